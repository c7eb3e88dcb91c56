//! What a light's maps are in a frame: the one value that goes from fitting to drawing, to stages
//! and to the look-up.

use super::layers::Layers;
use super::setup::Held;
use crate::casters::Casters;
use crate::passes::Passes;
use umbrage_core::light_view::{FitScene, LightView};

/// A light's maps in this frame.
#[derive(Debug, Default)]
pub struct MapFrame {
    /// Texels across and down.
    pub size: u32,
    /// The boxes that views were fitted to.
    pub scene: FitScene,
    /// Where the maps look from; empty where there is nothing to draw.
    pub views: Vec<LightView>,
    /// What the layers are.
    pub layers: Layers,
    /// Distances along the camera's view between views that split it, its ends included.
    pub borders: Vec<f64>,
    /// Share of a split over which it is blended with the next one.
    pub overlap: f64,
    /// Radius of filters, metres; 0 where it is in texels.
    pub softness_m: f64,
    /// Texels around each view that filters may look at.
    pub border_texels: f64,
    /// Texels around each view besides, for what hides the light's rim.
    pub soft_texels: f64,
    /// Texels of parallel light need not be all of one size.
    pub is_warped: bool,
    /// Depth falls linearly with the distance from the light.
    pub is_linear: bool,
    /// Which casters the maps hold.
    pub held: Held,
    /// The depth maps that are looked up, once there are some.
    pub texture: Option<wgpu::Texture>,
    /// By layer a matrix from the casters' space to clip space, where views are fitted on the GPU.
    pub(crate) matrices: Option<wgpu::Buffer>,
    /// By layer: a number that changes whenever the layer is drawn.
    pub versions: Vec<u64>,
}

impl MapFrame {
    /// True where views are from a point.
    pub fn is_from_a_point(&self) -> bool {
        self.views.first().is_some_and(LightView::is_perspective)
    }

    /// Replaces the matrix that a map's view in `uniform` starts with, where it was made on the
    /// GPU.
    pub(super) fn take_matrix(&self, passes: &mut Passes<'_>, layer: u32, uniform: &wgpu::Buffer) {
        const BYTES: u64 = size_of::<[[f32; 4]; 4]>() as u64;
        if let Some(matrices) = &self.matrices {
            passes.encoder().copy_buffer_to_buffer(matrices, u64::from(layer) * BYTES, uniform, 0, BYTES);
        }
    }

    /// Leaves out what the maps do not hold.
    pub(super) fn keep_held(&self, casters: &Casters, places: &mut Vec<u32>) {
        if self.held == Held::Masked {
            places.retain(|place| casters.placed()[*place as usize].masked);
        }
    }

    /// Changes whenever this layer of the maps does.
    pub fn version(&self, layer: u32) -> u64 {
        self.versions.get(layer as usize).copied().unwrap_or_default()
    }
}
