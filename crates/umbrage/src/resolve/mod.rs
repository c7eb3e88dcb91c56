//! Receivers out of depth that techniques can't read as it is: a part of a larger buffer, several
//! samples a pixel, a depth that is stored in another way, or every other pixel alone.

mod host;
mod pass;

use crate::fullscreen::target_texture;
use crate::receivers::{Receivers, check};
use crate::{error::Error, gpu::Gpu, passes::Passes};
pub use host::{HostDepth, Part, StoredDepth};
pub(crate) use pass::SHADERS;
use pass::{ResolvePass, Resolving};
use umbrage_core::CameraView;

/// Makes [`Receivers`] of a host's buffers by one full-screen pass each frame, which all lights of
/// the frame share; all techniques work on what it makes. It reads four bytes a pixel and writes as
/// many, with normals eight; neighbours are read, too, where pixels are not read in their middle.
pub struct Resolve {
    gpu: Gpu,
    pass: ResolvePass,
    host_size: (u32, u32),
    has_normals: bool,
    has_distances: bool,
    samples: u32,
    coarseness: f32,
    made: Option<Made>,
}

/// Pixels by which the depth at a pixel's middle is shifted at most where that of another place in
/// it was continued: a bend of the surface is missed.
const OFF_CENTER: f32 = 0.1;

struct Made {
    part: Part,
    receivers: Receivers,
    depth: wgpu::TextureView,
    normal: Option<wgpu::TextureView>,
}

impl Resolve {
    /// For buffers of a host; once, and again when the host makes new buffers.
    ///
    /// # Errors
    /// [`Error::Lent`] for buffers that can't be read so, or WGSL that does not compile. Browsers
    /// report the latter in their own way.
    pub fn new(gpu: &Gpu, host: &HostDepth<'_>) -> Result<Self, Error> {
        let texture = host.depth.texture();
        check::depth_of_any_samples(host.depth)?;
        host.normal.map_or(Ok(()), |normal| check::normal_beside(normal, host.depth))?;
        Ok(Self {
            gpu: gpu.clone(),
            pass: ResolvePass::new(gpu, host)?,
            host_size: (texture.width(), texture.height()),
            has_normals: host.normal.is_some(),
            has_distances: host.stored.is_some(),
            samples: texture.sample_count(),
            coarseness: host.stored.map_or(1.0, |stored| stored.coarseness.max(1.0)),
            made: None,
        })
    }

    /// Records the pass, once the host has drawn its depth; `camera` has the projection of the
    /// part. Its textures are made anew where the part's size changes: a host that adapts its
    /// resolution does so in steps.
    ///
    /// # Errors
    /// [`Error::Size`] for an empty part, [`Error::Lent`] for one that goes beyond the buffers, or
    /// for distances under a projection whose depth is not that of a distance along the view.
    pub fn record(&mut self, passes: &mut Passes<'_>, part: &Part, camera: &CameraView) -> Result<&Receivers, Error> {
        self.gpu.check_size("a part of a depth buffer", part.size.0, part.size.1)?;
        part.check(self.host_size)?;
        let resolving = Resolving::of(part, camera, self.samples);
        if self.has_distances && !Resolving::knows_distances(camera) {
            return Err(Error::Lent(
                "the projection's depth is not that of a distance along the view; resolve depth without `stored`"
                    .into(),
            ));
        }
        let kept = self
            .made
            .take()
            .filter(|made| made.part.receivers_size() == part.receivers_size() && made.part.is_half == part.is_half);
        let mut made = kept.map_or_else(|| self.make(part), Ok)?;
        made.part = *part;
        self.pass.record(passes, &resolving, &made.depth, made.normal.as_ref());
        Ok(&self.made.insert(made).receivers)
    }

    /// Those of the last frame, for whoever shades with them; `None` before the first.
    pub fn receivers(&self) -> Option<&Receivers> {
        self.made.as_ref().map(|made| &made.receivers)
    }

    fn make(&self, part: &Part) -> Result<Made, Error> {
        let size = part.receivers_size();
        let view = |label, format| target_texture(&self.gpu, label, size, 1, format).create_view(&Default::default());
        let depth = view("resolved depth", pass::DEPTH);
        let normal = self.has_normals.then(|| view("resolved normals", pass::NORMAL));
        let mut receivers = Receivers::new(&self.gpu, &depth, normal.as_ref(), size)?;
        receivers.coarseness = self.coarseness;
        if self.samples > 1 || part.is_half {
            receivers.bend = OFF_CENTER;
        }
        Ok(Made { part: *part, receivers, depth, normal })
    }
}
