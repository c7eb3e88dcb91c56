//! The window itself.

use super::show::{Result, Show, TECHNIQUES};
use std::sync::Arc;
use std::time::Instant;
use umbrage::Gpu;
use wgpu::CurrentSurfaceTexture as Current;
use wgpu::util::TextureBlitter;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// Opens the window and stays until it is closed.
pub fn run() -> Result<()> {
    let mut program = Program { shown: None, failed: None };
    EventLoop::new()?.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}

struct Program {
    shown: Option<Shown>,
    failed: Option<Box<dyn std::error::Error>>,
}

/// A window and what draws into it.
struct Shown {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    blitter: TextureBlitter,
    gpu: Gpu,
    show: Show,
    start: Instant,
}

impl Program {
    /// What fails ends the program.
    fn check(&mut self, events: &ActiveEventLoop, done: Result<()>) {
        if let Err(error) = done {
            self.failed = Some(error);
            events.exit();
        }
    }
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none() {
            let made = Shown::new(events).map(|shown| self.shown = Some(shown));
            self.check(events, made);
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(shown) = &mut self.shown else { return };
        let done = match event {
            WindowEvent::CloseRequested => {
                events.exit();
                Ok(())
            }
            WindowEvent::Resized(size) => shown.resize(size.width, size.height),
            WindowEvent::RedrawRequested => shown.draw(),
            WindowEvent::KeyboardInput { event, .. } => {
                if event.logical_key == Key::Named(NamedKey::Escape) {
                    events.exit();
                }
                shown.press(&event);
                Ok(())
            }
            _ => Ok(()),
        };
        self.check(events, done);
    }
}

impl Shown {
    fn new(events: &ActiveEventLoop) -> Result<Self> {
        let window = Arc::new(events.create_window(Window::default_attributes().with_title(TECHNIQUES[0]))?);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window.clone())?;
        let (adapter, device, queue) = pollster::block_on(async {
            let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
            let adapter = instance.request_adapter(&options).await?;
            let (device, queue) = adapter.request_device(&Default::default()).await?;
            Ok::<_, Box<dyn std::error::Error>>((adapter, device, queue))
        })?;
        let gpu = Gpu::new(device, queue);
        let size = window.inner_size();
        let (width, height) = (size.width.max(1), size.height.max(1));
        let config = surface.get_default_config(&adapter, width, height).ok_or("no format for this window")?;
        surface.configure(&gpu.device, &config);
        let blitter = TextureBlitter::new(&gpu.device, config.format);
        let show = Show::new(&gpu, (width, height))?;
        window.request_redraw();
        Ok(Self { window, surface, config, blitter, gpu, show, start: Instant::now() })
    }

    fn resize(&mut self, width: u32, height: u32) -> Result<()> {
        (self.config.width, self.config.height) = (width.max(1), height.max(1));
        self.surface.configure(&self.gpu.device, &self.config);
        Ok(self.show.renderer.resize(self.config.width, self.config.height)?)
    }

    /// The keys 1 to 9. A technique that the device can't do is named in the title.
    fn press(&mut self, key: &KeyEvent) {
        let digit = key.logical_key.to_text().and_then(|text| text.parse::<usize>().ok());
        let Some(i) = digit.and_then(|digit| digit.checked_sub(1)).filter(|i| *i < TECHNIQUES.len()) else { return };
        if key.state == ElementState::Pressed {
            let chosen = self.show.choose(i).map_err(|error| error.to_string());
            self.window.set_title(&chosen.map_or_else(|error| error, |()| TECHNIQUES[i].into()));
        }
    }

    fn draw(&mut self) -> Result<()> {
        self.window.request_redraw();
        let target = match self.surface.get_current_texture() {
            Current::Success(target) | Current::Suboptimal(target) => target,
            Current::Outdated | Current::Lost => return self.resize(self.config.width, self.config.height),
            // Nobody sees this frame.
            Current::Timeout | Current::Occluded | Current::Validation => return Ok(()),
        };
        self.show.frame(self.start.elapsed().as_secs_f64())?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let view = target.texture.create_view(&Default::default());
        self.blitter.copy(&self.gpu.device, &mut encoder, self.show.renderer.picture_view(), &view);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(target);
        Ok(())
    }
}
