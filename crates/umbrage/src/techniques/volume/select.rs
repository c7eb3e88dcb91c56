//! Which casters throw shadows that matter, and from where each is counted.

use super::options::{Count, Options, Reach};
use crate::casters::{self, Casters, Edges, MeshEdges, Placed, Sight};
use crate::silhouettes::Throw;
use crate::{error::Error, gpu::Gpu, view::View};
use umbrage_core::glam::{DMat3, DVec3, DVec4};
use umbrage_core::shadow_hull::{self, Convex, shadow_hull};
use umbrage_core::silhouette::Rule;
use umbrage_core::{Bounds, Frustum};

/// What became of a caster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// Its shadow is counted from the eye.
    FromEye,
    /// Its shadow is counted from infinity.
    FromInfinity,
    /// Its shadow falls on nothing in view.
    OutOfView,
    /// The light does not reach it.
    OutOfLight,
    /// It lies flat below everything.
    ShadowsNothing,
    /// Others were more important.
    OverBudget,
}

/// The casters of a frame. Keeps its memory.
#[derive(Default)]
pub(super) struct Selection {
    /// From the eye first.
    pub throws: Vec<Throw>,
    /// How many of the shadows that are counted from the eye the eye is in.
    pub eye_count: i32,
    /// The pixels that the light can reach; `None` for all.
    pub scissor: Option<[u32; 4]>,
    /// Most shadows that one point can be in.
    pub layers: u32,
    /// Light caps, and dark caps, that are drawn and that are out of view.
    pub caps: [u32; 2],
    pub caps_culled: [u32; 2],
    /// Casters whose triangles were searched for the eye's count, and those that were too close to tell.
    pub eye_counted: u32,
    pub eye_undecided: u32,
    fates: Vec<(u32, Fate)>,
    found: Vec<u32>,
}

/// What choosing goes by, the same for all casters.
struct Situation<'a> {
    view: &'a View<'a>,
    options: &'a Options,
    /// The light's centre, moved by rounding's width.
    light: DVec4,
    /// How far rounding moves things, metres.
    rounding: f64,
    frustum: Frustum,
    /// A box around the eye and what is in front of the near plane.
    around_eye: Bounds,
    /// What surely holds every point that shadows the viewport, where depth is clipped at the near plane.
    pyramid: Option<Convex>,
    /// Shadows end where the light does.
    range: Option<f64>,
    /// A box around everything that rays from the eye can end at, and the eye.
    seen: Bounds,
}

impl Selection {
    /// Chooses. Without `clamps`, volumes are clipped at the near plane.
    pub fn choose(&mut self, gpu: &Gpu, view: &View<'_>, options: &Options, clamps: bool) -> Result<DVec4, Error> {
        self.clear();
        let casters = view.casters;
        let rounding = 4e-6 * largest_coordinate(view);
        let light = off_ties(view.light.shape.center(), rounding);
        if !view.light.casts || casters.tree().is_empty() {
            return Ok(light);
        }
        let edges = casters.edges(gpu)?;
        let camera = &view.camera;
        let situation = Situation {
            view,
            options,
            light,
            rounding,
            frustum: Frustum::of(&camera.clip_from_world()),
            around_eye: around_eye(view).grown(rounding),
            pyramid: (!clamps).then(|| shadow_hull::occlusion_pyramid(camera, light)),
            range: view.light.range.filter(|_| options.is_finite() && light.w != 0.0),
            seen: casters.receivers_bounds().union(around_eye(view)).grown(4.0 * rounding),
        };
        if options.is_finite() && options.cull.light && !shadow_hull::may_light_view(view.light, camera) {
            self.fates.extend(casting(casters).map(|place| (place, Fate::OutOfLight)));
            return Ok(light);
        }
        if options.is_finite() && options.cull.scissor
            && let Some(reach) = shadow_hull::reach(view.light)
        {
            self.scissor = Some(shadow_hull::screen_rect(camera, &reach, view.receivers.size).unwrap_or_default());
        }
        if self.scissor.is_none_or(|[_, _, width, height]| width * height > 0) {
            self.candidates(&situation);
            self.spend_budget(&situation);
            self.classify(&situation, edges);
        }
        Ok(light)
    }

    fn clear(&mut self) {
        self.throws.clear();
        self.fates.clear();
        self.found.clear();
        let (throws, fates, found) =
            (std::mem::take(&mut self.throws), std::mem::take(&mut self.fates), std::mem::take(&mut self.found));
        *self = Self { throws, fates, found, ..Self::default() };
    }

    /// Fills `found` with the casters that can matter.
    fn candidates(&mut self, s: &Situation<'_>) {
        let casters = s.view.casters;
        let receivers = casters.receivers_bounds();
        if s.options.cull.view {
            let reach = if s.options.is_finite() { shadow_hull::reach(s.view.light) } else { None };
            let lit = reach.map_or(receivers, |reach| common(&receivers, &reach));
            if let Some(hull) = shadow_hull(&s.view.camera, &lit, s.light) {
                casters.tree().query(&hull, &mut self.found);
            }
            self.found.sort_unstable();
        } else {
            self.found.extend(casting(casters));
        }
        let shadowed = casters::Light { center: s.view.light.shape.center(), receivers };
        let fates = &mut self.fates;
        self.found.retain(|&place| {
            let placed = &casters.placed()[place as usize];
            let fate = if s.options.cull.view && placed.shadows_nothing(&shadowed) {
                Fate::ShadowsNothing
            } else if s.options.is_finite() && s.options.cull.light && !shadow_hull::may_be_reached(s.view.light, &placed.bounds) {
                Fate::OutOfLight
            } else {
                return true;
            };
            fates.push((place, fate));
            false
        });
    }

    /// Keeps the most important casters (PX 5.4): those whose box is largest on the screen.
    fn spend_budget(&mut self, s: &Situation<'_>) {
        let budget = s.options.budget;
        if budget == 0 || self.found.len() <= budget {
            return;
        }
        let eye = s.view.camera.eye;
        let importance = |place: u32| {
            let bounds = s.view.casters.placed()[place as usize].bounds;
            bounds.radius() / bounds.center().distance(eye).max(bounds.radius())
        };
        self.found.sort_by(|a, b| importance(*b).total_cmp(&importance(*a)).then(a.cmp(b)));
        self.fates.extend(self.found.drain(budget..).map(|place| (place, Fate::OverBudget)));
        self.found.sort_unstable();
    }

    fn classify(&mut self, s: &Situation<'_>, edges: &Edges) {
        for i in 0..self.found.len() {
            let place = self.found[i];
            let placed = &s.view.casters.placed()[place as usize];
            let mesh = edges.of_mesh(placed.mesh);
            if placed.bounds.is_empty() || mesh.adjacency.edges.is_empty() {
                continue;
            }
            let throw = self.throw(s, place, placed, mesh);
            // Both fronts and backs of a closed mesh count where it counts with all its triangles.
            let times = if throw.rule == Rule::All && mesh.adjacency.is_closed { 2 } else { 1 };
            self.layers = self.layers.saturating_add(mesh.adjacency.layers.saturating_mul(times));
            self.fates.push((place, if throw.z_fail { Fate::FromInfinity } else { Fate::FromEye }));
            self.throws.push(throw);
        }
        self.throws.sort_by_key(|t| (t.z_fail, t.place));
    }

    fn throw(&mut self, s: &Situation<'_>, place: u32, placed: &Placed, mesh: &MeshEdges) -> Throw {
        let bounds = placed.bounds.grown(s.rounding);
        // Where the eye may see a caster's inside, or through its surface.
        let is_open_to_eye = s.options.unseen || placed.masked || overlap(&bounds, &s.around_eye);
        let holds_light = s.light.w != 0.0 && holds(&bounds, s.light.truncate());
        let is_solid = mesh.adjacency.is_closed && !is_open_to_eye && !holds_light;
        let rule = if is_solid { Rule::Away } else { Rule::All };
        let z_fail = match s.options.count {
            Count::ZFail => true,
            Count::ZPass | Count::Xor => false,
            Count::Auto => is_open_to_eye || s.may_shadow_eye(&bounds),
            Count::ZPassEye => {
                is_open_to_eye || (s.may_shadow_eye(&bounds) && !self.count_from_eye(s, placed, mesh, rule))
            }
        };
        let (light_cap, dark_cap) = if z_fail { self.caps(s, placed, &bounds) } else { (false, false) };
        let reach = s.range.map_or(0.0, |range| finite_reach(range, s.light.truncate(), placed, mesh));
        // What is counted from infinity needs its dark cap, and that is best far away.
        let ends = !z_fail && s.options.reach != Reach::Infinite;
        let end = if ends { s.end_of(&placed.bounds) } else { DVec4::ZERO };
        Throw { place, rule, z_fail, light_cap, dark_cap, end, reach: reach as f32 }
    }

    /// Adds the caster's shadows that the eye is in; false where that can't be told for sure.
    fn count_from_eye(&mut self, s: &Situation<'_>, placed: &Placed, mesh: &MeshEdges, rule: Rule) -> bool {
        self.eye_counted += 1;
        let to_mesh = &placed.mesh_from_world;
        let light = s.light.truncate();
        let sight = Sight {
            eye: to_mesh.transform_point3(s.view.camera.eye),
            light: if s.light.w == 0.0 {
                to_mesh.transform_vector3(light).extend(0.0)
            } else {
                to_mesh.transform_point3(light).extend(1.0)
            },
            tolerance: s.rounding * largest_stretch(&to_mesh.matrix3),
            rule,
        };
        let part = &s.view.casters.meshes()[placed.mesh as usize].mesh;
        // Without depth clamping the count would have to start at the near plane, pixel by pixel.
        let counted = if s.pyramid.is_some() { None } else { mesh.eye_tree(part).count(part, &mesh.adjacency, &sight) };
        self.eye_undecided += u32::from(counted.is_none());
        self.eye_count += counted.unwrap_or(0);
        counted.is_some()
    }

    /// Which caps may be seen: those that are not can't be behind anything in view (GG 9.5.3).
    fn caps(&mut self, s: &Situation<'_>, placed: &Placed, bounds: &Bounds) -> (bool, bool) {
        let cull = s.options.cull.caps;
        let light_cap = !cull || s.frustum.may_see(&placed.bounds);
        let has_dark = s.light.w != 0.0 || s.options.quads;
        let dark_cap = has_dark
            && (!cull || s.range.is_some() || shadow_hull::dark_cap_may_be_seen(&s.view.camera, bounds, s.light));
        for (kind, drawn) in [light_cap, dark_cap].into_iter().enumerate() {
            self.caps[kind] += u32::from(drawn);
            self.caps_culled[kind] += u32::from(!drawn && (kind == 0 || has_dark));
        }
        (light_cap, dark_cap)
    }

    /// How many casters met this fate. Those out of view are the rest.
    pub fn count(&self, fate: Fate) -> u32 {
        self.fates.iter().filter(|(_, f)| *f == fate).count() as u32
    }

    /// What became of each caster, by its number in [`Casters::placed`].
    pub fn fates(&self, casters: &Casters) -> Vec<(u32, Fate)> {
        let mut all: Vec<_> = casting(casters).map(|place| (place, Fate::OutOfView)).collect();
        for &(place, fate) in &self.fates {
            if let Some(entry) = all.iter_mut().find(|(p, _)| *p == place) {
                entry.1 = fate;
            }
        }
        all
    }
}

impl Situation<'_> {
    /// False where the box surely shadows neither the eye nor, where that matters, a point of the near plane.
    fn may_shadow_eye(&self, bounds: &Bounds) -> bool {
        match &self.pyramid {
            Some(pyramid) => pyramid.may_touch(bounds),
            None => shadow_hull::segment_touches(self.view.camera.eye, self.light, bounds, self.rounding),
        }
    }

    /// The side of the box around all that is seen where the caster's shadow leaves it soonest, as n · p = w. Rays from
    /// the eye stay inside, so what lies beyond counts for nothing and need not be drawn. Zero where the shadow leaves the
    /// box through several sides.
    fn end_of(&self, bounds: &Bounds) -> DVec4 {
        let mut best = (f64::INFINITY, DVec4::ZERO);
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            for normal in [axis, -axis] {
                // Of the box: the corner that is least far along the normal, and how far the light is from there.
                let least = normal.dot(if normal == axis { bounds.min } else { bounds.max });
                let side = normal.dot(if normal == axis { self.seen.max } else { self.seen.min });
                let away = least * self.light.w - normal.dot(self.light.truncate());
                let middle = bounds.center();
                let direction = middle * self.light.w - self.light.truncate();
                let length = (side - normal.dot(middle)) / normal.dot(direction) * direction.length();
                // Not so steep that rounding moves where a ray meets the side.
                if away > 1e-3 * direction.length() && length < best.0 {
                    best = (length, normal.extend(side));
                }
            }
        }
        best.1
    }
}

fn casting(casters: &Casters) -> impl Iterator<Item = u32> + '_ {
    (0..).zip(casters.placed()).filter(|(_, p)| p.casts).map(|(place, _)| place)
}

/// Largest coordinate that shaders compute with, metres: what rounding goes by.
fn largest_coordinate(view: &View<'_>) -> f64 {
    let origin = view.casters.origin();
    let light = view.light.shape.center();
    let scene = view.casters.all_bounds();
    let scene = Bounds { min: scene.min - origin, max: scene.max - origin }.largest_coordinate();
    let points = [view.camera.eye - origin, (light.truncate() - origin) * light.w];
    points.iter().map(|p| p.abs().max_element()).fold(scene, f64::max)
}

/// A light at exactly the place of a vertex has no direction to cast it in. Moved by less than anybody sees, and
/// along no axis, it has.
fn off_ties(light: DVec4, rounding: f64) -> DVec4 {
    light + DVec3::new(0.1, 0.073, 0.087).extend(0.0) * (rounding * light.w)
}

/// A box around the eye and the near rectangle.
fn around_eye(view: &View<'_>) -> Bounds {
    let eye_from_clip = view.clip_from_eye().inverse();
    let near_depth = if view.camera.background_depth() == 0.0 { 1.0 } else { 0.0 };
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let near = corners.map(|(x, y)| {
        let p = eye_from_clip * DVec4::new(x, y, near_depth, 1.0);
        view.camera.eye + p.truncate() / p.w
    });
    Bounds::of(near).with(view.camera.eye)
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

fn holds(bounds: &Bounds, p: DVec3) -> bool {
    p.cmpge(bounds.min).all() && p.cmple(bounds.max).all()
}

fn common(a: &Bounds, b: &Bounds) -> Bounds {
    Bounds { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// The most that a matrix lengthens a vector, from above.
fn largest_stretch(m: &DMat3) -> f64 {
    (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt()
}

/// How far away from the light corners of the shadow have to lie so that no triangle between them cuts into the light's range
/// (the gaps of PX figure 3.7); 0, infinitely far, where the caster is so near that this is very far.
fn finite_reach(range: f64, light: DVec3, placed: &Placed, mesh: &MeshEdges) -> f64 {
    let near = light.clamp(placed.bounds.min, placed.bounds.max).distance(light);
    let half_edge = 0.5 * mesh.adjacency.longest_edge * largest_stretch(&placed.world_from_mesh.matrix3);
    // A triangle whose edges are seen under an angle fits into a cone that is 2 / √3 times as wide.
    let half_angle = (half_edge / near).asin() * 2.0 / 3.0_f64.sqrt();
    if half_angle < 1.3 { range / half_angle.cos() * 1.001 } else { 0.0 }
}
