//! Upkeep of the boxes around what is in and below each node.
//!
//! Both ways stop at the first node that does not change, so a move costs a node or two unless it
//! is at the rim of everything.

use super::{Node, ROOT, SceneTree, grown_by_rounding};
use crate::bounds::Bounds;

impl SceneTree {
    /// The box around all objects that queries can find; empty without any.
    pub fn content(&self) -> Bounds {
        self.nodes[ROOT as usize].content
    }

    /// Has `node` and those above it hold an object that came.
    pub(super) fn grow_content(&mut self, mut node: u32, came: &Bounds) {
        loop {
            let within = &mut self.nodes[node as usize];
            let grown = within.content.union(*came);
            if grown == within.content {
                return;
            }
            within.content = grown;
            if node == ROOT {
                return;
            }
            node = within.parent;
        }
    }

    /// Shrinks the boxes of `node` and those above it to what is left after an object with this box
    /// went.
    pub(super) fn shrink_content(&mut self, mut node: u32, went: &Bounds) {
        let mut went = *went;
        loop {
            let before = self.nodes[node as usize].content;
            if is_within(&went, &before) {
                return;
            }
            let left = self.content_of(&self.nodes[node as usize]);
            self.nodes[node as usize].content = left;
            if node == ROOT || left == before {
                return;
            }
            (node, went) = (self.nodes[node as usize].parent, before);
        }
    }

    fn content_of(&self, node: &Node) -> Bounds {
        let below = self.occupied_children(node).map(|child| child.content);
        node.boxes.iter().copied().chain(below).fold(Bounds::EMPTY, Bounds::union)
    }
}

impl Node {
    /// The content, a little larger, so that rounding in a volume's test never parts an object from
    /// its node.
    pub(super) fn around_content(&self) -> Bounds {
        grown_by_rounding(self.content)
    }
}

/// True where a box reaches no face of the other from inside.
fn is_within(inner: &Bounds, outer: &Bounds) -> bool {
    inner.min.cmpgt(outer.min).all() && inner.max.cmplt(outer.max).all()
}
