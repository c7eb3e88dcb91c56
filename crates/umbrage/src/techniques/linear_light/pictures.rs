//! Pictures of what is inside: maps, skins and channels of the light's first point, towards the
//! next one.

use super::point::Point;
use super::uniform::VIEWS;
use crate::fullscreen::{attachment, target_texture};
use crate::gpu::Gpu;
use crate::technique::DebugView;

/// What can be asked for: [`VIEWS`] of each kind.
pub(super) const NAMES: &[&str] = &[
    "map-0", "map-1", "map-2", "map-3", "map-4", "map-5", "shares-0", "shares-1", "shares-2", "shares-3", "shares-4",
    "shares-5", "skins-0", "skins-1", "skins-2", "skins-3", "skins-4", "skins-5",
];

/// Of skins.
pub(super) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// The skins of a layer, drawn when somebody looks at them.
#[derive(Default)]
pub(super) struct Skinned {
    layer: Option<u32>,
    made: Option<(u32, wgpu::Texture, wgpu::TextureView)>,
}

impl Skinned {
    /// Shows the layer of that name, or none.
    pub fn inspect(&mut self, view: Option<&str>) {
        let of_skins = NAMES.iter().skip(2 * VIEWS);
        self.layer = view.and_then(|view| (0..).zip(of_skins).find(|(_, name)| **name == view).map(|(layer, _)| layer));
        self.made = None;
    }

    /// The layer that is shown.
    pub fn layer(&self) -> Option<u32> {
        self.layer
    }

    /// Makes room for a map of so many texels a side.
    pub fn make_room(&mut self, gpu: &Gpu, size: u32) {
        if self.layer.is_some() && self.made.as_ref().is_none_or(|(made, ..)| *made != size) {
            let texture = target_texture(gpu, "skins", (size, size), 1, FORMAT);
            let view = texture.create_view(&Default::default());
            self.made = Some((size, texture, view));
        }
    }

    /// To draw into, after nothing.
    pub fn attachment(&self) -> Option<wgpu::RenderPassColorAttachment<'_>> {
        let (_, _, view) = self.made.as_ref()?;
        attachment(view, wgpu::LoadOp::Clear(wgpu::Color::BLACK))
    }

    fn view(&self) -> Option<DebugView<'_>> {
        let (_, texture, _) = self.made.as_ref()?;
        Some(DebugView { name: NAMES[2 * VIEWS + self.layer? as usize % VIEWS], texture, layer: 0 })
    }

    pub fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |(size, ..)| 4 * u64::from(*size) * u64::from(*size))
    }
}

/// All pictures of the last frame.
pub(super) fn pictures<'a>(points: &'a [Point], skinned: &'a Skinned) -> Vec<DebugView<'a>> {
    let Some(first) = points.first() else { return Vec::new() };
    let named = |kind: usize, texture: &'a wgpu::Texture, layer: u32| DebugView {
        name: NAMES[kind * VIEWS + layer as usize % VIEWS],
        texture,
        layer,
    };
    let maps = first.maps.frame().texture.as_ref();
    let shares = first.made().filter(|_| points.len() > 1).map(|made| &made.shares);
    let of_maps = maps.into_iter().flat_map(|texture| first.layers().map(move |layer| named(0, texture, layer)));
    let of_shares = shares.into_iter().flat_map(|texture| first.layers().map(move |layer| named(1, texture, layer)));
    of_maps.chain(of_shares).chain(skinned.view()).collect()
}
