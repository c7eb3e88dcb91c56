//! Whether what is on the GPU is what it was recorded to be. A host may drop an encoder, submit it
//! in vain since something in it is not valid, or submit two in another order than they were
//! recorded in; whoever keeps maps or poses from frame to frame has to know.
//!
//! A driver does not tell which encoder failed, so every frame leaves a stamp: its number, copied
//! into a buffer that is read back. A number that does not come back was not executed, nor was
//! anything else in the encoder.

use super::Passes;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What was recorded from [`super::Recorder::begin`] to [`Passes::finish`].
pub(super) struct Frame {
    /// Counted by its recorder.
    pub number: u64,
    fate: AtomicU64,
}

/// What became of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fate {
    /// It was not submitted yet, or the GPU is at it.
    Open,
    /// Nothing of it was executed, and nothing will be.
    Lost,
    /// The how manieth of all frames of the device it was.
    Executed(u64),
}

impl Frame {
    pub fn new(number: u64) -> Self {
        Self { number, fate: AtomicU64::new(0) }
    }

    pub fn lost(&self) {
        self.fate.store(u64::MAX, Ordering::Release);
    }

    /// `order` counts from 1.
    pub fn executed(&self, order: u64) {
        self.fate.store(order, Ordering::Release);
    }

    fn fate(&self) -> Fate {
        match self.fate.load(Ordering::Acquire) {
            0 => Fate::Open,
            u64::MAX => Fate::Lost,
            order => Fate::Executed(order),
        }
    }
}

/// The frames that something on the GPU was changed in and that are not known to be executed. It
/// belongs to whoever keeps the thing.
#[derive(Default)]
pub struct Kept {
    open: Vec<Arc<Frame>>,
}

impl Kept {
    /// The thing is changed, or is relied on, by what is recorded in this frame.
    pub fn note(&mut self, passes: &Passes<'_>) {
        if self.open.last().is_none_or(|last| !Arc::ptr_eq(last, passes.frame())) {
            self.open.push(passes.frame().clone());
        }
    }

    /// True where no frame is open any more, when that was last asked for by [`Kept::holds`].
    pub(crate) fn is_settled(&self) -> bool {
        self.open.is_empty()
    }

    /// False once for everything that went wrong: the thing is then not what it was recorded to be,
    /// and has to be made anew. Where the GPU has not reached a frame yet, all is taken to go well.
    pub fn holds(&mut self) -> bool {
        let (mut holds, mut latest, mut is_overtaken) = (true, 0, false);
        self.open.retain(|frame| match frame.fate() {
            Fate::Open => {
                is_overtaken = true;
                true
            }
            Fate::Lost => {
                holds = false;
                false
            }
            Fate::Executed(order) => {
                holds &= !is_overtaken && order > latest;
                latest = latest.max(order);
                false
            }
        });
        holds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(count: u64) -> (Kept, Vec<Arc<Frame>>) {
        let frames: Vec<_> = (1..=count).map(|number| Arc::new(Frame::new(number))).collect();
        (Kept { open: frames.clone() }, frames)
    }

    #[test]
    fn frames_that_are_executed_in_order_hold() {
        let (mut kept, frames) = kept(3);
        assert!(kept.holds());
        frames[0].executed(5);
        assert!(kept.holds());
        frames[1].executed(6);
        frames[2].executed(9);
        assert!(kept.holds() && kept.open.is_empty());
    }

    #[test]
    fn a_lost_frame_is_told_once() {
        let (mut kept, frames) = kept(2);
        frames[0].lost();
        assert!(!kept.holds());
        assert!(kept.holds());
        frames[1].executed(1);
        assert!(kept.holds());
    }

    #[test]
    fn a_frame_that_was_overtaken_is_told() {
        let (mut kept, frames) = kept(2);
        frames[1].executed(1);
        assert!(!kept.holds(), "the second before the first");
        kept.open.push(Arc::new(Frame::new(3)));
        kept.open[1].executed(2);
        frames[0].executed(3);
        assert!(!kept.holds(), "what the third made was undone by the first");
        assert!(kept.holds() && kept.open.is_empty());
    }
}
