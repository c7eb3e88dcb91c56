//! A few boxes that stand for many objects.

use super::{Node, ROOT, SceneTree};
use crate::{
    bounds::Bounds,
    volume::{Side, Volume},
};
use std::collections::VecDeque;

impl SceneTree {
    /// Appends at most `most` boxes (at least one where there is anything) that together hold each
    /// object whose box `volume` may touch: the objects' own boxes where they are few enough, else
    /// boxes around what is in a part of the space, the smaller the more there may be. Work goes by
    /// `most` and what is at the border, not by the number of objects.
    pub fn cut(&self, volume: &impl Volume, most: usize, boxes: &mut Vec<Bounds>) {
        let root = &self.nodes[ROOT as usize];
        if volume.side(&root.around_content()) == Side::Outside {
            return;
        }
        let end = boxes.len() + most;
        // Breadth first: the largest nodes are opened first.
        let mut closed = VecDeque::from([root]);
        while let Some(node) = closed.pop_front() {
            let room = end.saturating_sub(boxes.len() + closed.len());
            let within = node.objects.len() + node.occupied.count_ones() as usize;
            if within > room {
                boxes.push(node.content);
            } else {
                self.open(node, volume, &mut closed, boxes);
            }
        }
    }

    fn open<'a>(
        &'a self,
        node: &'a Node,
        volume: &impl Volume,
        closed: &mut VecDeque<&'a Node>,
        boxes: &mut Vec<Bounds>,
    ) {
        boxes.extend(node.boxes.iter().copied().filter(|b| volume.may_touch(b)));
        closed.extend(self.occupied_children(node).filter(|child| volume.may_touch(&child.around_content())));
    }
}
