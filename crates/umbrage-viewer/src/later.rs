//! Values that come some frames later.

use std::future::Future;
use std::pin::Pin;
use std::task::{Context, Poll, Waker};

/// A future that is asked in every frame, so that no frame waits for it.
pub(crate) struct Later<T>(Pin<Box<dyn Future<Output = T>>>);

impl<T> Later<T> {
    /// Starts `work`: what it does before it waits for the first time is done at once.
    pub fn start(work: impl Future<Output = T> + 'static) -> (Self, Option<T>) {
        let mut later = Self(Box::pin(work));
        let done = later.take();
        (later, done)
    }

    /// The value, once, where it has come.
    pub fn take(&mut self) -> Option<T> {
        match self.0.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(value) => Some(value),
            Poll::Pending => None,
        }
    }
}

/// What is asked for again and again, one after the other.
pub(crate) struct Newest<T> {
    under_way: Option<Later<T>>,
}

impl<T> Default for Newest<T> {
    fn default() -> Self {
        Self { under_way: None }
    }
}

impl<T> Newest<T> {
    /// Something was asked for and has not come.
    pub fn is_under_way(&self) -> bool {
        self.under_way.is_some()
    }

    /// Asks for the next one; what was under way is not waited for.
    pub fn ask(&mut self, work: impl Future<Output = T> + 'static) -> Option<T> {
        let (later, done) = Later::start(work);
        self.under_way = done.is_none().then_some(later);
        done
    }

    /// What has come.
    pub fn take(&mut self) -> Option<T> {
        let done = self.under_way.as_mut()?.take();
        if done.is_some() {
            self.under_way = None;
        }
        done
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_comes_at_once_and_once() {
        let mut newest = Newest::default();
        assert_eq!(newest.ask(async { 3 }), Some(3));
        assert!(!newest.is_under_way() && newest.take().is_none());
    }

    #[test]
    fn what_is_asked_for_later_takes_the_place_of_what_was_under_way() {
        let mut newest = Newest::default();
        assert_eq!(newest.ask(std::future::pending::<i32>()), None);
        assert!(newest.is_under_way() && newest.take().is_none());
        assert_eq!(newest.ask(async { 4 }), Some(4));
        assert!(!newest.is_under_way());
    }
}
