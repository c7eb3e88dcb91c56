//! The device: an adapter of ours, or a host's own.

use crate::error::{Error, nearest};
use crate::snapping;
use std::sync::{Arc, Mutex, OnceLock};
use wgpu::util::DeviceExt;

/// A device with its queue, cheap to clone.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    adapter: AdapterSummary,
    trouble: Arc<Mutex<Option<Error>>>,
    snapping: Arc<OnceLock<f32>>,
}

/// What a user wants to know of an adapter.
#[derive(Clone, Debug, PartialEq)]
pub struct AdapterSummary {
    /// The name the driver gives.
    pub name: String,
    /// `Vulkan`, `Metal`, …
    pub backend: String,
    /// `software`, `integrated`, `discrete`, `virtual` or `other`.
    pub kind: &'static str,
    /// Driver and version.
    pub driver: String,
}

impl AdapterSummary {
    fn of(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Other => "other",
        };
        let driver = format!("{} {}", info.driver, info.driver_info).trim().to_string();
        Self { name: info.name.clone(), backend: format!("{:?}", info.backend), kind, driver }
    }
}

impl Gpu {
    /// Features that make techniques faster or more exact and are asked for where the adapter has
    /// them. Every technique either works without them or says that it can't.
    pub const WANTED: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
        .union(wgpu::Features::DEPTH_CLIP_CONTROL)
        .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
        .union(wgpu::Features::FLOAT32_FILTERABLE)
        .union(wgpu::Features::FLOAT32_BLENDABLE)
        .union(wgpu::Features::INDIRECT_FIRST_INSTANCE);

    /// The adapters of this machine, best first, software ones last.
    pub fn adapters() -> Vec<AdapterSummary> {
        enumerate().iter().map(|a| AdapterSummary::of(&a.get_info())).collect()
    }

    /// A device of the best adapter, or of the one `wanted` names: a part of its name or kind
    /// (`software`, `nvidia`, …), or its number in [`Gpu::adapters`].
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::Unknown`] or [`Error::NoDevice`].
    pub fn request(wanted: Option<&str>) -> Result<Self, Error> {
        let adapters = enumerate();
        let names: Vec<String> = adapters.iter().map(|a| a.get_info().name).collect();
        let found = match wanted {
            None => adapters.into_iter().next(),
            Some(w) => {
                let matches = |(i, a): &(usize, wgpu::Adapter)| {
                    let s = AdapterSummary::of(&a.get_info());
                    let text = format!("{} {} {}", s.name, s.kind, s.backend).to_lowercase();
                    w.parse() == Ok(*i) || text.contains(&w.to_lowercase())
                };
                adapters.into_iter().enumerate().find(matches).map(|(_, a)| a)
            }
        };
        let Some(adapter) = found else {
            return Err(match wanted {
                Some(name) if !names.is_empty() => Error::Unknown {
                    what: "adapter",
                    name: name.into(),
                    nearest: nearest(name, names.iter().map(String::as_str)).or_else(|| names.first().cloned()),
                },
                _ => Error::NoAdapter { found: names.join(", ") },
            });
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("umbrage"),
            required_features: adapter.features() & Self::WANTED,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = block_on(adapter.request_device(&descriptor))
            .map_err(|e| Error::NoDevice { adapter: adapter.get_info().name, reason: e.to_string() })?;
        let gpu = Self::new(device, queue);
        let trouble = gpu.trouble.clone();
        gpu.device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| report(&trouble, Error::Driver(e.to_string()))));
        let trouble = gpu.trouble.clone();
        gpu.device.set_device_lost_callback(move |reason, text| {
            report(&trouble, Error::DeviceLost(format!("{reason:?} {text}").trim().to_string()));
        });
        Ok(gpu)
    }

    /// A host's own device. The host keeps its error and device-lost handlers.
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let adapter = AdapterSummary::of(&device.adapter_info());
        Self { device, queue, adapter, trouble: Arc::default(), snapping: Arc::default() }
    }

    /// The adapter in use.
    pub fn adapter(&self) -> &AdapterSummary {
        &self.adapter
    }

    /// True where the device has all of `features`.
    pub fn has(&self, features: wgpu::Features) -> bool {
        self.device.features().contains(features)
    }

    /// Pixels by which the rasteriser may shift a surface, since it snaps corners of triangles:
    /// measured once, which waits for the device, or what every device keeps to where it can't be
    /// measured.
    pub(crate) fn snapping(&self) -> f32 {
        let measured = || snapping::measured(self).unwrap_or(snapping::GUARANTEED);
        *self.snapping.get_or_init(measured)
    }

    /// The first error that the driver reported out of order, if any; a lost device stays lost.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] or [`Error::Driver`].
    pub fn check(&self) -> Result<(), Error> {
        match self.trouble.lock() {
            Ok(trouble) => trouble.clone().map_or(Ok(()), Err),
            Err(_) => Err(Error::Driver("an error handler panicked".into())),
        }
    }

    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// As [`Gpu::check`], and where the driver gives up waiting.
    pub fn wait(&self) -> Result<(), Error> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(|_| ()).map_err(|e| Error::Driver(e.to_string()))
    }

    /// Does `work` and takes what the driver reports meanwhile as its error, where [`Gpu::check`]
    /// would hold it against all that comes later. A lost device stays lost.
    ///
    /// # Errors
    /// That of `work`, or else [`Error::Driver`].
    pub fn catch<T, E: From<Error>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let scopes = [Validation, OutOfMemory, Internal].map(|filter| self.device.push_error_scope(filter));
        let done = work();
        // The last one pushed is the first to go.
        let reported = scopes.into_iter().rev().filter_map(|scope| block_on(scope.pop())).last();
        match (done, reported) {
            (Ok(_), Some(error)) => Err(Error::Driver(error.to_string()).into()),
            (done, _) => done,
        }
    }

    /// A two-dimensional texture size checked against the adapter's limit.
    ///
    /// # Errors
    /// [`Error::Size`].
    pub fn check_size(&self, what: &str, width: u32, height: u32) -> Result<(), Error> {
        let limit = self.device.limits().max_texture_dimension_2d;
        for size in [width, height] {
            if size == 0 || size > limit {
                return Err(Error::Size { what: what.into(), size: size.into(), limit: limit.into() });
            }
        }
        Ok(())
    }

    /// A buffer that holds `data`, padded to a multiple of 16 bytes and never empty.
    pub fn buffer<T: bytemuck::NoUninit>(&self, label: &str, data: &[T], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let mut contents = bytemuck::cast_slice::<T, u8>(data).to_vec();
        contents.resize(contents.len().next_multiple_of(16).max(16), 0);
        let descriptor = wgpu::util::BufferInitDescriptor { label: Some(label), contents: &contents, usage };
        self.device.create_buffer_init(&descriptor)
    }
}

fn report(trouble: &Mutex<Option<Error>>, error: Error) {
    if let Ok(mut slot) = trouble.lock()
        && (slot.is_none() || matches!(error, Error::DeviceLost(_)))
    {
        *slot = Some(error);
    }
}

/// All adapters, hardware first.
fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let mut adapters = block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    if adapters.is_empty() {
        adapters = block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    }
    adapters.sort_by_key(|a| match a.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    adapters
}

pub(crate) fn block_on<F: Future>(future: F) -> F::Output {
    pollster::block_on(future)
}
