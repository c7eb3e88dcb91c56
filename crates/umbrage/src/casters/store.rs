//! Buffers of things that come and go.

use super::journal::Journal;
use crate::{error::Error, gpu::Gpu};
use range_alloc::RangeAllocator;
use std::ops::Range;

/// A buffer that grows.
pub(super) struct Store {
    what: &'static str,
    /// Bytes of an element.
    stride: u64,
    usage: wgpu::BufferUsages,
    /// Bytes that it may have.
    limit: u64,
    buffer: wgpu::Buffer,
}

impl Store {
    /// Room for `count` elements that shaders read all of.
    pub fn new(gpu: &Gpu, what: &'static str, stride: u64, count: u64) -> Result<Self, Error> {
        let limits = gpu.device.limits();
        let limit = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        Self::within(gpu, (what, stride, count), wgpu::BufferUsages::STORAGE, limit)
    }

    /// Room for `count` elements that draws read, and shaders only where they fit.
    pub fn drawn(
        gpu: &Gpu,
        (what, stride, count): (&'static str, u64, u64),
        usage: wgpu::BufferUsages,
    ) -> Result<Self, Error> {
        Self::within(gpu, (what, stride, count), usage, gpu.device.limits().max_buffer_size)
    }

    fn within(
        gpu: &Gpu,
        (what, stride, count): (&'static str, u64, u64),
        usage: wgpu::BufferUsages,
        limit: u64,
    ) -> Result<Self, Error> {
        let usage = usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let size = count * stride;
        if size > limit {
            return Err(Error::Size { what: format!("the buffer of {what}"), size, limit });
        }
        Ok(Self { what, stride, usage, limit, buffer: buffer(gpu, what, size, usage) })
    }

    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// `count` elements from `first` on.
    pub fn slice(&self, first: u32, count: u32) -> wgpu::BufferSlice<'_> {
        let start = u64::from(first) * self.stride;
        self.buffer.slice(start..start + u64::from(count) * self.stride)
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    fn room(&self) -> u64 {
        self.buffer.size() / self.stride
    }

    /// Replaces elements from `first` on; there must be room.
    pub fn write<T: bytemuck::NoUninit>(&self, journal: &mut Journal, first: u32, data: &[T]) {
        journal.write(&self.buffer, u64::from(first) * self.stride, data);
    }

    /// Whether so many elements fit what the adapter allows.
    pub fn check(&self, count: u64) -> Result<(), Error> {
        let (size, limit) = (count * self.stride, self.limit);
        if size <= limit {
            return Ok(());
        }
        Err(Error::Size { what: format!("the buffer of {}", self.what), size, limit })
    }

    /// Has room for `count` elements, half as many again where it has to grow; true where it did.
    /// Its contents follow on the GPU.
    pub fn fit(&mut self, gpu: &Gpu, count: u64, journal: &mut Journal) -> Result<bool, Error> {
        if count <= self.room() {
            return Ok(false);
        }
        self.check(count)?;
        // Shaders bind whole buffers: room to spare is not to be what keeps them from it.
        let bound = gpu.device.limits().max_storage_buffer_binding_size.min(self.limit);
        let limit = if count * self.stride <= bound { bound } else { self.limit };
        let most = ((limit & !15) / self.stride).max(count);
        let larger = buffer(gpu, self.what, (count + count / 2).min(most) * self.stride, self.usage);
        journal.copy(&self.buffer, &larger);
        self.buffer = larger;
        Ok(true)
    }
}

fn buffer(gpu: &Gpu, what: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(what),
        size: size.next_multiple_of(16).max(16),
        usage,
        mapped_at_creation: false,
    })
}

/// Which parts of a row of elements are in use.
pub(super) struct Parts {
    free: RangeAllocator<u32>,
    end: u32,
}

/// Draws count vertices by signed numbers.
const MOST: u32 = i32::MAX as u32;

impl Parts {
    /// All free.
    pub fn new() -> Self {
        Self { free: RangeAllocator::new(0..0), end: 0 }
    }

    /// A part of so many elements, at the end where no gap holds it. `None` beyond 31 bits.
    pub fn take(&mut self, count: u32) -> Option<Range<u32>> {
        if count == 0 || count > MOST {
            return (count == 0).then_some(0..0);
        }
        if let Ok(found) = self.free.allocate_range(count) {
            return Some(found);
        }
        self.end = self.end.checked_add(count).filter(|end| *end <= MOST)?;
        self.free.grow_to(self.end);
        self.free.allocate_range(count).ok()
    }

    pub fn give_back(&mut self, part: Range<u32>) {
        if !part.is_empty() {
            self.free.free_range(part);
        }
    }

    /// How many elements there have to be.
    pub fn end(&self) -> u32 {
        self.end
    }
}

#[cfg(test)]
mod tests {
    use super::Parts;

    #[test]
    fn parts_do_not_overlap_and_gaps_are_used_again() {
        let mut parts = Parts::new();
        let mut taken: Vec<_> = (1..20).map(|n| parts.take(n * 7 % 11 + 1).expect("room")).collect();
        for round in 0..200_usize {
            let part = taken.swap_remove(round * 13 % taken.len());
            parts.give_back(part);
            taken.push(parts.take(round as u32 * 5 % 13).expect("room"));
            let mut sorted: Vec<_> = taken.iter().filter(|p| !p.is_empty()).collect();
            sorted.sort_by_key(|p| p.start);
            assert!(sorted.windows(2).all(|two| two[0].end <= two[1].start), "round {round}: {sorted:?}");
            assert!(sorted.last().is_none_or(|last| last.end <= parts.end()));
        }
        assert!(parts.end() < 400, "{}", parts.end());
        assert_eq!(Parts::new().take(0), Some(0..0));
        let mut full = Parts::new();
        assert!(full.take(super::MOST).is_some() && full.take(1).is_none());
    }
}
