//! Which techniques are compiled, with which settings and lights.

use anyhow::{Context, Result};
use umbrage::core::glam::{DVec2, DVec3};
use umbrage::core::{Camera, Light, LightShape};
use umbrage::{Error, Gpu, Param, ParamKind, PipelineParts, Receivers, Registry, Technique, TechniqueInfo, baseline};

/// Makes a technique for a device.
type Make = dyn Fn(&Gpu) -> Result<Box<dyn Technique>, Error>;

/// A technique and settings under one name, as the command writes it.
pub struct Set {
    pub name: String,
    make: Box<Make>,
    /// Lights are chosen by it where not all are tried.
    number: usize,
}

impl Set {
    /// Whether it is a technique's defaults.
    pub fn is_default(&self) -> bool {
        self.number == 0
    }
}

/// A technique at its defaults, then with each of its choices, one at a time.
pub fn sets(info: &TechniqueInfo) -> Result<Vec<Set>> {
    let registry = Registry::default();
    let words = |param: &Param| match param.kind {
        ParamKind::Switch { .. } => vec!["on", "off"],
        kind => kind.words(&registry),
    };
    let one = |param: &Param| words(param).iter().map(|word| format!("{}:{}={word}", info.id, param.name)).collect();
    let choices = info.params().iter().flat_map(|param| -> Vec<String> { one(param) });
    let names = std::iter::once(info.id.to_string()).chain(choices);
    let set = |(number, name): (usize, String)| {
        let settings = umbrage::parse(&name)?;
        Ok(Set { make: Box::new(move |gpu| settings.make(gpu)), name, number })
    };
    names.enumerate().map(set).collect()
}

/// What the costs of all techniques are compared with: a pass that reads depth and writes
/// visibility, and one map with one comparison.
pub fn yardsticks() -> [Set; 2] {
    let floor = |gpu: &Gpu| Ok(baseline::floor(gpu));
    let bare = |gpu: &Gpu| baseline::bare_minimum(gpu, 64, 1);
    [
        Set { name: "floor".into(), make: Box::new(floor), number: 0 },
        Set { name: "bare-minimum".into(), make: Box::new(bare), number: 0 },
    ]
}

/// What the technique has compiled: for lights of all kinds at its defaults, otherwise for some of
/// them, which take turns.
pub fn pipelines(set: &Set) -> Result<Vec<PipelineParts>> {
    let gpu = Gpu::request(Some("llvmpipe")).context("a device that runs is needed, too: Mesa's llvmpipe")?;
    let receivers = receivers(&gpu)?;
    let view = Camera::default().view(8, 8);
    let takes_turn = |light: usize| set.is_default() || light % 4 == set.number % 4;
    for (_, light) in lights().into_iter().enumerate().filter(|(light, _)| takes_turn(*light)) {
        let mut technique = (set.make)(&gpu)?;
        match umbrage::warm_up(&gpu, &mut *technique, &[light], &receivers, &view) {
            // Some techniques are for some kinds of light alone.
            Ok(()) | Err(Error::Unsupported { .. }) => {}
            Err(error) => return Err(error).with_context(|| set.name.clone()),
        }
    }
    Ok(gpu.pipelines())
}

/// A light of each kind, one that is hard and one that is soft.
fn lights() -> Vec<Light> {
    let (position, direction) = (DVec3::new(0.5, 3.0, 0.5), DVec3::NEG_Y);
    let shapes = [
        LightShape::Point { position },
        LightShape::Spot { position, direction, inner_angle_deg: 40.0, outer_angle_deg: 50.0 },
        LightShape::Directional { direction, angle_deg: 0.0 },
        LightShape::Directional { direction, angle_deg: 2.0 },
        LightShape::Sphere { position, radius: 0.3 },
        LightShape::Disc { position, direction, radius: 0.3 },
        LightShape::Rect { position, direction, up: DVec3::X, size: DVec2::splat(0.5), texture: None },
        LightShape::Line { from: position, to: position + 0.5 * DVec3::X },
    ];
    shapes.map(Light::new).into()
}

fn receivers(gpu: &Gpu) -> Result<Receivers> {
    let texture = |format| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        })
    };
    let depth = texture(wgpu::TextureFormat::Depth32Float).create_view(&Default::default());
    let normal = texture(wgpu::TextureFormat::R32Uint).create_view(&Default::default());
    Ok(Receivers::new(gpu, &depth, Some(&normal), (8, 8))?)
}
