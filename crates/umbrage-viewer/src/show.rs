//! Draws what a technique holds into the picture of a pane.

use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, attachment, bind};
use umbrage::{Gpu, Shader};
use umbrage_core::Image;

/// The shader.
pub const SHADER: Shader = Shader::new("show", include_str!("show.wgsl"));

/// The format of panes, which is that of textures of the window.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// How a source becomes colours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    /// As grey, from the first value, black, to the second, white.
    Numbers([f32; 2]),
    /// As it is.
    Colors,
    /// Its difference from the truth, so many times as strong.
    Difference(f32),
}

/// The pipelines for all panes.
pub(crate) struct Show {
    gpu: Gpu,
    layout: wgpu::BindGroupLayout,
    numbers: wgpu::RenderPipeline,
    colors: wgpu::RenderPipeline,
    difference: wgpu::RenderPipeline,
    /// Takes the place of a truth that is not needed.
    nothing: wgpu::TextureView,
}

impl Show {
    pub fn new(gpu: &Gpu) -> Self {
        let unfiltered = fullscreen::texture(FLOATS);
        let layout = fullscreen::layout(gpu, "show", wgpu::ShaderStages::FRAGMENT, &[unfiltered, unfiltered, UNIFORM]);
        let module = SHADER.module(gpu);
        let pipeline = |entry| {
            let target = FORMAT.into();
            Fullscreen { label: "show", module: &module, entry, groups: &[&layout], target, constants: &[] }
                .pipeline(gpu)
        };
        let (numbers, colors, difference) = (pipeline("numbers"), pipeline("colors"), pipeline("difference"));
        let nothing = truth_texture(gpu, (1, 1)).create_view(&Default::default());
        Self { gpu: gpu.clone(), layout, numbers, colors, difference, nothing }
    }

    /// Draws `source` into `pane`, as large as it fits without being stretched.
    pub fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::TextureView,
        truth: Option<&wgpu::TextureView>,
        pane: &wgpu::TextureView,
        way: Way,
    ) {
        let (pipeline, [low, high], gain) = match way {
            Way::Numbers(range) => (&self.numbers, range, 0.0),
            Way::Colors => (&self.colors, [0.0, 1.0], 0.0),
            Way::Difference(gain) => (&self.difference, [0.0, 1.0], gain),
        };
        let size = |view: &wgpu::TextureView| [view.texture().width() as f32, view.texture().height() as f32];
        let (from, to) = (size(source), size(pane));
        let [begin, end] = fitted(from, to);
        let params = [from[0], from[1], begin[0], begin[1], end[0], end[1], low, high, gain, 0.0, 0.0, 0.0];
        let params = self.gpu.buffer("show", &params, wgpu::BufferUsages::UNIFORM);
        let resources = [
            wgpu::BindingResource::TextureView(source),
            wgpu::BindingResource::TextureView(truth.unwrap_or(&self.nothing)),
            params.as_entire_binding(),
        ];
        let group = bind(&self.gpu, "show", &self.layout, &resources);
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("show"),
            color_attachments: &[attachment(pane, wgpu::LoadOp::Clear(wgpu::Color::BLACK))],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Where a picture of size `from` lies in one of size `to`: its corners.
pub(crate) fn fitted(from: [f32; 2], to: [f32; 2]) -> [[f32; 2]; 2] {
    let scale = (to[0] / from[0]).min(to[1] / from[1]);
    let begin = [0, 1].map(|i| ((to[i] - from[i] * scale) * 0.5).floor());
    [begin, [0, 1].map(|i| begin[i] + from[i] * scale)]
}

/// For visibility, −1 where a pixel is not scored.
pub(crate) fn truth_texture(gpu: &Gpu, (width, height): (u32, u32)) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("truth"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Uploads a picture of four bytes a pixel.
pub(crate) fn upload<T: bytemuck::NoUninit>(gpu: &Gpu, texture: &wgpu::Texture, picture: &Image<T>) {
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * picture.width), rows_per_image: None };
    let size = wgpu::Extent3d { width: picture.width, height: picture.height, depth_or_array_layers: 1 };
    gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&picture.data), layout, size);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_keeps_its_shape_and_lies_in_the_middle() {
        assert_eq!(fitted([100.0, 100.0], [200.0, 100.0]), [[50.0, 0.0], [150.0, 100.0]]);
        assert_eq!(fitted([100.0, 50.0], [50.0, 50.0]), [[0.0, 12.0], [50.0, 37.0]]);
        assert_eq!(fitted([8.0, 6.0], [8.0, 6.0]), [[0.0, 0.0], [8.0, 6.0]]);
    }
}
