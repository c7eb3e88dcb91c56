//! The full-screen pass that compares receivers with the maps.

use super::DepthMaps;
use crate::{
    fullscreen::{Fullscreen, UNIFORM, bind, layout},
    gpu::Gpu,
    passes::Passes,
    receivers::Receivers,
    shader::{Shader, shader_struct},
    view::View,
    visibility::VisibilityTarget,
};
use umbrage_core::glam::{DMat3, DMat4, DVec3, DVec4};

shader_struct! {
    /// How to get from a pixel to the surface it shows.
    pub(crate) struct Eye {
        eye_from_ndc: [[f32; 4]; 4],
        ndc_from_pixel: [f32; 2],
        background_depth: f32,
        reach: f32,
    }
}

shader_struct! {
    /// One view of the light, see `wgsl/map_lookup.wgsl`.
    pub(crate) struct MapLayer {
        map_from_ndc: [[f32; 4]; 4],
        slope_right: [f32; 3],
        pad_a: f32,
        slope_down: [f32; 3],
        pad_b: f32,
        slope_axis: [f32; 3],
        pad_c: f32,
    }
}

shader_struct! {
    /// See `wgsl/map_lookup.wgsl`.
    pub(crate) struct MapLookup {
        eye: Eye,
        layers: [MapLayer; 6],
        from_light: [[f32; 4]; 4],
        rounding: [f32; 2],
        per_metre: [f32; 2],
        size: f32,
        bias: f32,
        caster_rounding: f32,
        pad: f32,
    }
}

/// Host structs of a lookup shader.
pub(crate) const LOOKUP_LAYOUTS: &[crate::shader::HostLayout] = &[Eye::LAYOUT, MapLayer::LAYOUT, MapLookup::LAYOUT];

impl Eye {
    /// For the camera and size of `view`.
    pub(crate) fn new(view: &View<'_>) -> Self {
        let (width, height) = view.receivers.size;
        let eye_from_ndc = view.clip_from_eye().inverse();
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
        let ends = corners.into_iter().flat_map(|(x, y)| [0.0, 1.0].map(|z| eye_from_ndc * DVec4::new(x, y, z, 1.0)));
        Self {
            reach: ends.map(|p| p.truncate().abs().element_sum()).fold(0.0, f64::max) as f32,
            eye_from_ndc: eye_from_ndc.as_mat4().to_cols_array_2d(),
            ndc_from_pixel: [2.0 / width as f32, -2.0 / height as f32],
            background_depth: view.camera.background_depth(),
        }
    }
}

/// Pipelines (one for each combination that came up) and the uniforms of the pass.
pub(crate) struct Lookup {
    module: wgpu::ShaderModule,
    constants: Vec<(&'static str, f64)>,
    bias: f64,
    layout: wgpu::BindGroupLayout,
    pipelines: Vec<(Variant, wgpu::RenderPipeline)>,
    uniforms: wgpu::Buffer,
    data: MapLookup,
    sampler: wgpu::Sampler,
    bind_group: Option<(wgpu::Texture, wgpu::BindGroup)>,
    current: Option<usize>,
}

/// What a pipeline is made for.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    perspective: bool,
    cube: bool,
    has_normals: bool,
}

impl Lookup {
    pub(crate) fn new(gpu: &Gpu, shader: &Shader, bias: f64, constants: &[(&'static str, f64)]) -> Self {
        Self {
            module: shader.module(gpu),
            constants: constants.to_vec(),
            bias,
            layout: lookup_layout(gpu),
            pipelines: Vec::new(),
            uniforms: gpu.buffer(
                "map lookup",
                &[MapLookup::default()],
                wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            ),
            data: MapLookup::default(),
            sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("map compare"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::GreaterEqual),
                ..Default::default()
            }),
            bind_group: None,
            current: None,
        }
    }

    pub(crate) fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, maps: &DepthMaps) {
        self.current = None;
        let Some(textures) = maps.textures.as_ref().filter(|_| !maps.views.is_empty()) else { return };
        self.data = self.uniforms(view, maps);
        let perspective = self.is_perspective(maps);
        let variant = Variant { perspective, cube: maps.is_cube, has_normals: view.receivers.has_normals };
        let known = self.pipelines.iter().position(|(v, _)| *v == variant);
        self.current = Some(known.unwrap_or_else(|| {
            self.pipelines.push((variant, self.pipeline(gpu, variant)));
            self.pipelines.len() - 1
        }));
        if self.bind_group.as_ref().is_none_or(|(t, _)| t != textures.result()) {
            self.bind_group = Some((textures.result().clone(), self.bind(gpu, textures.result())));
        }
    }

    /// Writes 1 everywhere where there is nothing to look up.
    pub(crate) fn record(&self, passes: &mut Passes<'_>, receivers: &Receivers, visibility: &VisibilityTarget) {
        passes.upload(&self.uniforms, bytemuck::bytes_of(&self.data));
        let mut pass = passes.render("visibility", &[visibility.overwrite()], None);
        if let (Some(current), Some((_, bind_group))) = (self.current, &self.bind_group) {
            pass.set_pipeline(&self.pipelines[current].1);
            pass.set_bind_group(0, &receivers.bind_group, &[]);
            pass.set_bind_group(1, bind_group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.uniforms.size()
    }

    fn uniforms(&self, view: &View<'_>, maps: &DepthMaps) -> MapLookup {
        let eye_from_ndc = view.clip_from_eye().inverse();
        // A layer that was not rendered sends every point outside of the map, where all is lit.
        let outside = DMat4::from_cols(DVec4::ZERO, DVec4::ZERO, DVec4::ZERO, DVec4::new(-1.0, -1.0, 0.0, 1.0));
        let mut layers = [MapLayer { map_from_ndc: matrix(&outside), ..MapLayer::default() }; 6];
        let center = view.light.shape.center();
        for v in &maps.views {
            let map_from_world = texels_from_clip(v.size) * v.clip_from_world;
            let slopes = Slopes::of(&map_from_world, maps.is_perspective(v));
            layers[v.layer as usize] = MapLayer {
                map_from_ndc: matrix(&(map_from_world * DMat4::from_translation(view.camera.eye) * eye_from_ndc)),
                slope_right: slopes.right.as_vec3().to_array(),
                slope_down: slopes.down.as_vec3().to_array(),
                slope_axis: slopes.axis.as_vec3().to_array(),
                ..MapLayer::default()
            };
        }
        let from_light = DMat4::from_translation(view.camera.eye * center.w - center.truncate()) * eye_from_ndc;
        MapLookup {
            eye: Eye::new(view),
            layers,
            from_light: matrix(&from_light),
            size: maps.size as f32,
            // Depth 0…1 in single precision; perspective depth keeps its relative precision, parallel depth does not.
            rounding: if self.is_perspective(maps) { [2e-6, 0.0] } else { [0.0, 1e-6] },
            per_metre: per_metre(maps),
            bias: self.bias as f32,
            caster_rounding: (maps.largest_coordinate(view) * 2.4e-7) as f32,
            ..MapLookup::default()
        }
    }

    fn is_perspective(&self, maps: &DepthMaps) -> bool {
        maps.views.first().is_some_and(|v| maps.is_perspective(v))
    }

    fn pipeline(&self, gpu: &Gpu, variant: Variant) -> wgpu::RenderPipeline {
        let mut constants = self.constants.clone();
        let on = |switch: bool| if switch { 1.0 } else { 0.0 };
        constants.push(("PERSPECTIVE", on(variant.perspective)));
        constants.push(("CUBE", on(variant.cube)));
        constants.push(("HAS_NORMALS", on(variant.has_normals)));
        Fullscreen {
            label: "map lookup",
            module: &self.module,
            entry: "visibility",
            groups: &[&Receivers::layout(gpu), &self.layout],
            target: VisibilityTarget::FORMAT.into(),
            constants: &constants,
        }
        .pipeline(gpu)
    }

    fn bind(&self, gpu: &Gpu, maps: &wgpu::Texture) -> wgpu::BindGroup {
        let view = maps.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let resources = [
            self.uniforms.as_entire_binding(),
            wgpu::BindingResource::TextureView(&view),
            wgpu::BindingResource::Sampler(&self.sampler),
        ];
        bind(gpu, "map lookup", &self.layout, &resources)
    }
}

/// What a plane's normal has to do with the slope of its stored depth, see `map_point` in `wgsl/map_lookup.wgsl`.
struct Slopes {
    right: DVec3,
    down: DVec3,
    axis: DVec3,
}

impl Slopes {
    fn of(map_from_world: &DMat4, perspective: bool) -> Self {
        let rows = [0, 1, 2, 3].map(|i| map_from_world.row(i).truncate());
        // In perspective texels times w, and w, are linear in p − light; for parallel light texels and depth are in p.
        let last = if perspective { rows[3] } else { rows[2] };
        let inverse = DMat3::from_cols(rows[0], rows[1], last).inverse();
        let axis = inverse.row(2);
        // Any common factor will do: it cancels. Its sign makes n · axis positive for a plane that faces the light.
        let scale = 1.0 / axis.length().max(f64::MIN_POSITIVE);
        let toward_light = if perspective { -scale } else { scale };
        Self { right: inverse.row(0) * -scale, down: inverse.row(1) * -scale, axis: axis * toward_light }
    }
}

/// Clip space to texels across and down, row 0 at the top.
fn texels_from_clip(size: u32) -> DMat4 {
    let half = f64::from(size) * 0.5;
    DMat4::from_cols(
        DVec4::new(half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -half, 0.0, 0.0),
        DVec4::Z,
        DVec4::new(half, half, 0.0, 1.0),
    )
}

fn matrix(m: &DMat4) -> [[f32; 4]; 4] {
    m.as_mat4().to_cols_array_2d()
}

/// How stored depth changes per metre along the light: perspective depth is near / distance, so its derivative is
/// depth² / near; that of parallel depth is constant.
fn per_metre(maps: &DepthMaps) -> [f32; 2] {
    let Some(view) = maps.views.first() else { return [0.0; 2] };
    let depth = view.clip_from_world.row(2);
    if maps.is_perspective(view) { [(1.0 / depth.w) as f32, 0.0] } else { [0.0, depth.truncate().length() as f32] }
}

fn lookup_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let maps = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Depth,
        view_dimension: wgpu::TextureViewDimension::D2Array,
        multisampled: false,
    };
    let compare = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    layout(gpu, "map lookup", wgpu::ShaderStages::FRAGMENT, &[UNIFORM, maps, compare])
}
