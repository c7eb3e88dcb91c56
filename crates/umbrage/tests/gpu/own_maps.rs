//! A technique from outside of the library whose stage draws a map of its own: it stores depth as a
//! colour, and has to give what `shadow-map` gives.

use crate::common::{gpu, renderer, scene, visibility};
use umbrage::core::{Light, LightShape, Scene, glam::DVec3};
use umbrage::depth_maps::{
    CasterPass, Cover, Depth, LAYER_NAMES, LIGHTS, Map, MapFrame, MapSetup, MapTechnique, SHADERS, Stage,
};
use umbrage::fullscreen::{FLOATS, attachment, bind, layout, target_texture};
use umbrage::{
    Casters, Configure, Error, Family, Gpu, Passes, Registry, SettingsOf, Shader, Technique, TechniqueInfo, View, find,
};
use umbrage_renderer::{LightPass, Renderer};

const DRAW: Shader = Shader::new(
    "depth as a colour",
    "// needs: map_depth
    @fragment
    fn seen(@builtin(position) position: vec4f) -> @location(0) vec4f {
        return vec4f(position.z, 0.0, 0.0, 1.0);
    }

    @fragment
    fn seen_cut_out(in: Masked) -> @location(0) vec4f {
        if is_cut_out(in.material, base_color(in.material, in.uv).a) {
            discard;
        }
        return vec4f(in.position.z, 0.0, 0.0, 1.0);
    }",
);

const LOOKUP: Shader = Shader::new(
    "own maps",
    "// needs: map_visibility
    @group(2) @binding(0) var own_map: texture_2d_array<f32>;

    fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
        let texel = vec2i(point.texel);
        let stored = textureLoad(own_map, texel, point.layer, 0).x;
        return select(0.0, 1.0, is_lit(point, vec2f(texel) + 0.5 - point.texel, stored));
    }",
);

umbrage::settings! {
    /// Settings of the technique.
    struct OwnMaps {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
    }
}

const INFO: TechniqueInfo = TechniqueInfo {
    id: "own-maps",
    title: "Maps of its own",
    summary: "Draws depth into colours.",
    source: "a test",
    family: Family::DepthMaps,
    filter: None,
    lights: LIGHTS,
    casters: umbrage::Needs::Depth,
    features: wgpu::Features::empty(),
    limits: |limits| limits.max_storage_buffers_per_shader_stage = 2,
    hard: true,
    settings: SettingsOf::new::<OwnMaps>(),
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], DRAW, LOOKUP],
    readme: "",
};

impl Configure for OwnMaps {
    const INFO: &'static TechniqueInfo = &INFO;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        let stage = OwnStage::new(gpu);
        Ok(Box::new(MapTechnique::staged(gpu, &self.setup(), &LOOKUP, 0.5, &[], Some(Box::new(stage)))?))
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.setup())
    }
}

impl OwnMaps {
    fn setup(&self) -> MapSetup {
        self.map.covering(&self.cover, Depth::Projective)
    }
}

struct OwnStage {
    layout: wgpu::BindGroupLayout,
    pass: CasterPass,
    made: Option<Made>,
}

struct Made {
    /// The maps that these are as large as.
    of: wgpu::Texture,
    /// Colour and depth of each layer.
    layers: Vec<[wgpu::TextureView; 2]>,
    bind_group: wgpu::BindGroup,
    bytes: u64,
}

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl OwnStage {
    fn new(gpu: &Gpu) -> Self {
        let array = wgpu::BindingType::Texture {
            sample_type: FLOATS,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let nearest = wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        };
        Self {
            layout: layout(gpu, "own maps", wgpu::ShaderStages::FRAGMENT, &[array]),
            pass: CasterPass::new(gpu, &DRAW, ["seen", "seen_cut_out"], &[Some(COLOR.into())], Some(nearest)),
            made: None,
        }
    }

    fn make(&self, gpu: &Gpu, of: &wgpu::Texture) -> Made {
        let (size, count) = (of.width(), of.depth_or_array_layers());
        let [color, depth] = [COLOR, DEPTH].map(|f| target_texture(gpu, "own map", (size, size), count, f));
        let layer = |texture: &wgpu::Texture, i| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: i,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let all = color.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Made {
            of: of.clone(),
            layers: (0..count).map(|i| [layer(&color, i), layer(&depth, i)]).collect(),
            bind_group: bind(gpu, "own maps", &self.layout, &[wgpu::BindingResource::TextureView(&all)]),
            bytes: u64::from(size) * u64::from(size) * u64::from(count) * 8,
        }
    }
}

impl Stage for OwnStage {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error> {
        if let Some(texture) = frame.texture.as_ref().filter(|t| self.made.as_ref().is_none_or(|m| m.of != **t)) {
            self.made = Some(self.make(gpu, texture));
        }
        self.pass.prepare(gpu, view, frame);
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, frame: &MapFrame, casters: &Casters) -> u32 {
        let Some(made) = &self.made else { return 0 };
        self.pass.upload(passes, frame);
        let mut draws = 0;
        for (i, view) in frame.views.iter().enumerate() {
            let [color, depth] = &made.layers[view.layer as usize];
            let colors = [attachment(color, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT))];
            let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard });
            let depth = wgpu::RenderPassDepthStencilAttachment { view: depth, depth_ops, stencil_ops: None };
            draws += self.pass.record(passes, "own map", casters, i, &colors, Some(depth));
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|made| &made.bind_group)
    }

    fn bytes(&self) -> u64 {
        self.pass.bytes() + self.made.as_ref().map_or(0, |made| made.bytes)
    }
}

#[test]
fn a_stage_from_outside_draws_a_map_of_its_own() {
    let gpu = gpu();
    let registry = Registry::default().with(&INFO);
    let direction = DVec3::new(0.4, -1.0, 0.3).normalize();
    let sun = LightShape::Directional { direction, angle_deg: 0.0 };
    let lamp = LightShape::Point { position: DVec3::new(1.0, 3.0, 0.5) };
    for shape in [sun, lamp] {
        let scene = Scene { lights: vec![Light::new(shape)], ..scene("primitives", 0.5) };
        let technique = registry.parse("own-maps:size=512").unwrap().make(&gpu).unwrap();
        let mut own = Renderer::new(&gpu, &scene, 160, 120, vec![LightPass { light: 0, technique }]).unwrap();
        let own = visibility(&mut own, &scene);
        let known = visibility(&mut renderer(&gpu, &scene, 0, "shadow-map", "size=512", (160, 120)), &scene);
        let dark = known.data.iter().filter(|v| **v == 0.0).count();
        assert!(dark > 500, "there are shadows: {dark} pixels");
        let differ = own.data.iter().zip(&known.data).filter(|(a, b)| a != b).count();
        assert!(differ < 10, "{differ} pixels differ under {:?}", scene.lights[0].shape);
    }
    assert!(find("own-maps").is_err(), "the built-in registry stays as it is");
    gpu.check().unwrap();
}
