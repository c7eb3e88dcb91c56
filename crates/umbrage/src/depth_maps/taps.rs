//! The table of taps on the GPU, see `stages/map_taps.wgsl`.

use crate::gpu::Gpu;
use crate::params::{Param, ParamKind, Settings};
use crate::shader::{Shared, shader_struct};
use umbrage_core::sampling::{Domain, Pattern, TapTable};
use umbrage_core::{LightShape, Texture};

/// `noise`: shared by all techniques with taps.
pub(crate) const NOISE: Param = Param {
    name: "noise",
    help: "How neighbouring pixels differ: each pixel of a tile has its own jittered strata, or one set of taps turned by \
           blue noise, by interleaved gradient noise, or not at all (bands in place of grain).",
    unit: "",
    kind: ParamKind::Choice { values: &["stratified", "blue", "gradient", "none"] },
};

/// `noise` with what leaves the least error first.
pub(crate) const GRADIENT_NOISE: Param =
    Param { kind: ParamKind::Choice { values: &["gradient", "stratified", "blue", "none"] }, ..NOISE };

/// `tile`: shared by all techniques with taps.
pub(crate) const TILE: Param = Param {
    name: "tile",
    help: "Pixels across and down after which stratified and blue noise repeat.",
    unit: "pixels",
    kind: ParamKind::Int { min: 1, max: 32, default: 8 },
};

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
pub(super) const SHARED: Shared =
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
    /// As `noise` and `tile` of the settings say, with so many taps for the search (0 for none) and for the filter.
    pub(crate) fn new(settings: &Settings, search: u32, filter: u32) -> Self {
        let pattern = match settings.choice("noise") {
            "blue" => Pattern::Blue,
            "gradient" => Pattern::Gradient,
            "none" => Pattern::Fixed,
            _ => Pattern::Stratified,
        };
        let pattern = Some(pattern);
        Self { pattern, tile: settings.int("tile") as u32, search, filter, made: None }
    }

    /// Evenly spread, the same for all pixels.
    pub(crate) fn even(search: u32, filter: u32) -> Self {
        Self { pattern: Some(Pattern::Fixed), tile: 1, search, filter, made: None }
    }

    /// Grids of so many taps a side, the same for all pixels.
    pub(crate) fn grids(search: u32, filter: u32) -> Self {
        Self { pattern: None, tile: 1, search: search * search, filter: filter * filter, made: None }
    }

    /// Makes the table for `shape` where it is another than before, and then returns true. `textures` are the scene's.
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

/// Widens a grid until its outer taps are on the rim: a search that leaves the rim out takes the ends of a penumbra for lit and
/// for umbra.
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
