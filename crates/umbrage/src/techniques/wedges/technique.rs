//! A frame: choose casters, find silhouettes, build wedges, add up what they cover, resolve.

use super::budget::Budget;
use super::draws;
use super::old_ways;
use super::one_draw::OneDraw;
use super::options::{self, Options};
use super::piece::{Piece, Recording, is_reversed};
use super::pipelines::{Key, Pipelines, Resolve};
use super::records::GROUP;
use super::tables::{Tables, Term};
use super::targets::{MOST_PIECES, Target, TargetKey, Whole, lent_depth};
use super::views::{Drawn, Views};
use super::way::Way;
use crate::area_light::{Face, Form, Frame, ROUNDING, is_on_a_caster};
use crate::casters::Edges;
use crate::receivers::Eye;
use crate::silhouettes::Part;
use crate::technique::{DebugView, InOrder, Inside, Stats, Technique};
use crate::{error::Error, gpu::Gpu, inline::Lent, passes::Passes, view::View, visibility::VisibilityTarget};

pub(super) struct Wedges {
    options: Options,
    way: Box<dyn Way>,
    pipelines: Option<Pipelines>,
    body_indices: wgpu::Buffer,
    whole: Whole,
    form: Option<Form>,
    pieces: Vec<Piece>,
    /// One for each scale that may come up.
    targets: Vec<Target>,
    budget: Budget,
    tables: Tables,
    casting: u32,
    draws: u32,
    gpu: Gpu,
    views: Option<Views>,
}

/// Of the six corners of a body the triangles of its far face, front, back and both ends,
/// counter-clockwise from outside.
const FACES: [u16; 24] = [5, 4, 2, 5, 2, 3, 1, 0, 2, 1, 2, 4, 0, 1, 5, 0, 5, 3, 0, 3, 2, 1, 4, 5];

impl Wedges {
    pub fn new(gpu: &Gpu, settings: &options::Wedges) -> Result<Self, Error> {
        let options = Options::new(gpu, settings)?;
        let one_draw = || Box::new(OneDraw { is_split: options.split > 1 }) as Box<dyn Way>;
        let indices: Vec<u16> = (0..GROUP as u16).flat_map(|i| FACES.map(|corner| i * 6 + corner)).collect();
        Ok(Self {
            way: old_ways::way(gpu, settings)?.unwrap_or_else(one_draw),
            pipelines: None,
            body_indices: gpu.buffer("corners of wedges", &indices, wgpu::BufferUsages::INDEX),
            whole: Whole::new(gpu),
            form: None,
            pieces: Vec::new(),
            targets: Vec::new(),
            budget: Budget::new(options.budget_ms, options.scale),
            tables: Tables::new(gpu, options.table),
            casting: 0,
            draws: 0,
            gpu: gpu.clone(),
            views: None,
            options,
        })
    }

    fn is_lit(&self) -> bool {
        self.pieces.iter().all(|piece| piece.selection.throws.is_empty())
    }

    /// Cuts the light into its pieces, and chooses casters for each.
    fn choose(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form) -> Result<(), Error> {
        let forms = form.pieces(self.options.split);
        self.pieces.truncate(forms.len());
        for (i, mut form) in forms.into_iter().enumerate() {
            if let Some(weight) = self.tables.weight_of_piece(i).filter(|_| form.face == Face::Picture) {
                form.weight = weight;
            }
            match self.pieces.get_mut(i) {
                Some(piece) => piece.form = form,
                None => self.pieces.push(Piece::new(gpu, form, self.way.extrude())),
            }
            let piece = &mut self.pieces[i];
            piece.term = self.tables.term_of(&piece.form);
            piece.selection.choose(gpu, view, &piece.form, &self.options)?;
        }
        Ok(())
    }

    /// Makes room and pipelines.
    fn make_ready(&mut self, gpu: &Gpu, view: &View<'_>, form: &Form) -> Result<(), Error> {
        let Some(layout) = self.pieces.first().map(|p| p.silhouettes.layout()) else { return Ok(()) };
        let scales = self.scales();
        let pipelines = self.pipelines.get_or_insert_with(|| Pipelines::new(gpu, layout));
        for piece in &mut self.pieces {
            piece.prepare(gpu, view, pipelines, [self.way.at_once(), self.way.bundles()])?;
        }
        self.targets.truncate(scales.len());
        for (i, scale) in scales.iter().enumerate() {
            let scale = effective(view.receivers.size, *scale);
            let scaled_depth = (scale > 1).then_some(wgpu::TextureFormat::Depth32Float);
            let key = TargetKey {
                size: view.receivers.size,
                scale,
                pieces: self.pieces.len() as u32,
                own_depth: self.way.depth_format().or(scaled_depth),
            };
            if self.targets.get(i).is_none_or(|t| t.key != key) {
                self.targets.truncate(i);
                self.targets.push(Target::new(gpu, pipelines, key, &self.whole));
            }
            if let Some(format) = key.own_depth {
                pipelines.prepare_depth(gpu, format);
            }
            pipelines.prepare_resolve(gpu, resolve_key(view, form, self.tables.term(form.face), &self.targets[i]));
        }
        self.way.prepare(gpu, view, &self.pieces, &self.targets, pipelines)
    }

    /// Scales that may come up. Debug views are of the size of the picture.
    fn scales(&self) -> &'static [u32] {
        if self.views.is_some() { &[1] } else { self.options.scales() }
    }

    /// The target of the scale that is chosen now.
    fn target(&self) -> Option<&Target> {
        let scales = self.scales();
        let at = scales.iter().position(|s| *s == self.budget.scale()).unwrap_or(0);
        self.targets.get(at)
    }

    /// Draws all pieces and turns their shares into visibility.
    fn draw(
        &self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        edges: &Edges,
        form: &Form,
        visibility: &VisibilityTarget,
    ) -> u32 {
        let (Some(pipelines), Some(target)) = (&self.pipelines, self.target()) else { return 0 };
        let mut draws = 0;
        for (i, piece) in self.pieces.iter().enumerate() {
            let Some(buffers) = &piece.buffers else { continue };
            let body_indices = &self.body_indices;
            let tables = self.tables.group_of_piece(piece.term, i);
            for round in piece.rounds() {
                let recording = Recording { pipelines, target, body_indices, tables, round };
                piece.build(passes, view, edges, self.way.bundles(), &recording);
                if i == 0 && round.is_first {
                    draws += target.copy_depth(passes, view, pipelines, buffers);
                }
                draws += self.way.add_up(passes, view, i, piece, &recording);
            }
        }
        self.upload(passes, view, form, target);
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        let term = self.tables.term(form.face);
        if let Some(pipeline) = pipelines.resolving(resolve_key(view, form, term, target)) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &view.receivers.bind_group, &[]);
            pass.set_bind_group(1, &target.resolve, &[]);
            pass.set_bind_group(2, self.tables.group(term), &[]);
            pass.draw(0..3, 0..1);
        }
        draws + 1
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
        let form = self.form.filter(|form| !self.is_lit() && !form.is_point())?;
        let (piece, target) = (self.pieces.first()?, self.target()?);
        let resolve = resolve_key(view, &form, self.tables.term(form.face), target);
        Some(Drawn {
            pieces: self.pieces.iter().filter_map(|p| p.buffers.as_ref()).collect(),
            indices: &self.body_indices,
            key: Key { depth: compared_depth(view), ..piece.key(view, &draws::BODIES, target) },
            bundles: self.way.bundles(),
            tables: self.tables.group_of_piece(piece.term, 0),
            layout: &self.pipelines.as_ref()?.draw_layout,
            shares: (resolve, &target.resolve, &self.pipelines.as_ref()?.resolve_layout),
        })
    }

    /// What resolving reads.
    fn upload(&self, passes: &mut Passes<'_>, view: &View<'_>, form: &Form, target: &Target) {
        let frame = Frame { rounding: ROUNDING, cap_chunks: 0, scale: target.key.scale, wedges: [0; 2] };
        let mut pieces = [[0.0; 4]; MOST_PIECES];
        for (i, (record, piece)) in pieces.iter_mut().zip(&self.pieces).enumerate() {
            *record = piece.record(self.way.shadows_of_eye(i, piece));
        }
        passes.upload(&self.whole.light, bytemuck::bytes_of(&form.uniform(view, &frame)));
        passes.upload(&self.whole.eye, bytemuck::bytes_of(&Eye::new(view)));
        passes.upload(&self.whole.pieces, bytemuck::cast_slice(&pieces));
    }
}

/// A picture that is next to nothing is not made smaller.
fn effective((width, height): (u32, u32), scale: u32) -> u32 {
    if width.min(height) < 2 * scale { 1 } else { scale }
}

fn resolve_key(view: &View<'_>, form: &Form, term: Term, target: &Target) -> Resolve {
    Resolve {
        soft: !form.is_point(),
        has_normals: view.receivers.has_normals,
        face: form.face,
        term,
        pieces: target.key.pieces,
        scaled: target.key.scale > 1,
    }
}

/// Of the receivers' own depth, where it can be attached, the format and whether near is 1.
fn compared_depth(view: &View<'_>) -> Option<(wgpu::TextureFormat, bool)> {
    lent_depth(view.receivers).map(|d| (d.texture().format(), is_reversed(view)))
}

impl Technique for Wedges {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let has_picture = self.tables.prepare(gpu, view, self.options.split);
        let mut form = Form::of(&view.light.shape, has_picture, self.options.point_radius);
        if is_on_a_caster(gpu, view, form.center)? {
            form = form.off_ties(view.rounding());
        }
        self.casting = view.casters.casting().len() as u32;
        self.form = Some(form);
        self.choose(gpu, view, &form)?;
        if self.is_lit() { Ok(()) } else { self.make_ready(gpu, view, &form) }
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        visibility.check(view.receivers)?;
        self.draws = 0;
        let edges = view.casters.made_edges().filter(|_| !self.is_lit());
        let (Some(edges), Some(form)) = (edges, self.form) else {
            drop(passes.render("visibility", &[visibility.overwrite()], None));
            self.record_view(passes, view, visibility);
            return Ok(());
        };
        self.draws = self.draw(passes, view, edges, &form, visibility);
        self.record_view(passes, view, visibility);
        self.budget.frame(passes.last_ms());
        Ok(())
    }

    fn lend(&mut self, _: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("wedges")
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Wedges {
    fn stats(&self) -> Stats {
        let thrown = self.pieces.iter().map(|p| p.selection.throws.len() as u32).max().unwrap_or(0);
        let sides: u64 = self.pieces.iter().map(|p| u64::from(p.silhouettes.room(Part::PassSides))).sum();
        let pieces: u64 = self.pieces.iter().map(Piece::bytes).sum();
        let targets: u64 = self.targets.iter().map(Target::bytes).sum();
        Stats {
            draws: self.draws,
            triangles: sides * 10,
            casters_drawn: thrown,
            casters_culled: self.casting.saturating_sub(thrown),
            bytes: pieces + targets + self.way.bytes() + self.tables.bytes() + self.body_indices.size(),
        }
    }

    fn reads(&self, pass: &str) -> Option<u64> {
        let shares = draws::shares_format(&self.gpu).block_copy_size(None).map_or(0, u64::from);
        match pass {
            // The depth of the receiver, and the shares that are blended over.
            "wedges" => Some(4 + shares),
            "depth of wedges" => Some(4),
            "visibility" => Some(8 + shares * self.pieces.len() as u64),
            _ => None,
        }
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        let found = self.pieces.iter().filter_map(|p| p.silhouettes.found()).map(|[sides, ..]| u64::from(sides));
        found.reduce(|sum, more| sum + more).map(|wedges| ("wedges", wedges)).into_iter().collect()
    }

    fn inspect(&mut self, view: Option<&str>) {
        self.views = view.and_then(|name| Views::new(&self.gpu, name));
    }

    fn debug_views(&self) -> Vec<DebugView<'_>> {
        self.views.iter().filter_map(Views::picture).collect()
    }
}
