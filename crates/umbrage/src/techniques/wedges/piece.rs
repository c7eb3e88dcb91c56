//! A piece of a light, most often all of it: its casters, silhouettes and wedges.

use super::cuts::{CUTS, CutBuffer};
use super::draws::{self, Draw};
use super::pipelines::{Key, Making, Pipelines};
use super::records::{CHUNK, GROUP, Needs, Round, WINDOW};
use super::select::Selection;
use super::tables::Term;
use super::targets::{Buffers, SIDES, Target};
use crate::area_light::{Form, Frame, ROUNDING};
use crate::casters::{Edges, Reads};
use crate::receivers::Eye;
use crate::silhouettes::{Extrude, Part, Silhouettes, Style};
use crate::{
    error::Error,
    gpu::Gpu,
    passes::{Pass, Passes},
    view::View,
};
use std::ops::Range;

/// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65_535;

/// Workgroups that put wedges into bundles at most: few edges are silhouettes, so most of one a
/// window of edges would find nothing to do.
const MOST_GROUPS: u32 = 32;

/// Indices of a body, and of a side.
pub(super) const BODY_INDICES: u32 = 24;
pub(super) const SIDE_INDICES: u32 = 6;

pub(super) struct Piece {
    pub form: Form,
    /// How shares of it are found.
    pub term: Term,
    pub selection: Selection,
    pub silhouettes: Silhouettes,
    pub buffers: Option<Buffers>,
    /// What all its casters need, and what is built in one round.
    needs: Needs,
    round: Needs,
    cuts: CutBuffer,
}

/// What recording takes.
pub(super) struct Recording<'a> {
    pub pipelines: &'a Pipelines,
    pub target: &'a Target,
    pub body_indices: &'a wgpu::Buffer,
    /// Tables that shares are looked up in.
    pub tables: &'a wgpu::BindGroup,
    pub round: Round,
}

impl Piece {
    pub fn new(gpu: &Gpu, form: Form, extrude: Extrude) -> Self {
        let silhouettes = Silhouettes::new(gpu, extrude);
        Self {
            form,
            term: Term::Analytic,
            selection: Selection::default(),
            silhouettes,
            buffers: None,
            needs: Needs::default(),
            round: Needs::default(),
            cuts: CutBuffer::default(),
        }
    }

    /// Silhouettes of the chosen casters, and room for their wedges: for all at once or for a
    /// round, with bundles or without.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View<'_>,
        pipelines: &mut Pipelines,
        [at_once, bundles]: [bool; 2],
    ) -> Result<(), Error> {
        let style = Style { weighted: true, quads: true };
        let projection = (&view.camera.clip_from_world(), is_reversed(view));
        let throws = &self.selection.throws;
        self.silhouettes.prepare(gpu, view.casters, projection, self.form.center, throws, style)?;
        let needs = Needs { wedges: self.silhouettes.room(Part::PassSides), caps: self.selection.caps.len() as u32 };
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        (self.needs, self.round) = (needs, if at_once { needs } else { needs.round(limit) });
        if self.buffers.as_ref().is_none_or(|b| !b.hold(&self.round)) {
            self.buffers = Some(Buffers::new(gpu, pipelines, &self.round)?);
        }
        self.cuts.prepare(gpu, self.selection.cuts.len());
        pipelines.prepare_making(gpu, Making::Wedges { reversed: is_reversed(view) });
        pipelines.prepare_making(gpu, Making::Caps);
        if bundles {
            pipelines.prepare_making(gpu, Making::Bundles);
        }
        Ok(())
    }

    /// What resolving reads: its share of the light, and the shadows that the eye is in.
    pub fn record(&self, [facing, away]: [u32; 2]) -> [f32; 4] {
        [self.form.weight as f32, facing as f32, away as f32, 0.0]
    }

    /// The shadows that the eye is in of all casters that are counted from there.
    pub fn shadows_of_eye(&self) -> [u32; 2] {
        let counts = self.selection.eye_counts.iter().flatten();
        counts.fold([0; 2], |sum, count| [sum[0] + count[0], sum[1] + count[1]])
    }

    pub fn is_split(&self) -> bool {
        self.form.cell.is_some()
    }

    /// Rounds of a frame. The first one is recorded last, so that it is what debug views show.
    pub fn rounds(&self) -> impl Iterator<Item = Round> + use<> {
        let count = self.needs.rounds(&self.round).max(1);
        (0..count).rev().map(move |number| Round { number, is_first: number + 1 == count })
    }

    /// Chunks of caps of a round.
    fn caps_of(&self, round: Round) -> &[[u32; 2]] {
        let caps = &self.selection.caps;
        let start = (round.number as usize * self.round.caps as usize).min(caps.len());
        &caps[start..(start + self.round.caps as usize).min(caps.len())]
    }

    /// Finds silhouettes, once for all rounds, and builds wedges.
    pub fn build(&self, passes: &mut Passes<'_>, view: &View<'_>, edges: &Edges, bundles: bool, r: &Recording<'_>) {
        let Some(buffers) = &self.buffers else { return };
        self.upload(passes, view, buffers, r);
        if r.round.is_first {
            self.cuts.upload(passes, &self.selection.cuts);
            self.silhouettes.record(passes, edges);
        }
        let Some(found) = self.silhouettes.found_by_gpu() else { return };
        let room = self.round.wedges;
        let mut pass = passes.compute("build wedges");
        pass.set_bind_group(0, found, &[]);
        if let Some(making) = r.pipelines.making(Making::Wedges { reversed: is_reversed(view) }) {
            pass.set_pipeline(making);
            pass.set_bind_group(1, edges.group(Reads::Edges), &[]);
            pass.set_bind_group(2, &buffers.make, &[]);
            dispatch(&mut pass, room.div_ceil(GROUP));
        }
        let chunks = self.caps_of(r.round).len() as u32;
        if let Some(caps) = r.pipelines.making(Making::Caps).filter(|_| chunks > 0) {
            pass.set_pipeline(caps);
            pass.set_bind_group(0, self.silhouettes.casters_on_gpu(), &[]);
            pass.set_bind_group(1, edges.group(Reads::Triangles), &[]);
            pass.set_bind_group(2, &buffers.make_caps, &[]);
            dispatch(&mut pass, chunks);
        }
        let is_bundled = bundles && !self.form.is_point();
        if let Some(bundling) = r.pipelines.making(Making::Bundles).filter(|_| is_bundled) {
            pass.set_pipeline(bundling);
            pass.set_bind_group(0, &buffers.bundle, &[]);
            pass.dispatch_workgroups(room.div_ceil(WINDOW * GROUP).min(MOST_GROUPS), 1, 1);
        }
    }

    fn upload(&self, passes: &mut Passes<'_>, view: &View<'_>, buffers: &Buffers, r: &Recording<'_>) {
        let (caps, most) = (self.caps_of(r.round), self.round.wedges);
        let frame = Frame {
            rounding: ROUNDING,
            cap_chunks: caps.len() as u32,
            scale: r.target.key.scale,
            wedges: [r.round.number.saturating_mul(most), most],
        };
        passes.upload(&buffers.light, bytemuck::bytes_of(&self.form.uniform(view, &frame)));
        passes.upload(&buffers.eye, bytemuck::bytes_of(&Eye::new(view)));
        passes.upload(&buffers.cap_chunks, bytemuck::cast_slice(caps));
        let no_bodies = [GROUP * BODY_INDICES, 0, 0, 0, 0];
        let no_sides = [GROUP * SIDE_INDICES, 0, 0, 0, 0];
        passes.upload(&buffers.bodies, bytemuck::cast_slice(&[no_bodies, no_bodies, no_bodies, no_sides]));
        passes.upload(&buffers.singles, &[0; 8]);
    }

    /// A pass of its draws.
    pub fn begin<'p>(
        &self,
        passes: &'p mut Passes<'_>,
        view: &'p View<'_>,
        color: Option<wgpu::RenderPassColorAttachment<'p>>,
        stencil_ops: Option<wgpu::Operations<u32>>,
        r: &Recording<'p>,
    ) -> Pass<'p> {
        let depth = r.target.depth(view);
        let depth = depth.map(|view| wgpu::RenderPassDepthStencilAttachment { view, depth_ops: None, stencil_ops });
        let mut pass = passes.render("wedges", &[color], depth);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        if let Some(buffers) = &self.buffers {
            pass.set_bind_group(1, &buffers.draw, &[]);
        }
        pass.set_bind_group(2, r.tables, &[]);
        pass
    }

    pub fn key(&self, view: &View<'_>, draw: &'static Draw, target: &Target) -> Key {
        let depth = target.depth(view).map(|d| (d.texture().format(), is_reversed(view)));
        let mirrored = view.camera.is_mirrored();
        Key { draw, depth, face: self.form.face, term: self.term, split: self.is_split(), mirrored }
    }

    /// The hard shadow, as the GPU counted its sides.
    pub fn all_hard(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, r: &Recording<'_>) -> u32 {
        let pipeline = r.pipelines.drawing(self.key(view, &draws::SIDES, r.target));
        let mut drawn = 0;
        if let Some((pipeline, buffers)) = pipeline.zip(self.buffers.as_ref()) {
            pass.set_pipeline(pipeline);
            pass.set_index_buffer(self.silhouettes.corner_indices().slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed_indirect(&buffers.bodies, SIDES);
            drawn += 1;
        }
        drawn + self.caps(pass, view, 0..self.caps_of(r.round).len() as u32, r)
    }

    /// Bodies, as the GPU counted them, by draws with where their arguments are.
    pub fn all_bodies(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        view: &View<'_>,
        bodies: &[(&'static Draw, u64)],
        r: &Recording<'_>,
    ) -> u32 {
        let Some(buffers) = &self.buffers else { return 0 };
        let mut drawn = 0;
        pass.set_index_buffer(r.body_indices.slice(..), wgpu::IndexFormat::Uint16);
        for (draw, arguments) in bodies {
            if let Some(pipeline) = r.pipelines.drawing(self.key(view, draw, r.target)) {
                pass.set_pipeline(pipeline);
                pass.draw_indexed_indirect(&buffers.bodies, *arguments);
                drawn += 1;
            }
        }
        drawn
    }

    /// Light caps and dark caps of what is counted from infinity.
    pub fn caps(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, chunks: Range<u32>, r: &Recording<'_>) -> u32 {
        let pipeline = r.pipelines.drawing(self.key(view, &draws::CAPS, r.target));
        let Some(pipeline) = pipeline.filter(|_| !chunks.is_empty()) else { return 0 };
        pass.set_pipeline(pipeline);
        pass.draw(chunks.start * 3 * CHUNK..chunks.end * 3 * CHUNK, 0..2);
        1
    }

    /// What wedges lack of casters that the light touches.
    pub fn cut_casters(&self, pass: &mut wgpu::RenderPass<'_>, view: &View<'_>, r: &Recording<'_>) -> u32 {
        let pipeline = r.pipelines.drawing(self.key(view, &CUTS, r.target));
        let Some((pipeline, group)) = pipeline.zip(self.cuts.group()).filter(|_| !self.selection.cuts.is_empty())
        else {
            return 0;
        };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(3, group, &[]);
        pass.draw(0..3, 0..1);
        1
    }

    pub fn bytes(&self) -> u64 {
        self.cuts.bytes() + self.silhouettes.bytes() + self.buffers.as_ref().map_or(0, Buffers::bytes)
    }
}

pub(super) fn is_reversed(view: &View<'_>) -> bool {
    view.camera.background_depth() == 0.0
}

/// Makes the pipelines of some draws in these targets.
pub(super) fn prepare_draws(
    gpu: &Gpu,
    view: &View<'_>,
    pieces: &[Piece],
    targets: &[Target],
    draws: &[&'static Draw],
    pipelines: &mut Pipelines,
) {
    let Some(piece) = pieces.first() else { return };
    for target in targets {
        draws.iter().for_each(|draw| pipelines.prepare(gpu, piece.key(view, draw, target)));
    }
}

/// Workgroups in rows.
pub(super) fn dispatch(pass: &mut wgpu::ComputePass<'_>, groups: u32) {
    pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
}
