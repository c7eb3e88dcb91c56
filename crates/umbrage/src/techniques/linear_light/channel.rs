//! Channels of a map: for each texel the share of the light up to a neighbour of the map's point.

use super::steps::MAPS;
use super::uniform::SkinLayer;
use crate::fullscreen::{UNIFORM, attachment, bind, layer_view, layout, target_texture};
use crate::gpu::Gpu;
use crate::passes::Passes;
use umbrage_core::glam::DVec3;

/// Shares of a piece of the light, and more than all where there is no blocker.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R16Float;

/// No blocker was found: more than any share.
pub(super) const NONE: f64 = 2.0;

/// What skins are blended with: the blocker that hides most counts, whatever order they are drawn
/// in.
pub(super) fn least() -> wgpu::ColorTargetState {
    let least = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Min,
    };
    wgpu::ColorTargetState { blend: Some(wgpu::BlendState { color: least, alpha: least }), ..FORMAT.into() }
}

/// Of what skins are drawn into, group 3: the map, its point and the layer.
pub(super) fn into_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "skin layer", wgpu::ShaderStages::VERTEX_FRAGMENT, &[MAPS, UNIFORM, UNIFORM])
}

/// For each texel of a point's maps the share of the light from there to a neighbour.
pub(super) struct Channel {
    layers: Vec<ChannelLayer>,
}

/// One layer of a channel.
pub(super) struct ChannelLayer {
    view: wgpu::TextureView,
    uniform: wgpu::Buffer,
    pub bind_group: wgpu::BindGroup,
}

impl Channel {
    /// Names a layer and the direction of the neighbour; `None` where there is no such layer.
    pub fn upload(&self, passes: &mut Passes<'_>, layer: u32, to_other: DVec3) -> Option<&ChannelLayer> {
        let found = self.layers.get(layer as usize)?;
        let into = SkinLayer { to_other: to_other.as_vec3().to_array(), layer };
        passes.upload(&found.uniform, bytemuck::bytes_of(&into));
        Some(found)
    }
}

impl ChannelLayer {
    /// To draw skins into, after nothing.
    pub fn attachment(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        attachment(&self.view, wgpu::LoadOp::Clear(wgpu::Color { r: NONE, g: NONE, b: NONE, a: NONE }))
    }
}

/// The texture of the channels of a point with so many neighbours, and the channels: as large as
/// its maps, with all layers of the first channel before those of the second. `into` is
/// [`into_layout`], `resources` are the maps and the uniform of the point.
pub(super) fn channels(
    gpu: &Gpu,
    into: &wgpu::BindGroupLayout,
    maps: &wgpu::Texture,
    resources: [wgpu::BindingResource<'_>; 2],
    neighbours: u32,
) -> (wgpu::Texture, Vec<Channel>) {
    let count = maps.depth_or_array_layers();
    // A light that is one point has no channel, and what is bound in its place is not read.
    let (size, layers) =
        if neighbours == 0 { ((1, 1), 1) } else { ((maps.width(), maps.height()), count * neighbours) };
    let texture = target_texture(gpu, "shares of a light", size, layers, FORMAT);
    let layer = |layer| {
        let view = layer_view(&texture, layer);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer("skin layer", &[SkinLayer::default()], usage);
        let [maps, point] = resources.clone();
        let bind_group = bind(gpu, "skin layer", into, &[maps, point, uniform.as_entire_binding()]);
        ChannelLayer { view, uniform, bind_group }
    };
    let channel = |i| Channel { layers: (i * count..(i + 1) * count).map(layer).collect() };
    let channels = (0..neighbours).map(channel).collect();
    (texture, channels)
}
