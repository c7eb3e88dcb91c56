//! The objects in the order of the nodes, so that those in and below a node are one slice, and a
//! query takes them at once. Otherwise it would go to every node of what is wholly seen, most of it
//! memory that nobody has looked at since the last frame.

use super::{Node, ROOT, SceneTree};

/// All is put in order again when this share of the objects has come or gone since.
const CHANGED: usize = 4;

/// Where the objects in and below a node are in the order; `None` since one came or went. The
/// root's does not count: it is never taken whole.
pub(super) type Span = Option<[u32; 2]>;

impl SceneTree {
    /// Puts all objects in order, as the tree does by itself from time to time; worth a call when
    /// all of a scene has been added. Queries find the same before and after.
    pub fn put_in_order(&mut self) {
        self.order.clear();
        self.changes = 0;
        self.append(ROOT);
    }

    fn append(&mut self, node: u32) {
        let begin = self.order.len() as u32;
        let Node { children, occupied, objects, .. } = &self.nodes[node as usize];
        self.order.extend(objects);
        let (children, occupied) = (*children, *occupied);
        for octant in (0..8).filter(|octant| occupied >> octant & 1 == 1) {
            self.append(children[octant]);
        }
        self.nodes[node as usize].span = Some([begin, self.order.len() as u32]);
    }

    /// After an object entered or left `node`: neither that nor those above are a slice any more.
    pub(super) fn note_change(&mut self, mut node: u32) {
        self.changes += 1;
        if self.changes * CHANGED >= self.len {
            return self.put_in_order();
        }
        while node != ROOT {
            self.nodes[node as usize].span = None;
            node = self.nodes[node as usize].parent;
        }
    }

    /// Appends all objects in and below `node`.
    pub(super) fn gather_all(&self, node: &Node, found: &mut Vec<u32>) {
        if let Some([begin, end]) = node.span {
            found.extend(&self.order[begin as usize..end as usize]);
            return;
        }
        found.extend(&node.objects);
        self.occupied_children(node).for_each(|child| self.gather_all(child, found));
    }
}
