//! The scene that is open: on the GPU, and as rays see it.

use crate::background::Background;
use crate::state::State;
use std::collections::BTreeMap;
use std::sync::Arc;
use umbrage::Gpu;
use umbrage_core::glam::DVec3;
use umbrage_core::{Bounds, Instance, Scene, Texture};
use umbrage_reference::Tracer;
use umbrage_renderer::Renderer;
use umbrage_report::{Motion, Moving, Source, place};

/// What decides where the instances of a scene are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    time_s: f64,
    /// Of casters that move.
    frame: u32,
}

/// A scene, and what its pictures are made with.
pub(crate) struct Stage {
    pub source: Arc<Source>,
    pub renderer: Renderer,
    /// For rays, as instances are now; `None` until it is built.
    pub tracer: Option<Arc<Tracer>>,
    /// That being built, and for which moment.
    tracing: Background<(Moment, Arc<Tracer>)>,
    pub textures: Arc<[Texture]>,
    /// Of the scene, metres.
    pub radius: f64,
    pub middle: DVec3,
    motion: Motion,
    /// Where instances are.
    moment: Moment,
    /// Those that are not as the scene has them.
    placed: BTreeMap<usize, Instance>,
}

impl Stage {
    /// Uploads a scene for pictures of this size.
    pub fn new(gpu: &Gpu, source: Source, size: (u32, u32)) -> Result<Self, String> {
        let renderer = Renderer::new(gpu, &source.scene, size.0, size.1, Vec::new()).map_err(|e| e.to_string())?;
        let textures = source.scene.textures.clone().into();
        let bounds = source.scene.bounds();
        Ok(Self {
            motion: Motion::new(Moving::None, &source.scene),
            source: Arc::new(source),
            renderer,
            tracer: None,
            tracing: Background::default(),
            textures,
            radius: bounds.radius(),
            middle: bounds.center(),
            moment: Moment::default(),
            placed: BTreeMap::new(),
        })
    }

    /// A box around all that light can fall on.
    pub fn receivers(&self) -> Bounds {
        self.renderer.casters().all_bounds()
    }

    /// Some instance changes as time goes by.
    pub fn is_animated(&self) -> bool {
        self.motion.is_animated()
    }

    /// `state` with the camera and the lights where they are in its frame.
    pub fn seen(&self, state: &State) -> State {
        let mut seen = state.clone();
        for (number, light) in seen.lights.iter_mut().enumerate() {
            *light = self.motion.light(number, light, state.frame);
        }
        seen.camera = self.motion.camera(&seen.camera, state.frame);
        if let Some(path) = state.path {
            seen.camera = path.camera(&seen.camera, state.frame, self.renderer.size().1);
        }
        seen
    }

    /// Brings the instances to where they are in the frame of `state`.
    pub fn move_to(&mut self, state: &State) -> Result<(), String> {
        let scene = &self.source.scene;
        if self.motion.moving() != state.moving {
            self.motion = Motion::new(state.moving, scene);
        }
        let moment = self.moment_of(state);
        if moment == self.moment {
            return Ok(());
        }
        let now = self.motion.instances(scene, moment.time_s, moment.frame);
        let casters = self.renderer.casters_mut();
        let left = self.placed.keys().filter(|number| !now.contains_key(number));
        for number in left {
            place(casters, scene, *number, &scene.instances[*number]).map_err(|e| e.to_string())?;
        }
        for (number, instance) in &now {
            place(casters, scene, *number, instance).map_err(|e| e.to_string())?;
        }
        (self.placed, self.moment) = (now, moment);
        self.tracer = None;
        Ok(())
    }

    /// What of `state` decides where instances are.
    fn moment_of(&self, state: &State) -> Moment {
        Moment {
            time_s: if self.is_animated() { state.time_s } else { 0.0 },
            frame: if state.moving.moves(Moving::Casters) { state.frame } else { 0 },
        }
    }

    /// Where instances are.
    pub fn moment(&self) -> Moment {
        self.moment
    }

    /// Takes over what was built for rays, of the scene as it was opened.
    pub fn take_tracer(&mut self, tracer: Arc<Tracer>) {
        if self.moment == Moment::default() {
            self.tracer = Some(tracer);
        }
    }

    /// Builds the scene for rays as it is now, in the background; that of the scene as it was
    /// opened is built with it.
    pub fn trace(&mut self) {
        if let Some((_, tracer)) = self.tracing.take().filter(|(moment, _)| *moment == self.moment) {
            self.tracer = Some(tracer);
        }
        // One at a time: instances that are moved by hand would start one a frame.
        if self.tracer.is_none() && !self.tracing.is_under_way() {
            let (source, placed, moment) = (self.source.clone(), self.placed.clone(), self.moment);
            self.tracing.start(move || (moment, Arc::new(Tracer::new(&moved(&source.scene, placed)))));
        }
    }

    /// The scene is being made ready for rays.
    pub fn is_tracing(&self) -> bool {
        self.tracing.is_under_way()
    }
}

fn moved(scene: &Scene, placed: BTreeMap<usize, Instance>) -> Scene {
    let mut scene = scene.clone();
    placed.into_iter().for_each(|(number, instance)| scene.instances[number] = instance);
    scene
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
