//! Random cameras of every kind of projection, lights, and points that are seen.

use glam::{DMat4, DVec2, DVec3, DVec4};
use proptest::prelude::*;
use umbrage_core::{Bounds, Camera, CameraView};

pub const PICTURE: (u32, u32) = (640, 480);

/// A parallel projection covers what a perspective one does at this distance.
const HALF: f64 = 10.0;

/// A camera, and what tests need to know of it that its matrices hide.
#[derive(Clone, Debug)]
pub struct Shot {
    pub view: CameraView,
    pub camera: Camera,
    near: f64,
    far: f64,
    parallel: bool,
}

/// The kinds of projection that hosts have.
#[derive(Clone, Copy, Debug)]
enum Projection {
    Infinite,
    Finite,
    FiniteReversed,
    Parallel,
}

impl Shot {
    fn new(camera: Camera, projection: Projection) -> Self {
        let aspect = f64::from(PICTURE.0) / f64::from(PICTURE.1);
        let (near, far) = (camera.near, 500.0);
        let tangent = (camera.fov_y_deg.to_radians() * 0.5).tan();
        // Depth `first` is to become 0 and `last` 1.
        let finite = |first: f64, last: f64| {
            let (scale, offset) = (last / (first - last), first * last / (first - last));
            let x_y = camera.clip_from_view(aspect);
            DMat4::from_cols(x_y.x_axis, x_y.y_axis, DVec4::new(0.0, 0.0, scale, -1.0), DVec4::Z * offset)
        };
        let clip_from_view = match projection {
            Projection::Infinite => camera.clip_from_view(aspect),
            Projection::Finite => finite(near, far),
            Projection::FiniteReversed => finite(far, near),
            Projection::Parallel => {
                let (half, depth) = (tangent * HALF, far - near);
                DMat4::from_translation(DVec3::Z * (-near / depth))
                    * DMat4::from_scale(DVec3::new(1.0 / (half * aspect), 1.0 / half, -1.0 / depth))
            }
        };
        let view = CameraView::from_matrices(camera.view_from_world(), clip_from_view);
        let far = if matches!(projection, Projection::Infinite) { f64::INFINITY } else { far };
        Self { view, near, far, parallel: matches!(projection, Projection::Parallel), camera }
    }

    /// The point at `ndc`, in [−1, 1], at a share between near plane and `farthest`, or the far
    /// plane if that is nearer.
    pub fn seen(&self, ndc: DVec2, share: f64, farthest: f64) -> DVec3 {
        let (near, far) = (self.near, farthest.min(self.far));
        // Even on a logarithmic scale, and not quite at the planes, so that rounding puts no point
        // outside.
        let depth = near * (far / near).powf(0.001 + 0.998 * share);
        self.at(ndc, depth)
    }

    /// A direction that leads away within the view.
    pub fn away(&self, ndc: DVec2) -> DVec3 {
        let forward = self.camera.axes()[2];
        if self.parallel { forward } else { (self.at(ndc * 0.999, 1.0) - self.camera.eye).normalize() }
    }

    pub fn on_near(&self, ndc: DVec2) -> DVec3 {
        self.at(ndc, self.near)
    }

    fn at(&self, ndc: DVec2, depth: f64) -> DVec3 {
        let [right, up, forward] = self.camera.axes();
        let tangent = (self.camera.fov_y_deg.to_radians() * 0.5).tan();
        let half = if self.parallel { tangent * HALF } else { tangent * depth };
        let aspect = f64::from(PICTURE.0) / f64::from(PICTURE.1);
        let ndc = ndc * 0.999_999;
        self.camera.eye + right * (ndc.x * half * aspect) + up * (ndc.y * half) + forward * depth
    }

    /// How far a point is beyond the worst of the planes around what is seen between two distances
    /// along the view.
    pub fn outside(&self, point: DVec3, [first, last]: [f64; 2]) -> f64 {
        let v = point - self.camera.eye;
        let [x, y, depth] = self.camera.axes().map(|axis| axis.dot(v));
        let tangent = (self.camera.fov_y_deg.to_radians() * 0.5).tan();
        let aspect = f64::from(PICTURE.0) / f64::from(PICTURE.1);
        let beyond = |across: f64, tangent: f64| match self.parallel {
            true => across.abs() - tangent * HALF,
            false => (across.abs() - tangent * depth) / tangent.hypot(1.0),
        };
        let (first, last) = (first.max(self.near), last.min(self.far));
        let planes = [beyond(x, tangent * aspect), beyond(y, tangent), first - depth, depth - last];
        planes.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Where a point is in the picture, in pixels; `None` where it isn't seen. Worked out relative
    /// to the eye.
    pub fn pixel(&self, point: DVec3) -> Option<DVec2> {
        let [right, up, forward] = self.camera.axes();
        let v = point - self.camera.eye;
        let clip = self.view.clip_from_view * DVec4::new(right.dot(v), up.dot(v), -forward.dot(v), 1.0);
        let seen = clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z);
        let size = DVec2::new(PICTURE.0.into(), PICTURE.1.into());
        seen.then(|| (DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * size)
    }
}

pub fn vector(limit: f64) -> impl Strategy<Value = DVec3> {
    let c = -limit..limit;
    (c.clone(), c.clone(), c).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

pub fn direction() -> impl Strategy<Value = DVec3> {
    vector(1.0).prop_filter_map("a length", |v| (v.length() > 0.1).then(|| v.normalize()))
}

pub fn ndc() -> impl Strategy<Value = DVec2> {
    let c = prop_oneof![4 => -1.0..1.0, 1 => Just(-1.0), 1 => Just(1.0)];
    (c.clone(), c).prop_map(|(x, y)| DVec2::new(x, y))
}

/// The middle of a scene: at the origin, or ten thousand kilometres away.
pub fn middle() -> impl Strategy<Value = DVec3> {
    prop_oneof![2 => Just(DVec3::ZERO), 1 => vector(1e7), 1 => Just(DVec3::new(1e7, 0.0, -1e7))]
}

pub fn shot(middle: DVec3) -> impl Strategy<Value = Shot> {
    let projection = prop_oneof![
        3 => Just(Projection::Infinite),
        1 => Just(Projection::Finite),
        1 => Just(Projection::FiniteReversed),
        1 => Just(Projection::Parallel),
    ];
    (vector(20.0), direction(), 5.0..120.0, 0.01..2.0, projection).prop_map(move |(eye, to, fov_y_deg, near, kind)| {
        let eye = middle + eye;
        Shot::new(Camera { eye, target: eye + to * 10.0, fov_y_deg, near, ..Camera::default() }, kind)
    })
}

/// A light's centre: a point near or far, or a direction.
pub fn light(middle: DVec3) -> impl Strategy<Value = DVec4> {
    prop_oneof![
        3 => vector(30.0).prop_map(move |p| (middle + p).extend(1.0)),
        1 => vector(1e5).prop_map(move |p| (middle + p).extend(1.0)),
        3 => direction().prop_map(|d| d.extend(0.0)),
    ]
}

/// A point on the way from `from` to the light; up to 100 metres away for a directional one.
pub fn on_the_way(from: DVec3, light: DVec4, share: f64) -> DVec3 {
    let reach = if light.w == 0.0 { 100.0 } else { 1.0 };
    from + (light.truncate() - from * light.w) * (share * reach)
}

/// A box of half size `half` around a point that has `inside` (its coordinates in [−1, 1]) at
/// `point`.
pub fn box_with(point: DVec3, half: DVec3, inside: DVec3) -> Bounds {
    let center = point - half * inside;
    // A coordinate may round to the wrong side of the point.
    Bounds { min: center - half, max: center + half }.with(point)
}
