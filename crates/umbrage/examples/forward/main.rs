//! A host that shades forward asks for shadows in its own shader: boxes, panes that one sees
//! through and smoke are lit by the same two lights, without any full-screen pass.
//!
//!     cargo run -p umbrage --example forward -- picture.png

mod host;
pub(crate) mod things;

use host::Host;
pub use host::Shown;
use umbrage::core::glam::DVec3;
use umbrage::core::{Camera, Image, Light, LightShape};
use umbrage::techniques::{cascaded::Cascaded, pcss::Pcss};
use umbrage::{Casters, Configure, Followed, Gpu, Inline, Receivers, Recorder, View};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Draws a picture of 480 × 360 pixels into the file that is named, else into none.
pub fn main() -> Result<()> {
    let picture = picture((480, 360), Shown::Colors)?;
    if let Some(path) = std::env::args().find(|argument| argument.ends_with(".png")) {
        umbrage_io::pictures::save_png(path.as_ref(), &picture)?;
    }
    Ok(())
}

/// The camera of all pictures.
pub fn camera() -> Camera {
    Camera { eye: DVec3::new(2.6, 2.6, 5.4), target: DVec3::new(-0.1, 0.75, 0.0), ..Camera::default() }
}

/// A low sun, and a lamp that is a sphere.
pub fn lights() -> [Light; 2] {
    let direction = DVec3::new(0.75, -0.55, -0.35).normalize();
    let sun = LightShape::Directional { direction, angle_deg: 0.5 };
    let lamp = LightShape::Sphere { position: DVec3::new(2.0, 1.5, 1.5), radius: 0.15 };
    [sun, lamp].map(Light::new)
}

/// Two frames, of which the second one follows the first.
pub fn picture(size: (u32, u32), shown: Shown) -> Result<Image<[u8; 4]>> {
    let (device, queue) = host::device()?;
    let mut host = Host::new(&device, size, &camera(), &lights(), shown);

    // umbrage, once. The receivers are the camera's size here: nothing reads the depth buffer.
    let gpu = Gpu::new(device.clone(), queue.clone());
    let scene = things::casters();
    let mut casters = Casters::new(&gpu, &scene)?;
    casters.receive_in(&things::beside_casters());
    let receivers = Receivers::new(&gpu, &host.depth, None, size)?;
    let mut techniques = [Cascaded { splits: 2, ..Default::default() }.make(&gpu)?, Pcss::default().make(&gpu)?];
    let mut recorder = Recorder::new(&gpu);
    let mut inline: Option<Inline> = None;

    for _ in 0..2 {
        let mut encoder = device.create_command_encoder(&Default::default());

        // umbrage: the maps of both lights, and what the host's shader reads of them.
        let mut passes = recorder.begin(&mut encoder);
        let mut lent = Vec::new();
        for (technique, light) in techniques.iter_mut().zip(&lights()) {
            let camera = camera().view(size.0, size.1);
            let view = View { camera, receivers: &receivers, casters: &casters, light, textures: &[] };
            technique.prepare(&gpu, &view)?.record_maps(&mut passes)?;
            lent.push(technique.lend(&gpu)?);
        }
        passes.finish();
        let followed = match &mut inline {
            Some(inline) => inline.follow(&gpu, &lent)?,
            None => Followed::Shader,
        };
        let lights = match inline.take() {
            Some(inline) => inline,
            None => Inline::join(&gpu, &lent, 1, "lights")?,
        };
        if followed == Followed::Shader {
            host.make_pipelines(lights.wgsl(), lights.layout());
        }

        // The host draws.
        host.record(&mut encoder, lights.bind_group());
        inline = Some(lights);
        queue.submit([encoder.finish()]);
    }
    Ok(umbrage::read::rgba8(&gpu, &host.color)?)
}
