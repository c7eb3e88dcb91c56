//! Adapters: which there are, which of them can do the work, and which is taken.

use crate::error::{Error, nearest};
use wgpu::DownlevelFlags as Flags;

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
    /// Why it can't be used; `None` where it can.
    pub unusable: Option<String>,
}

impl AdapterSummary {
    /// Of an adapter.
    pub(super) fn of(adapter: &wgpu::Adapter) -> Self {
        let info = adapter.get_info();
        let unusable = unusable(info.backend, adapter.get_downlevel_capabilities().flags);
        Self { unusable, ..Self::of_info(&info) }
    }

    /// Of an adapter that a device was made of.
    pub(super) fn of_info(info: &wgpu::AdapterInfo) -> Self {
        let kind = match info.device_type {
            wgpu::DeviceType::Cpu => "software",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Other => "other",
        };
        let driver = format!("{} {}", info.driver, info.driver_info).trim().to_string();
        Self { name: info.name.clone(), backend: format!("{:?}", info.backend), kind, driver, unusable: None }
    }

    fn is_called(&self, wanted: &str) -> bool {
        format!("{} {} {}", self.name, self.kind, self.backend).to_lowercase().contains(&wanted.to_lowercase())
    }
}

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

/// All adapters, hardware first.
pub(super) async fn enumerate() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let mut adapters = instance.enumerate_adapters(wgpu::Backends::PRIMARY).await;
    if adapters.is_empty() {
        adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
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

/// The first adapter that can be used, or the one that `wanted` names.
pub(super) fn choose(adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, Error> {
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
