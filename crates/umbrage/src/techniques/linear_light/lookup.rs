//! The look-ups of all points, and how what they see adds up.

use super::channel::NONE;
use super::light::weight;
use super::point::Point;
use super::uniform::PointLookup;
use crate::depth_maps::{Blend, Lookup};
use crate::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind, layer_view, layout, target_texture};
use crate::shader::HostConstant;
use crate::{gpu::Gpu, passes::Passes, receivers::Receivers, visibility::VisibilityTarget};
use umbrage_core::glam::DVec3;

/// What `linear_light.wgsl` calls it.
pub(super) const CONSTANTS: &[HostConstant] = &[("NONE", NONE)];

/// Of what a point sees of a pixel, to both sides.
const SHARES: wgpu::TextureFormat = wgpu::TextureFormat::Rg16Float;

/// Pipelines of all points.
pub(super) struct Pipelines {
    /// In the order of [`Role`].
    lookups: [Lookup; 5],
    own: wgpu::BindGroupLayout,
    both: wgpu::BindGroupLayout,
    piece: wgpu::RenderPipeline,
    seen: Option<Seen>,
}

/// What a point is in its light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// The light is one point.
    Alone,
    /// One end.
    First,
    Between,
    /// The other end, which adds up the last piece of the light.
    Last,
    /// That where there is no other piece.
    Second,
}

impl Role {
    fn of(i: usize, count: usize) -> Self {
        match (i, count) {
            (_, 1) => Self::Alone,
            (0, _) => Self::First,
            (1, 2) => Self::Second,
            _ if i + 1 == count => Self::Last,
            _ => Self::Between,
        }
    }
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
        let bindings = [UNIFORM, shares, fullscreen::texture(FLOATS)];
        let own = layout(gpu, "shares", wgpu::ShaderStages::FRAGMENT, &bindings);
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
            lookups: [
                lookup(0.0),
                lookup(1.0).into("point_shares", SHARES),
                lookup(2.0).into("point_shares", SHARES),
                lookup(1.0).into("last_piece", weighted()),
                lookup(1.0).into("last_piece", VisibilityTarget::FORMAT),
            ],
            piece: piece.pipeline(gpu),
            own,
            both,
            seen: None,
        }
    }

    /// The look-up of point `i` of so many.
    pub fn of(&mut self, i: usize, count: usize) -> &mut Lookup {
        &mut self.lookups[Role::of(i, count) as usize]
    }

    /// What the point before point `i` sees of each pixel; `None` where there is no room for it.
    pub fn before(&self, i: usize) -> Option<&wgpu::TextureView> {
        self.seen.as_ref().map(|seen| &seen.views[(i + 1) % 2])
    }

    /// For the texture of a point's channels, and what the point before sees.
    pub fn bind(
        &self,
        gpu: &Gpu,
        uniform: &wgpu::Buffer,
        shares: &wgpu::Texture,
        before: Option<&wgpu::TextureView>,
    ) -> wgpu::BindGroup {
        // What a single point binds in its place is not read.
        let before = before.cloned().unwrap_or_else(|| layer_view(shares, 0));
        let view = shares.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let textures = [&view, &before].map(wgpu::BindingResource::TextureView);
        let [view, before] = textures;
        bind(gpu, "shares", &self.own, &[uniform.as_entire_binding(), view, before])
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
        let mut draws = 0;
        for (i, point) in points.iter().enumerate() {
            let weight = weight(i.saturating_sub(1), points.len() - 1);
            let load = if i == 1 { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
            let visibility = attachment(&visibility.view, load);
            if let Some(made) = point.made().filter(|_| i + 1 == points.len()) {
                let mut pass = passes.render("visibility", &[visibility], None);
                set_weight(&mut pass, weight);
                let lookup = &self.lookups[Role::of(i, points.len()) as usize];
                draws += lookup.draw(&mut pass, receivers, &point.maps.input, Some(&made.look_up));
            } else {
                draws += self.record_point(passes, receivers, (point, i, points.len()));
                if i > 0 {
                    draws += self.record_piece(passes, i - 1, visibility, weight);
                }
            }
        }
        draws
    }

    /// A point without maps is seen by all.
    fn record_point(
        &self,
        passes: &mut Passes<'_>,
        receivers: &Receivers,
        (point, i, count): (&Point, usize, usize),
    ) -> u32 {
        let all = wgpu::LoadOp::Clear(wgpu::Color { r: 0.5, g: 0.5, b: 0.5, a: 0.5 });
        // What the next point is before.
        let Some(target) = self.before(i + 1) else { return 0 };
        let mut pass = passes.render("visibility", &[attachment(target, all)], None);
        let Some(made) = point.made() else { return 0 };
        let lookup = &self.lookups[Role::of(i, count) as usize];
        lookup.draw(&mut pass, receivers, &point.maps.input, Some(&made.look_up))
    }

    /// Adds up what both ends of a piece see.
    fn record_piece(
        &self,
        passes: &mut Passes<'_>,
        i: usize,
        visibility: Option<wgpu::RenderPassColorAttachment<'_>>,
        weight: f64,
    ) -> u32 {
        let Some(seen) = &self.seen else { return 0 };
        let mut pass = passes.render("pieces", &[visibility], None);
        set_weight(&mut pass, weight);
        pass.set_pipeline(&self.piece);
        pass.set_bind_group(0, &seen.both[i % 2], &[]);
        pass.draw(0..3, 0..1);
        1
    }

    pub fn bytes(&self) -> u64 {
        let seen = self.seen.as_ref().map_or(0, |seen| 2 * 4 * u64::from(seen.size.0) * u64::from(seen.size.1));
        self.lookups.iter().map(Lookup::bytes).sum::<u64>() + seen
    }
}

fn set_weight(pass: &mut wgpu::RenderPass<'_>, weight: f64) {
    pass.set_blend_constant(wgpu::Color { r: weight, g: weight, b: weight, a: weight });
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
