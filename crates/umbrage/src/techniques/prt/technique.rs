//! A frame: turns the light, sums where it changed, draws.

use super::baked::Baked;
use super::batches::Batches;
use super::lights::{Lights, turn};
use super::pipelines::{BLOCK, DEPTH, Pipelines, PrtMesh, PrtView};
use super::sky::SkyLight;
use crate::fullscreen::{attachment, bind, target_texture};
use crate::passes::{Kept, Passes};
use crate::technique::{InOrder, Inside, Stats, Technique};
use crate::{Answer, Error, Gpu, RadianceTarget, View, VisibilityTarget};
use umbrage_core::glam::{DMat4, DQuat};
use umbrage_core::harmonics::Window;
use umbrage_core::transfer::{Transfer, Wanted};
use umbrage_core::{Environment, LightShape, Scene};

/// See [`super`].
pub(super) struct Transferring {
    wanted: Wanted,
    pipelines: Pipelines,
    sky: SkyLight,
    baked: Option<Baked>,
    lights: Lights,
    batches: Batches,
    view: wgpu::Buffer,
    /// Of the receivers' size.
    depth: Option<wgpu::TextureView>,
    /// Of the receivers that were drawn to last.
    bind_group: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    camera: PrtView,
    background: f32,
    /// Of the frame that was summed last: light, and how meshes stood.
    summed: Option<(Vec<[f32; 4]>, Vec<PrtMesh>)>,
    sums: u64,
    kept: Kept,
}

impl Transferring {
    pub fn new(gpu: &Gpu, wanted: Wanted, window: Window) -> Self {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            sky: SkyLight::new(wanted.order, window),
            wanted,
            pipelines: Pipelines::new(gpu),
            baked: None,
            lights: Lights::default(),
            batches: Batches::default(),
            view: gpu.buffer("camera of a transfer", &[PrtView::default()], usage),
            depth: None,
            bind_group: None,
            camera: PrtView::default(),
            background: 0.0,
            summed: None,
            sums: 0,
            kept: Kept::default(),
        }
    }

    /// Turns the light for every mesh, and lists what is drawn.
    fn place(&mut self, view: &View<'_>, environment: &Environment) -> Result<(), Error> {
        let Some(baked) = &mut self.baked else { return Err(no_transfer()) };
        baked.fits.check(view.casters)?;
        let sky = self.sky.of(environment);
        let turned = DQuat::from_mat3(&environment.world_from_sky());
        let color = (view.light.color * view.light.intensity).as_dvec3() * f64::from(environment.intensity);
        self.lights.clear();
        self.batches.clear();
        for mesh in &baked.meshes {
            let placed = view.casters.placed().get(mesh.instance);
            let turn = placed.map_or(DQuat::IDENTITY, |p| turn(&mesh.world_from_mesh, &p.world_from_mesh));
            let start = self.lights.of(sky, turned, color, turn);
            self.batches.add(view.casters, mesh, start);
        }
        Ok(())
    }

    /// Makes what has the size of the receivers.
    fn make_targets(&mut self, gpu: &Gpu, view: &View<'_>) {
        let receivers = view.receivers;
        let size = |texture: &wgpu::Texture| (texture.width(), texture.height());
        if self.depth.as_ref().is_none_or(|view| size(view.texture()) != receivers.size) {
            let depth = target_texture(gpu, "depth of a transfer", receivers.size, 1, DEPTH);
            self.depth = Some(depth.create_view(&Default::default()));
        }
        let Some(baked) = &self.baked else { return };
        if self.bind_group.as_ref().is_none_or(|(depth, _)| *depth != receivers.depth) {
            let seen = wgpu::BindingResource::TextureView(&receivers.depth);
            let entries = [self.view.as_entire_binding(), baked.table.as_entire_binding(), seen];
            let group = bind(gpu, "transferred radiance", &self.pipelines.draw_layout, &entries);
            self.bind_group = Some((receivers.depth.clone(), group));
        }
    }

    /// Sums up where the light or a mesh has changed since.
    fn sum(&mut self, passes: &mut Passes<'_>) {
        let Some(baked) = &self.baked else { return };
        self.kept.note(passes);
        let now = (&self.lights.coefficients, &self.batches.table);
        if self.summed.as_ref().is_some_and(|(lights, table)| (lights, table) == now) {
            return;
        }
        passes.upload(&baked.table, bytemuck::cast_slice(&self.batches.table));
        passes.upload(&baked.lights, bytemuck::cast_slice(&self.lights.coefficients));
        let mut pass = passes.compute("sum");
        pass.set_pipeline(self.pipelines.sum(baked.channels));
        for part in &baked.parts {
            pass.set_bind_group(0, &part.bind_group, &[]);
            pass.dispatch_workgroups(part.count.div_ceil(BLOCK as u32), 1, 1);
        }
        let (lights, table) = self.summed.get_or_insert_default();
        lights.clone_from(&self.lights.coefficients);
        table.clone_from(&self.batches.table);
        self.sums += 1;
    }

    fn draw(&self, passes: &mut Passes<'_>, view: &View<'_>, radiance: &RadianceTarget) {
        let (Some(baked), Some(depth), Some((_, group))) = (&self.baked, &self.depth, &self.bind_group) else { return };
        passes.upload(&self.view, bytemuck::bytes_of(&self.camera));
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(self.background),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        };
        let color = attachment(&radiance.view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render("draw", &[color], Some(depth));
        pass.set_bind_group(0, group, &[]);
        pass.set_bind_group(1, &view.casters.bind_group, &[]);
        pass.set_vertex_buffer(0, baked.vertices.slice(..));
        pass.set_vertex_buffer(1, baked.radiance.slice(..));
        pass.set_index_buffer(baked.indices.slice(..), wgpu::IndexFormat::Uint32);
        for draw in &self.batches.draws {
            pass.set_pipeline(self.pipelines.draw(self.background, draw.is_masked));
            pass.set_bind_group(2, view.casters.texture_group(draw.texture), &[]);
            pass.draw_indexed(draw.indices.clone(), 0, 0..1);
        }
    }
}

fn no_transfer() -> Error {
    let what = "scenes whose transfer it was not given; bake it (`umbrage-bake`) and hand it over by \
                `Technique::take_transfer`";
    Error::Unsupported { technique: "prt".into(), what: what.into() }
}

fn camera(view: &View<'_>) -> PrtView {
    let origin = DMat4::from_translation(view.casters.origin());
    // Depth in whole numbers, or that is 1 far away, has steps of one size.
    let format = view.receivers.depth.texture().format();
    let is_float = matches!(format, wgpu::TextureFormat::Depth32Float | wgpu::TextureFormat::Depth32FloatStencil8);
    let even = if is_float && view.camera.background_depth() < 0.5 { 0.0 } else { 4e-7 };
    PrtView {
        clip_from_world: (view.camera.clip_from_world() * origin).as_mat4().to_cols_array_2d(),
        rounding: [even, 1e-5],
        mirrored: u32::from(view.camera.is_mirrored()),
        spare: 0,
    }
}

impl Technique for Transferring {
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, _: InOrder) -> Result<(), Error> {
        let LightShape::Environment(environment) = &view.light.shape else {
            let kind = view.light.shape.kind().name();
            let what = format!("{kind} lights, whose answer is visibility; its light is the environment of the scene");
            return Err(Error::Unsupported { technique: "prt".into(), what });
        };
        if !self.kept.holds() {
            self.summed = None;
        }
        self.place(view, environment)?;
        self.make_targets(gpu, view);
        (self.camera, self.background) = (camera(view), view.camera.background_depth());
        Ok(())
    }

    fn record_visibility(
        &mut self,
        _: &mut Passes<'_>,
        _: &View<'_>,
        _: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        self.answer().refuse()
    }

    fn answer(&self) -> Answer {
        Answer::Radiance
    }

    fn record_radiance(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        radiance: &RadianceTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        radiance.check(view.receivers)?;
        self.sum(passes);
        self.draw(passes, view, radiance);
        Ok(())
    }

    fn wants(&self) -> Option<Wanted> {
        Some(self.wanted)
    }

    fn take_transfer(&mut self, gpu: &Gpu, transfer: &Transfer, scene: &Scene) -> Result<(), Error> {
        self.baked = Some(Baked::new(gpu, &self.pipelines, &self.wanted, transfer, scene)?);
        (self.bind_group, self.summed) = (None, None);
        Ok(())
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Transferring {
    fn stats(&self) -> Stats {
        let depth =
            self.depth.as_ref().map_or(0, |d| u64::from(d.texture().width()) * u64::from(d.texture().height()) * 4);
        Stats {
            draws: self.batches.draws.len() as u32,
            triangles: self.batches.triangles(),
            casters_drawn: self.batches.shown,
            bytes: depth + self.view.size() + self.baked.as_ref().map_or(0, |baked| baked.bytes),
            ..Stats::default()
        }
    }

    fn forget(&mut self) {
        self.summed = None;
    }

    fn counts(&self) -> Vec<(&'static str, u64)> {
        let points = self.baked.as_ref().map_or(0, |baked| baked.point_count as u64);
        vec![("points", points), ("sums", self.sums)]
    }
}
