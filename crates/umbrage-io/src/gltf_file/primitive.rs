//! Mesh primitives.

use super::accessor::Accessors;
use super::appearance::Coordinates;
use super::{File, document};
use crate::Error;
use crate::limits::LARGEST;
use crate::model::{is_usable, is_usable_uv};
use glam::{Vec2, Vec3};
use gltf::Semantic;
use gltf::accessor::Dimensions;
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use umbrage_core::Mesh;

/// Reads a primitive; `None`, and a note, where it has no triangles.
pub(super) fn read(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    mesh: &gltf::Mesh<'_>,
    primitive: &gltf::Primitive<'_>,
) -> Result<Option<Mesh>, Error> {
    let part = format!("mesh {}, primitive {}", mesh.index(), primitive.index());
    if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        file.note(format!("{part} holds {:?}, not triangles, and was left out", primitive.mode()));
        return Ok(None);
    }
    let Some(positions) = primitive.get(&Semantic::Positions) else {
        file.note(format!("{part} has no positions and was left out"));
        return Ok(None);
    };
    if primitive.morph_targets().next().is_some() {
        file.note("morph targets are not applied");
    }
    let draco = "KHR_draco_mesh_compression";
    if primitive.extension_value(draco).is_some() && positions.view().is_none() && positions.sparse().is_none() {
        let what = format!("its triangles are stored by `{draco}`, which cannot be read");
        return Err(file.error(part, what).remedy(document::remedy(draco)));
    }
    let positions: Vec<Vec3> = accessors.floats::<3>(&positions)?.into_iter().map(Vec3::from).collect();
    if let Some(vertex) = positions.iter().position(|p| !is_usable(*p)) {
        let what = format!("vertex {vertex} is at {}, which is not finite or too far away", positions[vertex]);
        return Err(file.error(part, what));
    }
    let corners = match primitive.indices() {
        Some(indices) => accessors.integers::<1>(&indices)?.into_iter().map(|[i]| i).collect(),
        None => (0..positions.len() as u32).collect::<Vec<u32>>(),
    };
    if let Some(index) = corners.iter().find(|&&i| i as usize >= positions.len()) {
        let what = format!("index {index} is out of range: there are {} vertices", positions.len());
        return Err(file.error(part, what).remedy("the file may be damaged: export it again"));
    }
    if corners.is_empty() {
        return Ok(None);
    }
    let attribute = |semantic: &Semantic| primitive.get(semantic);
    let normals = attribute(&Semantic::Normals).map(|a| accessors.floats::<3>(&a)).transpose()?.unwrap_or_default();
    let uvs = read_uvs(file, accessors, primitive, &part)?;
    let opacities = read_opacities(file, accessors, primitive)?;
    let counts = [("normals", normals.len()), ("texture coordinates", uvs.len()), ("colours", opacities.len())];
    for (what, count) in counts {
        if count != 0 && count != positions.len() {
            return Err(file.error(part, format!("has {count} {what} for {} vertices", positions.len())));
        }
    }
    if let Some(vertex) = uvs.iter().position(|uv| !is_usable_uv(*uv)) {
        let what = format!("the texture coordinate of vertex {vertex} is {}, not finite or too large", uvs[vertex]);
        return Err(file.error(part, what));
    }
    if let Some(vertex) = opacities.iter().position(|o| !(0.0..=LARGEST as f32).contains(o)) {
        let what = format!("the opacity of vertex {vertex} is {}: negative, or not finite", opacities[vertex]);
        return Err(file.error(part, what));
    }
    let mut mesh = Mesh {
        name: mesh.name().map_or(part.clone(), |name| format!("{name} ({part})")),
        indices: triangles(file, &part, primitive.mode(), &corners)?,
        normals: normals.into_iter().map(|n| Vec3::from(n).try_normalize().unwrap_or(Vec3::Y)).collect(),
        positions,
        uvs,
        opacities,
        ..Mesh::default()
    };
    mesh.generate_normals_if_absent();
    Ok(Some(mesh))
}

/// Where the vertices look up the base colour, if it has a picture.
fn read_uvs(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    primitive: &gltf::Primitive<'_>,
    part: &str,
) -> Result<Vec<Vec2>, Error> {
    let Some(coordinates) = Coordinates::of(&primitive.material()) else { return Ok(Vec::new()) };
    let Some(uvs) = primitive.get(&Semantic::TexCoords(coordinates.set)) else {
        file.note(format!("{part} has no texture coordinates {}: it has the colour of one pixel", coordinates.set));
        return Ok(Vec::new());
    };
    Ok(accessors.floats::<2>(&uvs)?.into_iter().map(|uv| coordinates.place(uv)).collect())
}

/// The opacity of the vertices, where the material has an alpha mask.
fn read_opacities(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    primitive: &gltf::Primitive<'_>,
) -> Result<Vec<f32>, Error> {
    let Some(colors) = primitive.get(&Semantic::Colors(0)) else { return Ok(Vec::new()) };
    file.note("colours of vertices are not read, except for their opacity in alpha masks");
    if primitive.material().alpha_mode() != AlphaMode::Mask || colors.dimensions() != Dimensions::Vec4 {
        return Ok(Vec::new());
    }
    Ok(accessors.floats::<4>(&colors)?.into_iter().map(|[_, _, _, alpha]| alpha).collect())
}

/// Corners of separate triangles, after the specification's section 3.7.2.1.
fn triangles(file: &File<'_>, part: &str, mode: Mode, corners: &[u32]) -> Result<Vec<u32>, Error> {
    Ok(match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .flat_map(|(i, c)| if i % 2 == 0 { [c[0], c[1], c[2]] } else { [c[0], c[2], c[1]] })
            .collect(),
        Mode::TriangleFan => {
            let [first, rest @ ..] = corners else { return Ok(Vec::new()) };
            rest.windows(2).flat_map(|c| [c[0], c[1], *first]).collect()
        }
        _ if corners.len().is_multiple_of(3) => corners.to_vec(),
        _ => {
            let what = format!("{} corners do not make whole triangles", corners.len());
            return Err(file.error(part, what).remedy("the file may be cut off: export it again"));
        }
    })
}
