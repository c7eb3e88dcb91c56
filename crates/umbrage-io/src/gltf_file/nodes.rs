//! The tree of nodes and their transforms.

use super::File;
use crate::Error;
use glam::{DAffine3, DMat4, Vec4};
use gltf::{Document, Node};

/// Where every node stands in the model.
pub(super) struct Nodes {
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
        let mut transforms = vec![None; nodes.len()];
        // A stack, since files may nest deeper than calls can.
        let roots = nodes.iter().filter(|n| !is_child[n.index()]);
        let mut stack: Vec<(Node<'_>, DAffine3)> = roots.map(|n| (n.clone(), DAffine3::IDENTITY)).collect();
        while let Some((node, model_from_parent)) = stack.pop() {
            let model_from_node = model_from_parent * transform(file, &node)?;
            transforms[node.index()] = Some(model_from_node);
            stack.extend(node.children().map(|child| (child, model_from_node)));
        }
        // Every node has at most one parent here, so what no root leads to goes around in circles.
        let reached = |(index, transform): (usize, Option<DAffine3>)| {
            transform.ok_or_else(|| {
                file.error(format!("node {index}"), "is its own ancestor").remedy("take it out of its own children")
            })
        };
        let model_from_node = transforms.into_iter().enumerate().map(reached).collect::<Result<_, _>>()?;
        Ok(Self { model_from_node })
    }

    /// Places what the node holds.
    pub fn model_from_node(&self, index: usize) -> DAffine3 {
        self.model_from_node[index]
    }

    /// The nodes of the default scene, or else of the first one, or else all of them; parents before children.
    pub fn shown<'a>(&self, document: &'a Document) -> Vec<Node<'a>> {
        let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
            return document.nodes().collect();
        };
        let mut seen = vec![false; self.model_from_node.len()];
        let mut shown = Vec::new();
        let mut stack: Vec<Node<'a>> = scene.nodes().collect();
        stack.reverse();
        while let Some(node) = stack.pop() {
            if std::mem::replace(&mut seen[node.index()], true) {
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

/// A node's own transform, checked.
fn transform(file: &File<'_>, node: &Node<'_>) -> Result<DAffine3, Error> {
    let columns = node.transform().matrix().map(Vec4::from);
    let finite = columns.iter().all(|c| c.is_finite() && c.abs().max_element() < 1e15);
    let affine = columns.map(|c| c.w) == [0.0, 0.0, 0.0, 1.0];
    if !finite || !affine {
        let what = if finite { "its matrix is not affine" } else { "its transform is not finite" };
        return Err(file.error(format!("node {}", node.index()), what));
    }
    let [x, y, z, w] = columns.map(|c| c.as_dvec4());
    Ok(DAffine3::from_mat4(DMat4::from_cols(x, y, z, w)))
}
