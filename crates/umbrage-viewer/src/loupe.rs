//! All that is known of one pixel, by rays alone: nothing is read back, and no frame waits.

use crate::background::Background;
use std::sync::Arc;
use umbrage_core::glam::{DVec2, DVec3};
use umbrage_core::light_view::{LightView, texel_across, texel_on_screen, view_at};
use umbrage_core::{Camera, Light, LightShape, Texture};
use umbrage_reference::closed_form::penumbra_width;
use umbrage_reference::{Blocker, LightSeen, Options, Shown, Tracer};

/// Places across and down the picture of the light; fewer where frames wait for it.
const LIGHT_SIZE: u32 = if cfg!(target_family = "wasm") { 32 } else { 96 };
/// Points of the light for the truth about the pixel.
const SAMPLES: u32 = 1024;

/// Where a technique's maps lie.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Maps {
    pub views: Vec<LightView>,
    pub splits: Vec<f64>,
    /// The camera that they were fitted to.
    pub camera: Camera,
}

/// What the loupe is held over.
#[derive(Clone)]
pub(crate) struct Place {
    pub tracer: Arc<Tracer>,
    pub textures: Arc<[Texture]>,
    /// The camera of the picture.
    pub camera: Camera,
    pub size: (u32, u32),
    pub pixel: (u32, u32),
    pub light: Light,
    pub maps: Arc<Maps>,
}

impl PartialEq for Place {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.tracer, &other.tracer)
            && Arc::ptr_eq(&self.textures, &other.textures)
            && Arc::ptr_eq(&self.maps, &other.maps)
            && (&self.camera, self.size, self.pixel, &self.light)
                == (&other.camera, other.size, other.pixel, &other.light)
    }
}

/// The map at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Texel {
    pub layer: u32,
    /// Texels from the left and the top of the map.
    pub place: DVec2,
    /// Of the map.
    pub size: u32,
    /// Pixels of the screen that it reaches over.
    pub on_screen: f64,
    /// Metres that it reaches over, across the light.
    pub across: f64,
    /// What half a texel does to the depth of the slope there, metres.
    pub bias: f64,
}

/// What is known of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Known {
    pub shown: Shown,
    /// To the light's centre, metres; `None` for parallel light.
    pub distance: Option<f64>,
    /// Of the normal and the way to the light's centre.
    pub cosine: f64,
    pub visibility: f64,
    /// On the way to the light's centre.
    pub blocker: Option<Blocker>,
    /// Of the shadow of that blocker, metres.
    pub penumbra: Option<f64>,
    /// Where a map covers the point.
    pub texel: Option<Texel>,
    pub light: LightSeen,
}

impl Known {
    /// Looks at a place; `None` where it shows nothing.
    fn of(place: &Place) -> Option<Self> {
        let Place { tracer, textures, camera, size, pixel, light, maps } = place;
        let shown = tracer.look(camera, *pixel, *size)?;
        let Shown { surface, .. } = shown;
        let way = light.shape.to_center(surface.position);
        let distance = (light.shape.center().w != 0.0).then(|| way.length());
        let cosine = surface.normal.dot(way.normalize_or_zero());
        let options = Options { samples: SAMPLES, ..Options::default() };
        let visibility = tracer.visibility_at(&surface, light, textures, &options, 0);
        let blocker = if light.casts { tracer.blocker(&surface, light.shape.center()) } else { None };
        let beyond = |blocker: &Blocker| blocker.distance > 0.0 && light.shape.kind().is_soft();
        let penumbra = blocker
            .filter(beyond)
            .map(|b| penumbra_width(radius(&light.shape), distance.unwrap_or(f64::INFINITY), b.distance));
        let texel = texel(maps, (camera, *size), &shown, way);
        let light = tracer.light_seen(&surface, light, textures, LIGHT_SIZE);
        Some(Self { shown, distance, cosine, visibility, blocker, penumbra, texel, light })
    }
}

/// That of the light, or the tangent of half a sun's angle.
fn radius(shape: &LightShape) -> f64 {
    match shape {
        LightShape::Directional { angle_deg, .. } => (angle_deg.to_radians() * 0.5).tan(),
        _ => shape.radius(),
    }
}

fn texel(maps: &Maps, (camera, size): (&Camera, (u32, u32)), shown: &Shown, way: DVec3) -> Option<Texel> {
    let (point, normal) = (shown.surface.position, shown.surface.normal);
    let fitted = maps.camera.view(size.0, size.1);
    let view = view_at(&maps.views, &maps.splits, &fitted, point)?;
    let place = texel_of(view, point)?;
    // The screen may be another one's than that the maps were fitted to.
    let view_alone = std::slice::from_ref(view);
    let on_screen = texel_on_screen(view_alone, &[], &camera.view(size.0, size.1), size, point, normal)?;
    let across = texel_across(view, point, way);
    let cosine = normal.dot(way.normalize_or_zero()).abs();
    let bias = 0.5 * across * (1.0 - cosine * cosine).max(0.0).sqrt() / cosine;
    Some(Texel { layer: view.layer, place, size: view.size, on_screen, across, bias })
}

/// Where in the map of a view a point of the world lies, texels from its left top corner.
pub(crate) fn texel_of(view: &LightView, point: DVec3) -> Option<DVec2> {
    let ndc = view.project(point)?;
    Some(DVec2::new(ndc.x + 1.0, 1.0 - ndc.y) * (0.5 * f64::from(view.size)))
}

/// A pixel, and what is known of it; `None` where it shows nothing.
pub(crate) type Held<'a> = ((u32, u32), Option<&'a Arc<Known>>);

/// One place after the other, the newest that was asked for.
#[derive(Default)]
pub(crate) struct Loupe {
    asked: Option<Place>,
    working: Background<(Place, Option<Known>)>,
    /// What was found last, and where.
    found: Option<(Place, Option<Arc<Known>>)>,
}

impl Loupe {
    /// Holds it over a place.
    pub fn hold(&mut self, place: Option<Place>) {
        if let Some((place, known)) = self.working.take() {
            self.found = Some((place, known.map(Arc::new)));
        }
        self.asked = place;
        let is_new = self.found.as_ref().map(|(place, _)| place) != self.asked.as_ref();
        if let Some(place) = self.asked.clone().filter(|_| is_new && !self.working.is_under_way()) {
            self.working.start(move || {
                let known = Known::of(&place);
                (place, known)
            });
        }
    }

    /// The newest that is known, and of which pixel; what is asked for now may still be under way.
    pub fn known(&self) -> Option<Held<'_>> {
        let (place, known) = self.found.as_ref()?;
        Some((place.pixel, known.as_ref()))
    }

    pub fn is_under_way(&self) -> bool {
        self.working.is_under_way()
    }
}
