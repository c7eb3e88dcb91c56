//! Light-space fits: the views that a map technique renders.
//!
//! One perspective view for a spot, one orthographic view for a directional light, up to six faces of a cube for lights
//! that shine to all sides. With [`Focus::Visible`] each view is cropped to what the camera can see of the receivers
//! (Brabec, Annen and Seidel, "Practical Shadow Mapping"; SG "Extensions"), so that no texel is spent elsewhere; its
//! near side always reaches back to every caster.

use crate::{bounds::Bounds, camera::CameraView, frustum::Frustum, light::LightShape};
use glam::{DMat4, DVec2, DVec3, DVec4};

/// One view of a light.
#[derive(Clone, Debug, PartialEq)]
pub struct LightView {
    /// World to the light's clip space; reversed depth: perspective views store near / distance along the axis,
    /// orthographic ones fall linearly from 1 at the nearest caster to 0 at the farthest receiver.
    pub clip_from_world: DMat4,
    /// Texels across and down.
    pub size: u32,
    /// The layer of the map: the face of the cube (+X, −X, +Y, −Y, +Z, −Z), 0 for a single view.
    pub layer: u32,
}

/// How views are fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fit {
    /// What they cover.
    pub focus: Focus,
    /// Texels of the map across and down, at least 1.
    pub size: u32,
    /// Texels kept free at every border, so that filters find neighbours there.
    pub border_texels: f64,
}

/// What the views of a light cover.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Focus {
    /// What the camera can see of the receivers.
    Visible,
    /// All that the light can reach: the scene, the spot's cone, all sides.
    Light,
}

/// The boxes that a fit goes by.
#[derive(Clone, Debug, Default)]
pub struct FitScene {
    /// Around each caster.
    pub casters: Vec<Bounds>,
    /// Around each receiver.
    pub receivers: Vec<Bounds>,
}

/// Widest half angle of a single perspective view, as a tangent: 60 degrees. A spot that has to cover more gets the
/// faces of a cube.
const WIDEST: f64 = 1.732;

/// Near plane of perspective views over the distance of the farthest point. Reversed float depth loses nothing by a
/// small one.
const NEAR: f64 = 1e-5;

/// Fits the views of `light`, replacing what is in `views`. None are left where nothing that is seen can be in
/// shadow. Returns true where there are views and their layers are faces of a cube.
pub fn fit(light: &LightShape, camera: &CameraView, scene: &FitScene, fit: &Fit, views: &mut Vec<LightView>) -> bool {
    views.clear();
    let center = light.center();
    if center.w == 0.0 {
        views.extend(directional(-center.truncate(), camera, scene, fit));
        return false;
    }
    let position = center.truncate();
    let all = scene.casters.iter().chain(&scene.receivers).fold(Bounds::EMPTY, |b, c| b.union(*c));
    if all.is_empty() {
        return false;
    }
    let reach = all.corners().iter().map(|c| c.distance(position)).fold(0.0, f64::max);
    let near = (NEAR * reach).max(f64::MIN_POSITIVE);
    if let LightShape::Spot { direction, outer_angle_deg, .. } = *light
        && let Some(view) = spot(position, direction, outer_angle_deg, near, camera, scene, fit)
    {
        views.push(view);
        return false;
    }
    for (layer, (forward, up)) in FACES.into_iter().enumerate() {
        let face = Perspective { position, forward, up, near };
        let rect = match fit.focus {
            Focus::Light => Some(Rect { min: DVec2::NEG_ONE, max: DVec2::ONE }),
            Focus::Visible => face.visible(camera, &scene.receivers, 1.0),
        };
        if let Some(rect) = rect {
            let clip_from_world = crop(fit, rect) * face.clip_from_world();
            views.push(LightView { clip_from_world, size: fit.size, layer: layer as u32 });
        }
    }
    !views.is_empty()
}

/// Forward and up of the faces of a cube, in the order of the layers.
const FACES: [(DVec3, DVec3); 6] = [
    (DVec3::X, DVec3::Y),
    (DVec3::NEG_X, DVec3::Y),
    (DVec3::Y, DVec3::Z),
    (DVec3::NEG_Y, DVec3::Z),
    (DVec3::Z, DVec3::Y),
    (DVec3::NEG_Z, DVec3::Y),
];

/// A rectangle of normalised device coordinates.
#[derive(Clone, Copy, Debug)]
struct Rect {
    min: DVec2,
    max: DVec2,
}

impl Rect {
    fn of(points: impl Iterator<Item = DVec2>) -> Option<Self> {
        let empty = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
        let rect = points.fold(empty, |r, p| Self { min: r.min.min(p), max: r.max.max(p) });
        (rect.min.cmple(rect.max).all() && rect.min.is_finite() && rect.max.is_finite()).then_some(rect)
    }
}

/// Stretches `rect` and its border to the whole of clip space.
fn crop(fit: &Fit, rect: Rect) -> DMat4 {
    let size = f64::from(fit.size.max(1));
    let border = fit.border_texels.clamp(0.0, size * 0.25);
    let center = (rect.min + rect.max) * 0.5;
    // A receiver seen edge-on still needs a width; half a percent of the other side keeps texels sane.
    let half = (rect.max - rect.min) * 0.5;
    let half = half.max(DVec2::splat((half.max_element() * 0.005).max(1e-9))) * (size / (size - 2.0 * border));
    let scale = half.recip();
    let moved = -center * scale;
    DMat4::from_cols(
        DVec4::new(scale.x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, scale.y, 0.0, 0.0),
        DVec4::Z,
        DVec4::new(moved.x, moved.y, 0.0, 1.0),
    )
}

/// A view from a point with a square opening of 90 degrees.
struct Perspective {
    position: DVec3,
    forward: DVec3,
    up: DVec3,
    near: f64,
}

impl Perspective {
    fn clip_from_world(&self) -> DMat4 {
        let right = self.forward.cross(self.up).normalize();
        let up = right.cross(self.forward);
        let row = |axis: DVec3| axis.extend(-axis.dot(self.position));
        DMat4::from_cols(row(right), row(up), DVec4::new(0.0, 0.0, 0.0, self.near), row(self.forward)).transpose()
    }

    /// What the camera sees of the receivers within a half opening of `tangent`.
    fn visible(&self, camera: &CameraView, receivers: &[Bounds], tangent: f64) -> Option<Rect> {
        let clip_from_world = self.clip_from_world();
        let opening = DMat4::from_scale(DVec3::new(1.0 / tangent, 1.0 / tangent, 1.0)) * clip_from_world;
        let both = Frustum::of(&camera.clip_from_world()).and(&Frustum::of(&opening));
        let mut points = Vec::new();
        for bounds in receivers {
            both.clip_box(bounds, &mut points);
        }
        Rect::of(points.iter().map(|p| {
            let clip = clip_from_world * p.extend(1.0);
            (clip.truncate().truncate() / clip.w.max(self.near)).clamp(DVec2::splat(-tangent), DVec2::splat(tangent))
        }))
    }
}

fn spot(
    position: DVec3,
    direction: DVec3,
    outer_angle_deg: f64,
    near: f64,
    camera: &CameraView,
    scene: &FitScene,
    fit: &Fit,
) -> Option<LightView> {
    let view = Perspective { position, forward: direction, up: direction.any_orthonormal_vector(), near };
    let rect = match fit.focus {
        Focus::Light => {
            let tangent = outer_angle_deg.to_radians().tan();
            if !(0.0..=WIDEST).contains(&tangent) {
                return None;
            }
            Rect { min: DVec2::splat(-tangent), max: DVec2::splat(tangent) }
        }
        Focus::Visible => {
            let mut points = Vec::new();
            let seen = Frustum::of(&camera.clip_from_world());
            scene.receivers.iter().for_each(|b| seen.clip_box(b, &mut points));
            let inside = |p: &DVec3| {
                let clip = view.clip_from_world() * p.extend(1.0);
                clip.truncate().truncate().abs().max_element() <= WIDEST * clip.w
            };
            if !points.iter().all(inside) {
                return None;
            }
            view.visible(camera, &scene.receivers, WIDEST)?
        }
    };
    Some(LightView { clip_from_world: crop(fit, rect) * view.clip_from_world(), size: fit.size, layer: 0 })
}

fn directional(direction: DVec3, camera: &CameraView, scene: &FitScene, fit: &Fit) -> Option<LightView> {
    let mut points = Vec::new();
    match fit.focus {
        Focus::Light => points.extend(scene.receivers.iter().flat_map(Bounds::corners)),
        Focus::Visible => {
            let seen = Frustum::of(&camera.clip_from_world());
            scene.receivers.iter().for_each(|b| seen.clip_box(b, &mut points));
        }
    }
    let (right, up) = tightest_axes(direction, &points, fit.focus);
    let rect = Rect::of(points.iter().map(|p| DVec2::new(right.dot(*p), up.dot(*p))))?;
    // Heights along the way the light travels: from the first caster to the last receiver.
    let height = |p: DVec3| direction.dot(p);
    let last = points.iter().map(|p| height(*p)).fold(f64::NEG_INFINITY, f64::max);
    let corners = scene.casters.iter().flat_map(Bounds::corners).chain(points.iter().copied());
    let first = corners.map(height).fold(f64::INFINITY, f64::min);
    let margin = ((last - first) * 1e-4).max(1e-9 * (1.0 + first.abs().max(last.abs())));
    let (first, last) = (first - margin, last + margin);
    let depth = 1.0 / (last - first);
    let light_from_world = DMat4::from_cols(
        right.extend(0.0),
        up.extend(0.0),
        (-direction * depth).extend(last * depth),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    )
    .transpose();
    Some(LightView { clip_from_world: crop(fit, rect) * light_from_world, size: fit.size, layer: 0 })
}

/// Two axes across `direction` that give the points a small rectangle. A focus on the light keeps fixed axes, so that
/// the map does not turn with the camera.
fn tightest_axes(direction: DVec3, points: &[DVec3], focus: Focus) -> (DVec3, DVec3) {
    let a = direction.any_orthonormal_vector();
    let b = a.cross(direction);
    let axes = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        (a * cos + b * sin, b * cos - a * sin)
    };
    if focus == Focus::Light {
        return axes(0.0);
    }
    // A few extreme points in fixed directions stand for the hull.
    let hull: Vec<DVec3> = (0..32)
        .filter_map(|i| {
            let (u, _) = axes(std::f64::consts::TAU * f64::from(i) / 32.0);
            points.iter().copied().max_by(|p, q| u.dot(*p).total_cmp(&u.dot(*q)))
        })
        .collect();
    let area = |angle: f64| {
        let (u, v) = axes(angle);
        Rect::of(hull.iter().map(|p| DVec2::new(u.dot(*p), v.dot(*p))))
            .map_or(0.0, |r| (r.max - r.min).element_product())
    };
    let best = (0..24)
        .map(|i| std::f64::consts::FRAC_PI_2 * f64::from(i) / 24.0)
        .min_by(|x, y| area(*x).total_cmp(&area(*y)))
        .unwrap_or(0.0);
    axes(best)
}

/// How far, in pixels, one texel of the map that covers `point` reaches on the screen along the surface there with
/// `normal`: the largest singular value of ∂pixel/∂texel. `None` where no view covers the point.
pub fn texel_on_screen(
    views: &[LightView],
    camera: &CameraView,
    (width, height): (u32, u32),
    point: DVec3,
    normal: DVec3,
) -> Option<f64> {
    let covers = |v: &&LightView| {
        let c = v.clip_from_world * point.extend(1.0);
        c.w > 0.0 && c.x.abs() <= c.w && c.y.abs() <= c.w
    };
    let view = views.iter().find(covers)?;
    let (s, t) = normal.try_normalize()?.any_orthonormal_pair();
    let half = |w: u32, h: u32| DVec2::new(f64::from(w), f64::from(h)) * 0.5;
    // Change of the place in a picture when the point moves along an axis of the surface.
    let change = |clip_from_world: &DMat4, scale: DVec2, axis: DVec3| {
        let (p, d) = (*clip_from_world * point.extend(1.0), *clip_from_world * axis.extend(0.0));
        (d.truncate().truncate() * p.w - p.truncate().truncate() * d.w) / (p.w * p.w) * scale
    };
    let texels = [s, t].map(|a| change(&view.clip_from_world, half(view.size, view.size), a));
    let pixels = [s, t].map(|a| change(&camera.clip_from_world(), half(width, height), a));
    let det = texels[0].perp_dot(texels[1]);
    if det.abs() < f64::MIN_POSITIVE {
        return Some(f64::INFINITY);
    }
    let x = (pixels[0] * texels[1].y - pixels[1] * texels[0].y) / det;
    let y = (pixels[1] * texels[0].x - pixels[0] * texels[1].x) / det;
    // Largest singular value of the 2×2 matrix with columns x and y.
    let (sum, product) = (x.length_squared() + y.length_squared(), x.perp_dot(y));
    Some(((sum + (sum * sum - 4.0 * product * product).max(0.0).sqrt()) * 0.5).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;

    fn floor() -> Bounds {
        Bounds { min: DVec3::new(-5.0, 0.0, -5.0), max: DVec3::new(5.0, 0.0, 5.0) }
    }

    fn crate_above() -> Bounds {
        Bounds { min: DVec3::new(-1.0, 1.0, -1.0), max: DVec3::new(1.0, 2.0, 1.0) }
    }

    fn scene() -> FitScene {
        FitScene { casters: vec![crate_above()], receivers: vec![floor(), crate_above()] }
    }

    fn fit_of(light: &LightShape, focus: Focus, border_texels: f64) -> (Vec<LightView>, bool) {
        let camera = Camera { eye: DVec3::new(0.0, 6.0, 12.0), ..Camera::default() };
        let mut views = Vec::new();
        let fit_to = Fit { focus, size: 512, border_texels };
        let cube = fit(light, &camera.view(640, 480), &scene(), &fit_to, &mut views);
        (views, cube)
    }

    fn ndc(view: &LightView, p: DVec3) -> DVec3 {
        let c = view.clip_from_world * p.extend(1.0);
        c.truncate() / c.w
    }

    #[test]
    fn a_directional_view_holds_receivers_and_reaches_back_to_casters() {
        let light = LightShape::Directional { direction: DVec3::new(0.3, -1.0, 0.2).normalize(), angle_deg: 0.0 };
        for focus in [Focus::Light, Focus::Visible] {
            let (views, cube) = fit_of(&light, focus, 4.0);
            assert!(views.len() == 1 && !cube);
            let limit = 1.0 - 8.0 / 512.0 + 1e-9;
            for c in crate_above().corners() {
                let n = ndc(&views[0], c);
                assert!(n.x.abs() <= limit && n.y.abs() <= limit && (0.0..=1.0).contains(&n.z), "{focus:?} {n}");
            }
            assert!(ndc(&views[0], DVec3::new(0.0, 2.0, 0.0)).z > ndc(&views[0], DVec3::ZERO).z, "reversed depth");
        }
    }

    #[test]
    fn the_faces_of_a_cube_share_their_borders() {
        let light = LightShape::Point { position: DVec3::new(0.0, 3.0, 0.0) };
        let (views, cube) = fit_of(&light, Focus::Light, 0.0);
        assert!(cube && views.len() == 6);
        for direction in [DVec3::new(1.0, 0.2, 0.1), DVec3::new(-0.1, -1.0, 0.9), DVec3::new(0.3, 0.2, -1.0)] {
            let p = DVec3::new(0.0, 3.0, 0.0) + direction * 2.0;
            let seeing = views.iter().filter(|v| (v.clip_from_world * p.extend(1.0)).w > 0.0);
            let inside = seeing.filter(|v| ndc(v, p).truncate().abs().max_element() <= 1.0).count();
            assert_eq!(inside, 1, "{direction}");
        }
    }

    #[test]
    fn faces_that_see_no_receiver_are_left_out() {
        let light = LightShape::Point { position: DVec3::new(0.0, 30.0, 0.0) };
        let (views, _) = fit_of(&light, Focus::Visible, 0.0);
        assert_eq!(views.iter().map(|v| v.layer).collect::<Vec<_>>(), [3], "only the face that looks down");
    }

    #[test]
    fn a_spot_covers_what_is_seen_even_outside_its_cone() {
        let spot = |direction: DVec3| LightShape::Spot {
            position: DVec3::new(0.0, 20.0, 0.0),
            direction,
            inner_angle_deg: 5.0,
            outer_angle_deg: 6.0,
        };
        let (views, cube) = fit_of(&spot(DVec3::NEG_Y), Focus::Visible, 0.0);
        assert!(views.len() == 1 && !cube);
        assert!(ndc(&views[0], DVec3::new(3.0, 0.0, 0.0)).truncate().abs().max_element() <= 1.0);
        let (views, cube) = fit_of(&spot(DVec3::X), Focus::Visible, 0.0);
        assert!(cube && !views.is_empty(), "a floor below a level spot needs the faces of a cube");
    }

    #[test]
    fn nothing_to_see_needs_no_view() {
        let mut views = vec![];
        let camera = Camera::default().view(4, 3);
        let fit_to = Fit { focus: Focus::Visible, size: 16, border_texels: 0.0 };
        for light in [
            LightShape::Point { position: DVec3::ZERO },
            LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 },
        ] {
            fit(&light, &camera, &FitScene::default(), &fit_to, &mut views);
            assert!(views.is_empty());
        }
        // All of the scene is behind the camera: no room for six faces has to be made.
        let away = Camera { eye: DVec3::new(0.0, 6.0, 12.0), target: DVec3::new(0.0, 6.0, 99.0), ..Camera::default() };
        let position = DVec3::Y * 20.0;
        let spot = LightShape::Spot { position, direction: DVec3::NEG_Y, inner_angle_deg: 5.0, outer_angle_deg: 6.0 };
        for light in [LightShape::Point { position }, spot] {
            let cube = fit(&light, &away.view(4, 3), &scene(), &fit_to, &mut views);
            assert!(views.is_empty() && !cube, "{light:?}");
        }
    }

    #[test]
    fn a_texel_seen_from_the_light_itself_is_a_pixel() {
        // The camera is an orthographic light's twin: looking straight down, map and screen of the same scale.
        let light = LightShape::Directional { direction: DVec3::NEG_Y, angle_deg: 0.0 };
        let (views, _) = fit_of(&light, Focus::Light, 0.0);
        let camera = CameraView {
            eye: DVec3::Y,
            view_from_world: glam::DAffine3::IDENTITY,
            clip_from_view: views[0].clip_from_world,
        };
        let reach = texel_on_screen(&views, &camera, (512, 512), DVec3::ZERO, DVec3::Y).unwrap();
        assert!((reach - 1.0).abs() < 1e-9, "{reach}");
        let coarse = texel_on_screen(&views, &camera, (2048, 2048), DVec3::ZERO, DVec3::Y).unwrap();
        assert!((coarse - 4.0).abs() < 1e-9, "{coarse}");
    }
}
