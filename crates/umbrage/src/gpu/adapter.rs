//! What is told of an adapter.

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
}
