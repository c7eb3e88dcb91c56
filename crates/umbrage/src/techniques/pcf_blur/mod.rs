//! Percentage-closer filtering, blurred on the screen: soft edges for two cheap passes, and a halo unless the blur keeps to the
//! surfaces.
//!
//! Sources: ZA 3.3; Shastry, "Soft-Edged Shadows", 2005; weights by surface after Tomasi and Manduchi 1998.

mod blur;
mod technique;
mod tiles;

use crate::depth_maps::{
    BIAS, CACHE, DEPTH, FACES, FOCUS, LAYER_NAMES, LIGHTS, MapTechnique, OMNI, SHADERS, SIZE,
};
use crate::params::{Param, ParamKind};
use crate::shader::{Module, Shader};
use crate::technique::TechniqueInfo;
use blur::{Blur, ScreenBlur};
use technique::Blurred;

const SOURCE_SHADER: Shader = Shader::new("pcf-blur source", include_str!("source.wgsl"));

const MODULES: &[Module] = &[
    Module { name: "head", source: include_str!("head.wgsl") },
    Module { name: "quads", source: include_str!("quads.wgsl") },
    Module { name: "blur", source: include_str!("blur.wgsl") },
];

const fn shader(name: &'static str, source: &'static str) -> Shader {
    let constants = &[("OWN_SHADOW", OWN_SHADOW)];
    Shader::new(name, source).with_modules(MODULES).with_layouts(&[Blur::LAYOUT]).with_constants(constants)
}

const TILES_SHADER: Shader = shader("pcf-blur tiles", include_str!("tiles.wgsl"));
const ROWS_SHADER: Shader = shader("pcf-blur rows", include_str!("rows.wgsl"));
const COLUMNS_SHADER: Shader = shader("pcf-blur columns", include_str!("columns.wgsl"));
const RESULT_SHADER: Shader = shader("pcf-blur result", include_str!("result.wgsl"));

const SOURCE: Param = Param {
    name: "source",
    help: "What is blurred: percentage-closer filtering with 3×3 compares, or one compare.",
    unit: "",
    kind: ParamKind::Choice { values: &["3", "hard"] },
};

const RADIUS: Param = Param {
    name: "radius",
    help: "Reach of the blur, two standard deviations.",
    unit: "pixels",
    kind: ParamKind::Float { min: 0.0, max: 64.0, default: 3.0 },
};

const DEPTH_AWARE: Param = Param {
    name: "depth-aware",
    help: "Blurs only along a surface; off, light and shadow of one surface bleed into what is behind or before it on the \
           screen.",
    unit: "",
    kind: ParamKind::Switch { default: true },
};

/// What the source draws where a surface faces away from the light, for the blur to know: next to no light in place of none. As in
/// `head.wgsl`.
const OWN_SHADOW: f64 = 6.103515625e-5;

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "pcf-blur",
    title: "Blurred percentage-closer filtering",
    summary: "Blurs the visibility picture itself, along the surfaces it shows: soft edges of constant width on the screen.",
    source: "ZA 3.3",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[SIZE, SOURCE, RADIUS, DEPTH_AWARE, FACES, OMNI, DEPTH, FOCUS, CACHE, BIAS],
    views: &LAYER_NAMES,
    shaders: &[
        SHADERS[0],
        SHADERS[1],
        SHADERS[2],
        SOURCE_SHADER,
        TILES_SHADER,
        ROWS_SHADER,
        COLUMNS_SHADER,
        RESULT_SHADER,
    ],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let is_hard = settings.choice("source") == "hard";
        let reach = if is_hard { 0.5 } else { 2.0 };
        let constants = [("IS_HARD", f64::from(u8::from(is_hard))), ("OWN_SHADOW", OWN_SHADOW)];
        let source = MapTechnique::new(gpu, settings, &SOURCE_SHADER, reach, &constants)?;
        let radius = settings.float("radius");
        let blur = (radius > 0.0).then(|| ScreenBlur::new(gpu, radius, settings.switch("depth-aware")));
        Ok(Box::new(Blurred::new(source, blur)))
    },
};
