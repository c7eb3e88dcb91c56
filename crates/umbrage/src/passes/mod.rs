//! Recording: passes with names and GPU times, and uploads that happen in the order they are
//! recorded.
//!
//! `Queue::write_buffer` takes effect before everything in the encoder, so a technique that is
//! recorded twice in one encoder (brute force over many light samples) would see only its last
//! uniforms. Uploads here are copies within the encoder, from a staging belt that keeps its memory.

mod fragments;
mod kept;
#[cfg(not(target_family = "wasm"))]
mod known;
mod queries;
mod stamps;
mod timer;

use crate::{error::Error, gpu::Gpu};
use fragments::{Counted, Counter, touched};
pub use fragments::{Pass, PassFragments};
use kept::Frame;
pub use kept::Kept;
use stamps::Stamps;
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;
use timer::Timer;
use wgpu::util::StagingBelt;

/// Whose a pass is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Owner {
    /// A part of the host, by its name: `gbuffer`, `shading`.
    Host(&'static str),
    /// The technique of the light of this number.
    Light(usize),
}

/// Whose passes are until somebody is named.
const NOBODY: Owner = Owner::Host("");

/// What debuggers show of a pass.
fn labelled(owner: Owner, pass: &str) -> Cow<'_, str> {
    if owner == NOBODY { pass.into() } else { format!("{owner}: {pass}").into() }
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
    gpu: Gpu,
    belt: StagingBelt,
    stamps: Stamps,
    timer: Option<Timer>,
    counter: Option<Counter>,
}

impl Recorder {
    /// Times passes where the device has `TIMESTAMP_QUERY`.
    pub fn new(gpu: &Gpu) -> Self {
        let timer = gpu.has(wgpu::Features::TIMESTAMP_QUERY).then(|| Timer::new(gpu));
        Self::with(gpu, timer, None)
    }

    /// Counts the fragments of passes in place of timing them, since counting takes time.
    ///
    /// # Errors
    /// [`Error::NotCounted`] where the device only tells whether there were any fragments, as the
    /// standard allows; and as [`Gpu::wait`].
    #[cfg(not(target_family = "wasm"))]
    pub fn counting(gpu: &Gpu) -> Result<Self, Error> {
        let mut recorder = Self::with(gpu, None, Some(Counter::new(gpu)));
        let known = known::of_a_known_pass(gpu, &mut recorder)?;
        if known == known::KNOWN { Ok(recorder) } else { Err(Error::NotCounted) }
    }

    fn with(gpu: &Gpu, timer: Option<Timer>, counter: Option<Counter>) -> Self {
        // Memory for uploads, which grows where it is too small.
        let belt = StagingBelt::new(gpu.device.clone(), 1 << 18);
        Self { gpu: gpu.clone(), belt, stamps: Stamps::new(gpu), timer, counter }
    }

    /// Starts a frame on a host's encoder, which is to be submitted after those of earlier frames:
    /// what one frame leaves on the GPU, the next one may use. Callbacks of work that is done may
    /// be called.
    pub fn begin<'a>(&'a mut self, encoder: &'a mut wgpu::CommandEncoder) -> Passes<'a> {
        self.gpu.settle();
        if let Some(timer) = &mut self.timer {
            timer.queries.begin();
        }
        if let Some(counter) = &mut self.counter {
            counter.queries.begin();
        }
        let (timer, counter) = (self.timer.as_mut(), self.counter.as_mut());
        let frame = self.stamps.begin();
        let (gpu, belt, stamps) = (&self.gpu, &mut self.belt, &self.stamps);
        Passes { encoder, gpu, belt, stamps, frame, timer, counter, owner: NOBODY }
    }

    /// GPU times of the newest frame whose results have arrived; empty without timestamps. Never
    /// waits: poll the device first to be sure of the last frame.
    pub fn times(&mut self) -> Vec<PassTime> {
        let Some(timer) = &mut self.timer else { return Vec::new() };
        timer.collect();
        timer.latest.clone()
    }

    /// Fragments of the newest frame whose counts have arrived; empty for a recorder that does not
    /// count. Never waits: poll the device first to be sure of the last frame.
    pub fn fragments(&mut self) -> Vec<PassFragments> {
        let Some(counter) = &mut self.counter else { return Vec::new() };
        counter.collect();
        counter.latest.clone()
    }
}

/// One frame's recording. It ends with [`Passes::finish`], or when it is dropped; the encoder can't
/// be finished before.
#[must_use = "a frame ends at once where nobody keeps it"]
pub struct Passes<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    gpu: &'a Gpu,
    belt: &'a mut StagingBelt,
    stamps: &'a Stamps,
    frame: Arc<Frame>,
    timer: Option<&'a mut Timer>,
    counter: Option<&'a mut Counter>,
    owner: Owner,
}

impl Passes<'_> {
    /// The encoder, for copies and for whatever needs no timing.
    pub fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.encoder
    }

    /// Milliseconds on the GPU that all passes of the present owner took in the newest frame whose
    /// times have arrived.
    pub fn last_ms(&self) -> Option<f64> {
        let own = self.timer.as_ref()?.latest.iter().filter(|t| t.owner == self.owner);
        own.map(|t| t.time_ms).reduce(|sum, ms| sum + ms)
    }

    /// Names whom the following passes belong to in [`PassTime::owner`] and in their labels, such
    /// as `light 3: map`, which debuggers show around what each pass draws. (No debug groups of
    /// several passes besides: some versions of Mesa's software driver crash on these.)
    pub fn owner(&mut self, owner: Owner) {
        self.owner = owner;
    }

    /// Replaces the start of `buffer` by `data` for everything recorded after this.
    /// `data` is a multiple of four bytes long.
    pub fn upload(&mut self, buffer: &wgpu::Buffer, data: &[u8]) {
        self.upload_at(buffer, 0, data);
    }

    /// The same from byte `at` of the buffer on, a multiple of four.
    pub fn upload_at(&mut self, buffer: &wgpu::Buffer, at: u64, data: &[u8]) {
        let Some(size) = wgpu::BufferSize::new(data.len() as u64) else { return };
        let part = self.belt.allocate(size, wgpu::BufferSize::MIN);
        self.encoder.copy_buffer_to_buffer(part.buffer(), part.offset(), buffer, at, size.get());
        // Memory that is not there is that of a lost device, see `Gpu::check`.
        if let Ok(mut memory) = part.get_mapped_range_mut() {
            memory.copy_from_slice(data);
        }
    }

    /// That what was recorded is worth anything.
    pub(crate) fn check_loss(&self) -> Result<(), Error> {
        self.gpu.check_loss()
    }

    /// The frame, to be noted by whoever keeps what it changes.
    fn frame(&self) -> &Arc<Frame> {
        &self.frame
    }

    /// A render pass, timed under its label, and its fragments counted where the recorder does
    /// that.
    pub fn render(
        &mut self,
        label: &str,
        color: &[Option<wgpu::RenderPassColorAttachment<'_>>],
        depth_stencil: Option<wgpu::RenderPassDepthStencilAttachment<'_>>,
    ) -> Pass<'_> {
        let slot = self.timer.as_mut().and_then(|t| t.queries.slot((self.owner, label.into())));
        let timestamp_writes = slot.zip(self.timer.as_ref()).map(|(i, t)| wgpu::RenderPassTimestampWrites {
            query_set: &t.queries.set,
            beginning_of_pass_write_index: Some(i),
            end_of_pass_write_index: Some(i + 1),
        });
        let owner = self.owner;
        let counted =
            || Counted { owner, pass: label.into(), attachment_bytes: touched(color, depth_stencil.as_ref()) };
        let full_label = labelled(self.owner, label);
        let query = self.counter.as_mut().and_then(|c| c.queries.slot(counted()));
        let pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(&full_label),
            color_attachments: color,
            depth_stencil_attachment: depth_stencil,
            timestamp_writes,
            occlusion_query_set: self.counter.as_ref().map(|c| &c.queries.set),
            ..Default::default()
        });
        Pass::new(pass, query)
    }

    /// A compute pass, timed under its label.
    pub fn compute(&mut self, label: &str) -> wgpu::ComputePass<'_> {
        let slot = self.timer.as_mut().and_then(|t| t.queries.slot((self.owner, label.into())));
        let timestamp_writes = slot.zip(self.timer.as_ref()).map(|(i, t)| wgpu::ComputePassTimestampWrites {
            query_set: &t.queries.set,
            beginning_of_pass_write_index: Some(i),
            end_of_pass_write_index: Some(i + 1),
        });
        let full_label = labelled(self.owner, label);
        self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(&full_label), timestamp_writes })
    }

    /// Ends the frame: times are on their way, upload memory comes back when the GPU is done with
    /// it.
    pub fn finish(self) {}
}

impl Drop for Passes<'_> {
    fn drop(&mut self) {
        if let Some(timer) = &mut self.timer {
            timer.resolve(self.encoder);
        }
        if let Some(counter) = &mut self.counter {
            counter.resolve(self.encoder);
        }
        let stamp = self.stamps.stamp(&self.frame);
        self.upload(&stamp.buffer, &stamp.bytes());
        stamp.read_on_submit(self.encoder);
        self.belt.finish_and_recall_on_submit(self.encoder);
        self.gpu.unsettle();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debuggers_show_whose_a_pass_is() {
        assert_eq!(labelled(Owner::Light(2), "map"), "light 2: map");
        assert_eq!(labelled(Owner::Host("shading"), "add"), "shading: add");
        assert_eq!(labelled(NOBODY, "map"), "map");
    }
}
