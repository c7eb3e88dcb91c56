//! A tree of the objects of a scene that lets them move without being rebuilt (PX 5.3).
//!
//! The thesis splits the scene in four, and an object across a split stays in the large node above
//! it, however small it is. This tree is a *loose* octree (Ulrich, "Loose Octrees", Game
//! Programming Gems, 2000): an object belongs to the cell that its centre is in, of the smallest
//! size that is not below twice its own, and a node's box is its cell grown to twice the size. So
//! an object on a split is stored as deep as any other, and one that moves to and fro across it
//! stays where it is. Twice, since a query's time goes into reaching nodes, not into testing the
//! boxes in one: with as many nodes as objects it takes twice as long.
//!
//! Each node also knows the box around what is in and below it, its *content*: queries and cuts go
//! by that.

mod content;
mod cut;
mod order;

use crate::bounds::Bounds;
use glam::DVec3;

pub use crate::volume::{Side, Sphere, Volume};

/// The objects of a scene by place. Objects are numbers that the caller chooses, dense from 0.
///
/// Nodes are made when first needed and stay, so removing an object changes its own node and no
/// other's structure.
#[derive(Clone, Debug)]
pub struct SceneTree {
    /// The root first.
    nodes: Vec<Node>,
    /// By the number of the object.
    entries: Vec<Option<Entry>>,
    len: usize,
    /// The objects in the order of the nodes, as far as these have a span in it.
    order: Vec<u32>,
    /// How often one came or went since that was made.
    changes: usize,
}

#[derive(Clone, Debug)]
struct Node {
    /// Middle of the cell, a cube.
    center: DVec3,
    /// Half the edge of the cell.
    half: f64,
    /// What the node's objects are within: the loose cell. Not so for the root, which holds what
    /// fits nowhere.
    bounds: Bounds,
    /// Around the boxes of the objects in and below the node.
    content: Bounds,
    depth: u32,
    parent: u32,
    /// This node's place in its parent.
    octant: usize,
    /// 0, the root, stands for none.
    children: [u32; 8],
    /// Bit i: there are objects in or below child i.
    occupied: u8,
    objects: Vec<u32>,
    /// Their boxes, here too since queries go through them in order.
    boxes: Vec<Bounds>,
    span: order::Span,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    bounds: Bounds,
    /// None for a box that can't be found.
    place: Option<Place>,
}

/// The handle by which an object is removed.
#[derive(Clone, Copy, Debug)]
struct Place {
    node: u32,
    index: usize,
}

const ROOT: u32 = 0;

/// 256 cells along an edge: in a scene of a kilometre, leaves of four metres. The thesis has leaves
/// of five.
const DEPTH_LIMIT: u32 = 8;

/// A cell is at least so many times as large as what it holds.
const ROOMY: f64 = 2.0;

/// Boxes of nodes are larger by this share of their coordinates, so that rounding, in the middles
/// of cells or in a volume's test, never parts an object from its node.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl SceneTree {
    /// A tree for objects in about this box; others are found too, but each is tested in every
    /// query. An empty box stands for the metre around the origin.
    pub fn new(bounds: Bounds) -> Self {
        let (center, half) = middle_and_half(&bounds);
        let usable = can_be_found(&bounds) && center.is_finite() && half > 0.0 && half.is_finite();
        let (center, half) = if usable { (center, half) } else { (bounds.center(), 0.5) };
        let center = if center.is_finite() { center } else { DVec3::ZERO };
        let nodes = vec![Node::new(center, half, 0, ROOT, 0)];
        Self { nodes, entries: Vec::new(), len: 0, order: Vec::new(), changes: 0 }
    }

    /// Adds `object`, or moves it where it is known. One with an empty box, or one that is not
    /// finite, is kept but no query finds it.
    pub fn insert(&mut self, object: u32, bounds: Bounds) {
        self.remove(object);
        let index = object as usize;
        if index >= self.entries.len() {
            self.entries.resize(index + 1, None);
        }
        let place = can_be_found(&bounds).then(|| {
            let node = self.home(&bounds);
            self.grow_content(node, &bounds);
            self.enter(node, object, bounds)
        });
        self.entries[index] = Some(Entry { bounds, place });
        self.len += 1;
        if let Some(place) = place {
            self.note_change(place.node);
        }
    }

    /// Takes `object` out by its handle, without a search; an unknown number is no error.
    pub fn remove(&mut self, object: u32) {
        let Some(entry) = self.entries.get_mut(object as usize).and_then(Option::take) else { return };
        self.len -= 1;
        let Some(place) = entry.place else { return };
        let node = &mut self.nodes[place.node as usize];
        node.objects.swap_remove(place.index);
        node.boxes.swap_remove(place.index);
        if let Some(moved) = node.objects.get(place.index)
            && let Some(entry) = &mut self.entries[*moved as usize]
        {
            entry.place = Some(place);
        }
        self.leave(place.node);
        self.shrink_content(place.node, &entry.bounds);
        self.note_change(place.node);
    }

    /// Moves `object`: no more than storing its box where it still fits its node and would fit no
    /// smaller one. An unknown number is added.
    pub fn update(&mut self, object: u32, bounds: Bounds) {
        let entry = self.entries.get(object as usize).copied().flatten();
        match entry {
            Some(Entry { place: Some(place), bounds: before })
                if can_be_found(&bounds) && self.stays(place.node, &bounds) =>
            {
                self.entries[object as usize] = Some(Entry { bounds, place: Some(place) });
                self.nodes[place.node as usize].boxes[place.index] = bounds;
                self.grow_content(place.node, &bounds);
                self.shrink_content(place.node, &before);
            }
            _ => self.insert(object, bounds),
        }
    }

    /// The box that `object` was last given; `None` for an unknown number.
    pub fn bounds(&self, object: u32) -> Option<Bounds> {
        self.entries.get(object as usize).copied().flatten().map(|e| e.bounds)
    }

    /// How many objects are known, those without a box to be found by among them.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True where no object is known.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Appends the objects whose boxes `volume` may touch, in an order that depends on nothing but
    /// the calls before.
    pub fn query(&self, volume: &impl Volume, found: &mut Vec<u32>) {
        // The root holds what is outside its own box too: it is never skipped nor taken whole.
        self.gather_touched(&self.nodes[ROOT as usize], volume, !0, found);
    }

    /// `cutting`: see [`Volume::side_within`].
    fn gather_touched(&self, node: &Node, volume: &impl Volume, cutting: u64, found: &mut Vec<u32>) {
        let objects = node.objects.iter().zip(&node.boxes);
        found.extend(objects.filter(|(_, bounds)| volume.may_touch_within(bounds, cutting)).map(|(object, _)| *object));
        for child in self.occupied_children(node) {
            let mut cutting = cutting;
            match volume.side_within(&child.around_content(), &mut cutting) {
                Side::Outside => {}
                Side::Partly => self.gather_touched(child, volume, cutting, found),
                Side::Inside => self.gather_all(child, found),
            }
        }
    }

    fn occupied_children<'a>(&'a self, node: &'a Node) -> impl Iterator<Item = &'a Node> {
        let occupied = (0..8).filter(|octant| node.occupied >> octant & 1 == 1);
        occupied.map(|octant| &self.nodes[node.children[octant] as usize])
    }

    /// The node that a box belongs to, made with those above it where it is missing.
    fn home(&mut self, bounds: &Bounds) -> u32 {
        let (center, half) = middle_and_half(bounds);
        let mut node = ROOT;
        if self.nodes[ROOT as usize].has_center(center) {
            while self.nodes[node as usize].children_fit(half) {
                node = self.child(node, center);
            }
        }
        node
    }

    fn child(&mut self, parent: u32, point: DVec3) -> u32 {
        let node = &self.nodes[parent as usize];
        let upper = point.cmpge(node.center);
        let octant = upper.bitmask() as usize;
        if node.children[octant] != ROOT {
            return node.children[octant];
        }
        let half = node.half * 0.5;
        let center = node.center + DVec3::select(upper, DVec3::splat(half), DVec3::splat(-half));
        let child = self.nodes.len() as u32;
        let made = Node::new(center, half, node.depth + 1, parent, octant);
        self.nodes[parent as usize].children[octant] = child;
        self.nodes.push(made);
        child
    }

    fn stays(&self, node: u32, bounds: &Bounds) -> bool {
        let (center, half) = middle_and_half(bounds);
        let within = &self.nodes[node as usize];
        match node {
            ROOT => !(within.has_center(center) && within.children_fit(half)),
            _ => within.bounds.side(bounds) == Side::Inside && !within.children_fit(half),
        }
    }

    fn enter(&mut self, node: u32, object: u32, bounds: Bounds) -> Place {
        let entered = &mut self.nodes[node as usize];
        let place = Place { node, index: entered.objects.len() };
        entered.objects.push(object);
        entered.boxes.push(bounds);
        // Up to the first ancestor that knows already; mostly that is the parent.
        let mut below = node;
        while below != ROOT {
            let Node { parent, octant, .. } = self.nodes[below as usize];
            let parent_node = &mut self.nodes[parent as usize];
            if parent_node.occupied >> octant & 1 == 1 {
                break;
            }
            parent_node.occupied |= 1 << octant;
            below = parent;
        }
        place
    }

    /// Tells the nodes above that `node` has lost an object: up to the first that has others.
    fn leave(&mut self, mut node: u32) {
        while node != ROOT && self.nodes[node as usize].is_vacant() {
            let Node { parent, octant, .. } = self.nodes[node as usize];
            self.nodes[parent as usize].occupied &= !(1 << octant);
            node = parent;
        }
    }
}

impl Node {
    fn new(center: DVec3, half: f64, depth: u32, parent: u32, octant: usize) -> Self {
        let loose = DVec3::splat(2.0 * half);
        let bounds = Bounds { min: center - loose, max: center + loose };
        let (bounds, content) = (grown_by_rounding(bounds), Bounds::EMPTY);
        let (children, objects, boxes) = ([ROOT; 8], Vec::new(), Vec::new());
        Self { center, half, bounds, content, depth, parent, octant, children, occupied: 0, objects, boxes, span: None }
    }

    fn has_center(&self, point: DVec3) -> bool {
        (point - self.center).abs().max_element() <= self.half
    }

    /// Whether a box of this half size fits a child that its centre is in.
    fn children_fit(&self, half: f64) -> bool {
        self.depth < DEPTH_LIMIT && half * ROOMY <= self.half * 0.5
    }

    fn is_vacant(&self) -> bool {
        self.objects.is_empty() && self.occupied == 0
    }
}

fn grown_by_rounding(bounds: Bounds) -> Bounds {
    bounds.grown(ROUNDING * bounds.largest_coordinate())
}

fn can_be_found(bounds: &Bounds) -> bool {
    !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite()
}

/// Middle of a box and half of its longest edge, such that neither overflows.
fn middle_and_half(bounds: &Bounds) -> (DVec3, f64) {
    let (min, max) = (bounds.min * 0.5, bounds.max * 0.5);
    (min + max, (max - min).max_element())
}

#[cfg(test)]
mod tests;
