//! Whether what was recorded was submitted: a host may drop an encoder, and then maps are not what
//! they are thought to be.

use std::sync::{
    Arc,
    atomic::{AtomicBool, Ordering},
};

/// Notices encoders that are dropped.
#[derive(Default)]
pub(super) struct Submission {
    dropped: Arc<AtomicBool>,
}

struct Guard {
    dropped: Arc<AtomicBool>,
    submitted: bool,
}

impl Submission {
    /// Watches an encoder that something was recorded into.
    pub fn watch(&self, encoder: &wgpu::CommandEncoder) {
        let guard = Guard { dropped: self.dropped.clone(), submitted: false };
        encoder.on_submitted_work_done(move || guard.submitted());
    }

    /// True once after an encoder was dropped.
    pub fn was_dropped(&self) -> bool {
        self.dropped.swap(false, Ordering::Relaxed)
    }
}

impl Guard {
    fn submitted(mut self) {
        self.submitted = true;
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if !self.submitted {
            self.dropped.store(true, Ordering::Relaxed);
        }
    }
}
