//! WGSL put together from named modules by concatenation, and the host structs that have to match it.

use crate::gpu::Gpu;

/// `wgsl/fullscreen.wgsl`: one triangle that covers the target.
pub const FULLSCREEN: &str = include_str!("wgsl/fullscreen.wgsl");
/// `wgsl/receivers.wgsl`: group 0, the visible surfaces.
pub const RECEIVERS: &str = concat!(include_str!("wgsl/pack_normal.wgsl"), include_str!("wgsl/receivers.wgsl"));
/// `wgsl/inspect.wgsl`: what pictures of a technique's inside are drawn over. After [`RECEIVERS`].
pub const INSPECT: &str = include_str!("wgsl/inspect.wgsl");
/// `wgsl/map_visibility.wgsl`: the full-screen pass around a technique's `lit_share`. After [`MAP_LOOKUP`].
pub const MAP_VISIBILITY: &str = include_str!("wgsl/map_visibility.wgsl");
/// `wgsl/map_quick.wgsl`: the first of two phases, around a technique's `quick_share`. After [`MAP_VISIBILITY`].
pub const MAP_QUICK: &str = include_str!("wgsl/map_quick.wgsl");
/// `wgsl/pack_normal.wgsl`: how a host packs the normals of [`crate::Receivers`], `pack_normal(normal, casts) -> u32`.
pub const PACK_NORMAL: &str = include_str!("wgsl/pack_normal.wgsl");
/// `wgsl/map_storage.wgsl`: what maps hold for a depth; for passes that read or draw maps and don't have [`MAP_LOOKUP`].
pub const MAP_STORAGE: &str = include_str!("wgsl/map_storage.wgsl");
/// `wgsl/map_layers.wgsl` and `wgsl/map_lookup.wgsl`: group 1, where a receiver lies in the maps of a light. With [`MAP_STORAGE`],
/// after [`RECEIVERS`].
pub const MAP_LOOKUP: &str = concat!(
    include_str!("wgsl/map_storage.wgsl"),
    include_str!("wgsl/map_layers.wgsl"),
    include_str!("wgsl/map_lookup.wgsl")
);
/// `wgsl/light_kernel.wgsl`: the light's surface as a receiver sees it through the map. After [`MAP_LOOKUP`].
pub const LIGHT_KERNEL: &str = include_str!("wgsl/light_kernel.wgsl");
/// `wgsl/map_taps.wgsl`: group 2, where filters look. After [`MAP_LOOKUP`].
pub const MAP_TAPS: &str = include_str!("wgsl/map_taps.wgsl");
/// `wgsl/map_cells.wgsl`: the layout of the pyramid of nearest depths.
pub const MAP_CELLS: &str = include_str!("wgsl/map_cells.wgsl");
/// `wgsl/soft_taps.wgsl`: group 2, filters that follow the light's size. After [`LIGHT_KERNEL`], [`MAP_TAPS`] and [`MAP_CELLS`].
pub const SOFT_TAPS: &str = include_str!("wgsl/soft_taps.wgsl");

/// `wgsl/moments_depth.wgsl`: linear depth of filterable maps.
pub const MOMENTS_DEPTH: &str = include_str!("wgsl/moments_depth.wgsl");
/// `wgsl/moments_float.wgsl`: moments in textures of floats.
pub const MOMENTS_FLOAT: &str = include_str!("wgsl/moments_float.wgsl");
/// `wgsl/moments_unorm.wgsl`: moments in even steps of 16 bits. Needs a technique's `packed` and `unpacked`.
pub const MOMENTS_UNORM: &str = include_str!("wgsl/moments_unorm.wgsl");
/// `wgsl/moments_mean.wgsl`: their mean, where it is linear.
pub const MOMENTS_MEAN: &str = include_str!("wgsl/moments_mean.wgsl");
/// `wgsl/moments_passes.wgsl`: from depth to filtered moments. After a technique's `moments_of`.
pub const MOMENTS_PASSES: &str = include_str!("wgsl/moments_passes.wgsl");
/// `wgsl/moments_lookup.wgsl`: group 2, filtered moments. After [`MAP_LOOKUP`] and [`MOMENTS_DEPTH`].
pub const MOMENTS_LOOKUP: &str =
    concat!(include_str!("wgsl/moments_share.wgsl"), include_str!("wgsl/moments_lookup.wgsl"));
/// `wgsl/moments_soft.wgsl`: filtered moments for filters that follow the light's size. After
/// [`SOFT_TAPS`] and [`MOMENTS_DEPTH`].
pub const MOMENTS_SOFT: &str = concat!(include_str!("wgsl/moments_share.wgsl"), include_str!("wgsl/moments_soft.wgsl"));

/// One shader: plain WGSL modules, later ones using names of earlier ones.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// For messages and labels.
    pub name: &'static str,
    /// Module sources.
    pub parts: &'static [&'static str],
    /// Host structs that the shader reads; a test compares them with the WGSL of the same name.
    pub layouts: &'static [HostLayout],
}

impl Shader {
    /// The whole source.
    pub fn source(&self) -> String {
        self.parts.join("\n")
    }

    /// Compiles it.
    pub fn module(&self, gpu: &Gpu) -> wgpu::ShaderModule {
        gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source().into()),
        })
    }
}

/// Name, members (name, byte offset, byte size) and size of a struct on the host's side.
#[derive(Clone, Copy, Debug)]
pub struct HostLayout {
    /// The struct's name, the same in WGSL.
    pub name: &'static str,
    /// Members in order.
    pub members: &'static [(&'static str, usize, usize)],
    /// Bytes in all.
    pub size: usize,
}

/// Declares a struct that a shader reads, together with its [`HostLayout`], the constant `LAYOUT`. The crate that uses this
/// depends on `bytemuck` with its feature `derive`.
#[macro_export]
macro_rules! shader_struct {
    (
        $(#[$doc:meta])*
        $vis:vis struct $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* }
    ) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        $vis struct $name { $($(#[$field_doc])* pub $field: $type,)* }

        impl $name {
            /// What a test compares with the WGSL struct of the same name.
            $vis const LAYOUT: $crate::HostLayout = $crate::HostLayout {
                name: stringify!($name),
                members: &[$((stringify!($field), std::mem::offset_of!($name, $field), size_of::<$type>()),)*],
                size: size_of::<$name>(),
            };
        }
    };
}
pub(crate) use shader_struct;
