//! The light as wedges and coverage see it.

use crate::shader::shader_struct;
use crate::view::View;
use umbrage_core::LightShape;
use umbrage_core::glam::{DMat3, DVec3, DVec4};

shader_struct! {
    /// See `light.wgsl`.
    pub(crate) struct WedgeLight {
        clip_from_eye: [[f32; 4]; 4],
        to_light: [[f32; 4]; 3],
        from_light: [[f32; 4]; 3],
        corners: [[f32; 4]; 4],
        low: [f32; 4],
        high: [f32; 4],
        center: [f32; 3],
        radius: f32,
        eye_from_origin: [f32; 3],
        face: u32,
        parallel: u32,
        rounding: f32,
        eye_chunks: u32,
        pad: u32,
    }
}

/// What a light looks like, see `light.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Face {
    Ball = 0,
    Disc = 1,
    Square = 2,
    Line = 3,
    Picture = 4,
}

/// A light's form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub face: Face,
    /// A place (w = 1) or a direction (w = 0), in world space.
    pub center: DVec4,
    /// Takes differences of places to light space, see `light.wgsl`.
    to_light: DMat3,
    /// Its hull there.
    corners: [DVec3; 4],
    radius: f64,
    /// Half extents in world space, which casters are chosen by.
    half: [DVec3; 3],
}

/// Corners of the square in light space.
const SQUARE: [DVec3; 4] =
    [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0)];

/// How wide a line is taken to be, as a share of its length; the shader has the same.
const LINE_WIDTH: f64 = 1e-3;

impl Form {
    /// `point_radius`: what points and spots have.
    pub fn of(shape: &LightShape, has_picture: bool, point_radius: f64) -> Self {
        match *shape {
            LightShape::Point { position } | LightShape::Spot { position, .. } => {
                Self::ball(position, DMat3::IDENTITY, DVec3::splat(point_radius))
            }
            LightShape::Sphere { position, radius } => Self::ball(position, DMat3::IDENTITY, DVec3::splat(radius)),
            LightShape::Ellipsoid { position, radii, rotation } => Self::ball(position, rotation, radii),
            LightShape::Directional { direction, angle_deg } => Self::sun(-direction, angle_deg.to_radians() * 0.5),
            LightShape::Disc { position, direction, radius } => {
                let (x, y) = direction.any_orthonormal_pair();
                Self::flat(Face::Disc, position, x * radius, y * radius)
            }
            LightShape::Rect { position, direction, up, size, .. } => {
                let face = if has_picture { Face::Picture } else { Face::Square };
                // To the right for who looks at the emitting side, and down, as rows of pictures go.
                Self::flat(face, position, up.cross(direction) * (size.x * 0.5), up * (size.y * -0.5))
            }
            LightShape::Line { from, to } => Self::line((from + to) * 0.5, (to - from) * 0.5),
        }
    }

    fn ball(center: DVec3, rotation: DMat3, radii: DVec3) -> Self {
        let largest = radii.max_element();
        // A flat ellipsoid is the limit of thin ones, a point is in a space of metres.
        let radii = if largest > 1e-9 { radii.max(DVec3::splat(largest * 1e-6)) } else { DVec3::ZERO };
        let scale = if largest > 1e-9 { radii.recip() } else { DVec3::ONE };
        Self {
            face: Face::Ball,
            center: center.extend(1.0),
            to_light: DMat3::from_diagonal(scale) * rotation.transpose(),
            corners: [DVec3::ZERO; 4],
            radius: if largest > 1e-9 { 1.0 } else { 0.0 },
            half: [rotation.x_axis * radii.x, rotation.y_axis * radii.y, rotation.z_axis * radii.z],
        }
    }

    fn sun(to_light: DVec3, half_angle: f64) -> Self {
        let (x, y) = to_light.any_orthonormal_pair();
        let tan = half_angle.tan();
        let (scale, spread) = if tan > 1e-9 { (1.0 / tan, 1.0) } else { (1.0, 0.0) };
        Self {
            face: Face::Disc,
            center: to_light.extend(0.0),
            to_light: DMat3::from_cols(x * scale, y * scale, to_light).transpose(),
            corners: SQUARE.map(|c| c * spread + DVec3::Z),
            radius: 0.0,
            half: [x * tan, y * tan, DVec3::ZERO],
        }
    }

    fn flat(face: Face, center: DVec3, x: DVec3, y: DVec3) -> Self {
        // Not so thin that it has no inverse.
        let least = x.length().max(y.length()).max(1e-9) * 1e-6;
        let [x, y] = [x, y].map(|v| if v.length() < least { v.normalize_or(DVec3::X) * least } else { v });
        let depth = 0.5 * (x.length() + y.length());
        Self {
            face,
            center: center.extend(1.0),
            to_light: DMat3::from_cols(x, y, x.cross(y).normalize_or(DVec3::Y) * depth).inverse(),
            corners: SQUARE,
            radius: 0.0,
            half: [x, y, DVec3::ZERO],
        }
    }

    fn line(center: DVec3, x: DVec3) -> Self {
        let length = x.length().max(1e-9);
        let (y, z) = x.normalize_or(DVec3::X).any_orthonormal_pair();
        Self {
            face: Face::Line,
            center: center.extend(1.0),
            to_light: DMat3::from_cols(x.normalize_or(DVec3::X), y, z).transpose() * (1.0 / length),
            corners: [DVec3::X, DVec3::X, DVec3::NEG_X, DVec3::NEG_X],
            radius: LINE_WIDTH,
            half: [x, y * (length * LINE_WIDTH), DVec3::ZERO],
        }
    }

    /// True where it has no extent: shadows are hard.
    pub fn is_point(&self) -> bool {
        self.half.iter().map(|h| h.length()).fold(0.0, f64::max) <= 1e-9
    }

    /// Points or directions whose hull holds the light.
    pub fn hull(&self) -> Vec<DVec4> {
        let [x, y, z] = self.half;
        let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)];
        let ends: &[f64] = if z == DVec3::ZERO { &[0.0] } else { &[-1.0, 1.0] };
        let corner = |(a, b): (f64, f64), c: f64| self.center + (x * a + y * b + z * c).extend(0.0);
        let mut hull: Vec<DVec4> = ends.iter().flat_map(|&c| signs.map(|s| corner(s, c))).collect();
        hull.dedup();
        hull
    }

    /// For the shaders; `rounding`: the share of coordinates that single precision is off by; `eye_chunks`: see
    /// `eye.wgsl`.
    pub fn uniform(&self, view: &View<'_>, rounding: f64, eye_chunks: u32) -> WedgeLight {
        let eye = view.camera.eye;
        let center = (self.center.truncate() - eye) * self.center.w;
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).extend(0.0).as_vec4().to_array());
        let seen = view.seen();
        let seen = seen.grown(4.0 * rounding * seen.largest_coordinate());
        let corner = |p: DVec3| p.extend(0.0).as_vec4().to_array();
        WedgeLight {
            clip_from_eye: view.clip_from_eye().as_mat4().to_cols_array_2d(),
            to_light: rows(self.to_light),
            from_light: rows(self.to_light.inverse()),
            corners: self.corners.map(corner),
            low: corner(seen.min - eye),
            high: corner(seen.max - eye),
            center: center.as_vec3().to_array(),
            radius: self.radius as f32,
            eye_from_origin: (view.casters.origin() - eye).as_vec3().to_array(),
            face: self.face as u32,
            parallel: u32::from(self.center.w == 0.0),
            rounding: rounding as f32,
            eye_chunks,
            pad: 0,
        }
    }
}
