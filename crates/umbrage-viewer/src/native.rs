//! The window.

use crate::{Lab, Options};
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::cell::RefCell;
use std::rc::Rc;
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
    let mut options = options.clone();
    for _ in 0..MOST_LOSSES {
        let lost = Rc::new(RefCell::new(None));
        open(registry, &options, lost.clone())?;
        // The device was lost: the same again in a new window.
        let Some(link) = lost.take() else { return Ok(()) };
        options.state = Some(link);
    }
    Err(format!("the graphics device was lost {MOST_LOSSES} times; update its driver, or choose another --adapter"))
}

/// Devices that may be lost, one after the other.
const MOST_LOSSES: u32 = 4;

fn open(registry: &Registry, options: &Options, lost: Rc<RefCell<Option<String>>>) -> Result<(), String> {
    let native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_title("umbrage").with_inner_size([1280.0, 800.0]),
        renderer: eframe::Renderer::Wgpu,
        wgpu_options: WgpuConfiguration { wgpu_setup: setup(options.adapter.clone()), ..Default::default() },
        run_and_return: true,
        ..Default::default()
    };
    let (registry, options) = (registry.clone(), options.clone());
    let open = move |context: &eframe::CreationContext<'_>| match Lab::new(context, &registry, &options) {
        Ok(lab) => Ok(Box::new(Window { lab, lost }) as Box<dyn eframe::App>),
        Err(error) => Err(error.into()),
    };
    eframe::run_native("umbrage", native, Box::new(open))
        .map_err(|error| format!("the window can't be opened: {error}"))
}

/// A laboratory in a window that is opened anew where its device is lost.
struct Window {
    lab: Lab,
    /// What was seen then.
    lost: Rc<RefCell<Option<String>>>,
}

impl eframe::App for Window {
    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        self.lab.frame(ui);
        if self.lab.is_lost() {
            self.lost.replace(self.lab.permalink());
            ui.ctx().send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }
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
