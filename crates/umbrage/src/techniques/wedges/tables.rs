//! Shares of a light that shaders look up: those of a disc, where tables are asked for, and those
//! of pictures.

use super::shaders;
use crate::area_light::{Face, Form};
use crate::fullscreen::{STORAGE, bind, layout};
use crate::gpu::Gpu;
use crate::shader::Shader;
use crate::view::View;
use half::f16;
use umbrage_core::coverage::{SphereTable, TexturedTable};
use umbrage_core::glam::DVec2;
use umbrage_core::sampling::Luminance;
use umbrage_core::{LightShape, Texture};
use wgpu::util::DeviceExt;

/// Values along each axis of a disc's table (PX 4.2).
const DISC_SIDE: usize = 32;

/// Values along each axis of a picture's table: 0.7 MB. Over lines across checkers, bars and a spot
/// 16 are off by up to 0.019, 24 by up to 0.011 and 32, three times as large and as slow to make,
/// by up to 0.007; a test in the core crate prints them.
const PICTURE_SIDE: usize = 24;

/// The same of a piece, which has fewer details and a part of the light: 0.13 MB.
const PIECE_SIDE: usize = 16;

/// Where the share that an edge covers comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    /// A formula.
    Analytic,
    /// A table for discs.
    Table,
    /// A table for one picture.
    Picture,
}

impl Term {
    /// What draws wedges.
    pub fn draw_shader(self) -> Shader {
        shaders::DRAWS[self as usize]
    }

    /// What makes visibility; discs have their horizon in closed form.
    pub fn resolve_shader(self) -> Shader {
        if self == Self::Picture { shaders::RESOLVE_PICTURE } else { shaders::RESOLVE }
    }

    /// Of group 2; unused by formulas.
    pub fn layout(self, gpu: &Gpu) -> wgpu::BindGroupLayout {
        let table = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D3,
            multisampled: false,
        };
        let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let all = [table, sampler, STORAGE];
        let used = [0, 2, 3][self as usize];
        layout(gpu, "shares of a light", wgpu::ShaderStages::FRAGMENT, &all[..used])
    }
}

/// The tables of a light.
pub(super) struct Tables {
    for_discs: bool,
    nothing: wgpu::BindGroup,
    disc: Option<wgpu::BindGroup>,
    picture: Option<Picture>,
}

/// What was made of a picture; nothing of one without light.
struct Picture {
    of: Texture,
    table: Option<wgpu::BindGroup>,
    /// Of a split light, row by row.
    pieces: Vec<PicturePiece>,
}

/// A part of a picture: its share of all light, and its own table if there is any.
struct PicturePiece {
    weight: f64,
    table: Option<wgpu::BindGroup>,
}

impl Tables {
    /// `for_discs`: spheres, discs and suns go by a table, too.
    pub fn new(gpu: &Gpu, for_discs: bool) -> Self {
        let nothing = bind(gpu, "shares of a light", &Term::Analytic.layout(gpu), &[]);
        Self { for_discs, nothing, disc: None, picture: None }
    }

    /// Makes the table that a light needs, a picture's once for as long as it shows the same, with
    /// one for each of `split` times `split` pieces. True where it shows one; a black one, as none,
    /// is an even light.
    pub fn prepare(&mut self, gpu: &Gpu, view: &View<'_>, split: usize) -> bool {
        if let LightShape::Rect { texture, .. } = view.light.shape {
            let shown = texture.and_then(|index| view.textures.get(index));
            return shown.is_some_and(|texture| self.prepare_picture(gpu, texture, split));
        }
        if self.for_discs && self.disc.is_none() {
            let table = SphereTable::new(DISC_SIDE);
            let values: Vec<f16> = table.values().as_flattened().iter().map(|v| f16::from_f32(*v)).collect();
            let side = DISC_SIDE as u32;
            let shares = texture(gpu, [side; 3], wgpu::TextureFormat::Rg16Float, &values);
            self.disc = Some(group(gpu, Term::Table, &shares, None));
        }
        false
    }

    fn prepare_picture(&mut self, gpu: &Gpu, texture: &Texture, split: usize) -> bool {
        // Whether it is the same is asked of its pixels, since hosts may change them where they
        // are.
        if self.picture.as_ref().is_none_or(|p| p.of != *texture) {
            let light = Luminance::of(texture);
            let of = |part: &Part, side| light.as_ref().and_then(|light| table_of(light, part, side));
            let made = |part: &Part, side| of(part, side).map(|table| upload(gpu, &table));
            let piece = |part: Part| PicturePiece {
                weight: light.as_ref().map_or(0.0, |light| light.within(part.low, part.high)),
                table: made(&part, PIECE_SIDE),
            };
            let pieces = if split > 1 { parts(split).map(piece).collect() } else { Vec::new() };
            self.picture = Some(Picture { of: texture.clone(), table: made(&Part::WHOLE, PICTURE_SIDE), pieces });
        }
        self.picture.as_ref().is_some_and(|p| p.table.is_some())
    }

    /// How shares of such a light are found.
    pub fn term(&self, face: Face) -> Term {
        match face {
            Face::Picture => Term::Picture,
            Face::Sphere | Face::Disc if self.for_discs => Term::Table,
            _ => Term::Analytic,
        }
    }

    /// The same of a light or a piece; pieces of discs have no table.
    pub fn term_of(&self, form: &Form) -> Term {
        if form.cell.is_some() { Term::Analytic } else { self.term(form.face) }
    }

    /// Group 2 of it.
    pub fn group(&self, term: Term) -> &wgpu::BindGroup {
        let made = match term {
            Term::Analytic => None,
            Term::Table => self.disc.as_ref(),
            Term::Picture => self.picture.as_ref().and_then(|p| p.table.as_ref()),
        };
        made.unwrap_or(&self.nothing)
    }

    /// Of a split light the group of its piece of this number; that of a dark one of a picture is
    /// never seen.
    pub fn group_of_piece(&self, term: Term, number: usize) -> &wgpu::BindGroup {
        let piece = self.picture.as_ref().and_then(|p| p.pieces.get(number)).filter(|_| term == Term::Picture);
        piece.and_then(|piece| piece.table.as_ref()).unwrap_or(self.group(term))
    }

    /// The share of a picture's light that a piece of it gives; `None` where there is no such
    /// piece.
    pub fn weight_of_piece(&self, number: usize) -> Option<f64> {
        self.picture.as_ref()?.pieces.get(number).map(|piece| piece.weight)
    }

    /// Bytes of the textures.
    pub fn bytes(&self) -> u64 {
        let values = |is_made, count: usize| if is_made { count } else { 0 };
        let has_picture = self.picture.as_ref().is_some_and(|p| p.table.is_some());
        let pieces = self.picture.iter().flat_map(|p| &p.pieces).filter(|p| p.table.is_some()).count();
        let count = values(self.disc.is_some(), 2 * DISC_SIDE.pow(3))
            + values(has_picture, PICTURE_SIDE.pow(4))
            + pieces * PIECE_SIDE.pow(4);
        (count * size_of::<f16>()) as u64
    }
}

/// A rectangle of a picture, which is from 0 to 1.
struct Part {
    low: DVec2,
    high: DVec2,
}

impl Part {
    const WHOLE: Self = Self { low: DVec2::ZERO, high: DVec2::ONE };
}

/// `count` times `count` of them, row by row.
fn parts(count: usize) -> impl Iterator<Item = Part> {
    (0..count * count).map(move |i| {
        let at = |step: usize| DVec2::new((i % count + step) as f64, (i / count + step) as f64) / count as f64;
        Part { low: at(0), high: at(1) }
    })
}

fn table_of(light: &Luminance, part: &Part, side: usize) -> Option<TexturedTable> {
    let on_picture = |p: [f64; 2]| part.low + (part.high - part.low) * (DVec2::from(p) * 0.5 + 0.5);
    TexturedTable::new(|low, high| light.within(on_picture(low), on_picture(high)), side)
}

fn upload(gpu: &Gpu, table: &TexturedTable) -> wgpu::BindGroup {
    let side = table.side() as u32;
    let values: Vec<f16> = table.triangles().iter().map(|v| f16::from_f32(*v)).collect();
    let triangles = texture(gpu, [side, side, side * side], wgpu::TextureFormat::R16Float, &values);
    let sectors = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("sectors of a picture"),
        contents: bytemuck::cast_slice(table.sectors()),
        usage: wgpu::BufferUsages::STORAGE,
    });
    group(gpu, Term::Picture, &triangles, Some(&sectors))
}

/// Halves, since every adapter filters them; shares are off by 0.0002 at most.
fn texture(gpu: &Gpu, size: [u32; 3], format: wgpu::TextureFormat, values: &[f16]) -> wgpu::TextureView {
    let [width, height, depth_or_array_layers] = size;
    let descriptor = wgpu::TextureDescriptor {
        label: Some("shares of a light"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    let made = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, Default::default(), &bytes);
    made.create_view(&Default::default())
}

fn group(gpu: &Gpu, term: Term, shares: &wgpu::TextureView, sectors: Option<&wgpu::Buffer>) -> wgpu::BindGroup {
    let sampler = gpu.sampler(&wgpu::SamplerDescriptor {
        label: Some("shares of a light"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let mut resources = vec![wgpu::BindingResource::TextureView(shares), wgpu::BindingResource::Sampler(&sampler)];
    resources.extend(sectors.map(|s| s.as_entire_binding()));
    bind(gpu, "shares of a light", &term.layout(gpu), &resources)
}
