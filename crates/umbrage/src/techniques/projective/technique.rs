//! A frame: choose planes and casters, find the pixels of planes, draw shadows on them.

use super::draws::{Draws, Normals, Way};
use super::views::{self, Views};
use crate::depth_maps::RECEIVER_BYTES;
use crate::planar::{Chosen, Finder, Shadows, Wanted, nearest_w};
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{error::Error, gpu::Gpu, inline::Lent, passes::Passes, view::View, visibility::VisibilityTarget};
use std::ops::Range;

/// See the module of the technique.
pub(super) struct Projected {
    gpu: Gpu,
    wanted: Wanted,
    chosen: Chosen,
    finder: Finder,
    shadows: Shadows,
    draws: Draws,
    way: Way,
    stats: Stats,
    /// The light casts shadows, and there is something to cast them.
    is_shadowed: bool,
    views: Option<Views>,
}

/// Pixels that a rasteriser may shift surfaces by and still show them in their planes.
const LEAST_SHIFT: f32 = 1e-3;

/// Fewer pixels of planes for each triangle make marking the cheaper way, and so do more fragments
/// of shadows for each pixel.
const LEAST_PIXELS: f64 = 32.0;
const MOST_DEPTH: f64 = 2.0;

/// Of a rectangle of two triangles.
const CORNERS: u32 = 6;

impl Projected {
    pub fn new(gpu: &Gpu, settings: &super::Projective) -> Self {
        let (finder, shadows) = (Finder::new(gpu), Shadows::new(gpu));
        Self {
            draws: Draws::new(gpu, &finder, &shadows),
            wanted: Wanted { planes: settings.planes, tolerance: settings.tolerance, cull: settings.cull },
            chosen: Chosen::default(),
            gpu: gpu.clone(),
            finder,
            shadows,
            way: Way::Marked,
            stats: Stats::default(),
            is_shadowed: false,
            views: None,
        }
    }

    fn upload(&mut self, passes: &mut Passes<'_>, view: &View<'_>) {
        let (clip_from_eye, nearest) = (view.clip_from_eye(), nearest_w(&view.camera));
        let planes = self.chosen.planes();
        self.finder.upload(passes, view, &self.chosen);
        self.shadows.upload(passes, view, planes.iter().map(|plane| (plane.clone(), clip_from_eye, nearest)));
        self.chosen.upload(passes);
    }

    /// How shadows are drawn: marking costs what planes cover of the screen; asking at once costs
    /// more for each fragment, and triangles have more fragments than pixels.
    fn best_way(&self, view: &View<'_>) -> Way {
        let planes = self.chosen.planes().iter().zip(self.chosen.rects());
        let area = |[_, _, width, height]: &[u32; 4]| f64::from(*width) * f64::from(*height);
        let (pixels, fragments) = planes.fold((0.0, 0.0), |(pixels, fragments), (plane, rect)| {
            (pixels + area(rect), fragments + plane.depth * area(rect))
        });
        let triangles: u64 = self.chosen.lists().iter().map(|list| list.triangles(view.casters)).sum();
        let are_few = triangles as f64 * LEAST_PIXELS <= pixels && fragments <= MOST_DEPTH * pixels;
        if are_few { Way::AtOnce } else { Way::Marked }
    }

    fn draw(&self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        let Some(resolve) = self.draws.resolve() else { return };
        let stencil = if self.way == Way::Marked { self.draws.attachment() } else { None };
        let mut pass = passes.render("projected shadows", &[visibility.overwrite()], stencil);
        let bind = |pass: &mut wgpu::RenderPass<'_>| {
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, &self.finder.bind_group, &[]);
        };
        if !self.chosen.behind().is_empty() {
            pass.set_pipeline(resolve.behind(self.way));
            bind(&mut pass);
            pass.draw(0..CORNERS, 0..self.chosen.behind().len() as u32);
        }
        let cast = |pass: &mut wgpu::RenderPass<'_>, plane: usize| {
            let [x, y, width, height] = self.chosen.rects()[plane];
            pass.set_scissor_rect(x, y, width, height);
            self.shadows.bind(pass, plane);
            self.chosen.draw(pass, view.casters, plane, |surface, form| self.draws.cast(self.way, surface, form));
        };
        if self.way == Way::AtOnce {
            (0..self.chosen.planes().len()).for_each(|plane| cast(&mut pass, plane));
            return;
        }
        let (width, height) = view.receivers.size;
        for (id, planes) in (1..).zip(apart(&self.chosen.rects()[..self.chosen.planes().len()])) {
            pass.set_stencil_reference(id);
            planes.clone().for_each(|plane| cast(&mut pass, plane));
            pass.set_scissor_rect(0, 0, width, height);
            pass.set_pipeline(&resolve.marked);
            bind(&mut pass);
            pass.draw(0..CORNERS, planes.start as u32..planes.end as u32);
        }
    }
}

/// Runs of rectangles that do not overlap: all of a run are marked before any is read.
fn apart(rects: &[[u32; 4]]) -> impl Iterator<Item = Range<usize>> + '_ {
    let overlap = |a: &[u32; 4], b: &[u32; 4]| {
        let along = |i: usize| a[i] < b[i] + b[i + 2] && b[i] < a[i] + a[i + 2];
        along(0) && along(1)
    };
    let mut start = 0;
    std::iter::from_fn(move || {
        let first = start;
        let is_apart = |end: &usize| !rects[first..*end].iter().any(|rect| overlap(rect, &rects[*end]));
        start = (first..rects.len()).take_while(is_apart).last()? + 1;
        Some(first..start)
    })
}

impl Technique for Projected {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        self.chosen.update(gpu, view, &self.wanted, |_| 0.0);
        let is_shifted = view.receivers.snapping > LEAST_SHIFT;
        let is_coarse = is_shifted || self.wanted.tolerance > 0.0 || view.camera.background_depth() != 0.0;
        let normals = Normals { are_there: view.receivers.has_normals, are_needed: is_coarse };
        self.draws.follow(gpu, &self.shadows, view.casters.forms());
        self.way = if is_coarse { Way::Marked } else { self.best_way(view) };
        self.draws.prepare(gpu, view.receivers, normals, self.way);
        self.shadows.prepare(gpu, view.receivers);
        if let Some(views) = &mut self.views {
            views.prepare(gpu, view.receivers, &self.finder);
        }
        let lists = self.chosen.lists();
        let drawn = lists.iter().map(|list| list.drawn()).sum();
        let casting = view.casters.casting().len() as u32;
        self.is_shadowed = view.light.casts && casting > 0;
        self.stats = Stats {
            draws: if self.way == Way::Marked { apart(&self.chosen.rects()[..lists.len()]).count() as u32 } else { 0 }
                + u32::from(!self.chosen.behind().is_empty())
                + lists.iter().map(|list| list.draws()).sum::<u32>(),
            triangles: lists.iter().map(|list| list.triangles(view.casters)).sum(),
            casters_drawn: drawn,
            casters_culled: (lists.len() as u32 * casting).saturating_sub(drawn),
            bytes: self.draws.bytes() + self.shadows.bytes() + self.chosen.bytes(),
        };
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.upload(passes, view);
        if self.is_shadowed {
            self.draw(passes, view, visibility);
        } else {
            passes.render("visibility", &[visibility.overwrite()], None);
        }
        if let Some(views) = &mut self.views {
            views.record(&self.gpu, passes, view.receivers, &self.finder, visibility);
        }
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("projective")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Projected {
    fn stats(&self) -> Stats {
        self.stats
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            // Depth, and the normal where that tells planes apart, or what casts shadows.
            "projected shadows" => Some(RECEIVER_BYTES),
            "visibility" => Some(0),
            _ => None,
        }
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        self.chosen.counts()
    }

    fn inspect(&mut self, view: Option<&str>) {
        let name = view.and_then(|v| views::NAMES.iter().find(|name| **name == v));
        self.views = name.map(|name| Views::new(&self.gpu, name));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.views.iter().filter_map(Views::picture).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_are_taken_together_as_long_as_they_are_apart() {
        let runs = |rects: &[[u32; 4]]| apart(rects).collect::<Vec<_>>();
        assert_eq!(runs(&[]), []);
        assert_eq!(runs(&[[0, 0, 9, 9], [1, 1, 2, 2], [3, 1, 2, 2], [1, 3, 9, 9], [2, 2, 1, 1]]), [0..1, 1..4, 4..5]);
    }
}
