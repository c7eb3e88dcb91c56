//! A technique that notes what reaches it, to test that wrappers pass everything on.

use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{Error, Gpu, Passes, Settings, View, VisibilityTarget, find};
use std::sync::{Arc, Mutex, PoisonError};
use umbrage_core::{glam::DMat4, light_view::LightView};

/// Everything in it differs from what [`Inside`] says where a technique says nothing.
struct Probe {
    calls: Arc<Mutex<Vec<String>>>,
    views: [LightView; 1],
    texture: wgpu::Texture,
}

impl Probe {
    fn new(gpu: &Gpu, calls: Arc<Mutex<Vec<String>>>) -> Self {
        let view =
            LightView { clip_from_world: DMat4::IDENTITY, size: 7, layer: 0, paraboloid: None, steady_border: None };
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("probe"),
            size: wgpu::Extent3d::default(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Self { calls, views: [view], texture }
    }

    fn note(&self, call: &str) {
        self.calls.lock().unwrap_or_else(PoisonError::into_inner).push(call.into());
    }
}

impl Technique for Probe {
    fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        Ok(())
    }

    fn record_visibility(
        &mut self,
        _: &mut Passes<'_>,
        _: &View<'_>,
        _: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        Ok(())
    }

    fn set(&mut self, _: &Gpu, _: &Settings) -> Result<bool, Error> {
        self.note("set");
        Ok(true)
    }

    fn set_frame(&mut self, frame: u32) {
        self.note(&format!("frame {frame}"));
    }

    fn draws_host_casters(&self) -> bool {
        true
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Probe {
    fn stats(&self) -> Stats {
        Stats::default()
    }

    fn forget(&mut self) {
        self.note("forget");
    }

    fn light_views(&self) -> &[LightView] {
        &self.views
    }

    fn split_distances(&self) -> &[f64] {
        &[3.0]
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        vec![("probes", 1)]
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        (pass == "probe").then_some(5)
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.note(&format!("inspect {}", view.unwrap_or_default()));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        vec![DebugView { name: "probe", texture: &self.texture, layer: 0 }]
    }
}

/// Fails where the technique that `wrap` makes around another one keeps anything to itself. What it
/// costs is its own.
pub fn assert_forwards(wrap: impl Fn(&Gpu, Box<dyn Technique>) -> Box<dyn Technique>) {
    let gpu = Gpu::request(None).expect("this test needs a graphics adapter");
    let calls = Arc::default();
    let mut wrapped = wrap(&gpu, Box::new(Probe::new(&gpu, Arc::clone(&calls))));
    let settings = find("none").expect("a technique").default_settings();
    assert!(wrapped.set(&gpu, &settings).expect("no error"), "settings are taken over");
    assert!(wrapped.draws_host_casters(), "casters of hosts are drawn");
    wrapped.set_frame(7);
    wrapped.inside_mut().forget();
    wrapped.inside_mut().inspect(Some("probe"));
    let noted = calls.lock().expect("all calls are done").clone();
    assert_eq!(noted, ["set", "frame 7", "forget", "inspect probe"]);
    let inside = wrapped.inside();
    assert_eq!(inside.light_views().iter().map(|view| view.size).collect::<Vec<_>>(), [7]);
    assert_eq!(inside.split_distances(), [3.0]);
    assert_eq!(inside.counts(), [("probes", 1)]);
    assert_eq!(inside.reads("probe"), Some(5));
    assert_eq!(inside.debug_views().iter().map(|view| view.name).collect::<Vec<_>>(), ["probe"]);
}
