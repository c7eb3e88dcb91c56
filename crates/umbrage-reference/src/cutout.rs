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
    /// Index into `Cutouts::textures`.
    texture: usize,
    /// The texture's alpha from which on the surface is there.
    cutoff: f32,
}

/// What an instance's material does to its triangles.
pub(crate) enum Holes {
    /// No holes.
    None,
    /// Nothing but holes.
    All,
    /// Index into the textures, and the alpha from which on the surface is there.
    Texture(usize, f32),
}

impl Cutouts {
    /// Keeps a copy of the textures that masks use.
    pub fn holes(&mut self, scene: &Scene, instance: &Instance) -> Holes {
        let Some(material) = scene.materials.get(instance.material) else { return Holes::None };
        let Some(cutoff) = material.alpha_cutoff else { return Holes::None };
        let opacity = material.base_color.w;
        let texture = material.texture.and_then(|t| scene.textures.get(t));
        match texture.filter(|t| t.width > 0 && t.height > 0 && t.rgba.len() >= t.width as usize * t.height as usize) {
            None if opacity >= cutoff => Holes::None,
            None => Holes::All,
            Some(texture) => {
                let index = self.textures.iter().position(|t| t == texture).unwrap_or_else(|| {
                    self.textures.push(texture.clone());
                    self.textures.len() - 1
                });
                // alpha · opacity ≥ cutoff; of a quite transparent material nothing is there,
                // unless all is.
                match (opacity > 0.0, cutoff > 0.0) {
                    (_, false) => Holes::None,
                    (false, _) => Holes::All,
                    (true, true) => Holes::Texture(index, cutoff / opacity),
                }
            }
        }
    }

    /// The number of a new cut-out triangle.
    pub fn add(&mut self, mesh: &Mesh, corners: [u32; 3], texture: usize, cutoff: f32) -> u32 {
        let uvs = corners.map(|i| mesh.uvs.get(i as usize).copied().unwrap_or(Vec2::ZERO));
        self.triangles.push(Cutout { uvs, texture, cutoff });
        self.triangles.len() as u32 - 1
    }
}

impl Opacity for Cutouts {
    fn stops(&self, triangle: &Triangle, seen: &SeenTriangle, direction: DVec3) -> bool {
        if triangle.cutout == Triangle::OPAQUE {
            return true;
        }
        let Some(cutout) = self.triangles.get(triangle.cutout as usize) else { return true };
        let shares = seen.barycentric(direction);
        let uv: Vec2 = cutout.uvs.iter().zip(shares).map(|(uv, share)| *uv * share as f32).sum();
        !uv.is_finite() || self.textures[cutout.texture].alpha(uv) >= cutout.cutoff
    }
}
