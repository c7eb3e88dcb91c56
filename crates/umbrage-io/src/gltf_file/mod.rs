//! glTF 2.0: `.gltf` with its files, and `.glb`.
//!
//! Read are nodes, meshes (triangles, strips, fans), skins, animations of nodes, base-colour and
//! roughness of materials, alpha masks, perspective cameras and `KHR_lights_punctual`. Whatever
//! else changes the picture is noted. The `gltf` crate reads and validates the JSON; bytes are read
//! here, with every range checked. (Source: Khronos, "glTF 2.0 specification", version 2.0.1.)

mod accessor;
mod animation;
mod appearance;
mod buffers;
mod nodes;
mod primitive;
mod scenery;
mod skin;

use crate::error::{self, Error, Place};
use crate::model::{Hold, Model, Part};
use accessor::Accessors;
use appearance::Appearance;
use gltf::{Document, Gltf};
use nodes::Nodes;
use std::collections::{BTreeSet, HashMap};
use std::fmt::Display;
use std::path::Path;

/// Extensions that only tell how data are stored or seen: a file that requires them can be shown
/// without.
const HARMLESS: [&str; 3] = ["KHR_lights_punctual", "KHR_mesh_quantization", "KHR_texture_transform"];

/// The file being read, for errors and notes.
struct File<'a> {
    path: &'a Path,
    /// Sorted, each once.
    notes: BTreeSet<String>,
}

impl File<'_> {
    /// An error at a part of the file.
    fn error(&self, part: impl Display, what: impl Display) -> Error {
        Error::new(self.path, what).at(Place::Part(part.to_string()))
    }

    fn note(&mut self, note: impl Display) {
        self.notes.insert(format!("{}: {note}", self.path.display()));
    }
}

/// Reads a glTF file and those it refers to.
pub(crate) fn read(path: &Path) -> Result<Model, Error> {
    let mut file = File { path, notes: BTreeSet::new() };
    let (document, blob) = parse(&mut file, &error::read(path)?)?;
    let buffers = buffers::read(&file, &document, blob)?;
    let accessors = Accessors { path, buffers: &buffers };
    let nodes = Nodes::read(&file, &document)?;
    let mut appearance = Appearance::new(&document, &buffers);
    let mut model = Model::default();
    model.rig.nodes.clone_from(&nodes.rig);
    for skin in document.skins() {
        model.rig.skins.push(skin::read(&file, &accessors, &nodes, &skin)?);
    }
    for animation in document.animations() {
        model.rig.animations.push(animation::read(&mut file, &accessors, &nodes, &animation)?);
    }
    // Primitives without a skin are shared by all nodes that show their mesh.
    let mut shared: HashMap<(usize, usize), Option<usize>> = HashMap::new();

    for node in nodes.shown(&document) {
        let model_from_node = nodes.model_from_node(node.index());
        scenery::read_camera(&mut file, &mut model, &node, model_from_node);
        scenery::read_light(&mut file, &mut model, &node, model_from_node)?;
        let Some(mesh) = node.mesh() else { continue };
        if node.skin().is_none() && model_from_node.matrix3.determinant() == 0.0 {
            file.note(format!("node {} is scaled to nothing and was left out", node.index()));
            continue;
        }
        for primitive in mesh.primitives() {
            let material = appearance.material(&mut file, &primitive.material())?;
            let uv_set = appearance::uv_set(&primitive.material());
            let key = (mesh.index(), primitive.index());
            let read = |file: &mut File<'_>| primitive::read(file, &accessors, &mesh, &primitive, uv_set);
            let (mesh, hold) = match node.skin() {
                Some(skin) => {
                    let Some(mut skinned) = read(&mut file)? else { continue };
                    skin::read_weights(&file, &accessors, &model.rig.skins[skin.index()], &primitive, &mut skinned)?;
                    skin::check_pose(&file, &skinned, &model.rig.joints_at(skin.index(), None))?;
                    model.meshes.push(skinned);
                    (model.meshes.len() - 1, Hold::Skin(skin.index()))
                }
                None => {
                    let index = match shared.get(&key) {
                        Some(index) => *index,
                        None => {
                            let index = read(&mut file)?.map(|mesh| {
                                model.meshes.push(mesh);
                                model.meshes.len() - 1
                            });
                            shared.insert(key, index);
                            index
                        }
                    };
                    let Some(index) = index else { continue };
                    (index, Hold::Node(nodes.place(node.index())))
                }
            };
            model.parts.push(Part { mesh, material, hold });
        }
    }
    (model.materials, model.textures) = appearance.into_parts();
    model.notes.extend(file.notes);
    Ok(model)
}

/// The document, validated, and the binary part of a `.glb`.
fn parse(file: &mut File<'_>, bytes: &[u8]) -> Result<(Document, Option<Vec<u8>>), Error> {
    let damaged =
        |what: String| Error::new(file.path, what).remedy("the file may be cut off or damaged: export it again");
    // The length in the header counts the header of 12 bytes.
    if bytes.starts_with(b"glTF") {
        let Some(length) = bytes.get(8..12).and_then(|l| l.try_into().ok()).map(u32::from_le_bytes) else {
            return Err(damaged(format!("is {} bytes long, and the header alone has 12", bytes.len())));
        };
        if length < 12 || length as usize > bytes.len() {
            return Err(damaged(format!("says that it is {length} bytes long, and is {}", bytes.len())));
        }
    }
    let gltf = Gltf::from_slice_without_validation(bytes).map_err(|e| damaged(format!("is not valid glTF: {e}")))?;
    let mut root = gltf.document.into_json();
    let version = root.asset.min_version.as_ref().unwrap_or(&root.asset.version);
    if !version.starts_with("2.") {
        return Err(file.error("asset", format!("is glTF {version}, not 2.0")).remedy("export it as glTF 2.0"));
    }
    let harmless = |name: &String| HARMLESS.contains(&name.as_str()) || name.starts_with("KHR_materials_");
    if let Some(required) = root.extensions_required.iter().find(|name| !harmless(name)) {
        return Err(Error::new(file.path, format!("requires the extension `{required}`, which cannot be read"))
            .remedy("export it without this extension"));
    }
    root.extensions_required.clear();
    make_safe_to_validate(file, &mut root)?;
    let document = Document::from_json(root).map_err(|e| match e {
        gltf::Error::Validation(errors) => match errors.first() {
            Some((path, what)) => file.error(path, format!("is not valid glTF: {what}")),
            None => damaged("is not valid glTF".to_owned()),
        },
        other => damaged(format!("is not valid glTF: {other}")),
    })?;
    for name in document.extensions_used() {
        if name != "KHR_lights_punctual" && name != "KHR_mesh_quantization" && !name.starts_with("KHR_materials_") {
            file.note(format!("the extension `{name}` is not read and was left out"));
        }
    }
    Ok((document, gltf.blob))
}

/// The `gltf` crate refuses positions without bounds, which are not needed here, and panics on
/// those out of range.
fn make_safe_to_validate(file: &File<'_>, root: &mut gltf::json::Root) -> Result<(), Error> {
    let count = root.accessors.len();
    for (index, mesh) in root.meshes.iter().enumerate() {
        let mut accessors = mesh.primitives.iter().flat_map(|p| p.attributes.values());
        if let Some(accessor) = accessors.find(|accessor| accessor.value() >= count) {
            let what = format!("accessor {} is out of range: there are {count}", accessor.value());
            return Err(file.error(format!("mesh {index}"), what));
        }
    }
    for accessor in &mut root.accessors {
        let bounds = Some(gltf::json::Value::from(vec![0.0; 3]));
        (accessor.min, accessor.max) = (bounds.clone(), bounds);
    }
    Ok(())
}
