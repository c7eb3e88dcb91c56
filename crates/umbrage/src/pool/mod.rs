//! One budget of bytes for the maps of all lights. Each light gets maps as large as the screen has
//! use for, within what its settings allow, and lights that light nothing seen give theirs back.

mod plan;

use crate::settings::{Settings, Value};
use crate::technique::Technique;
use crate::{Error, Gpu, Registry, View};
use plan::{Price, Share, TRIED, divide, wanted};
use umbrage_core::LightKind;

/// Divides a budget of bytes among the maps of many lights.
///
/// Before the techniques of a frame are prepared, a host shows all of its lights to
/// [`MapPool::share`], which changes the size of maps where there is need: by powers of two, down
/// from what the settings of each light ask for. A technique takes a new size in place where it
/// can ([`Technique::set`]) and is made anew elsewhere; neither compiles anything. In a frame that
/// needs what the one before needed nothing is made.
///
/// A light is important by how large its range is on the screen; a directional light, and one
/// without a range, always is.
#[derive(Debug)]
pub struct MapPool {
    bytes: u64,
    lights: Vec<Member>,
    shares: Vec<Share>,
    sizes: Vec<u32>,
    /// What lights of these settings and this kind take.
    prices: Prices,
    /// How many bytes `sizes` are for.
    divided: Option<u64>,
}

/// By settings and kind of light.
type Prices = Vec<(Settings, LightKind, Price)>;

/// A light of a host, as [`MapPool::share`] takes it.
pub struct PooledLight<'a> {
    /// The view that is to be prepared.
    pub view: View<'a>,
    /// What the technique is made of; its `size` is the most that the light gets.
    pub settings: &'a Settings,
    /// The technique.
    pub technique: &'a mut Box<dyn Technique>,
}

/// What is known of a light.
#[derive(Debug, Default)]
struct Member {
    made_for: Option<(Settings, LightKind)>,
    share: Share,
    /// Its technique has yet to get maps of `size`.
    is_new: bool,
    /// Of its maps; 0 where it has none.
    size: u32,
    /// Frames since it lit something that was seen.
    unseen: u32,
}

/// Frames for which a light keeps its maps that lights nothing seen, where there is room: the
/// camera may turn back.
const KEPT: u32 = 60;

/// Settings whose prices are kept.
const PRICES: usize = 64;

impl MapPool {
    /// Of so many bytes. What [`crate::Stats::bytes`] counts of a technique with maps is paid from
    /// it.
    pub fn new(bytes: u64) -> Self {
        let (lights, shares, sizes, prices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { bytes, lights, shares, sizes, prices, divided: None }
    }

    /// From the next frame on has so many bytes.
    pub fn set_bytes(&mut self, bytes: u64) {
        self.bytes = bytes;
    }

    /// Bytes in all.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// The size of the maps of light number `light` of the last [`MapPool::share`]; `None` for a
    /// light without maps.
    pub fn size(&self, light: usize) -> Option<u32> {
        self.lights.get(light).map(|member| member.size).filter(|size| *size > 0)
    }

    /// Gives all lights of a frame the maps that they get. They come in the same order in every
    /// frame. Techniques whose settings have no `size` that can change while they run are left as
    /// they are and cost nothing.
    ///
    /// # Errors
    /// [`Error::Scene`] where the smallest maps take more than there is, and those of making and
    /// preparing a technique.
    pub fn share(&mut self, gpu: &Gpu, lights: &mut [PooledLight<'_>]) -> Result<(), Error> {
        self.lights.resize_with(lights.len(), Member::default);
        for (light, member) in lights.iter().zip(&mut self.lights) {
            if let Some(most) = most(light.settings) {
                member.look_at(gpu, light, most, &mut self.prices)?;
            }
        }
        if !self.divide(KEPT) && !self.divide(0) {
            let (count, bytes) = (self.lights.len(), self.bytes);
            return Err(Error::Scene(format!(
                "the smallest maps of {count} lights take more than the pool's {bytes} bytes; give it more, or let \
                 fewer lights cast shadows"
            )));
        }
        let sized = lights.iter_mut().zip(&mut self.lights).zip(&self.sizes);
        for ((light, member), size) in sized {
            if member.size != *size || member.is_new {
                member.resize(gpu, light, *size)?;
            }
        }
        Ok(())
    }

    /// Chooses sizes; lights that were not seen for so many frames give theirs back.
    fn divide(&mut self, kept: u32) -> bool {
        let share = |member: &Member| {
            let is_kept = member.unseen == 0 || (member.size > 0 && member.unseen <= kept);
            Share { wanted: if is_kept { member.share.wanted } else { 0 }, ..member.share }
        };
        let is_known =
            self.divided == Some(self.bytes) && self.lights.iter().map(share).eq(self.shares.iter().copied());
        if is_known {
            return true;
        }
        self.shares.clear();
        self.shares.extend(self.lights.iter().map(share));
        let fits = divide(&self.shares, self.bytes, &mut self.sizes);
        self.divided = fits.then_some(self.bytes);
        fits
    }
}

impl Member {
    /// Finds out what the light wants and what that takes.
    fn look_at(&mut self, gpu: &Gpu, light: &PooledLight<'_>, most: u32, prices: &mut Prices) -> Result<(), Error> {
        let kind = light.view.light.shape.kind();
        let is_known = |(settings, of): &(Settings, LightKind)| *of == kind && settings == light.settings;
        if !self.made_for.as_ref().is_some_and(is_known) {
            let made_for = Some((light.settings.clone(), kind));
            *self = Self { made_for, is_new: true, size: self.size, unseen: self.unseen, ..Self::default() };
        }
        let held = light.technique.inside().stats().bytes;
        if self.size == 0 {
            self.share.idle = held;
        } else if self.unseen == 0 && !self.is_new {
            self.learn(held);
        }
        let Some(need) = need(&light.view) else {
            self.unseen = self.unseen.saturating_add(1);
            return Ok(());
        };
        self.unseen = 0;
        if self.share.price == Price::default() {
            let price = price(gpu, light, prices)?;
            let extra = bytes(gpu, light, TRIED[0])?.saturating_sub(price.of(TRIED[0]));
            self.share = Share { price, extra, ..self.share };
        }
        self.share.wanted = wanted(need, self.share.wanted, most);
        Ok(())
    }

    /// What has moved takes more, for instance, than what has always stood still.
    fn learn(&mut self, held: u64) {
        let known = self.share.price.of(self.size) + self.share.extra;
        (self.share.more, self.share.at) = (held.saturating_sub(known), self.size);
    }

    fn resize(&mut self, gpu: &Gpu, light: &mut PooledLight<'_>, size: u32) -> Result<(), Error> {
        (self.size, self.is_new) = (size, false);
        // Whoever prepares a light all the same that lights nothing gets the smallest maps.
        let settings = sized(light.settings, if size == 0 { TRIED[0] } else { size })?;
        if size == 0 || !light.technique.set(gpu, &settings)? {
            *light.technique = settings.make(gpu)?;
        }
        Ok(())
    }
}

/// The size that settings ask for, where it can change while a technique runs.
fn most(settings: &Settings) -> Option<u32> {
    let is_live = settings.info().params().iter().any(|param| param.name == "size" && param.live);
    match settings.get("size").filter(|_| is_live)? {
        Value::Int(size) => u32::try_from(size).ok(),
        _ => None,
    }
}

fn sized(settings: &Settings, size: u32) -> Result<Settings, Error> {
    let mut settings = settings.clone();
    settings.set(&Registry::default(), "size", &size.to_string())?;
    Ok(settings)
}

/// What maps for such a light take, found once with small ones.
fn price(gpu: &Gpu, light: &PooledLight<'_>, prices: &mut Prices) -> Result<Price, Error> {
    let kind = light.view.light.shape.kind();
    if let Some((_, _, price)) = prices.iter().find(|(settings, of, _)| *of == kind && settings == light.settings) {
        return Ok(*price);
    }
    let mut tried = [0; TRIED.len()];
    for (tried, size) in tried.iter_mut().zip(TRIED) {
        *tried = bytes(gpu, light, size)?;
    }
    let price = Price::new(tried);
    // Settings that change in every frame are not all kept.
    if prices.len() >= PRICES {
        prices.clear();
    }
    prices.push((light.settings.clone(), kind, price));
    Ok(price)
}

/// What maps of this size take.
fn bytes(gpu: &Gpu, light: &PooledLight<'_>, size: u32) -> Result<u64, Error> {
    let mut technique = sized(light.settings, size)?.make(gpu)?;
    drop(technique.prepare(gpu, &light.view)?);
    Ok(technique.inside().stats().bytes)
}

/// Texels across that a map has use for: as many as the light's range has pixels on the screen, as
/// far away as half of it towards the eye. `None` for a light that lights nothing seen.
fn need(view: &View<'_>) -> Option<f64> {
    view.lit_part()?;
    let (center, projection) = (view.light.shape.center(), view.camera.clip_from_view);
    let Some(range) = view.light.range.filter(|_| center.w != 0.0) else { return Some(f64::INFINITY) };
    let radius = range.max(view.light.shape.radius());
    let pixels = f64::from(view.receivers.size.1) * projection.row(1).truncate().length() * radius;
    let depth = projection.row(3);
    if depth.truncate().length_squared() == 0.0 {
        return Some(pixels / depth.w.abs());
    }
    let distance = center.truncate().distance(view.camera.eye) - 0.5 * radius;
    Some(pixels / (depth.truncate().length() * distance.max(1e-3 * radius)))
}
