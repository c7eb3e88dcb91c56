//! Depth that is not a whole texture of the camera's own depth: every technique works on what
//! `Resolve` makes of it.

use crate::host::{
    LAMP, SIZE, Target, Truth, depth_texture, frame, gpu, layer, point, scene, technique, texture, visibility,
};
use umbrage::core::{CameraView, LightShape, Scene};
use umbrage::{Error, Gpu, HostDepth, Part, Resolve, StoredDepth, techniques};

/// Depth by the logarithm of the distance: 0 at the eye, 1 at 1000 m.
const LOGARITHM: &str = "return log2(clip.w + 1.0) / log2(1001.0);";
/// Back.
const DISTANCE: &str = "fn view_distance(stored: f32) -> f32 {
    return select(exp2(stored * log2(1001.0)) - 1.0, 1e38, stored == 1.0);
}";

/// How a host keeps its depth.
struct Kept {
    name: &'static str,
    samples: u32,
    /// The part of a buffer of 150 × 120.
    corner: Option<(u32, u32)>,
    is_logarithm: bool,
    has_normals: bool,
}

const PLAIN: Kept = Kept { name: "plain", samples: 1, corner: None, is_logarithm: false, has_normals: false };

const KEPT: [Kept; 4] = [
    Kept { name: "a part", corner: Some((37, 21)), ..PLAIN },
    Kept { name: "a part, with normals", corner: Some((37, 21)), has_normals: true, ..PLAIN },
    Kept { name: "four samples", samples: 4, ..PLAIN },
    Kept { name: "logarithm", is_logarithm: true, ..PLAIN },
];

impl Kept {
    /// The error of a technique.
    fn error(&self, gpu: &Gpu, id: &str, scene: &Scene, camera: &CameraView, truth: &Truth) -> Result<f64, Error> {
        let size = if self.corner.is_some() { (150, 120) } else { SIZE };
        let depth = layer(&depth_texture(gpu, size, self.samples, 1), 0);
        let normal = self.has_normals.then(|| layer(&texture(gpu, crate::host::NORMAL, size, self.samples, 1), 0));
        let target = Target {
            samples: self.samples,
            part: self.corner.map(|(x, y)| [x, y, SIZE.0, SIZE.1]),
            stored: self.is_logarithm.then_some(LOGARITHM),
            normal: normal.as_ref(),
            ..Target::of(&depth)
        };
        let stored = self.is_logarithm.then_some(StoredDepth { wgsl: DISTANCE, coarseness: 1000_f32.ln() });
        let mut resolve = Resolve::new(gpu, &HostDepth { depth: &depth, normal: normal.as_ref(), stored })?;
        let part = Part { corner: self.corner.unwrap_or_default(), ..Part::of(SIZE) };
        let mut technique = technique(gpu, id);
        let made = frame(gpu, |passes| {
            target.draw(gpu, passes.encoder(), scene, camera);
            let receivers = resolve.record(passes, &part, camera)?;
            visibility(gpu, &mut *technique, passes, scene, (camera, receivers))
        });
        Ok(truth.error(&made?.read(gpu)?))
    }
}

#[test]
fn every_technique_reads_what_is_resolved() {
    let gpu = gpu();
    let scene = scene(LightShape::Sphere { position: LAMP, radius: 0.3 });
    let camera = scene.camera.view(SIZE.0, SIZE.1);
    let truth = Truth::of(&scene, &scene.camera, SIZE);
    let mut wrong = Vec::new();
    for info in techniques().iter().filter(|info| info.id != "none") {
        let error = |kept: &Kept| kept.error(&gpu, info.id, &scene, &camera, &truth);
        let plain = error(&PLAIN).unwrap();
        for kept in &KEPT {
            let found = error(kept).unwrap();
            println!("{:16} {:20} {found:.4}, plain {plain:.4}", info.id, kept.name);
            // Other samples of edges; and half a pixel of the shadow's edge with several.
            let more = if kept.samples > 1 { 0.004 } else { 0.001 };
            if found > 1.05 * plain + more {
                wrong.push(format!("{} {}: {found:.4}, plain {plain:.4}", info.id, kept.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_can_not_be_resolved_is_an_error() {
    let gpu = gpu();
    let depth = layer(&depth_texture(&gpu, SIZE, 1, 1), 0);
    let host = HostDepth { depth: &depth, normal: None, stored: None };
    let camera = scene(point()).camera.view(SIZE.0, SIZE.1);
    let mut resolve = Resolve::new(&gpu, &host).unwrap();
    let mut says = |part: Part, words: &str| {
        let error = frame(&gpu, |passes| resolve.record(passes, &part, &camera).map(|_| ()).unwrap_err().to_string());
        assert!(error.contains(words), "{error:?} does not say {words:?}");
    };
    says(Part { corner: (1, 0), ..Part::of(SIZE) }, "ends at 97, 72 and the buffer at 96, 72");
    says(Part { corner: (u32::MAX, 0), ..Part::of(SIZE) }, "choose a part of it");
    says(Part::of((0, 4)), "empty");
    let wrong = StoredDepth { wgsl: "fn distance_of(stored: f32) -> f32 { return stored; }", coarseness: 1.0 };
    let made =
        gpu.catch(|| Ok::<_, Error>(Resolve::new(&gpu, &HostDepth { stored: Some(wrong), ..host }).err())).unwrap();
    let error = made.expect("WGSL without the function").to_string();
    assert!(error.contains("fn view_distance(stored: f32) -> f32"), "{error}");
    let color = layer(&texture(&gpu, wgpu::TextureFormat::R32Float, SIZE, 1, 1), 0);
    let error = Resolve::new(&gpu, &HostDepth { depth: &color, ..host }).err().expect("no depth").to_string();
    assert!(error.contains("R32Float"), "{error}");
    let normal = layer(&texture(&gpu, crate::host::NORMAL, (8, 8), 1, 1), 0);
    let error = Resolve::new(&gpu, &HostDepth { normal: Some(&normal), ..host }).err().expect("other size").to_string();
    assert!(error.contains("8×8 and not 96×72"), "{error}");
}
