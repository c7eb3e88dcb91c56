//! The example of a host that shades forward: what its shader says of both lights is the truth, and
//! panes and smoke change the picture.

#[path = "../../examples/forward/main.rs"]
mod example;

use example::{Shown, camera, lights, picture};
use umbrage::core::Scene;
use umbrage_reference::{Options, Tracer};

const SIZE: (u32, u32) = (120, 90);

#[test]
fn solid_things_are_lit_as_rays_say() {
    example::main().unwrap();
    let scene: Scene = example::things::casters();
    let tracer = Tracer::new(&scene);
    let geometry = tracer.geometry(&camera(), SIZE.0, SIZE.1);
    for (i, light) in lights().iter().enumerate() {
        let seen = picture(SIZE, Shown::Share(i)).unwrap();
        let options = Options { samples: 64, ..Options::default() };
        let truth = tracer.visibility(&geometry, light, &[], &options, &|_, _| ());
        let scored = truth.scored.data.iter().zip(&truth.visibility.data).zip(&seen.data);
        let apart: Vec<f32> = scored
            .filter(|((scored, _), _)| **scored)
            .map(|((_, truth), seen)| (truth - f32::from(seen[0]) / 255.0).abs())
            .collect();
        let mean = apart.iter().sum::<f32>() / apart.len() as f32;
        println!("light {i}: {mean:.4} apart on the mean of {} pixels", apart.len());
        assert!(apart.len() > 2000 && mean < 0.01, "light {i}: {mean:.4}");
    }
}

#[test]
fn panes_and_smoke_are_in_the_picture() {
    let all = picture(SIZE, Shown::Colors).unwrap();
    let brightness = |pixel: &[u8; 4]| pixel[..3].iter().map(|c| u32::from(*c)).sum::<u32>();
    // The smoke's column is lit above and in the tall box's shadow below.
    let column = |y: u32| all[(SIZE.0 / 2, y)];
    let [above, below] = [column(SIZE.1 * 24 / 90), column(SIZE.1 * 44 / 90)];
    assert!(brightness(&above) > brightness(&below) + 90, "{above:?} above, {below:?} below");
    // The green pane.
    let [red, green, blue, _] = all[(SIZE.0 * 45 / 120, SIZE.1 * 40 / 90)];
    assert!(green > red + 20 && green > blue + 20, "{red} {green} {blue}");
}
