//! What a device makes once for all that ask for the same: shader modules, layouts, samplers and
//! pipelines. To compile a pipeline takes tens of milliseconds, and the second light of a kind
//! needs none of its own.

use super::Gpu;
use crate::shader::Module;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Kept of each sort. Settings that move on without end would make it grow for ever.
const MOST: usize = 1024;

/// All that is shared. What is in use lives on in who uses it, whatever happens here.
#[derive(Debug, Default)]
pub(super) struct Shared {
    pub(super) modules: Once<(&'static str, &'static str, &'static [Module]), wgpu::ShaderModule>,
    pub(super) bind_group_layouts: Once<Vec<wgpu::BindGroupLayoutEntry>, wgpu::BindGroupLayout>,
    pub(super) pipeline_layouts: Once<Vec<Option<wgpu::BindGroupLayout>>, wgpu::PipelineLayout>,
    /// By descriptors as text, since these have numbers that do not hash.
    samplers: Once<String, wgpu::Sampler>,
    pub(super) render: Once<Render, wgpu::RenderPipeline>,
    pub(super) compute: Once<(Option<wgpu::PipelineLayout>, Stage), wgpu::ComputePipeline>,
    /// What the host has given, and what it may store.
    pub cache: OnceLock<wgpu::PipelineCache>,
}

/// Values by what they are made from.
#[derive(Debug)]
pub(super) struct Once<K, V>(Mutex<HashMap<K, Arc<OnceLock<V>>>>);

/// A shader stage of a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Stage {
    pub module: wgpu::ShaderModule,
    pub entry: Option<String>,
    pub constants: Vec<(String, u64)>,
    pub zeroes: bool,
}

/// All of a [`wgpu::RenderPipelineDescriptor`] but its label.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Render {
    pub layout: Option<wgpu::PipelineLayout>,
    pub vertex: Stage,
    pub buffers: Vec<Option<(u64, wgpu::VertexStepMode, Vec<wgpu::VertexAttribute>)>>,
    pub primitive: wgpu::PrimitiveState,
    pub depth_stencil: Option<wgpu::DepthStencilState>,
    pub multisample: wgpu::MultisampleState,
    pub fragment: Option<(Stage, Vec<Option<wgpu::ColorTargetState>>)>,
    pub multiview: Option<std::num::NonZeroU32>,
}

impl<K, V> Default for Once<K, V> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<K: Eq + Hash, V: Clone> Once<K, V> {
    /// Makes it where it is not there. Others wait only if they need the same, not for all that is
    /// being compiled.
    fn get(&self, key: K, make: impl FnOnce() -> V) -> V {
        let slot = {
            let mut slots = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if slots.len() >= MOST && !slots.contains_key(&key) {
                slots.clear();
            }
            slots.entry(key).or_default().clone()
        };
        slot.get_or_init(make).clone()
    }

    /// What has been made so far is made from these.
    pub fn keys(&self) -> Vec<K>
    where
        K: Clone,
    {
        let slots = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slots.iter().filter(|(_, made)| made.get().is_some()).map(|(key, _)| key.clone()).collect()
    }

    /// What `value` was made from.
    pub fn key_of(&self, value: &V) -> Option<K>
    where
        K: Clone,
        V: PartialEq,
    {
        let slots = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slots.iter().find(|(_, made)| made.get() == Some(value)).map(|(key, _)| key.clone())
    }

    fn clear(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}

impl Stage {
    fn of(module: &wgpu::ShaderModule, entry: Option<&str>, options: &wgpu::PipelineCompilationOptions<'_>) -> Self {
        let constants = options.constants.iter().map(|(name, value)| (name.to_string(), value.to_bits())).collect();
        let zeroes = options.zero_initialize_workgroup_memory;
        Self { module: module.clone(), entry: entry.map(String::from), constants, zeroes }
    }
}

impl Render {
    fn of(made: &wgpu::RenderPipelineDescriptor<'_>) -> Self {
        let wgpu::VertexState { module, entry_point, compilation_options, buffers } = &made.vertex;
        let buffer = |b: &wgpu::VertexBufferLayout<'_>| (b.array_stride, b.step_mode, b.attributes.to_vec());
        let fragment = |f: &wgpu::FragmentState<'_>| {
            (Stage::of(f.module, f.entry_point, &f.compilation_options), f.targets.to_vec())
        };
        Self {
            layout: made.layout.cloned(),
            vertex: Stage::of(module, *entry_point, compilation_options),
            buffers: buffers.iter().map(|b| b.as_ref().map(buffer)).collect(),
            primitive: made.primitive,
            depth_stencil: made.depth_stencil.clone(),
            multisample: made.multisample,
            fragment: made.fragment.as_ref().map(fragment),
            multiview: made.multiview_mask,
        }
    }
}

impl Shared {
    /// What was made may be broken, as after an error of the driver: it is made again.
    pub fn clear(&self) {
        self.modules.clear();
        self.bind_group_layouts.clear();
        self.pipeline_layouts.clear();
        self.samplers.clear();
        self.render.clear();
        self.compute.clear();
    }
}

impl Gpu {
    /// As [`wgpu::Device::create_render_pipeline`]; all descriptors that differ in nothing but
    /// their label share one pipeline. Module and layout count as the same where they come from
    /// [`Shader::module`](crate::Shader::module) and [`Gpu::pipeline_layout`].
    pub fn render_pipeline(&self, descriptor: &wgpu::RenderPipelineDescriptor<'_>) -> wgpu::RenderPipeline {
        self.shared.render.get(Render::of(descriptor), || {
            let cache = self.shared.cache.get();
            self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor { cache, ..descriptor.clone() })
        })
    }

    /// The same of a pipeline for compute passes.
    pub fn compute_pipeline(&self, descriptor: &wgpu::ComputePipelineDescriptor<'_>) -> wgpu::ComputePipeline {
        let stage = Stage::of(descriptor.module, descriptor.entry_point, &descriptor.compilation_options);
        self.shared.compute.get((descriptor.layout.cloned(), stage), || {
            let cache = self.shared.cache.get();
            self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor { cache, ..descriptor.clone() })
        })
    }

    /// The layout of pipelines whose bind groups are `groups` in order, shared as pipelines are.
    pub fn pipeline_layout(&self, groups: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
        let key = groups.iter().map(|group| group.cloned()).collect();
        self.shared.pipeline_layouts.get(key, || {
            let descriptor = wgpu::PipelineLayoutDescriptor { bind_group_layouts: groups, ..Default::default() };
            self.device.create_pipeline_layout(&descriptor)
        })
    }

    /// A layout of bind groups, shared as pipelines are.
    pub fn bind_group_layout(&self, label: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
        self.shared.bind_group_layouts.get(entries.to_vec(), || {
            let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries };
            self.device.create_bind_group_layout(&descriptor)
        })
    }

    /// A sampler, shared as pipelines are.
    pub fn sampler(&self, descriptor: &wgpu::SamplerDescriptor<'_>) -> wgpu::Sampler {
        let key = format!("{:?}", descriptor.map_label(|_| ()));
        self.shared.samplers.get(key, || self.device.create_sampler(descriptor))
    }

    /// The module of a source and of the modules in which its needs are looked for first.
    pub(crate) fn shader_module(
        &self,
        name: &'static str,
        (source, modules): (&'static str, &'static [Module]),
        text: impl FnOnce() -> String,
    ) -> wgpu::ShaderModule {
        self.shared.modules.get((name, source, modules), || {
            let source = wgpu::ShaderSource::Wgsl(text().into());
            self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(name), source })
        })
    }

    /// A module with text of a host's, for whoever asks alone.
    pub(crate) fn module_of_host(&self, label: &str, text: String) -> wgpu::ShaderModule {
        let source = wgpu::ShaderSource::Wgsl(text.into());
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
    }

    /// Gives what compiled pipelines are kept in from one run of the program to the next. wgpu has
    /// it where the device has [`wgpu::Features::PIPELINE_CACHE`]. To make one is `unsafe`, since
    /// its bytes must come from the same driver, for which the host can vouch alone. Only the first
    /// one counts; pipelines that are there already are not in it.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use wgpu::Features;
    /// # let stored: Option<Vec<u8>> = None;
    /// # let own = wgpu::InstanceDescriptor::new_without_display_handle();
    /// # let instance = wgpu::Instance::new(own);
    /// # let adapter = pollster::block_on(instance.request_adapter(&Default::default()))?;
    /// # let required_features = adapter.features() & Features::PIPELINE_CACHE;
    /// # let descriptor = wgpu::DeviceDescriptor { required_features, ..Default::default() };
    /// # let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;
    /// let gpu = umbrage::Gpu::new(device, queue);
    /// if gpu.has(Features::PIPELINE_CACHE) {
    ///     let data = stored.as_deref();
    ///     let descriptor = wgpu::PipelineCacheDescriptor { label: None, data, fallback: true };
    ///     // The bytes are those that the same adapter and driver gave before.
    ///     gpu.use_pipeline_cache(unsafe { gpu.device.create_pipeline_cache(&descriptor) });
    /// }
    /// let technique = umbrage::parse("pcf")?.make(&gpu)?;
    /// let to_store: Option<Vec<u8>> = gpu.pipeline_cache_data();
    /// # assert_eq!(to_store.is_some(), gpu.has(Features::PIPELINE_CACHE));
    /// # Ok(()) }
    /// ```
    pub fn use_pipeline_cache(&self, cache: wgpu::PipelineCache) {
        // Whoever was first has settled it.
        let _ = self.shared.cache.set(cache);
    }

    /// The bytes of the cache that [`Gpu::use_pipeline_cache`] was given, to be stored; `None`
    /// without one, and where the driver gives none.
    pub fn pipeline_cache_data(&self) -> Option<Vec<u8>> {
        self.shared.cache.get()?.get_data()
    }
}
