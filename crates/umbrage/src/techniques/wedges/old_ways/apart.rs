//! What is drawn into a buffer of its own and then added: convex loops one by one (`batch =
//! per-loop`, PX 4.4), or casters, of which the largest share counts (`combine = max`).

use super::super::draws::{self, Draw, shares_format};
use super::super::piece::{Piece, Recording, prepare_draws};
use super::super::pipelines::Pipelines;
use super::super::stages::Stages;
use super::super::targets::{Target, TargetKey};
use super::super::way::Way;
use super::draws::{APART, LOOP_BODIES, LOOP_SIDES, loop_format};
use super::groups::{Group, find_groups};
use super::listed;
use crate::fullscreen::{FLOATS, STORAGE, additive, attachment, bind, layout, target_texture, texture};
use crate::silhouettes::Extrude;
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View};

/// What is drawn apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Loops,
    Largest,
}

/// See the module.
pub(super) struct Apart {
    kind: Kind,
    /// Of the sums of a loop or a caster.
    format: wgpu::TextureFormat,
    layout: wgpu::BindGroupLayout,
    transfer: wgpu::RenderPipeline,
    pieces: Vec<OfPiece>,
    sums: Vec<Sums>,
}

/// What is drawn apart of a piece.
struct OfPiece {
    groups: Vec<Group>,
    /// The shadows that the eye is in: of casters that are drawn apart a slot each, of all others
    /// the first.
    eye_counts: Vec<[u32; 2]>,
    buffer: wgpu::Buffer,
}

/// Where the sums of a loop or a caster add up.
struct Sums {
    of: TargetKey,
    view: wgpu::TextureView,
    /// Of each piece what reads them, with the piece's counts of the eye.
    groups: Vec<(wgpu::Buffer, wgpu::BindGroup)>,
}

impl OfPiece {
    fn new(gpu: &Gpu, slots: usize) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let buffer = gpu.buffer("shadows of the eye", &vec![[0_u32; 2]; slots.next_power_of_two()], usage);
        Self { groups: Vec::new(), eye_counts: Vec::new(), buffer }
    }

    fn count_eye(&mut self, piece: &Piece) {
        self.eye_counts.clear();
        self.eye_counts.resize(1 + self.groups.len(), [0; 2]);
        for (throw, count) in piece.selection.eye_counts.iter().enumerate() {
            let slot = self.groups.get(throw).map_or(0, |group| group.slot);
            let [facing, away] = count.unwrap_or_default();
            let sum = &mut self.eye_counts[slot as usize];
            *sum = [sum[0] + facing, sum[1] + away];
        }
    }
}

impl Sums {
    fn new(gpu: &Gpu, target: &Target, format: wgpu::TextureFormat) -> Self {
        let texture = target_texture(gpu, "shares of a loop", target.size(), 1, format);
        Self { of: target.key, view: texture.create_view(&Default::default()), groups: Vec::new() }
    }

    fn prepare(&mut self, gpu: &Gpu, pieces: &[OfPiece], layout: &wgpu::BindGroupLayout) {
        self.groups.truncate(pieces.len());
        for (i, piece) in pieces.iter().enumerate() {
            if self.groups.get(i).is_none_or(|(counts, _)| *counts != piece.buffer) {
                self.groups.truncate(i);
                let sums = wgpu::BindingResource::TextureView(&self.view);
                let group = bind(gpu, "a loop's shares", layout, &[sums, piece.buffer.as_entire_binding()]);
                self.groups.push((piece.buffer.clone(), group));
            }
        }
    }
}

impl Apart {
    pub fn new(gpu: &Gpu, kind: Kind) -> Self {
        let layout = layout(gpu, "a loop's shares", wgpu::ShaderStages::FRAGMENT, &[texture(FLOATS), STORAGE]);
        let (entry, format, target) = match kind {
            Kind::Loops => ("add_loop", loop_format(gpu), additive(shares_format(gpu))),
            Kind::Largest => ("most_of_casters", shares_format(gpu), most(shares_format(gpu))),
        };
        let module = APART.module(gpu);
        let transfer = Stages::new(&module, "screen", entry).pipeline(gpu, &[&layout], None, Some(target));
        Self { kind, format, layout, transfer, pieces: Vec::new(), sums: Vec::new() }
    }

    fn prepare_pieces(&mut self, gpu: &Gpu, view: &View<'_>, pieces: &[Piece]) {
        self.pieces.truncate(pieces.len());
        for (i, piece) in pieces.iter().enumerate() {
            let slots = 1 + piece.selection.throws.len();
            if self.pieces.get(i).is_none_or(|own| own.buffer.size() < 8 * slots as u64) {
                self.pieces.truncate(i);
                self.pieces.push(OfPiece::new(gpu, slots));
            }
            let own = &mut self.pieces[i];
            find_groups(
                view.casters,
                &piece.silhouettes,
                &piece.selection,
                self.kind == Kind::Largest,
                &mut own.groups,
            );
            own.count_eye(piece);
        }
    }

    /// Adds the counts of a loop or a caster.
    fn transfer(
        &self,
        passes: &mut Passes<'_>,
        into: Option<wgpu::RenderPassColorAttachment<'_>>,
        sums: &wgpu::BindGroup,
        slot: u32,
    ) -> u32 {
        let mut pass = passes.render("add loop", &[into], None);
        pass.set_pipeline(&self.transfer);
        pass.set_bind_group(0, sums, &[]);
        pass.draw(0..3, slot..slot + 1);
        1
    }
}

impl Way for Apart {
    fn extrude(&self) -> Extrude {
        Extrude::Cpu
    }

    fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pieces: &[Piece],
        targets: &[Target],
        pipelines: &mut Pipelines,
    ) -> Result<(), Error> {
        let all: &[&'static Draw] = &[&draws::SIDES, &draws::CAPS, &draws::BODIES, &LOOP_SIDES, &LOOP_BODIES];
        let used = if self.kind == Kind::Largest { &all[..3] } else { all };
        prepare_draws(gpu, view, pieces, targets, used, pipelines);
        self.prepare_pieces(gpu, view, pieces);
        self.sums.truncate(targets.len());
        for (i, target) in targets.iter().enumerate() {
            if self.sums.get(i).is_none_or(|sums| sums.of != target.key) {
                self.sums.truncate(i);
                self.sums.push(Sums::new(gpu, target, self.format));
            }
            self.sums[i].prepare(gpu, &self.pieces, &self.layout);
        }
        Ok(())
    }

    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, number: usize, piece: &Piece, r: &Recording<'_>) -> u32 {
        let sums = self.sums.iter().find(|sums| sums.of == r.target.key);
        let (Some(layer), Some(sums), Some(own)) = (r.target.layers.get(number), sums, self.pieces.get(number)) else {
            return 0;
        };
        let Some((_, reads_sums)) = sums.groups.get(number) else { return 0 };
        passes.upload(&own.buffer, bytemuck::cast_slice(&own.eye_counts));
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let (mut load, mut drawn) = (clear, 0);
        for group in &own.groups {
            let is_apart = group.slot > 0;
            let (into, first) = if is_apart { (&sums.view, clear) } else { (layer, load) };
            drawn += draw_group(passes, view, piece, attachment(into, first), group, r);
            if is_apart {
                drawn += self.transfer(passes, attachment(layer, load), reads_sums, group.slot);
            }
            load = wgpu::LoadOp::Load;
        }
        drawn
    }

    fn shadows_of_eye(&self, number: usize, _piece: &Piece) -> [u32; 2] {
        self.pieces.get(number).and_then(|own| own.eye_counts.first()).copied().unwrap_or_default()
    }

    fn bytes(&self) -> u64 {
        let texel = u64::from(self.format.block_copy_size(None).unwrap_or(0));
        let sums = self.sums.iter().map(|sums| sums.view.texture().size());
        let sums: u64 = sums.map(|size| u64::from(size.width) * u64::from(size.height) * texel).sum();
        sums + self.pieces.iter().map(|own| own.buffer.size()).sum::<u64>()
    }
}

fn draw_group<'p>(
    passes: &'p mut Passes<'_>,
    view: &'p View<'_>,
    piece: &Piece,
    into: Option<wgpu::RenderPassColorAttachment<'p>>,
    group: &Group,
    r: &Recording<'p>,
) -> u32 {
    let mut pass = piece.begin(passes, view, into, None, r);
    let [sides, bodies] = group.draws;
    let mut drawn = listed::range(&mut pass, view, piece, sides, group.wedges.clone(), r);
    drawn += piece.caps(&mut pass, view, group.caps.clone(), r);
    if !piece.form.is_point() {
        drawn += listed::range(&mut pass, view, piece, bodies, group.wedges.clone(), r);
    }
    drawn
}

fn most(format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
    let max = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Max,
    };
    wgpu::ColorTargetState { blend: Some(wgpu::BlendState { color: max, alpha: max }), ..format.into() }
}
