//! A pass with a known number of fragments: it tells whether a device counts them.

use super::Recorder;
use crate::fullscreen::{Fullscreen, attachment, target_texture};
use crate::{Error, Gpu, Shader};

/// Fragments of the pass that tells whether a device counts.
pub(super) const KNOWN: u64 = 24 * 16;

/// How many fragments the device counts in a pass that draws a whole picture of [`KNOWN`] pixels.
pub(super) fn of_a_known_pass(gpu: &Gpu, recorder: &mut Recorder) -> Result<u64, Error> {
    const SHADER: Shader = Shader::new("white", include_str!("white.wgsl"));
    let format = wgpu::TextureFormat::R8Unorm;
    let target = target_texture(gpu, "known fragments", (24, 16), 1, format).create_view(&Default::default());
    let module = SHADER.module(gpu);
    let white = Fullscreen {
        label: "known fragments",
        module: &module,
        entry: "white",
        groups: &[],
        target: format.into(),
        constants: &[],
    };
    let pipeline = white.pipeline(gpu);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = recorder.begin(&mut encoder);
    let clear = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
    let mut pass = passes.render("known fragments", &[attachment(&target, clear)], None);
    pass.set_pipeline(&pipeline);
    pass.draw(0..3, 0..1);
    drop(pass);
    passes.finish();
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(recorder.fragments().iter().map(|pass| pass.fragments).sum())
}
