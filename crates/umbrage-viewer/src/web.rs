//! The laboratory on a page.

use crate::walk::Walk;
use crate::{Lab, Options, link};
use eframe::egui;
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use eframe::wasm_bindgen::{JsCast, JsValue};
use eframe::web_sys;
use std::sync::Arc;
use umbrage::{Gpu, Registry};
use web_time::{Duration, Instant};

/// The canvas of the page.
const CANVAS: &str = "laboratory";
/// Where the page says what is missing.
const MESSAGE: &str = "message";
/// The query with which the laboratory walks through all techniques, see [`Walk`].
const WALK: &str = "walk";
/// Between two looks at whether the address has to change.
const ADDRESS: Duration = Duration::from_millis(500);

/// Starts the laboratory on the page's canvas. The address may end in `#` and a permalink; what is
/// missing, such as WebGPU, the page says in a sentence.
pub fn run(registry: &Registry) {
    let registry = registry.clone();
    wasm_bindgen_futures::spawn_local(async move {
        if let Err(error) = start(registry).await {
            say(&error);
        }
    });
}

async fn start(registry: Registry) -> Result<(), String> {
    let canvas = element(CANVAS).and_then(|element| element.dyn_into::<web_sys::HtmlCanvasElement>().ok());
    let canvas = canvas.ok_or(format!("the page has no canvas `{CANVAS}`"))?;
    let options = eframe::WebOptions {
        wgpu_options: WgpuConfiguration { wgpu_setup: setup(), ..Default::default() },
        ..Default::default()
    };
    let open = move |context: &eframe::CreationContext<'_>| match Page::new(context, &registry) {
        Ok(page) => Ok(Box::new(page) as Box<dyn eframe::App>),
        Err(error) => Err(error.into()),
    };
    let started = eframe::WebRunner::new().start(canvas, options, Box::new(open)).await;
    started.map_err(|error| format!("The laboratory can't start: {}.", text(&error)))?;
    if let Some(message) = element(MESSAGE) {
        message.remove();
    }
    Ok(())
}

/// WebGPU with what techniques want.
fn setup() -> WgpuSetup {
    let mut new = WgpuSetupCreateNew::without_display_handle();
    new.instance_descriptor.backends = wgpu::Backends::BROWSER_WEBGPU;
    new.power_preference = wgpu::PowerPreference::HighPerformance;
    new.device_descriptor = Arc::new(|adapter| wgpu::DeviceDescriptor {
        label: Some("umbrage"),
        required_features: adapter.features() & Gpu::WANTED,
        required_limits: adapter.limits(),
        ..Default::default()
    });
    WgpuSetup::CreateNew(new)
}

/// The laboratory, and the address that leads to what it shows.
struct Page {
    lab: Lab,
    /// The part of the address after `#` that is shown.
    address: String,
    looked_at: Instant,
    walk: Option<Walk>,
}

impl Page {
    fn new(context: &eframe::CreationContext<'_>, registry: &Registry) -> Result<Self, String> {
        let location = &context.integration_info.web_info.location;
        let address = location.hash.trim_start_matches('#').to_string();
        let mut lab = Lab::new(context, registry, &Options::default())?;
        if !address.is_empty()
            && let Err(error) = lab.follow(&address)
        {
            lab.face.say(error);
        }
        let walk = (location.query == WALK).then(|| Walk::new(registry));
        Ok(Self { lab, address, looked_at: Instant::now(), walk })
    }

    /// Follows an address that was typed or clicked, and else has it lead to what is shown.
    fn keep_address(&mut self, location: &eframe::Location) {
        let typed = location.hash.trim_start_matches('#');
        if typed != self.address {
            self.address = typed.to_string();
            if let Err(error) = self.lab.follow(typed) {
                self.lab.face.say(error);
            }
            return;
        }
        if self.looked_at.elapsed() < ADDRESS || self.lab.opening.is_some() {
            return;
        }
        self.looked_at = Instant::now();
        let Some(stage) = &self.lab.stage else { return };
        let shown = link::write(&self.lab.state, &stage.source.scene);
        if shown != self.address
            && let Some(window) = web_sys::window()
            && window.location().replace(&format!("#{shown}")).is_ok()
        {
            self.address = shown;
        }
    }
}

impl eframe::App for Page {
    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.lab.frame(ui);
        if let Some(walk) = &mut self.walk {
            let say = |line: &str| web_sys::console::log_1(&format!("umbrage: {line}").into());
            if ui.ctx().input(|input| input.pointer.any_click()) {
                say("click");
            }
            walk.step(&mut self.lab, say);
            ui.ctx().request_repaint();
        } else {
            self.keep_address(&frame.info().web_info.location);
        }
    }
}

fn element(id: &str) -> Option<web_sys::Element> {
    web_sys::window()?.document()?.get_element_by_id(id)
}

/// Shows a sentence in the place of the laboratory.
fn say(error: &str) {
    if let Some(message) = element(MESSAGE) {
        message.set_text_content(Some(error));
    }
}

fn text(error: &JsValue) -> String {
    error.as_string().unwrap_or_else(|| format!("{error:?}"))
}
