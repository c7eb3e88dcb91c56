//! The light as wedges and coverage see it.

use crate::shader::shader_struct;
use crate::view::View;
use umbrage_core::glam::{DMat3, DVec3, DVec4};
use umbrage_core::{Bounds, Frustum, LightShape};

shader_struct! {
    /// See `light.wgsl`.
    pub(crate) struct WedgeLight {
        clip_from_eye: [[f32; 4]; 4],
        center: [f32; 4],
        linear: [[f32; 4]; 3],
        inverse: [[f32; 4]; 3],
        corners: [[f32; 4]; 4],
        axes: [[f32; 4]; 3],
        low: [f32; 4],
        high: [f32; 4],
        eye_from_origin: [f32; 3],
        radius: f32,
        face: u32,
        parallel: u32,
        rounding: f32,
        eye_chunks: u32,
    }
}

/// What a light looks like, see `light.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Face {
    Ball = 0,
    Disc = 1,
    Rect = 2,
    Line = 3,
    Picture = 4,
}

/// A light's form in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub face: Face,
    /// A place (w = 1) or a direction (w = 0).
    pub center: DVec4,
    /// Takes differences of places to where wedges are built.
    linear: DMat3,
    /// The hull there, about the centre, or directions.
    corners: [DVec3; 4],
    radius: f64,
    /// What the shader multiplies differences with to find coordinates on the face, as rows; not for balls.
    axes: [DVec3; 3],
    /// Half extents in world space: the hull that casters are chosen by.
    half: Vec3s,
}

type Vec3s = [DVec3; 3];

/// How wide a line light is taken to be, as a share of its length.
const LINE_WIDTH: f64 = 1e-3;

impl Form {
    /// `point_radius`: what points and spots have. `None` for lights that are points: their shadows are hard.
    pub fn of(shape: &LightShape, has_picture: bool, point_radius: f64) -> Self {
        let hard = |center| Self::ball(center, DMat3::IDENTITY, point_radius.max(0.0) * DVec3::ONE);
        match *shape {
            LightShape::Point { position } | LightShape::Spot { position, .. } => hard(position),
            LightShape::Sphere { position, radius } => {
                Self::ball(position, DMat3::IDENTITY, DVec3::splat(radius.max(0.0)))
            }
            LightShape::Ellipsoid { position, radii, rotation } => Self::ball(position, rotation, radii),
            LightShape::Directional { direction, angle_deg } => Self::sun(-direction, angle_deg.to_radians() * 0.5),
            LightShape::Disc { position, direction, radius } => {
                let (x, y) = direction.any_orthonormal_pair();
                Self::flat(Face::Disc, position, x * radius, y * radius)
            }
            LightShape::Rect { position, direction, up, size, .. } => {
                let face = if has_picture { Face::Picture } else { Face::Rect };
                // To the right for who looks at the emitting side, and down, as rows of pictures go.
                Self::flat(face, position, up.cross(direction) * (size.x * 0.5), up * (size.y * -0.5))
            }
            LightShape::Line { from, to } => {
                let x = (to - from) * 0.5;
                let y = x.any_orthogonal_vector().normalize_or_zero() * (x.length() * LINE_WIDTH);
                Self::flat(Face::Line, (from + to) * 0.5, x, y)
            }
        }
    }

    fn ball(center: DVec3, rotation: DMat3, radii: DVec3) -> Self {
        // A flat ellipsoid is the limit of thin ones.
        let thin = radii.max(DVec3::splat(radii.max_element() * 1e-6)).max(DVec3::splat(1e-12));
        Self {
            face: Face::Ball,
            center: center.extend(1.0),
            linear: DMat3::from_diagonal(thin.recip()) * rotation.transpose(),
            corners: [DVec3::ZERO; 4],
            radius: 1.0,
            axes: [DVec3::ZERO; 3],
            half: [rotation.x_axis * radii.x, rotation.y_axis * radii.y, rotation.z_axis * radii.z],
        }
    }

    fn sun(to_light: DVec3, half_angle: f64) -> Self {
        let (x, y) = to_light.any_orthonormal_pair();
        let (sin, tan) = (half_angle.sin(), half_angle.tan().max(1e-12));
        Self {
            face: Face::Disc,
            center: to_light.extend(0.0),
            linear: DMat3::IDENTITY,
            corners: [to_light; 4],
            radius: sin,
            axes: [x / tan, y / tan, to_light],
            half: [x * tan, y * tan, DVec3::ZERO],
        }
    }

    fn flat(face: Face, center: DVec3, x: DVec3, y: DVec3) -> Self {
        let normal = x.cross(y).normalize_or(DVec3::Y);
        let row = |v: DVec3| v / v.length_squared().max(1e-24);
        // A hull of a disc is that of its square, a little larger than the disc.
        let corners = [x + y, x - y, -x - y, y - x];
        let (corners, radius) =
            if face == Face::Line { ([x, x, -x, -x], y.length()) } else { (corners, 0.0) };
        let axes = [row(x), row(y), normal];
        Self {
            face,
            center: center.extend(1.0),
            linear: DMat3::IDENTITY,
            corners,
            radius,
            axes,
            half: [x, y, DVec3::ZERO],
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
        let center = (self.center.truncate() - eye * self.center.w).extend(self.center.w);
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).extend(0.0).as_vec4().to_array());
        let seen = seen(view);
        let seen = seen.grown(4.0 * rounding * seen.largest_coordinate());
        let corner = |p: DVec3| (p - eye).extend(0.0).as_vec4().to_array();
        let width = self.axes[1].length();
        let mut axes = self.axes.map(|a| a.extend(0.0).as_vec4().to_array());
        // The cross product of a normal with the long axis' row, taken to this axis' row.
        axes[1][3] = (width / self.axes[0].length().max(1e-30)) as f32;
        WedgeLight {
            clip_from_eye: view.clip_from_eye().as_mat4().to_cols_array_2d(),
            center: center.as_vec4().to_array(),
            linear: rows(self.linear),
            inverse: rows(self.linear.inverse()),
            corners: self.corners.map(|c| c.extend(0.0).as_vec4().to_array()),
            axes,
            low: corner(seen.min),
            high: corner(seen.max),
            eye_from_origin: (view.casters.origin() - eye).as_vec3().to_array(),
            radius: self.radius as f32,
            face: self.face as u32,
            parallel: u32::from(self.center.w == 0.0),
            rounding: rounding as f32,
            eye_chunks,
        }
    }
}

/// A box around what the camera sees of the receivers.
fn seen(view: &View<'_>) -> Bounds {
    let mut corners = Vec::with_capacity(32);
    Frustum::of(&view.camera.clip_from_world()).clip_box(&view.casters.receivers_bounds(), &mut corners);
    Bounds::of(corners)
}
