//! The light as the shader of the fins reads it, and how far behind edges anything is seen.

use crate::area_light::{Face, Form};
use crate::shader::{HostConstant, shader_struct};
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat3, DVec3};
use umbrage_core::light_view::LightView;

shader_struct! {
    /// See `fin_share.wgsl`.
    pub(crate) struct SmoothieLight {
        to_light: [[f32; 4]; 3],
        half_axes: [[f32; 4]; 3],
        center: [f32; 3],
        farthest: f32,
        face: u32,
        is_parallel: u32,
        pad_a: u32,
        pad_b: u32,
    }
}

/// What `fin_share.wgsl` calls the faces of lights.
pub(super) const FACES: &[HostConstant] = &[
    ("SPHERE", Face::Sphere as u32 as f64),
    ("DISC", Face::Disc as u32 as f64),
    ("SQUARE", Face::Square as u32 as f64),
    ("LINE", Face::Line as u32 as f64),
];

impl SmoothieLight {
    /// For casters relative to `origin`, and receivers no farther from the light than this depth.
    pub(super) fn new(form: &Form, origin: DVec3, farthest: f32) -> Self {
        let from_light = form.to_light.inverse();
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).extend(0.0).as_vec4().to_array());
        // How far the light reaches along the axes of its own space.
        let reach = match form.face {
            Face::Sphere => DVec3::ONE,
            Face::Line => DVec3::X,
            _ => DVec3::new(1.0, 1.0, 0.0),
        };
        let half_axes = from_light * DMat3::from_diagonal(reach);
        Self {
            to_light: rows(form.to_light),
            half_axes: rows(half_axes.transpose()),
            center: ((form.center.truncate() - origin) * form.center.w).as_vec3().to_array(),
            farthest,
            face: if form.face == Face::Picture { Face::Square } else { form.face } as u32,
            is_parallel: u32::from(form.center.w == 0.0),
            ..Self::default()
        }
    }
}

/// The least depth of a receiver in a view: 0 where there is no telling.
pub(super) fn farthest_depth(view: &LightView, receivers: &[Bounds]) -> f32 {
    let corners = || receivers.iter().flat_map(Bounds::corners);
    let depth = if view.paraboloid.is_some() {
        let farthest = corners().map(|p| p.distance(view.eye())).fold(0.0, f64::max);
        view.clip_from_world.row(2).w / farthest
    } else {
        let clips = corners().map(|p| view.clip_from_world * p.extend(1.0));
        // What is behind the light it does not see.
        let is_seen = |w: f64| w > 0.0 || !view.is_perspective();
        clips.filter(|c| is_seen(c.w)).map(|c| if c.w > 0.0 { c.z / c.w } else { 0.0 }).fold(f64::INFINITY, f64::min)
    };
    // A little less, for what is rounded.
    if depth.is_finite() { (depth * 0.999).clamp(0.0, 1.0) as f32 } else { 0.0 }
}
