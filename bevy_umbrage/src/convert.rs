//! Bevy's meshes, materials and pictures as those of umbrage. The two have different versions of
//! their vector crate, so everything goes through arrays.

use bevy::color::ColorToComponents;
use bevy::image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::math::{Affine3A, Mat4};
use bevy::mesh::{Indices, Mesh, MeshVertexAttribute, PrimitiveTopology, VertexAttributeValues as Values};
use bevy::pbr::StandardMaterial;
use bevy::prelude::{AlphaMode, Vec3};
use bevy::render::render_resource::TextureFormat;
use umbrage::core::glam::{self, DAffine3, DMat4, DVec3};
use umbrage::core::material::{Filter, Sampling, Wrap};
use umbrage::core::rig::Influence;
use umbrage::core::{self as core, Texture};

/// A place or a direction.
pub fn vector(v: Vec3) -> DVec3 {
    glam::Vec3::from_array(v.to_array()).as_dvec3()
}

/// What takes a point somewhere.
pub fn affine(place: &Affine3A) -> DAffine3 {
    DAffine3::from_cols_array(&place.to_cols_array().map(f64::from))
}

/// A matrix.
pub fn matrix(m: &Mat4) -> DMat4 {
    DMat4::from_cols_array(&m.to_cols_array().map(f64::from))
}

/// A matrix without perspective, such as that of a joint.
pub fn affine_of(m: &Mat4) -> DAffine3 {
    DAffine3::from_mat4(matrix(m))
}

/// The triangles of a mesh; `None` where it has none, or its data are on the GPU alone.
pub fn mesh(source: &Mesh) -> Option<core::Mesh> {
    let Values::Float32x3(positions) = attribute(source, &Mesh::ATTRIBUTE_POSITION)? else { return None };
    let indices = match source.try_indices_option().ok()? {
        Some(Indices::U16(indices)) => indices.iter().copied().map(u32::from).collect(),
        Some(Indices::U32(indices)) => indices.clone(),
        None => (0..positions.len() as u32).collect(),
    };
    let indices = match source.primitive_topology() {
        PrimitiveTopology::TriangleList => indices,
        PrimitiveTopology::TriangleStrip => of_strip(&indices),
        _ => return None,
    };
    let count = positions.len() as u32;
    if indices.iter().any(|i| *i >= count) {
        return None;
    }
    let mut mesh = core::Mesh {
        positions: positions.iter().copied().map(glam::Vec3::from_array).collect(),
        indices,
        ..Default::default()
    };
    if let Some(Values::Float32x3(normals)) = attribute(source, &Mesh::ATTRIBUTE_NORMAL) {
        mesh.normals = normals.iter().copied().map(glam::Vec3::from_array).collect();
    }
    if let Some(Values::Float32x2(uvs)) = attribute(source, &Mesh::ATTRIBUTE_UV_0) {
        mesh.uvs = uvs.iter().copied().map(glam::Vec2::from_array).collect();
    }
    mesh.generate_normals_if_absent();
    let joints = attribute(source, &Mesh::ATTRIBUTE_JOINT_INDEX);
    let weights = attribute(source, &Mesh::ATTRIBUTE_JOINT_WEIGHT);
    if let (Some(joints), Some(Values::Float32x4(weights))) = (joints, weights) {
        for (joints, weights) in joint_numbers(joints).zip(weights) {
            let influence = |(joint, weight): (u16, f32)| Influence { joint: joint.into(), weight };
            let all: Vec<_> = joints.into_iter().zip(*weights).map(influence).collect();
            mesh.weights.push(&all);
        }
    }
    Some(mesh)
}

fn attribute<'a>(mesh: &'a Mesh, attribute: &MeshVertexAttribute) -> Option<&'a Values> {
    mesh.try_attribute_option(attribute.id).ok().flatten()
}

fn joint_numbers(values: &Values) -> impl Iterator<Item = [u16; 4]> {
    match values {
        Values::Uint16x4(joints) => joints.clone(),
        Values::Uint8x4(joints) => joints.iter().map(|four| four.map(u16::from)).collect(),
        _ => Vec::new(),
    }
    .into_iter()
}

/// Every other triangle of a strip is turned round.
fn of_strip(strip: &[u32]) -> Vec<u32> {
    let turned = |(number, corners): (usize, &[u32])| match number % 2 {
        0 => [corners[0], corners[1], corners[2]],
        _ => [corners[1], corners[0], corners[2]],
    };
    strip.windows(3).enumerate().flat_map(turned).collect()
}

/// Below this opacity Bevy's shadows leave out a surface that light goes through in part.
const BLENDED_CUTOFF: f32 = 0.05;

/// Where a material is cut out; its texture is left to the caller, who has [`texture`].
pub fn material(source: &StandardMaterial) -> core::Material {
    let alpha_cutoff = match source.alpha_mode {
        AlphaMode::Opaque | AlphaMode::Multiply => None,
        AlphaMode::Mask(cutoff) => Some(cutoff),
        AlphaMode::AlphaToCoverage => Some(0.5),
        AlphaMode::Blend | AlphaMode::Premultiplied | AlphaMode::Add => Some(BLENDED_CUTOFF),
    };
    let base_color = glam::Vec4::from_array(source.base_color.to_linear().to_f32_array());
    core::Material { base_color, alpha_cutoff, ..Default::default() }
}

/// A picture with an alpha channel; `None` for formats that the CPU can't read here, such as
/// compressed ones.
pub fn texture(name: String, source: &Image) -> Option<Texture> {
    let data = source.data.as_ref()?;
    let rgba = match source.texture_descriptor.format {
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb => data.as_chunks().0.to_vec(),
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => {
            data.as_chunks().0.iter().map(|&[b, g, r, a]| [r, g, b, a]).collect()
        }
        _ => source.convert(TextureFormat::Rgba8UnormSrgb)?.data?.as_chunks().0.to_vec(),
    };
    let (width, height) = (source.width(), source.height());
    // The rest, where there is more, are smaller versions.
    let count = width as usize * height as usize;
    let rgba = rgba.get(..count).filter(|_| count > 0)?.to_vec();
    Some(Texture { name, width, height, rgba, sampling: sampling(&source.sampler) })
}

fn sampling(sampler: &ImageSampler) -> Sampling {
    let standard = ImageSamplerDescriptor::linear();
    let of = match sampler {
        ImageSampler::Default => &standard,
        ImageSampler::Descriptor(descriptor) => descriptor,
    };
    let wrap = |mode: ImageAddressMode| match mode {
        ImageAddressMode::Repeat => Wrap::Repeat,
        ImageAddressMode::MirrorRepeat => Wrap::Mirror,
        ImageAddressMode::ClampToEdge | ImageAddressMode::ClampToBorder => Wrap::Clamp,
    };
    let filter = match of.mag_filter {
        ImageFilterMode::Nearest => Filter::Nearest,
        ImageFilterMode::Linear => Filter::Linear,
    };
    Sampling { wrap: [wrap(of.address_mode_u), wrap(of.address_mode_v)], filter }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::asset::RenderAssetUsages;

    fn bevys(topology: PrimitiveTopology, indices: Option<Indices>) -> Mesh {
        let corners = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.0]];
        let mesh = Mesh::new(topology, RenderAssetUsages::default());
        let mut mesh = mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, corners);
        indices.into_iter().for_each(|indices| mesh.insert_indices(indices));
        mesh
    }

    #[test]
    fn triangles_of_strips_face_one_way() {
        let strip = mesh(&bevys(PrimitiveTopology::TriangleStrip, None)).expect("triangles");
        assert_eq!(strip.indices, [0, 1, 2, 2, 1, 3, 2, 3, 4]);
        assert!(strip.normals.iter().all(|n| *n == glam::Vec3::Z), "{:?}", strip.normals);
    }

    #[test]
    fn what_has_no_triangles_is_no_mesh() {
        let list = |indices: Vec<u16>| mesh(&bevys(PrimitiveTopology::TriangleList, Some(Indices::U16(indices))));
        assert_eq!(list(vec![0, 1, 2]).map(|mesh| mesh.triangle_count()), Some(1));
        assert_eq!(list(vec![0, 1, 5]), None, "an index beyond the vertices");
        assert_eq!(mesh(&bevys(PrimitiveTopology::LineList, None)), None);
        assert_eq!(mesh(&Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())), None);
    }

    #[test]
    fn surfaces_are_cut_out_as_in_bevys_shadows() {
        let cutoff = |alpha_mode| material(&StandardMaterial { alpha_mode, ..Default::default() }).alpha_cutoff;
        assert_eq!(cutoff(AlphaMode::Opaque), None);
        assert_eq!(cutoff(AlphaMode::Mask(0.3)), Some(0.3));
        assert_eq!(cutoff(AlphaMode::Blend), Some(BLENDED_CUTOFF));
    }
}
