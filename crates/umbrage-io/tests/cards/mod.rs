//! Small files made in tests, and what is seen of them.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use umbrage_core::glam::{DVec2, DVec3, Vec2};
use umbrage_core::{Image, Instance, Scene};
use umbrage_io::{Opened, open, open_bytes, pictures};

/// A file to open, and those beside it.
pub struct Input {
    name: &'static str,
    files: Vec<(&'static str, Vec<u8>)>,
}

impl Input {
    pub fn bytes(name: &'static str, bytes: Vec<u8>) -> Self {
        Self { name, files: vec![(name, bytes)] }
    }

    pub fn obj(text: String) -> Self {
        Self::bytes("a.obj", text.into_bytes())
    }

    pub fn and(mut self, name: &'static str, bytes: Vec<u8>) -> Self {
        self.files.push((name, bytes));
        self
    }

    /// Writes the files into a folder of their own.
    pub fn write(&self) -> (TempDir, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        for (name, bytes) in &self.files {
            std::fs::write(dir.path().join(name), bytes).unwrap();
        }
        let path = dir.path().join(self.name);
        (dir, path)
    }

    /// Opens what has to open, from the disk and from memory: both have to be the same.
    pub fn open(&self, name: &str) -> Opened {
        let (_dir, path) = self.write();
        let opened = open(&path).unwrap_or_else(|e| panic!("{name}: {e}"));
        let files = self.files.iter().map(|(name, bytes)| ((*name).to_string(), bytes.clone())).collect();
        let at_hand = open_bytes(self.name, &files).unwrap_or_else(|e| panic!("{name} from memory: {e}"));
        let text = |scene: &Scene| format!("{:?} {:?} {:?}", scene.meshes, scene.instances, scene.materials);
        let pictures = |scene: &Scene| scene.textures.iter().map(|t| (t.width, t.rgba.clone())).collect::<Vec<_>>();
        assert!(text(&opened.scene) == text(&at_hand.scene), "{name} is another scene from memory");
        assert!(pictures(&opened.scene) == pictures(&at_hand.scene), "{name} has other pictures from memory");
        assert_eq!(opened.notes.len(), at_hand.notes.len(), "{name}: {:?}", at_hand.notes);
        opened
    }
}

/// The bytes of a PNG of `size` × `size` white pixels, opaque where `is_ink` of column and row.
pub fn picture(size: u32, is_ink: impl Fn(u32, u32) -> bool) -> Vec<u8> {
    let image = Image::from_fn(size, size, |x, y| [255u8, 255, 255, if is_ink(x, y) { 255 } else { 0 }]);
    pictures::png_bytes(Path::new("picture"), &image).unwrap()
}

fn base64(bytes: &[u8]) -> String {
    base64::Engine::encode(&base64::engine::general_purpose::STANDARD, bytes)
}

/// A glTF file with one mesh called `card`: a unit square of two triangles.
pub struct Gltf {
    buffer: Vec<u8>,
    views: Vec<String>,
    accessors: Vec<String>,
    attributes: String,
    material: String,
    nodes: String,
    primitive: String,
    rest: String,
}

impl Gltf {
    pub fn card() -> Self {
        let new = Self {
            buffer: Vec::new(),
            views: Vec::new(),
            accessors: Vec::new(),
            attributes: String::new(),
            material: String::new(),
            nodes: "{\"mesh\":0}".into(),
            primitive: String::new(),
            rest: String::new(),
        };
        new.attribute("POSITION", "[[0,0,0],[1,0,0],[1,1,0],[0,1,0]]")
    }

    /// Adds an attribute of floats, given as a JSON list of lists.
    pub fn attribute(mut self, name: &str, values: &str) -> Self {
        let values: Vec<Vec<f32>> = serde_json::from_str(values).unwrap();
        let width = values[0].len();
        let (start, count) = (self.buffer.len(), values.len());
        self.buffer.extend(values.iter().flatten().flat_map(|v| v.to_le_bytes()));
        let length = self.buffer.len() - start;
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":{length}}}"#));
        let view = self.views.len() - 1;
        self.accessors
            .push(format!(r#"{{"bufferView":{view},"componentType":5126,"count":{count},"type":"VEC{width}"}}"#));
        let comma = if self.attributes.is_empty() { "" } else { "," };
        write!(self.attributes, r#"{comma}"{name}":{}"#, self.accessors.len() - 1).unwrap();
        self
    }

    /// The contents of the material.
    pub fn material(mut self, contents: &str) -> Self {
        self.material = contents.into();
        self
    }

    /// A material with an alpha mask.
    pub fn masked(self, png: &[u8], sampler: &str, texture_info: &str) -> Self {
        let image = format!(r#"{{"uri":"data:image/png;base64,{}"}}"#, base64(png));
        self.material(&format!(
            r#""alphaMode":"MASK","pbrMetallicRoughness":{{"baseColorTexture":{{"index":0{texture_info}}}}}"#
        ))
        .rest(&format!(r#","images":[{image}],"samplers":[{{{sampler}}}],"textures":[{{"source":0,"sampler":0}}]"#))
    }

    /// The base colour as `KHR_materials_pbrSpecularGlossiness` has it.
    pub fn specular_glossiness(mut self) -> Self {
        let old = r#""extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture""#;
        self.material = self.material.replace(r#""pbrMetallicRoughness":{"baseColorTexture""#, old) + "}";
        self
    }

    pub fn nodes(mut self, nodes: &str) -> Self {
        self.nodes = nodes.into();
        self
    }

    /// More of the file's top level.
    pub fn rest(mut self, rest: &str) -> Self {
        self.rest += rest;
        self
    }

    /// Positions that are compressed.
    pub fn draco(mut self) -> Self {
        self.accessors[0] = self.accessors[0].replace(r#""bufferView":0,"#, "");
        self.primitive =
            r#","extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}"#.into();
        self
    }

    /// Positions in a buffer that a decompressor has to fill.
    pub fn meshopt(mut self) -> Self {
        let view = r#"{"extensions":{"EXT_meshopt_compression":{"buffer":0}},"buffer":1,"#;
        self.views[0] = self.views[0].replace(r#"{"buffer":0,"#, view);
        self.primitive = String::new();
        self
    }

    /// Positions of which some are zero by default, and others stand apart.
    pub fn sparse(mut self) -> Self {
        let start = self.buffer.len();
        self.buffer.extend([1, 2, 3, 0]);
        self.views.push(format!(r#"{{"buffer":0,"byteOffset":{start},"byteLength":3}}"#));
        let sparse = r#""sparse":{"count":3,"indices":{"bufferView":1,"componentType":5121},"values":{"bufferView":0,"byteOffset":12}},"#;
        self.accessors[0] = self.accessors[0].replace(r#""bufferView":0,"#, sparse);
        self
    }

    fn json(&self, uri: &str) -> String {
        let Self { views, accessors, attributes, material, nodes, primitive, rest, .. } = self;
        let length = self.buffer.len();
        let fallback = r#",{"byteLength":48,"extensions":{"EXT_meshopt_compression":{"fallback":true}}}"#;
        let fallback = if views[0].contains("meshopt") { fallback } else { "" };
        // An index of each node that is no child of another.
        let count = serde_json::from_str::<serde_json::Value>(&format!("[{nodes}]")).unwrap();
        let nested =
            count.as_array().unwrap().iter().flat_map(|n| n["children"].as_array().cloned().unwrap_or_default());
        let nested: Vec<u64> = nested.filter_map(|c| c.as_u64()).collect();
        let roots: Vec<u64> = (0..count.as_array().unwrap().len() as u64).filter(|n| !nested.contains(n)).collect();
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":{roots:?}}}],"nodes":[{nodes}],
"meshes":[{{"name":"card","primitives":[{{"attributes":{{{attributes}}},"mode":6,"material":0{primitive}}}]}}],
"materials":[{{{material}}}],"accessors":[{}],"bufferViews":[{}],
"buffers":[{{{uri}"byteLength":{length}}}{fallback}]{rest}}}"#,
            accessors.join(","),
            views.join(",")
        )
    }

    /// The bytes of the `.gltf`, changed.
    pub fn bytes(&self, change: impl Fn(&[u8]) -> Vec<u8>) -> Input {
        let uri = format!(r#""uri":"data:application/octet-stream;base64,{}","#, base64(&self.buffer));
        Input::bytes("a.gltf", change(self.json(&uri).as_bytes()))
    }

    /// A `.glb` with a part that nobody knows at its end.
    pub fn glb(&self) -> Input {
        let pad = |mut chunk: Vec<u8>, with: u8| {
            chunk.resize(chunk.len().next_multiple_of(4), with);
            chunk
        };
        let chunks = [
            (b"JSON", pad(self.json("").into_bytes(), b' ')),
            (b"BIN\0", pad(self.buffer.clone(), 0)),
            (b"MINE", vec![1, 2, 3, 4]),
        ];
        let length: usize = 12 + chunks.iter().map(|(_, chunk)| 8 + chunk.len()).sum::<usize>();
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((length as u32).to_le_bytes());
        for (kind, chunk) in chunks {
            bytes.extend((chunk.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(chunk);
        }
        Input::bytes("a.glb", bytes)
    }
}

impl From<Gltf> for Input {
    fn from(file: Gltf) -> Self {
        file.bytes(<[u8]>::to_vec)
    }
}

/// Points along each side of the grid over the unit square.
const SIDE: usize = 37;

/// The unit square as lines of text, `#` where something is there.
pub fn covered(scene: &Scene) -> String {
    let at = |i: usize| (i as f64 + 0.31) / SIDE as f64;
    let row = |j: usize| -> String {
        let there =
            |i: usize| scene.instances.iter().any(|instance| is_there(scene, instance, DVec2::new(at(i), at(j))));
        (0..SIDE).map(|i| if there(i) { '#' } else { '.' }).collect()
    };
    (0..SIDE).rev().map(row).collect::<Vec<_>>().join("\n")
}

/// True where a ray along Z meets a triangle of an instance, and no hole.
fn is_there(scene: &Scene, instance: &Instance, point: DVec2) -> bool {
    let mesh = &scene.meshes[instance.mesh];
    let material = &scene.materials[instance.material];
    mesh.triangles().any(|triangle| {
        let place = |p: DVec3| instance.world_from_mesh.transform_point3(p).truncate();
        let [a, b, c] = mesh.corners(triangle).map(|p| place(p.as_dvec3()));
        let area = (b - a).perp_dot(c - a);
        let shares = [(b, c), (c, a), (a, b)].map(|(p, q)| (q - p).perp_dot(point - p) / area);
        if area == 0.0 || shares.iter().any(|s| *s < 0.0) {
            return false;
        }
        let Some(cutoff) = material.alpha_cutoff else { return true };
        let mean = |of: &dyn Fn(usize) -> f32| -> f32 {
            triangle.iter().zip(shares).map(|(i, share)| of(*i as usize) * share as f32).sum()
        };
        let uv = |i: usize| mesh.uvs.get(i).copied().unwrap_or_default();
        let uv = Vec2::new(mean(&|i| uv(i).x), mean(&|i| uv(i).y));
        let opacity = mean(&|i| mesh.opacities.get(i).copied().unwrap_or(1.0));
        let texel = material.texture.map_or(1.0, |t| scene.textures[t].alpha(uv));
        material.base_color.w * opacity * texel >= cutoff
    })
}
