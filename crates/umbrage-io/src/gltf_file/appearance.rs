//! Materials and their base-colour pictures.
//!
//! | glTF | here |
//! |---|---|
//! | base colour factor and texture | base colour and texture, for metals too: without an environment to mirror they would be black |
//! | metallic m, roughness r | specular = luminance of mix(0.04, base colour, m), the reflectance at normal incidence; shininess = 2 / r⁴ − 2 in 1…2048 (the Blinn–Phong exponent of a GGX lobe of α = r²; B. Walter et al., "Microfacet models for refraction", 2007) |
//! | metallic-roughness texture | not read; its factors count as m = 0 and r / 2 |
//! | `KHR_materials_pbrSpecularGlossiness` | diffuse → base colour, specular as it stands, r = 1 − glossiness |
//! | emissive factor | emissive; 0 where a texture says where, which is not read |
//! | alpha mode MASK | alpha mask |
//! | alpha mode BLEND, transmission | opaque, with a note |

use super::{File, buffers, document};
use crate::error::{self, Error, shown};
use crate::limits::{Budget, MOST_PIXELS_IN_ALL};
use crate::pictures;
use glam::{DAffine2, DMat2, Vec2, Vec3, Vec4};
use gltf::Document;
use gltf::material::AlphaMode;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};
use std::collections::HashMap;
use std::path::Path;
use umbrage_core::{Filter, Material, Sampling, Texture, Wrap};

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
    /// Index into `textures` by index of the image and sampling; `None` where it is missing.
    texture_of: HashMap<(usize, Sampling), Option<usize>>,
    pixels: Budget,
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
            pixels: Budget::new(MOST_PIXELS_IN_ALL),
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
        let masked = material.alpha_mode() == AlphaMode::Mask;
        let info = base_color_texture(material);
        let texture = info.map(|t| self.texture(file, &t.texture(), masked)).transpose()?.flatten();
        let look = Look::of(material);
        let emissive = Vec3::from(material.emissive_factor());
        let cutoff = material.alpha_cutoff().unwrap_or(0.5);
        for (what, values) in [
            ("base colour", look.base_color),
            ("emissive colour", emissive.extend(0.0)),
            ("reflectance and roughness", Vec4::new(look.reflectance, look.roughness, 0.0, 0.0)),
            ("alpha cut-off", Vec4::splat(cutoff)),
        ] {
            if !values.is_finite() || values.min_element() < 0.0 {
                return Err(file.error(part, format!("its {what} is negative or not finite")));
            }
        }
        let name = error::line(material.name().unwrap_or(&part));
        if material.alpha_mode() == AlphaMode::Blend || transmits(material) {
            file.note(format!("`{name}` is transparent: its shadow is that of an opaque surface"));
        }
        if material.emissive_texture().is_some() && emissive != Vec3::ZERO {
            file.note(format!("`{name}` glows where a texture says: that is not read"));
        }
        Ok(Material {
            base_color: look.base_color.truncate().extend(if masked { look.base_color.w } else { 1.0 }),
            texture,
            specular: look.reflectance,
            shininess: (2.0 / look.roughness.powi(4) - 2.0).clamp(1.0, 2048.0),
            emissive: if material.emissive_texture().is_some() { Vec3::ZERO } else { emissive },
            alpha_cutoff: masked.then_some(cutoff),
        })
    }

    /// Index of a texture; `None`, and a note, where there is no picture for it.
    fn texture(
        &mut self,
        file: &mut File<'_>,
        texture: &gltf::Texture<'_>,
        masked: bool,
    ) -> Result<Option<usize>, Error> {
        let part = format!("texture {}", texture.index());
        let Some(source) = texture.source() else {
            let Some(extension) = OTHER_PICTURES.into_iter().find(|e| texture.extension_value(e).is_some()) else {
                file.note(format!("{part} names no picture: its colour is left out"));
                return Ok(None);
            };
            let what = format!("its only picture is stored by `{extension}`, which cannot be read");
            if masked {
                return Err(file.error(part, what).remedy(document::remedy(extension)));
            }
            file.note(format!("{part}: {what}: its colour is left out"));
            return Ok(None);
        };
        let key = (source.index(), sampling(&texture.sampler()));
        if let Some(known) = self.texture_of.get(&key) {
            return Ok(*known);
        }
        let read = self.picture(file, source.index())?;
        let index = read.map(|read| {
            self.textures.push(Texture { sampling: key.1, ..read });
            self.textures.len() - 1
        });
        self.texture_of.insert(key, index);
        Ok(index)
    }

    /// The picture of an image; `None`, and a note, where its file is missing.
    fn picture(&mut self, file: &mut File<'_>, index: usize) -> Result<Option<Texture>, Error> {
        let part = format!("image {index}");
        // By its JSON, since `Image::source` panics on an image that lacks its media type.
        let image = self.document.as_json().images.get(index);
        let view = image.and_then(|i| i.buffer_view).and_then(|v| self.document.views().nth(v.value()));
        let uri = image.and_then(|i| i.uri.as_deref());
        let pixels = &mut self.pixels;
        let read = match (view, uri) {
            (Some(view), _) => {
                let bytes = buffers::view(self.buffers, &view)
                    .ok_or_else(|| file.error(&part, "does not lie within its buffer"))?;
                pictures::texture_within(Path::new(EMBEDDED), bytes, pixels)
            }
            (None, Some(uri)) if uri.starts_with("data:") => {
                pictures::texture_within(Path::new(EMBEDDED), &buffers::resolve(file, &part, uri)?, pixels)
            }
            (None, Some(uri)) => {
                let name = buffers::resolve_path(file, uri);
                if file.files.is_missing(&name) {
                    file.note(format!(
                        "{part}: the picture `{}` is missing: its colour and holes are left out",
                        shown(&name)
                    ));
                    return Ok(None);
                }
                pictures::load_within(file.files, &name, pixels)
            }
            (None, None) => return Err(file.error(part, "names neither a file nor a buffer view")),
        };
        read.map(Some).map_err(|e| file.pass_on(&part, &e))
    }
}

/// Base colour with its opacity, and the highlight.
struct Look {
    base_color: Vec4,
    /// At normal incidence.
    reflectance: f32,
    roughness: f32,
}

impl Look {
    fn of(material: &gltf::Material<'_>) -> Self {
        let luminance = |c: Vec3| c.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        if let Some(old) = material.pbr_specular_glossiness() {
            return Self {
                base_color: Vec4::from(old.diffuse_factor()),
                reflectance: luminance(Vec3::from(old.specular_factor())),
                roughness: 1.0 - old.glossiness_factor(),
            };
        }
        let pbr = material.pbr_metallic_roughness();
        let textured = pbr.metallic_roughness_texture().is_some();
        let (metallic, roughness) = (pbr.metallic_factor(), pbr.roughness_factor());
        let (metallic, roughness) = if textured { (0.0, roughness * 0.5) } else { (metallic, roughness) };
        let base_color = Vec4::from(pbr.base_color_factor());
        let reflectance = luminance(Vec3::splat(0.04).lerp(base_color.truncate(), metallic.min(1.0)));
        Self { base_color, reflectance, roughness }
    }
}

/// Extensions that store a picture in a format of their own.
const OTHER_PICTURES: [&str; 4] = ["KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "MSFT_texture_dds"];

/// True for glass and the like.
fn transmits(material: &gltf::Material<'_>) -> bool {
    let share = |extension, factor| {
        let value = material.extension_value(extension).and_then(|e| e.get(factor));
        value.and_then(|v| v.as_f64()).unwrap_or(0.0)
    };
    share("KHR_materials_transmission", "transmissionFactor") > 0.0
        || share("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor") > 0.0
}

fn base_color_texture<'a>(material: &gltf::Material<'a>) -> Option<gltf::texture::Info<'a>> {
    match material.pbr_specular_glossiness() {
        Some(old) => old.diffuse_texture(),
        None => material.pbr_metallic_roughness().base_color_texture(),
    }
}

fn sampling(sampler: &gltf::texture::Sampler<'_>) -> Sampling {
    let wrap = [sampler.wrap_s(), sampler.wrap_t()].map(|mode| match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::Mirror,
        WrappingMode::ClampToEdge => Wrap::Clamp,
    });
    // Level 0 is looked up from near and far, so that the filter for near decides, and what is said
    // for far where nothing is said for near.
    let is_nearest = match (sampler.mag_filter(), sampler.min_filter()) {
        (Some(near), _) => near == MagFilter::Nearest,
        (None, Some(far)) => {
            matches!(far, MinFilter::Nearest | MinFilter::NearestMipmapNearest | MinFilter::NearestMipmapLinear)
        }
        (None, None) => false,
    };
    Sampling { wrap, filter: if is_nearest { Filter::Nearest } else { Filter::Linear } }
}

/// How a material takes its base colour from the texture coordinates of vertices.
pub(super) struct Coordinates {
    /// Which set of them.
    pub set: u32,
    /// `KHR_texture_transform`.
    transform: DAffine2,
}

impl Coordinates {
    pub fn of(material: &gltf::Material<'_>) -> Option<Self> {
        let info = base_color_texture(material)?;
        let Some(transform) = info.texture_transform() else {
            return Some(Self { set: info.tex_coord(), transform: DAffine2::IDENTITY });
        };
        let [offset, scale] = [transform.offset(), transform.scale()].map(|v| Vec2::from(v).as_dvec2());
        // Counter-clockwise where v points down.
        let rotation = DMat2::from_angle(-f64::from(transform.rotation()));
        Some(Self {
            set: transform.tex_coord().unwrap_or(info.tex_coord()),
            transform: DAffine2 { matrix2: rotation * DMat2::from_diagonal(scale), translation: offset },
        })
    }

    /// Where a vertex looks up the picture.
    pub fn place(&self, uv: [f32; 2]) -> Vec2 {
        self.transform.transform_point2(Vec2::from(uv).as_dvec2()).as_vec2()
    }
}
