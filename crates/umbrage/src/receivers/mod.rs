//! What shadows fall on: the depth buffer of the view, and normals where the host has them.

pub(crate) mod check;
mod eye;

use crate::fullscreen::{self, bind};
use crate::shader::Shared;
use crate::{error::Error, gpu::Gpu};
pub use eye::Eye;

/// What the host has to agree on with `eye.wgsl`.
pub(crate) const SHARED: Shared = Shared { module: "eye", layouts: &[Eye::LAYOUT], constants: &[] };

/// Depth (and normals) of the visible surfaces, made once per size.
///
/// Depth has 24 bits or floats and one sample a pixel; of a format with stencil, the view is of the
/// depth alone. All surfaces in it that shadows should fall on have to be among the
/// [`crate::Casters`], those that cast none too: maps are fitted to them. Normals are `R32Uint`:
/// the geometric normal in world space, turned to the eye, packed by the function in
/// [`crate::wgsl::PACK_NORMAL`]. Without them normals come from the depth itself, which costs a
/// little and is less exact at the edges of surfaces.
#[derive(Clone, Debug)]
pub struct Receivers {
    /// Pixels across and down.
    pub size: (u32, u32),
    pub(crate) has_normals: bool,
    pub(crate) bind_group: wgpu::BindGroup,
    pub(crate) depth: wgpu::TextureView,
    pub(crate) stencil: Option<wgpu::TextureView>,
    /// Pixels by which the rasteriser may have shifted surfaces.
    pub(crate) snapping: f32,
    /// Pixels by which depth that was continued from elsewhere in a pixel may be shifted.
    pub(crate) bend: f32,
    /// Steps of single precision by which depth may be off.
    pub(crate) coarseness: f32,
}

impl Receivers {
    /// Wraps a host's views of `size`, each of one layer and level. `normal` may be `None`.
    ///
    /// # Errors
    /// [`Error::Size`] for a size of 0 or beyond the device's limit, [`Error::Lent`] for a view
    /// that can't be read so: another format, several samples, an array, both aspects, another
    /// size, no `TEXTURE_BINDING`.
    pub fn new(
        gpu: &Gpu,
        depth: &wgpu::TextureView,
        normal: Option<&wgpu::TextureView>,
        size: (u32, u32),
    ) -> Result<Self, Error> {
        gpu.check_size("a depth buffer", size.0, size.1)?;
        check::depth(depth, size)?;
        normal.map_or(Ok(()), |view| check::normal(view, size))?;
        let none;
        let normal_view = match normal {
            Some(view) => view,
            None => {
                none = placeholder(gpu);
                &none
            }
        };
        let views = [depth, normal_view].map(wgpu::BindingResource::TextureView);
        let layout = Self::layout(gpu);
        let bind_group = gpu.validated(|| bind(gpu, "receivers", &layout, &views)).map_err(check::rejected)?;
        Ok(Self {
            size,
            has_normals: normal.is_some(),
            bind_group,
            depth: depth.clone(),
            stencil: None,
            snapping: gpu.snapping(),
            bend: 0.0,
            coarseness: 1.0,
        })
    }

    /// Lends the depth buffer's stencil: `view` is of the same texture with both aspects.
    /// Techniques that count in the stencil then need no copy of the depth; what was in the stencil
    /// is lost.
    ///
    /// # Errors
    /// [`Error::Lent`] for a view of another texture, of one without stencil or without
    /// `RENDER_ATTACHMENT`.
    pub fn with_stencil(mut self, view: &wgpu::TextureView) -> Result<Self, Error> {
        check::stencil(view, &self.depth)?;
        self.stencil = Some(view.clone());
        Ok(self)
    }

    /// Depth and normals, as the module `receivers` declares them in group 0.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Layout of [`Receivers::bind_group`].
    pub fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        let bindings = [wgpu::TextureSampleType::Depth, wgpu::TextureSampleType::Uint].map(fullscreen::texture);
        let stages = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
        fullscreen::layout(gpu, "receivers", stages, &bindings)
    }
}

/// What is bound where there are no normals.
pub(crate) fn placeholder(gpu: &Gpu) -> wgpu::TextureView {
    let texture = fullscreen::target_texture(gpu, "no normals", (1, 1), 1, wgpu::TextureFormat::R32Uint);
    texture.create_view(&Default::default())
}
