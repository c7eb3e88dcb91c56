//! Storage that grows.

use crate::{error::Error, gpu::Gpu};

/// A storage buffer that is made anew when it gets too small.
pub(super) struct Grown {
    label: &'static str,
    pub buffer: wgpu::Buffer,
}

impl Grown {
    pub fn new(gpu: &Gpu, label: &'static str) -> Self {
        Self { label, buffer: storage(gpu, label, 256) }
    }

    /// True where it was made anew.
    pub fn fit(&mut self, gpu: &Gpu, bytes: usize) -> Result<bool, Error> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        let size = bytes as u64;
        if size <= self.buffer.size() {
            return Ok(false);
        }
        if size > limit {
            return Err(Error::Size { what: format!("{} of a light's samples", self.label), size, limit });
        }
        self.buffer = storage(gpu, self.label, (size + size / 2).next_multiple_of(16).min(limit));
        Ok(true)
    }
}

pub(super) fn storage(gpu: &Gpu, label: &str, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}
