//! What is known of the device: whether it is lost, what the driver reported, and how far it has
//! come.

use crate::error::Error;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};

/// Shared by everything that uses a device.
#[derive(Debug)]
pub(super) struct Watch {
    /// The first error that came out of order, or the loss of the device.
    trouble: Mutex<Option<Error>>,
    /// The newest fault of the host that it has not heard of.
    fault: Mutex<Option<Error>>,
    /// Mapped for a moment, which only a device that is lost refuses.
    #[cfg(not(target_family = "wasm"))]
    probe: Mutex<wgpu::Buffer>,
    executed: AtomicU64,
    is_unsettled: AtomicBool,
}

/// Of a device that may be gone: what it calls itself must not keep it alive, since a device that
/// goes first waits for what it has to do.
#[derive(Clone, Debug)]
pub(crate) struct Watcher(Weak<Watch>);

impl Watcher {
    pub(super) fn of(watch: &Arc<Watch>) -> Self {
        Self(Arc::downgrade(watch))
    }

    /// Counts frames that were executed, of all recorders.
    pub fn count(&self) -> u64 {
        self.0.upgrade().map_or(0, |watch| watch.count_frame())
    }

    /// This frame of a recorder was executed after one that was recorded later.
    pub fn overtaken(&self, frame: u64, by: u64) {
        if let Some(watch) = self.0.upgrade() {
            watch.fault(Error::Order { frame, by });
        }
    }
}

impl Watch {
    #[cfg_attr(target_family = "wasm", expect(unused_variables, reason = "nothing is tried in a browser"))]
    pub fn new(device: &wgpu::Device) -> Self {
        Self {
            trouble: Mutex::default(),
            fault: Mutex::default(),
            #[cfg(not(target_family = "wasm"))]
            probe: Mutex::new(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("whether the device is there"),
                size: 8,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })),
            executed: AtomicU64::new(0),
            is_unsettled: AtomicBool::new(false),
        }
    }

    /// A lost device stays lost; of other errors the first one counts.
    pub fn report(&self, error: Error) {
        let mut trouble = lock(&self.trouble);
        if trouble.is_none() || matches!(error, Error::DeviceLost(_)) {
            *trouble = Some(error);
        }
    }

    pub fn trouble(&self) -> Option<Error> {
        lock(&self.trouble).clone()
    }

    /// The loss of the device, which a host's own device tells nobody but the host: so it is tried.
    pub fn loss(&self) -> Option<Error> {
        let known = || self.trouble().filter(|error| matches!(error, Error::DeviceLost(_)));
        known().or_else(|| {
            if self.answers() {
                return None;
            }
            self.report(Error::DeviceLost("it does not answer any more".into()));
            known()
        })
    }

    /// A device that is there maps later, one that is lost refuses at once. In a browser nothing is
    /// told at once, and all is taken to go well.
    #[cfg(not(target_family = "wasm"))]
    fn answers(&self) -> bool {
        let probe = lock(&self.probe);
        let refused = Arc::new(AtomicBool::new(false));
        let told = refused.clone();
        probe.slice(..).map_async(wgpu::MapMode::Read, move |result| told.store(result.is_err(), Ordering::Relaxed));
        let is_refused = refused.load(Ordering::Relaxed);
        if !is_refused {
            probe.unmap();
        }
        !is_refused
    }

    #[cfg(target_family = "wasm")]
    fn answers(&self) -> bool {
        true
    }

    /// For [`Watch::take_fault`].
    pub fn fault(&self, error: Error) {
        *lock(&self.fault) = Some(error);
    }

    /// What the host did wrong and has not heard of.
    pub fn take_fault(&self) -> Option<Error> {
        lock(&self.fault).take()
    }

    /// The how manieth frame of all recorders it is that was executed now.
    pub fn count_frame(&self) -> u64 {
        self.executed.fetch_add(1, Ordering::AcqRel) + 1
    }

    /// Work was recorded since [`Watch::settle`].
    pub fn unsettle(&self) {
        self.is_unsettled.store(true, Ordering::Relaxed);
    }

    /// True where work was recorded since the last time.
    pub fn settle(&self) -> bool {
        self.is_unsettled.swap(false, Ordering::Relaxed)
    }
}

/// What is behind these locks is right whoever panicked.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
