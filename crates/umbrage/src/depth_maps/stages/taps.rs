//! The table of taps on the GPU, see `map_taps.wgsl`.

use crate::choices;
use crate::gpu::Gpu;
use crate::shader::{Shared, shader_struct};
use umbrage_core::sampling::{Domain, Pattern, TapTable};
use umbrage_core::{LightShape, Texture};

choices! {
    /// How the taps of neighbouring pixels differ.
    pub enum Noise {
        /// Each pixel of a tile has its own jittered strata.
        Stratified = "stratified",
        /// One set of taps, turned by blue noise.
        Blue = "blue",
        /// One set of taps, turned by interleaved gradient noise.
        Gradient = "gradient",
        /// Not at all: bands in place of grain.
        None = "none",
    }
}

/// Taps on the rim that are tried first.
pub(crate) const TESTS: u32 = 8;

/// Most entries of `set_of_pixel`, a tile of 32 × 32.
const PIXELS: usize = 1024;

shader_struct! {
    /// The start of the table; `set_of_pixel` and the offsets follow.
    pub(crate) struct TapsHead {
        tile: u32,
        sets: u32,
        count: u32,
        is_square: u32,
    }
}

/// What the host has to agree on with `map_taps.wgsl`.
pub(in crate::depth_maps) const SHARED: Shared =
    Shared { module: "map_taps", layouts: &[TapsHead::LAYOUT], constants: &[("TILE_PIXELS", PIXELS as f64)] };

/// Taps for one kind of light.
pub(crate) struct Taps {
    /// `None` for grids.
    pattern: Option<Pattern>,
    tile: u32,
    /// Taps of the search for blockers, before those of the filter.
    search: u32,
    filter: u32,
    made: Option<(Shape, wgpu::Buffer)>,
}

impl Taps {
    /// Jittered by `noise`, which repeats after `tile` pixels, with so many taps for the search (0
    /// for none) and for the filter.
    pub(crate) fn new(noise: Noise, tile: u32, search: u32, filter: u32) -> Self {
        let pattern = match noise {
            Noise::Stratified => Pattern::Stratified,
            Noise::Blue => Pattern::Blue,
            Noise::Gradient => Pattern::Gradient,
            Noise::None => Pattern::Fixed,
        };
        Self { pattern: Some(pattern), tile, search, filter, made: None }
    }

    /// Evenly spread, the same for all pixels.
    pub(crate) fn even(search: u32, filter: u32) -> Self {
        Self { pattern: Some(Pattern::Fixed), tile: 1, search, filter, made: None }
    }

    /// Grids of so many taps a side, the same for all pixels.
    pub(crate) fn grids(search: u32, filter: u32) -> Self {
        Self { pattern: None, tile: 1, search: search * search, filter: filter * filter, made: None }
    }

    /// Makes the table for `shape` where it is another than before, and then returns true.
    /// `textures` are the scene's.
    pub(crate) fn prepare(&mut self, gpu: &Gpu, shape: Shape, textures: &[Texture]) -> bool {
        if self.made.as_ref().is_some_and(|(s, _)| *s == shape) {
            return false;
        }
        self.made = Some((shape, self.make(gpu, shape, textures)));
        true
    }

    pub(crate) fn buffer(&self) -> Option<&wgpu::Buffer> {
        self.made.as_ref().map(|(_, buffer)| buffer)
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |(_, buffer)| buffer.size())
    }

    fn make(&self, gpu: &Gpu, shape: Shape, textures: &[Texture]) -> wgpu::Buffer {
        let Shape { domain, texture } = shape;
        let table = |count: u32| {
            let even = match self.pattern {
                Some(pattern) => TapTable::new(pattern, domain, count, TESTS, self.tile),
                None => TapTable::grid(domain, count.isqrt()),
            };
            match texture.and_then(|i| textures.get(i)) {
                Some(texture) => even.weighted_by(texture),
                None => even,
            }
        };
        let filter = table(self.filter);
        let search = (self.search > 0).then(|| match self.pattern {
            Some(_) => table(self.search),
            None => to_rim(table(self.search)),
        });
        let tile = if self.pattern == Some(Pattern::Gradient) { 0 } else { filter.tile };
        let count = self.search + self.filter;
        let head = TapsHead { tile, sets: filter.sets, count, is_square: u32::from(domain == Domain::Square) };
        let mut set_of_pixel = filter.set_of_pixel.clone();
        set_of_pixel.resize(PIXELS, 0);
        let of_set = |table: &TapTable, set: u32| {
            let start = (set * table.taps) as usize;
            table.offsets[start..start + table.taps as usize].to_vec()
        };
        let offsets: Vec<[f32; 2]> = (0..filter.sets)
            .flat_map(|set| search.iter().chain([&filter]).flat_map(move |table| of_set(table, set)))
            .collect();
        let parts: [&[u8]; 3] =
            [bytemuck::bytes_of(&head), bytemuck::cast_slice(&set_of_pixel), bytemuck::cast_slice(&offsets)];
        gpu.buffer("taps", &parts.concat(), wgpu::BufferUsages::STORAGE)
    }
}

/// Widens a grid until its outer taps are on the rim: a search that leaves the rim out takes the
/// ends of a penumbra for lit and for umbra.
fn to_rim(mut grid: TapTable) -> TapTable {
    let side = grid.taps.isqrt().max(2) as f32;
    grid.offsets.iter_mut().flatten().for_each(|x| *x *= side / (side - 1.0));
    grid
}

/// What taps fill, in units of a light's half axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shape {
    domain: Domain,
    /// Index into the scene's textures: what a light shows, weighting its points.
    texture: Option<usize>,
}

impl Shape {
    /// For filters of one width all around.
    pub(crate) const DISC: Self = Self { domain: Domain::Disc, texture: None };

    /// For filters that follow the light.
    pub(crate) fn of(light: &LightShape) -> Self {
        match *light {
            LightShape::Rect { texture, .. } => Self { domain: Domain::Square, texture },
            LightShape::Line { .. } => Self { domain: Domain::Segment, texture: None },
            _ => Self::DISC,
        }
    }
}
