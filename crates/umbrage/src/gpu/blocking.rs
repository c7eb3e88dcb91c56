//! What waits for the device, where a thread may wait: everywhere but in browsers.

#[cfg(feature = "native")]
use super::AdapterSummary;
use super::Gpu;
use crate::error::Error;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

#[cfg(feature = "native")]
impl Gpu {
    /// [`Gpu::adapters_async`], waited for.
    pub fn adapters() -> Vec<AdapterSummary> {
        pollster::block_on(Self::adapters_async())
    }

    /// [`Gpu::request_async`], waited for.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::Unknown`] or [`Error::NoDevice`].
    pub fn request(wanted: Option<&str>) -> Result<Self, Error> {
        pollster::block_on(Self::request_async(wanted))
    }

    /// [`Gpu::catch_async`], waited for.
    ///
    /// # Errors
    /// That of `work`, or else [`Error::Driver`].
    pub fn catch<T, E: From<Error>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        pollster::block_on(self.catch_async(work))
    }
}

impl Gpu {
    /// Waits until all submitted work is done.
    ///
    /// # Errors
    /// As [`Gpu::check`], and where the driver gives up waiting.
    pub fn wait(&self) -> Result<(), Error> {
        let polled = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        polled.map(|_| ()).map_err(|e| Error::Driver(e.to_string()))
    }

    /// Waits for what submits work and then waits for the device.
    ///
    /// # Errors
    /// Those of `work` and of [`Gpu::wait`].
    pub(crate) fn finish<T>(&self, work: impl Future<Output = Result<T, Error>>) -> Result<T, Error> {
        let mut work = pin!(work);
        let mut context = Context::from_waker(Waker::noop());
        loop {
            if let Poll::Ready(done) = work.as_mut().poll(&mut context) {
                return done;
            }
            self.wait()?;
        }
    }
}
