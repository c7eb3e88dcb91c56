//! The look-ups of all points, and how what they see adds up.

use super::channel::NONE;
use super::light::weight;
use super::point::Point;
use super::uniform::PointLookup;
use crate::depth_maps::{Blend, Lookup};
use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind, layout, target_texture};
use crate::shader::HostConstant;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, visibility::VisibilityTarget};
use umbrage_core::glam::DVec3;

/// What `linear_light.wgsl` calls it.
pub(super) const CONSTANTS: &[HostConstant] = &[("NONE", NONE)];

/// Of what a point sees of a pixel, to both sides.
const SHARES: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;

/// Pipelines of all points.
pub(super) struct Pipelines {
    /// Of a light that is one point, of ends and of points between two others.
    lookups: [Lookup; 3],
    own: wgpu::BindGroupLayout,
    both: wgpu::BindGroupLayout,
    piece: wgpu::RenderPipeline,
    seen: Option<Seen>,
}

/// What two points in turn see of each pixel.
struct Seen {
    size: (u32, u32),
    views: [wgpu::TextureView; 2],
    /// With either of them first.
    both: [wgpu::BindGroup; 2],
}

impl Pipelines {
    pub fn new(gpu: &Gpu, threshold: f64) -> Self {
        let shares = wgpu::BindingType::Texture {
            sample_type: FLOATS,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let own = layout(gpu, "shares", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, shares]);
        let both = layout(gpu, "both ends", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS); 2]);
        let module = super::PIECES.module(gpu);
        let target = weighted();
        let piece =
            Fullscreen { label: "piece", module: &module, entry: "piece", groups: &[&both], target, constants: &[] };
        let lookup = |neighbours: f64| {
            let constants = [("NEIGHBOURS", neighbours), ("THRESHOLD", threshold)];
            Lookup::new(gpu, &super::LOOKUP, Blend::Off, &constants, Some(own.clone()))
        };
        Self {
            lookups: [lookup(0.0), lookup(1.0).into("point_shares", SHARES), lookup(2.0).into("point_shares", SHARES)],
            piece: piece.pipeline(gpu),
            own,
            both,
            seen: None,
        }
    }

    /// The look-up of a point with so many neighbours.
    pub fn of(&mut self, neighbours: usize) -> &mut Lookup {
        &mut self.lookups[neighbours.min(2)]
    }

    /// For the texture of a point's channels.
    pub fn bind(&self, gpu: &Gpu, uniform: &wgpu::Buffer, shares: &wgpu::Texture) -> wgpu::BindGroup {
        let view = shares.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resources = [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(&view)];
        bind(gpu, "shares", &self.own, &resources)
    }

    /// Makes room for what points see in a picture of this size.
    pub fn make_room(&mut self, gpu: &Gpu, size: (u32, u32)) {
        if self.seen.as_ref().is_some_and(|seen| seen.size == size) {
            return;
        }
        let texture = || target_texture(gpu, "seen of a light", size, 1, SHARES);
        let views = [texture(), texture()].map(|texture| texture.create_view(&Default::default()));
        let resources = [0, 1].map(|i: usize| wgpu::BindingResource::TextureView(&views[i]));
        let [a, b] = resources;
        let both = [[a.clone(), b.clone()], [b, a]].map(|both| bind(gpu, "both ends", &self.both, &both));
        self.seen = Some(Seen { size, views, both });
    }

    /// Looks up all points and adds up the pieces between; returns the number of draws.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        points: &[Point],
        visibility: &VisibilityTarget,
    ) -> u32 {
        if let [point] = points {
            let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
            let Some(made) = point.made() else { return 0 };
            return self.lookups[0].draw(&mut pass, receivers, &point.maps.input, Some(&made.look_up));
        }
        let Some(seen) = &self.seen else { return 0 };
        let mut draws = 0;
        for (i, point) in points.iter().enumerate() {
            draws += self.record_point(passes, receivers, point, &seen.views[i % 2]);
            if i > 0 {
                let load = if i == 1 { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
                let mut pass = passes.render("pieces", &[attachment(&visibility.view, load)], None);
                let weight = weight(i - 1, points.len() - 1);
                pass.set_blend_constant(wgpu::Color { r: weight, g: weight, b: weight, a: weight });
                pass.set_pipeline(&self.piece);
                pass.set_bind_group(0, &seen.both[(i - 1) % 2], &[]);
                pass.draw(0..3, 0..1);
                draws += 1;
            }
        }
        draws
    }

    /// A point without maps is seen by all.
    fn record_point(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        point: &Point,
        target: &wgpu::TextureView,
    ) -> u32 {
        let all = wgpu::LoadOp::Clear(wgpu::Color { r: 0.5, g: 0.5, b: 0.5, a: 0.5 });
        let mut pass = passes.render("visibility", &[attachment(target, all)], None);
        let Some(made) = point.made() else { return 0 };
        let lookup = &self.lookups[made.channels.len().min(2)];
        lookup.draw(&mut pass, receivers, &point.maps.input, Some(&made.look_up))
    }

    pub fn bytes(&self) -> u64 {
        let seen = self.seen.as_ref().map_or(0, |seen| 2 * 4 * u64::from(seen.size.0) * u64::from(seen.size.1));
        self.lookups.iter().map(Lookup::bytes).sum::<u64>() + seen
    }
}

/// Adds what is drawn, times the pass's blend constant.
fn weighted() -> wgpu::ColorTargetState {
    let color = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Constant,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    let blend = Some(wgpu::BlendState { color, alpha: color });
    wgpu::ColorTargetState { blend, ..VisibilityTarget::FORMAT.into() }
}

impl PointLookup {
    /// From positions relative to the eye; `layers` of shares for each neighbour.
    pub(super) fn of(here: DVec3, neighbours: impl Iterator<Item = DVec3>, layers: u32) -> Self {
        let mut lookup = Self { here: here.as_vec3().to_array(), layers, ..Self::default() };
        for (place, neighbour) in lookup.neighbours.iter_mut().zip(neighbours) {
            *place = neighbour.as_vec3().extend(0.0).to_array();
        }
        lookup
    }
}
