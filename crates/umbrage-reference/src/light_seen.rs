//! A light as one point of a surface sees it, with what hides it.

use crate::geometry::Surface;
use crate::tracer::{CLEARANCE, Tracer};
use crate::triangle::Ray;
use glam::{DVec2, DVec3, DVec4};
use umbrage_core::sampling::{LightFrom, LightSampler};
use umbrage_core::{Image, Light, LightShape, Texture};

/// Half extents of the light that the picture reaches to either side.
const MARGIN: f64 = 1.25;
/// Of lights without extent, the share of the picture's half that the dot in its middle takes.
const DOT: f64 = 0.1;
/// Half the angle that is seen around such a light, radians.
const AROUND: f64 = 0.1;
/// A thin line is drawn so many times as wide as it is long.
const THICKNESS: f64 = 0.12;

/// What hides a point of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocker {
    /// Distance from the surface, metres; 0 where the surface's own tangent plane hides the light.
    pub distance: f64,
    /// Its model, [`umbrage_core::Instance::model`]; −1 where it is not known.
    pub model: i32,
}

/// One place of a [`LightSeen`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// How bright the light is there: 1 in the mean over the light, 0 beside it.
    pub brightness: f32,
    /// What is in the way; also beside the light.
    pub blocker: Option<Blocker>,
}

/// A light as one point sees it: its outline in the plane it lies in, upright, with a margin around
/// it. Equal areas are equal shares of the light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSeen {
    /// The picture.
    pub spots: Image<Spot>,
}

impl LightSeen {
    /// The share of the light that is seen, 0…1: visibility, as well as a picture of this size has
    /// it.
    pub fn share(&self) -> f64 {
        let sum = |only_seen: bool| {
            let spots = self.spots.data.iter().filter(|spot| !only_seen || spot.blocker.is_none());
            spots.map(|spot| f64::from(spot.brightness)).sum::<f64>()
        };
        let all = sum(false);
        if all > 0.0 { sum(true) / all } else { 0.0 }
    }
}

impl Tracer {
    /// What first hides `to`, a world point with w = 1 or a direction with w = 0, from a surface:
    /// another casting triangle, or the surface itself where `to` is below its tangent plane.
    pub fn blocker(&self, surface: &Surface, to: DVec4) -> Option<Blocker> {
        let direction = to.truncate() - surface.position * to.w;
        let cosine = surface.normal.dot(direction);
        if surface.casts && cosine < 0.0 {
            let model = surface.triangle.map_or(-1, |triangle| self.instance(triangle).model);
            return Some(Blocker { distance: 0.0, model });
        }
        let clear = CLEARANCE * self.scale;
        let t_max = if to.w == 0.0 { f64::INFINITY } else { 1.0 - clear / direction.length() };
        let ray = Ray { origin: surface.position - self.center, direction, t_min: clear / cosine.abs(), t_max };
        let (triangle, t) = self.casting().first(&ray, surface.triangle, &self.cutouts)?;
        Some(Blocker { distance: t * direction.length(), model: self.instance(triangle.id).model })
    }

    /// Where the way from `origin` along `direction` first meets a casting triangle.
    pub fn first_caster(&self, origin: DVec3, direction: DVec3) -> Option<DVec3> {
        let ray = Ray { origin: origin - self.center, direction, t_min: 0.0, t_max: f64::INFINITY };
        let (_, t) = self.casting().first(&ray, None, &self.cutouts)?;
        Some(origin + direction * t)
    }

    /// The light as `surface` sees it, `size` places across and down; `textures` are the scene's.
    /// Of lights without extent a dot in the middle of what is around it.
    pub fn light_seen(&self, surface: &Surface, light: &Light, textures: &[Texture], size: u32) -> LightSeen {
        let sampler = LightSampler::new(&light.shape, textures);
        let frame = Frame::new(&sampler, &light.shape, surface.position);
        let cell = 2.0 * MARGIN / f64::from(size.max(1));
        let spots = Image::from_fn(size, size, |x, y| {
            let d = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) * cell - MARGIN;
            let (to, brightness) = frame.at(d, cell * 0.5);
            let blocker = if light.casts { self.blocker(surface, to) } else { None };
            Spot { brightness: brightness as f32, blocker }
        });
        LightSeen { spots }
    }
}

/// How places of the picture belong to points of the light.
struct Frame<'a> {
    from: LightFrom<'a>,
    center: DVec4,
    /// To the right and down in the picture, −1 or 1 half extents of it each.
    flip: DVec2,
    shape: Shape,
}

enum Shape {
    /// As it is.
    Extended,
    /// A line, drawn with this half width.
    Thin(DVec3),
    /// A dot, with what these axes reach around it.
    Dot([DVec3; 2]),
}

impl<'a> Frame<'a> {
    fn new(sampler: &'a LightSampler, shape: &LightShape, eye: DVec3) -> Self {
        let from = sampler.at(eye);
        let (center, forward) = (shape.center(), shape.to_center(eye));
        let [mut x, mut y] = from.axes();
        let is_round =
            matches!(shape, LightShape::Sphere { .. } | LightShape::Disc { .. } | LightShape::Directional { .. });
        let mut turned = from;
        if is_round {
            // So that what is above is above in the picture; looking straight up any turn will do.
            turned = from.turned((-x.y).atan2(y.y));
            [x, y] = turned.axes();
        }
        let thin = forward.cross(x).normalize_or(DVec3::Y) * x.length() * THICKNESS;
        let kind = match shape {
            LightShape::Line { .. } => Shape::Thin(thin),
            _ if !shape.kind().is_soft() || x == DVec3::ZERO => {
                let (right, down) = upright(forward);
                let reach = if center.w == 0.0 { AROUND } else { AROUND * forward.length() };
                Shape::Dot([right * reach, down * reach])
            }
            _ => Shape::Extended,
        };
        let (x, y) = match &kind {
            Shape::Extended => (x, y),
            Shape::Thin(across) => (x, *across),
            Shape::Dot([right, down]) => (*right, *down),
        };
        // Down is down, and what is at the right is at the right.
        let down = if y.y > 0.0 { -1.0 } else { 1.0 };
        let right = if x.cross(y * down).dot(forward) < 0.0 { -1.0 } else { 1.0 };
        Self { from: turned, center, flip: DVec2::new(right, down), shape: kind }
    }

    /// The point of the light, or beside it, at a place of the picture, and how bright it is.
    fn at(&self, d: DVec2, reach: f64) -> (DVec4, f64) {
        let d = d * self.flip;
        match self.shape {
            Shape::Extended => (self.from.place(d), self.from.brightness(d, reach)),
            Shape::Thin(across) => {
                let beside = d.y.signum() * (d.y.abs() - THICKNESS).max(0.0) / THICKNESS;
                let is_on = d.x.abs() <= 1.0 && beside == 0.0;
                let to = self.from.place(DVec2::new(d.x, 0.0)) + (across * beside).extend(0.0);
                (to, f64::from(u8::from(is_on)))
            }
            Shape::Dot([right, down]) => {
                let is_on = d.length() <= DOT;
                let by = if is_on { DVec3::ZERO } else { right * d.x + down * d.y };
                (self.center + by.extend(0.0), f64::from(u8::from(is_on)))
            }
        }
    }
}

/// Unit vectors to the right and down for who looks along `forward`.
fn upright(forward: DVec3) -> (DVec3, DVec3) {
    let forward = forward.normalize_or(DVec3::NEG_Y);
    let right = forward.cross(DVec3::Y);
    let right = if right.length_squared() > 1e-12 { right.normalize() } else { DVec3::X };
    (right, forward.cross(right))
}
