//! What a technique is.

use crate::{
    error::Error, gpu::Gpu, params::Param, params::ParamKind, params::Settings, passes::Passes, shader::Shader,
    techniques::techniques, view::View, visibility::VisibilityTarget,
};
use umbrage_core::{LightKind, LightKinds, light_view::LightView};

/// Finds which share of one light each visible point sees.
///
/// A frame is `prepare`, then `record`; both with the same view.
pub trait Technique: Send {
    /// Everything the CPU does for this frame: fits light views, chooses casters, makes room. Creates GPU objects only
    /// in the first frame and when a size or the kind of light changes.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a light or view that the technique can't do, [`Error::Size`] beyond the limits.
    fn prepare(&mut self, gpu: &Gpu, view: &View<'_>) -> Result<(), Error>;

    /// Records the passes that leave the light's visibility in `visibility`.
    ///
    /// # Errors
    /// As [`Technique::prepare`].
    fn record(&mut self, passes: &mut Passes<'_>, view: &View<'_>, visibility: &VisibilityTarget) -> Result<(), Error>;

    /// In place of `prepare` and `record` of one light: leaves 0 in `visibility` where a point is in the shadow of any of the
    /// views' lights, else 1. Known to be wrong for more than one light, and kept to be compared with (PX 3.4). The views differ in
    /// nothing but the light.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a technique that does not know this, and as [`Technique::prepare`].
    fn record_overlay(
        &mut self,
        _gpu: &Gpu,
        _passes: &mut Passes<'_>,
        _views: &[View<'_>],
        _visibility: &VisibilityTarget,
    ) -> Result<(), Error> {
        let (technique, what) = ("this technique".into(), "the overlay of all lights at once; choose `volume`".into());
        Err(Error::Unsupported { technique, what })
    }

    /// Drops what earlier frames left to be used again: the next frame does all of the work.
    fn forget(&mut self) {}

    /// What the last frame drew and what is held.
    fn stats(&self) -> Stats;

    /// The views of the light that the last frame rendered maps for; empty for techniques without maps. The
    /// measurement uses them to tell how large a texel is on the screen.
    fn light_views(&self) -> &[LightView] {
        &[]
    }

    /// Distances along the camera's view at which one of [`Technique::light_views`] gives way to the next, metres, ascending;
    /// empty where views are not chosen by that. Between distances number i − 1 and i the view of layer i counts, or that of layer i − 1
    /// where it goes on, see [`umbrage_core::light_view::view_at`].
    fn split_distances(&self) -> &[f64] {
        &[]
    }

    /// What else the last frame came to, by name: casters culled and why, and the like.
    fn counts(&self) -> Vec<(&'static str, u64)> {
        Vec::new()
    }

    /// From the next frame on draws this one of [`TechniqueInfo::views`] where a frame does not make it anyway, and shows it
    /// among [`Technique::debug_views`]; `None` and other names end that.
    fn inspect(&mut self, _view: Option<&str>) {}

    /// Pictures of what is inside, as far as the last frame made them.
    fn debug_views(&self) -> Vec<DebugView<'_>> {
        Vec::new()
    }
}

/// Cost of a frame apart from time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Draw calls.
    pub draws: u32,
    /// Triangles sent to the GPU; where the GPU chooses itself what to draw, those that it chooses from.
    pub triangles: u64,
    /// Casters drawn, counted once for every view of the light.
    pub casters_drawn: u32,
    /// Casters left out because no view of the light sees them.
    pub casters_culled: u32,
    /// GPU memory held by the technique, without casters, receivers and target.
    pub bytes: u64,
}

/// A texture worth looking at.
#[derive(Clone, Copy, Debug)]
pub struct DebugView<'a> {
    /// What users ask for, such as `map-0`.
    pub name: &'static str,
    /// The texture: depth, one float channel, or 8-bit colour.
    pub texture: &'a wgpu::Texture,
    /// Which layer of it.
    pub layer: u32,
}

/// Makes a technique from checked settings.
pub type Make = fn(&Gpu, &Settings) -> Result<Box<dyn Technique>, Error>;

/// Everything the program knows of a technique; one constant in its folder.
pub struct TechniqueInfo {
    /// What users type.
    pub id: &'static str,
    /// What people read.
    pub title: &'static str,
    /// One sentence.
    pub summary: &'static str,
    /// Where it is from.
    pub source: &'static str,
    /// The kinds of light it can do; soft kinds done as hard ones from their centre count.
    pub lights: LightKinds,
    /// Features it can't do without.
    pub features: wgpu::Features,
    /// True where it gives 0 or 1 from one point of the light, so that `light_samples` makes sense.
    pub hard: bool,
    /// Its parameters.
    pub params: &'static [Param],
    /// Names of the pictures of its inside; a light may come without some of them.
    pub views: &'static [&'static str],
    /// Its shaders.
    pub shaders: &'static [Shader],
    /// Its README.
    pub readme: &'static str,
    /// Makes one.
    pub make: Make,
}

impl std::fmt::Debug for TechniqueInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TechniqueInfo").field("id", &self.id).finish_non_exhaustive()
    }
}

impl TechniqueInfo {
    /// Checked settings from pairs of name and value; what is not named keeps its default.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Setting`].
    pub fn settings(&self, set: &[(String, String)]) -> Result<Settings, Error> {
        Settings::parse(self.id, self.params, set).map_err(|error| self.naming_others(error))
    }

    /// A word that other techniques know for the same parameter: their names are the way out.
    fn naming_others(&self, mut error: Error) -> Error {
        if let Error::Setting { name, value, expected, .. } = &mut error {
            let knows = |p: &Param| {
                p.name == name && matches!(p.kind, ParamKind::Choice { values } if values.contains(&value.as_str()))
            };
            let others: Vec<_> = techniques().iter().filter(|t| t.params.iter().any(knows)).map(|t| t.id).collect();
            if !others.is_empty() {
                expected.push_str(&format!(
                    "; choose one of these, or a technique that can do `{value}`: {}",
                    others.join(", ")
                ));
            }
        }
        error
    }

    /// A technique with these settings.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the device lacks a feature; [`Error::Size`] beyond its limits.
    pub fn make(&self, gpu: &Gpu, settings: &Settings) -> Result<Box<dyn Technique>, Error> {
        if !gpu.has(self.features) {
            let what = format!("this adapter, which lacks {:?}", self.features - gpu.device.features());
            return Err(Error::Unsupported { technique: self.id.into(), what });
        }
        (self.make)(gpu, settings)
    }

    /// Whether it can do lights of this kind.
    ///
    /// # Errors
    /// [`Error::Unsupported`] naming the kind.
    pub fn supports(&self, kind: LightKind) -> Result<(), Error> {
        if self.lights.contains(kind) {
            return Ok(());
        }
        Err(Error::Unsupported { technique: self.id.into(), what: format!("{} lights", kind.name()) })
    }
}
