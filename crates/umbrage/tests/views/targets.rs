//! Visibility in textures of a host's own, and from half the size to the full one.

use crate::host::{
    LAMP, SIZE, Target, Truth, depth_texture, frame, gpu, layer, point, scene, technique, texture, visibility,
};
use umbrage::core::{Image, LightShape, Scene};
use umbrage::{Coarse, Deliver, Error, Gpu, HostDepth, Part, Receivers, Resolve, Upsample, VisibilityTarget};
use wgpu::{ColorTargetState, ColorWrites, TextureFormat};

/// A target of the format with visibility from corner (5, 7) on, everything else 0.5.
fn delivered(gpu: &Gpu, state: ColorTargetState) -> (Image<f32>, wgpu::Texture) {
    let scene = scene(point());
    let camera = scene.camera.view(SIZE.0, SIZE.1);
    let depth = layer(&depth_texture(gpu, SIZE, 1, 1), 0);
    let receivers = Receivers::new(gpu, &depth, None, SIZE).unwrap();
    let into = texture(gpu, state.format, (120, 90), 1, 2);
    let mut deliver = Deliver::new(gpu, state).unwrap();
    let made = frame(gpu, |passes| {
        Target::of(&depth).draw(gpu, passes.encoder(), &scene, &camera);
        let target = visibility(gpu, &mut *technique(gpu, "pcf"), passes, &scene, (&camera, &receivers)).unwrap();
        let gray = wgpu::Color { r: 0.5, g: 0.5, b: 0.5, a: 0.5 };
        let view = layer(&into, 1);
        drop(passes.render("gray", &[umbrage::fullscreen::attachment(&view, wgpu::LoadOp::Clear(gray))], None));
        deliver.record(passes, &target, &view, (5, 7)).unwrap();
        target
    });
    (made.read(gpu).unwrap(), into)
}

/// The second layer's bytes, `size` a pixel.
fn bytes(gpu: &Gpu, texture: &wgpu::Texture, size: u32) -> Vec<Vec<u8>> {
    let row = (120 * size).next_multiple_of(256);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row) * 90,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut source = texture.as_image_copy();
    source.origin.z = 1;
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    let extent = wgpu::Extent3d { width: 120, height: 90, depth_or_array_layers: 1 };
    encoder.copy_texture_to_buffer(source, wgpu::TexelCopyBufferInfo { buffer: &buffer, layout }, extent);
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.wait().unwrap();
    let data = buffer.get_mapped_range(..).unwrap();
    data.chunks(row as usize).map(|line| line[..(120 * size) as usize].to_vec()).collect()
}

#[test]
fn visibility_comes_to_a_part_of_a_layer_of_other_formats() {
    let gpu = gpu();
    let inside = |x: u32, y: u32| (5..5 + SIZE.0).contains(&x) && (7..7 + SIZE.1).contains(&y);
    // One byte a pixel.
    let (seen, into) = delivered(&gpu, TextureFormat::R8Unorm.into());
    let found = bytes(&gpu, &into, 1);
    let some_shadow = seen.data.iter().filter(|v| **v < 0.5).count();
    assert!(some_shadow > 100, "{some_shadow}");
    for (y, line) in found.iter().enumerate() {
        for (x, value) in line.iter().enumerate() {
            let at = (x as u32, y as u32);
            let expected = if inside(at.0, at.1) { seen[(at.0 - 5, at.1 - 7)] } else { 0.5 };
            assert!((f32::from(*value) / 255.0 - expected).abs() < 0.003, "{at:?}: {value} for {expected}");
        }
    }
    // One channel of four; the others stay.
    let green = ColorTargetState { write_mask: ColorWrites::GREEN, ..TextureFormat::Rgba8Unorm.into() };
    let (seen, into) = delivered(&gpu, green);
    for (y, line) in bytes(&gpu, &into, 4).iter().enumerate() {
        for (x, value) in line.chunks(4).enumerate() {
            let at = (x as u32, y as u32);
            let expected = if inside(at.0, at.1) { seen[(at.0 - 5, at.1 - 7)] } else { 0.5 };
            assert!((f32::from(value[1]) / 255.0 - expected).abs() < 0.003, "{at:?}: {value:?} for {expected}");
            assert!([0, 2, 3].iter().all(|c| value[*c].abs_diff(128) <= 1), "{at:?}: {value:?}");
        }
    }
}

#[test]
fn a_target_that_takes_no_visibility_is_an_error() {
    let gpu = gpu();
    for (format, words) in [(TextureFormat::R8Uint, "R8Uint"), (TextureFormat::Depth32Float, "Depth32Float")] {
        let made = gpu.catch(|| Ok::<_, Error>(Deliver::new(&gpu, format.into()).err())).unwrap();
        let error = made.expect("no target").to_string();
        assert!(error.contains(words) && error.contains("R8Unorm"), "{error}");
    }
    let mut deliver = Deliver::new(&gpu, TextureFormat::R8Unorm.into()).unwrap();
    let small = layer(&texture(&gpu, TextureFormat::R8Unorm, (8, 8), 1, 1), 0);
    let visibility = VisibilityTarget::new(&gpu, 8, 8).unwrap();
    let error = frame(&gpu, |passes| deliver.record(passes, &visibility, &small, (1, 0)).unwrap_err().to_string());
    assert!(error.contains("ends at 9, 8 and its target at 8, 8"), "{error}");
}

/// Errors of a technique at the full size, and at half the size with upsampling.
fn full_and_half(gpu: &Gpu, id: &str, scene: &Scene, size: (u32, u32), has_normals: bool) -> [f64; 2] {
    let camera = scene.camera.view(size.0, size.1);
    let truth = Truth::of(scene, &scene.camera, size);
    let depth = layer(&depth_texture(gpu, size, 1, 1), 0);
    let normal = has_normals.then(|| layer(&texture(gpu, crate::host::NORMAL, size, 1, 1), 0));
    let host = HostDepth { depth: &depth, normal: normal.as_ref(), stored: None };
    let receivers = Receivers::new(gpu, &depth, normal.as_ref(), size).unwrap();
    let (mut resolve, mut upsample) =
        (Resolve::new(gpu, &host).unwrap(), Upsample::new(gpu, VisibilityTarget::FORMAT.into()).unwrap());
    let upsampled = VisibilityTarget::new(gpu, size.0, size.1).unwrap();
    let full = frame(gpu, |passes| {
        let target = Target { normal: normal.as_ref(), ..Target::of(&depth) };
        target.draw(gpu, passes.encoder(), scene, &camera);
        let at = |passes: &mut _, receivers: &_| {
            visibility(gpu, &mut *technique(gpu, id), passes, scene, (&camera, receivers)).unwrap()
        };
        let full = at(passes, &receivers);
        let half = resolve.record(passes, &Part { is_half: true, ..Part::of(size) }, &camera).unwrap();
        assert_eq!(half.size, (size.0.div_ceil(2), size.1.div_ceil(2)));
        let coarse = Coarse { receivers: half, visibility: &at(passes, half) };
        upsample.record(passes, &camera, &receivers, &coarse, &upsampled.view, (0, 0)).unwrap();
        full
    });
    [&full, &upsampled].map(|target| truth.error(&target.read(gpu).unwrap()))
}

#[test]
fn half_the_size_upsampled_is_nearly_as_right() {
    let gpu = gpu();
    let soft = LightShape::Sphere { position: LAMP, radius: 0.4 };
    let mut fence = (umbrage::core::scenes::find("picket-fence").unwrap().build)(0.3);
    fence.lights.drain(1..);
    for (name, scene, most) in [("box and sphere", scene(soft), 0.004), ("picket-fence", fence, 0.035)] {
        for (id, size, has_normals) in [("wedges", (160, 120), true), ("pcss", (161, 119), false)] {
            let [full, half] = full_and_half(&gpu, id, &scene, size, has_normals);
            println!("{name}, {id}: {full:.4} at the full size, {half:.4} upsampled");
            assert!(half < full + most, "{name}, {id}: {full:.4}, upsampled {half:.4}");
            assert!(half != full, "{name}, {id}: nothing was upsampled");
        }
    }
}
