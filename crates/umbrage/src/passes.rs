//! Recording: passes with names and GPU times, and uploads that happen in the order they are
//! recorded.
//!
//! `Queue::write_buffer` takes effect before everything in the encoder, so a technique that is
//! recorded twice in one encoder (brute force over many light samples) would see only its last
//! uniforms. Uploads here are copies within the encoder, from a staging belt that keeps its memory.

use crate::gpu::Gpu;
use std::{
    fmt,
    sync::{Arc, Mutex, mpsc},
};
use wgpu::util::StagingBelt;

/// Passes that one frame can time (4096 queries are the most that WebGPU allows in a set). A frame
/// with more has no times at all, rather than the sum of a part.
const MAX_TIMED: u32 = 2048;

/// Whose a pass is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// A part of the host, by its name: `gbuffer`, `shading`.
    Host(&'static str),
    /// The technique of the light of this number.
    Light(usize),
}

impl fmt::Display for Owner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Host(name) => f.write_str(name),
            Self::Light(number) => write!(f, "light {number}"),
        }
    }
}

/// GPU time of one pass, or the sum over passes of the same name in a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// Who recorded it.
    pub owner: Owner,
    /// The pass.
    pub pass: String,
    /// Milliseconds between its start and its end on the GPU.
    pub time_ms: f64,
}

/// What recording needs across frames: upload memory and timestamp queries.
pub struct Recorder {
    belt: StagingBelt,
    timer: Option<Timer>,
}

impl Recorder {
    /// Times passes where the device has `TIMESTAMP_QUERY`.
    pub fn new(gpu: &Gpu) -> Self {
        let timer = gpu.has(wgpu::Features::TIMESTAMP_QUERY).then(|| Timer::new(gpu));
        Self { belt: StagingBelt::new(gpu.device.clone(), 1 << 18), timer }
    }

    /// Starts a frame on a host's encoder. Call [`Passes::finish`] before the encoder is finished.
    pub fn begin<'a>(&'a mut self, encoder: &'a mut wgpu::CommandEncoder) -> Passes<'a> {
        if let Some(timer) = &mut self.timer {
            timer.names.clear();
        }
        Passes { encoder, belt: &mut self.belt, timer: self.timer.as_mut(), owner: Owner::Host("") }
    }

    /// GPU times of the newest frame whose results have arrived; empty without timestamps. Never
    /// waits: poll the device first to be sure of the last frame.
    pub fn times(&mut self) -> Vec<PassTime> {
        self.timer.as_mut().map_or_else(Vec::new, Timer::collect)
    }
}

/// One frame's recording.
pub struct Passes<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    belt: &'a mut StagingBelt,
    timer: Option<&'a mut Timer>,
    owner: Owner,
}

impl Passes<'_> {
    /// The encoder, for copies and what else needs no timing.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.encoder
    }

    /// Milliseconds on the GPU that all passes of the present owner took in the newest frame whose
    /// times have arrived.
    pub fn last_ms(&self) -> Option<f64> {
        let own = self.timer.as_ref()?.latest.iter().filter(|t| t.owner == self.owner);
        own.map(|t| t.time_ms).reduce(|sum, ms| sum + ms)
    }

    /// Names whom the following passes belong to in [`PassTime::owner`].
    pub fn owner(&mut self, owner: Owner) {
        self.owner = owner;
    }

    /// Replaces the start of `buffer` by `data` for everything recorded after this.
    /// `data` is a multiple of four bytes long.
    pub fn upload(&mut self, buffer: &wgpu::Buffer, data: &[u8]) {
        if let Some(size) = wgpu::BufferSize::new(data.len() as u64) {
            self.belt.write_buffer(self.encoder, buffer, 0, size).copy_from_slice(data);
        }
    }

    /// A render pass, timed under its label.
    pub fn render(
        &mut self,
        label: &str,
        color: &[Option<wgpu::RenderPassColorAttachment<'_>>],
        depth_stencil: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    ) -> wgpu::RenderPass<'_> {
        let slot = self.timer.as_mut().and_then(|t| t.slot(self.owner, label));
        let timestamp_writes = slot.zip(self.timer.as_ref()).map(|(i, t)| wgpu::RenderPassTimestampWrites {
            query_set: &t.queries,
            beginning_of_pass_write_index: Some(2 * i),
            end_of_pass_write_index: Some(2 * i + 1),
        });
        self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: color,
            depth_stencil_attachment: depth_stencil,
            timestamp_writes,
            ..Default::default()
        })
    }

    /// A compute pass, timed under its label.
    pub fn compute(&mut self, label: &str) -> wgpu::ComputePass<'_> {
        let slot = self.timer.as_mut().and_then(|t| t.slot(self.owner, label));
        let timestamp_writes = slot.zip(self.timer.as_ref()).map(|(i, t)| wgpu::ComputePassTimestampWrites {
            query_set: &t.queries,
            beginning_of_pass_write_index: Some(2 * i),
            end_of_pass_write_index: Some(2 * i + 1),
        });
        self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes })
    }

    /// Ends the frame: times are on their way, upload memory comes back when the GPU is done with
    /// it.
    pub fn finish(self) {
        if let Some(timer) = self.timer {
            timer.resolve(self.encoder);
        }
        self.belt.finish_and_recall_on_submit(self.encoder);
    }
}

/// Timestamp queries of a frame and the buffers they are read back through.
struct Timer {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    period_ns: f64,
    names: Vec<(Owner, String)>,
    spare: Vec<wgpu::Buffer>,
    arrived: mpsc::Receiver<Frame>,
    sender: Arc<Mutex<mpsc::Sender<Frame>>>,
    latest: Vec<PassTime>,
}

/// A frame's timestamps on the way back: the mapped buffer and what its pairs are.
struct Frame {
    buffer: wgpu::Buffer,
    names: Vec<(Owner, String)>,
}

/// Read-backs under way at most; a frame beyond them goes untimed rather than waiting.
const IN_FLIGHT: usize = 4;

impl Timer {
    fn new(gpu: &Gpu) -> Self {
        let size = u64::from(MAX_TIMED) * 16;
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let (sender, arrived) = mpsc::channel();
        Self {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("timestamps"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MAX_TIMED,
            }),
            resolved: buffer("timestamps", wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
            names: Vec::new(),
            spare: (0..IN_FLIGHT)
                .map(|_| buffer("timestamps back", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST))
                .collect(),
            arrived,
            sender: Arc::new(Mutex::new(sender)),
            latest: Vec::new(),
        }
    }

    fn slot(&mut self, owner: Owner, pass: &str) -> Option<u32> {
        let i = self.names.len() as u32;
        self.names.push((owner, pass.to_string()));
        (i < MAX_TIMED).then_some(i)
    }

    fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.take_arrived();
        if self.names.is_empty() || self.names.len() as u32 > MAX_TIMED {
            self.latest.clear();
            return;
        }
        let Some(buffer) = self.spare.pop() else { return };
        let count = 2 * self.names.len() as u32;
        let bytes = u64::from(count) * 8;
        encoder.resolve_query_set(&self.queries, 0..count, &self.resolved, 0);
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &buffer, 0, bytes);
        let frame = Frame { buffer: buffer.clone(), names: std::mem::take(&mut self.names) };
        let sender = self.sender.clone();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, 0..bytes, move |result| {
            if let (Ok(()), Ok(sender)) = (result, sender.lock()) {
                // The receiver is gone only when the timer is, and then nobody waits.
                let _ = sender.send(frame);
            }
        });
    }

    fn take_arrived(&mut self) {
        while let Ok(Frame { buffer, names }) = self.arrived.try_recv() {
            if let Ok(bytes) = buffer.slice(0..names.len() as u64 * 16).get_mapped_range() {
                let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&bytes);
                self.latest = sum_by_name(names, &ticks, self.period_ns);
            }
            buffer.unmap();
            self.spare.push(buffer);
        }
    }

    fn collect(&mut self) -> Vec<PassTime> {
        self.take_arrived();
        self.latest.clone()
    }
}

/// Start and end of each pass, in ticks, to milliseconds by name.
fn sum_by_name(names: Vec<(Owner, String)>, ticks: &[u64], period_ns: f64) -> Vec<PassTime> {
    let mut times: Vec<PassTime> = Vec::new();
    for ((owner, pass), pair) in names.into_iter().zip(ticks.as_chunks::<2>().0) {
        let time_ms = pair[1].saturating_sub(pair[0]) as f64 * period_ns * 1e-6;
        match times.iter_mut().find(|t| t.owner == owner && t.pass == pass) {
            Some(t) => t.time_ms += time_ms,
            None => times.push(PassTime { owner, pass, time_ms }),
        }
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_of_one_name_add_up() {
        let name = |p: &str| (Owner::Light(0), p.to_string());
        let times = sum_by_name(vec![name("map"), name("map"), name("test")], &[0, 1000, 2000, 4000, 10, 5], 1000.0);
        assert_eq!(times.len(), 2);
        assert!((times[0].time_ms - 3.0).abs() < 1e-9);
        assert_eq!(times[1].time_ms, 0.0, "a clock that ran backwards is no time");
    }
}
