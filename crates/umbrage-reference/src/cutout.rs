//! Alpha masks: where a triangle has holes.

use crate::bvh::Opacity;
use crate::triangle::{SeenTriangle, Triangle};
use glam::{DVec3, Vec2};
use umbrage_core::{Instance, Mesh, Scene, Texture};

/// The alpha masks of a scene's triangles.
#[derive(Default)]
pub(crate) struct Cutouts {
    textures: Vec<Texture>,
    triangles: Vec<Cutout>,
}

struct Cutout {
    uvs: [Vec2; 3],
    opacities: [f32; 3],
    mask: Mask,
}

/// Where a surface is there: where its picture's alpha times its vertices' opacity is at least
/// `cutoff`.
#[derive(Clone, Copy)]
pub(crate) struct Mask {
    /// Index into `Cutouts::textures`; `None` is 1 all over.
    texture: Option<usize>,
    cutoff: f32,
}

/// What an instance's material does to its triangles.
pub(crate) enum Holes {
    /// No holes.
    None,
    /// Nothing but holes.
    All,
    /// Holes in each triangle.
    Some(Mask),
}

impl Cutouts {
    /// Keeps a copy of the textures that masks use.
    pub fn holes(&mut self, scene: &Scene, instance: &Instance, mesh: &Mesh) -> Holes {
        let Some(material) = scene.materials.get(instance.material) else { return Holes::None };
        let Some(cutoff) = material.alpha_cutoff else { return Holes::None };
        let opacity = material.base_color.w;
        let texture = material.texture.and_then(|t| scene.textures.get(t));
        let texture =
            texture.filter(|t| t.width > 0 && t.height > 0 && t.rgba.len() >= t.width as usize * t.height as usize);
        let varies = texture.is_some() || !mesh.opacities.is_empty();
        // alpha · opacity ≥ cutoff; of a quite transparent material nothing is there, unless all
        // is.
        match (cutoff > 0.0, opacity > 0.0) {
            (false, _) => Holes::None,
            (true, false) => Holes::All,
            (true, true) if varies => {
                let texture = texture.map(|t| self.index_of(t));
                Holes::Some(Mask { texture, cutoff: cutoff / opacity })
            }
            (true, true) if opacity >= cutoff => Holes::None,
            (true, true) => Holes::All,
        }
    }

    fn index_of(&mut self, texture: &Texture) -> usize {
        self.textures.iter().position(|t| t == texture).unwrap_or_else(|| {
            self.textures.push(texture.clone());
            self.textures.len() - 1
        })
    }

    /// The number of a new cut-out triangle.
    pub fn add(&mut self, mesh: &Mesh, corners: [u32; 3], mask: Mask) -> u32 {
        let uvs = corners.map(|i| mesh.uvs.get(i as usize).copied().unwrap_or(Vec2::ZERO));
        let opacities = corners.map(|i| mesh.opacities.get(i as usize).copied().unwrap_or(1.0));
        self.triangles.push(Cutout { uvs, opacities, mask });
        self.triangles.len() as u32 - 1
    }
}

impl Opacity for Cutouts {
    fn stops(&self, triangle: &Triangle, seen: &SeenTriangle, direction: DVec3) -> bool {
        if triangle.cutout == Triangle::OPAQUE {
            return true;
        }
        let Some(Cutout { uvs, opacities, mask }) = self.triangles.get(triangle.cutout as usize) else { return true };
        let shares = seen.barycentric(direction);
        let uv: Vec2 = uvs.iter().zip(shares).map(|(uv, share)| *uv * share as f32).sum();
        let opacity: f32 = opacities.iter().zip(shares).map(|(opacity, share)| opacity * share as f32).sum();
        let alpha = mask.texture.map_or(1.0, |texture| self.textures[texture].alpha(uv));
        !uv.is_finite() || alpha * opacity >= mask.cutoff
    }
}
