//! What binds edges and planes together with the vertices that they lie between: for each use what
//! it reads, since WebGPU promises eight storage buffers a stage, and casters and lists of
//! silhouettes take two.

use crate::casters::poses;
use crate::fullscreen::STORAGE;
use crate::{error::Error, gpu::Gpu};
use wgpu::ShaderStages as Stages;

/// Bindings as `edges.wgsl`, and what needs it, declare them in group 1.
const EDGES: u32 = 0;
const PAIRS: u32 = 1;
const POSITIONS: u32 = 2;
const INDICES: u32 = 3;
const INSTANCES: u32 = 4;
const NORMALS: u32 = 5;
const OFFSETS: u32 = 6;

const TOO_LARGE: &str = "a buffer of edges, planes or vertices (techniques with maps need none; the limit is the \
                         device's max_storage_buffer_binding_size)";

/// With the remedy.
pub(super) fn too_large(error: Error) -> Error {
    match error {
        Error::Size { size, limit, .. } => Error::Size { what: TOO_LARGE.into(), size, limit },
        other => other,
    }
}

/// What a shader reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reads {
    /// What silhouettes are found by.
    Sides,
    /// Edges that were found, where they are.
    Edges,
    /// The same, and whether the triangles at them have an area.
    Contour,
    /// All edges, found and placed in one shader.
    AllEdges,
    /// Triangles, and which way they face.
    Triangles,
}

impl Reads {
    const ALL: [Self; 5] = [Self::Sides, Self::Edges, Self::Contour, Self::AllEdges, Self::Triangles];

    fn bindings(self) -> &'static [u32] {
        match self {
            Self::Sides => &[PAIRS, NORMALS, OFFSETS],
            Self::Edges => &[EDGES, POSITIONS, INSTANCES],
            Self::Contour => &[EDGES, PAIRS, POSITIONS, INSTANCES, NORMALS],
            Self::AllEdges => &[EDGES, PAIRS, POSITIONS, INSTANCES, NORMALS, OFFSETS],
            Self::Triangles => &[POSITIONS, INDICES, INSTANCES, NORMALS, OFFSETS],
        }
    }

    /// Of [`Groups::get`].
    pub fn layout(self, gpu: &Gpu) -> wgpu::BindGroupLayout {
        let visibility = match self {
            Self::Sides | Self::Contour => Stages::COMPUTE,
            Self::AllEdges => Stages::VERTEX,
            Self::Edges | Self::Triangles => Stages::VERTEX | Stages::COMPUTE,
        };
        let entry = |&binding| wgpu::BindGroupLayoutEntry { binding, visibility, ty: STORAGE, count: None };
        let entries: Vec<_> = self.bindings().iter().map(entry).collect();
        gpu.bind_group_layout("edges", &entries)
    }

    fn group(self, gpu: &Gpu, of: &[wgpu::Buffer; 7]) -> wgpu::BindGroup {
        let entry = |&binding: &u32| {
            let resource = of[binding as usize].as_entire_binding();
            wgpu::BindGroupEntry { binding, resource }
        };
        let entries: Vec<_> = self.bindings().iter().map(entry).collect();
        let layout = &self.layout(gpu);
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("edges"), layout, entries: &entries })
    }
}

/// One bind group for each.
pub(super) struct Groups {
    groups: [wgpu::BindGroup; Reads::ALL.len()],
    /// What remakes planes of posed meshes.
    pub pose: wgpu::BindGroup,
    of: [wgpu::Buffer; 7],
}

impl Groups {
    /// `of`: in the order of the bindings.
    ///
    /// # Errors
    /// [`Error::Size`] where shaders may not have all of one.
    pub fn new(gpu: &Gpu, of: [wgpu::Buffer; 7]) -> Result<Self, Error> {
        let limit = gpu.device.limits().max_storage_buffer_binding_size;
        if let Some(size) = of.iter().map(wgpu::Buffer::size).find(|size| *size > limit) {
            return Err(Error::Size { what: TOO_LARGE.into(), size, limit });
        }
        let [indices, normals, offsets] = [INDICES, NORMALS, OFFSETS].map(|binding| &of[binding as usize]);
        Ok(Self {
            groups: Reads::ALL.map(|reads| reads.group(gpu, &of)),
            pose: poses::planes_group(gpu, [indices, normals, offsets]),
            of,
        })
    }

    pub fn get(&self, reads: Reads) -> &wgpu::BindGroup {
        &self.groups[reads as usize]
    }

    /// True where these are the buffers that are bound.
    pub fn are_of(&self, of: &[wgpu::Buffer; 7]) -> bool {
        self.of == *of
    }
}
