//! Parallel-split shadow maps: what the camera sees is split by distance, and each part has a map of its own.
//!
//! Sources: Zhang et al., "Parallel-Split Shadow Maps for Large-Scale Virtual Environments", 2006; FE 3 and 5; SG "Extensions".

use crate::depth_maps::{BIAS, CACHE, FACES, LAYER_NAMES, LIGHTS, SHADERS, SIZE, SPLIT_FIT_SHADER};
use crate::params::{Param, ParamKind};
use crate::technique::TechniqueInfo;
use crate::techniques::find;

const SPLITS: Param = Param {
    name: "splits",
    help: "Parts of what the camera sees, each with a map of its own.",
    unit: "",
    kind: ParamKind::Int { min: 1, max: 9, default: 4 },
};

const LAMBDA: Param = Param {
    name: "lambda",
    help: "Where the parts end: at uniform (0) or logarithmic (1) distances, or in between.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 1.0, default: 0.95 },
};

const DISTANCE: Param = Param {
    name: "distance",
    help: "How far along the view shadows go; 0 for the farthest receiver.",
    unit: "m",
    kind: ParamKind::Float { min: 0.0, max: 1e12, default: 0.0 },
};

const FILTER: Param = Param {
    name: "filter",
    help: "The technique that looks the maps up, with its own defaults but for the parameters that are set here.",
    unit: "",
    kind: ParamKind::Choice {
        values: &["pcf", "shadow-map", "pcf-jitter", "pcf-blur", "pcss", "pcss-jitter", "vsm", "evsm", "msm", "esm"],
    },
};

const KERNEL: Param = Param {
    name: "kernel",
    help: "Of `pcf`, see there.",
    unit: "",
    kind: ParamKind::Choice { values: &["2x2", "3", "5", "7", "disc"] },
};

const RADIUS_M: Param = Param {
    name: "radius-m",
    help: "Radius of `pcf` and `pcf-jitter` in metres, the same in all parts; 0 for their own one in texels. Those of `pcss` follow the light.",
    unit: "m",
    kind: ParamKind::Float { min: 0.0, max: 1e6, default: 0.0 },
};

const FIT: Param = Param {
    name: "fit",
    help: "What maps cover: what a part holds of the receivers (scene-dependent), or the whole part of the view (scene-independent).",
    unit: "",
    kind: ParamKind::Choice { values: &["scene", "frustum"] },
};

const DEPTH_FIT: Param = Param {
    name: "depth-fit",
    help: "Splits the range of depths that are really visible, found on the GPU, in place of that of boxes around the receivers.",
    unit: "",
    kind: ParamKind::Switch { default: false },
};

const STABILIZE: Param = Param {
    name: "stabilize",
    help: "Keeps texels where they are in the world when the camera moves or turns, so that edges don't crawl; in place of `fit`.",
    unit: "",
    kind: ParamKind::Switch { default: false },
};

const MARGIN: Param = Param {
    name: "margin",
    help: "With `stabilize`: share of a map that the camera may move by before the map changes at all.",
    unit: "",
    kind: ParamKind::Float { min: 0.0, max: 0.5, default: 0.0 },
};

const BLEND: Param = Param {
    name: "blend",
    help: "How a part gives way to the next one over the last tenth of it: by mixing both, by a pattern of pixels, or at once.",
    unit: "",
    kind: ParamKind::Choice { values: &["lerp", "dither", "off"] },
};

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "cascaded",
    title: "Cascaded shadow maps",
    summary: "Splits what the camera sees by distance and renders a depth map for each part: fine texels near, coarse ones far away.",
    source: "FE 3 to 5; SG \"Extensions\"",
    lights: LIGHTS,
    features: wgpu::Features::empty(),
    hard: false,
    params: &[
        SIZE, SPLITS, LAMBDA, DISTANCE, FILTER, KERNEL, RADIUS_M, FIT, DEPTH_FIT, STABILIZE, MARGIN, BLEND, CACHE,
        FACES, BIAS,
    ],
    views: &LAYER_NAMES,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SPLIT_FIT_SHADER],
    readme: include_str!("README.md"),
    make: |gpu, settings| {
        let filter = find(settings.choice("filter"))?;
        filter.make(gpu, &settings.with_defaults_of(filter.params))
    },
};
