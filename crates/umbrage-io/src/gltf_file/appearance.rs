//! Materials and their base-colour pictures.
//!
//! | glTF | here |
//! |---|---|
//! | base colour factor and texture | base colour and texture, for metals too: without an environment to mirror they would be black |
//! | metallic m, roughness r | specular = luminance of mix(0.04, base colour, m), the reflectance at normal incidence; shininess = 2 / r⁴ − 2 in 1…2048 (the Blinn–Phong exponent of a GGX lobe of α = r²; B. Walter et al., "Microfacet models for refraction", 2007) |
//! | metallic-roughness texture | not read; its factors count as m = 0 and r / 2 |
//! | emissive factor | emissive; 0 where a texture says where, which is not read |
//! | alpha mode MASK | alpha mask |
//! | alpha mode BLEND | opaque, with a note |

use super::{File, buffers};
use crate::{Error, pictures};
use glam::{Vec3, Vec4};
use gltf::Document;
use gltf::material::AlphaMode;
use std::collections::HashMap;
use std::path::Path;
use umbrage_core::{Material, Texture};

/// What stands for the name of a picture inside the file.
const EMBEDDED: &str = "its data";

/// Reads materials and pictures when they are first used.
pub(super) struct Appearance<'a> {
    document: &'a Document,
    buffers: &'a [Vec<u8>],
    materials: Vec<Material>,
    textures: Vec<Texture>,
    /// Index into `materials` by index in the file; `None` is the default material.
    material_of: HashMap<Option<usize>, usize>,
    /// Index into `textures` by index of the image.
    texture_of: HashMap<usize, usize>,
}

impl<'a> Appearance<'a> {
    pub fn new(document: &'a Document, buffers: &'a [Vec<u8>]) -> Self {
        Self {
            document,
            buffers,
            materials: Vec::new(),
            textures: Vec::new(),
            material_of: HashMap::new(),
            texture_of: HashMap::new(),
        }
    }

    /// The materials and textures that were used.
    pub fn into_parts(self) -> (Vec<Material>, Vec<Texture>) {
        (self.materials, self.textures)
    }

    /// Index of a material.
    pub fn material(&mut self, file: &mut File<'_>, material: &gltf::Material<'_>) -> Result<usize, Error> {
        if let Some(index) = self.material_of.get(&material.index()) {
            return Ok(*index);
        }
        let read = self.read(file, material)?;
        self.materials.push(read);
        self.material_of.insert(material.index(), self.materials.len() - 1);
        Ok(self.materials.len() - 1)
    }

    fn read(&mut self, file: &mut File<'_>, material: &gltf::Material<'_>) -> Result<Material, Error> {
        let Some(index) = material.index() else { return Ok(Material::default()) };
        let part = format!("material {index}");
        let pbr = material.pbr_metallic_roughness();
        let texture = pbr.base_color_texture().map(|t| self.texture(file, &t.texture())).transpose()?;
        let textured = pbr.metallic_roughness_texture().is_some();
        let (metallic, roughness) = (pbr.metallic_factor(), pbr.roughness_factor());
        let (metallic, roughness) = if textured { (0.0, roughness * 0.5) } else { (metallic, roughness) };
        let base_color = Vec4::from(pbr.base_color_factor());
        let emissive = Vec3::from(material.emissive_factor());
        let cutoff = material.alpha_cutoff().unwrap_or(0.5);
        for (what, values) in [
            ("base colour", base_color),
            ("emissive colour", emissive.extend(0.0)),
            ("metallic and roughness", Vec4::new(metallic, roughness, 0.0, 0.0)),
            ("alpha cut-off", Vec4::splat(cutoff)),
        ] {
            if !values.is_finite() || values.min_element() < 0.0 {
                return Err(file.error(part, format!("its {what} is negative or not finite")));
            }
        }
        let name = material.name().map_or(part, str::to_owned);
        if material.alpha_mode() == AlphaMode::Blend {
            file.note(format!("`{name}` is transparent: its shadow is that of an opaque surface"));
        }
        if material.emissive_texture().is_some() && emissive != Vec3::ZERO {
            file.note(format!("`{name}` glows where a texture says: that is not read"));
        }
        let masked = material.alpha_mode() == AlphaMode::Mask;
        let reflectance = Vec3::splat(0.04).lerp(base_color.truncate(), metallic.min(1.0));
        Ok(Material {
            base_color: base_color.truncate().extend(if masked { base_color.w } else { 1.0 }),
            texture,
            specular: reflectance.dot(Vec3::new(0.2126, 0.7152, 0.0722)),
            shininess: (2.0 / roughness.powi(4) - 2.0).clamp(1.0, 2048.0),
            emissive: if material.emissive_texture().is_some() { Vec3::ZERO } else { emissive },
            alpha_cutoff: masked.then_some(cutoff),
        })
    }

    fn texture(&mut self, file: &File<'_>, texture: &gltf::Texture<'_>) -> Result<usize, Error> {
        let index = texture.source().index();
        if let Some(known) = self.texture_of.get(&index) {
            return Ok(*known);
        }
        let part = format!("image {index}");
        // By its JSON, since `Image::source` panics on an image that lacks its media type.
        let image = self.document.as_json().images.get(index);
        let view = image.and_then(|i| i.buffer_view).and_then(|v| self.document.views().nth(v.value()));
        let uri = image.and_then(|i| i.uri.as_deref());
        let read = match (view, uri) {
            (Some(view), _) => {
                let bytes = buffers::view(self.buffers, &view)
                    .ok_or_else(|| file.error(&part, "does not lie within its buffer"))?;
                pictures::texture_from_bytes(Path::new(EMBEDDED), bytes)
            }
            (None, Some(uri)) => {
                let bytes = buffers::resolve(file, &part, uri)?;
                let data = uri.starts_with("data:");
                let name = if data { EMBEDDED.into() } else { buffers::resolve_path(file, uri) };
                pictures::texture_from_bytes(&name, &bytes)
            }
            (None, None) => return Err(file.error(part, "names neither a file nor a buffer view")),
        };
        let texture = read.map_err(|e| file.error(&part, e))?;
        self.textures.push(texture);
        self.texture_of.insert(index, self.textures.len() - 1);
        Ok(self.textures.len() - 1)
    }
}

/// The set of texture coordinates that a material's base colour goes by.
pub(super) fn uv_set(material: &gltf::Material<'_>) -> u32 {
    material.pbr_metallic_roughness().base_color_texture().map_or(0, |t| t.tex_coord())
}
