//! The scene that is open: on the GPU, and as rays see it.

use std::sync::Arc;
use umbrage::Gpu;
use umbrage_core::Texture;
use umbrage_reference::Tracer;
use umbrage_renderer::Renderer;
use umbrage_report::Source;

/// A scene, and what its pictures are made with.
pub(crate) struct Stage {
    pub source: Source,
    pub renderer: Renderer,
    /// `None` until it is built.
    pub tracer: Option<Arc<Tracer>>,
    pub textures: Arc<[Texture]>,
    /// Of the scene, metres.
    pub radius: f64,
}

impl Stage {
    /// Uploads a scene for pictures of this size.
    pub fn new(gpu: &Gpu, source: Source, size: (u32, u32)) -> Result<Self, String> {
        let renderer = Renderer::new(gpu, &source.scene, size.0, size.1, Vec::new()).map_err(|e| e.to_string())?;
        let textures = source.scene.textures.clone().into();
        let radius = source.scene.bounds().radius();
        Ok(Self { source, renderer, tracer: None, textures, radius })
    }
}

/// What comes of opening a scene, one after the other.
pub(crate) enum Opened {
    /// The scene, or why it could not be read.
    Scene(Box<Result<Source, String>>),
    /// The same for rays.
    Tracer(Arc<Tracer>),
}

/// A scene that is being opened, while the window stays in use.
pub(crate) struct Opening {
    /// As users name it.
    pub name: String,
    found: std::sync::mpsc::Receiver<Opened>,
}

impl Opening {
    /// Opens the scene that `open` gives; natively on a thread of its own.
    pub fn start(name: &str, open: impl FnOnce() -> Result<Source, String> + Send + 'static) -> Self {
        let (send, found) = std::sync::mpsc::channel();
        let work = move || {
            let source = open();
            let scene = source.as_ref().ok().map(|source| source.scene.clone());
            // Nobody waits where another scene was asked for meanwhile.
            if send.send(Opened::Scene(Box::new(source))).is_ok()
                && let Some(scene) = scene
            {
                let _ = send.send(Opened::Tracer(Arc::new(Tracer::new(&scene))));
            }
        };
        #[cfg(not(target_family = "wasm"))]
        std::thread::spawn(work);
        #[cfg(target_family = "wasm")]
        work();
        Self { name: name.into(), found }
    }

    /// What has come since; `Err` where nothing more will come.
    pub fn take(&self) -> Result<Option<Opened>, ()> {
        use std::sync::mpsc::TryRecvError::{Disconnected, Empty};
        match self.found.try_recv() {
            Ok(found) => Ok(Some(found)),
            Err(Empty) => Ok(None),
            Err(Disconnected) => Err(()),
        }
    }
}
