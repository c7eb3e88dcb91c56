//! The stamps of frames, see [`super::kept`].

use super::kept::Frame;
use crate::gpu::{Gpu, Watcher};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Numbers a recorder's frames and finds out what becomes of them.
pub(super) struct Stamps {
    gpu: Gpu,
    begun: u64,
    shared: Arc<Shared>,
}

/// What frames on their way have of it.
struct Shared {
    /// Buffers that no frame is in.
    spare: Mutex<Vec<wgpu::Buffer>>,
    /// The newest frame that was executed.
    newest: AtomicU64,
}

impl Stamps {
    pub fn new(gpu: &Gpu) -> Self {
        let shared = Shared { spare: Mutex::default(), newest: AtomicU64::new(0) };
        Self { gpu: gpu.clone(), begun: 0, shared: Arc::new(shared) }
    }

    /// Starts a frame.
    pub fn begin(&mut self) -> Arc<Frame> {
        self.begun += 1;
        Arc::new(Frame::new(self.begun))
    }

    /// A buffer that the frame's number is to be copied into, and what is to be read back of it.
    pub fn stamp(&self, frame: &Arc<Frame>) -> Stamp {
        let spare = self.shared.spare.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let buffer = spare.unwrap_or_else(|| {
            self.gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("number of a frame"),
                size: 8,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        Stamp { buffer, frames: self.gpu.frames(), frame: frame.clone(), shared: self.shared.clone(), is_known: false }
    }
}

/// A frame whose encoder is under way: where it goes without being read back, the frame is lost.
pub(super) struct Stamp {
    pub buffer: wgpu::Buffer,
    frames: Watcher,
    frame: Arc<Frame>,
    shared: Arc<Shared>,
    is_known: bool,
}

impl Stamp {
    /// What the buffer holds once the frame was executed.
    pub fn bytes(&self) -> [u8; 8] {
        self.frame.number.to_le_bytes()
    }

    /// Has it read back when the encoder was submitted.
    pub fn read_on_submit(self, encoder: &wgpu::CommandEncoder) {
        let buffer = self.buffer.clone();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |result| self.arrived(result.is_ok()));
    }

    fn arrived(mut self, is_mapped: bool) {
        if !is_mapped {
            return;
        }
        let found = self.buffer.slice(..).get_mapped_range();
        self.is_known = found.is_ok_and(|found| found[..] == self.bytes());
        self.buffer.unmap();
        if self.is_known {
            self.frame.executed(self.frames.count());
            let newest = self.shared.newest.fetch_max(self.frame.number, Ordering::AcqRel);
            if newest > self.frame.number {
                self.frames.overtaken(self.frame.number, newest);
            }
        }
    }
}

impl Drop for Stamp {
    fn drop(&mut self) {
        if !self.is_known {
            self.frame.lost();
        }
        self.shared.spare.lock().unwrap_or_else(PoisonError::into_inner).push(self.buffer.clone());
    }
}
