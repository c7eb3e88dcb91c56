//! The table of taps on the GPU, see `wgsl/map_taps.wgsl`.

use crate::gpu::Gpu;
use crate::params::{Param, ParamKind, Settings};
use crate::shader::shader_struct;
use umbrage_core::LightShape;
use umbrage_core::sampling::{Domain, Pattern, TapTable};

/// `noise`: shared by all techniques with taps.
pub(crate) const NOISE: Param = Param {
    name: "noise",
    help: "How neighbouring pixels differ: each pixel of a tile has its own jittered strata, or one set of taps turned by \
           blue noise, by interleaved gradient noise, or not at all (bands in place of grain).",
    unit: "",
    kind: ParamKind::Choice { values: &["stratified", "blue", "gradient", "none"] },
};

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

/// Taps for one kind of light.
pub(crate) struct Taps {
    pattern: Pattern,
    tile: u32,
    /// Taps of the search for blockers, before those of the filter.
    search: u32,
    filter: u32,
    made: Option<(Domain, wgpu::Buffer)>,
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
        Self { pattern, tile: settings.int("tile") as u32, search, filter, made: None }
    }

    /// The table for taps in `domain`, made anew where that is another than before.
    pub(crate) fn buffer(&mut self, gpu: &Gpu, domain: Domain) -> &wgpu::Buffer {
        let known = self.made.take().filter(|(d, _)| *d == domain);
        let made = known.unwrap_or_else(|| (domain, self.make(gpu, domain)));
        &self.made.insert(made).1
    }

    pub(crate) fn bytes(&self) -> u64 {
        self.made.as_ref().map_or(0, |(_, buffer)| buffer.size())
    }

    fn make(&self, gpu: &Gpu, domain: Domain) -> wgpu::Buffer {
        let table = |count| TapTable::new(self.pattern, domain, count, TESTS, self.tile);
        let filter = table(self.filter);
        let search = (self.search > 0).then(|| table(self.search));
        let tile = if self.pattern == Pattern::Gradient { 0 } else { filter.tile };
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

/// What the taps of a light fill, in units of its half axes.
pub(crate) fn domain_of(light: &LightShape) -> Domain {
    match light {
        LightShape::Rect { .. } => Domain::Square,
        LightShape::Line { .. } => Domain::Segment,
        _ => Domain::Disc,
    }
}
