//! Rigs: what moves the vertices of a mesh. Nodes make a tree; a skin says which of them are joints
//! of a mesh; an animation moves nodes. Meanings are those of glTF (Khronos, "glTF 2.0
//! specification", version 2.0.1, sections 3.7.3 and 3.11).

mod animation;
mod weights;

pub use animation::{Animation, Channel, Interpolation, Property};
pub use weights::{Influence, JointBoxes, Weights};

use glam::{DAffine3, DQuat, DVec3};

/// The nodes, skins and animations of one model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// Parents before children.
    pub nodes: Vec<Node>,
    /// What meshes may hang on.
    pub skins: Vec<Skin>,
    /// Motions to choose from.
    pub animations: Vec<Animation>,
}

/// A node of a rig.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Index of the node that it moves with. One that does not stand before it counts as none.
    pub parent: Option<usize>,
    /// Where it is at rest.
    pub local: Local,
}

/// Takes a point from a node's space to that of its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Local {
    /// In parts, each of which an animation may replace.
    Parts(Parts),
    /// As one matrix, which no animation changes.
    Matrix(DAffine3),
}

/// Scale first, then rotation, then translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts {
    /// Metres, before the scale of the parent.
    pub translation: DVec3,
    /// Of unit length.
    pub rotation: DQuat,
    /// A factor for each axis.
    pub scale: DVec3,
}

impl Default for Parts {
    fn default() -> Self {
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE }
    }
}

/// The joints of a mesh; its [`Weights`] go by their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Each a node and what takes a vertex, as it was bound, to that node's space.
    pub joints: Vec<Joint>,
}

/// See [`Skin`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Index into [`Rig::nodes`]. One that is not there stands at the model's origin.
    pub node: usize,
    /// The inverse bind matrix.
    pub node_from_mesh: DAffine3,
}

/// A moment of an animation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Index into [`Rig::animations`].
    pub animation: usize,
    /// Seconds from its start; see [`Animation::within`] for times beyond its ends.
    pub time_s: f64,
}

impl Rig {
    /// Where every node is at a moment: matrices from its space to that of the model. Without a
    /// moment, or with that of an animation that is not there, the rig is at rest.
    pub fn nodes_at(&self, moment: Option<Moment>) -> Vec<DAffine3> {
        let mut local: Vec<Local> = self.nodes.iter().map(|n| n.local).collect();
        if let Some(moment) = moment
            && let Some(animation) = self.animations.get(moment.animation)
        {
            animation.pose(moment.time_s, &mut local);
        }
        place(&self.nodes, local)
    }

    /// What each joint of a skin does to a vertex of the mesh as it was bound, at a moment or at
    /// rest. Empty for a skin that is not there.
    pub fn joints_at(&self, skin: usize, moment: Option<Moment>) -> Vec<DAffine3> {
        let nodes = self.nodes_at(moment);
        let joints = self.skins.get(skin).map_or(&[][..], |s| &s.joints);
        let place = |j: &Joint| nodes.get(j.node).copied().unwrap_or(DAffine3::IDENTITY) * j.node_from_mesh;
        joints.iter().map(place).collect()
    }
}

/// Matrices that take a point from the space of each node to that of the model, the nodes standing
/// to their parents as `local` says.
pub fn place(nodes: &[Node], local: impl IntoIterator<Item = Local>) -> Vec<DAffine3> {
    let mut placed: Vec<DAffine3> = Vec::with_capacity(nodes.len());
    for (node, local) in nodes.iter().zip(local) {
        let parent = node.parent.and_then(|p| placed.get(p)).copied().unwrap_or(DAffine3::IDENTITY);
        placed.push(parent * local.matrix());
    }
    placed
}

impl Local {
    /// As a matrix.
    pub fn matrix(&self) -> DAffine3 {
        match self {
            Self::Matrix(matrix) => *matrix,
            Self::Parts(p) => DAffine3::from_scale_rotation_translation(p.scale, p.rotation, p.translation),
        }
    }
}

#[cfg(test)]
mod tests;
