//! `batch = per-wedge`: one wedge after the other, in two halves, each with a mask if there is one
//! (PX 4.1–4.3).

use super::super::draws::{self, Draw};
use super::super::piece::{BODY_INDICES, Piece, Recording, dispatch, prepare_draws};
use super::super::pipelines::{Pipelines, compute};
use super::super::records::{GROUP, RECORD};
use super::super::targets::Target;
use super::super::way::Way;
use super::draws::{BACK, FRONT, FRONT_MASK, HALF_RECORD, HALVES, MASKED_BACK, MASKED_FRONT, halves_layout};
use super::listed::{self, BODY_CORNERS};
use super::masked::{CLEARED, stencil_format};
use crate::fullscreen::{STORAGE, STORAGE_WRITE, UNIFORM, attachment, bind, layout};
use crate::silhouettes::Extrude;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// See the module.
pub(super) struct PerWedge {
    /// Depth with a stencil, where masks are drawn.
    format: Option<wgpu::TextureFormat>,
    make_layout: wgpu::BindGroupLayout,
    draw_layout: wgpu::BindGroupLayout,
    cut: wgpu::ComputePipeline,
    /// Of each piece.
    halves: Vec<Halves>,
}

/// Where the wedges of a piece are cut.
struct Halves {
    /// The wedges.
    of: wgpu::Buffer,
    halves: wgpu::Buffer,
    make: wgpu::BindGroup,
    draw: wgpu::BindGroup,
}

impl Halves {
    fn new(gpu: &Gpu, wedges: &wgpu::Buffer, light: &wgpu::Buffer, way: &PerWedge) -> Self {
        let halves = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("halves of wedges"),
            size: wedges.size() / RECORD * HALF_RECORD,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let all = [light, wedges, &halves].map(|buffer| buffer.as_entire_binding());
        Self {
            make: bind(gpu, "halves of wedges", &way.make_layout, &all),
            draw: bind(gpu, "halves of wedges", &way.draw_layout, &[halves.as_entire_binding()]),
            of: wedges.clone(),
            halves,
        }
    }
}

impl PerWedge {
    pub fn new(gpu: &Gpu, stencil: bool) -> Self {
        let bindings = [UNIFORM, STORAGE, STORAGE_WRITE];
        let make_layout = layout(gpu, "halves of wedges", wgpu::ShaderStages::COMPUTE, &bindings);
        Self {
            format: stencil.then(|| stencil_format(gpu)),
            cut: compute(gpu, &HALVES, &[&make_layout], &[]),
            make_layout,
            draw_layout: halves_layout(gpu),
            halves: Vec::new(),
        }
    }

    /// Of each half its mask, if there is one, and what it adds.
    fn draws(&self) -> [(Option<&'static Draw>, &'static Draw); 2] {
        match self.format {
            Some(_) => [(Some(&FRONT_MASK), &MASKED_FRONT), (Some(&FRONT_MASK), &MASKED_BACK)],
            None => [(None, &FRONT), (None, &BACK)],
        }
    }

    fn cut(&self, passes: &mut Passes<'_>, halves: &Halves, wedges: u32) {
        let mut pass = passes.compute("build wedges");
        pass.set_pipeline(&self.cut);
        pass.set_bind_group(0, &halves.make, &[]);
        dispatch(&mut pass, wedges.div_ceil(GROUP));
    }

    fn wedge_by_wedge(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        view: &View<'_>,
        piece: &Piece,
        halves: &Halves,
        r: &Recording<'_>,
    ) -> u32 {
        let find = |draw| r.pipelines.drawing(piece.key(view, draw, r.target));
        let draws = self.draws().map(|(mask, draw)| (mask.and_then(find), find(draw)));
        pass.set_index_buffer(r.body_indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.set_bind_group(3, &halves.draw, &[]);
        let mut drawn = 0;
        for wedge in listed::all(piece) {
            for (half, (mask, draw)) in (0..).zip(draws) {
                for pipeline in [mask, draw].into_iter().flatten() {
                    pass.set_pipeline(pipeline);
                    pass.draw_indexed(0..BODY_INDICES, (wedge * BODY_CORNERS) as i32, half..half + 1);
                    drawn += 1;
                }
            }
        }
        drawn
    }
}

impl Way for PerWedge {
    fn extrude(&self) -> Extrude {
        Extrude::Cpu
    }

    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        self.format
    }

    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pieces: &[Piece],
        targets: &[Target],
        pipelines: &mut Pipelines,
    ) -> Result<(), Error> {
        let mut used = vec![&draws::SIDES, &draws::CAPS];
        self.draws().into_iter().for_each(|(mask, draw)| used.extend(mask.into_iter().chain([draw])));
        prepare_draws(gpu, view, pieces, targets, &used, pipelines);
        self.halves.truncate(pieces.len());
        for (i, buffers) in pieces.iter().enumerate().filter_map(|(i, piece)| Some((i, piece.buffers.as_ref()?))) {
            if self.halves.get(i).is_none_or(|h| h.of != buffers.wedges) {
                self.halves.truncate(i);
                self.halves.push(Halves::new(gpu, &buffers.wedges, &buffers.light, self));
            }
        }
        Ok(())
    }

    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, number: usize, piece: &Piece, r: &Recording<'_>) -> u32 {
        let (Some(layer), Some(halves)) = (r.target.layers.get(number), self.halves.get(number)) else { return 0 };
        let wedges = listed::all(piece);
        self.cut(passes, halves, wedges.end);
        let color = attachment(layer, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = piece.begin(passes, view, color, self.format.map(|_| CLEARED), r);
        let mut drawn = listed::range(&mut pass, view, piece, &draws::SIDES, wedges, r);
        drawn += piece.caps(&mut pass, view, 0..piece.selection.caps.len() as u32, r);
        if !piece.form.is_point() {
            drawn += self.wedge_by_wedge(&mut pass, view, piece, halves, r);
        }
        drawn
    }

    fn bytes(&self) -> u64 {
        self.halves.iter().map(|h| h.halves.size()).sum()
    }
}
