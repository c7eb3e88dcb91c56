//! The window.

use crate::{Lab, Options};
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use umbrage::{Gpu, Registry};
use umbrage_report::{Choice, RAY_TRACED, Source};

/// Opens the laboratory in a window and returns when it is closed.
///
/// # Errors
/// A sentence: there is no display, no adapter, or the options are wrong.
pub fn run(registry: &Registry, options: &Options) -> Result<(), String> {
    if let Some(link) = &options.state {
        crate::link::read(link)?;
    }
    check(registry, options)?;
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

/// Finds what is wrong before a window is opened.
fn check(registry: &Registry, options: &Options) -> Result<(), String> {
    for technique in options.techniques.iter().filter(|technique| *technique != RAY_TRACED) {
        Choice::parse(registry, technique, &[]).map_err(|e| e.to_string())?;
    }
    if let Some(scene) = options.scene.as_ref().filter(|scene| !Path::new(scene).exists()) {
        Source::open(scene).map_err(|e| e.to_string())?;
    }
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let displays = ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"];
    if cfg!(all(unix, not(target_vendor = "apple"))) && !displays.into_iter().any(is_set) {
        return Err(
            "there is no display for a window (DISPLAY and WAYLAND_DISPLAY are not set); `umbrage render` and \
                    `umbrage compare` need none"
                .into(),
        );
    }
    Ok(())
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
