//! The light as the shader of the fins reads it.

use crate::area_light::{Face, Form, LINE_WIDTH};
use crate::shader::{HostConstant, shader_struct};
use umbrage_core::Bounds;
use umbrage_core::glam::{DMat3, DVec3};

shader_struct! {
    /// See `fin_share.wgsl`.
    pub(crate) struct SmoothieLight {
        to_light: [[f32; 4]; 3],
        half_axes: [[f32; 4]; 3],
        center: [f32; 3],
        reach: f32,
        low: [f32; 3],
        face: u32,
        high: [f32; 3],
        pad: u32,
    }
}

/// What `fin_share.wgsl` calls the faces of lights.
pub(super) const FACES: &[HostConstant] = &[
    ("SPHERE", Face::Sphere as u32 as f64),
    ("DISC", Face::Disc as u32 as f64),
    ("SQUARE", Face::Square as u32 as f64),
    ("LINE", Face::Line as u32 as f64),
    ("LINE_WIDTH", LINE_WIDTH as f32 as f64),
];

impl SmoothieLight {
    /// For casters relative to `origin`, and receivers in a box.
    pub(super) fn new(form: &Form, origin: DVec3, receivers: &Bounds) -> Self {
        let from_light = form.to_light.inverse();
        let rows = |m: DMat3| [0, 1, 2].map(|i| m.row(i).extend(0.0).as_vec4().to_array());
        // How far the light reaches along the axes of its own space.
        let reach = match form.face {
            Face::Sphere => DVec3::ONE,
            Face::Line => DVec3::X,
            _ => DVec3::new(1.0, 1.0, 0.0),
        };
        let half_axes = from_light * DMat3::from_diagonal(reach);
        let squares = [0, 1, 2].map(|i| half_axes.col(i).length_squared());
        let single = |p: DVec3| (p - origin).as_vec3().to_array();
        Self {
            to_light: rows(form.to_light),
            half_axes: rows(half_axes.transpose()),
            center: ((form.center.truncate() - origin) * form.center.w).as_vec3().to_array(),
            reach: squares.iter().sum::<f64>().sqrt() as f32,
            low: single(receivers.min),
            high: single(receivers.max),
            face: if form.face == Face::Picture { Face::Square } else { form.face } as u32,
            pad: 0,
        }
    }
}
