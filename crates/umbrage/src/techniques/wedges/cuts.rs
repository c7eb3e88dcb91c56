//! Casters that the light touches: triangles that its own plane cuts, see `cuts.wgsl`.

use super::draws::{Draw, HARD};
use super::records::Cut;
use super::shaders;
use super::tables::Term;
use crate::area_light::Form;
use crate::casters::Placed;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::shader::Shader;
use crate::silhouettes::Throw;
use crate::{gpu::Gpu, passes::Passes, view::View};
use umbrage_core::Mesh;
use umbrage_core::adjacency::{Adjacency, NONE};
use umbrage_core::glam::{DVec3, DVec4, Vec4};
use umbrage_core::silhouette::{facing, light_in_mesh};

/// Makes up for what wedges lack of what the light touches.
pub(super) static CUTS: Draw = Draw {
    vertex: "fullscreen",
    fragment: "add_cuts",
    shader: cuts_shader,
    shares: true,
    more: Some(cuts_layout),
    ..HARD
};

fn cuts_shader(term: Term) -> Shader {
    shaders::CUTS[term as usize]
}

fn cuts_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    layout(gpu, "cuts", wgpu::ShaderStages::FRAGMENT, &[STORAGE])
}

/// Planes that are this near to each other, as a share of their distances, are one.
const SAME: f64 = 1e-6;

/// Casters of no more triangles are corrected as a whole: also where points and the light are on
/// the same side of what the light does not touch.
const WHOLE: usize = 64;

/// Every pixel goes through all cuts: a caster with more, such as a bulb of many triangles around
/// the light, is left as it is.
const MOST: usize = 256;

/// Appends what the light cuts of a caster. The triangles that it touches count, and all others in
/// their planes, of which those at the light's side are turned the wrong way, too.
pub(super) fn cut(view: &View<'_>, form: &Form, touched: &Touched<'_>, into: &mut Vec<Cut>) {
    let Some(sides) = &touched.placed.sides else { return };
    let mesh = touched.mesh;
    let light = light_in_mesh(touched.throw.light, &sides.mesh_from_world, mesh.center);
    let caster = Caster { touched, is_mirrored: sides.is_mirrored, light, eye: view.camera.eye, off: view.rounding() };
    let first = into.len();
    let planes = caster.triangles(form, into);
    caster.edges(&planes, into);
    if into.len() - first > MOST {
        into.truncate(first);
    }
}

/// A caster that the light may touch.
pub(super) struct Touched<'a> {
    pub placed: &'a Placed,
    pub part: &'a Mesh,
    pub mesh: &'a Adjacency,
    pub throw: &'a Throw,
}

/// The same with what its triangles are told by.
struct Caster<'a> {
    touched: &'a Touched<'a>,
    is_mirrored: bool,
    /// In mesh space, see [`light_in_mesh`].
    light: Vec4,
    eye: DVec3,
    off: f64,
}

impl Caster<'_> {
    /// Relative to the eye.
    fn corner(&self, i: u32) -> DVec3 {
        let at = self.touched.part.positions[i as usize].as_dvec3();
        self.touched.placed.world_from_mesh.transform_point3(at) - self.eye
    }

    /// Whether the light is in front of a triangle, as shaders say.
    fn is_facing(&self, t: usize) -> bool {
        facing(self.touched.mesh.planes[t], self.light) > 0
    }

    /// Whether it runs counter-clockwise seen from the light.
    fn is_turned_right(&self, t: usize) -> bool {
        self.is_facing(t) != self.is_mirrored
    }

    /// Corners counter-clockwise seen from the light.
    fn turned(&self, t: usize) -> [DVec3; 3] {
        let [a, b, c] = self.touched.mesh.triangles[t].map(|i| self.corner(i));
        if self.is_turned_right(t) { [a, b, c] } else { [a, c, b] }
    }

    fn plane(&self, t: usize) -> DVec4 {
        let [a, b, c] = self.turned(t);
        let away = -(b - a).cross(c - a).normalize_or_zero();
        away.extend(away.dot(a))
    }

    fn record(&self, corners: [DVec3; 3], t: usize, is_edge: bool) -> Cut {
        let (front, both) = (self.is_facing(t), !self.touched.throw.is_body);
        let weight = |on: bool| if on || both { 1.0 } else { 0.0 };
        let [a, b, c] = corners.map(|p| p.as_vec3());
        Cut {
            a: a.extend(weight(front)).to_array(),
            b: b.extend(weight(!front)).to_array(),
            c: c.extend(0.0).to_array(),
            plane: self.plane(t).as_vec4().to_array(),
            off: self.off as f32,
            is_edge: if is_edge { 1.0 } else { 0.0 },
            ..Cut::default()
        }
    }

    fn with_area(&self) -> impl Iterator<Item = usize> + '_ {
        (0..).zip(&self.touched.mesh.planes).filter(|(_, plane)| **plane != Vec4::ZERO).map(|(t, _)| t)
    }

    /// Appends the triangles that the light touches; the planes to correct.
    fn triangles(&self, form: &Form, into: &mut Vec<Cut>) -> Vec<DVec4> {
        let center = self.touched.throw.light.truncate() - self.eye;
        let is_small = self.with_area().count() <= WHOLE;
        let mut planes: Vec<DVec4> = Vec::new();
        for t in self.with_area() {
            let corners = self.turned(t);
            let is_touched = form.touches(corners.map(|p| p - center));
            if is_touched {
                into.push(self.record(corners, t, false));
            }
            let plane = self.plane(t);
            if (is_touched || is_small) && !planes.iter().any(|other| is_same(*other, plane)) {
                planes.push(plane);
            }
            if planes.len() > MOST {
                break;
            }
        }
        planes
    }

    /// Appends the edges around what is in these planes.
    fn edges(&self, planes: &[DVec4], into: &mut Vec<Cut>) {
        let mut plane_of = vec![None; self.touched.mesh.triangles.len()];
        for t in self.with_area().filter(|_| !planes.is_empty()) {
            let own = self.plane(t);
            plane_of[t] = planes.iter().position(|plane| is_same(*plane, own));
        }
        for edge in &self.touched.mesh.edges {
            let [first, second] = edge.triangles;
            let first = first as usize;
            let second = (second != NONE).then_some(second as usize);
            let is_within = second.is_some_and(|t| plane_of[t] == plane_of[first]) && !edge.same_direction;
            if is_within && plane_of[first].is_some() {
                continue;
            }
            let [a, b] = edge.vertices.map(|i| self.corner(i));
            for (t, runs_along) in [(Some(first), true), (second, edge.same_direction)] {
                let Some(t) = t.filter(|t| plane_of[*t].is_some()) else { continue };
                let [a, b] = if runs_along == self.is_turned_right(t) { [a, b] } else { [b, a] };
                into.push(self.record([a, b, a], t, true));
            }
        }
    }
}

fn is_same(a: DVec4, b: DVec4) -> bool {
    let far = a.w.abs().max(b.w.abs()).max(f64::MIN_POSITIVE);
    a.truncate().dot(b.truncate()) > 1.0 - SAME && (a.w - b.w).abs() <= SAME * far
}

/// Cuts on the GPU.
#[derive(Default)]
pub(super) struct CutBuffer {
    made: Option<(wgpu::Buffer, wgpu::BindGroup)>,
}

impl CutBuffer {
    /// Makes room for so many: exactly, since the shader goes through all there is room for.
    pub fn prepare(&mut self, gpu: &Gpu, count: usize) {
        let size = (count * size_of::<Cut>()) as u64;
        if count == 0 || self.made.as_ref().is_some_and(|(buffer, _)| buffer.size() == size) {
            return;
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("cuts"),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = bind(gpu, "cuts", &cuts_layout(gpu), &[buffer.as_entire_binding()]);
        self.made = Some((buffer, group));
    }

    pub fn upload(&self, passes: &mut Passes<'_>, cuts: &[Cut]) {
        if let Some((buffer, _)) = self.made.as_ref().filter(|_| !cuts.is_empty()) {
            passes.upload(buffer, bytemuck::cast_slice(cuts));
        }
    }

    pub fn group(&self) -> Option<&wgpu::BindGroup> {
        self.made.as_ref().map(|(_, group)| group)
    }

    pub fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |(buffer, _)| buffer.size())
    }
}
