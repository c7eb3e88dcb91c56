//! The frame: maps of every point, steps in them, skins, and the look-ups that add up.

use super::borders::{Borders, Job, neighbours};
use super::light::points;
use super::lookup::{Lit, Pipelines, Role};
use super::options;
use super::pictures::{Skinned, pictures};
use super::point::Point;
use super::uniform::{LightPoint, PointLookup};
use crate::depth_maps::RECEIVER_BYTES;
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{Error, Gpu, Lent, passes::Passes, view::View, visibility::VisibilityTarget};
use umbrage_core::light_view::LightView;
use umbrage_core::{Light, LightShape};

/// What a look-up of two points at once binds.
struct Both {
    /// Whose shares it was made for.
    of: [wgpu::Texture; 2],
    bind_group: wgpu::BindGroup,
}

/// See the module above.
pub(super) struct LinearLight {
    settings: options::LinearLight,
    borders: Borders,
    pipelines: Pipelines,
    /// The points of the light.
    shapes: Vec<LightShape>,
    points: Vec<Point>,
    skinned: Skinned,
    /// The pixels that the light can light: the first, and how many.
    lit: [u32; 4],
    /// For a look-up of two points at once.
    both: Option<Both>,
    draws: u32,
}

impl LinearLight {
    pub fn new(gpu: &Gpu, settings: &options::LinearLight) -> Result<Self, Error> {
        gpu.check_size("a shadow map", settings.size, settings.size)?;
        Ok(Self {
            settings: settings.clone(),
            borders: Borders::new(gpu, settings),
            pipelines: Pipelines::new(gpu, settings.threshold),
            shapes: Vec::new(),
            points: Vec::new(),
            skinned: Skinned::default(),
            lit: [0; 4],
            both: None,
            draws: 0,
        })
    }

    /// Makes room for look-ups: of two points at once where their maps are alike, else of one after
    /// the other.
    fn look_up(&mut self, gpu: &Gpu, view: &View<'_>) {
        let count = self.points.len();
        let at_once = match &mut self.points[..] {
            [first, other] if first.maps.input.joins(&other.maps.input) => {
                first.maps.input.join(&other.maps.input);
                true
            }
            _ => false,
        };
        if count > 1 && !at_once {
            self.pipelines.make_room(gpu, view.receivers.size);
        }
        for (i, point) in self.points.iter_mut().enumerate() {
            if count == 2 && !at_once {
                let light = Light { shape: self.shapes[i].clone(), ..view.light.clone() };
                point.maps.look_up(gpu, &View { light: &light, ..*view }, self.pipelines.of(Role::of(i, count)));
            }
            point.make_room(gpu, &self.borders, &self.pipelines, (i, count));
        }
        let made = match &self.points[..] {
            [first, other] if at_once => first.made().zip(other.made()).map(|made| (first, made)),
            _ => None,
        };
        self.both = made.map(|(first, (own, others))| {
            let of = [own.shares.clone(), others.shares.clone()];
            match self.both.take().filter(|both| both.of == of) {
                Some(both) => both,
                None => {
                    let bind_group = self.pipelines.bind_both(gpu, &first.look_up_uniform, [own, others]);
                    Both { of, bind_group }
                }
            }
        });
    }

    /// What shaders read of each point.
    fn place(&mut self, view: &View<'_>) {
        let places: Vec<_> = self.shapes.iter().map(|shape| shape.center().truncate()).collect();
        let (origin, receivers) = (view.casters.origin(), view.casters.receivers_bounds());
        for (i, point) in self.points.iter_mut().enumerate() {
            let frame = point.maps.frame();
            point.data = LightPoint::of(&frame.views, frame.size, places[i], origin, &receivers);
            let ways = neighbours(i, places.len()).map(|j| places[j] - places[i]);
            point.look_up_data = PointLookup::of(places[i] - view.camera.eye, ways, frame.layers.count());
        }
    }

    /// Draws skins where either of two neighbours has new maps.
    fn record_shares(&mut self, passes: &mut Passes<'_>, view: &View<'_>) -> u32 {
        let count = self.points.len();
        if count < 2 {
            return 0;
        }
        let new: Vec<bool> = self.points.iter().map(Point::is_new).collect();
        self.borders.find(passes, self.points.iter().zip(&new).filter(|(_, new)| **new).map(|(point, _)| point));
        let mut draws = 0;
        for (i, target) in self.points.iter().enumerate() {
            let Some(made) = target.made() else { continue };
            for (k, (channel, j)) in made.channels.iter().zip(neighbours(i, count)).enumerate() {
                let [here, there] = [i, j].map(|k| self.shapes[k].center().truncate());
                let (edges, other) = (target.edges.get(k), self.points[j].made());
                let job = Job { target, channel, edges, other, to_other: there - here };
                let (is_new, is_shown) = (new[i] || new[j], (i, k) == (0, 0) && self.skinned.layer().is_some());
                if is_new || is_shown {
                    Borders::find_edges(passes, view, &job);
                }
                if is_new {
                    draws += self.borders.record(passes, &job);
                }
                if is_shown {
                    self.borders.record_picture(passes, &job, &self.skinned);
                }
            }
        }
        for (point, new) in self.points.iter_mut().zip(new) {
            if new {
                point.take();
            }
        }
        draws
    }
}

impl Technique for LinearLight {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let apart_m = points(&view.light.shape, self.settings.samples, &mut self.shapes);
        self.lit = view.lit_pixels();
        let setup = self.settings.setup();
        self.points.truncate(self.shapes.len());
        self.points.resize_with(self.shapes.len(), || Point::new(gpu, &setup));
        let count = self.points.len();
        if count > 1 {
            self.skinned.make_room(gpu, self.settings.size);
        }
        for (i, point) in self.points.iter_mut().enumerate() {
            let role = if count == 2 { Role::OfTwo } else { Role::of(i, count) };
            let light = Light { shape: self.shapes[i].clone(), ..view.light.clone() };
            point.maps.prepare(gpu, &View { light: &light, ..*view }, apart_m, self.pipelines.of(role));
        }
        self.look_up(gpu, view);
        self.place(view);
        if count > 1 {
            self.borders.prepare(gpu, view, &self.shapes, &mut self.points)?;
        }
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
        self.draws = 0;
        for point in &mut self.points {
            passes.upload(&point.uniform, bytemuck::bytes_of(&point.data));
            passes.upload(&point.look_up_uniform, bytemuck::bytes_of(&point.look_up_data));
            self.draws += point.maps.record(passes, view.casters);
        }
        self.draws += self.record_shares(passes, view);
        let lit = Lit { receivers: view.receivers, pixels: self.lit };
        self.draws += match &self.both {
            Some(both) => self.pipelines.record_both(passes, lit, (&self.points[0], &both.bind_group), visibility),
            None => self.pipelines.record(passes, lit, &self.points, visibility),
        };
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("linear-light")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for LinearLight {
    fn forget(&mut self) {
        self.points.iter_mut().for_each(Point::forget);
    }

    fn stats(&self) -> Stats {
        let mut stats =
            Stats { bytes: self.borders.bytes() + self.pipelines.bytes() + self.skinned.bytes(), ..Stats::default() };
        for point in &self.points {
            let of_maps = point.maps.stats();
            stats.triangles += of_maps.triangles + 1;
            stats.casters_drawn += of_maps.casters_drawn;
            stats.casters_culled += of_maps.casters_culled;
            stats.bytes += point.bytes();
        }
        stats.draws = self.draws;
        stats
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            "map" => Some(0),
            // The texel's depth, and the share that is blended over.
            "skins" => Some(4 + 2),
            // The receiver, its texel's depth, and a share for each neighbour; or for one, what the
            // point before sees, and what is blended over.
            // The receiver, and a texel's depth and share from both ends.
            "visibility" if self.both.is_some() => Some(RECEIVER_BYTES + 2 * (4 + 2)),
            "visibility" => Some(RECEIVER_BYTES + 4 + 2 + 4 + 2),
            // What both ends see, and what is blended over.
            "pieces" => Some(2 * 4 + 2),
            _ => None,
        }
    }

    fn light_views(&self) -> &[LightView] {
        self.points.first().map_or(&[], |point| &point.maps.frame().views)
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.skinned.inspect(view);
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        pictures(&self.points, &self.skinned)
    }
}
