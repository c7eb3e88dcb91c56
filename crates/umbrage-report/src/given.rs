//! Visibility that is already known, as a technique: with it the renderer shades the reference.

use umbrage::{Error, Gpu, InOrder, Inside, Passes, Shader, Stats, Technique, View, VisibilityTarget};
use umbrage_core::Image;

/// Copies the picture.
const SHADER: Shader = Shader::new("given visibility", include_str!("given.wgsl"));

/// Writes one picture, whatever the view.
pub struct Given {
    pipeline: wgpu::RenderPipeline,
    picture: wgpu::BindGroup,
    bytes: u64,
}

impl Given {
    /// Uploads the picture, which has the size of the frames to come.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits.
    pub fn new(gpu: &Gpu, visibility: &Image<f32>) -> Result<Self, Error> {
        gpu.check_size("a picture of visibility", visibility.width, visibility.height)?;
        let module = SHADER.module(gpu);
        let pipeline = gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("given visibility"),
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("fullscreen"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: None,
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("copy"),
                compilation_options: Default::default(),
                targets: &[Some(VisibilityTarget::FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let picture = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("given visibility"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&upload(gpu, visibility)),
            }],
        });
        Ok(Self { pipeline, picture, bytes: 4 * visibility.data.len() as u64 })
    }
}

fn upload(gpu: &Gpu, picture: &Image<f32>) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width: picture.width, height: picture.height, depth_or_array_layers: 1 };
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("given visibility"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let bytes: Vec<u8> = picture.data.iter().flat_map(|v| v.to_le_bytes()).collect();
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * picture.width), rows_per_image: None };
    gpu.queue.write_texture(texture.as_image_copy(), &bytes, layout, size);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

impl Technique for Given {
    fn prepare_view(&mut self, _: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        _: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        let mut pass = passes.render("given visibility", &[visibility.overwrite()], None);
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.picture, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Given {
    fn stats(&self) -> Stats {
        Stats { draws: 1, triangles: 1, bytes: self.bytes, ..Stats::default() }
    }
}
