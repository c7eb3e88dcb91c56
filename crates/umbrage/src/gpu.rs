//! The device: an adapter of ours, or a host's own.

mod adapter;
mod arrival;
#[cfg(not(target_family = "wasm"))]
mod blocking;
mod pipelines;
#[cfg(any(feature = "native", target_family = "wasm"))]
mod request;
mod shared;
mod watch;

use crate::error::Error;
use crate::snapping;
pub use adapter::AdapterSummary;
pub(crate) use arrival::arrival;
pub use pipelines::{PipelineKind, PipelineParts, RenderParts, StageParts};
use shared::Shared;
use std::pin::pin;
use std::sync::{Arc, OnceLock};
use std::task::{Context, Poll, Waker};
use watch::Watch;
pub(crate) use watch::Watcher;

/// A device with its queue, cheap to clone. Clones share what techniques compile; a host makes one
/// for its device and clones that.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    adapter: AdapterSummary,
    watch: Arc<Watch>,
    snapping: Arc<OnceLock<f32>>,
    shared: Arc<Shared>,
}

impl Gpu {
    /// Features that make techniques faster or more exact and are asked for where the adapter has
    /// them. Every technique either works without them or says that it can't.
    pub const WANTED: wgpu::Features = wgpu::Features::TIMESTAMP_QUERY
        .union(wgpu::Features::DEPTH_CLIP_CONTROL)
        .union(wgpu::Features::DEPTH32FLOAT_STENCIL8)
        .union(wgpu::Features::FLOAT32_FILTERABLE)
        .union(wgpu::Features::FLOAT32_BLENDABLE)
        .union(wgpu::Features::INDIRECT_FIRST_INSTANCE);

    /// A host's own device. The host keeps its error and device-lost handlers; that the device is
    /// lost is noticed all the same, but in a browser, where the host has to say so: [`Gpu::lost`].
    pub fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let adapter = AdapterSummary::of_info(&device.adapter_info());
        let watch = Arc::new(Watch::new(&device));
        Self { device, queue, adapter, watch, snapping: Arc::default(), shared: Arc::default() }
    }

    /// To be called by a host's own device-lost handler: from here on, everything that would use
    /// the device is [`Error::DeviceLost`] with this reason. It is for all clones of this value.
    pub fn lost(&self, reason: &str) {
        self.watch.report(Error::DeviceLost(reason.into()));
    }

    /// The adapter in use.
    pub fn adapter(&self) -> &AdapterSummary {
        &self.adapter
    }

    /// True where the device has all of `features`.
    pub fn has(&self, features: wgpu::Features) -> bool {
        self.device.features().contains(features)
    }

    /// Pixels by which the rasteriser may shift a surface, since it snaps corners of triangles:
    /// measured once, which waits for the device, or what every device keeps to where it can't be
    /// measured. In a browser it is what [`Gpu::measure_async`] has found before.
    pub fn snapping(&self) -> f32 {
        #[cfg(not(target_family = "wasm"))]
        let found = self.snapping.get_or_init(|| self.finish(snapping::measured(self)).unwrap_or(snapping::GUARANTEED));
        #[cfg(target_family = "wasm")]
        let found = self.snapping.get().unwrap_or(&snapping::GUARANTEED);
        *found
    }

    /// Measures how exactly the device rasterises, which maps allow for. Where threads may wait,
    /// the first technique with maps does so by itself. In a browser, a host with a device of its
    /// own calls this once; without it, maps allow for the coarsest device there may be.
    pub async fn measure_async(&self) {
        if self.snapping.get().is_none() {
            let found = snapping::measured(self).await.unwrap_or(snapping::GUARANTEED);
            // Whoever was faster has found the same.
            let _ = self.snapping.set(found);
        }
    }

    /// The first error that the driver reported out of order, if any; a lost device stays lost. Of
    /// a host's own device, other errors than its loss go to the host.
    ///
    /// # Errors
    /// [`Error::DeviceLost`] or [`Error::Driver`].
    pub fn check(&self) -> Result<(), Error> {
        self.check_loss()?;
        self.watch.trouble().map_or(Ok(()), Err)
    }

    /// That the device is not lost.
    pub(crate) fn check_loss(&self) -> Result<(), Error> {
        self.watch.loss().map_or(Ok(()), Err)
    }

    /// That the host has done nothing wrong that it has not heard of.
    pub(crate) fn check_fault(&self) -> Result<(), Error> {
        self.watch.take_fault().map_or(Ok(()), Err)
    }

    /// Learns what became of frames that were submitted, without waiting for any; once after each.
    pub(crate) fn settle(&self) {
        if self.watch.settle() && self.check_loss().is_ok() {
            // What it returns is news of the queue, which nobody asked for.
            let _ = self.device.poll(wgpu::PollType::Poll);
        }
    }

    /// There is work to learn of.
    pub(crate) fn unsettle(&self) {
        self.watch.unsettle();
    }

    /// For what the device calls when something has happened.
    pub(crate) fn frames(&self) -> Watcher {
        Watcher::of(&self.watch)
    }

    /// Waits until all work that was submitted before is done. In a browser it is told by itself;
    /// elsewhere somebody has to poll the device meanwhile.
    ///
    /// # Errors
    /// As [`Gpu::check`].
    pub async fn wait_async(&self) -> Result<(), Error> {
        let (report, done) = arrival();
        self.queue.on_submitted_work_done(move || report.arrive(()));
        done.await;
        self.check()
    }

    /// Does `work` and takes what the driver reports meanwhile as its error, where [`Gpu::check`]
    /// would hold it against all that comes later. A lost device stays lost.
    ///
    /// # Errors
    /// That of `work`, or else [`Error::Driver`].
    pub async fn catch_async<T, E: From<Error>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let scopes = [Validation, OutOfMemory, Internal].map(|filter| self.device.push_error_scope(filter));
        let done = work();
        let mut reported = None;
        // The last one pushed is the first to go.
        for scope in scopes.into_iter().rev() {
            reported = scope.pop().await.or(reported);
        }
        match (done, reported) {
            (done, None) => done,
            (done, Some(error)) => {
                // What was made meanwhile may be of no use, and others are not to get it.
                self.shared.clear();
                done.and(Err(Error::Driver(error.to_string()).into()))
            }
        }
    }

    /// Does `work` and gives what the driver rejects in it at once. A browser tells later, and
    /// reports it in its own way: there, everything passes.
    pub(crate) fn validated<T>(&self, work: impl FnOnce() -> T) -> Result<T, String> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let done = work();
        let mut report = pin!(scope.pop());
        match report.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(Some(error)) => Err(error.to_string()),
            Poll::Ready(None) | Poll::Pending => Ok(done),
        }
    }

    /// A two-dimensional texture size checked against the adapter's limit.
    ///
    /// # Errors
    /// [`Error::Size`], [`Error::DeviceLost`].
    pub fn check_size(&self, what: &str, width: u32, height: u32) -> Result<(), Error> {
        self.check_loss()?;
        let limit = self.device.limits().max_texture_dimension_2d;
        for size in [width, height] {
            if size == 0 || size > limit {
                return Err(Error::Size { what: what.into(), size: size.into(), limit: limit.into() });
            }
        }
        Ok(())
    }

    /// A buffer that holds `data`, padded to a multiple of 16 bytes and never empty.
    pub fn buffer<T: bytemuck::NoUninit>(&self, label: &str, data: &[T], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let mut contents = bytemuck::cast_slice::<T, u8>(data).to_vec();
        contents.resize(contents.len().next_multiple_of(16).max(16), 0);
        let size = contents.len() as u64;
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: true,
        });
        // Memory that is not there is that of a lost device, see `Gpu::check`, or too much.
        if let Ok(mut memory) = buffer.slice(..).get_mapped_range_mut() {
            memory.copy_from_slice(&contents);
        }
        buffer.unmap();
        buffer
    }
}
