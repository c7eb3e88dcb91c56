//! What the look-up knows of each plane: its texture, and the light as it blurs shadows there.

use super::Softness;
use crate::planar::{LitPlane, MOST};
use crate::shader::shader_struct;
use crate::view::View;
use umbrage_core::LightShape;
use umbrage_core::glam::{DMat4, DVec2, DVec3, DVec4};

shader_struct! {
    /// See `lookup.wgsl`.
    pub(crate) struct PlaneTexture {
        across: [f32; 4],
        down: [f32; 4],
        normal: [f32; 3],
        inverse_height: f32,
        light: [f32; 3],
        highest: f32,
        right: [f32; 3],
        radius: f32,
        up: [f32; 3],
        is_round: f32,
    }
}

shader_struct! {
    /// See `lookup.wgsl`.
    pub(crate) struct Textures {
        right: [f32; 3],
        radius: f32,
        up: [f32; 3],
        is_round: f32,
        planes: [PlaneTexture; MOST],
    }
}

/// The blur that a technique wants.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blur {
    pub softness: Softness,
    pub kernel: u32,
    /// Of a fixed blur, metres; 0 for neighbouring texels.
    pub radius_m: f64,
    pub size: u32,
}

/// Shadows are looked up no farther away than this share of what is seen of a plane.
const FARTHEST: f64 = 0.5;

/// Taps along each side of the grid that blockers are searched for with, and by how much each next
/// one is smaller, down to half a texel: see `lookup.wgsl`.
const SEARCH: u64 = 5;
const CLOSER: f64 = 0.3;

impl Blur {
    /// Texels that a pixel reads at most.
    pub fn texels(&self) -> u64 {
        let rounds = (2.0 * f64::from(self.size)).ln() / (1.0 / CLOSER).ln();
        let searched = if self.softness == Softness::Light { rounds.ceil() as u64 * SEARCH * SEARCH } else { 0 };
        // Between the middles of four each.
        searched + 4 * u64::from(self.kernel * self.kernel)
    }

    /// How far beyond what is seen of a plane shadows matter, metres.
    pub fn margin(&self, view: &View<'_>, plane: &LitPlane) -> f64 {
        let seen = (plane.high - plane.low).max_element();
        match self.softness {
            Softness::Light => {
                // A light without extent blurs nothing, however high casters are.
                let extent = extent(view, plane);
                let highest = plane.reach_of(&view.casters.casting().content());
                if extent > 0.0 { (extent * highest).min(FARTHEST * seen) } else { 0.0 }
            }
            Softness::Fixed if self.radius_m > 0.0 => self.radius_m,
            Softness::Fixed => seen * f64::from(self.kernel) / f64::from(self.size),
        }
    }

    /// The rectangle that a plane's texture covers, along its axes.
    pub fn rectangle(&self, plane: &LitPlane) -> [DVec2; 2] {
        let (from, to) = plane.shadows;
        let (low, high) = (from.max(plane.low), to.min(plane.high));
        // A texel around it, so that bilinear taps end in light.
        let texel = ((high - low) / f64::from(self.size.max(3) - 2)).max(DVec2::splat(1e-9));
        [low - texel, high + texel]
    }

    /// What 1 stands for in the texture.
    pub fn highest(&self, view: &View<'_>, plane: &LitPlane) -> f64 {
        let most = FARTHEST * (plane.high - plane.low).max_element() / extent(view, plane).max(1e-9);
        plane.highest.min(most).max(1e-9)
    }

    /// For the look-up.
    fn texture(&self, view: &View<'_>, plane: &LitPlane) -> PlaneTexture {
        let texels = texels_from_eye(view, plane, self.rectangle(plane), self.size);
        let eye = view.camera.eye - plane.origin;
        let axes = match self.softness {
            Softness::Light => Axes::over(view, plane),
            Softness::Fixed => self.fixed(plane),
        };
        let highest = if self.softness == Softness::Fixed { 1.0 } else { self.highest(view, plane) };
        let row = |i: usize| texels.row(i).as_vec4().to_array();
        PlaneTexture {
            across: row(0),
            down: row(1),
            normal: plane.plane.truncate().as_vec3().to_array(),
            inverse_height: plane.inverse_height as f32,
            light: (plane.light - eye * plane.inverse_height).as_vec3().to_array(),
            highest: highest as f32,
            right: axes.right.as_vec3().to_array(),
            radius: axes.radius as f32,
            up: axes.up.as_vec3().to_array(),
            is_round: f32::from(u8::from(axes.is_round)),
        }
    }

    /// For the look-up: the light, and all planes.
    pub fn textures(&self, view: &View<'_>, planes: &[LitPlane]) -> Textures {
        let center = view.light.shape.center();
        let toward = center.truncate() - view.casters.receivers_bounds().center() * center.w;
        let axes = Axes::of(&view.light.shape, toward);
        let mut textures = Textures {
            right: axes.right.as_vec3().to_array(),
            radius: axes.radius as f32,
            up: axes.up.as_vec3().to_array(),
            is_round: f32::from(u8::from(axes.is_round)),
            ..Textures::default()
        };
        textures.planes.iter_mut().zip(planes).for_each(|(data, plane)| *data = self.texture(view, plane));
        textures
    }

    /// Half axes of a blur that is the same everywhere, in the plane.
    fn fixed(&self, plane: &LitPlane) -> Axes {
        let [low, high] = self.rectangle(plane);
        let texel = (high - low) / f64::from(self.size);
        let half = if self.radius_m > 0.0 { DVec2::splat(self.radius_m) } else { texel * 0.5 * f64::from(self.kernel) };
        Axes { right: plane.right * half.x, up: plane.up * half.y, radius: 0.0, is_round: false }
    }
}

/// From places relative to the eye to the clip space of a plane's texture.
pub(super) fn clip_from_eye(view: &View<'_>, plane: &LitPlane, [low, high]: [DVec2; 2]) -> DMat4 {
    let eye = view.camera.eye - plane.origin;
    let row = |axis: DVec3, low: f64, high: f64| {
        let scale = 2.0 / (high - low);
        (axis * scale).extend((axis.dot(eye) - low) * scale - 1.0)
    };
    let (x, y) = (row(plane.right, low.x, high.x), row(plane.up, low.y, high.y));
    DMat4::from_cols(x, y, DVec4::ZERO, DVec4::W).transpose()
}

/// The same to texels; row 0 is at the top.
fn texels_from_eye(view: &View<'_>, plane: &LitPlane, rectangle: [DVec2; 2], size: u32) -> DMat4 {
    let half = 0.5 * f64::from(size);
    let texels_from_clip =
        DMat4::from_translation(DVec3::new(half, half, 0.0)) * DMat4::from_scale(DVec3::new(half, -half, 1.0));
    texels_from_clip * clip_from_eye(view, plane, rectangle)
}

/// Half axes of a light, the radius of a sphere instead, and whether it is round; of parallel light
/// at a distance of 1.
struct Axes {
    right: DVec3,
    up: DVec3,
    radius: f64,
    is_round: bool,
}

impl Axes {
    /// `toward` is the way from what is in shadow to the light.
    fn of(shape: &LightShape, toward: DVec3) -> Self {
        let flat = |right: DVec3, up: DVec3, is_round| Self { right, up, radius: 0.0, is_round };
        match *shape {
            LightShape::Point { .. } | LightShape::Spot { .. } => flat(DVec3::ZERO, DVec3::ZERO, true),
            LightShape::Directional { direction, angle_deg } => {
                let tangent = (angle_deg * 0.5).to_radians().clamp(0.0, 1.5).tan();
                let (right, up) = direction.any_orthonormal_pair();
                flat(right * tangent, up * tangent, true)
            }
            LightShape::Sphere { radius, .. } => Self { radius, ..flat(DVec3::ZERO, DVec3::ZERO, true) },
            LightShape::Ellipsoid { radii, rotation, .. } => {
                let way = (rotation.transpose() * toward / radii.max(DVec3::splat(1e-9))).normalize_or(DVec3::Y);
                let (right, up) = way.any_orthonormal_pair();
                flat(rotation * (right * radii), rotation * (up * radii), true)
            }
            LightShape::Disc { direction, radius, .. } => {
                let (right, up) = direction.any_orthonormal_pair();
                flat(right * radius, up * radius, true)
            }
            LightShape::Rect { direction, up, size, .. } => {
                flat(up.cross(direction) * (size.x * 0.5), up * (size.y * 0.5), false)
            }
            LightShape::Line { from, to } => flat((to - from) * 0.5, DVec3::ZERO, false),
            LightShape::Environment(_) => flat(DVec3::X, DVec3::Z, true),
        }
    }

    /// Over the light's height above a plane, for the middle of what is in shadow there.
    fn over(view: &View<'_>, plane: &LitPlane) -> Self {
        let center = view.light.shape.center();
        let height = plane.plane.truncate().dot(center.truncate() - plane.origin * center.w) + plane.plane.w * center.w;
        let middle = plane.at((plane.low + plane.high) * 0.5);
        let axes = Self::of(&view.light.shape, plane.light - middle * plane.inverse_height);
        Self { right: axes.right / height, up: axes.up / height, radius: axes.radius / height, ..axes }
    }
}

/// The widest half axis of the light's blur, metres for each metre of reach.
fn extent(view: &View<'_>, plane: &LitPlane) -> f64 {
    let Axes { right, up, radius, .. } = Axes::over(view, plane);
    let normal = plane.plane.truncate();
    let corners = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE].map(|s| plane.low + (plane.high - plane.low) * s);
    let toward = corners.map(|p| plane.light - plane.at(p) * plane.inverse_height);
    let widest = |axis: DVec3| toward.iter().map(|way| (axis - *way * normal.dot(axis)).length()).fold(0.0, f64::max);
    let slanted = toward.iter().map(|way| way.length()).fold(0.0, f64::max);
    widest(right).hypot(widest(up)).max(radius * slanted)
}
