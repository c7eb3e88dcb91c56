//! Pictures that are computed on the CPU, some frames after what they show.

use crate::later::Newest;
use crate::pane::Shared;
use crate::stage::Stage;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use umbrage::{Error, read};
use umbrage_core::{Camera, Image};
use umbrage_metrics::{footprint_colors, texel_footprint};

type Colors = Image<[u8; 4]>;
/// What is left to do once everything has been read back.
type Work = Box<dyn FnOnce() -> Result<Colors, String> + Send>;

/// Pictures by the CPU.
const FLIP: &str = "flip";
const TEXEL_SIZE: &str = "texel-size";
const NORMAL: &str = "normal";

pub(crate) fn is_slow(picture: &str) -> bool {
    [FLIP, TEXEL_SIZE, NORMAL].contains(&picture)
}

pub(crate) fn needs_truth(picture: &str) -> bool {
    picture == FLIP
}

/// One such picture under way.
#[derive(Default)]
pub(crate) struct Slow {
    reading: Newest<Result<Work, Error>>,
    computing: Option<Receiver<Result<Colors, String>>>,
    /// Another one was asked for meanwhile.
    is_stale: bool,
}

impl Slow {
    /// Asks for `picture` of the frame that was drawn last, pass `main` of it. While one is under
    /// way, the next has to wait.
    pub fn ask(
        &mut self,
        picture: &str,
        shared: &Shared<'_>,
        stage: &Stage,
        main: usize,
        size: (u32, u32),
        camera: &Camera,
    ) -> Result<(), String> {
        if self.is_under_way() {
            self.is_stale = true;
            return Ok(());
        }
        if picture == FLIP {
            let texture = stage.renderer.visibility_texture(main).map_err(|e| e.to_string())?.clone();
            let (gpu, truth) = (shared.gpu.clone(), shared.main_truth().cloned());
            let Some(truth) = truth.filter(|truth| truth.samples > 0 && truth.visibility.size() == size) else {
                return Err("FLIP needs the truth, which is being traced".into());
            };
            let work = async move {
                let produced = read::later::one_channel(&gpu, &texture, 0).await?;
                Ok(Box::new(move || flip(&produced, &truth.visibility, &truth.scored)) as Work)
            };
            self.start(work);
            return Ok(());
        }
        let tracer = stage.tracer.clone().ok_or("the scene is being made ready for rays")?;
        let camera = camera.clone();
        let inside = stage.renderer.technique(main).map(|technique| technique.inside());
        let views = inside.map(|inside| inside.light_views().to_vec()).unwrap_or_default();
        let splits = inside.map(|inside| inside.split_distances().to_vec()).unwrap_or_default();
        if picture == TEXEL_SIZE && views.is_empty() {
            return Err("this technique has no maps, and so no texels".into());
        }
        let is_normal = picture == NORMAL;
        let work: Work = Box::new(move || {
            let seen = tracer.geometry(&camera, size.0, size.1);
            if is_normal {
                let byte = |c: f32| ((c * 0.5 + 0.5).clamp(0.0, 1.0) * 255.0).round() as u8;
                return Ok(seen.normal.map(|n| opaque(n.to_array().map(byte))));
            }
            let footprint = texel_footprint(&views, &splits, &camera, &seen.depth, &seen.normal);
            Ok(footprint_colors(&footprint).map(|color| opaque(*color)))
        });
        self.start(async move { Ok(work) });
        Ok(())
    }

    fn start(&mut self, work: impl Future<Output = Result<Work, Error>> + 'static) {
        if let Some(done) = self.reading.ask(work) {
            self.compute(done);
        }
    }

    fn compute(&mut self, work: Result<Work, Error>) {
        let (send, found) = channel();
        let work = move || {
            // Nobody waits for what another scene has left.
            let _ = send.send(work.map_err(|e| e.to_string()).and_then(|work| work()));
        };
        #[cfg(not(target_family = "wasm"))]
        std::thread::spawn(work);
        #[cfg(target_family = "wasm")]
        work();
        self.computing = Some(found);
    }

    /// The picture, once, when it has come.
    pub fn take(&mut self) -> Option<Result<Colors, String>> {
        if let Some(work) = self.reading.take() {
            self.compute(work);
        }
        let found = match self.computing.as_ref()?.try_recv() {
            Err(TryRecvError::Empty) => return None,
            Ok(found) => Some(found),
            Err(TryRecvError::Disconnected) => Some(Err("this picture could not be computed".into())),
        };
        self.computing = None;
        found
    }

    pub fn is_under_way(&self) -> bool {
        self.reading.is_under_way() || self.computing.is_some()
    }

    /// True, once, where the picture that has come is not the newest.
    pub fn was_stale(&mut self) -> bool {
        std::mem::take(&mut self.is_stale)
    }
}

fn opaque([r, g, b]: [u8; 3]) -> [u8; 4] {
    [r, g, b, 255]
}

#[cfg(feature = "flip")]
fn flip(produced: &Image<f32>, reference: &Image<f32>, mask: &Image<bool>) -> Result<Colors, String> {
    Ok(umbrage_metrics::flip_colors(produced, reference, mask).map(|color| opaque(*color)))
}

#[cfg(not(feature = "flip"))]
fn flip(_: &Image<f32>, _: &Image<f32>, _: &Image<bool>) -> Result<Colors, String> {
    Err("FLIP is not in this build: it needs a C++ compiler, and does not run in browsers".into())
}
