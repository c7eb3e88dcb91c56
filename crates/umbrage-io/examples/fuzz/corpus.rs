//! Small files of every kind, made here.

use image::codecs::hdr::HdrEncoder;
use image::{DynamicImage, ExtendedColorType, ImageFormat, Rgb};
use serde_json::{Value, json};
use std::fs;
use std::io::Cursor;
use std::path::Path;
use umbrage_core::Image;
use umbrage_io::pictures;

/// A file, and those beside it; the first one is opened.
#[derive(Clone)]
pub struct Case {
    pub files: Vec<Entry>,
}

#[derive(Clone)]
pub struct Entry {
    pub name: String,
    pub bytes: Vec<u8>,
}

impl Case {
    fn new(files: &[(&str, Vec<u8>)]) -> Self {
        let entry = |(name, bytes): &(&str, Vec<u8>)| Entry { name: (*name).to_owned(), bytes: bytes.clone() };
        Self { files: files.iter().map(entry).collect() }
    }

    /// Writes the files into a folder, and removes what other inputs left there.
    pub fn write(&self, folder: &Path) {
        for entry in fs::read_dir(folder).expect("the folder of inputs").flatten() {
            let _ = fs::remove_file(entry.path());
        }
        for file in &self.files {
            fs::write(folder.join(&file.name), &file.bytes).expect("an input");
        }
    }
}

const OBJ: &str = "# C:\\
mtllib a.mtl
o card
v 0 0 0
v 1 0 0
v 1 1 0 1 0 0
v 0.5 0.25 0
v 0 1 0
vt 0 0
vt 1 0.5 0
vn 0 0 1
g left
usemtl leaf
s off
f 1/1/1 2/2/1 3/1/1 4/2/1 5/1/1
usemtl stem
f -1//1 -2//1 \\
 -3//1
l 1 2 3
v 3 3 3
f 6 1 2 3
";

const MTL: &str = "newmtl leaf
Kd 0.5 1 0.5
Ks 0.1 0.1 0.1
Ns 20
map_Kd -s 2 2 a.png
map_d a.png
newmtl stem
Kd 1 1 1
Ke 0 0 2
d 0.5
";

const TOML: &str = "name = \"small\"
[camera]
eye = [0.0, 2.0, 6.0]
target = [0.0, 0.5, 0.0]
up = [0, 1, 0]
fov_y = 45.0
near = 0.01
[ambient]
color = [0.1, 0.1, 0.1]
[[model]]
primitive = \"sphere\"
radius = 0.5
segments = [8, 4]
rotate = [0.0, 30.0, 0.0]
material = { base_color = [1, 0, 0], specular = 0.5, shininess = 8, emissive = [0, 0, 0] }
[[model]]
primitive = \"torus\"
radii = [1, 0.25]
segments = [5, 4]
casts = false
[[model]]
primitive = \"cone\"
radius = 1
height = 2
translate = [1, 2, 3]
[[model]]
primitive = \"box\"
size = [1, 2, 3]
scale = [1, -2, 0.5]
receives = false
[[model]]
primitive = \"plane\"
size = [9, 9]
[[model]]
path = \"a.obj\"
[[model]]
path = \"a.glb\"
animation = \"wave\"
time = 0.4
[[light]]
kind = \"spot\"
position = [2.0, 5.0, 3.0]
direction = [0.0, -1.0, 0.0]
inner_angle = 10.0
outer_angle = 20.0
attenuation = [1, 0, 0]
range = 20
[[light]]
kind = \"directional\"
direction = [0, -1, 0]
angle = 0.5
[[light]]
kind = \"rect\"
position = [0, 3, 0]
direction = [0, -1, 0]
up = [1, 0, 0]
size = [1, 1]
texture = \"a.png\"
[[light]]
kind = \"ellipsoid\"
position = [0, 3, 0]
radii = [1, 0.5, 0.25]
rotate = [0, 0, 45]
[[light]]
kind = \"line\"
from = [0, 3, 0]
to = [1, 3, 0]
intensity = 3
color = [1, 1, 0]
casts = false
";

/// A triangle on a skin with an animation, a mask with a transform, a sparse accessor, a camera and
/// two lights. The buffer is that of [`buffer`].
fn gltf(uri: Option<String>) -> Value {
    let accessor = |view: usize, kind: u32, count: usize, of: &str| json!({ "bufferView": view, "componentType": kind, "count": count, "type": of });
    let lengths = [36, 8, 12, 12, 64, 4, 12, 24, 12, 48, 48];
    let starts = lengths.iter().scan(0, |sum, length| {
        *sum += length;
        Some(*sum - length)
    });
    let views: Vec<Value> = starts
        .zip(lengths)
        .map(|(start, length)| json!({ "buffer": 0, "byteOffset": start, "byteLength": length }))
        .collect();
    let mut position = accessor(0, 5126, 3, "VEC3");
    position["sparse"] =
        json!({ "count": 1, "indices": { "bufferView": 5, "componentType": 5123 }, "values": { "bufferView": 6 } });
    let mut weights = accessor(3, 5121, 3, "VEC4");
    weights["normalized"] = json!(true);
    let mut buffer = json!({ "byteLength": lengths.iter().sum::<usize>() });
    if let Some(uri) = uri {
        buffer["uri"] = json!(uri);
    }
    let transform =
        json!({ "KHR_texture_transform": { "offset": [0.25, 0], "rotation": 0.5, "scale": [2, 1], "texCoord": 0 } });
    json!({
        "asset": { "version": "2.0", "minVersion": "2.0" },
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"],
        "extensionsRequired": ["KHR_texture_transform"],
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "spot", "intensity": 9, "color": [1, 1, 1], "range": 9, "spot": { "innerConeAngle": 0.25, "outerConeAngle": 0.5 } },
            { "type": "point" }] } },
        "scene": 0,
        "scenes": [{ "nodes": [0, 2, 3] }],
        "nodes": [
            { "children": [1], "translation": [1, 0, 0], "rotation": [0, 0, 0, 1] },
            { "mesh": 0, "skin": 0, "scale": [2, 2, 2] },
            { "camera": 0, "translation": [0, 0, 5], "extensions": { "KHR_lights_punctual": { "light": 0 } } },
            { "mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "extensions": { "KHR_lights_punctual": { "light": 1 } } }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } }],
        "skins": [{ "joints": [0], "inverseBindMatrices": 4 }],
        "animations": [{ "name": "wave", "samplers": [{ "input": 7, "output": 8, "interpolation": "LINEAR" }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }] }],
        "meshes": [{ "name": "leaf", "primitives": [{
            "attributes": { "POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3, "TEXCOORD_0": 5, "COLOR_0": 6 },
            "indices": 1, "material": 0, "mode": 4 }] }],
        "materials": [{ "alphaMode": "MASK", "alphaCutoff": 0.25, "emissiveFactor": [0, 0, 0], "pbrMetallicRoughness": {
            "baseColorFactor": [1, 1, 1, 0.9], "metallicFactor": 0.5, "roughnessFactor": 0.5,
            "baseColorTexture": { "index": 0, "extensions": transform } } }],
        "samplers": [{ "magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648 }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "images": [{ "uri": "a.png" }],
        "accessors": [position, accessor(1, 5123, 3, "SCALAR"), accessor(2, 5121, 3, "VEC4"), weights,
            accessor(4, 5126, 1, "MAT4"), accessor(7, 5126, 3, "VEC2"), accessor(9, 5126, 3, "VEC4"),
            accessor(8, 5126, 3, "SCALAR"), accessor(10, 5126, 3, "VEC3")],
        "bufferViews": views,
        "buffers": [buffer]
    })
}

fn buffer() -> Vec<u8> {
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    [
        floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 9.0, 9.0, 9.0]),
        vec![0, 0, 1, 0, 2, 0, 0, 0],
        [0; 12].to_vec(),
        [255, 0, 0, 0].repeat(3),
        floats(&identity),
        vec![2, 0, 0, 0],
        floats(&[0.0, 1.0, 0.0]),
        floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        floats(&[0.0, 0.5, 1.0]),
        floats(&[1.0, 1.0, 1.0, 1.0]).repeat(3),
        floats(&[0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ]
    .concat()
}

/// Packs a `.glb`.
pub fn glb(json: &[u8], blob: &[u8]) -> Vec<u8> {
    let pad = |bytes: &[u8], with: u8| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), with);
        bytes
    };
    let (json, blob) = (pad(json, b' '), pad(blob, 0));
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + blob.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", blob)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

fn encoded(picture: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("a picture");
    bytes.into_inner()
}

/// Pictures by their extension, of all kinds of pixels.
fn all_pictures() -> Vec<(&'static str, Vec<u8>)> {
    let rgba = DynamicImage::ImageRgba8(image::RgbaImage::from_fn(5, 4, |x, y| {
        image::Rgba([9, 99, x as u8, (x * y * 20) as u8])
    }));
    let mut hdr = Vec::new();
    HdrEncoder::new(&mut hdr).encode(&[Rgb([1.0f32, 2.0, 0.5]); 96], 12, 8).expect("a picture");
    let folder = tempfile::tempdir().expect("a folder");
    let exr = |save: &dyn Fn(&Path)| {
        let path = folder.path().join("a.exr");
        save(&path);
        fs::read(path).expect("a picture")
    };
    let grey =
        exr(&|path| pictures::save_exr(path, &Image::from_fn(9, 7, |x, y| (x * y) as f32), "V").expect("a picture"));
    let color = exr(&|path| {
        pictures::save_exr_rgb(path, &Image::from_fn(20, 20, |x, y| [x as f32, y as f32, 0.5])).expect("a picture")
    });
    let mut jpeg = Vec::new();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut jpeg, 60);
    image::ImageEncoder::write_image(encoder, &rgba.to_rgb8(), 5, 4, ExtendedColorType::Rgb8).expect("a picture");
    vec![
        ("png", encoded(&rgba, ImageFormat::Png)),
        ("png", encoded(&rgba.to_luma8().into(), ImageFormat::Png)),
        ("png", encoded(&rgba.to_luma16().into(), ImageFormat::Png)),
        ("png", encoded(&rgba.to_rgba16().into(), ImageFormat::Png)),
        ("jpg", jpeg),
        ("jpg", encoded(&rgba.to_luma8().into(), ImageFormat::Jpeg)),
        ("hdr", hdr),
        ("exr", grey),
        ("exr", color),
    ]
}

/// The corpus: scenes as users have them, and pictures alone.
pub fn all() -> Vec<Case> {
    let pictures = all_pictures();
    let png = pictures[0].1.clone();
    let text = |value: &Value| value.to_string().into_bytes();
    let data = base64::Engine::encode(&base64::engine::general_purpose::STANDARD, buffer());
    let uri = format!("data:application/octet-stream;base64,{data}");
    let glb = glb(&text(&gltf(None)), &buffer());
    let obj = |picture: &[u8]| Case::new(&[("a.obj", OBJ.into()), ("a.mtl", MTL.into()), ("a.png", picture.to_vec())]);
    let mut all = vec![
        obj(&png),
        obj(&pictures[4].1),
        Case::new(&[("a.gltf", text(&gltf(Some(uri)))), ("a.png", png.clone())]),
        Case::new(&[("a.gltf", text(&gltf(Some("a.bin".into())))), ("a.bin", buffer()), ("a.png", png.clone())]),
        Case::new(&[("a.glb", glb.clone()), ("a.png", png.clone())]),
        Case::new(&[
            ("a.scene.toml", TOML.into()),
            ("a.obj", OBJ.into()),
            ("a.mtl", MTL.into()),
            ("a.glb", glb),
            ("a.png", png),
        ]),
    ];
    all.extend(pictures.iter().map(|(kind, bytes)| Case::new(&[(&format!("a.{kind}"), bytes.clone())])));
    all
}
