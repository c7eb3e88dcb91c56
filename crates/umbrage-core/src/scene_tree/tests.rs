//! The structure of the tree; what queries find is tested from outside.

use super::*;

fn cube(center: DVec3, half: f64) -> Bounds {
    Bounds { min: center - half, max: center + half }
}

fn tree() -> SceneTree {
    SceneTree::new(cube(DVec3::ZERO, 64.0))
}

fn node_of(tree: &SceneTree, object: u32) -> u32 {
    tree.entries[object as usize].and_then(|e| e.place).expect("a place").node
}

#[test]
fn depth_follows_size_and_ends() {
    let mut tree = tree();
    for (object, (half, depth)) in
        [(100.0, 0), (64.0, 0), (17.0, 0), (16.0, 1), (15.0, 1), (1.0, 5), (1e-3, 8), (0.0, 8)].into_iter().enumerate()
    {
        tree.insert(object as u32, cube(DVec3::new(0.0, 1e-9, -3.0), half));
        assert_eq!(tree.nodes[node_of(&tree, object as u32) as usize].depth, depth, "half {half}");
    }
    assert!(tree.nodes.iter().all(|n| n.depth <= DEPTH_LIMIT));
}

#[test]
fn what_is_outside_the_root_stays_in_it() {
    let mut tree = tree();
    tree.insert(0, cube(DVec3::splat(1e9), 1.0));
    tree.update(0, cube(DVec3::splat(-1e9), 1.0));
    assert_eq!((node_of(&tree, 0), tree.nodes.len()), (ROOT, 1));
    tree.update(0, cube(DVec3::ONE, 1.0));
    assert_eq!(tree.nodes[node_of(&tree, 0) as usize].depth, 5, "it comes down once it is inside");
}

#[test]
fn moving_to_and_fro_across_a_split_changes_nothing() {
    let mut tree = tree();
    tree.insert(0, cube(DVec3::splat(0.1), 0.6));
    let (node, nodes) = (node_of(&tree, 0), tree.nodes.len());
    for i in 0..100 {
        tree.update(0, cube(DVec3::splat(0.3 * f64::from(i).sin()), 0.6 + 0.05 * f64::from(i).cos()));
        assert_eq!((node_of(&tree, 0), tree.nodes.len()), (node, nodes), "step {i}");
    }
    tree.update(0, cube(DVec3::splat(-5.0), 0.6));
    assert_ne!(node_of(&tree, 0), node, "it has left its node");
}

#[test]
fn removal_leaves_the_structure_alone() {
    let mut tree = tree();
    let at = |i: u32| DVec3::new(f64::from(i % 8), f64::from(i / 8), 0.0) * 10.0 - 30.0;
    (0..64).for_each(|i| tree.insert(i, cube(at(i), 1.0)));
    let places: Vec<_> = (0..64).map(|i| node_of(&tree, i)).collect();
    let nodes = tree.nodes.len();
    (0..64).step_by(2).for_each(|i| tree.remove(i));
    assert_eq!(tree.nodes.len(), nodes);
    assert!((1..64).step_by(2).all(|i| node_of(&tree, i) == places[i as usize]), "others stay where they are");
    (0..64).step_by(2).for_each(|i| tree.insert(i, cube(at(i), 1.0)));
    assert_eq!(tree.nodes.len(), nodes, "nodes are used again");
}

#[test]
fn nodes_know_whether_there_is_anything_below() {
    let mut tree = tree();
    tree.insert(0, cube(DVec3::splat(5.0), 0.5));
    tree.insert(1, cube(DVec3::splat(5.1), 0.5));
    tree.remove(0);
    assert_eq!(tree.nodes.iter().filter(|n| !n.is_vacant()).count(), 7, "the node and all above it");
    tree.remove(1);
    assert!(tree.nodes.iter().all(Node::is_vacant));
}

#[test]
fn any_root_box_will_do() {
    let flat = Bounds { min: DVec3::ZERO, max: DVec3::ZERO };
    let broken =
        [Bounds::EMPTY, flat, cube(DVec3::NAN, 1.0), cube(DVec3::ZERO, f64::INFINITY), cube(DVec3::ZERO, f64::MAX)];
    for root in broken.into_iter().chain([cube(DVec3::splat(1e9), 1e-9)]) {
        let mut tree = SceneTree::new(root);
        tree.insert(0, cube(DVec3::splat(1e9), 1e-9));
        tree.insert(1, cube(DVec3::ZERO, 1.0));
        let mut found = Vec::new();
        tree.query(&cube(DVec3::ZERO, 1e10), &mut found);
        found.sort_unstable();
        assert_eq!(found, [0, 1], "{root:?}");
    }
}

#[test]
fn what_is_below_a_node_is_a_slice_until_one_of_it_moves_out() {
    let mut tree = tree();
    let at = |i: u32| DVec3::new(f64::from(i % 10), f64::from(i / 10), 0.0) * 10.0 - 45.0;
    (0..100).for_each(|i| tree.insert(i, cube(at(i), 1.0)));
    tree.put_in_order();
    let all_in_order = |tree: &SceneTree| {
        tree.nodes[1..].iter().filter(|n| !n.is_vacant()).all(|node| {
            let (mut walked, mut bare) = (Vec::new(), tree.clone());
            bare.nodes.iter_mut().for_each(|n| n.span = None);
            bare.gather_all(node, &mut walked);
            node.span.is_none_or(|[begin, end]| tree.order[begin as usize..end as usize] == walked)
        })
    };
    let spans = |tree: &SceneTree| tree.nodes.iter().filter(|n| n.span.is_some()).count();
    assert!(tree.nodes.iter().all(|n| n.span.is_some()) && all_in_order(&tree));
    tree.update(7, cube(at(7) + 0.01, 1.0));
    assert!(tree.nodes.iter().all(|n| n.span.is_some()), "it has stayed in its node");
    tree.update(7, cube(at(97), 1.0));
    assert!(tree.nodes.iter().any(|n| n.span.is_none()) && spans(&tree) > tree.nodes.len() / 2 && all_in_order(&tree));
    // To nodes that are made for it, below some that have a span.
    tree.update(7, cube(at(55) + DVec3::Z * 20.0, 0.1));
    assert!(all_in_order(&tree));
    // Each comes back, and again; all is put in order from time to time.
    for i in (0..100).chain(0..100) {
        tree.remove(i);
        tree.insert(i, cube(at(i), 1.0));
        assert!(all_in_order(&tree));
    }
    assert!(tree.changes * 4 < tree.len);
}
