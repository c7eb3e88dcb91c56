//! The look-ups of all points, and how what they see adds up.

use super::channel::NONE;
use super::light::weight;
use super::point::{Made, Point};
use super::steps::MAPS;
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
    /// Of two points that are looked up at once.
    of_two: wgpu::BindGroupLayout,
    both: wgpu::BindGroupLayout,
    piece: wgpu::RenderPipeline,
    seen: Option<Seen>,
}

/// What a point is in its light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// The light is one point.
    Alone,
    /// One end.
    First,
    Between,
    /// The other end, which adds up the last piece of the light.
    Last,
    /// One of two points that are looked up at once.
    OfTwo,
}

impl Role {
    /// Of point `i` of so many.
    pub fn of(i: usize, count: usize) -> Self {
        match (i, count) {
            (_, 1) => Self::Alone,
            (0, _) => Self::First,
            _ if i + 1 == count => Self::Last,
            _ => Self::Between,
        }
    }
}

/// Where points are looked up.
#[derive(Clone, Copy)]
pub(super) struct Lit<'a> {
    pub receivers: &'a Receivers,
    /// The pixels that the light can light: the first, and how many.
    pub pixels: [u32; 4],
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
        let bindings = [UNIFORM, shares, fullscreen::texture(FLOATS), shares, MAPS];
        let of_two = layout(gpu, "shares of both ends", wgpu::ShaderStages::FRAGMENT, &bindings);
        let both = layout(gpu, "both ends", wgpu::ShaderStages::FRAGMENT, &[fullscreen::texture(FLOATS); 2]);
        let module = super::PIECES.module(gpu);
        let target = weighted();
        let piece =
            Fullscreen { label: "piece", module: &module, entry: "piece", groups: &[&both], target, constants: &[] };
        let lookup_of = |neighbours: f64, layout: &wgpu::BindGroupLayout| {
            let constants = [("NEIGHBOURS", neighbours), ("THRESHOLD", threshold)];
            Lookup::new(gpu, &super::LOOKUP, Blend::Off, &constants, Some(layout.clone()))
        };
        let lookup = |neighbours| lookup_of(neighbours, &own);
        Self {
            lookups: [
                lookup(0.0),
                lookup(1.0).into("point_shares", SHARES),
                lookup(2.0).into("point_shares", SHARES),
                lookup(1.0).into("last_piece", weighted()),
                lookup_of(1.0, &of_two).into("both_ends", VisibilityTarget::FORMAT),
            ],
            piece: piece.pipeline(gpu),
            own,
            of_two,
            both,
            seen: None,
        }
    }

    /// The look-up of a point.
    pub fn of(&mut self, role: Role) -> &mut Lookup {
        &mut self.lookups[role as usize]
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

    /// The same for both of two points, for the first one's shares and what belongs to the other.
    pub fn bind_both(&self, gpu: &Gpu, uniform: &wgpu::Buffer, [first, other]: [&Made; 2]) -> wgpu::BindGroup {
        let whole = |texture: &wgpu::Texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..Default::default()
            })
        };
        let views = [&first.shares, &other.shares, &other.maps].map(whole);
        // No point before is read.
        let before = layer_view(&first.shares, 0);
        let textures = [&views[0], &before, &views[1], &views[2]].map(wgpu::BindingResource::TextureView);
        let [own, before, shares, maps] = textures;
        let resources = [uniform.as_entire_binding(), own, before, shares, maps];
        bind(gpu, "shares of both ends", &self.of_two, &resources)
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
        lit: Lit<'_>,
        points: &[Point],
        visibility: &VisibilityTarget,
    ) -> u32 {
        if let [point] = points {
            let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
            let made = point.made();
            return made.map_or(0, |made| self.draw(&mut pass, lit, Role::Alone, (point, &made.look_up)));
        }
        let (mut draws, count) = (0, points.len());
        for (i, point) in points.iter().enumerate() {
            let weight = weight(i.saturating_sub(1), count - 1);
            let load = if i == 1 { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) } else { wgpu::LoadOp::Load };
            let visibility = attachment(&visibility.view, load);
            if let Some(made) = point.made().filter(|_| i + 1 == count) {
                let mut pass = passes.render("visibility", &[visibility], None);
                set_weight(&mut pass, weight);
                let (lookup, more) = (&self.lookups[Role::Last as usize], Some(&made.look_up));
                draws += lookup.draw(&mut pass, lit.receivers, &point.maps.input, more);
            } else {
                draws += self.record_point(passes, lit, (point, i, count));
                if i > 0 {
                    draws += self.record_piece(passes, i - 1, visibility, weight);
                }
            }
        }
        draws
    }

    /// Looks up both of two points at once; `first` has joined the other one.
    pub fn record_both(
        &self,
        passes: &mut Passes<'_>,
        lit: Lit<'_>,
        (first, both): (&Point, &wgpu::BindGroup),
        visibility: &VisibilityTarget,
    ) -> u32 {
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        self.draw(&mut pass, lit, Role::OfTwo, (first, both))
    }

    /// A point without maps is seen by all, and so is every point where the light lights nothing.
    fn record_point(&self, passes: &mut Passes<'_>, lit: Lit<'_>, (point, i, count): (&Point, usize, usize)) -> u32 {
        let all = wgpu::LoadOp::Clear(wgpu::Color { r: 0.5, g: 0.5, b: 0.5, a: 0.5 });
        // What the next point is before.
        let Some(target) = self.before(i + 1) else { return 0 };
        let mut pass = passes.render("visibility", &[attachment(target, all)], None);
        let role = Role::of(i, count);
        point.made().map_or(0, |made| self.draw(&mut pass, lit, role, (point, &made.look_up)))
    }

    /// A look-up where the light can light anything.
    fn draw(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        lit: Lit<'_>,
        role: Role,
        (point, more): (&Point, &wgpu::BindGroup),
    ) -> u32 {
        let [x, y, width, height] = lit.pixels;
        if width == 0 || height == 0 {
            return 0;
        }
        pass.set_scissor_rect(x, y, width, height);
        self.lookups[role as usize].draw(pass, lit.receivers, &point.maps.input, Some(more))
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
    /// From a position relative to the eye and the ways from there to its neighbours; `layers` of
    /// shares for each of them.
    pub(super) fn of(here: DVec3, ways: impl Iterator<Item = DVec3>, layers: u32) -> Self {
        let mut lookup = Self { here: here.as_vec3().to_array(), layers, ..Self::default() };
        for (neighbour, way) in lookup.neighbours.iter_mut().zip(ways) {
            *neighbour = way.as_vec3().extend(0.0).to_array();
        }
        lookup
    }
}
