//! The form of a light: what it looks like, in a space of its own, and its pieces.

use crate::shader::HostConstant;
use crate::view::off_ties;
use umbrage_core::coverage::Cell;
use umbrage_core::glam::{DMat3, DVec2, DVec3, DVec4};
use umbrage_core::{Bounds, LightShape};

/// What a light looks like, see `area_light.wgsl`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Face {
    Sphere = 0,
    Disc = 1,
    Square = 2,
    Line = 3,
    Picture = 4,
}

/// What shaders call faces, and what else they share.
pub(super) const CONSTANTS: &[HostConstant] = &[
    ("SPHERE", Face::Sphere as u32 as f64),
    ("DISC", Face::Disc as u32 as f64),
    ("SQUARE", Face::Square as u32 as f64),
    ("LINE", Face::Line as u32 as f64),
    ("PICTURE", Face::Picture as u32 as f64),
    ("LINE_WIDTH", LINE_WIDTH as f32 as f64),
];

/// A light's form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Form {
    pub face: Face,
    /// A place (w = 1) or a direction (w = 0), in world space.
    pub center: DVec4,
    /// Takes differences of places to light space, see `area_light.wgsl`.
    pub to_light: DMat3,
    /// Its hull there.
    pub(super) corners: [DVec3; 4],
    pub(super) radius: f64,
    /// Half extents in world space, which casters are chosen by.
    half: [DVec3; 3],
    /// Of a split disc or sphere the piece that it is.
    pub cell: Option<Cell>,
    /// The share of the light that it is.
    pub weight: f64,
}

/// Corners of the square in light space.
const SQUARE: [DVec3; 4] =
    [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(-1.0, -1.0, 0.0), DVec3::new(-1.0, 1.0, 0.0)];

/// How wide a line is taken to be, as a share of its length.
pub(crate) const LINE_WIDTH: f64 = 1e-3;

/// How near to the light a triangle touches it, in light space.
const SLACK: f64 = 1e-4;

/// What all lights start with.
const WHOLE: Form = Form {
    face: Face::Sphere,
    center: DVec4::ZERO,
    to_light: DMat3::IDENTITY,
    corners: [DVec3::ZERO; 4],
    radius: 0.0,
    half: [DVec3::ZERO; 3],
    cell: None,
    weight: 1.0,
};

impl Form {
    /// `point_radius`: what points and spots have.
    pub fn of(shape: &LightShape, has_picture: bool, point_radius: f64) -> Self {
        let form = Self::with_extent(shape, has_picture, point_radius);
        // A light that has shrunk to a point has no space of its own.
        if form.is_point() && form.center.w != 0.0 {
            return Self::sphere(form.center.truncate(), DMat3::IDENTITY, DVec3::ZERO);
        }
        form
    }

    fn with_extent(shape: &LightShape, has_picture: bool, point_radius: f64) -> Self {
        match *shape {
            LightShape::Point { position } | LightShape::Spot { position, .. } => {
                Self::sphere(position, DMat3::IDENTITY, DVec3::splat(point_radius))
            }
            LightShape::Sphere { position, radius } => Self::sphere(position, DMat3::IDENTITY, DVec3::splat(radius)),
            LightShape::Ellipsoid { position, radii, rotation } => Self::sphere(position, rotation, radii),
            LightShape::Directional { direction, angle_deg } => Self::sun(-direction, angle_deg.to_radians() * 0.5),
            LightShape::Disc { position, direction, radius } => {
                let (x, y) = direction.any_orthonormal_pair();
                Self::flat(Face::Disc, position, x * radius, y * radius)
            }
            LightShape::Rect { position, direction, up, size, .. } => {
                let face = if has_picture { Face::Picture } else { Face::Square };
                // To the right for who looks at the emitting side, and down, as rows of pictures
                // go.
                Self::flat(face, position, up.cross(direction) * (size.x * 0.5), up * (size.y * -0.5))
            }
            LightShape::Line { from, to } => Self::line((from + to) * 0.5, (to - from) * 0.5),
            LightShape::Environment(_) => Self::sun(DVec3::Y, std::f64::consts::FRAC_PI_2),
        }
    }

    fn sphere(center: DVec3, rotation: DMat3, radii: DVec3) -> Self {
        let largest = radii.max_element();
        // A flat ellipsoid is the limit of thin ones, a point is in a space of metres.
        let radii = if largest > 1e-9 { radii.max(DVec3::splat(largest * 1e-6)) } else { DVec3::ZERO };
        let scale = if largest > 1e-9 { radii.recip() } else { DVec3::ONE };
        Self {
            face: Face::Sphere,
            center: center.extend(1.0),
            to_light: DMat3::from_diagonal(scale) * rotation.transpose(),
            corners: [DVec3::ZERO; 4],
            radius: if largest > 1e-9 { 1.0 } else { 0.0 },
            half: [rotation.x_axis * radii.x, rotation.y_axis * radii.y, rotation.z_axis * radii.z],
            ..WHOLE
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
            ..WHOLE
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
            ..WHOLE
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
            ..WHOLE
        }
    }

    /// The light cut into `count` times `count` pieces, a line into `count`. A light without extent
    /// is one piece. Those of a picture come row by row, as bright as an even light's.
    pub fn pieces(&self, count: usize) -> Vec<Self> {
        let [x, y, _] = self.half;
        let of = count as f64;
        let at = |i: usize| (2.0 * i as f64 + 1.0) / of - 1.0;
        let moved = |way: DVec3| self.center.truncate() + way;
        match self.face {
            _ if count <= 1 || self.is_point() => vec![*self],
            Face::Sphere | Face::Disc => Cell::grid(count).into_iter().map(|cell| self.piece(cell)).collect(),
            Face::Line => {
                (0..count).map(|i| Self { weight: 1.0 / of, ..Self::line(moved(x * at(i)), x / of) }).collect()
            }
            Face::Square | Face::Picture => (0..count * count)
                .map(|i| moved(x * at(i % count) + y * at(i / count)))
                .map(|center| Self { weight: 1.0 / (of * of), ..Self::flat(self.face, center, x / of, y / of) })
                .collect(),
        }
    }

    fn piece(&self, cell: Cell) -> Self {
        let mut corners = self.corners;
        if self.face == Face::Disc {
            let [low, high] = [cell.low, cell.high].map(|c| DVec2::from_array(c).clamp(DVec2::NEG_ONE, DVec2::ONE));
            let [a, c] = [high, low].map(|c| c.extend(corners[0].z));
            corners = [a, DVec3::new(a.x, c.y, a.z), c, DVec3::new(c.x, a.y, a.z)];
        }
        Self { corners, cell: Some(cell), weight: cell.around / std::f64::consts::TAU, ..*self }
    }

    /// From where the silhouette of a caster around `place` is seen, in light space, and the
    /// direction in which the piece of a sphere has its x.
    pub fn anchor(&self, place: DVec3) -> (DVec3, DVec3) {
        let Some(cell) = &self.cell else { return (DVec3::Z * (1.0 - self.center.w), DVec3::X) };
        let [x, y] = cell.center;
        if self.face == Face::Disc {
            return (DVec3::new(x, y, 1.0 - self.center.w), DVec3::X);
        }
        let to_center = -(self.to_light * (place - self.center.truncate())).normalize_or(DVec3::NEG_Z);
        let axis = to_center.any_orthonormal_vector();
        (axis * x + to_center.cross(axis) * y, axis)
    }

    /// A place of the light, or a direction to it, from light space.
    pub fn in_world(&self, place: DVec3) -> DVec4 {
        let way = self.to_light.inverse() * place;
        if self.center.w == 0.0 { way.extend(0.0) } else { self.center + way.extend(0.0) }
    }

    /// The same for a light whose centre may be at a vertex or in a triangle, see [`off_ties`].
    /// Relative to the eye, ways are rounded twice. What has an extent is moved by a thousandth of
    /// it, clear of whatever a rasteriser makes of planes that nearly hold the centre.
    pub fn off_ties(self, rounding: f64) -> Self {
        let extent = self.half.iter().map(|h| h.length()).fold(0.0, f64::max);
        Self { center: off_ties(self.center, (2.0 * rounding).max(1e-2 * extent)), ..self }
    }

    /// True where it has no extent: shadows are hard.
    pub fn is_point(&self) -> bool {
        self.half.iter().map(|h| h.length()).fold(0.0, f64::max) <= 1e-9
    }

    /// Whether a triangle may touch the light. Corners are relative to the light's centre.
    pub fn touches(&self, corners: [DVec3; 3]) -> bool {
        if self.center.w == 0.0 || self.is_point() {
            return false;
        }
        let corners = corners.map(|p| self.to_light * p);
        let hull = self.corners.iter().map(|c| c.abs()).fold(DVec3::ZERO, DVec3::max) + (self.radius + SLACK);
        let box_of = corners.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let reach = self.corners.iter().map(|c| normal.dot(*c).abs()).fold(0.0, f64::max) + self.radius + SLACK;
        box_of.0.cmple(hull).all() && box_of.1.cmpge(-hull).all() && normal.dot(corners[0]).abs() <= reach
    }

    /// A box around the light.
    pub fn bounds(&self) -> Bounds {
        Bounds::of(self.hull().iter().map(|p| p.truncate()))
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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_make_up_the_light() {
        let shapes = [
            LightShape::Sphere { position: DVec3::Y, radius: 0.5 },
            LightShape::Disc { position: DVec3::Y, direction: DVec3::X, radius: 0.5 },
            LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 2.0 },
            LightShape::Line { from: DVec3::X, to: DVec3::Y },
            LightShape::Rect { position: DVec3::Y, direction: DVec3::X, up: DVec3::Y, size: DVec2::ONE, texture: None },
        ];
        for shape in shapes {
            for count in 1..=3 {
                for has_picture in [false, true] {
                    let pieces = Form::of(&shape, has_picture, 0.0).pieces(count);
                    let whole: f64 = pieces.iter().map(|p| p.weight).sum();
                    assert!((whole - 1.0).abs() < 1e-12, "{shape:?} {count}: {whole}");
                    let expected = if matches!(shape, LightShape::Line { .. }) { count } else { count * count };
                    assert_eq!(pieces.len(), expected);
                }
            }
        }
    }
}
