//! Broken input: an error that names file, place and remedy, and never a panic.

use std::path::{Path, PathBuf};
use tempfile::TempDir;
use umbrage_core::Image;
use umbrage_io::{open, open_str, pictures};

/// A folder with one small scene in every format.
struct Folder(TempDir);

const SCENE: &str = "name = \"small\"
[camera]
eye = [0.0, 2.0, 6.0]
target = [0.0, 0.5, 0.0]
fov_y = 45.0

[[model]]
primitive = \"sphere\"
radius = 0.5
segments = [8, 4]
rotate = [0.0, 30.0, 0.0]

[[light]]
kind = \"spot\"
position = [2.0, 5.0, 3.0]
direction = [0.0, -1.0, 0.0]
inner_angle = 10.0
outer_angle = 20.0
";

const OBJ: &str = "mtllib a.mtl
o card
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
vt 0 0
vt 1 1
vn 0 0 1
usemtl leaf
f 1/1/1 2/1/1 3/2/1 4/2/1
f -4//1 -3//1 -2//1
";

/// A triangle with a skin, a picture in a buffer view, a sparse accessor, a camera and a spot
/// light.
fn gltf_json(buffer: &str, png_length: usize) -> String {
    let length = 232 + png_length;
    format!(
        r#"{{"asset":{{"version":"2.0"}},"extensionsUsed":["KHR_lights_punctual"],
"extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"spot","intensity":9,"spot":{{"outerConeAngle":0.5}}}}]}}}},
"scene":0,"scenes":[{{"nodes":[0,2]}}],
"nodes":[{{"children":[1],"translation":[1,0,0]}},{{"mesh":0,"skin":0,"scale":[2,2,2]}},
{{"camera":0,"translation":[0,0,5],"extensions":{{"KHR_lights_punctual":{{"light":0}}}}}}],
"cameras":[{{"type":"perspective","perspective":{{"yfov":0.8,"znear":0.1}}}}],
"skins":[{{"joints":[0],"inverseBindMatrices":4}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3,"TEXCOORD_0":5}},"indices":1,"material":0}}]}}],
"materials":[{{"alphaMode":"MASK","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
"textures":[{{"source":0}}],"images":[{{"bufferView":7,"mimeType":"image/png"}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":1,"indices":{{"bufferView":5,"componentType":5123}},"values":{{"bufferView":6}}}}}},
{{"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}},
{{"bufferView":2,"componentType":5121,"count":3,"type":"VEC4"}},
{{"bufferView":3,"componentType":5121,"normalized":true,"count":3,"type":"VEC4"}},
{{"bufferView":4,"componentType":5126,"count":1,"type":"MAT4"}},
{{"bufferView":8,"componentType":5126,"count":3,"type":"VEC2"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":6}},
{{"buffer":0,"byteOffset":44,"byteLength":12}},{{"buffer":0,"byteOffset":56,"byteLength":12}},
{{"buffer":0,"byteOffset":68,"byteLength":64}},{{"buffer":0,"byteOffset":132,"byteLength":2}},
{{"buffer":0,"byteOffset":136,"byteLength":12}},{{"buffer":0,"byteOffset":232,"byteLength":{png_length}}},
{{"buffer":0,"byteOffset":148,"byteLength":24}}],
"buffers":[{{{buffer}"byteLength":{length}}}]}}"#
    )
}

/// The buffer of [`gltf_json`].
fn gltf_buffer(png: &[u8]) -> Vec<u8> {
    let mut bytes = vec![0; 232];
    let mut put = |at: usize, values: &[u8]| bytes[at..at + values.len()].copy_from_slice(values);
    let floats = |values: &[f32]| values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>();
    put(0, &floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 9.0, 9.0, 9.0]));
    put(36, &[0, 0, 1, 0, 2, 0]);
    for vertex in 0..3 {
        put(56 + 4 * vertex, &[255]);
    }
    put(68, &floats(&[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 3.0, 1.0]));
    put(132, &[2, 0]);
    put(136, &floats(&[0.0, 1.0, 0.0]));
    put(148, &floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    // Used by nothing but a test of what happens then.
    put(172, &floats(&[f32::NAN; 3]));
    bytes.extend(png);
    bytes
}

fn glb(json: &str, buffer: &[u8]) -> Vec<u8> {
    let pad = |mut chunk: Vec<u8>, with: u8| {
        chunk.resize(chunk.len().next_multiple_of(4), with);
        chunk
    };
    let (json, buffer) = (pad(json.as_bytes().to_vec(), b' '), pad(buffer.to_vec(), 0));
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + buffer.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", json), (b"BIN\0", buffer)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        let png = folder.path("leaf.png");
        pictures::save_png(&png, &Image::from_fn(2, 2, |x, y| [10, 20, 30, (x * 200 + y * 50) as u8])).unwrap();
        let png = std::fs::read(png).unwrap();
        folder.write("a.scene.toml", SCENE);
        folder.write("a.mtl", "newmtl leaf\nKd 0.5 1 0.5\nmap_Kd leaf.png\n");
        folder.write("a.obj", OBJ);
        folder.write("a.gltf", gltf_json("\"uri\":\"a%20b.bin\",", png.len()));
        folder.write("a b.bin", gltf_buffer(&png));
        folder.write("a.glb", glb(&gltf_json("", png.len()), &gltf_buffer(&png)));
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, contents: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), contents).unwrap();
    }

    fn text(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// The message of opening a file that must not open.
    fn error(&self, name: &str) -> String {
        match open(&self.path(name)) {
            Ok(opened) => panic!("{name} opened: {:?}", opened.notes),
            Err(e) => e.to_string(),
        }
    }

    /// Opens `name` with one string in it replaced, and expects all the `parts` in the error.
    fn expect(&self, name: &str, from: &str, to: &str, parts: &[&str]) {
        let whole = self.text(name);
        assert!(whole.contains(from), "{name} has no {from}");
        self.write(name, whole.replacen(from, to, 1));
        let message = self.error(name);
        self.write(name, whole);
        for part in parts {
            assert!(message.contains(part), "{from} → {to}: `{part}` is not in: {message}");
        }
        assert!(!message.contains('\n'), "{message}");
    }
}

#[test]
fn the_small_scenes_open() {
    let folder = Folder::new();
    for (name, triangles) in [("a.scene.toml", 48), ("a.obj", 3), ("a.gltf", 1), ("a.glb", 1)] {
        let opened = open(&folder.path(name)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(opened.scene.triangle_count(), triangles, "{name}");
    }
    let scene = open(&folder.path("a.obj")).unwrap().scene;
    assert_eq!(scene.materials[0].alpha_cutoff, Some(0.5), "a texture with transparent pixels is a mask");
    assert_eq!(scene.textures[0].rgba[3], [10, 20, 30, 250]);
    // The joint moves by (1, 0, 0), its inverse bind matrix by (0, 0, 3); the node's own scale does
    // not count.
    let scene = open(&folder.path("a.glb")).unwrap().scene;
    let want = [[1.0, 0.0, 3.0], [2.0, 0.0, 3.0], [1.0, 1.0, 3.0]].map(glam::Vec3::from);
    assert_eq!(scene.posed_mesh(&scene.instances[0]).positions, want);
    assert_eq!(scene.materials[0].alpha_cutoff, Some(0.5));
    assert_eq!(scene.camera.eye, glam::DVec3::new(0.0, 0.0, 5.0));
    assert_eq!(scene.lights[0].shape.kind(), umbrage_core::LightKind::Spot);
}

#[test]
fn scene_file_errors_name_line_key_and_remedy() {
    let f = Folder::new();
    let name = "a.scene.toml";
    for (from, to, parts) in [
        ("radius", "raduis", &["a.scene.toml:9:1", "[[model]]", "unknown key `raduis`", "did you mean `radius`?"][..]),
        ("[camera]", "[camara]", &[":2:", "`camara`", "did you mean `camera`?"]),
        ("segments", "size", &[":10:", "unknown key `size`"]),
        ("\"sphere\"", "\"spehre\"", &[":8:", "`primitive`", "did you mean `sphere`?"]),
        ("\"spot\"", "\"spotlight\"", &[":14:", "`kind`", "did you mean `spot`?"]),
        ("[8, 4]", "[2, 4]", &[":10:", "`segments`", "3 to"]),
        ("[8, 4]", "[8.5, 4]", &[":10:", "8.5"]),
        ("[8, 4]", "[1e9, 4]", &[":10:", "`segments`"]),
        ("45.0", "\"45\"", &[":5:", "`fov_y` must be a number, not a text"]),
        ("45.0", "180", &[":5:", "`fov_y`", "below 180"]),
        ("45.0", "nan", &[":5:", "`fov_y` must be finite"]),
        ("45.0", "1e999", &[":5:", "`fov_y` must be finite"]),
        ("45.0", "45.0\nnear = 0", &[":6:", "`near` must be over 0"]),
        ("45.0", "45.0\nup = [0, -1.5, -6]", &[":6:", "`up` lies along the line of sight"]),
        ("45.0", "45.0\nup = [0, 0, 0]", &[":6:", "`up` has no length"]),
        ("fov_y = 45.0", "", &[":2:", "camera: the key `fov_y` is missing"]),
        ("45.0", "45.0\nfar = 100", &[":6:", "`far` is for cameras with parallel lines of sight"]),
        ("45.0", "45.0\nheight = 3", &[":5:", "`fov_y` and `height` are both given"]),
        ("fov_y = 45.0", "height = 3", &[":2:", "camera: the key `far` is missing"]),
        ("fov_y = 45.0", "height = 0\nfar = 100", &[":5:", "`height` must be over 0"]),
        ("fov_y = 45.0", "height = 3\nfar = -9\nnear = -8", &[":6:", "`far` must be over `near`, which is -8"]),
        ("fov_y = 45.0", "height = nan\nfar = 100", &[":5:", "`height` must be finite"]),
        ("[0.0, 0.5, 0.0]", "[0, 2, 6]", &[":4:", "`target` is where `eye` is"]),
        ("[0.0, 0.5, 0.0]", "[0, 2]", &[":4:", "`target` must be a list of 3 numbers, not of 2"]),
        ("[0.0, 0.5, 0.0]", "[0, 2, true]", &[":4:", "not true or false"]),
        ("0.5\n", "-0.5\n", &[":9:", "`radius` must be over 0"]),
        ("rotate = [0.0, 30.0, 0.0]", "scale = 0", &[":11:", "`scale` must not be 0"]),
        ("rotate = [0.0, 30.0, 0.0]", "scale = [1, inf, 1]", &[":11:", "`scale` must be finite"]),
        ("rotate = [0.0, 30.0, 0.0]", "casts = 1", &[":11:", "`casts` must be true or false"]),
        ("rotate = [0.0, 30.0, 0.0]", "path = 'a.obj'", &[":11:", "exclude each other"]),
        ("rotate = [0.0, 30.0, 0.0]", "material = { colour = [0, 0, 0] }", &[":11:", "unknown key `colour`"]),
        ("rotate = [0.0, 30.0, 0.0]", "material = { base_color = [-1, 0, 0] }", &[":11:", "must not be negative"]),
        ("rotate = [0.0, 30.0, 0.0]", "material = 3", &[":11:", "must be a table"]),
        ("[0.0, -1.0, 0.0]", "[0, 0, 0]", &[":16:", "`direction` has no length"]),
        ("inner_angle = 10.0", "inner_angle = 30", &[":17:", "larger than `outer_angle`"]),
        ("outer_angle = 20.0", "outer_angle = 90", &[":18:", "below 90"]),
        ("outer_angle = 20.0", "", &[":13:", "`outer_angle` is missing"]),
        ("20.0\n", "20.0\nrange = 0", &[":19:", "`range` must be over 0"]),
        ("20.0\n", "20.0\nattenuation = [0, 0, 0]", &[":19:", "all 0"]),
        ("20.0\n", "20.0\nintensity = -1", &[":19:", "`intensity` must not be negative"]),
        ("[[model]]", "[model]", &[":7:", "write [[model]]"]),
        ("primitive = \"sphere\"\nradius = 0.5\nsegments = [8, 4]", "", &["neither `path` nor `primitive`"]),
        ("fov_y = 45.0", "fov_y = ", &[":5:", "not valid TOML"]),
        ("fov_y = 45.0", "eye = [0, 0, 0]", &[":5:", "not valid TOML", "duplicate key"]),
    ] {
        f.expect(name, from, to, parts);
    }
    let model = |line: &str| open_str(&format!("[[model]]\n{line}"), f.0.path(), "s.toml").unwrap_err().to_string();
    assert!(model("path = 'b.obj'").contains("s.toml:2:8: `path` names "), "{}", model("path = 'b.obj'"));
    assert!(model("path = 'aa.obj'").ends_with("did you mean `a.obj`?"), "{}", model("path = 'aa.obj'"));
    assert!(model("path = 'a.mtl'").contains("`.mtl` is not a kind of file"), "{}", model("path = 'a.mtl'"));
    let empty = open_str("name = 'x'", Path::new("."), "s.toml").unwrap_err().to_string();
    assert!(empty.starts_with("s.toml: there is no triangle in it"), "{empty}");
}

#[test]
fn degenerate_lights_are_errors() {
    for (light, part) in [
        ("kind = 'line'\nfrom = [1, 1, 1]\nto = [1, 1, 1]", "s:6:6: `to` is where `from` is"),
        (
            "kind = 'rect'\nposition = [0, 1, 0]\ndirection = [0, 1, 0]\nup = [0, 2, 0]\nsize = [1, 1]",
            "`up` lies along",
        ),
        ("kind = 'rect'\nposition = [0, 1, 0]\ndirection = [0, 1, 0]\nup = [1, 0, 0]\nsize = [1, 0]", "`size` must be"),
        ("kind = 'sphere'\nposition = [0, 1, 0]\nradius = -1", "`radius` must not be negative"),
        ("kind = 'ellipsoid'\nposition = [0, 1, 0]\nradii = [1, 0, 1]", "`radii` must be over 0"),
        ("kind = 'directional'\ndirection = [0, -1, 0]\nangle = 180", "`angle` must be below 180"),
        ("kind = 'directional'\ndirection = [0, -1, 0]\nposition = [0, 0, 0]", "unknown key `position`"),
        ("position = [0, 0, 0]", "the key `kind` is missing"),
    ] {
        let text = format!("model = [{{ primitive = 'box', size = [1, 1, 1] }}]\n\n[[light]]\n{light}\n");
        let message = open_str(&text, Path::new("."), "s").unwrap_err().to_string();
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
}

#[test]
fn obj_errors_name_the_line() {
    let f = Folder::new();
    for (from, to, parts) in [
        ("v 1 1 0", "v 1 nan 0", &["a.obj:5: ", "not finite"][..]),
        ("v 1 1 0", "v 1 inf 0", &["a.obj:5: ", "not finite"]),
        ("v 1 1 0", "v 1 1e30 0", &["a.obj:5: ", "too far"]),
        ("v 1 1 0", "v 1 1", &["a.obj:5: ", "needs 3 numbers and has 2"]),
        ("v 1 1 0", "v 1 x 0", &["a.obj:5: ", "`x` is not a number; mend it"]),
        ("3/2/1", "9/2/1", &["a.obj:11: ", "index 9 is out of range: the file has 4 vertices"]),
        ("3/2/1", "3/9/1", &["a.obj:11: ", "2 texture coordinates"]),
        ("3/2/1", "3/2/2", &["a.obj:11: ", "1 normals"]),
        ("3/2/1", "0/2/1", &["a.obj:11: ", "`0/2/1` is not a corner"]),
        ("3/2/1", "3/2/1/1", &["a.obj:11: ", "is not a corner"]),
        ("-4//1", "-5//1", &["a.obj:12: ", "is not a corner"]),
        ("-3//1 -2//1", "-3//1", &["a.obj:12: ", "needs 3 corners and has 2"]),
        ("f 1/1/1 2/1/1 3/2/1 4/2/1\nf -4//1 -3//1 -2//1", "", &["there is no triangle"]),
    ] {
        f.expect("a.obj", from, to, parts);
    }
    f.write("leaf.png", "no picture");
    let message = f.error("a.obj");
    assert!(
        message.contains("a.mtl:1: material `leaf` names ") && message.contains("leaf.png: is not a picture"),
        "{message}"
    );
    std::fs::remove_file(f.path("leaf.png")).unwrap();
    let notes = open(&f.path("a.obj")).unwrap().notes;
    assert!(notes[0].contains("material `leaf`: the picture") && notes[0].contains("is missing"), "{notes:?}");
    f.write("a.mtl", "newmtl leaf\nKd 1 x 1\n");
    assert!(f.error("a.obj").contains("a.mtl:2: `x` is not a number"));
    f.expect("a.obj", "mtllib a.mtl", "mtllib .", &["a.obj:1: `mtllib` names ", "it is a folder; name a file in it"]);
    std::fs::remove_file(f.path("a.mtl")).unwrap();
    let notes = open(&f.path("a.obj")).unwrap().notes;
    assert!(notes[0].contains("a.obj:1: material library `a.mtl` is missing"), "{notes:?}");
}

#[test]
fn gltf_errors_name_the_part() {
    let f = Folder::new();
    for (from, to, parts) in [
        ("\"count\":3,\"type\":\"VEC3\"", "\"count\":4,\"type\":\"VEC3\"", &["accessor 0", "do not fit"][..]),
        ("\"count\":3,\"type\":\"VEC3\"", "\"count\":3,\"type\":\"VEC2\"", &["accessor 0", "2 numbers instead of 3"]),
        (
            "\"byteOffset\":136,\"byteLength\":12",
            "\"byteOffset\":999,\"byteLength\":12",
            &["accessor 0", "within its buffer"],
        ),
        ("\"byteOffset\":132", "\"byteOffset\":70", &["accessor 0", "sparse index"]),
        (
            "\"byteOffset\":36,\"byteLength\":6",
            "\"byteOffset\":70,\"byteLength\":6",
            &["mesh 0, primitive 0", "out of range"],
        ),
        ("\"byteOffset\":136", "\"byteOffset\":172", &["mesh 0, primitive 0", "vertex 2", "not finite"]),
        ("\"POSITION\":0", "\"POSITION\":6", &["mesh 0", "accessor 6 is out of range"]),
        ("\"joints\":[0]", "\"joints\":[0,1]", &["skin 0", "1 inverse bind matrices for 2 joints"]),
        ("\"children\":[1]", "\"children\":[1,0]", &["node 0", "its own ancestor"]),
        ("\"children\":[1]", "\"children\":[1,1]", &["node 1", "child of two"]),
        ("\"children\":[1]", "\"children\":[7]", &["a.gltf", "not valid glTF"]),
        ("\"translation\":[1,0,0]", "\"translation\":[1e30,0,0]", &["node 0", "not finite"]),
        ("a%20b.bin", "c.bin", &["buffer 0", "c.bin: cannot be read"]),
        (
            "\"uri\":\"a%20b.bin\"",
            "\"uri\":\"data:application/octet-stream;base64,AAAA\"",
            &["buffer 0", "is 3 bytes long instead"],
        ),
        ("\"uri\":\"a%20b.bin\"", "\"uri\":\"data:,x\"", &["buffer 0", "not in base64"]),
        ("\"uri\":\"a%20b.bin\"", "\"uri\":\"data:;base64,*\"", &["buffer 0", "not valid base64"]),
        ("\"uri\":\"a%20b.bin\",", "", &["buffer 0", "no binary part"]),
        ("\"bufferView\":7,\"mimeType\":\"image/png\"", "\"uri\":\".\"", &["image 0", "it is a folder"]),
        ("\"bufferView\":7,\"mimeType\":\"image/png\"", "\"bufferView\":6", &["image 0", "not a picture"]),
        ("\"bufferView\":7,\"mimeType\":\"image/png\"", "\"mimeType\":\"image/png\"", &["image 0", "neither"]),
        ("\"intensity\":9", "\"intensity\":-9", &["light 0", "negative"]),
        ("0.5}", "5}", &["light 0", "half angles"]),
        (
            "\"extensionsUsed\"",
            "\"extensionsRequired\":[\"X_y\"],\"extensionsUsed\"",
            &["requires the extension `X_y`"],
        ),
        ("{\"asset\"", "{\"asset", &["not valid glTF"]),
        ("\"version\":\"2.0\"", "\"version\":\"1.0\"", &["asset: is glTF 1.0, not 2.0; export"]),
    ] {
        f.expect("a.gltf", from, to, parts);
    }
    f.write("a.glb", &std::fs::read(f.path("a.glb")).unwrap()[..900]);
    assert!(f.error("a.glb").contains("bytes long, and is 900"), "{}", f.error("a.glb"));
    f.write("a.glb", b"glTF\x02\0\0\0");
    assert!(f.error("a.glb").contains("is 8 bytes long, and the header alone has 12"), "{}", f.error("a.glb"));
}

/// Cuts a file at many lengths and damages every byte; `open` must come back each time.
fn corrupt(name: &str) {
    let f = Folder::new();
    let whole = std::fs::read(f.path(name)).unwrap();
    let damaged = format!("damaged-{name}");
    for length in (0..whole.len()).step_by(whole.len() / 300 + 1) {
        f.write(&damaged, &whole[..length]);
        let _ = open(&f.path(&damaged));
    }
    for i in 0..whole.len() {
        let mut bytes = whole.clone();
        // Another bit for every byte: digits, letters and punctuation become others of their kind
        // or something else.
        bytes[i] ^= [0x01, 0x10, 0x04, 0x80, 0x02][i % 5];
        f.write(&damaged, bytes);
        let _ = open(&f.path(&damaged));
    }
}

#[test]
fn corrupt_scene_files_do_not_panic() {
    corrupt("a.scene.toml");
}

#[test]
fn corrupt_obj_and_mtl_do_not_panic() {
    corrupt("a.obj");
    let f = Folder::new();
    let whole = f.text("a.mtl");
    for length in 0..whole.len() {
        f.write("a.mtl", &whole[..length]);
        let _ = open(&f.path("a.obj"));
    }
}

#[test]
fn corrupt_gltf_does_not_panic() {
    corrupt("a.glb");
}

#[test]
fn a_glb_cut_off_anywhere_is_an_error() {
    let f = Folder::new();
    let whole = std::fs::read(f.path("a.glb")).unwrap();
    for length in (0..whole.len()).step_by(7) {
        f.write("cut.glb", &whole[..length]);
        let message = f.error("cut.glb");
        assert!(message.contains("cut.glb"), "{message}");
    }
}

#[test]
fn files_of_no_use_are_refused() {
    let f = Folder::new();
    assert!(f.error("b.obj").contains("cannot be read"));
    f.write("a.txt", "text");
    assert!(f.error("a.txt").contains("`.txt` is not a kind of file that can be opened; use .toml"));
    f.write("binary.toml", [0xff, 0xfe, 0x00]);
    assert!(f.error("binary.toml").contains("not UTF-8"));
    f.write("empty.glb", "");
    f.error("empty.glb");
    std::fs::create_dir(f.path("dir.obj")).unwrap();
    assert!(f.error("dir.obj").contains("cannot be read"));
}

#[test]
fn what_files_claim_costs_neither_memory_nor_time() {
    let f = Folder::new();
    let started = std::time::Instant::now();
    f.expect(
        "a.gltf",
        "{\"bufferView\":1,\"componentType\":5123,\"count\":3",
        "{\"componentType\":5123,\"count\":67108863",
        &["accessor 1", "67108863 elements and no bytes"],
    );
    // A picture of 30,000 × 30,000 pixels, of which nothing follows.
    let png = std::fs::read(f.path("leaf.png")).unwrap();
    let mut large = png.clone();
    large[16..24].copy_from_slice(&[0, 0, 0x75, 0x30, 0, 0, 0x75, 0x30]);
    let crc = crc(&large[12..29]);
    large[29..33].copy_from_slice(&crc.to_be_bytes());
    f.write("leaf.png", &large);
    let message = f.error("a.obj");
    assert!(
        message.contains("leaf.png") && message.contains("30000 × 30000") && message.contains("scale it"),
        "{message}"
    );
    f.write("leaf.png", &png);
    // A long name of an object, of a material that changes all the time, and of a library.
    let names = format!("o {}\n", "n".repeat(1_000_000));
    let faces: String = (0..50_000).map(|i| format!("usemtl m{}\nf 1 2 3\n", i % 1000)).collect();
    let libraries = "mtllib a.mtl\n".repeat(50_000);
    f.write("long.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{names}{faces}{libraries}"));
    assert_eq!(open(&f.path("long.obj")).unwrap().scene.meshes.len(), 1000);
    // A polygon of more corners than can be cut, and shapes of more triangles than there may be.
    let corners = |i: usize| format!("v {i} {} 0\n", if i.is_multiple_of(2) { 9 } else { 1 });
    let polygon: String = (0..20_000).map(corners).chain(["v 0 -9 0\nf".into()]).collect();
    let numbers: String = (1..20_002).map(|i| format!(" {i}")).collect();
    f.write("comb.obj", polygon + &numbers);
    assert!(f.error("comb.obj").contains("a concave polygon has 20001 corners"), "{}", f.error("comb.obj"));
    f.write("many.toml", "[[model]]\nprimitive = 'cylinder'\nradius = 1\nheight = 1\nsegments = [4096, 4096]\n");
    let message = f.error("many.toml");
    assert!(message.contains("more than 33554432 triangles"), "{message}");
    assert!(started.elapsed().as_secs() < 60, "{:?}", started.elapsed());
}

/// The check sum of a PNG's parts.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 })
    })
}
