//! What an observer sees of how a technique works: lines in the world.

use crate::loupe::Maps;
use umbrage_core::adjacency::Adjacency;
use umbrage_core::glam::{DVec2, DVec3, Vec3};
use umbrage_core::light_view::LightView;
use umbrage_core::silhouette::{ContourEdge, Rule, contour, light_in_mesh};
use umbrage_core::wedge::{LightHull, Wedge};
use umbrage_core::{Bounds, Light, LightShape, Scene};

/// Lines that are drawn, at most.
const MOST_LINES: usize = 4000;
/// Triangles of a mesh whose silhouettes are found, at most.
const MOST_TRIANGLES: usize = 50_000;
/// Pieces of the rim of a paraboloid's map.
const RIM: u32 = 32;

/// What a line is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum What {
    /// The camera that stands still.
    Camera,
    /// Where one part of what it sees ends and the next begins.
    Split,
    /// What a map shows.
    Map,
    /// The box around a caster that is drawn into a map.
    Kept,
    /// The box around a caster that is in no map.
    Culled,
    /// An edge that bounds a shadow.
    Silhouette,
    /// A side of a shadow volume.
    Volume,
    /// A body around a penumbra.
    Wedge,
}

impl What {
    /// All of them, with what users read.
    pub const ALL: [(Self, &'static str); 8] = [
        (Self::Camera, "the frozen camera"),
        (Self::Split, "splits"),
        (Self::Map, "what maps show"),
        (Self::Kept, "casters kept"),
        (Self::Culled, "casters culled"),
        (Self::Silhouette, "silhouettes"),
        (Self::Volume, "shadow volumes"),
        (Self::Wedge, "penumbra wedges"),
    ];
    /// Those that are shown at first.
    pub const FIRST: [Self; 5] = [Self::Camera, Self::Split, Self::Map, Self::Kept, Self::Culled];
}

/// A line in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    pub from: DVec3,
    pub to: DVec3,
    pub what: What,
}

/// A mesh as its silhouettes are found.
struct Outline {
    adjacency: Adjacency,
    positions: Vec<Vec3>,
}

/// The casters of a scene; found once.
pub(crate) struct Shapes {
    scene: Scene,
    boxes: Vec<Bounds>,
    /// Of each mesh, where it is small enough.
    outlines: Vec<Option<Outline>>,
    around: Bounds,
}

/// What of a scene shapes are made of, to be taken to another thread.
pub(crate) fn geometry(scene: &Scene) -> Scene {
    let (meshes, instances, rigs) = (scene.meshes.clone(), scene.instances.clone(), scene.rigs.clone());
    Scene { meshes, instances, rigs, ..Scene::default() }
}

impl Shapes {
    pub fn new(scene: Scene) -> Self {
        let outline = |mesh: &umbrage_core::Mesh| {
            let is_small = mesh.triangle_count() <= MOST_TRIANGLES;
            is_small.then(|| Outline { adjacency: Adjacency::of(mesh), positions: mesh.positions.clone() })
        };
        let outlines = scene.meshes.iter().map(outline).collect();
        let boxes = scene.instances.iter().map(|instance| scene.instance_bounds(instance)).collect();
        Self { around: scene.bounds(), outlines, boxes, scene }
    }

    /// The lines of all that `shows` asks for; what is most telling first.
    pub fn lines(&self, light: &Light, maps: &Maps, aspect: f64, shows: &[What]) -> Vec<Line> {
        let mut lines = Vec::new();
        let asked = |what: What| shows.contains(&what);
        if asked(What::Camera) {
            self.camera(maps, aspect, &mut lines);
        }
        if asked(What::Split) {
            self.splits(maps, aspect, &mut lines);
        }
        if asked(What::Map) {
            maps.views.iter().for_each(|view| self.map(view, &mut lines));
        }
        self.casters(maps, shows, &mut lines);
        if [What::Silhouette, What::Volume, What::Wedge].into_iter().any(asked) {
            self.shadows(light, shows, &mut lines);
        }
        lines.retain(|line| line.from.is_finite() && line.to.is_finite());
        lines.truncate(MOST_LINES);
        lines
    }

    /// How far from `p` the scene reaches.
    fn reach(&self, p: DVec3) -> f64 {
        self.around.corners().iter().map(|c| c.distance(p)).fold(0.0, f64::max)
    }

    /// Corners of what the frozen camera sees at a distance along its view.
    fn corners(maps: &Maps, aspect: f64, distance: f64) -> [DVec3; 4] {
        // Only the shape of the picture counts.
        let size = ((aspect * 1000.0).round().max(1.0) as u32, 1000);
        let (width, height) = (f64::from(size.0), f64::from(size.1));
        [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)].map(|(x, y)| {
            let pixel = DVec2::new(x, y);
            maps.camera.start(pixel, size.0, size.1) + maps.camera.ray(pixel, size.0, size.1) * distance
        })
    }

    fn camera(&self, maps: &Maps, aspect: f64, into: &mut Vec<Line>) {
        let far = maps.camera.parallel.map_or_else(|| self.reach(maps.camera.eye), |parallel| parallel.far);
        let [near, far] = [maps.camera.near, far].map(|distance| Self::corners(maps, aspect, distance));
        ring(&near, What::Camera, into);
        ring(&far, What::Camera, into);
        into.extend(near.into_iter().zip(far).map(|(from, to)| Line { from, to, what: What::Camera }));
    }

    fn splits(&self, maps: &Maps, aspect: f64, into: &mut Vec<Line>) {
        for &split in &maps.splits {
            ring(&Self::corners(maps, aspect, split), What::Split, into);
        }
    }

    fn map(&self, view: &LightView, into: &mut Vec<Line>) {
        let size = f64::from(view.size);
        let border: Vec<DVec2> = match &view.paraboloid {
            None => [(0.0, 0.0), (size, 0.0), (size, size), (0.0, size)].map(DVec2::from).to_vec(),
            Some(paraboloid) => (0..RIM)
                .map(|i| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / f64::from(RIM)).sin_cos();
                    let ndc = paraboloid.scale * DVec2::new(cos, sin) + paraboloid.axis;
                    DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) * (size * 0.5)
                })
                .collect(),
        };
        let is_from_point = view.paraboloid.is_some() || view.is_perspective();
        let ray = |texel: &DVec2| {
            let (from, way) = view.ray(*texel);
            let way = if is_from_point { way.normalize_or_zero() * self.reach(from) } else { way };
            (from, from + way)
        };
        let (from, to): (Vec<DVec3>, Vec<DVec3>) = border.iter().map(ray).unzip();
        if !is_from_point {
            ring(&from, What::Map, into);
        }
        ring(&to, What::Map, into);
        // Of a round rim four are enough.
        let step = (from.len() / 4).max(1);
        let sides = from.into_iter().zip(to).step_by(step);
        into.extend(sides.map(|(from, to)| Line { from, to, what: What::Map }));
    }

    fn casters(&self, maps: &Maps, shows: &[What], into: &mut Vec<Line>) {
        let frusta: Vec<_> = maps.views.iter().map(LightView::frustum).collect();
        if frusta.is_empty() {
            return;
        }
        let instances = self.scene.instances.iter().zip(&self.boxes).filter(|(instance, _)| instance.casts);
        for (_, bounds) in instances.filter(|(_, bounds)| !bounds.is_empty()) {
            let is_kept = frusta.iter().any(|frustum| frustum.may_see(bounds));
            let what = if is_kept { What::Kept } else { What::Culled };
            if shows.contains(&what) && into.len() < MOST_LINES {
                edges_of(bounds, what, into);
            }
        }
    }

    /// Silhouettes, and what is made of them.
    fn shadows(&self, light: &Light, shows: &[What], into: &mut Vec<Line>) {
        let hull = hull(&light.shape);
        let center = light.shape.center();
        let mut edges: Vec<ContourEdge> = Vec::new();
        for instance in self.scene.instances.iter().filter(|i| i.casts && i.pose.is_none()) {
            let Some(Some(outline)) = self.outlines.get(instance.mesh) else { continue };
            let adjacency = &outline.adjacency;
            let in_mesh = light_in_mesh(center, &instance.world_from_mesh.inverse(), adjacency.center);
            let rule = if adjacency.is_closed { Rule::Away } else { Rule::All };
            edges.clear();
            contour(adjacency, in_mesh, rule, &mut edges);
            for edge in &edges {
                if into.len() >= MOST_LINES {
                    return;
                }
                let ends = [edge.from, edge.to].map(|i| {
                    let place = outline.positions.get(i as usize).copied().unwrap_or_default();
                    instance.world_from_mesh.transform_point3(place.as_dvec3())
                });
                self.edge(ends, light, hull.as_ref(), shows, into);
            }
        }
    }

    fn edge(&self, ends: [DVec3; 2], light: &Light, hull: Option<&LightHull>, shows: &[What], into: &mut Vec<Line>) {
        let [from, to] = ends;
        let length = 2.0 * self.around.radius();
        if shows.contains(&What::Silhouette) {
            into.push(Line { from, to, what: What::Silhouette });
        }
        if shows.contains(&What::Volume) {
            let away = ends.map(|p| p - light.shape.to_center(p).normalize_or_zero() * length);
            let sides = ends.into_iter().zip(away);
            into.extend(sides.map(|(from, to)| Line { from, to, what: What::Volume }));
        }
        if let Some(wedge) = hull.filter(|_| shows.contains(&What::Wedge)).and_then(|hull| Wedge::new(from, to, hull)) {
            let [a, b] = wedge.near;
            into.push(Line { from: a, to: b, what: What::Wedge });
            for (near, ways) in wedge.near.into_iter().zip(wedge.far) {
                into.extend(ways.map(|way| Line { from: near, to: near + way * length, what: What::Wedge }));
            }
        }
    }
}

/// A body around the light; `None` for lights without extent.
fn hull(shape: &LightShape) -> Option<LightHull> {
    let center = shape.center();
    let round = LightHull { corners: [center.truncate(); 4], radius: shape.radius(), is_parallel: center.w == 0.0 };
    let corners = |corners| LightHull { corners, radius: 0.0, is_parallel: false };
    Some(match *shape {
        LightShape::Rect { position, direction, up, size, .. } => {
            let (right, up) = (up.cross(direction) * (size.x * 0.5), up * (size.y * 0.5));
            corners([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| position + right * x + up * y))
        }
        LightShape::Line { from, to } => corners([from, from, to, to]),
        _ if shape.radius() > 0.0 => round,
        _ => return None,
    })
}

fn ring(corners: &[DVec3], what: What, into: &mut Vec<Line>) {
    let next = corners.iter().cycle().skip(1);
    into.extend(corners.iter().zip(next).map(|(from, to)| Line { from: *from, to: *to, what }));
}

fn edges_of(bounds: &Bounds, what: What, into: &mut Vec<Line>) {
    let corners = bounds.corners();
    // Corners differ in one bit of their number where an edge joins them.
    for (i, j) in (0..8usize).flat_map(|i| [1, 2, 4].map(|bit| (i, i ^ bit))).filter(|(i, j)| i < j) {
        into.push(Line { from: corners[i], to: corners[j], what });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::light_view::{Fit, FitScene, Focus, Omni, fit};
    use umbrage_core::scenes;

    fn contact() -> Scene {
        (scenes::find("contact").expect("a built-in scene").build)(0.2)
    }

    #[test]
    fn lines_are_of_what_was_asked_for_alone() {
        let scene = contact();
        let shapes = Shapes::new(geometry(&scene));
        let light = &scene.lights[1];
        let mut views = Vec::new();
        let boxes = shapes.boxes.clone();
        let how = Fit { focus: Focus::Visible, omni: Omni::Cube, size: 64, border_texels: 0.0, border_m: 0.0 };
        let seen = scene.camera.view(4, 3).frustum();
        fit(&light.shape, &seen, &FitScene::new(boxes.clone(), boxes), &how, &mut views);
        let maps = Maps { views, splits: vec![2.0, 5.0], camera: scene.camera.clone() };
        for (what, name) in What::ALL {
            let lines = shapes.lines(light, &maps, 4.0 / 3.0, &[what]);
            assert!(lines.iter().all(|line| line.what == what), "{name}");
            assert!(!lines.is_empty() || what == What::Culled, "{name}");
        }
        assert_eq!(shapes.lines(light, &maps, 4.0 / 3.0, &[What::Camera]).len(), 12);
        assert_eq!(shapes.lines(light, &maps, 4.0 / 3.0, &[What::Split]).len(), 8);
        // Without maps nothing is culled by them.
        assert!(shapes.lines(light, &Maps::default(), 1.0, &[What::Kept, What::Culled, What::Map]).is_empty());
    }

    #[test]
    fn wedges_hold_what_sees_their_edge_in_front_of_the_light() {
        let shape = LightShape::Sphere { position: DVec3::Y * 4.0, radius: 0.5 };
        let hull = hull(&shape).expect("a light with an extent");
        let (a, b) = (DVec3::new(-1.0, 1.0, 0.0), DVec3::new(1.0, 1.0, 0.0));
        let wedge = Wedge::new(a, b, &hull).expect("an edge beside the light");
        assert!(wedge.depth(DVec3::ZERO) > 0.0 && wedge.depth(DVec3::Z) < 0.0);
    }
}
