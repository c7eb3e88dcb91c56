//! Real-time shadows on `wgpu`: every technique behind one interface.
//!
//! A technique answers one question, *which share of this light does each visible point see?*, and
//! writes the answer to a [`VisibilityTarget`]. The page of the [`techniques`](mod@techniques) has
//! a picture of each. A host engine brings its device, depth buffer, camera, casters and lights:
//!
//! ```no_run
//! use umbrage::depth_maps::Kernel;
//! use umbrage::{Configure, techniques::pcf::Pcf};
//!
//! # use umbrage::core::{CameraView, Scene};
//! # fn frame(device: wgpu::Device, queue: wgpu::Queue, depth: &wgpu::TextureView,
//! #          camera: CameraView, scene: &Scene) -> Result<(), umbrage::Error> {
//! // Once.
//! let gpu = umbrage::Gpu::new(device, queue);
//! let casters = umbrage::Casters::new(&gpu, scene)?;
//! let receivers = umbrage::Receivers::new(&gpu, depth, None, (1024, 768))?;
//! let visibility = umbrage::VisibilityTarget::new(&gpu, 1024, 768)?;
//! let mut technique = Pcf { kernel: Kernel::Square7, ..Default::default() }.make(&gpu)?;
//! let mut recorder = umbrage::Recorder::new(&gpu);
//! // Every frame, after the depth buffer is drawn.
//! let view = umbrage::View {
//!     camera, receivers: &receivers, casters: &casters,
//!     light: &scene.lights[0], textures: &scene.textures,
//! };
//! let prepared = technique.prepare(&gpu, &view)?;
//! let mut encoder = gpu.device.create_command_encoder(&Default::default());
//! let mut passes = recorder.begin(&mut encoder);
//! prepared.record(&mut passes, &visibility)?;
//! passes.finish();
//! gpu.queue.submit([encoder.finish()]);
//! # Ok(()) }
//! ```
//!
//! # Features
//!
//! | feature | what it brings |
//! |---|---|
//! | `native`, by default | back ends for desktops (Vulkan, Metal, DirectX 12, GL); outside of browsers `Gpu::adapters`, `Gpu::request` and their asynchronous twins, `Gpu::catch`, and what reads pictures back and waits: [`read`] |
//! | `techniques`, by default | names for every technique in [`techniques()`], [`find`] and [`parse`]. Without it those have names that look depth maps up, and of the others the families that are features: `moment-maps` (vsm, evsm, msm, esm), `fitted-maps` (cascaded, psm, lispsm, plane-optimal), `projected` (projective, projective-fake), `volumes` (volume), `area-lights` (wedges, light-mask). Whoever names a technique by its type needs no feature for it; what has neither is no part of the program |
//! | `mint` | matrices and vectors of [`core::glam`] from and into those of [`mint`](https://docs.rs/mint) |
//!
//! A host with a device of its own turns `native` off. In browsers WebGPU is there without any
//! feature, and so is `Gpu::request_async`.

/// The example in the project's README is compiled with the tests of the documentation.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

mod answer;
mod area_light;
pub mod baseline;
mod bvh;
mod casters;
mod checked;
mod compute;
mod contact;
mod deliver;
mod denoise;
pub mod depth_maps;
mod error;
pub mod fullscreen;
mod gpu;
mod inline;
mod light_samples;
mod masked;
mod moment_maps;
mod passes;
mod planar;
mod pool;
mod prepared;
#[cfg(test)]
mod probe;
pub mod read;
mod receivers;
mod registry;
mod resolve;
mod settings;
mod shader;
mod silhouettes;
mod snapping;
mod technique;
pub mod techniques;
mod view;
mod visibility;
mod warm_up;

pub use answer::{Answer, RadianceTarget};
pub use casters::{
    CasterView, Casters, HostCasters, InstanceId, LentIndices, LentInstances, LentMatrices, LentMesh, LentShape,
    LentVertices, MaterialId, MatrixForm, MeshId, Needs, Placement, SeenCasters, SeenSurface, TextureId, Vertices,
};
pub use contact::{Contact, Length, contact_shadows};
pub use deliver::{Coarse, Deliver, Upsample};
pub use denoise::Denoise;
pub use error::{Error, nearest};
pub use gpu::{AdapterSummary, Gpu, PipelineKind, PipelineParts, RenderParts, StageParts};
pub use inline::{Binding, Followed, Inline, Lent, Resource};
pub use light_samples::{LightPoints, light_pieces, light_samples, light_samples_over};
pub use masked::{Masked, MaskedBy};
pub use passes::{Kept, Owner, Pass, PassFragments, PassTime, Passes, Recorder};
pub use pool::{MapPool, PooledLight};
pub use prepared::Prepared;
pub use receivers::{Eye, Receivers};
pub use registry::{Filter, FilterId, FilterUse, Registry, find, parse, techniques};
pub use resolve::{HostDepth, Part, Resolve, StoredDepth};
#[doc(hidden)]
pub use settings::declare;
pub use settings::{Configure, Group, Param, ParamKind, Setting, Settings, Value, read as read_settings};
pub use shader::{HostConstant, HostLayout, Module, Shader, Shared, Unresolved};
pub use technique::{DebugView, Family, InOrder, Inside, SettingsOf, Stats, Technique, TechniqueInfo, storage_buffers};
pub use techniques::{RENAMED, Renamed};

pub use umbrage_core as core;
pub use view::View;
pub use visibility::VisibilityTarget;
pub use warm_up::warm_up;
/// The version of wgpu that hosts have to use.
pub use wgpu;

/// WGSL that passes of a host may share with the library.
pub mod wgsl {
    pub use crate::shader::PACK_NORMAL;
}

/// Every shader of the library: those of the techniques, the adaptor, the denoiser, contact
/// shadows, masked casters, poses and the baselines.
pub fn shaders() -> Vec<Shader> {
    let registry = Registry::default();
    let own: Vec<_> = registry.all().flat_map(|t| t.shaders).collect();
    own.into_iter()
        .chain([&light_samples::SHADER])
        .chain(denoise::SHADERS)
        .chain(contact::SHADERS)
        .chain(masked::SHADERS)
        .chain(casters::shaders())
        .chain(baseline::SHADERS)
        .chain(&resolve::SHADERS)
        .chain(&deliver::SHADERS)
        .copied()
        .collect()
}

/// What the host has to agree on with the library's modules of WGSL, whatever shader needs them.
pub fn shared() -> Vec<Shared> {
    let one = [receivers::SHARED, area_light::SHARED, moment_maps::SHARED];
    [casters::SHARED, planar::SHARED, silhouettes::SHARED, depth_maps::SHARED, &one].concat()
}
