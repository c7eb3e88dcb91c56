//! Hierarchies of boxes in the order in which a shader walks them without a stack.

use crate::{bvh, shader::shader_struct};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::{Boundable, BvhBuildParams};
use umbrage_core::glam::Vec3;

shader_struct! {
    /// A node, see `light_mask.wgsl`.
    pub(crate) struct TreeNode {
        low: [f32; 3],
        next: u32,
        high: [f32; 3],
        leaf: u32,
    }
}

/// Leaves have so many things at most; their number takes the low bits of `TreeNode::leaf`.
const LEAF_BITS: u32 = 8;

impl TreeNode {
    /// The node where its tree starts at node `first` and its things at number `thing`.
    pub fn moved(&self, first: u32, thing: u32) -> Self {
        let is_leaf = self.leaf & ((1 << LEAF_BITS) - 1) > 0;
        let leaf = if is_leaf { self.leaf + (thing << LEAF_BITS) } else { self.leaf };
        Self { next: self.next + first, leaf, ..*self }
    }
}

/// A box around one thing.
pub(super) struct Boxed(pub Vec3, pub Vec3);

impl Boundable for Boxed {
    fn aabb(&self) -> Aabb {
        // Through arrays: the crate may have another version of `glam` than we have.
        Aabb::new(self.0.to_array().into(), self.1.to_array().into())
    }
}

/// Appends the tree over `boxes` to `nodes`, depth first, and the order of things to `order`.
/// Numbers of things in leaves count from `order`'s length before.
pub(super) fn append(boxes: &[Boxed], nodes: &mut Vec<TreeNode>, order: &mut Vec<u32>) {
    if boxes.is_empty() {
        return;
    }
    let tree = bvh::build(boxes, BvhBuildParams::medium_build());
    let first = order.len() as u32;
    order.extend(&tree.primitive_indices);
    lay_out(&tree, first, nodes);
}

fn lay_out(tree: &Bvh2, first: u32, nodes: &mut Vec<TreeNode>) {
    // Nodes of the tree still to be laid out; `None` closes the node at that place.
    let mut open = vec![(0, None)];
    while let Some((number, close)) = open.pop() {
        if let Some(place) = close {
            let place: usize = place;
            nodes[place].next = nodes.len() as u32;
            continue;
        }
        let node = tree.nodes[number as usize];
        let place = nodes.len();
        let leaf = if node.is_leaf() { (first + node.first_index) << LEAF_BITS | node.prim_count.min(255) } else { 0 };
        nodes.push(TreeNode { low: node.min.to_array(), next: 0, high: node.max.to_array(), leaf });
        open.push((0, Some(place)));
        if !node.is_leaf() {
            open.push((node.first_index + 1, None));
            open.push((node.first_index, None));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_without_a_stack_comes_to_every_thing_once() {
        let boxes: Vec<Boxed> = (0..100)
            .map(|i| Vec3::new((i * 37 % 100) as f32, (i * 11 % 17) as f32, i as f32))
            .map(|p| Boxed(p, p + 0.5))
            .collect();
        let (mut nodes, mut order) = (vec![TreeNode::default(); 3], vec![7; 5]);
        append(&boxes, &mut nodes, &mut order);
        let (mut at, mut seen) = (3, Vec::new());
        while at < nodes.len() {
            let leaf = nodes[at].leaf;
            let count = leaf & 255;
            seen.extend((0..count).map(|i| order[((leaf >> LEAF_BITS) + i) as usize]));
            assert!(nodes[at].next as usize > at);
            at = if count > 0 { nodes[at].next as usize } else { at + 1 };
        }
        seen.sort_unstable();
        assert_eq!(seen, (0..100).collect::<Vec<u32>>());
        let root = nodes[3];
        assert_eq!(root.next as usize, nodes.len());
        append(&[], &mut nodes, &mut order);
        assert_eq!(root.next as usize, nodes.len());
    }
}
