//! How often a point is inside a shadow volume is how many triangles hide the light from it.

use crate::crossing::{Sheet, crossings};
use crate::shapes::{Setting, closed, damaged, setting, soup, within};
use crate::volume::{Volume, vertex};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use std::cell::Cell;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DVec3, DVec4, Vec4};
use umbrage_core::silhouette::{Rule, facing, light_in_mesh};
use umbrage_core::{Bounds, Mesh, Scene};
use umbrage_reference::Tracer;

/// How many points had which answer. A test that checks nothing must not pass.
#[derive(Default)]
struct Tally {
    lit: Cell<u32>,
    hidden: Cell<u32>,
    hidden_twice: Cell<u32>,
    /// Too near to an edge to be decided.
    skipped: Cell<u32>,
    /// In a place that the rule is not made for.
    excluded: Cell<u32>,
}

impl Tally {
    fn add(counter: &Cell<u32>) {
        counter.set(counter.get() + 1);
    }

    fn check(&self, least: u32) {
        let [lit, hidden, twice, skipped] = [&self.lit, &self.hidden, &self.hidden_twice, &self.skipped].map(Cell::get);
        let all = format!("{lit} lit, {hidden} hidden, {twice} of them twice, {skipped} skipped");
        assert!(lit >= least && hidden >= least && twice >= least / 4, "too few points: {all}");
        assert!(skipped * 100 <= lit + hidden, "too many points on edges: {all}");
    }
}

/// A mesh, its light and everything that is known of its shadow.
struct Shadow {
    light: DVec4,
    light_in_mesh: Vec4,
    adjacency: Adjacency,
    /// Every triangle of the mesh, as it stands in the world.
    triangles: Vec<[DVec4; 3]>,
    volume: Vec<Sheet>,
    rule: Rule,
    tracer: Tracer,
}

impl Shadow {
    fn of((mesh, world_from_mesh, light): &Setting, rule: Rule) -> Self {
        let adjacency = Adjacency::of(mesh);
        let light_in_mesh = light_in_mesh(*light, &world_from_mesh.inverse(), adjacency.center);
        let volume = Volume::of(&adjacency, light_in_mesh, rule).sheets(mesh, world_from_mesh, *light);
        let triangles = adjacency.triangles.iter().map(|t| t.map(|v| vertex(mesh, world_from_mesh, v))).collect();
        let mut scene = Scene::default();
        let number = scene.add_mesh(mesh.clone());
        scene.place(number, 0, *world_from_mesh);
        Self { light: *light, light_in_mesh, adjacency, triangles, volume, rule, tracer: Tracer::new(&scene) }
    }

    /// How many triangles that cast under the rule are between a point and the light.
    fn in_between(&self, point: DVec4) -> Option<i32> {
        let mut count = 0;
        for (corners, plane) in self.triangles.iter().zip(&self.adjacency.planes) {
            let met = crossings(point, self.light, &[Sheet { corners: *corners, times: 1 }])?;
            let throws = self.rule == Rule::All || facing(*plane, self.light_in_mesh) < 0;
            count += i32::from(met != 0 && throws);
        }
        Some(count)
    }

    /// How often a point is inside the volume, by a way from it without end.
    fn inside(&self, point: DVec4, way: DVec3) -> Option<i32> {
        crossings(point, way.extend(0.0), &self.volume)
    }

    /// Compares all that is known about a point.
    fn check(&self, Look { point, other, way }: Look, tally: &Tally) {
        let (point, other) = (point.extend(1.0), other.extend(1.0));
        let inside = (self.inside(point, way), self.inside(other, way));
        let known = (self.in_between(point), inside, crossings(point, other, &self.volume));
        let (Some(truth), (Some(inside), Some(other_inside)), Some(between)) = known else {
            return Tally::add(&tally.skipped);
        };
        assert_eq!(inside, truth, "inside the volume, and triangles before the light, at {point}");
        assert_eq!(inside > 0, self.tracer.blocked(point.truncate(), self.light), "inside, and blocked, at {point}");
        // What counting from an eye goes by.
        assert_eq!(inside - other_inside, between, "the surfaces between two points, {point} and {other}");
        if self.rule == Rule::Away || !self.adjacency.is_closed {
            assert!(truth as u32 <= self.adjacency.layers, "{truth} of {} layers", self.adjacency.layers);
        }
        Tally::add(if truth > 0 { &tally.hidden } else { &tally.lit });
        if truth > 1 {
            Tally::add(&tally.hidden_twice);
        }
    }
}

/// What to look at.
struct Look {
    point: DVec3,
    /// Another point.
    other: DVec3,
    /// A way to go from both.
    way: DVec3,
}

/// Runs `check` on many meshes, and on many points around each.
fn run(mesh: impl Strategy<Value = Mesh>, rule: Rule, check: impl Fn(&Setting, &Shadow, Look)) {
    let config = Config { cases: 500, ..Config::with_source_file(file!()) };
    let looks = prop::collection::vec((within(1.0), -0.5..4.0f64, within(4.0), within(1.0)), 12);
    let result = TestRunner::new(config).run(&(setting(mesh), looks), |(setting, looks)| {
        let shadow = Shadow::of(&setting, rule);
        let (_, world_from_mesh, light) = &setting;
        for (near, behind, other, way) in looks {
            // Most points and ways lie behind the mesh as seen from the light, where the shadow is.
            let near = world_from_mesh.transform_point3(near);
            let from_light = (near * light.w - light.truncate()).normalize_or_zero();
            let way = (way + from_light * 0.5).normalize_or_zero();
            check(&setting, &shadow, Look { point: near + from_light * behind, other: near + other, way });
        }
        Ok(())
    });
    assert!(result.is_ok(), "{result:?}");
}

fn check_all(mesh: impl Strategy<Value = Mesh>) {
    let tally = Tally::default();
    run(mesh, Rule::All, |_, shadow, look| shadow.check(look, &tally));
    tally.check(200);
}

#[test]
fn all_triangles_of_any_mesh() {
    check_all(soup());
}

#[test]
fn all_triangles_of_closed_meshes() {
    check_all(closed());
}

#[test]
fn all_triangles_of_damaged_meshes() {
    check_all(damaged());
}

#[test]
fn triangles_facing_away_of_closed_meshes_seen_from_outside() {
    let tally = Tally::default();
    run(closed(), Rule::Away, |(mesh, world_from_mesh, light), shadow, look| {
        assert!(shadow.adjacency.is_closed);
        let mesh_from_world = world_from_mesh.inverse();
        let Bounds { min, max } = mesh.bounds();
        let is_outside = |p: DVec3| {
            let p = mesh_from_world.transform_point3(p);
            p.cmplt(min).any() || p.cmpgt(max).any()
        };
        if is_outside(look.point) && is_outside(look.other) && (light.w == 0.0 || is_outside(light.truncate())) {
            shadow.check(look, &tally);
        } else {
            Tally::add(&tally.excluded);
        }
    });
    tally.check(200);
}
