//! All that has the size of the picture: textures, and bind groups of them. A new size makes these
//! anew, and that alone.

use crate::{shading::Shading, tonemap::ToneMap};
use umbrage::{Error, Gpu, Receivers, fullscreen::target_texture};

/// Packed normals.
pub(crate) const PACKED: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;
/// Shading normals and looks, packed.
pub(crate) const SURFACE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Uint;
/// Radiance.
pub(crate) const WIDE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// The picture.
pub(crate) const PICTURE: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

pub(crate) struct Targets {
    pub gbuffer: GBuffer,
    /// What techniques read of the G-buffer.
    pub receivers: Receivers,
    /// What shading reads of it.
    pub surface: wgpu::BindGroup,
    /// What tone mapping reads.
    pub radiance: wgpu::BindGroup,
    pub picture: wgpu::Texture,
    pub picture_view: wgpu::TextureView,
}

/// What the camera sees, and the light that comes from there.
pub(crate) struct GBuffer {
    /// Of the depth alone.
    pub depth_view: wgpu::TextureView,
    /// Of depth and stencil, for techniques that count in it; `None` where the adapter has no such
    /// format.
    pub stencil_view: Option<wgpu::TextureView>,
    /// Geometric normal turned to the eye, packed.
    pub normal_view: wgpu::TextureView,
    /// Shading normal and look, packed, see `surface.wgsl`.
    pub surface_view: wgpu::TextureView,
    /// Light that leaves the surface, where lights add to it one after the other.
    pub radiance_view: wgpu::TextureView,
}

impl Targets {
    pub fn new(gpu: &Gpu, shading: &Shading, tonemap: &ToneMap, size: (u32, u32)) -> Result<Self, Error> {
        let gbuffer = GBuffer::new(gpu, size);
        let mut receivers = Receivers::new(gpu, &gbuffer.depth_view, Some(&gbuffer.normal_view), size)?;
        if let Some(view) = &gbuffer.stencil_view {
            receivers = receivers.with_stencil(view)?;
        }
        let picture = target_texture(gpu, "picture", size, 1, PICTURE);
        Ok(Self {
            receivers,
            surface: shading.surface(gpu, &gbuffer),
            radiance: tonemap.radiance(gpu, &gbuffer),
            picture_view: picture.create_view(&Default::default()),
            picture,
            gbuffer,
        })
    }

    /// Pixels across and down.
    pub fn size(&self) -> (u32, u32) {
        self.receivers.size
    }
}

impl GBuffer {
    fn new(gpu: &Gpu, size: (u32, u32)) -> Self {
        let texture = |label, format| target_texture(gpu, label, size, 1, format);
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let (depth, normal) = (texture("depth", depth_format(gpu)), texture("geometric normal", PACKED));
        let depth_alone = wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() };
        Self {
            depth_view: depth.create_view(&depth_alone),
            stencil_view: depth.format().has_stencil_aspect().then(|| view(&depth)),
            normal_view: view(&normal),
            surface_view: view(&texture("surface", SURFACE)),
            radiance_view: view(&texture("radiance", WIDE)),
        }
    }
}

/// Floats, with a stencil where there can be one.
pub(crate) fn depth_format(gpu: &Gpu) -> wgpu::TextureFormat {
    if gpu.has(wgpu::Features::DEPTH32FLOAT_STENCIL8) {
        wgpu::TextureFormat::Depth32FloatStencil8
    } else {
        wgpu::TextureFormat::Depth32Float
    }
}
