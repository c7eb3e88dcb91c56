//! Which casters cast shadows that matter, and from where each is counted.

use super::options::{Count, Options, Reach};
use super::situation::{Situation, common};
use crate::casters::{self, Casters, Edges, MeshEdges, Placed, before_eye};
use crate::silhouettes::Throw;
use crate::{error::Error, gpu::Gpu, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::DVec4;
use umbrage_core::shadow_hull::{self, shadow_hull};
use umbrage_core::silhouette::Rule;

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
    /// It has an alpha mask, and is looked up in a map.
    InMaps,
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
    /// Light caps, and dark caps, that are drawn and that are out of view.
    pub caps: [u32; 2],
    pub caps_culled: [u32; 2],
    /// Casters whose triangles were searched for the eye's count, and those that were too close to
    /// tell.
    pub eye_counted: u32,
    pub eye_undecided: u32,
    fates: Vec<(u32, Fate)>,
    found: Vec<u32>,
}

impl Selection {
    /// Chooses; returns the light's centre to extrude from. Without `clamps`, volumes are clipped
    /// at the near plane.
    pub fn choose(&mut self, gpu: &Gpu, view: &View<'_>, options: &Options, clamps: bool) -> Result<DVec4, Error> {
        self.clear();
        let casters = view.casters;
        let situation = Situation::new(view, options, clamps);
        let (light, camera) = (situation.light, &view.camera);
        if !view.light.casts || casters.casting().is_empty() {
            return Ok(light);
        }
        let edges = casters.edges(gpu)?;
        if options.is_finite() && options.cull.light && !shadow_hull::may_light_view(view.light, camera) {
            self.fates.extend(casters.casting_places().into_iter().map(|place| (place, Fate::OutOfLight)));
            return Ok(light);
        }
        if options.is_finite()
            && options.cull.scissor
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
                casters.casting().query(&hull, &mut self.found);
            }
            casters.sort(&mut self.found);
        } else {
            self.found.extend(casters.casting_places());
        }
        let shadowed = casters::Light { center: s.view.light.shape.center(), receivers };
        let fates = &mut self.fates;
        self.found.retain(|&place| {
            let placed = &casters.placed()[place as usize];
            let fate = if s.options.leaves_masked && placed.masked {
                Fate::InMaps
            } else if s.options.cull.view && placed.shadows_nothing(&shadowed) {
                Fate::ShadowsNothing
            } else if s.options.is_finite()
                && s.options.cull.light
                && !shadow_hull::may_be_reached(s.view.light, &placed.bounds)
            {
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
        // Of those that are as important the older one comes first, as they are sorted.
        self.found.sort_by(|a, b| importance(*b).total_cmp(&importance(*a)));
        self.fates.extend(self.found.drain(budget..).map(|place| (place, Fate::OverBudget)));
        s.view.casters.sort(&mut self.found);
    }

    fn classify(&mut self, s: &Situation<'_>, edges: &Edges) {
        for i in 0..self.found.len() {
            let place = self.found[i];
            let placed = &s.view.casters.placed()[place as usize];
            let mesh = edges.of_mesh(placed.mesh);
            if placed.bounds.is_empty() || placed.sides.is_none() || mesh.adjacency.edges.is_empty() {
                continue;
            }
            let throw = self.throw(s, place, placed, mesh);
            self.fates.push((place, if throw.z_fail { Fate::FromInfinity } else { Fate::FromEye }));
            self.throws.push(throw);
        }
        self.throws.sort_by_key(|t| t.z_fail);
    }

    fn throw(&mut self, s: &Situation<'_>, place: u32, placed: &Placed, mesh: &MeshEdges) -> Throw {
        let bounds = placed.bounds.grown(s.rounding);
        // Where the eye may see a caster's inside, or through its surface.
        let is_open_to_eye = s.options.unseen || placed.masked || bounds.overlaps(&s.around_eye);
        let holds_light = s.light.w != 0.0 && bounds.contains(s.light.truncate());
        let is_solid = mesh.adjacency.is_closed && !is_open_to_eye && !holds_light;
        let rule = if is_solid { Rule::Away } else { Rule::All };
        let z_fail = match s.options.count {
            Count::ZFail => true,
            Count::ZPass | Count::Xor => false,
            // Parallel lines of sight start at no eye.
            _ if s.is_parallel_view => true,
            Count::Auto => is_open_to_eye || s.may_shadow_eye(&bounds),
            Count::ZPassEye => {
                is_open_to_eye || (s.may_shadow_eye(&bounds) && !self.count_from_eye(s, placed, mesh, rule))
            }
        };
        // What is counted from infinity needs a dark cap where it ends, while parallel light needs
        // none infinitely far away. Parallel lines of sight have a far plane, before infinity.
        let is_endless = z_fail && s.light.w == 0.0 && !s.is_parallel_view;
        let ends = s.options.reach != Reach::Infinite && !is_endless;
        let end = if ends { s.end_of(&placed.bounds) } else { DVec4::ZERO };
        let (light_cap, dark_cap) = if z_fail { self.caps(s, placed, &bounds, end) } else { (false, false) };
        let farthest = s.farthest.filter(|_| ends && !z_fail && end == DVec4::ZERO);
        let reach = s.range.or(farthest).map_or(0.0, |range| s.finite_reach(range, placed, mesh));
        Throw {
            place,
            light: s.light,
            rule,
            is_body: false,
            from_infinity: false,
            z_fail,
            light_cap,
            dark_cap,
            end,
            reach: reach as f32,
            anchor: Default::default(),
        }
    }

    /// Adds the caster's shadows that the eye is in; false where that can't be told for sure.
    fn count_from_eye(&mut self, s: &Situation<'_>, placed: &Placed, mesh: &MeshEdges, rule: Rule) -> bool {
        if placed.posed {
            return false;
        }
        self.eye_counted += 1;
        let counted = if s.is_clipped() { None } else { before_eye(s.view, placed, mesh, s.light, s.rounding) };
        self.eye_undecided += u32::from(counted.is_none());
        let [facing, away] = counted.unwrap_or_default();
        self.eye_count += away as i32 + if rule == Rule::All { facing as i32 } else { 0 };
        counted.is_some()
    }

    /// Which caps may be seen: those that are not can't be behind anything in view (GG 9.5.3).
    fn caps(&mut self, s: &Situation<'_>, placed: &Placed, bounds: &Bounds, end: DVec4) -> (bool, bool) {
        let cull = s.options.cull.caps;
        let light_cap = !cull || s.frustum.may_see(&placed.bounds);
        let has_dark = s.light.w != 0.0 || s.options.quads || s.is_parallel_view;
        let may_see_dark = || match (end == DVec4::ZERO, s.range) {
            (false, _) => s.frustum.may_see(&s.shadow_on(bounds, end)),
            (true, Some(_)) => true,
            (true, None) => shadow_hull::dark_cap_may_be_seen(&s.view.camera, bounds, s.light),
        };
        let dark_cap = has_dark && (!cull || may_see_dark());
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
        let places = casters.casting_places().into_iter();
        let mut all: Vec<_> = places.map(|place| (place, Fate::OutOfView)).collect();
        for &(place, fate) in &self.fates {
            if let Some(entry) = all.iter_mut().find(|(p, _)| *p == place) {
                entry.1 = fate;
            }
        }
        all
    }
}
