//! How far a device's rasteriser shifts surfaces, since it snaps corners of triangles to parts of a
//! pixel.
//!
//! Vulkan asks for four binary digits of a pixel, most devices have eight. What a camera's depth
//! buffer shows of a surface is then that surface some part of a pixel aside. Seen at an angle, it
//! is off its own plane by more than depths are rounded, and would shadow itself. Where a device
//! finds depth from corners behind the eye, the shift of those is taken farther.

use crate::{Error, Gpu, Shader, read::later};
use umbrage_core::Image;
use umbrage_core::glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

/// Triangles of known depth.
const SHADER: Shader = Shader::new("known triangles", include_str!("snapping.wgsl"));

/// Pixels, for a device that can't be measured: four digits, with as much to spare as
/// [`measured`] leaves.
pub(crate) const GUARANTEED: f32 = 0.0625;

/// Other triangles may be shifted more than those that are tried.
const TO_SPARE: f64 = 1.25;

/// Pixels across and down, and of the cell that each triangle fills.
const SIZE: u32 = 64;
const CELL: u32 = 16;

/// How far ground reaches to all sides, in heights of the eye, and the depth of what is as far away
/// as its height.
pub(crate) const GROUND: f64 = 10.0;
const NEAR: f64 = 0.5;

/// Pixels by which surfaces are shifted at most, across and down together.
///
/// # Errors
/// Those of [`later`].
pub(crate) async fn measured(gpu: &Gpu) -> Result<f32, Error> {
    let triangles: Vec<Triangle> = (0..(SIZE / CELL).pow(2)).map(Triangle::number).collect();
    let depth = later::one_channel(gpu, &draw(gpu, &triangles), 0).await?;
    let shifts: Option<Vec<f64>> = triangles.iter().map(|t| t.shift_in(&depth)).collect();
    let missing = || Error::Driver("triangles of known depth were not drawn".into());
    let most = shifts.ok_or_else(missing)?.into_iter().fold(0.0, f64::max);
    Ok((TO_SPARE * most).min(1.0) as f32)
}

/// A triangle, of which one cell is drawn.
struct Triangle {
    /// Clip space.
    corners: [DVec4; 3],
    /// The first pixel of its cell.
    cell: (u32, u32),
}

impl Triangle {
    fn number(i: u32) -> Self {
        let cells = SIZE / CELL;
        let cell = (i % cells * CELL, i / cells * CELL);
        Self { corners: if i.is_multiple_of(2) { Self::in_cell(i, cell) } else { Self::ground(i) }, cell }
    }

    /// One that fits in its cell, with corners at any part of a pixel and a slope to any side.
    fn in_cell(i: u32, cell: (u32, u32)) -> [DVec4; 3] {
        let middle = DVec2::new(f64::from(cell.0), f64::from(cell.1)) + 0.5 * f64::from(CELL);
        let slope = DVec2::from_angle(2.4 * f64::from(i)) / f64::from(SIZE);
        [0, 1, 2].map(|k| {
            let part = (f64::from(3 * i + k) * DVec2::new(0.754_877_666, 0.569_840_291)).fract();
            let way = DVec2::from_angle(turn(i, k)) * 6.0 + part;
            ndc_of(middle + way).extend(0.5 + slope.dot(way)).extend(1.0)
        })
    }

    /// Level ground around an eye that looks down: it reaches as far behind the eye as ahead.
    fn ground(i: u32) -> [DVec4; 3] {
        let down = DMat3::from_rotation_x(-0.9);
        [0, 1, 2].map(|k| {
            let at = DVec2::from_angle(turn(i, k)) * GROUND;
            let eye = down.transpose() * DVec3::new(at.x, -1.0, at.y);
            DVec4::new(eye.x, eye.y, NEAR, -eye.z)
        })
    }

    /// Depth as a linear function of normalised device coordinates and 1.
    fn plane(&self) -> DVec3 {
        let [x, y, z, w] = DMat4::from_cols(self.corners[0], self.corners[1], self.corners[2], DVec4::W)
            .transpose()
            .to_cols_array_2d()
            .map(|row| DVec3::new(row[0], row[1], row[2]));
        DMat3::from_cols(x, y, w).inverse() * z
    }

    /// How far its depths in a picture are off, pixels across and down together; `None` where the
    /// picture shows nothing of it.
    fn shift_in(&self, picture: &Image<f32>) -> Option<f64> {
        let plane = self.plane();
        let pixels = (0..CELL * CELL).map(|p| (self.cell.0 + p % CELL, self.cell.1 + p / CELL));
        let off = pixels.filter_map(|(x, y)| {
            let shown = f64::from(picture[(x, y)]);
            let ndc = ndc_of(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
            (shown > 0.0).then(|| (shown - plane.dot(ndc.extend(1.0))).abs())
        });
        let per_pixel = plane.truncate().abs().element_sum() * 2.0 / f64::from(SIZE);
        off.reduce(f64::max).map(|most| most / per_pixel)
    }
}

/// The direction of a corner from the middle of its triangle.
fn turn(i: u32, corner: u32) -> f64 {
    f64::from(corner) * 2.1 + 0.4 * f64::from(i)
}

/// Of a place in pixels, row 0 at the top.
fn ndc_of(at: DVec2) -> DVec2 {
    (at * 2.0 / f64::from(SIZE) - 1.0) * DVec2::new(1.0, -1.0)
}

/// The triangles' depths.
fn draw(gpu: &Gpu, triangles: &[Triangle]) -> wgpu::Texture {
    let corners: Vec<[f32; 4]> = triangles.iter().flat_map(|t| t.corners.map(|c| c.as_vec4().to_array())).collect();
    let vertices = gpu.buffer("known triangles", &corners, wgpu::BufferUsages::VERTEX);
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("known triangles"),
        size: wgpu::Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let view = texture.create_view(&Default::default());
    let pipeline = pipeline(gpu);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("known triangles"),
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
            stencil_ops: None,
        }),
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_vertex_buffer(0, vertices.slice(..));
    for (first, triangle) in (0_u32..).step_by(3).zip(triangles) {
        pass.set_scissor_rect(triangle.cell.0, triangle.cell.1, CELL, CELL);
        pass.draw(first..first + 3, 0..1);
    }
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
    texture
}

fn pipeline(gpu: &Gpu) -> wgpu::RenderPipeline {
    let module = &SHADER.module(gpu);
    let attributes = &wgpu::vertex_attr_array![0 => Float32x4];
    let step_mode = wgpu::VertexStepMode::Vertex;
    let buffers = &[Some(wgpu::VertexBufferLayout { array_stride: 16, step_mode, attributes })];
    gpu.render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("known triangles"),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("corner"),
            compilation_options: Default::default(),
            buffers,
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: None,
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles' depths as a rasteriser makes them that snaps corners to `steps` a pixel.
    fn picture(triangles: &[Triangle], steps: f64) -> Image<f32> {
        let mut picture = Image::filled(SIZE, SIZE, 0.0);
        for triangle in triangles {
            let corners = triangle.corners.map(|c| {
                let half = 0.5 * f64::from(SIZE);
                let at = (c.truncate().truncate() / c.w * DVec2::new(half, -half) + half) * steps;
                let ndc = ndc_of(at.round() / steps);
                DVec4::new(ndc.x, ndc.y, c.z / c.w, 1.0)
            });
            let plane = Triangle { corners, ..*triangle }.plane();
            for p in 0..CELL * CELL {
                let (x, y) = (triangle.cell.0 + p % CELL, triangle.cell.1 + p / CELL);
                let ndc = ndc_of(DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
                picture[(x, y)] = plane.dot(ndc.extend(1.0)) as f32;
            }
        }
        picture
    }

    fn most(steps: f64) -> f64 {
        let triangles: Vec<Triangle> = (0..16).map(Triangle::number).collect();
        let picture = picture(&triangles, steps);
        triangles.iter().map(|t| t.shift_in(&picture).unwrap()).fold(0.0, f64::max)
    }

    #[test]
    fn what_is_measured_is_how_far_corners_are_snapped() {
        // Half a step in each direction at most; corners behind the eye take that farther.
        let (coarse, fine) = (most(16.0), most(256.0));
        assert!((1.0 / 32.0..=1.0 / 8.0).contains(&coarse), "{coarse} pixels for four binary digits");
        assert!((1.0 / 512.0..=1.0 / 128.0).contains(&fine), "{fine} pixels for eight binary digits");
        assert!(most(1e9) < 1e-5, "{} pixels for none", most(1e9));
    }

    #[test]
    fn what_was_not_drawn_is_not_taken_for_exact() {
        assert_eq!(Triangle::number(0).shift_in(&Image::filled(SIZE, SIZE, 0.0)), None);
    }
}
