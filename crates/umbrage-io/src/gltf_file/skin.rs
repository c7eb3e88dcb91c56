//! Skins: which nodes are the joints of a mesh, and which of them hold each of its vertices.

use super::File;
use super::accessor::Accessors;
use super::nodes::Nodes;
use crate::Error;
use crate::model::is_usable;
use glam::{DAffine3, DMat4};
use gltf::Semantic;
use umbrage_core::Mesh;
use umbrage_core::rig::{Influence, Joint, Skin};

/// The joints of a skin. The transform of the node that shows the mesh does not count (the
/// specification's section 3.7.3.3).
pub(super) fn read(
    file: &File<'_>,
    accessors: &Accessors<'_>,
    nodes: &Nodes,
    skin: &gltf::Skin<'_>,
) -> Result<Skin, Error> {
    let joints: Vec<usize> = skin.joints().map(|joint| nodes.place(joint.index())).collect();
    let inverse = match skin.inverse_bind_matrices() {
        Some(inverse) => accessors.floats::<16>(&inverse)?,
        None => vec![DMat4::IDENTITY.as_mat4().to_cols_array(); joints.len()],
    };
    let part = || format!("skin {}", skin.index());
    if inverse.len() < joints.len() {
        let what = format!("has {} inverse bind matrices for {} joints", inverse.len(), joints.len());
        return Err(file.error(part(), what));
    }
    if inverse.as_flattened().iter().any(|number| !number.is_finite()) {
        return Err(file.error(part(), "has an inverse bind matrix that is not finite"));
    }
    let bound = |m: [f32; 16]| DAffine3::from_mat4(DMat4::from_cols_array(&m.map(f64::from)));
    let joint = |(node, m): (usize, [f32; 16])| Joint { node, node_from_mesh: bound(m) };
    Ok(Skin { joints: joints.into_iter().zip(inverse).map(joint).collect() })
}

/// Reads which joints hold each vertex of a mesh that hangs on `skin`, all sets of them.
pub(super) fn read_weights(
    file: &File<'_>,
    accessors: &Accessors<'_>,
    skin: &Skin,
    primitive: &gltf::Primitive<'_>,
    mesh: &mut Mesh,
) -> Result<(), Error> {
    let mut vertices: Vec<Vec<Influence>> = vec![Vec::new(); mesh.positions.len()];
    for set in 0.. {
        let (Some(j), Some(w)) = (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set))) else {
            break;
        };
        let (j, w) = (accessors.integers::<4>(&j)?, accessors.floats::<4>(&w)?);
        if j.len() != vertices.len() || w.len() != vertices.len() {
            return Err(file.error(&mesh.name, "has joints and weights for another number of vertices"));
        }
        for ((vertex, j), w) in vertices.iter_mut().zip(j).zip(w) {
            let influences = j.into_iter().zip(w).map(|(joint, weight)| Influence { joint, weight });
            vertex.extend(influences.filter(|i| i.weight != 0.0));
        }
    }
    let count = skin.joints.len();
    if let Some(out) = vertices.iter().flatten().find(|i| i.joint as usize >= count) {
        let what = format!("joint {} is out of range: there are {count}", out.joint);
        return Err(file.error(&mesh.name, what));
    }
    vertices.iter().for_each(|influences| mesh.weights.push(influences));
    Ok(())
}

/// Finds a vertex that its joints take where nothing can be worked with.
pub(super) fn check_pose(file: &File<'_>, mesh: &Mesh, joints: &[DAffine3]) -> Result<(), Error> {
    let posed = mesh.posed(joints).positions;
    match posed.iter().position(|p| !is_usable(*p)) {
        None => Ok(()),
        Some(vertex) => {
            let what = format!("moves vertex {vertex} to {}, which is not finite or too far", posed[vertex]);
            Err(file.error(format!("the skin of {}", mesh.name), what))
        }
    }
}
