//! The scene tree against a plain list of the same objects.

use glam::{DMat3, DVec3, DVec4};
use proptest::prelude::*;
use std::{cell::Cell, collections::BTreeMap};
use umbrage_core::{
    Bounds, Camera, Frustum, SceneTree,
    scene_tree::{Side, Sphere, Volume},
    shadow_hull::Convex,
};

const ROOT: Bounds = Bounds { min: DVec3::splat(-100.0), max: DVec3::splat(100.0) };

fn around(center: DVec3, half: DVec3) -> Bounds {
    Bounds { min: center - half, max: center + half }
}

fn vector(limit: f64) -> impl Strategy<Value = DVec3> {
    let c = -limit..limit;
    (c.clone(), c.clone(), c).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Places anywhere in the root box, on its splits, around it and very far away.
fn place() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        4 => vector(100.0),
        3 => vector(8.5).prop_map(|p| p.round() * 12.5),
        1 => vector(300.0),
        1 => vector(4.0).prop_map(|p| p.round() * 1e9),
    ]
}

fn half_size() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        4 => vector(2.0).prop_map(DVec3::abs),
        2 => vector(3.0).prop_map(|s| s.round().abs() * 12.5),
        1 => Just(DVec3::ZERO),
        1 => vector(400.0).prop_map(DVec3::abs),
        1 => Just(DVec3::splat(1e9)),
    ]
}

fn object_box() -> impl Strategy<Value = Bounds> {
    let usual = (place(), half_size()).prop_map(|(center, half)| around(center, half));
    let broken = prop_oneof![
        Just(Bounds::EMPTY),
        Just(around(DVec3::NAN, DVec3::ONE)),
        Just(around(DVec3::new(0.0, f64::NAN, 0.0), DVec3::ONE)),
        Just(around(DVec3::ZERO, DVec3::INFINITY)),
    ];
    prop_oneof![12 => usual, 1 => broken]
}

#[derive(Clone, Debug)]
enum Step {
    Insert(u32, Bounds),
    Update(u32, Bounds),
    Nudge(u32, DVec3),
    Remove(u32),
}

fn step() -> impl Strategy<Value = Step> {
    let object = 0..60_u32;
    prop_oneof![
        4 => (object.clone(), object_box()).prop_map(|(o, b)| Step::Insert(o, b)),
        3 => (object.clone(), object_box()).prop_map(|(o, b)| Step::Update(o, b)),
        3 => (object.clone(), vector(3.0)).prop_map(|(o, d)| Step::Nudge(o, d)),
        2 => object.prop_map(Step::Remove),
    ]
}

/// What a tree should hold.
type List = BTreeMap<u32, Bounds>;

fn apply(step: &Step, tree: &mut SceneTree, list: &mut List) {
    match *step {
        Step::Insert(object, bounds) => {
            tree.insert(object, bounds);
            list.insert(object, bounds);
        }
        Step::Update(object, bounds) => {
            tree.update(object, bounds);
            list.insert(object, bounds);
        }
        Step::Nudge(object, by) => {
            if let Some(bounds) = list.get_mut(&object) {
                *bounds = Bounds { min: bounds.min + by, max: bounds.max + by };
                tree.update(object, *bounds);
            }
        }
        Step::Remove(object) => {
            tree.remove(object);
            list.remove(&object);
        }
    }
}

fn finite(bounds: &Bounds) -> bool {
    !bounds.is_empty() && bounds.min.is_finite() && bounds.max.is_finite()
}

fn check(tree: &SceneTree, list: &List, volume: &impl Volume) -> Result<(), TestCaseError> {
    let mut found = vec![u32::MAX];
    tree.query(volume, &mut found);
    prop_assert_eq!(found.remove(0), u32::MAX, "a query only appends");
    found.sort_unstable();
    let touched = list.iter().filter(|(_, b)| finite(b) && volume.side(b) != Side::Outside);
    prop_assert_eq!(found, touched.map(|(object, _)| *object).collect::<Vec<_>>());
    Ok(())
}

/// Cuts of any size hold what a list would find; large ones are that list.
fn check_cut(tree: &SceneTree, list: &List, volume: &impl Volume) -> Result<(), TestCaseError> {
    let touched: Vec<Bounds> =
        list.values().copied().filter(|b| finite(b) && volume.side(b) != Side::Outside).collect();
    for most in [0, 1, 2, 5, 13, 40, 1000] {
        let mut boxes = vec![Bounds::EMPTY];
        tree.cut(volume, most, &mut boxes);
        prop_assert_eq!(boxes.remove(0), Bounds::EMPTY, "a cut only appends");
        prop_assert!(boxes.len() <= most.max(1), "{} boxes in place of {}", boxes.len(), most);
        for object in &touched {
            let held = boxes.iter().any(|b| b.union(*object) == *b);
            prop_assert!(held, "{:?} is in none of {} boxes", object, boxes.len());
        }
        if most == 1000 {
            prop_assert_eq!(boxes.len(), touched.len());
        }
    }
    Ok(())
}

fn frustum(eye: DVec3, target: DVec3, fov_y_deg: f64) -> Frustum {
    let camera = Camera { eye, target, fov_y_deg, ..Camera::default() };
    Frustum::of(&camera.view(4, 3).clip_from_world())
}

proptest! {
    #[test]
    fn queries_find_what_a_list_would(
        steps in prop::collection::vec(step(), 0..200),
        (center, half) in (place(), half_size()),
        (eye, target, fov_y_deg) in (place(), place(), 5.0..120.0),
        points in prop::collection::vec((place(), 0..4), 1..8),
        empty_root: bool,
    ) {
        let mut tree = SceneTree::new(if empty_root { Bounds::EMPTY } else { ROOT });
        let mut list = List::new();
        for step in &steps {
            apply(step, &mut tree, &mut list);
        }
        prop_assert_eq!((tree.len(), tree.is_empty()), (list.len(), list.is_empty()));
        for object in 0..70 {
            // By their text, because a box that is not a number differs from itself.
            prop_assert_eq!(format!("{:?}", tree.bounds(object)), format!("{:?}", list.get(&object).copied()));
        }
        let content = list.values().copied().filter(finite).fold(Bounds::EMPTY, Bounds::union);
        prop_assert_eq!(tree.content(), content);
        check_cut(&tree, &list, &around(center, half))?;
        check_cut(&tree, &list, &Sphere { center, radius: f64::INFINITY })?;
        check_cut(&tree, &list, &frustum(eye, target, fov_y_deg))?;
        check(&tree, &list, &around(center, half))?;
        check(&tree, &list, &Sphere { center, radius: half.length() })?;
        check(&tree, &list, &Sphere { center, radius: f64::INFINITY })?;
        check(&tree, &list, &frustum(eye, target, fov_y_deg))?;
        let points: Vec<DVec4> = points.iter().map(|(p, w)| p.extend(if *w == 0 { 0.0 } else { 1.0 })).collect();
        check(&tree, &list, &Convex::hull(&points))?;
    }

    #[test]
    fn a_sphere_knows_its_side(center in vector(5.0), half in vector(3.0), radius in 0.0..8.0, t in vector(1.0)) {
        let bounds = around(center, half.abs());
        let side = Sphere { center: DVec3::ZERO, radius }.side(&bounds);
        let lengths = bounds.corners().map(|c| c.length());
        let nearest = DVec3::ZERO.clamp(bounds.min, bounds.max).length();
        prop_assert_eq!(side == Side::Outside, nearest > radius);
        prop_assert_eq!(side == Side::Inside, lengths.iter().all(|l| *l <= radius));
        let inside = (center + half.abs() * t).length() <= radius;
        let wrong = if inside { Side::Outside } else { Side::Inside };
        prop_assert_ne!(side, wrong);
    }
}

/// Counts the questions a volume is asked.
struct Counted<V>(V, Cell<usize>);

impl<V: Volume> Volume for Counted<V> {
    fn side(&self, bounds: &Bounds) -> Side {
        self.1.set(self.1.get() + 1);
        self.0.side(bounds)
    }
}

/// 10,000 objects of half a metre to two in a square of 200 metres, thirty high.
fn town() -> SceneTree {
    let mut tree = SceneTree::new(ROOT);
    let share = |i: u32, step: f64| (f64::from(i) * step).fract();
    for i in 0..10_000 {
        let place = DVec3::new(share(i, 0.754_877_666), share(i, 0.569_840_291) * 0.15, share(i, 0.348_324_53));
        tree.insert(i, around(place * 200.0 - 100.0, DVec3::splat(0.25 + 0.75 * share(i, 0.618_033_988))));
    }
    tree
}

fn questions(tree: &SceneTree, volume: impl Volume) -> (usize, usize) {
    let (counted, mut found) = (Counted(volume, Cell::new(0)), Vec::new());
    tree.query(&counted, &mut found);
    (counted.1.get(), found.len())
}

#[test]
fn a_query_far_from_most_objects_asks_about_few() {
    let tree = town();
    let (asked, found) = questions(&tree, Sphere { center: DVec3::new(-60.0, -90.0, 40.0), radius: 5.0 });
    assert!(found > 5 && asked < 400, "{asked} questions for {found} objects");
    let narrow = frustum(DVec3::new(-95.0, -90.0, -95.0), DVec3::new(-95.0, -95.0, 95.0), 5.0);
    let (asked, found) = questions(&tree, narrow);
    assert!(found > 100 && asked < 2_000, "{asked} questions for {found} objects");
    let (asked, found) = questions(&tree, around(DVec3::splat(500.0), DVec3::ONE));
    assert!(found == 0 && asked <= 8, "{asked} questions to find nothing");
}

#[test]
fn what_is_wholly_inside_is_not_asked_about() {
    let (asked, found) = questions(&town(), around(DVec3::ZERO, DVec3::splat(1e3)));
    assert!(found == 10_000 && asked <= 8, "{asked} questions for {found} objects");
}

/// A square of `side` × `side` objects, five metres from one to the next.
fn fields(side: u32) -> SceneTree {
    let extent = f64::from(side) * 2.5;
    let mut tree = SceneTree::new(around(DVec3::ZERO, DVec3::new(extent, 1.0, extent)));
    for i in 0..side * side {
        let (x, z) = (f64::from(i % side) * 5.0 - extent, f64::from(i / side) * 5.0 - extent);
        tree.insert(i, around(DVec3::new(x, 0.0, z), DVec3::ONE));
    }
    tree
}

#[test]
fn a_cut_asks_little_more_in_a_larger_world() {
    let volumes =
        [frustum(DVec3::new(0.0, 2.0, 0.0), DVec3::new(10.0, 1.0, 3.0), 60.0), frustum(DVec3::Y, DVec3::Z, 20.0)];
    for seen in volumes {
        let asked = [32, 100, 320].map(|side| {
            let (counted, mut boxes) = (Counted(seen.clone(), Cell::new(0)), Vec::new());
            fields(side).cut(&counted, 256, &mut boxes);
            assert!(!boxes.is_empty() && boxes.len() <= 256, "{} boxes", boxes.len());
            counted.1.get()
        });
        assert!(
            asked[2] < 1_500 && asked[2] < 2 * asked[0],
            "questions of 1,000, 10,000 and 100,000 objects: {asked:?}"
        );
    }
}

#[test]
fn an_emptied_tree_is_asked_nothing() {
    let mut tree = town();
    (0..10_000).for_each(|object| tree.remove(object));
    assert_eq!(questions(&tree, ROOT), (0, 0));
    assert!(tree.is_empty());
    tree.remove(3);
    tree.remove(20_000);
    tree.update(3, around(DVec3::ONE, DVec3::ONE));
    assert!(tree.len() == 1 && questions(&tree, ROOT).1 == 1);
}

#[test]
fn turned_boxes_of_a_moving_object_are_found_all_along() {
    let mut tree = town();
    for frame in 0..2_000 {
        let angle = f64::from(frame) * 0.01;
        let place = DMat3::from_rotation_y(angle) * DVec3::new(90.0, -90.0, 0.0);
        let bounds = around(place, DVec3::splat(1.0 + 0.4 * (7.0 * angle).sin()));
        tree.update(10_000, bounds);
        let mut found = Vec::new();
        tree.query(&Sphere { center: bounds.max, radius: 0.01 }, &mut found);
        assert!(found.contains(&10_000), "frame {frame}");
    }
}
