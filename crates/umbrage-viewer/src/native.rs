//! The window.

use crate::{Lab, Options};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::sync::Arc;
use umbrage::{Gpu, Registry};

/// Opens the laboratory in a window and returns when it is closed.
///
/// # Errors
/// A sentence: there is no display, no adapter, or the options are wrong.
pub fn run(registry: &Registry, options: &Options) -> Result<(), String> {
    if let Some(link) = &options.state {
        crate::link::read(link)?;
    }
    let native = eframe::NativeOptions {
        viewport: eframe::egui::ViewportBuilder::default().with_title("umbrage").with_inner_size([1280.0, 800.0]),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration { wgpu_setup: setup(options.adapter.clone()), ..Default::default() },
        run_and_return: true,
        ..Default::default()
    };
    let (registry, options) = (registry.clone(), options.clone());
    let open = move |context: &eframe::CreationContext<'_>| match Lab::new(context, &registry, &options) {
        Ok(lab) => Ok(Box::new(lab) as Box<dyn eframe::App>),
        Err(error) => Err(error.into()),
    };
    eframe::run_native("umbrage", native, Box::new(open))
        .map_err(|error| format!("the window can't be opened: {error}"))
}

/// A device with what techniques want, of the adapter that is named or the best one.
pub fn setup(wanted: Option<String>) -> WgpuSetup {
    let mut new = WgpuSetupCreateNew::without_display_handle();
    new.instance_descriptor.backends = wgpu::Backends::PRIMARY;
    new.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        let fitting: Vec<_> = adapters.iter().filter(|a| surface.is_none_or(|s| a.is_surface_supported(s))).collect();
        Gpu::choose(fitting.into_iter().cloned().collect(), wanted.as_deref()).map_err(|e| e.to_string())
    }));
    new.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("umbrage"),
        required_features: adapter.features() & Gpu::WANTED,
        required_limits: adapter.limits(),
        ..Default::default()
    });
    WgpuSetup::CreateNew(new)
}
