//! Adapters: which there are, which of them can do the work, and which one a device is made of.

use super::watch::Watch;
use super::{AdapterSummary, Gpu};
use crate::error::{Error, nearest};
use std::sync::{Arc, Weak};
use wgpu::DownlevelFlags as Flags;

/// What all techniques need beside the limits and features that each of them names.
const NEEDED: Flags = Flags::COMPUTE_SHADERS
    .union(Flags::INDIRECT_EXECUTION)
    .union(Flags::BASE_VERTEX)
    .union(Flags::READ_ONLY_DEPTH_STENCIL)
    .union(Flags::COMPARISON_SAMPLERS)
    .union(Flags::INDEPENDENT_BLEND)
    .union(Flags::VERTEX_STORAGE)
    .union(Flags::FRAGMENT_STORAGE)
    .union(Flags::DEPTH_TEXTURE_AND_BUFFER_COPIES);

/// Why an adapter can't do the work.
fn unusable(backend: wgpu::Backend, flags: Flags) -> Option<String> {
    if backend == wgpu::Backend::Gl {
        return Some("shaders can't read depth buffers through OpenGL".into());
    }
    let lacking = NEEDED - flags;
    (!lacking.is_empty()).then(|| {
        let names: Vec<_> = lacking.iter_names().map(|(name, _)| name).collect();
        format!("it lacks {}", names.join(", "))
    })
}

impl Gpu {
    /// The best of a host's own `adapters` that can do the work, or the one that `wanted` names: a
    /// part of its name or kind (`software`, `nvidia`, …), or its number, best first.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::Unknown`].
    pub fn choose(mut adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, Error> {
        sort(&mut adapters);
        choose(adapters, wanted)
    }

    /// The adapters of this machine, best first, software ones last; those that can't be used come
    /// with their reason. In a browser it is the one that the browser chooses.
    pub async fn adapters_async() -> Vec<AdapterSummary> {
        enumerate().await.iter().map(AdapterSummary::of).collect()
    }

    /// A device of the best adapter, or of the one `wanted` names: a part of its name or kind
    /// (`software`, `nvidia`, …), or its number in [`Gpu::adapters_async`].
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::Unknown`] or [`Error::NoDevice`].
    pub async fn request_async(wanted: Option<&str>) -> Result<Self, Error> {
        let adapter = choose(enumerate().await, wanted)?;
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("umbrage"),
            required_features: adapter.features() & Self::WANTED,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|e| Error::NoDevice { adapter: adapter.get_info().name, reason: e.to_string() })?;
        let gpu = Self::new(device, queue);
        let watch = Arc::downgrade(&gpu.watch);
        gpu.device.on_uncaptured_error(Arc::new(move |e: wgpu::Error| tell(&watch, Error::Driver(e.to_string()))));
        let watch = Arc::downgrade(&gpu.watch);
        gpu.device.set_device_lost_callback(move |reason, text| {
            tell(&watch, Error::DeviceLost(format!("{reason:?} {text}").trim().to_string()));
        });
        if cfg!(target_family = "wasm") {
            gpu.measure_async().await;
        }
        Ok(gpu)
    }
}

/// What a device calls must not keep it alive.
fn tell(watch: &Weak<Watch>, error: Error) {
    if let Some(watch) = watch.upgrade() {
        watch.report(error);
    }
}

impl AdapterSummary {
    /// Of an adapter.
    fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let unusable = unusable(info.backend, adapter.get_downlevel_capabilities().flags);
        Self { unusable, ..Self::of_info(&info) }
    }

    fn is_called(&self, wanted: &str) -> bool {
        format!("{} {} {}", self.name, self.kind, self.backend).to_lowercase().contains(&wanted.to_lowercase())
    }
}

/// All adapters, hardware first.
async fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let mut adapters = instance.enumerate_adapters(wgpu::Backends::PRIMARY).await;
    if adapters.is_empty() {
        adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
    }
    sort(&mut adapters);
    adapters
}

/// Hardware first.
fn sort(adapters: &mut [wgpu::Adapter]) {
    adapters.sort_by_key(|a| match a.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
}

/// The first adapter that can be used, or the one that `wanted` names.
fn choose(adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, Error> {
    let summaries: Vec<AdapterSummary> = adapters.iter().map(AdapterSummary::of).collect();
    let number = choice(&summaries, wanted)?;
    adapters.into_iter().nth(number).ok_or(Error::NoAdapter { found: String::new() })
}

/// The number of the adapter that is taken.
fn choice(adapters: &[AdapterSummary], wanted: Option<&str>) -> Result<usize, Error> {
    let named = |(i, a): &(usize, &AdapterSummary)| wanted.is_none_or(|w| w.parse() == Ok(*i) || a.is_called(w));
    let fitting: Vec<(usize, &AdapterSummary)> = adapters.iter().enumerate().filter(named).collect();
    if let Some((number, _)) = fitting.iter().find(|(_, a)| a.unusable.is_none()) {
        return Ok(*number);
    }
    if let (Some(wanted), true, false) = (wanted, fitting.is_empty(), adapters.is_empty()) {
        let names = || adapters.iter().map(|a| a.name.as_str());
        let nearest = nearest(wanted, names()).or_else(|| names().next().map(String::from));
        return Err(Error::Unknown { what: "adapter", name: wanted.into(), nearest });
    }
    let why = |(_, a): &(usize, &AdapterSummary)| Some(format!("{}: {}", a.name, a.unusable.as_ref()?));
    Err(Error::NoAdapter { found: fitting.iter().filter_map(why).collect::<Vec<_>>().join("; ") })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn adapter(name: &str, kind: &'static str, unusable: Option<&str>) -> AdapterSummary {
        let (backend, driver) = ("Vulkan".into(), "1.0".into());
        AdapterSummary { name: name.into(), backend, kind, driver, unusable: unusable.map(String::from) }
    }

    #[test]
    fn the_first_that_can_do_the_work_is_taken_or_the_one_that_is_named() {
        let all = [adapter("Old", "discrete", Some("it lacks X")), adapter("A", "integrated", None)];
        let all = [&all[..], &[adapter("B", "software", None)]].concat();
        assert_eq!(choice(&all, None), Ok(1));
        for (wanted, number) in [("software", 2), ("b", 2), ("2", 2), ("vulkan", 1)] {
            assert_eq!(choice(&all, Some(wanted)), Ok(number), "{wanted}");
        }
    }

    #[test]
    fn one_that_cannot_do_the_work_is_refused_with_its_reason() {
        let all = [adapter("Old", "discrete", Some("it lacks X"))];
        for wanted in [None, Some("old"), Some("0")] {
            let text = choice(&all, wanted).unwrap_err().to_string();
            assert!(text.contains("no usable graphics adapter (Old: it lacks X); install a Vulkan driver"), "{text}");
        }
        let text = choice(&all, Some("odd")).unwrap_err().to_string();
        assert!(text.contains("unknown adapter `odd`; did you mean `Old`?"), "{text}");
        let text = choice(&[], Some("odd")).unwrap_err().to_string();
        assert!(text.contains("no usable graphics adapter; install a Vulkan driver"), "{text}");
    }

    #[test]
    fn what_lacks_something_is_unusable_and_says_what() {
        assert_eq!(unusable(wgpu::Backend::Vulkan, NEEDED), None);
        let without = NEEDED - Flags::READ_ONLY_DEPTH_STENCIL - Flags::VERTEX_STORAGE;
        let text = unusable(wgpu::Backend::Vulkan, without).unwrap();
        assert!(text.contains("READ_ONLY_DEPTH_STENCIL, VERTEX_STORAGE"), "{text}");
        assert!(unusable(wgpu::Backend::Gl, Flags::all()).is_some());
    }
}
