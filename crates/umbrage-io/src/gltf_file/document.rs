//! The JSON of a glTF file, with everything checked that the `gltf` crate takes for granted.

use super::File;
use crate::error::{self, Error};
use crate::text;
use gltf::json::validation::{self, Validate};
use gltf::json::{Root, Value};
use gltf::{Document, json};

/// Extensions that are read. A file that requires one of these can be shown.
const READ: [&str; 5] = [
    "KHR_lights_punctual",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// Extensions that change only how a surface shines: they are left out, and no note says so.
const SHINE: [&str; 9] = [
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_unlit",
];

/// Extensions about which materials speak themselves, where they matter.
const NOTED: [&str; 3] = ["KHR_materials_transmission", "KHR_materials_diffuse_transmission", "KHR_materials_volume"];

/// What helps against an extension that is not read.
pub(super) fn remedy(extension: &str) -> &'static str {
    match extension {
        "KHR_draco_mesh_compression" => "export it without Draco compression",
        "EXT_meshopt_compression" | "KHR_meshopt_compression" => "export it without meshopt compression",
        "KHR_texture_basisu" | "EXT_texture_webp" | "EXT_texture_avif" | "MSFT_texture_dds" => {
            "export it with PNG or JPEG pictures"
        }
        "EXT_mesh_gpu_instancing" => "export it with a node for every instance",
        _ => "export it without this extension",
    }
}

/// The document, checked, and the binary part of a `.glb`.
pub(super) fn parse(file: &mut File<'_>, bytes: Vec<u8>) -> Result<(Document, Option<Vec<u8>>), Error> {
    let (mut value, blob) = match bytes.starts_with(b"glTF") {
        true => {
            let (json, blob) = unpack(file, &bytes)?;
            (json::deserialize::from_slice(json), blob.map(<[u8]>::to_vec))
        }
        false => (json::deserialize::from_str(&text::decode(file.path, bytes)?), None),
    };
    let value: &mut Value = value.as_mut().map_err(|e| damaged(file, format!("is not valid glTF: {e}")))?;
    leave_out_other_targets(file, value);
    let mut root: Root = serde_path_to_error::deserialize(value.take()).map_err(|e| {
        let what = format!("is not valid glTF: {}", e.inner());
        match e.path().iter().next() {
            None => damaged(file, what),
            Some(_) => file.error(e.path(), what),
        }
    })?;
    check_version(file, &root)?;
    check_extensions(file, &root)?;
    root.extensions_required.clear();
    make_safe_to_validate(file, &mut root)?;
    validate(file, &root)?;
    Ok((Document::from_json_without_validation(root), blob))
}

/// The checks of the `gltf` crate, without that for the bytes of accessors: they may have none, and
/// are zeros then, or are in an extension that is named where they are used.
fn validate(file: &File<'_>, root: &Root) -> Result<(), Error> {
    let mut first = None;
    root.validate(root, json::Path::new, &mut |path, what| {
        let place = path().to_string();
        let is_empty = what == validation::Error::Missing && place.starts_with("accessors[");
        if first.is_none() && !(is_empty && place.ends_with(".bufferView")) {
            first = Some((place, what));
        }
    });
    match first {
        None => Ok(()),
        Some((place, what)) => Err(file.error(place, format!("is not valid glTF: {what}"))),
    }
}

fn damaged(file: &File<'_>, what: String) -> Error {
    Error::new(file.path, what).remedy("the file may be cut off or damaged: export it again")
}

/// The JSON and the binary part of a `.glb`. Chunks of other kinds are skipped, as the
/// specification's section 4.4.3 has it.
fn unpack<'a>(file: &File<'_>, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), Error> {
    let word = |bytes: &[u8], at: usize| bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
    let (Some(version), Some(length)) = (word(bytes, 4), word(bytes, 8)) else {
        return Err(damaged(file, format!("is {} bytes long, and the header alone has 12", bytes.len())));
    };
    if version != 2 {
        return Err(damaged(file, format!("is a .glb of version {version}, not 2")));
    }
    // The length counts the header.
    if length < 12 || length as usize > bytes.len() {
        return Err(damaged(file, format!("says that it is {length} bytes long, and is {}", bytes.len())));
    }
    let mut rest = &bytes[12..length as usize];
    let mut chunks = Vec::new();
    while let (Some(size), Some(kind)) = (word(rest, 0), word(rest, 4)) {
        let Some(chunk) = rest[8..].get(..size as usize) else {
            return Err(damaged(file, format!("is cut off: a part of {size} bytes does not fit into it")));
        };
        chunks.push((kind.to_le_bytes(), chunk));
        rest = &rest[8 + size as usize..];
        // Parts are padded to four bytes, and their sizes should say so.
        rest = &rest[rest.len().min(size.next_multiple_of(4).wrapping_sub(size) as usize)..];
    }
    match chunks.as_slice() {
        [([b'J', b'S', b'O', b'N'], json), rest @ ..] => {
            let blob = rest.first().filter(|(kind, _)| kind == b"BIN\0");
            Ok((json, blob.map(|(_, chunk)| *chunk)))
        }
        _ => Err(damaged(file, "does not start with a part that is JSON".to_owned())),
    }
}

fn check_version(file: &File<'_>, root: &Root) -> Result<(), Error> {
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    match version.starts_with("2.") {
        true => Ok(()),
        false => Err(file.error("asset", format!("is glTF {version}, not 2.0")).remedy("export it as glTF 2.0")),
    }
}

fn check_extensions(file: &mut File<'_>, root: &Root) -> Result<(), Error> {
    let is_read = |name: &str| READ.contains(&name);
    let shines = |name: &str| SHINE.contains(&name);
    if let Some(required) = root.extensions_required.iter().find(|name| !is_read(name) && !shines(name)) {
        let what = format!("requires the extension `{}`, which cannot be read", error::line(required));
        return Err(Error::new(file.path, what).remedy(remedy(required)));
    }
    for name in root.extensions_used.iter().filter(|n| !is_read(n) && !shines(n) && !NOTED.contains(&n.as_str())) {
        file.note(format!("the extension `{name}` is not read and was left out"));
    }
    Ok(())
}

/// Takes out what animations move other than nodes' places, as `KHR_animation_pointer` does: the
/// crate knows no such target.
fn leave_out_other_targets(file: &mut File<'_>, root: &mut Value) {
    const MOVED: [&str; 4] = ["translation", "rotation", "scale", "weights"];
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        channels.retain(|channel| {
            let Some(target) = channel.get("target") else { return true };
            match (target.get("path").and_then(Value::as_str), target.get("node")) {
                (Some(path), Some(_)) if MOVED.contains(&path) => true,
                (Some(path), _) if !MOVED.contains(&path) => {
                    file.note(format!("animations of `{}` are not read", error::line(path)));
                    false
                }
                (Some(_), None) => {
                    file.note("animations of no node are not read");
                    false
                }
                _ => true,
            }
        });
    }
}

/// What the `gltf` crate takes for granted: it panics on accessors out of range, on animations of
/// nodes out of range and on cameras without their lens, and refuses positions without bounds,
/// which are not needed here.
fn make_safe_to_validate(file: &File<'_>, root: &mut Root) -> Result<(), Error> {
    let count = root.accessors.len();
    for (index, mesh) in root.meshes.iter().enumerate() {
        let mut accessors = mesh.primitives.iter().flat_map(|p| p.attributes.values());
        if let Some(accessor) = accessors.find(|accessor| accessor.value() >= count) {
            let what = format!("accessor {} is out of range: there are {count}", accessor.value());
            return Err(file.error(format!("mesh {index}"), what));
        }
    }
    let count = root.nodes.len();
    for (index, animation) in root.animations.iter().enumerate() {
        let out = |c: &&json::animation::Channel| c.target.node.value() >= count;
        if let Some(channel) = animation.channels.iter().find(out) {
            let what = format!("node {} is out of range: there are {count}", channel.target.node.value());
            return Err(file.error(format!("animation {index}"), what));
        }
    }
    for (index, camera) in root.cameras.iter().enumerate() {
        use json::camera::Type;
        use json::validation::Checked::Valid;
        let lens = match camera.type_ {
            Valid(Type::Perspective) => camera.perspective.is_some(),
            Valid(Type::Orthographic) => camera.orthographic.is_some(),
            _ => true,
        };
        if !lens {
            return Err(file.error(format!("camera {index}"), "has not the lens that its type names"));
        }
    }
    for accessor in &mut root.accessors {
        let bounds = Some(Value::from(vec![0.0; 3]));
        (accessor.min, accessor.max) = (bounds.clone(), bounds);
    }
    Ok(())
}
