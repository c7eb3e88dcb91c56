//! Skins: meshes that follow joints, shown in the pose that the nodes stand in.

use super::File;
use super::accessor::Accessors;
use super::nodes::Nodes;
use crate::Error;
use crate::model::is_usable;
use glam::{DAffine3, DMat3, DMat4, DVec3};
use gltf::{Semantic, Skin};
use umbrage_core::Mesh;

/// Moves the vertices to where their joints hold them, in the space of the model; the node's own transform does not
/// count (the specification's section 3.7.3.3).
pub(super) fn apply(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    nodes: &Nodes,
    skin: &Skin<'_>,
    primitive: &gltf::Primitive<'_>,
    mesh: &mut Mesh,
) -> Result<(), Error> {
    let part = format!("skin {}, {}", skin.index(), mesh.name);
    let joints = joint_transforms(file, accessors, nodes, skin)?;
    let mut blends = vec![(DAffine3::from_mat3(DMat3::ZERO), 0.0); mesh.positions.len()];
    for set in 0.. {
        let (Some(j), Some(w)) = (primitive.get(&Semantic::Joints(set)), primitive.get(&Semantic::Weights(set))) else {
            break;
        };
        let (j, w) = (accessors.integers::<4>(&j)?, accessors.floats::<4>(&w)?);
        if j.len() != blends.len() || w.len() != blends.len() {
            return Err(file.error(part, "has joints and weights for another number of vertices"));
        }
        for ((blend, j), w) in blends.iter_mut().zip(j).zip(w) {
            for (joint, weight) in j.into_iter().zip(w).filter(|(_, weight)| *weight != 0.0) {
                let Some(transform) = joints.get(joint as usize) else {
                    let what = format!("joint {joint} is out of range: there are {}", joints.len());
                    return Err(file.error(part, what));
                };
                add_scaled(&mut blend.0, transform, f64::from(weight));
                blend.1 += f64::from(weight);
            }
        }
    }
    file.note("skinned meshes are shown in their rest pose");
    for (vertex, (mut blend, weight)) in blends.into_iter().enumerate() {
        // Without weights there is no joint to follow: the vertex stays.
        if weight != 0.0 {
            let sum = std::mem::replace(&mut blend, DAffine3::from_mat3(DMat3::ZERO));
            add_scaled(&mut blend, &sum, 1.0 / weight);
        } else {
            blend = DAffine3::IDENTITY;
        }
        let position = blend.transform_point3(mesh.positions[vertex].as_dvec3()).as_vec3();
        if !is_usable(position) {
            return Err(
                file.error(part, format!("moves vertex {vertex} to {position}, which is not finite or too far"))
            );
        }
        mesh.positions[vertex] = position;
        let normal = normal_matrix(&blend.matrix3) * mesh.normals[vertex].as_dvec3();
        mesh.normals[vertex] = normal.try_normalize().unwrap_or(DVec3::Y).as_vec3();
    }
    Ok(())
}

/// What each joint does to a vertex of the mesh as it was bound.
fn joint_transforms(
    file: &File<'_>,
    accessors: &Accessors<'_>,
    nodes: &Nodes,
    skin: &Skin<'_>,
) -> Result<Vec<DAffine3>, Error> {
    let joints: Vec<DAffine3> = skin.joints().map(|joint| nodes.model_from_node(joint.index())).collect();
    let Some(inverse) = skin.inverse_bind_matrices() else { return Ok(joints) };
    let inverse = accessors.floats::<16>(&inverse)?;
    if inverse.len() < joints.len() {
        let what = format!("has {} inverse bind matrices for {} joints", inverse.len(), joints.len());
        return Err(file.error(format!("skin {}", skin.index()), what));
    }
    let bound = |m: [f32; 16]| DAffine3::from_mat4(DMat4::from_cols_array(&m.map(f64::from)));
    Ok(joints.into_iter().zip(inverse).map(|(joint, m)| joint * bound(m)).collect())
}

fn add_scaled(sum: &mut DAffine3, transform: &DAffine3, weight: f64) {
    sum.matrix3 += transform.matrix3 * weight;
    sum.translation += transform.translation * weight;
}

/// The matrix for normals, up to a positive factor: the cofactors, which exist also where there is no inverse.
fn normal_matrix(m: &DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * m.determinant().signum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_stay_perpendicular_when_stretched_and_mirrored() {
        let m = DMat3::from_diagonal(DVec3::new(3.0, -1.0, 0.5)) * DMat3::from_rotation_z(0.4);
        let (along, normal) = (DVec3::new(1.0, 1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0));
        let moved = normal_matrix(&m) * normal;
        assert!((m * along).dot(moved).abs() < 1e-12 && (m * normal).dot(moved) > 0.0);
    }
}
