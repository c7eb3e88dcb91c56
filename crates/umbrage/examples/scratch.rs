//! scratch
use umbrage::{Gpu, LightPass, Renderer, find};
fn main() {
    let gpu = Gpu::request(None).unwrap();
    let a: Vec<String> = std::env::args().collect();
    let scene = (umbrage::core::scenes::find(&a[1]).unwrap().build)(1.0);
    let info = find("volume").unwrap();
    let set: Vec<_> = a[3..].iter().map(|s| { let (x, y) = s.split_once('=').unwrap(); (x.to_string(), y.to_string()) }).collect();
    let technique = info.make(&gpu, &info.settings(&set).unwrap()).unwrap();
    let light = a[2].parse().unwrap();
    let size: (u32, u32) = (std::env::var("W").map_or(1024, |w| w.parse().unwrap()), 48);
    let mut r = Renderer::new(&gpu, &scene, size.0, size.0 * 3 / 4, vec![LightPass { light, technique }]).unwrap();
    for _ in 0..40 {
        r.frame(&scene.camera).unwrap();
        r.wait().unwrap();
    }
    for t in r.times() { println!("{} {} {:.2}", t.owner, t.pass, t.time_ms); }
}
