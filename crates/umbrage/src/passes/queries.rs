//! Queries of a frame and the buffers they are read back through, without ever waiting.

use crate::gpu::Gpu;
use std::sync::{Arc, Mutex, mpsc};

/// Passes that one frame can ask of (4096 queries are the most that WebGPU allows in a set). A
/// frame with more has no answers at all, rather than those of a part.
const MOST: u32 = 2048;

/// Read-backs under way at most; a frame beyond them goes without rather than waiting.
const IN_FLIGHT: usize = 4;

/// Queries, `each` of them for what is called `N`.
pub(super) struct Queries<N> {
    pub set: wgpu::QuerySet,
    each: u32,
    resolved: wgpu::Buffer,
    names: Vec<N>,
    spare: Vec<wgpu::Buffer>,
    arrived: mpsc::Receiver<Frame<N>>,
    sender: Arc<Mutex<mpsc::Sender<Frame<N>>>>,
}

/// A frame's answers on the way back: the buffer, mapped where they have arrived, and what they
/// belong to. Wherever it is dropped the buffer comes back.
struct Frame<N> {
    buffer: wgpu::Buffer,
    is_mapped: bool,
    names: Vec<N>,
}

/// A frame that is under way: an encoder that is dropped drops it.
struct Underway<N> {
    frame: Option<Frame<N>>,
    sender: Arc<Mutex<mpsc::Sender<Frame<N>>>>,
}

impl<N> Drop for Underway<N> {
    fn drop(&mut self) {
        if let (Some(frame), Ok(sender)) = (self.frame.take(), self.sender.lock()) {
            // The receiver is gone only when the queries are, and then nobody waits.
            let _ = sender.send(frame);
        }
    }
}

impl<N: wgpu::WasmNotSend + 'static> Queries<N> {
    pub fn new(gpu: &Gpu, label: &str, ty: wgpu::QueryType, each: u32) -> Self {
        let buffer = |usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: u64::from(MOST * each) * 8,
                usage,
                mapped_at_creation: false,
            })
        };
        let (sender, arrived) = mpsc::channel();
        let back = || buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor { label: Some(label), ty, count: MOST * each }),
            each,
            resolved: buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            names: Vec::new(),
            spare: (0..IN_FLIGHT).map(|_| back()).collect(),
            arrived,
            sender: Arc::new(Mutex::new(sender)),
        }
    }

    /// Before the first pass of a frame.
    pub fn begin(&mut self) {
        self.names.clear();
    }

    /// The first query of a pass; `None` where there are too many.
    pub fn slot(&mut self, name: N) -> Option<u32> {
        let i = self.names.len() as u32;
        self.names.push(name);
        (i < MOST).then_some(self.each * i)
    }

    /// After the last pass; false where the frame has no answers, since it has no passes or too
    /// many.
    pub fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) -> bool {
        let passes = self.names.len() as u32;
        if passes == 0 || passes > MOST {
            return false;
        }
        let Some(buffer) = self.spare.pop() else { return true };
        let count = self.each * passes;
        let bytes = u64::from(count) * 8;
        encoder.resolve_query_set(&self.set, 0..count, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &buffer, 0, bytes);
        let frame = Frame { buffer: buffer.clone(), is_mapped: false, names: std::mem::take(&mut self.names) };
        let mut underway = Underway { frame: Some(frame), sender: self.sender.clone() };
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, 0..bytes, move |result| {
            if let Some(frame) = &mut underway.frame {
                frame.is_mapped = result.is_ok();
            }
        });
        true
    }

    /// The answers of the newest frame that have arrived since the last call.
    pub fn newest(&mut self) -> Option<(Vec<N>, Vec<u64>)> {
        let mut newest = None;
        while let Ok(Frame { buffer, is_mapped, names }) = self.arrived.try_recv() {
            if is_mapped {
                let bytes = u64::from(self.each) * names.len() as u64 * 8;
                if let Ok(range) = buffer.slice(0..bytes).get_mapped_range() {
                    newest = Some((names, bytemuck::pod_collect_to_vec(&range)));
                }
                buffer.unmap();
            }
            self.spare.push(buffer);
        }
        newest
    }
}
