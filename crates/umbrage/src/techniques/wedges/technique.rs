//! A frame: choose casters, find silhouettes, build wedges, add up what they cover, resolve.

use super::light::Form;
use super::mask::Mask;
use super::pipelines::{Draw, Key, Pipelines, Resolve};
use super::select::Selection;
use super::tables::Tables;
use super::targets::{Buffers, GROUP, Target, lent_depth};
use super::views::{Drawn, Views};
use crate::casters::Edges;
use crate::depth_maps::Eye;
use crate::fullscreen::attachment;
use crate::params::Settings;
use crate::silhouettes::{Extrude, Part, Silhouettes, Style};
use crate::technique::{DebugView, Stats, Technique};
use crate::{error::Error, gpu::Gpu, passes::Passes, view::View, visibility::VisibilityTarget};
use umbrage_core::glam::DVec3;

pub(super) struct Wedges {
    point_radius: f64,
    silhouettes: Silhouettes,
    pipelines: Pipelines,
    selection: Selection,
    body_indices: wgpu::Buffer,
    buffers: Option<Buffers>,
    target: Option<Target>,
    form: Option<Form>,
    casting: u32,
    draws: u32,
    tables: Tables,
    /// In place of wedges.
    mask: Option<Mask>,
    masks_all: bool,
    samples: u32,
    gpu: Gpu,
    views: Option<Views>,
}

/// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65_535;

/// A few roundings of single precision.
const ROUNDING: f64 = 1e-6;

/// Of the six corners of a body the triangles of its far face, front, back and both ends, counter-clockwise from outside.
const FACES: [u16; 24] = [5, 4, 2, 5, 2, 3, 1, 0, 2, 1, 2, 4, 0, 1, 5, 0, 5, 3, 0, 3, 2, 1, 4, 5];

impl Wedges {
    pub fn new(gpu: &Gpu, settings: &Settings) -> Self {
        let silhouettes = Silhouettes::new(gpu, Extrude::Compute);
        let indices: Vec<u16> = (0..GROUP as u16).flat_map(|i| FACES.map(|corner| i * 6 + corner)).collect();
        Self {
            point_radius: settings.float("radius"),
            pipelines: Pipelines::new(gpu, silhouettes.layout()),
            silhouettes,
            selection: Selection::default(),
            body_indices: gpu.buffer("corners of wedges", &indices, wgpu::BufferUsages::INDEX),
            buffers: None,
            target: None,
            form: None,
            casting: 0,
            draws: 0,
            tables: Tables::new(gpu, settings.choice("coverage") == "table"),
            mask: None,
            masks_all: settings.choice("combine") == "bitmask",
            samples: settings.int("samples") as u32,
            gpu: gpu.clone(),
            views: None,
        }
    }

    fn key(&self, view: &View<'_>, form: &Form, draw: Draw) -> Key {
        let depth = lent_depth(view.receivers).map(|d| (d.texture().format(), is_reversed(view)));
        Key { draw, depth, has_normals: view.receivers.has_normals, face: form.face, term: self.tables.term(form.face) }
    }

    fn resolve_key(&self, view: &View<'_>, form: &Form) -> Resolve {
        Resolve {
            soft: !form.is_point(),
            has_normals: view.receivers.has_normals,
            face: form.face,
            term: self.tables.term(form.face),
        }
    }

    /// Makes room and pipelines.
    fn make_ready(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form) -> Result<(), Error> {
        let style = Style { weighted: true, quads: true };
        let projection = (&view.camera.clip_from_world(), is_reversed(view));
        self.silhouettes.prepare(gpu, view.casters, projection, form.center, &self.selection.throws, style)?;
        let (wedges, chunks) = (self.silhouettes.room(Part::PassSides), self.selection.eye_chunks.len() as u32);
        if self.buffers.as_ref().is_none_or(|b| !b.hold(wedges, chunks)) {
            self.buffers = Some(Buffers::new(gpu, &self.pipelines, wedges, chunks)?);
            self.target = None;
        }
        if let Some(buffers) = &self.buffers
            && self.target.as_ref().is_none_or(|t| t.size != view.receivers.size)
        {
            self.target = Some(Target::new(gpu, &self.pipelines, view.receivers.size, buffers));
        }
        self.pipelines.prepare_make(gpu, is_reversed(view));
        for draw in [Draw::Sides, Draw::Bodies] {
            self.pipelines.prepare(gpu, self.key(view, form, draw));
        }
        self.pipelines.prepare_resolve(gpu, self.resolve_key(view, form));
        Ok(())
    }

    fn build(&self, passes: &mut Passes<'_>, view: &View<'_>, edges: &Edges, form: &Form) {
        let Some(buffers) = &self.buffers else { return };
        passes.upload(
            &buffers.light,
            bytemuck::bytes_of(&form.uniform(view, ROUNDING, self.selection.eye_chunks.len() as u32)),
        );
        passes.upload(&buffers.eye, bytemuck::bytes_of(&Eye::new(view)));
        passes.upload(&buffers.eye_chunks, bytemuck::cast_slice(&self.selection.eye_chunks));
        passes.upload(&buffers.eye_count, &[0; 8]);
        passes.upload(&buffers.bodies, &[0; 20]);
        self.silhouettes.record(passes, edges);
        let Some(found) = self.silhouettes.found_by_gpu() else { return };
        let mut pass = passes.compute("build wedges");
        pass.set_bind_group(0, found, &[]);
        pass.set_bind_group(1, &edges.draw, &[]);
        if let Some(making) = self.pipelines.making(is_reversed(view)) {
            let groups = self.silhouettes.room(Part::PassSides).div_ceil(GROUP);
            pass.set_pipeline(making);
            pass.set_bind_group(2, &buffers.make, &[]);
            pass.dispatch_workgroups(groups.min(ROW), groups.div_ceil(ROW), 1);
        }
        let chunks = self.selection.eye_chunks.len() as u32;
        if chunks > 0 {
            pass.set_pipeline(&self.pipelines.count);
            pass.set_bind_group(2, &buffers.count, &[]);
            pass.dispatch_workgroups(chunks.min(ROW), chunks.div_ceil(ROW), 1);
        }
    }

    fn add_up(&self, passes: &mut Passes<'_>, view: &View<'_>, form: &Form) -> u32 {
        let (Some(buffers), Some(target)) = (&self.buffers, &self.target) else { return 0 };
        let depth = lent_depth(view.receivers).map(|view| wgpu::RenderPassDepthStencilAttachment {
            view,
            depth_ops: None,
            stencil_ops: None,
        });
        let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
        let mut pass = passes.render("wedges", &[attachment(&target.view, clear)], depth);
        pass.set_bind_group(0, &view.receivers.bind_group, &[]);
        pass.set_bind_group(1, &buffers.draw, &[]);
        pass.set_bind_group(2, self.tables.group(self.tables.term(form.face)), &[]);
        let mut draws = 0;
        if let (Some(pipeline), Some((arguments, offset))) =
            (self.pipelines.drawing(self.key(view, form, Draw::Sides)), self.silhouettes.arguments(Part::PassSides))
        {
            pass.set_pipeline(pipeline);
            pass.set_index_buffer(self.silhouettes.corner_indices().slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed_indirect(arguments, offset);
            draws += 1;
        }
        if let Some(pipeline) = self.pipelines.drawing(self.key(view, form, Draw::Bodies)).filter(|_| !form.is_point())
        {
            pass.set_pipeline(pipeline);
            pass.set_index_buffer(self.body_indices.slice(..), wgpu::IndexFormat::Uint16);
            pass.draw_indexed_indirect(&buffers.bodies, 0);
            draws += 1;
        }
        draws
    }

    /// The debug view that was asked for.
    fn record_view(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) {
        if let Some(mut views) = self.views.take() {
            views.record(passes, view, visibility, self.drawn(view).as_ref());
            self.views = Some(views);
        }
    }

    /// What debug views show: nothing where no wedges are drawn.
    fn drawn(&self, view: &View<'_>) -> Option<Drawn<'_>> {
        let is_drawn = !self.masks_all && !self.selection.throws.is_empty();
        let form = self.form.filter(|form| is_drawn && !form.is_point())?;
        Some(Drawn {
            buffers: self.buffers.as_ref()?,
            indices: &self.body_indices,
            key: self.key(view, &form, Draw::Bodies),
            tables: self.tables.group(self.tables.term(form.face)),
            layout: &self.pipelines.draw_layout,
        })
    }
}

impl Technique for Wedges {
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error> {
        if view.camera.clip_from_view.row(3).truncate() == DVec3::ZERO {
            let what = "parallel projections, since shadows are counted from the eye; choose `volume` or a map".into();
            return Err(Error::Unsupported { technique: super::INFO.id.into(), what });
        }
        // Masks have the picture in their samples.
        let has_picture = !self.masks_all && self.tables.prepare(gpu, view);
        let form = Form::of(&view.light.shape, has_picture, self.point_radius);
        self.casting = view.casters.casting().len() as u32;
        self.selection.choose(gpu, view, &form, ROUNDING)?;
        let is_lit = self.selection.throws.is_empty();
        if !is_lit && self.masks_all {
            let mask = self.mask.get_or_insert_with(|| Mask::new(gpu, self.samples));
            mask.prepare(gpu, view, &form, &self.selection, ROUNDING)?;
        } else if !is_lit {
            self.make_ready(gpu, view, &form)?;
        }
        self.form = Some(form);
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.draws = 0;
        let edges = view.casters.made_edges().filter(|_| !self.selection.throws.is_empty());
        let (Some(edges), Some(form)) = (edges, self.form) else {
            drop(passes.render("visibility", &[visibility.overwrite()], None));
            self.record_view(passes, view, visibility);
            return Ok(());
        };
        if let Some(mask) = self.mask.as_mut() {
            mask.record(passes, view, &form, ROUNDING, visibility);
            self.draws = 1;
            self.record_view(passes, view, visibility);
            return Ok(());
        }
        self.build(passes, view, edges, &form);
        self.draws = self.add_up(passes, view, &form);
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        if let (Some(pipeline), Some(target)) = (self.pipelines.resolving(self.resolve_key(view, &form)), &self.target)
        {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, &target.resolve, &[]);
            pass.set_bind_group(2, self.tables.group(self.tables.term(form.face)), &[]);
            pass.draw(0..3, 0..1);
            self.draws += 1;
        }
        drop(pass);
        self.record_view(passes, view, visibility);
        Ok(())
    }

    fn stats(&self) -> Stats {
        let thrown = self.selection.throws.len() as u32;
        let own = self.buffers.as_ref().map_or(0, Buffers::bytes) + self.target.as_ref().map_or(0, Target::bytes);
        Stats {
            draws: self.draws,
            triangles: u64::from(self.silhouettes.room(Part::PassSides)) * 10,
            casters_drawn: thrown,
            casters_culled: self.casting.saturating_sub(thrown),
            bytes: own
                + self.mask.as_ref().map_or(0, Mask::bytes)
                + self.tables.bytes()
                + self.silhouettes.bytes()
                + self.body_indices.size(),
        }
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.views = view.and_then(|name| Views::new(&self.gpu, name));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.views.iter().filter_map(Views::picture).collect()
    }
}

fn is_reversed(view: &View<'_>) -> bool {
    view.camera.background_depth() == 0.0
}
