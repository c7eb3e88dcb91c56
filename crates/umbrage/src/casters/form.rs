//! How the buffers of a draw lie in memory: as the library has them, or as a host does.

use super::lent::{LentVertices, MatrixForm};
use wgpu::{VertexAttribute, VertexBufferLayout, VertexFormat, VertexStepMode};

/// What pipelines that draw casters differ in by the buffers that they read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Form {
    pub positions: Stream,
    pub uvs: Uvs,
    /// Of a host's instances, and bytes from one to the next.
    pub matrices: Option<(MatrixForm, u64)>,
}

/// A vertex buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Stream {
    pub format: VertexFormat,
    /// Bytes from one to the next.
    pub stride: u64,
}

/// Where texture coordinates come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Uvs {
    /// With normals and opacities.
    Own,
    /// All are 0.
    Nothing,
    Lent(Stream),
}

impl Stream {
    pub fn of(vertices: &LentVertices) -> Self {
        Self { format: vertices.format, stride: vertices.stride }
    }
}

/// Slots of vertex buffers.
pub(super) const POSITIONS: u32 = 0;
pub(super) const NUMBERS: u32 = 1;
pub(super) const ATTRIBUTES: u32 = 2;
pub(super) const MATRICES: u32 = 3;

impl Form {
    /// The library's meshes and instances.
    pub const OWN: Self =
        Self { positions: Stream { format: VertexFormat::Float32x3, stride: 12 }, uvs: Uvs::Own, matrices: None };

    /// The vertex shader: those that take matrices of a host's have a name of their own.
    pub fn entry(&self, vertex: &str) -> String {
        if self.matrices.is_some() { format!("{vertex}_many") } else { vertex.into() }
    }

    /// Pipeline-overridable constants of the vertex shader, see `many.wgsl`.
    pub fn constants(&self, textured: bool) -> Vec<(&'static str, f64)> {
        let no_opacity = (textured && self.uvs != Uvs::Own).then_some(("HAS_OPACITY", 0.0));
        let rows = matches!(self.matrices, Some((MatrixForm::Rows3x4, _))).then_some(("ROWS", 1.0));
        no_opacity.into_iter().chain(rows).collect()
    }

    /// Has `make` use the layouts of the vertex buffers: positions and instance numbers, attributes
    /// where `textured`, and a host's matrices.
    pub fn with_layouts<R>(&self, textured: bool, make: impl FnOnce(&[Option<VertexBufferLayout<'_>>]) -> R) -> R {
        let at = |shader_location, format, offset| VertexAttribute { format, offset, shader_location };
        let position = [at(0, self.positions.format, 0)];
        // All instances that a host has in one buffer have one number.
        let number_stride = if self.matrices.is_some() { 0 } else { 4 };
        let number = [at(1, VertexFormat::Uint32, 0)];
        let (uv_stride, uv) = match self.uvs {
            Uvs::Own => (24, [at(3, VertexFormat::Float32x3, 12)]),
            Uvs::Nothing => (0, [at(3, VertexFormat::Float32x3, 0)]),
            Uvs::Lent(Stream { format, stride }) => (stride, [at(3, format, 0)]),
        };
        let layout = |array_stride, step_mode, attributes| VertexBufferLayout { array_stride, step_mode, attributes };
        let uvs = textured.then_some(layout(uv_stride, VertexStepMode::Vertex, &uv));
        let rows = self.matrices.map(|(form, stride)| (stride, form.offsets()));
        let row = |i: usize| at(4 + i as u32, VertexFormat::Float32x4, rows.map_or(0, |(_, offsets)| offsets[i]));
        let rows_at = [0, 1, 2, 3].map(row);
        let matrices = rows.map(|(stride, _)| layout(stride, VertexStepMode::Instance, &rows_at));
        let all = [
            Some(layout(self.positions.stride, VertexStepMode::Vertex, &position)),
            Some(layout(number_stride, VertexStepMode::Instance, &number)),
            uvs,
            matrices,
        ];
        let count = if self.matrices.is_some() { 4 } else { 2 + usize::from(textured) };
        make(&all[..count])
    }
}

/// Something for each form of buffers that casters have.
pub(crate) struct ByForm<T>(Vec<(Form, T)>);

impl<T> ByForm<T> {
    /// For the library's own.
    pub fn new(own: T) -> Self {
        Self(vec![(Form::OWN, own)])
    }

    /// Makes what casters need besides.
    pub fn follow(&mut self, forms: &[Form], make: impl Fn(Form) -> T) {
        for form in forms {
            if self.get(form).is_none() {
                self.0.push((*form, make(*form)));
            }
        }
    }

    /// What was made for a form.
    pub fn get(&self, form: &Form) -> Option<&T> {
        self.0.iter().find(|(known, _)| known == form).map(|(_, made)| made)
    }
}
