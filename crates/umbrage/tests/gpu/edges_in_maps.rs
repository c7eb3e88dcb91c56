//! Edges of casters drawn into layers of maps, by a stage from outside of the library: outside of
//! an edge the map has to say light, inside shadow.

use crate::common::{gpu, visibility};
use umbrage::core::glam::{DAffine3, DMat3, DVec3, Vec4};
use umbrage::core::light_view::{Cascades, Cover, Focus, Omni, Warp};
use umbrage::core::{Camera, Light, LightShape, Material, Scene, Texture, primitive};
use umbrage::depth_maps::{
    Bias, Blend, Depth, EdgeDraw, EdgePass, EdgeTarget, Faces, Fitting, Held, MapFrame, MapSetup, MapTechnique,
    Softness, Splits, Stage,
};
use umbrage::fullscreen::{FLOATS, attachment, bind, layout, target_texture};
use umbrage::{Casters, Error, Gpu, Passes, Shader, View};
use umbrage_renderer::{LightPass, Renderer};

/// Two texels to both sides of each edge, away from corners: 1 outside, −1 inside, and its depth.
const DRAW: Shader = Shader::new(
    "sides of edges",
    "// needs: map_edges
    struct Side {
        @builtin(position) position: vec4f,
        @location(0) across: f32,
        @location(1) along: f32,
        @location(2) @interpolate(flat) length: f32,
        @location(3) depth: f32,
    }

    @vertex
    fn side(@builtin(vertex_index) vertex: u32, @builtin(instance_index) group: u32) -> Side {
        let edge = contour_edge(vertex, group);
        let seen = layer_edge(edge, 4.0);
        if !seen.is_seen {
            return Side(OFF_LAYER, 0.0, 0.0, 0.0, 0.0);
        }
        let at = quad_corner(seen, vertex, 2.0, 2.0);
        let length = distance(seen.start, seen.end);
        let depth = select(seen.depth.x, seen.depth.y, is_at_end(vertex));
        let position = clip_of_texel(at, clamp(depth, 0.0, 1.0));
        return Side(position, dot(at - seen.start, seen.outward), dot(at - seen.start, seen.along), length, depth);
    }

    @fragment
    fn which(in: Side) -> @location(0) vec4f {
        if in.along < 4.0 || in.along > in.length - 4.0 || abs(in.across) < 0.8 {
            discard;
        }
        return vec4f(sign(in.across), in.depth, 0.0, 1.0);
    }",
);

/// 0.5 where an edge and the map agree, 0.25 where there is shadow outside, 0.125 where there is
/// light inside; else 1, or the 0 of its own shadow.
const LOOKUP: Shader = Shader::new(
    "sides against the map",
    "// needs: map_visibility
    @group(2) @binding(0) var sides: texture_2d_array<f32>;

    fn lit_share(point: MapPoint, pixel: Pixel) -> f32 {
        let texel = vec2i(point.texel);
        let side = textureLoad(sides, texel, point.layer, 0).xy;
        let is_behind = point.depth < side.y && !pixel.surface.casts;
        let lit = is_lit(point, vec2f(texel) + 0.5 - point.texel, load_depth(texel, point.layer));
        let agrees = lit == (side.x > 0.0);
        return select(1.0, select(select(0.125, 0.25, side.x > 0.0), 0.5, agrees), side.x != 0.0 && is_behind);
    }",
);

struct Sides {
    layout: wgpu::BindGroupLayout,
    pass: EdgePass,
    made: Option<(wgpu::Texture, Vec<wgpu::TextureView>, wgpu::BindGroup)>,
}

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

impl Sides {
    fn new(gpu: &Gpu) -> Self {
        let array = wgpu::BindingType::Texture {
            sample_type: FLOATS,
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        };
        let draw = EdgeDraw {
            vertex: "side",
            fragment: Some("which"),
            targets: vec![Some(COLOR.into())],
            depth_stencil: None,
        };
        Self {
            layout: layout(gpu, "sides", wgpu::ShaderStages::FRAGMENT, &[array]),
            pass: EdgePass::new(gpu, &DRAW, None, &[], vec![draw]),
            made: None,
        }
    }
}

impl Stage for Sides {
    fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, frame: &MapFrame) -> Result<(), Error> {
        self.pass.prepare(gpu, view.casters, view.light.shape.center(), &frame.views, frame)?;
        let Some(maps) = frame.texture.as_ref().filter(|_| self.made.is_none()) else { return Ok(()) };
        let (size, count) = (maps.width(), maps.depth_or_array_layers());
        let texture = target_texture(gpu, "sides", (size, size), count, COLOR);
        let view = |dimension, base_array_layer, count| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(dimension),
                base_array_layer,
                array_layer_count: Some(count),
                ..Default::default()
            })
        };
        let layers = (0..count).map(|i| view(wgpu::TextureViewDimension::D2, i, 1)).collect();
        let all = view(wgpu::TextureViewDimension::D2Array, 0, count);
        let group = bind(gpu, "sides", &self.layout, &[wgpu::BindingResource::TextureView(&all)]);
        self.made = Some((texture, layers, group));
        Ok(())
    }

    fn record(&mut self, passes: &mut Passes<'_>, frame: &MapFrame, casters: &Casters) -> u32 {
        let Some((_, layers, _)) = &self.made else { return 0 };
        self.pass.find(passes, casters, frame);
        let mut draws = 0;
        for (i, view) in frame.views.iter().enumerate() {
            let clear = wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT);
            let colors = &[attachment(&layers[view.layer as usize], clear)];
            let target = EdgeTarget { label: "sides", colors, depth: None };
            draws += self.pass.record(passes, (i, 0), None, target);
        }
        draws
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|(_, _, group)| group)
    }

    fn bytes(&self) -> u64 {
        self.pass.bytes()
    }
}

/// Things that float over a floor, one kind at a time.
fn floating(kind: &str, shape: &LightShape) -> Scene {
    let mut scene = Scene::default();
    let floor = scene.add_mesh(primitive::plane());
    let material = scene.add_material(Material::default());
    scene.place(floor, material, DAffine3::from_scale(DVec3::splat(40.0))).casts = false;
    let at = DVec3::new(0.3, 1.6, -0.2);
    // No face is so steep under any of the lights that it is only a few texels wide.
    let turned = DMat3::from_rotation_x(0.5) * DMat3::from_rotation_z(0.8) * DMat3::from_rotation_y(0.3);
    let place = |matrix3: DMat3| DAffine3 { matrix3: turned * matrix3, translation: at };
    match kind {
        "box" => {
            let cube = scene.add_mesh(primitive::cube());
            scene.place(cube, material, place(DMat3::IDENTITY));
        }
        "mirrored box" => {
            let cube = scene.add_mesh(primitive::cube());
            scene.place(cube, material, place(DMat3::from_diagonal(DVec3::new(-1.2, 0.7, 1.0))));
        }
        "card" => {
            let card = scene.add_mesh(primitive::plane());
            scene.place(card, material, place(DMat3::IDENTITY));
        }
        "box without a lid" => {
            let mut open = primitive::cube();
            open.indices.truncate(30);
            let open = scene.add_mesh(open);
            scene.place(open, material, place(DMat3::IDENTITY));
        }
        _ => {
            scene.textures.push(Texture {
                name: "opaque".into(),
                width: 1,
                height: 1,
                rgba: vec![[255; 4]],
                sampling: Default::default(),
            });
            let masked =
                Material { base_color: Vec4::ONE, texture: Some(0), alpha_cutoff: Some(0.5), ..Material::default() };
            let masked = scene.add_material(masked);
            let card = scene.add_mesh(primitive::plane());
            scene.place(card, masked, place(DMat3::IDENTITY));
        }
    }
    scene.instances[1].receives = false;
    scene.lights.push(Light::new(shape.clone()));
    scene.camera = Camera { eye: DVec3::new(1.0, 7.0, 7.0), target: DVec3::new(0.5, 0.0, 0.0), ..Camera::default() };
    scene
}

/// Pixels where an edge agrees with the map, with shadow outside, and with light inside.
fn counts(gpu: &Gpu, scene: &Scene, fitting: Fitting, depth: Depth) -> [usize; 3] {
    let setup = MapSetup {
        size: 512,
        faces: Faces::Front,
        depth,
        cache: true,
        bias: Bias::Auto(1.0),
        fitting,
        softness: Softness::Own,
        held: Held::All,
    };
    let stage = Box::new(Sides::new(gpu));
    let technique = Box::new(MapTechnique::staged(gpu, &setup, &LOOKUP, 4.0, &[], Some(stage)).unwrap());
    let mut renderer = Renderer::new(gpu, scene, 320, 240, vec![LightPass { light: 0, technique }]).unwrap();
    let picture = visibility(&mut renderer, scene);
    let count = |value| picture.data.iter().filter(|v| **v == value).count();
    [0.5, 0.25, 0.125].map(count)
}

#[test]
fn outside_of_edges_is_light_and_inside_shadow() {
    let gpu = gpu();
    let sun = LightShape::Directional { direction: DVec3::new(0.4, -1.0, 0.3).normalize(), angle_deg: 0.0 };
    let position = DVec3::new(-1.0, 4.5, 1.0);
    let lamp = LightShape::Point { position };
    let direction = DVec3::new(0.3, -1.0, -0.2).normalize();
    let spot = LightShape::Spot { position, direction, inner_angle_deg: 35.0, outer_angle_deg: 40.0 };
    let one = |omni| Fitting::One { focus: Focus::Visible, omni };
    let cascades = Cascades { count: 3, lambda: 0.5, overlap: 0.1, distance: 0.0, cover: Cover::Receivers };
    let splits = |depth_fit| Fitting::Splits(Splits { cascades, blend: Blend::Off, depth_fit });
    let warp = Fitting::Warp(Warp::LightSpace { strength: 1.0 });
    for kind in ["box", "mirrored box", "card", "box without a lid"] {
        for (light, fitting, depth) in [
            (&sun, one(Omni::Cube), Depth::Projective),
            (&spot, one(Omni::Cube), Depth::Linear),
            (&lamp, one(Omni::Cube), Depth::Projective),
            (&lamp, one(Omni::Tetrahedral), Depth::Projective),
            (&lamp, one(Omni::DualParaboloid), Depth::Projective),
            (&sun, splits(false), Depth::Projective),
            (&sun, splits(true), Depth::Projective),
            (&sun, warp, Depth::Projective),
        ] {
            let [right, outside, inside] = counts(&gpu, &floating(kind, light), fitting, depth);
            let what = format!("{kind}, {light:?}, {fitting:?}: {right}, {outside}, {inside}");
            assert!(right > 60 && inside * 200 <= right, "{what}");
            // A part of the border of an open box has the box itself behind it: a seventh was seen.
            let of = if kind == "box without a lid" { 6 } else { 200 };
            assert!(outside * of <= right, "{what}");
        }
    }
    let masked = counts(&gpu, &floating("masked card", &sun), one(Omni::Cube), Depth::Projective);
    assert_eq!(masked, [0; 3], "a card with a mask has no edges");
    gpu.check().unwrap();
}
