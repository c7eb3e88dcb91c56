//! The tree of nodes and their transforms.

use super::File;
use crate::Error;
use crate::limits::LARGEST;
use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4, Vec4};
use gltf::scene::Transform;
use gltf::{Document, Node};
use umbrage_core::rig::{self, Local, Parts};

/// Where every node stands in the model.
pub(super) struct Nodes {
    /// Parents before children.
    pub rig: Vec<rig::Node>,
    /// The place of a node of the file in `rig`.
    place: Vec<usize>,
    model_from_node: Vec<DAffine3>,
}

impl Nodes {
    /// Computes all transforms, also of nodes that no scene shows: skins may use them.
    pub fn read(file: &File<'_>, document: &Document) -> Result<Self, Error> {
        let nodes: Vec<Node<'_>> = document.nodes().collect();
        let mut is_child = vec![false; nodes.len()];
        for child in nodes.iter().flat_map(Node::children) {
            if std::mem::replace(&mut is_child[child.index()], true) {
                return Err(file.error(format!("node {}", child.index()), "is the child of two nodes"));
            }
        }
        let mut places = vec![None; nodes.len()];
        let mut rig: Vec<rig::Node> = Vec::with_capacity(nodes.len());
        // A stack, since files may nest deeper than calls can.
        let roots = nodes.iter().filter(|n| !is_child[n.index()]);
        let mut stack: Vec<(Node<'_>, Option<usize>)> = roots.map(|n| (n.clone(), None)).collect();
        while let Some((node, parent)) = stack.pop() {
            let own = rig.len();
            rig.push(rig::Node { parent, local: local(file, &node)? });
            places[node.index()] = Some(own);
            stack.extend(node.children().map(|child| (child, Some(own))));
        }
        // Every node has at most one parent here, so what no root leads to goes around in circles.
        let reached = |(index, place): (usize, Option<usize>)| {
            place.ok_or_else(|| {
                file.error(format!("node {index}"), "is its own ancestor").remedy("take it out of its own children")
            })
        };
        let place = places.into_iter().enumerate().map(reached).collect::<Result<_, _>>()?;
        let model_from_node = rig::place(&rig, rig.iter().map(|n| n.local));
        Ok(Self { rig, place, model_from_node })
    }

    /// The place of a node of the file in the rig.
    pub fn place(&self, index: usize) -> usize {
        self.place[index]
    }

    /// Places what the node holds, at rest.
    pub fn model_from_node(&self, index: usize) -> DAffine3 {
        self.model_from_node[self.place[index]]
    }

    /// The nodes of the default scene, or else of the first one, or else all of them; parents
    /// before children.
    pub fn shown<'a>(&self, document: &'a Document) -> Vec<Node<'a>> {
        let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
            return document.nodes().collect();
        };
        let mut seen = vec![false; self.place.len()];
        let mut shown = Vec::new();
        let mut stack: Vec<Node<'a>> = scene.nodes().collect();
        stack.reverse();
        while let Some(node) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) || is_hidden(&node) {
                continue;
            }
            let below = stack.len();
            stack.extend(node.children());
            stack[below..].reverse();
            shown.push(node);
        }
        shown
    }
}

/// True where `KHR_node_visibility` hides a node with all below it.
fn is_hidden(node: &Node<'_>) -> bool {
    node.extension_value("KHR_node_visibility").and_then(|e| e.get("visible")) == Some(&false.into())
}

/// A node's own transform, checked.
fn local(file: &File<'_>, node: &Node<'_>) -> Result<Local, Error> {
    let columns = node.transform().matrix().map(Vec4::from);
    let finite = columns.iter().all(|c| c.is_finite() && f64::from(c.abs().max_element()) < LARGEST);
    let affine = columns.map(|c| c.w) == [0.0, 0.0, 0.0, 1.0];
    if !finite || !affine {
        let what = match finite {
            true => "its matrix is not affine: its last row is not 0, 0, 0, 1",
            false => "its transform is not finite or too large",
        };
        return Err(file.error(format!("node {}", node.index()), what));
    }
    Ok(match node.transform() {
        Transform::Matrix { .. } => {
            let [x, y, z, w] = columns.map(|c| c.as_dvec4());
            Local::Matrix(DAffine3::from_mat4(DMat4::from_cols(x, y, z, w)))
        }
        Transform::Decomposed { translation, rotation, scale } => {
            let rotation = DVec4::from_array(rotation.map(f64::from)).try_normalize();
            Local::Parts(Parts {
                translation: DVec3::from_array(translation.map(f64::from)),
                rotation: rotation.map_or(DQuat::IDENTITY, DQuat::from_vec4),
                scale: DVec3::from_array(scale.map(f64::from)),
            })
        }
    })
}
