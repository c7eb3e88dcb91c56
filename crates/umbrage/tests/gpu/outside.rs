//! A filter from outside of the library: one shader and one declaration, then it looks up splits
//! and warps like any other.

use crate::common::{gpu, scene};
use umbrage::core::{Image, Scene};
use umbrage::depth_maps::{Cover, LAYER_NAMES, LIGHTS, Map, MapSetup, MapTechnique, SHADERS, Storage};
use umbrage::{
    Configure, Error, Family, Filter, FilterUse, Gpu, Registry, Settings, SettingsOf, Shader, Technique, TechniqueInfo,
};
use umbrage_renderer::{LightPass, Renderer};

const SHADER: Shader = Shader::new("veil", include_str!("veil.wgsl"));

umbrage::settings! {
    /// A shadow map whose shadows let some light through.
    struct Veil {
        #[flatten] map: Map,
        #[flatten] cover: Cover,
        #[flatten] storage: Storage,
        /// Share of the light that shadows let through.
        through: f64 = 0.5, in 0.0..=1.0,
    }
}

static INFO: TechniqueInfo = TechniqueInfo {
    id: "veil",
    title: "Veil",
    summary: "A shadow map whose shadows let some light through.",
    source: "this test",
    family: Family::DepthMaps,
    filter: Some(FilterUse { warped: true }),
    settings: SettingsOf::new::<Veil>(),
    shaders: &[SHADERS[0], SHADERS[1], SHADERS[2], SHADER],
    views: &LAYER_NAMES,
    lights: LIGHTS,
    casters: umbrage::Needs::Depth,
    ..umbrage::techniques::none::INFO
};

impl Configure for Veil {
    const INFO: &'static TechniqueInfo = &INFO;

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

impl Filter for Veil {
    fn make_on(&self, gpu: &Gpu, maps: &MapSetup) -> Result<Box<dyn Technique>, Error> {
        Ok(Box::new(MapTechnique::new(gpu, maps, &SHADER, 0.5, &[("THROUGH", self.through)])?))
    }
}

fn visibility(gpu: &Gpu, scene: &Scene, settings: &Settings) -> Image<f32> {
    let passes = vec![LightPass { light: 0, technique: settings.make(gpu).unwrap() }];
    let mut renderer = Renderer::new(gpu, scene, 96, 72, passes).unwrap();
    renderer.frame(&scene.camera).unwrap();
    renderer.visibility(0).unwrap()
}

#[test]
fn a_filter_from_outside_looks_up_splits_and_warps() {
    let (gpu, scene) = (gpu(), scene("duelling-frusta", 0.3));
    let registry = Registry::default().with(&INFO);
    for on in ["", "cascaded", "cascaded:splits=2:blend=off", "psm", "lispsm", "plane-optimal"] {
        let parse = |filter: &str| {
            let text = if on.is_empty() { filter.to_string() } else { format!("{on}:filter={filter}") };
            registry.parse(&text).unwrap()
        };
        let (veiled, hard) = (parse("veil"), parse("shadow-map"));
        assert!(veiled.to_string().contains("veil"), "{veiled}");
        let [veiled, hard] = [veiled, hard].map(|settings| visibility(&gpu, &scene, &settings));
        let mut shadowed = 0;
        for (veiled, hard) in veiled.data.iter().zip(&hard.data) {
            // A surface that faces away from the light has none of it, whatever a filter says.
            let faces_away = (*veiled, *hard) == (0.0, 0.0);
            let share = 0.5 + 0.5 * hard;
            assert!(faces_away || (veiled - share).abs() < 2e-3, "{on}: {veiled} where the hard shadow has {hard}");
            shadowed += usize::from(!faces_away && *hard < 0.5);
        }
        assert!(shadowed > 50, "{on}: only {shadowed} pixels are in shadow");
    }
}

#[test]
fn a_registry_without_it_does_not_know_it() {
    let registry = Registry::default().with(&INFO);
    assert!(registry.filters(true).any(|info| info.id == "veil") && registry.find("veil").is_ok());
    let text = umbrage::parse("cascaded:filter=veil").unwrap_err().to_string();
    assert!(text.contains("`veil` is not in its range (pcf, shadow-map"), "{text}");
    let text = registry.parse("lispsm:filter=pcss").unwrap_err().to_string();
    assert!(text.contains("smoothies, veil"), "warps can't be looked up by `pcss`: {text}");
}

#[test]
fn typed_settings_out_of_range_name_the_field() {
    let gpu = gpu();
    let error = Veil { through: 1.5, ..Veil::default() }.make(&gpu).err().expect("an error").to_string();
    assert!(error.contains("`through` of veil") && error.contains("0 to 1"), "{error}");
}
