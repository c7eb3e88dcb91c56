//! The truth, traced while the laboratory is used: on a thread of its own, or in slices where there
//! are no threads.

use std::sync::Arc;
use umbrage_core::{Camera, Image, Light, Texture};
use umbrage_reference::{Progressive, Tracer};

/// What is to be traced.
#[derive(Clone)]
pub(crate) struct Wanted {
    pub tracer: Arc<Tracer>,
    pub camera: Camera,
    pub size: (u32, u32),
    /// Each with its number.
    pub lights: Vec<(usize, Light)>,
    pub textures: Arc<[Texture]>,
}

impl PartialEq for Wanted {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.tracer, &other.tracer)
            && Arc::ptr_eq(&self.textures, &other.textures)
            && (&self.camera, self.size, &self.lights) == (&other.camera, other.size, &other.lights)
    }
}

/// The truth about one light, as far as it is known.
#[derive(Clone, Debug)]
pub(crate) struct Traced {
    /// The number of the light.
    pub light: usize,
    pub visibility: Image<f32>,
    pub scored: Image<bool>,
    /// A pixel's, in whole rounds.
    pub samples: u32,
    pub standard_error: Option<f64>,
    /// More samples would change it.
    pub goes_on: bool,
}

/// Between two pictures that a thread hands over.
#[cfg(not(target_family = "wasm"))]
const SLICE: std::time::Duration = std::time::Duration::from_millis(80);
/// For each pixel, after which nobody sees a difference.
pub(crate) const MOST_SAMPLES: u32 = 4096;

/// One job after the other; a new one ends the one before.
pub(crate) struct Truth {
    wanted: Option<Wanted>,
    /// Of the job, one for each light.
    traced: Vec<Arc<Traced>>,
    /// Counts pictures, so that others see what is new.
    version: u64,
    worker: worker::Worker,
}

impl Truth {
    pub fn new() -> Self {
        Self { wanted: None, traced: Vec::new(), version: 0, worker: worker::Worker::new() }
    }

    /// Traces this from now on; nothing happens where it is traced already.
    pub fn want(&mut self, wanted: Option<Wanted>) {
        if wanted != self.wanted {
            self.traced.clear();
            self.version += 1;
            self.wanted = wanted.clone();
            self.worker.start(wanted);
        }
    }

    /// Takes over what has been traced meanwhile; true where there is something new.
    pub fn take(&mut self) -> bool {
        let new = self.worker.take();
        for traced in new.iter() {
            match self.traced.iter_mut().find(|old| old.light == traced.light) {
                Some(old) => *old = traced.clone(),
                None => self.traced.push(traced.clone()),
            }
        }
        self.version += u64::from(!new.is_empty());
        !new.is_empty()
    }

    /// The truth about the light of this number.
    pub fn of(&self, light: usize) -> Option<&Arc<Traced>> {
        self.traced.iter().find(|traced| traced.light == light)
    }

    /// Another one whenever there is something new.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Something is traced that is not done.
    pub fn is_under_way(&self) -> bool {
        let wanted = self.wanted.as_ref().map_or(0, |wanted| wanted.lights.len());
        self.traced.len() < wanted || self.traced.iter().any(|traced| traced.goes_on)
    }
}

/// A job under way: its lights take turns.
struct Job(Vec<One>);

struct One {
    number: usize,
    light: Progressive,
    goes_on: bool,
}

impl Job {
    fn new(wanted: &Wanted) -> Self {
        let Wanted { tracer, camera, size, lights, textures } = wanted;
        let one = |(number, light): &(usize, Light)| {
            let light = Progressive::new(tracer.clone(), camera, *size, light, textures);
            One { number: *number, light, goes_on: true }
        };
        Self(lights.iter().map(one).collect())
    }

    /// Traces the light that is behind while `go_on` says so; `None` where all are done.
    fn advance(&mut self, go_on: impl FnMut() -> bool) -> Option<Traced> {
        let one = self.0.iter_mut().filter(|one| one.goes_on).min_by_key(|one| one.light.samples())?;
        one.goes_on = one.light.advance(go_on) && one.light.samples() < MOST_SAMPLES;
        Some(Traced {
            light: one.number,
            visibility: one.light.visibility().clone(),
            scored: one.light.scored().clone(),
            samples: one.light.samples(),
            standard_error: one.light.standard_error(),
            goes_on: one.goes_on,
        })
    }
}

#[cfg(not(target_family = "wasm"))]
mod worker {
    use super::{Job, SLICE, Traced, Wanted};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicU64, Ordering};
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::time::Instant;

    /// A thread that traces.
    pub struct Worker {
        /// The number of the newest job: older ones end.
        newest: Arc<AtomicU64>,
        jobs: Sender<(u64, Option<Wanted>)>,
        found: Receiver<(u64, Arc<Traced>)>,
    }

    impl Worker {
        pub fn new() -> Self {
            let newest = Arc::new(AtomicU64::new(0));
            let (jobs, to_do) = channel();
            let (done, found) = channel();
            let now = newest.clone();
            std::thread::spawn(move || work(&now, &to_do, &done));
            Self { newest, jobs, found }
        }

        pub fn start(&mut self, wanted: Option<Wanted>) {
            let number = self.newest.fetch_add(1, Ordering::Relaxed) + 1;
            // A thread that is gone has panicked, and said so.
            let _ = self.jobs.send((number, wanted));
        }

        pub fn take(&mut self) -> Vec<Arc<Traced>> {
            let newest = self.newest.load(Ordering::Relaxed);
            self.found.try_iter().filter(|(number, _)| *number == newest).map(|(_, traced)| traced).collect()
        }
    }

    impl Drop for Worker {
        fn drop(&mut self) {
            self.newest.store(u64::MAX, Ordering::Relaxed);
        }
    }

    fn work(newest: &AtomicU64, jobs: &Receiver<(u64, Option<Wanted>)>, done: &Sender<(u64, Arc<Traced>)>) {
        // One core stays with whoever uses the laboratory.
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(cores.saturating_sub(1).max(1)).build() else {
            return;
        };
        while let Ok((number, wanted)) = jobs.recv() {
            let is_newest = || newest.load(Ordering::Relaxed) == number;
            let Some(wanted) = wanted.filter(|_| is_newest()) else { continue };
            let mut job = Job::new(&wanted);
            loop {
                let start = Instant::now();
                let traced = pool.install(|| job.advance(|| is_newest() && start.elapsed() < SLICE));
                let Some(traced) = traced.filter(|_| is_newest()) else { break };
                if done.send((number, Arc::new(traced))).is_err() {
                    return;
                }
            }
        }
    }
}

#[cfg(target_family = "wasm")]
mod worker {
    use super::{Job, Traced, Wanted};
    use std::sync::Arc;
    use web_time::{Duration, Instant};

    /// Of each frame.
    const SLICE: Duration = Duration::from_millis(12);

    /// Traces in slices, between frames.
    pub struct Worker(Option<Job>);

    impl Worker {
        pub fn new() -> Self {
            Self(None)
        }

        pub fn start(&mut self, wanted: Option<Wanted>) {
            self.0 = wanted.map(|wanted| Job::new(&wanted));
        }

        pub fn take(&mut self) -> Vec<Arc<Traced>> {
            let start = Instant::now();
            let traced = self.0.as_mut().and_then(|job| job.advance(|| start.elapsed() < SLICE));
            traced.map(Arc::new).into_iter().collect()
        }
    }
}
