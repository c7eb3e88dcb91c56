//! The edges that bound the shadows of a light's casters, in world space, on the GPU.

use crate::casters::{Casters, Places, Reads};
use crate::compute::compute_pipeline;
use crate::fullscreen::{STORAGE, STORAGE_WRITE, UNIFORM, bind, layout};
use crate::shader::{Shader, Shared, shader_struct};
use crate::silhouettes::{Extrude, Part, Silhouettes, Style, Throw};
use crate::{error::Error, gpu::Gpu, passes::Passes};
use umbrage_core::glam::{DMat4, DVec4};
use umbrage_core::light_view::LightView;
use umbrage_core::silhouette::Rule;

/// Puts edges into world space.
pub(crate) const CONTOUR_SHADER: Shader = Shader::new("contour", include_str!("make_contour.wgsl"));

/// What the host has to agree on with `contour_record.wgsl`.
pub(in crate::depth_maps) const SHARED: Shared =
    Shared { module: "contour_record", layouts: &[ContourRecord::LAYOUT], constants: &[] };

/// The same with `map_edges.wgsl`.
pub(in crate::depth_maps) const SHARED_EDGES: Shared =
    Shared { module: "map_edges", layouts: &[], constants: &[("EDGES", CHUNK as f64)] };

shader_struct! {
    /// An edge, see `contour_record.wgsl`.
    pub(crate) struct ContourRecord {
        start: [f32; 3],
        times: f32,
        end: [f32; 3],
        pad: f32,
    }
}

const RECORD: u64 = size_of::<ContourRecord>() as u64;

/// Edges that a workgroup makes, and an instance draws.
const CHUNK: u32 = 64;

/// Workgroups in a row, the most that every adapter allows.
const ROW: u32 = 65_535;

/// Finds them, and keeps them for as long as light, casters and views stay.
pub(super) struct Contour {
    silhouettes: Silhouettes,
    make: wgpu::ComputePipeline,
    written: wgpu::BindGroupLayout,
    read: wgpu::BindGroupLayout,
    light: wgpu::Buffer,
    /// The light, relative to the casters' origin.
    place: [f32; 4],
    buffers: Option<Buffers>,
    throws: Vec<Throw>,
    found: Vec<u32>,
    known: Places,
    made_for: Option<Key>,
}

struct Buffers {
    records: wgpu::Buffer,
    write: wgpu::BindGroup,
    read: wgpu::BindGroup,
}

/// The casters, when they last moved, the light, and the views that chose among them.
#[derive(PartialEq)]
struct Key {
    casters: u64,
    moves: u64,
    light: DVec4,
    seen_by: Vec<LightView>,
}

impl Contour {
    pub fn new(gpu: &Gpu) -> Self {
        let silhouettes = Silhouettes::new(gpu, Extrude::Compute);
        let written = layout(gpu, "make contour", wgpu::ShaderStages::COMPUTE, &[STORAGE_WRITE]);
        let of_edges = Reads::Contour.layout(gpu);
        let groups = [Some(silhouettes.layout()), Some(&of_edges), Some(&written)];
        let make = compute_pipeline(gpu, &CONTOUR_SHADER.module(gpu), "make_contour", &groups, &[]);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Self {
            silhouettes,
            make,
            written,
            read: layout(gpu, "contour", wgpu::ShaderStages::VERTEX, &[STORAGE, UNIFORM]),
            light: gpu.buffer("light of a contour", &[[0f32; 4]], usage),
            place: [0.0; 4],
            buffers: None,
            throws: Vec::new(),
            found: Vec::new(),
            known: Places::default(),
            made_for: None,
        }
    }

    /// The layout of what `map_edges.wgsl` has as group 0.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.read
    }

    /// Chooses the casters that any of `seen_by` sees.
    pub fn prepare(&mut self, gpu: &Gpu, casters: &Casters, light: DVec4, seen_by: &[LightView]) -> Result<(), Error> {
        let moves = casters.moves().now();
        let is_known = |key: &Key| {
            (key.casters, key.moves, key.light) == (casters.version(), moves, light) && key.seen_by == seen_by
        };
        if self.made_for.as_ref().is_some_and(is_known) {
            return Ok(());
        }
        self.made_for = None;
        self.choose(gpu, casters, light, seen_by)?;
        self.made_for = Some(Key { casters: casters.version(), moves, light, seen_by: seen_by.to_vec() });
        Ok(())
    }

    fn choose(&mut self, gpu: &Gpu, casters: &Casters, light: DVec4, seen_by: &[LightView]) -> Result<(), Error> {
        let edges = casters.edges(gpu)?;
        self.known.clear(casters.placed().len());
        self.found.clear();
        for view in seen_by {
            casters.casting().query(&view.frustum(), &mut self.found);
        }
        self.found.retain(|place| self.known.insert(*place));
        casters.sort(&mut self.found);
        let has_edges = |place: &&u32| {
            let placed = &casters.placed()[**place as usize];
            let has_some = !edges.of_mesh(placed.mesh).adjacency.edges.is_empty();
            has_some && !placed.masked && placed.sides.is_some() && !placed.bounds.is_empty()
        };
        self.throws.clear();
        self.throws.extend(self.found.iter().filter(has_edges).map(|place| throw(*place, light)));
        let style = Style { weighted: true, quads: true };
        self.silhouettes.prepare(gpu, casters, (&DMat4::IDENTITY, true), light, &self.throws, style)?;
        let from_origin = light.truncate() - casters.origin() * light.w;
        self.place = from_origin.extend(light.w).as_vec4().to_array();
        self.make_room(gpu);
        Ok(())
    }

    /// Room for all edges, as far as a shader can bind: of more edges than that on silhouettes the
    /// last are left out.
    fn make_room(&mut self, gpu: &Gpu) {
        let limits = gpu.device.limits();
        let most = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / (RECORD * u64::from(CHUNK));
        let needed = u64::from(self.silhouettes.room(Part::PassSides)).div_ceil(u64::from(CHUNK)).min(most);
        if self.buffers.as_ref().is_some_and(|b| b.chunks() >= needed) {
            return;
        }
        // Half as much again, so that a moving camera does not make it grow all the time.
        let records = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("contour"),
            size: (needed + needed / 2).clamp(1, most.max(1)) * RECORD * u64::from(CHUNK),
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let write = bind(gpu, "make contour", &self.written, &[records.as_entire_binding()]);
        let read = bind(gpu, "contour", &self.read, &[records.as_entire_binding(), self.light.as_entire_binding()]);
        self.buffers = Some(Buffers { records, write, read });
    }

    /// Finds the edges.
    pub fn record(&self, passes: &mut Passes<'_>, casters: &Casters) {
        let edges = casters.made_edges().filter(|_| !self.throws.is_empty());
        let (Some(edges), Some(buffers)) = (edges, &self.buffers) else { return };
        passes.upload(&self.light, bytemuck::bytes_of(&self.place));
        self.silhouettes.record(passes, edges);
        let chunks = u64::from(self.silhouettes.room(Part::PassSides)).div_ceil(u64::from(CHUNK));
        let chunks = chunks.min(buffers.chunks()) as u32;
        let mut pass = passes.compute("silhouettes");
        pass.set_pipeline(&self.make);
        pass.set_bind_group(0, self.silhouettes.found_by_gpu(), &[]);
        pass.set_bind_group(1, edges.group(Reads::Contour), &[]);
        pass.set_bind_group(2, &buffers.write, &[]);
        pass.dispatch_workgroups(chunks.min(ROW), chunks.div_ceil(ROW), 1);
    }

    /// Draws four corners for each, with the pipeline that is set; false where there are none.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) -> bool {
        let arguments = self.silhouettes.arguments(Part::PassSides).filter(|_| !self.throws.is_empty());
        let (Some((arguments, offset)), Some(buffers)) = (arguments, &self.buffers) else { return false };
        pass.set_bind_group(0, &buffers.read, &[]);
        pass.set_index_buffer(self.silhouettes.corner_indices().slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed_indirect(arguments, offset);
        true
    }

    /// Edges that are looked at.
    pub fn edges(&self) -> u64 {
        if self.throws.is_empty() { 0 } else { self.silhouettes.looked_at().0 }
    }

    pub fn bytes(&self) -> u64 {
        self.silhouettes.bytes() + self.light.size() + self.buffers.as_ref().map_or(0, |b| b.records.size())
    }
}

impl Buffers {
    /// Chunks of edges that there is room for.
    fn chunks(&self) -> u64 {
        self.records.size() / (RECORD * u64::from(CHUNK))
    }
}

/// All of a caster's triangles count, whichever way they are wound.
fn throw(place: u32, light: DVec4) -> Throw {
    Throw {
        place,
        light,
        rule: Rule::All,
        is_body: false,
        from_infinity: false,
        z_fail: false,
        light_cap: false,
        dark_cap: false,
        end: DVec4::ZERO,
        reach: 0.0,
        anchor: Default::default(),
    }
}
