//! For tests that look at what is on the GPU.

use crate::Gpu;

/// The numbers in a buffer.
pub(super) fn read(gpu: &Gpu, buffer: &wgpu::Buffer) -> Vec<f32> {
    let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
    let back = gpu.buffer("back", &vec![0u8; buffer.size() as usize], usage);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &back, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    back.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    gpu.wait().unwrap();
    bytemuck::pod_collect_to_vec(&back.get_mapped_range(..).unwrap())
}
