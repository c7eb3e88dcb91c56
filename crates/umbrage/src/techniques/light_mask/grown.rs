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
        check(self.label, size, limit)?;
        self.buffer = storage(gpu, self.label, (size + size / 2).next_multiple_of(16).min(limit));
        Ok(true)
    }
}

/// That a shader may have all of it.
fn check(label: &str, size: u64, limit: u64) -> Result<(), Error> {
    if size <= limit {
        return Ok(());
    }
    let remedy = "fewer triangles need less, and techniques with maps none; the limit is the device's \
                  max_storage_buffer_binding_size";
    Err(Error::Size { what: format!("a buffer of the casters' {label} ({remedy})"), size, limit })
}

pub(super) fn storage(gpu: &Gpu, label: &str, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
    gpu.device.create_buffer(&wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_large_is_named_with_the_remedy() {
        assert!(check("triangles", 128, 128).is_ok());
        let error = check("triangles", 129, 128).unwrap_err().to_string();
        for part in ["the casters' triangles", "techniques with maps none", "of 129 is too large", "allows 1 to 128"] {
            assert!(error.contains(part), "{part}: {error}");
        }
    }
}
