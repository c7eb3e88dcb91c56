//! What has to be copied to the GPU, in order, until it surely is there.
//!
//! Changes go into the host's encoder, so frames that were recorded before keep what they saw. A
//! host may drop that encoder, or submit it in vain: then everything since is recorded again.

use crate::gpu::Gpu;
use crate::passes::{Kept, Passes};
use std::collections::VecDeque;

/// The copies that are not known to be executed.
#[derive(Default)]
pub(super) struct Journal {
    steps: VecDeque<Step>,
    /// How many of them are in an encoder.
    recorded: usize,
    /// The frames that they are in, and how many each has.
    frames: VecDeque<(usize, Kept)>,
    /// All of these frames.
    kept: Kept,
}

enum Step {
    /// Everything of a buffer to the start of one that takes its place.
    Copy {
        from: wgpu::Buffer,
        to: wgpu::Buffer,
    },
    Write {
        to: wgpu::Buffer,
        at: u64,
        bytes: Vec<u8>,
    },
}

impl Journal {
    /// Replaces part of a buffer.
    pub fn write<T: bytemuck::NoUninit>(&mut self, to: &wgpu::Buffer, at: u64, data: &[T]) {
        let data: &[u8] = bytemuck::cast_slice(data);
        if data.is_empty() {
            return;
        }
        // Meshes that are added one after the other mostly lie so.
        let waits = self.recorded < self.steps.len();
        if let Some(Step::Write { to: last, at: first, bytes }) = self.steps.back_mut().filter(|_| waits)
            && last == to
            && *first + bytes.len() as u64 == at
        {
            bytes.extend_from_slice(data);
            return;
        }
        self.steps.push_back(Step::Write { to: to.clone(), at, bytes: data.to_vec() });
    }

    /// Copies what a buffer holds into a larger one.
    pub fn copy(&mut self, from: &wgpu::Buffer, to: &wgpu::Buffer) {
        self.steps.push_back(Step::Copy { from: from.clone(), to: to.clone() });
    }

    /// True where all is in an encoder.
    pub fn is_recorded(&self) -> bool {
        self.recorded == self.steps.len()
    }

    /// Forgets what was executed; false once where something was not, or in another order: then it
    /// is recorded again, and what others recorded in these frames may have to be, too.
    pub fn holds(&mut self) -> bool {
        if !self.kept.holds() {
            self.frames.clear();
            self.recorded = 0;
            return false;
        }
        while let Some((steps, kept)) = self.frames.front_mut() {
            // Whether it was executed in order, all of them have told together.
            kept.holds();
            if !kept.is_settled() {
                break;
            }
            self.recorded -= *steps;
            self.steps.drain(..*steps);
            self.frames.pop_front();
        }
        true
    }

    /// Records what is not yet in an encoder. The frame is noted without that, too, where others
    /// record something that has to hold.
    pub fn record(&mut self, passes: &mut Passes<'_>, others: bool) {
        let new = self.steps.len() - self.recorded;
        if new == 0 && !others {
            return;
        }
        for step in self.steps.range(self.recorded..) {
            match step {
                Step::Copy { from, to } => passes.encoder().copy_buffer_to_buffer(from, 0, to, 0, from.size()),
                Step::Write { to, at, bytes } => passes.upload_at(to, *at, bytes),
            }
        }
        self.recorded = self.steps.len();
        let mut kept = Kept::default();
        kept.note(passes);
        self.kept.note(passes);
        self.frames.push_back((new, kept));
    }

    /// True where something waits to be written to a buffer.
    #[cfg(test)]
    pub fn writes_to(&self, buffer: &wgpu::Buffer) -> bool {
        self.steps.range(self.recorded..).any(|step| matches!(step, Step::Write { to, .. } if to == buffer))
    }

    /// Does all at once, for buffers that no frame has seen.
    pub fn finish(&mut self, gpu: &Gpu) {
        for step in self.steps.drain(..) {
            match step {
                Step::Write { to, at, bytes } => gpu.queue.write_buffer(&to, at, &bytes),
                Step::Copy { from, to } => {
                    let mut encoder = gpu.device.create_command_encoder(&Default::default());
                    encoder.copy_buffer_to_buffer(&from, 0, &to, 0, from.size());
                    gpu.queue.submit([encoder.finish()]);
                }
            }
        }
        self.recorded = 0;
    }
}
