//! glTF 2.0: `.gltf` with its files, and `.glb`.
//!
//! Read are nodes, meshes (triangles, strips, fans), skins, animations of nodes, base-colour and
//! roughness of materials, alpha masks with all that shapes them, perspective cameras and
//! `KHR_lights_punctual`. Whatever else changes the picture is noted; what a file requires and is
//! not read is an error. The `gltf` crate reads the JSON; bytes are read here, with every range
//! checked. (Source: Khronos, "glTF 2.0 specification", version 2.0.1.)

mod accessor;
mod animation;
mod appearance;
mod buffers;
mod document;
mod nodes;
mod primitive;
mod scenery;
mod skin;

use crate::error::{self, Error, Place, shown};
use crate::files::Files;
use crate::limits::MOST_INSTANCES;
use crate::model::{Hold, Model, Part};
use accessor::Accessors;
use appearance::Appearance;
use nodes::Nodes;
use std::collections::{BTreeSet, HashMap};
use std::fmt::Display;
use std::path::Path;
use umbrage_core::Mesh;

/// The file being read, for errors and notes.
struct File<'a> {
    path: &'a Path,
    /// Where those are that it names.
    files: Files<'a>,
    /// Sorted, each once.
    notes: BTreeSet<String>,
}

impl File<'_> {
    /// An error at a part of the file.
    fn error(&self, part: impl Display, what: impl Display) -> Error {
        Error::new(self.path, what).at(Place::Part(part.to_string())).remedy("mend it, or export the file again")
    }

    /// An error at a part of the file, from what is wrong with the file that it names.
    fn pass_on(&self, part: impl Display, error: &Error) -> Error {
        self.error(part, "names").passing_on(error)
    }

    fn note(&mut self, note: impl Display) {
        self.notes.insert(format!("{}: {}", shown(self.path), error::line(&note.to_string())));
    }
}

/// What a binary glTF says, looked over, and the numbers that come with it.
pub(crate) fn document(path: &Path, bytes: Vec<u8>) -> Result<(gltf::Document, Option<Vec<u8>>), Error> {
    document::parse(&mut File { path, files: Files::OnDisk, notes: BTreeSet::new() }, bytes)
}

/// Reads a glTF file and those it refers to.
pub(crate) fn read(files: Files<'_>, path: &Path) -> Result<Model, Error> {
    let mut file = File { path, files, notes: BTreeSet::new() };
    let (document, blob) = document::parse(&mut file, files.read(path)?)?;
    let buffers = buffers::read(&file, &document, blob)?;
    let accessors = Accessors::new(path, &buffers);
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
    // Primitives are shared by all nodes that show their mesh, on the same skin.
    let mut shared: HashMap<(usize, usize, Option<usize>), Option<usize>> = HashMap::new();

    for node in nodes.shown(&document) {
        let model_from_node = nodes.model_from_node(node.index());
        scenery::read_camera(&mut file, &mut model, &node, model_from_node);
        scenery::read_light(&mut file, &mut model, &node, model_from_node)?;
        let Some(mesh) = node.mesh() else { continue };
        let skin = node.skin().map(|skin| skin.index());
        if skin.is_none() && model_from_node.matrix3.determinant() == 0.0 {
            file.note(format!("node {} is scaled to nothing and was left out", node.index()));
            continue;
        }
        for primitive in mesh.primitives() {
            let key = (mesh.index(), primitive.index(), skin);
            let material = appearance.material(&mut file, &primitive.material())?;
            let index = match shared.get(&key) {
                Some(index) => *index,
                None => {
                    let read = primitive::read(&mut file, &accessors, &mesh, &primitive)?;
                    let index = match (read, skin) {
                        (None, _) => None,
                        (Some(mesh), None) => Some(add(&mut model, mesh)),
                        (Some(mut mesh), Some(skin)) => {
                            skin::read_weights(&file, &accessors, &model.rig.skins[skin], &primitive, &mut mesh)?;
                            skin::check_pose(&file, &mesh, &model.rig.joints_at(skin, None))?;
                            Some(add(&mut model, mesh))
                        }
                    };
                    shared.insert(key, index);
                    index
                }
            };
            let Some(mesh) = index else { continue };
            let hold = skin.map_or_else(|| Hold::Node(nodes.place(node.index())), Hold::Skin);
            model.parts.push(Part { mesh, material, hold });
            if model.parts.len() > MOST_INSTANCES {
                let what = format!("shows more than {MOST_INSTANCES} meshes");
                return Err(Error::new(path, what).remedy("join some of them, or export less"));
            }
        }
    }
    (model.materials, model.textures) = appearance.into_parts();
    model.notes.extend(file.notes);
    Ok(model)
}

fn add(model: &mut Model, mesh: Mesh) -> usize {
    model.meshes.push(mesh);
    model.meshes.len() - 1
}
