//! What the shader that looks maps up has to know: the eye, the views and the light's extent.

use super::extent::LightExtent;
use super::layer::MapLayer;
use super::steady::{OUTSIDE, share_first};
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::layers::{LAYER_CONSTANTS, LOOKUP_LAYERS, MOST_LAYERS};
use crate::depth_maps::setup::Bias;
use crate::depth_maps::texels::{matrix, near, view_distance};
use crate::{receivers::Eye, shader::Shared, shader::shader_struct, view::View};
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat4, DVec4};
use umbrage_core::light_view::FARTHEST;

shader_struct! {
    /// See `map_layers.wgsl`.
    pub(crate) struct MapLookup {
        eye: Eye,
        ndc_from_eye: [[f32; 4]; 4],
        layers: [MapLayer; LOOKUP_LAYERS],
        from_light: [[f32; 4]; 4],
        rounding: [f32; 2],
        size: f32,
        bias: f32,
        caster_rounding: f32,
        farthest: f32,
        last_split: f32,
        softness: f32,
        offsets: [f32; 2],
        outlined: f32,
        jitter: f32,
        view_distance: [f32; 4],
        splits: [[f32; 4]; 2],
        blends: [[f32; 4]; 2],
        light: LightExtent,
    }
}

/// What the host has to agree on with `map_layers.wgsl`.
pub(in crate::depth_maps) const SHARED: Shared = Shared {
    module: "map_layers",
    layouts: &[MapLayer::LAYOUT, LightExtent::LAYOUT, MapLookup::LAYOUT],
    constants: LAYER_CONSTANTS,
};

impl MapLookup {
    /// For the maps of this frame, to look up receivers whose places are in `space`.
    pub(super) fn new(view: &View<'_>, maps: &MapFrame, bias: Bias, space: Space) -> Self {
        let ndc_from_eye = view.clip_from_eye();
        let eye_from_place = match space {
            Space::Ndc => ndc_from_eye.inverse(),
            Space::Eye => DMat4::IDENTITY,
        };
        // A layer that was not rendered sends every point outside of the map, where all is lit.
        let outside = DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(-1.0, -1.0, 0.0, 1.0));
        let nothing = MapLayer { map_from_place: matrix(&outside), from_first: OUTSIDE, ..MapLayer::default() };
        let mut layers = [nothing; LOOKUP_LAYERS];
        let world_from_place = DMat4::from_translation(view.camera.eye) * eye_from_place;
        for v in &maps.views {
            layers[v.layer as usize] = MapLayer::of(v, &world_from_place, &maps.scene.casters);
        }
        share_first(&maps.views, &mut layers);
        Self {
            eye: Eye::new(view),
            ndc_from_eye: matrix(&ndc_from_eye),
            layers,
            from_light: matrix(&(from_light(view) * eye_from_place)),
            size: maps.size as f32,
            rounding: rounding(maps),
            bias: bias.factor() as f32,
            offsets: bias.offsets().unwrap_or_default().map(|offset| offset as f32),
            caster_rounding: (largest_coordinate(view) * 2.4e-7 + storage_rounding(maps)) as f32,
            farthest: FARTHEST as f32,
            softness: maps.softness_m as f32,
            outlined: if view.casters.has_masked() { 0.0 } else { 1.0 },
            light: LightExtent::of(&view.light.shape),
            ..Self::splits(view, maps, &eye_from_place)
        }
    }
}

impl MapLookup {
    /// Has the layers of another point's maps besides, which have as many texels.
    pub(super) fn join(&mut self, other: &Self) {
        let half = LOOKUP_LAYERS / 2;
        self.layers[half..].copy_from_slice(&other.layers[..half]);
        self.caster_rounding = self.caster_rounding.max(other.caster_rounding);
    }
}

impl MapLookup {
    /// What chooses the split of a pixel.
    fn splits(view: &View<'_>, maps: &MapFrame, eye_from_place: &DMat4) -> Self {
        let [mut splits, mut blends] = [[f32::MAX; MOST_LAYERS - 1]; 2];
        for (i, ends) in
            maps.borders.windows(2).take(maps.borders.len().saturating_sub(2)).enumerate().take(MOST_LAYERS - 1)
        {
            splits[i] = ends[1] as f32;
            blends[i] = (ends[1] - maps.overlap * (ends[1] - ends[0])) as f32;
        }
        let halves = |v: [f32; MOST_LAYERS - 1]| [[v[0], v[1], v[2], v[3]], [v[4], v[5], v[6], v[7]]];
        Self {
            splits: halves(splits),
            blends: halves(blends),
            last_split: maps.borders.last().map_or(f32::MAX, |last| *last as f32),
            view_distance: view_distance(view, eye_from_place),
            ..Self::default()
        }
    }
}

/// Where a receiver's place is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Space {
    /// In the camera's normalised device coordinates, as full-screen passes have it.
    Ndc,
    /// Relative to the eye, as shaders of hosts have it.
    Eye,
}

/// Takes what is relative to the eye to the way from the light, times w: from a point's centre,
/// and along parallel light, which goes the same way everywhere.
fn from_light(view: &View<'_>) -> DMat4 {
    let center = view.light.shape.center();
    let [x, y, z] = [DVec4::X, DVec4::Y, DVec4::Z].map(|axis| axis * center.w);
    let eye = view.camera.eye * center.w - center.truncate();
    DMat4::from_cols(x, y, z, eye.extend(1.0))
}

/// Largest coordinate that the vertex shader computes with, metres: what rounding goes by.
fn largest_coordinate(view: &View<'_>) -> f64 {
    let origin = view.casters.origin();
    let casters = view.casters.casting_content();
    let casters = Bounds { min: casters.min - origin, max: casters.max - origin };
    let center = view.light.shape.center();
    let light = (center.truncate() - origin).abs().max_element() * center.w;
    light.max(casters.largest_coordinate())
}

/// Depth 0…1 in single precision; perspective depth keeps its relative precision, parallel depth
/// does not. In a paraboloid each texel's depth comes from differences between neighbours, which
/// round more.
fn rounding(maps: &MapFrame) -> [f32; 2] {
    match maps.views.first() {
        Some(view) if view.paraboloid.is_some() => [2e-5, 0.0],
        Some(view) if view.is_perspective() => [2e-6, 0.0],
        _ => [0.0, 1e-6],
    }
}

/// What storing a linear depth rounds, metres: the same at every distance.
fn storage_rounding(maps: &MapFrame) -> f64 {
    let view = maps.views.first().filter(|_| maps.is_linear);
    view.map_or(0.0, |view| 1e-6 * near(view) / FARTHEST)
}
