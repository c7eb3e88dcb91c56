//! Pipelines made ahead: a technique draws a little world that has something of everything, so that
//! all it compiles is there before the first frame.

use crate::casters::Casters;
use crate::fullscreen::target_texture;
use crate::receivers::Receivers;
use crate::technique::Technique;
use crate::{Answer, Error, Gpu, Passes, RadianceTarget, Recorder, View, VisibilityTarget};
use umbrage_core::glam::{DAffine3, DMat3, DVec2, DVec3};
use umbrage_core::rig::{Influence, Joint, Local, Node, Parts, Skin};
use umbrage_core::{Camera, CameraView, Light, LightShape, Material, Pose, Rig, Scene, Texture, primitive};

/// Pixels across and down of what is drawn.
const SIZE: (u32, u32) = (8, 8);

/// Places of the eye, and what it looks at: beside the casters, in the shadow of one, and there
/// with that caster in view. Volumes are counted otherwise there.
const EYES: [(DVec3, DVec3); 3] = [
    (DVec3::new(0.5, 2.0, 5.0), DVec3::ZERO),
    (DVec3::new(0.0, 0.3, 0.0), DVec3::Z),
    (DVec3::new(0.0, 0.3, 0.0), DVec3::new(0.0, 2.0, 1.0)),
];

/// Has `technique` compile all that it needs for lights such as `lights`, for receivers such as
/// `receivers` (their format, whether there are normals and a stencil) and for cameras with such a
/// projection. What is compiled is shared by all techniques of the same settings on this device,
/// so this one may be dropped afterwards, and the first frame of another one compiles nothing.
///
/// Of the lights their kinds count, whether they have a range, an extent or a picture; not where
/// they are. Of the receivers nothing is read or drawn over. The technique takes the memory that it
/// takes in a frame; drop it, or let it have smaller maps, whose size makes no difference but to
/// moments that are reduced.
///
/// It takes as long as compiling does. Where threads may wait, another thread can do it meanwhile:
/// ```no_run
/// # fn f(gpu: umbrage::Gpu, receivers: umbrage::Receivers, camera: umbrage::core::CameraView,
/// #      light: umbrage::core::Light) -> Result<(), umbrage::Error> {
/// let settings = umbrage::parse("pcf:kernel=7")?;
/// let ahead = std::thread::spawn(move || {
///     umbrage::warm_up(&gpu, &mut *settings.make(&gpu)?, &[light], &receivers, &camera)
/// });
/// # Ok(()) }
/// ```
///
/// # Errors
/// Those of preparing and recording, [`Error::Unsupported`] among them for a kind of light that the
/// technique can't do.
pub fn warm_up(
    gpu: &Gpu,
    technique: &mut dyn Technique,
    lights: &[Light],
    receivers: &Receivers,
    camera: &CameraView,
) -> Result<(), Error> {
    for is_crowded in [false, true] {
        let mut world = World::new(gpu, receivers, is_crowded)?;
        for (eye, target) in EYES {
            let looking = Camera { eye, target, ..Camera::default() };
            let camera = CameraView::from_matrices(looking.view_from_world(), camera.clip_from_view);
            for light in lights {
                world.draw(gpu, technique, &above(light), camera)?;
            }
        }
    }
    gpu.check()
}

/// What is drawn, and what it is drawn to.
struct World {
    casters: Casters,
    receivers: Receivers,
    visibility: VisibilityTarget,
    radiance: RadianceTarget,
    textures: Vec<Texture>,
}

impl World {
    fn new(gpu: &Gpu, receivers: &Receivers, is_crowded: bool) -> Result<Self, Error> {
        let scene = scene(is_crowded);
        Ok(Self {
            casters: Casters::new(gpu, &scene)?,
            receivers: receivers.small_copy(gpu, SIZE)?,
            visibility: VisibilityTarget::new(gpu, SIZE.0, SIZE.1)?,
            radiance: RadianceTarget::new(gpu, SIZE.0, SIZE.1)?,
            textures: scene.textures,
        })
    }

    fn draw(
        &mut self,
        gpu: &Gpu,
        technique: &mut dyn Technique,
        light: &Light,
        camera: CameraView,
    ) -> Result<(), Error> {
        let mut recorder = Recorder::new(gpu);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        let recorded = self.record(gpu, &mut passes, technique, light, camera);
        passes.finish();
        recorded?;
        // Many drivers compile only when something is drawn.
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    fn record(
        &mut self,
        gpu: &Gpu,
        passes: &mut Passes<'_>,
        technique: &mut dyn Technique,
        light: &Light,
        camera: CameraView,
    ) -> Result<(), Error> {
        self.casters.record(passes)?;
        let Self { casters, receivers, textures, visibility, radiance } = self;
        let view = View { camera, receivers, casters, light, textures };
        let answer = technique.answer();
        let prepared = technique.prepare(gpu, &view)?;
        match answer {
            Answer::Visibility => prepared.record(passes, visibility),
            Answer::Radiance => prepared.record_radiance(passes, radiance),
        }
    }
}

/// A floor, a closed caster over it, an open one, one with an alpha mask and one that is posed. In
/// a crowd a point may be in more shadows than a stencil counts.
fn scene(is_crowded: bool) -> Scene {
    let mut scene = Scene { rigs: vec![rig()], ..Scene::default() };
    let white =
        Texture { name: "white".into(), width: 1, height: 1, rgba: vec![[255; 4]], sampling: Default::default() };
    scene.textures.push(white);
    let plain = scene.add_material(Material::default());
    let masked = scene.add_material(Material { alpha_cutoff: Some(0.5), texture: Some(0), ..Material::default() });
    let (plane, cube) = (scene.add_mesh(primitive::plane()), scene.add_mesh(primitive::cube()));
    let mut bent = primitive::cube();
    bent.name = "bent".into();
    bent.positions.iter().for_each(|_| bent.weights.push(&[Influence { joint: 0, weight: 1.0 }]));
    let bent = scene.add_mesh(bent);
    let at = |x, y, size| {
        DAffine3::from_scale_rotation_translation(DVec3::splat(size), Default::default(), DVec3::new(x, y, 0.0))
    };
    scene.place(plane, plain, at(0.0, 0.0, 8.0));
    scene.place(cube, plain, at(0.0, 1.5, 1.0));
    scene.place(plane, plain, at(2.0, 1.0, 1.0));
    scene.place(plane, masked, at(-2.0, 1.0, 1.0));
    scene.place(bent, plain, at(3.5, 1.0, 0.5)).pose = Some(Pose { rig: 0, skin: 0, moment: None });
    for _ in 0..if is_crowded { 256 } else { 0 } {
        scene.place(cube, plain, at(6.0, 0.5, 0.1));
    }
    scene
}

/// One joint that moves nothing.
fn rig() -> Rig {
    Rig {
        nodes: vec![Node { parent: None, local: Local::Parts(Parts::default()) }],
        skins: vec![Skin { joints: vec![Joint { node: 0, node_from_mesh: DAffine3::IDENTITY }] }],
        animations: Vec::new(),
    }
}

/// Such a light over the world, with all of it in its range.
fn above(light: &Light) -> Light {
    let (place, down) = (DVec3::new(0.1, 5.0, 0.2), DVec3::NEG_Y);
    let small = |size: f64| size.clamp(0.0, 0.5);
    let shape = match light.shape.clone() {
        LightShape::Point { .. } => LightShape::Point { position: place },
        LightShape::Spot { inner_angle_deg, outer_angle_deg, .. } => {
            LightShape::Spot { position: place, direction: down, inner_angle_deg, outer_angle_deg }
        }
        LightShape::Directional { angle_deg, .. } => LightShape::Directional { direction: down, angle_deg },
        LightShape::Sphere { radius, .. } => LightShape::Sphere { position: place, radius: small(radius) },
        LightShape::Ellipsoid { radii, .. } => LightShape::Ellipsoid {
            position: place,
            radii: radii.to_array().map(small).into(),
            rotation: DMat3::IDENTITY,
        },
        LightShape::Disc { radius, .. } => LightShape::Disc { position: place, direction: down, radius: small(radius) },
        LightShape::Rect { size, texture, .. } => LightShape::Rect {
            position: place,
            direction: down,
            up: DVec3::X,
            size: DVec2::from(size.to_array().map(small)),
            texture: texture.map(|_| 0),
        },
        LightShape::Line { from, to } => {
            LightShape::Line { from: place, to: place + DVec3::X * small(from.distance(to)) }
        }
        sky @ LightShape::Environment(_) => sky,
    };
    Light { shape, range: light.range.map(|_| 20.0), ..light.clone() }
}

impl Receivers {
    /// Receivers of the same kind and another size, at which nothing is seen.
    fn small_copy(&self, gpu: &Gpu, size: (u32, u32)) -> Result<Self, Error> {
        let depth = target_texture(gpu, "depth made ahead", size, 1, self.depth.texture().format());
        let normal = target_texture(gpu, "normals made ahead", size, 1, wgpu::TextureFormat::R32Uint);
        let aspect = wgpu::TextureAspect::DepthOnly;
        let depth_view = depth.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() });
        let normal_view = self.has_normals.then(|| normal.create_view(&Default::default()));
        let copy = Self::new(gpu, &depth_view, normal_view.as_ref(), size)?;
        if self.stencil.is_some() { copy.with_stencil(&depth.create_view(&Default::default())) } else { Ok(copy) }
    }
}
