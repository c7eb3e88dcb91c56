//! Work beside the frames.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// One piece of work under way, natively on a thread of its own.
pub(crate) struct Background<T>(Option<Receiver<T>>);

impl<T> Default for Background<T> {
    fn default() -> Self {
        Self(None)
    }
}

impl<T: Send + 'static> Background<T> {
    /// Starts `work`; what was under way is not waited for.
    pub fn start(&mut self, work: impl FnOnce() -> T + Send + 'static) {
        let (send, found) = channel();
        let work = move || {
            // Nobody waits where something else was asked for meanwhile.
            let _ = send.send(work());
        };
        #[cfg(not(target_family = "wasm"))]
        std::thread::spawn(work);
        #[cfg(target_family = "wasm")]
        work();
        self.0 = Some(found);
    }

    /// What has come of it, once.
    pub fn take(&mut self) -> Option<T> {
        let found = self.0.as_ref()?.try_recv();
        if !matches!(found, Err(TryRecvError::Empty)) {
            self.0 = None;
        }
        found.ok()
    }

    pub fn is_under_way(&self) -> bool {
        self.0.is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_done_comes_once() {
        let mut background = Background::default();
        background.start(|| 7);
        let found = loop {
            if let Some(found) = background.take() {
                break found;
            }
            std::thread::yield_now();
        };
        assert_eq!((found, background.is_under_way(), background.take()), (7, false, None));
    }
}
