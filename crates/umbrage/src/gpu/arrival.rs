//! What a callback brings, as a future.

use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};

/// The end that the callback keeps.
pub(crate) struct Bringer<T>(Arc<Mutex<Slot<T>>>);

/// The end that is awaited. It gives `None` where the callback is gone without having been called.
pub(crate) struct Arrival<T>(Arc<Mutex<Slot<T>>>);

struct Slot<T> {
    value: Option<T>,
    is_gone: bool,
    waiting: Option<Waker>,
}

/// Both ends.
pub(crate) fn arrival<T>() -> (Bringer<T>, Arrival<T>) {
    let slot = Arc::new(Mutex::new(Slot { value: None, is_gone: false, waiting: None }));
    (Bringer(slot.clone()), Arrival(slot))
}

impl<T> Bringer<T> {
    /// Brings the value.
    pub fn arrive(self, value: T) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).value = Some(value);
    }
}

impl<T> Drop for Bringer<T> {
    fn drop(&mut self) {
        let mut slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        slot.is_gone = true;
        if let Some(waiting) = slot.waiting.take() {
            waiting.wake();
        }
    }
}

impl<T> Future for Arrival<T> {
    type Output = Option<T>;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<T>> {
        let mut slot = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if slot.is_gone {
            return Poll::Ready(slot.value.take());
        }
        slot.waiting = Some(context.waker().clone());
        Poll::Pending
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_arrives_and_none_where_nothing_can_come() {
        let (bringer, arrival) = arrival();
        std::thread::spawn(move || bringer.arrive(7));
        assert_eq!(pollster::block_on(arrival), Some(7));
        let (bringer, arrival) = super::arrival::<u32>();
        drop(bringer);
        assert_eq!(pollster::block_on(arrival), None);
    }
}
