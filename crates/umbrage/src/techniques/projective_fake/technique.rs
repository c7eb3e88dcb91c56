//! A frame: choose planes and casters, draw a texture for each plane, look it up.

use super::draws::{Draws, LIT, TEXEL_BYTES};
use super::planes::{Blur, clip_from_eye};
use crate::depth_maps::RECEIVER_BYTES;
use crate::fullscreen::attachment;
use crate::planar::{Chosen, Finder, LitPlane, Shadows, Wanted};
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{error::Error, gpu::Gpu, inline::Lent, passes::Passes, view::View, visibility::VisibilityTarget};

/// What can be asked for: the textures of the first planes.
pub(super) const NAMES: &[&str] = &["texture-0", "texture-1", "texture-2", "texture-3"];

/// See the module of the technique.
pub(super) struct Filtered {
    wanted: Wanted,
    blur: Blur,
    chosen: Chosen,
    finder: Finder,
    shadows: Shadows,
    draws: Draws,
    stats: Stats,
    /// The light casts shadows, and there is something to cast them.
    is_shadowed: bool,
}

impl Filtered {
    pub fn new(gpu: &Gpu, settings: &super::ProjectiveFake) -> Result<Self, Error> {
        gpu.check_size("a texture of a plane", settings.size, settings.size)?;
        let shadows = Shadows::new(gpu);
        Ok(Self {
            wanted: Wanted { planes: settings.planes, tolerance: settings.tolerance, cull: settings.cull },
            blur: Blur {
                softness: settings.softness,
                kernel: settings.kernel,
                radius_m: settings.radius_m,
                size: settings.size,
            },
            chosen: Chosen::default(),
            finder: Finder::new(gpu),
            draws: Draws::new(gpu, &shadows),
            shadows,
            stats: Stats::default(),
            is_shadowed: false,
        })
    }

    fn upload(&mut self, passes: &mut Passes<'_>, view: &View<'_>) {
        let planes = self.chosen.planes();
        self.finder.upload(passes, view, &self.chosen);
        passes.upload(&self.draws.uniform, bytemuck::bytes_of(&self.blur.textures(view, planes)));
        let blur = self.blur;
        self.shadows.upload(
            passes,
            view,
            planes.iter().map(|plane| {
                let drawn = LitPlane { highest: blur.highest(view, plane), ..plane.clone() };
                (drawn, clip_from_eye(view, plane, blur.rectangle(plane)), NEAREST)
            }),
        );
        self.chosen.upload(passes);
    }

    fn draw(&self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        for plane in 0..self.chosen.planes().len() {
            let Some(layer) = self.draws.layer(plane) else { continue };
            let clear = wgpu::LoadOp::Clear(wgpu::Color { r: LIT, ..wgpu::Color::TRANSPARENT });
            let mut pass = passes.render("heights of casters", &[attachment(layer, clear)], None);
            self.shadows.bind(&mut pass, plane);
            self.chosen.draw(&mut pass, view.casters, plane, |surface, form| self.draws.cast(surface, form));
        }
        let Some((pipeline, textures)) = self.draws.lookup() else { return };
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &self.finder.bind_group, &[]);
        pass.set_bind_group(2, textures, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Half the least w in a texture's clip space.
const NEAREST: f64 = 0.5;

impl Technique for Filtered {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let blur = self.blur;
        self.chosen.update(gpu, view, &self.wanted, |plane| blur.margin(view, plane));
        let planes = self.chosen.planes().len() as u32;
        self.draws.follow(gpu, &self.shadows, view.casters.forms());
        self.draws.prepare(gpu, view.receivers, &self.finder, planes, &self.blur);
        self.shadows.prepare(gpu, view.receivers);
        let lists = self.chosen.lists();
        let drawn = lists.iter().map(|list| list.drawn()).sum();
        let casting = view.casters.casting().len() as u32;
        self.is_shadowed = view.light.casts && casting > 0;
        let texture = self.draws.texture();
        let texels = texture.map_or(0, |t| 2 * u64::from(t.width()) * u64::from(t.height()));
        self.stats = Stats {
            draws: 1 + lists.iter().map(|list| list.draws()).sum::<u32>(),
            triangles: 1 + lists.iter().map(|list| list.triangles(view.casters)).sum::<u64>(),
            casters_drawn: drawn,
            casters_culled: (planes * casting).saturating_sub(drawn),
            bytes: texels * texture.map_or(0, |t| t.depth_or_array_layers().into())
                + self.shadows.bytes()
                + self.chosen.bytes(),
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
        if self.is_shadowed {
            self.upload(passes, view);
            self.draw(passes, view, visibility);
        } else {
            passes.render("visibility", &[visibility.overwrite()], None);
        }
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("projective-fake")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Filtered {
    fn stats(&self) -> Stats {
        self.stats
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        match pass {
            // What is blended over.
            "heights of casters" => Some(TEXEL_BYTES),
            "visibility" => Some(RECEIVER_BYTES + self.blur.texels() * TEXEL_BYTES),
            _ => None,
        }
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        self.chosen.counts()
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        let Some(texture) = self.draws.texture().filter(|_| self.is_shadowed) else { return Vec::new() };
        let planes = self.chosen.planes().len() as u32;
        (0..planes).zip(NAMES).map(|(layer, name)| DebugView { name, texture, layer }).collect()
    }
}
