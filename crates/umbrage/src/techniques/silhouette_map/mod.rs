//! Hard shadows from a depth map whose texels are moved to where silhouettes are: edges of shadows
//! are lines within texels in place of stairs.
//!
//! Sources: Sen, Cammarano and Hanrahan, "Shadow Silhouette Maps", 2003; SG "Shadow Silhouette
//! Maps".

mod stage;

use crate::casters::Needs;
use crate::depth_maps::{
    CONTOUR_SHADER, Cover, EdgePass, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage,
};
use crate::settings::Configure;
use crate::shader::{Module, Shader};
use crate::silhouettes::FIND_SHADER;
use crate::technique::{Family, SettingsOf, Technique, TechniqueInfo, storage_buffers};
use crate::{Error, Filter, FilterUse, Gpu, settings};
use stage::SilhouetteStage;

const MODULES: &[Module] = &[
    Module { name: "silhouette_key", source: include_str!("silhouette_key.wgsl") },
    Module { name: "silhouette_cell", source: include_str!("silhouette_cell.wgsl") },
];

const POINTS: Shader = Shader::new("silhouette points", include_str!("points.wgsl")).with_modules(MODULES);

const LOOKUP: Shader = Shader::new("silhouette-map", include_str!("silhouette_map.wgsl")).with_modules(MODULES);

const PICTURES: Shader = Shader::new("silhouette pictures", include_str!("pictures.wgsl")).with_modules(MODULES);

/// Pictures over the scene, in the order of `pictures.wgsl`.
const PICTURE_NAMES: &[&str] = &["silhouettes", "silhouette-pixels", "parts"];

/// Maps, and the pictures.
static VIEWS: [&str; LAYER_NAMES.len() + PICTURE_NAMES.len()] = {
    let mut names = [PICTURE_NAMES[0]; LAYER_NAMES.len() + PICTURE_NAMES.len()];
    let mut i = 0;
    while i < names.len() {
        let picture = i.saturating_sub(LAYER_NAMES.len());
        names[i] = if i < LAYER_NAMES.len() { LAYER_NAMES[i] } else { PICTURE_NAMES[picture] };
        i += 1;
    }
    names
};

settings! {
    /// See the module.
    pub struct SilhouetteMap {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
    }
}

/// See the module.
pub const INFO: TechniqueInfo = TechniqueInfo {
    id: "silhouette-map",
    title: "Silhouette map",
    summary: "Moves the texels of a depth map to where the light sees silhouettes.",
    source: "SG \"Shadow Silhouette Maps\"; Sen et al. 2003",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    lights: LIGHTS,
    casters: Needs::Edges,
    features: wgpu::Features::empty(),
    limits: storage_buffers::<{ EdgePass::STORAGE_BUFFERS }>,
    hard: true,
    settings: SettingsOf::new::<SilhouetteMap>(),
    views: &VIEWS,
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], FIND_SHADER, CONTOUR_SHADER, POINTS, LOOKUP, PICTURES],
    readme: include_str!("README.md"),
};

impl Configure for SilhouetteMap {
    const INFO: &'static TechniqueInfo = &INFO;
    const LENT: bool = true;

    fn build(&self, gpu: &Gpu) -> Result<Box<dyn Technique>, Error> {
        self.make_on(gpu, &self.map.covering(&self.cover, self.storage.depth))
    }

    fn as_filter(&self) -> Option<&dyn Filter> {
        Some(self)
    }

    fn maps(&self) -> Option<MapSetup> {
        Some(self.map.covering(&self.cover, self.storage.depth))
    }
}

impl Filter for SilhouetteMap {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        let stage = Box::new(SilhouetteStage::new(gpu, &POINTS));
        // Depths at four corners; pixels at a silhouette read five points besides.
        let maps = MapTechnique::staged(gpu, maps, &LOOKUP, 1.5, &[], Some(stage))?.reading(16 + 20);
        Ok(Box::new(maps.in_phases().with_pictures(gpu, &PICTURES, PICTURE_NAMES)))
    }
}
