//! What a technique is.

use crate::{
    Answer, Error, FilterUse, Gpu, Lent, Needs, Param, Passes, RadianceTarget, Registry, Settings, Shader, View,
    VisibilityTarget, settings::Configure,
};
use std::any::Any;
use umbrage_core::transfer::{Transfer, Wanted};
use umbrage_core::{LightKind, LightKinds, Scene, light_view::LightView};

/// Finds which share of one light each visible point sees; or else what light goes from there to
/// the eye because of it, see [`Answer`].
///
/// Whoever uses one calls `prepare` on it, which every `dyn Technique` has, and records what that
/// returns, a [`Prepared`](crate::Prepared). The methods that take an [`InOrder`] are what a
/// technique does then: `prepare_view`, and after it with the same view one of the others or none.
pub trait Technique: Any + wgpu::WasmNotSend {
    /// Everything the CPU does for this frame: fits light views, chooses casters, makes room.
    /// Creates GPU objects only in the first frame and when a size or the kind of light changes.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a light or view that the technique can't do, [`Error::Size`]
    /// beyond the limits.
    fn prepare_view(&mut self, gpu: &Gpu, view: &View<'_>, order: InOrder) -> Result<(), Error>;

    /// Records the passes that leave the light's visibility in `visibility`.
    ///
    /// # Errors
    /// As [`Technique::prepare_view`].
    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        view: &View<'_>,
        visibility: &VisibilityTarget,
        order: InOrder,
    ) -> Result<(), Error>;

    /// Takes over settings that differ from its own in [live](Param::live) parameters only, see
    /// [`Settings::differs_live`]. False where it can't: nothing has changed then, and a new
    /// technique is to be made.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the device's limits.
    fn set(&mut self, _gpu: &Gpu, _settings: &Settings) -> Result<bool, Error> {
        Ok(false)
    }

    /// What it answers: the share of its light that points see, unless it says otherwise.
    fn answer(&self) -> Answer {
        Answer::Visibility
    }

    /// In place of [`Technique::record_visibility`] where the [answer](Technique::answer) is
    /// radiance: records the passes that leave in `radiance` the light that goes from each visible
    /// point to the eye. Such a technique [refuses](Answer::refuse) the other one.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the answer is visibility, and as [`Technique::prepare_view`].
    fn record_radiance(
        &mut self,
        _passes: &mut Passes<'_>,
        _view: &View<'_>,
        _radiance: &RadianceTarget,
        _order: InOrder,
    ) -> Result<(), Error> {
        self.answer().refuse()
    }

    /// The baked transfer of the scene that it works from; `None` for techniques that need none.
    fn wants(&self) -> Option<Wanted> {
        None
    }

    /// Works from now on with a transfer that somebody baked as it [wants](Technique::wants) of
    /// `scene`, the one that the casters are made of: an instance of the transfer is the one that
    /// [`Casters::instance`](crate::Casters::instance) tells. Where instances were moved or turned
    /// since, their own shadows and reflections go with them, and those on others stay.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for techniques that want none; [`Error::Scene`] for a transfer of
    /// other settings, or of another scene; [`Error::Size`] beyond the device's limits. The one
    /// before stays in use then.
    fn take_transfer(&mut self, _gpu: &Gpu, _transfer: &Transfer, _scene: &Scene) -> Result<(), Error> {
        let what = "baked transfer, which it has no use for".into();
        Err(Error::Unsupported { technique: "this technique".into(), what })
    }

    /// In place of [`Technique::record_visibility`] where shaders of the host's own find the
    /// visibility: records all that these read.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the technique [lends](Technique::lend) nothing.
    fn record_maps(&mut self, _passes: &mut Passes<'_>, _view: &View<'_>, _order: InOrder) -> Result<(), Error> {
        Lent::refuse("this technique")
    }

    /// What shaders of the host's own need to look this light up, see [`Inline`](crate::Inline),
    /// for the frame that was prepared last. From then on each frame that is recorded keeps what
    /// they read up to date.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the answer is no look-up of maps:
    /// [`TechniqueInfo::is_lent`] tells before.
    fn lend(&mut self, _gpu: &Gpu) -> Result<Lent, Error> {
        Lent::refuse("this technique")
    }

    /// Says which frame the next one is that is prepared, for techniques that spread work over
    /// frames and choose taps or points of the light by its number. They count by themselves where
    /// nobody says. After a cut of the camera hosts call [`Inside::forget`].
    fn set_frame(&mut self, _frame: u32) {}

    /// True where it has casters drawn that a host draws itself, see
    /// [`HostCasters`](crate::HostCasters), or needs none; others refuse views with such casters.
    fn draws_host_casters(&self) -> bool {
        false
    }

    /// What is inside, for those who measure and look.
    fn inside(&self) -> &dyn Inside;

    /// The same, to change what is measured and looked at.
    fn inside_mut(&mut self) -> &mut dyn Inside;
}

/// Proof that a technique is called in order. Only the library makes it; a technique that wraps
/// another one passes it on.
#[derive(Clone, Copy, Debug)]
pub struct InOrder(());

impl InOrder {
    pub(crate) fn new() -> Self {
        Self(())
    }
}

/// What can be measured of a technique and looked at in it. No picture depends on it.
pub trait Inside {
    /// What the last frame drew and what is held.
    fn stats(&self) -> Stats;

    /// Drops what earlier frames left to be used again: the next frame does all of the work.
    fn forget(&mut self) {}

    /// The views of the light that the last frame rendered maps for; empty for techniques without
    /// maps. The measurement uses them to tell how large a texel is on the screen.
    fn light_views(&self) -> &[LightView] {
        &[]
    }

    /// Distances along the camera's view at which one of [`Inside::light_views`] ends and the next
    /// begins, metres, ascending; empty where views are not chosen by distance. Between distances
    /// number i − 1 and i the view of layer i counts, or that of layer i − 1 where it still covers
    /// the point, see [`umbrage_core::light_view::view_at`].
    fn split_distances(&self) -> &[f64] {
        &[]
    }

    /// More numbers of the last frame, by name: casters culled and why, and the like.
    fn counts(&self) -> Vec<(&'static str, u64)> {
        Vec::new()
    }

    /// Bytes that a fragment of this render pass reads apart from the attachments that it is tested
    /// against: texels, and what is blended over; the most where fragments differ. `None` where
    /// that is not known.
    fn reads(&self, _pass: &str) -> Option<u64> {
        None
    }

    /// From the next frame on draws this one of [`TechniqueInfo::views`] where a frame does not
    /// make it anyway, and shows it among [`Inside::debug_views`]; `None` and other names end that.
    fn inspect(&mut self, _view: Option<&str>) {}

    /// Pictures of what is inside, as far as the last frame made them.
    fn debug_views(&self) -> Vec<DebugView<'_>> {
        Vec::new()
    }
}

/// Passes on what is inside the technique in a field: the body of [`Inside`] for wrappers, but for
/// what they add to.
macro_rules! inside_of {
    ($field:ident) => {
        fn light_views(&self) -> &[umbrage_core::light_view::LightView] {
            self.$field.inside().light_views()
        }

        fn split_distances(&self) -> &[f64] {
            self.$field.inside().split_distances()
        }

        fn counts(&self) -> Vec<(&'static str, u64)> {
            self.$field.inside().counts()
        }

        fn inspect(&mut self, view: Option<&str>) {
            self.$field.inside_mut().inspect(view);
        }

        fn debug_views(&self) -> Vec<$crate::technique::DebugView<'_>> {
            self.$field.inside().debug_views()
        }
    };
}
pub(crate) use inside_of;

/// Cost of a frame apart from time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stats {
    /// Draw calls.
    pub draws: u32,
    /// Triangles sent to the GPU; where the GPU chooses itself what to draw, those that it chooses
    /// from.
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

/// What kind of thing a technique is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Family {
    /// No shadow at all, to compare with.
    Control,
    /// Renders depth maps from the light and looks them up.
    DepthMaps,
    /// Filters moments of depth maps.
    MomentMaps,
    /// Fits the maps that a filter looks up: splits, warps.
    FittedMaps,
    /// Draws casters through the light on what receives their shadows.
    Projected,
    /// Counts shadow volumes.
    Volumes,
    /// Works from silhouettes or triangles and the extent of the light.
    AreaLights,
    /// Works from what was computed of the scene before.
    Baked,
}

impl Family {
    /// The technique renders maps seen from the light.
    pub fn has_maps(self) -> bool {
        matches!(self, Self::DepthMaps | Self::MomentMaps | Self::FittedMaps)
    }
}

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
    /// What kind of thing it is.
    pub family: Family,
    /// What it can look up of the maps that splits and warps fit; `None` where it has maps of its
    /// own only, or none.
    pub filter: Option<FilterUse>,
    /// The kinds of light it can do; soft kinds done as hard ones from their centre count.
    pub lights: LightKinds,
    /// What it has to know of casters.
    pub casters: Needs,
    /// Features it can't do without.
    pub features: wgpu::Features,
    /// Raises limits to what it can't do without, such as [`storage_buffers`].
    pub limits: fn(&mut wgpu::Limits),
    /// True where it gives 0 or 1 from one point of the light, so that `light_samples` makes sense.
    pub hard: bool,
    /// Its settings, see [`SettingsOf::new`].
    pub settings: SettingsOf,
    /// Names of the pictures of its inside; a light may come without some of them.
    pub views: &'static [&'static str],
    /// Its shaders.
    pub shaders: &'static [Shader],
    /// Its README.
    pub readme: &'static str,
}

/// For [`TechniqueInfo::limits`]: so many storage buffers in one stage of a shader. WebGPU promises
/// eight.
pub fn storage_buffers<const COUNT: u32>(limits: &mut wgpu::Limits) {
    limits.max_storage_buffers_per_shader_stage = COUNT;
}

/// The type of a technique's settings.
#[derive(Clone, Copy)]
pub struct SettingsOf {
    params: fn() -> &'static [Param],
    default: fn() -> Settings,
    answer: Answer,
    is_lent: bool,
}

impl SettingsOf {
    /// Those of `T`.
    pub const fn new<T: Configure>() -> Self {
        Self { params: T::params, default: || T::default().into(), answer: T::ANSWER, is_lent: T::LENT }
    }
}

impl std::fmt::Debug for TechniqueInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("TechniqueInfo").field("id", &self.id).finish_non_exhaustive()
    }
}

impl TechniqueInfo {
    /// Its parameters.
    pub fn params(&self) -> &'static [Param] {
        (self.settings.params)()
    }

    /// What it answers; as [`Technique::answer`] before there is one.
    pub fn answer(&self) -> Answer {
        self.settings.answer
    }

    /// Whether shaders of a host's own can look its maps up, see [`Technique::lend`].
    pub fn is_lent(&self) -> bool {
        self.settings.is_lent
    }

    /// Every parameter at its default.
    pub fn default_settings(&self) -> Settings {
        (self.settings.default)()
    }

    /// Checked settings from pairs of name and value; what is not named keeps its default. Filters
    /// are those that are built in; [`Registry::settings`] knows others too.
    ///
    /// # Errors
    /// [`Error::Unknown`] and [`Error::Setting`].
    pub fn settings(&'static self, set: &[(String, String)]) -> Result<Settings, Error> {
        Registry::default().with(self).settings(self.id, set)
    }

    /// Whether the device has what the technique can't do without.
    ///
    /// # Errors
    /// [`Error::Unsupported`] naming what is lacking, [`Error::DeviceLost`].
    pub fn check(&self, gpu: &Gpu) -> Result<(), Error> {
        gpu.check_loss()?;
        if !gpu.has(self.features) {
            return self.refuse(format!("which lacks {:?}", self.features - gpu.device.features()));
        }
        let (limits, mut needed) = (gpu.device.limits(), gpu.device.limits());
        (self.limits)(&mut needed);
        let mut lacking = Vec::new();
        needed.check_limits_with_fail_fn(&limits, false, |name, needed, limit| {
            lacking.push(format!("whose {name} is {limit} and has to be {needed}"));
        });
        if lacking.is_empty() { Ok(()) } else { self.refuse(lacking.join(", ")) }
    }

    fn refuse(&self, lack: String) -> Result<(), Error> {
        Err(Error::Unsupported { technique: self.id.into(), what: format!("this adapter, {lack}") })
    }

    /// Whether it can do lights of this kind.
    ///
    /// # Errors
    /// [`Error::Unsupported`] naming the kind.
    pub fn supports(&self, kind: LightKind) -> Result<(), Error> {
        if self.lights.contains(kind) {
            return Ok(());
        }
        let what = match (kind, self.answer()) {
            (LightKind::Environment, _) => {
                let others: Vec<&str> = Registry::default().of_radiance().iter().map(|info| info.id).collect();
                format!("the environment, whose answer is radiance; choose {}", others.join(" or "))
            }
            (_, Answer::Radiance) => {
                format!("{} lights, whose answer is visibility; its light is the environment", kind.name())
            }
            _ => format!("{} lights", kind.name()),
        };
        Err(Error::Unsupported { technique: self.id.into(), what })
    }
}
