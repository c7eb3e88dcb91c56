//! What hosts lend is checked: each wrong buffer is one error that names it and the remedy, and no
//! error of the driver.

use crate::common::gpu;
use umbrage::{Error, Gpu, Receivers, VisibilityTarget};
use wgpu::{TextureAspect, TextureFormat, TextureUsages, TextureViewDimension};

const BOTH: TextureUsages = TextureUsages::RENDER_ATTACHMENT.union(TextureUsages::TEXTURE_BINDING);

/// A texture of 32 × 16.
fn texture(gpu: &Gpu, format: TextureFormat, samples: u32, layers: u32, usage: TextureUsages) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("lent"),
        size: wgpu::Extent3d { width: 32, height: 16, depth_or_array_layers: layers },
        mip_level_count: 1,
        sample_count: samples,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    })
}

/// What `Receivers::new` says of a view of such a texture, without a word of the driver.
fn refused(gpu: &Gpu, depth: &wgpu::Texture, of: &wgpu::TextureViewDescriptor<'_>, size: (u32, u32)) -> String {
    let made = gpu.catch(|| Ok::<_, Error>(Receivers::new(gpu, &depth.create_view(of), None, size))).unwrap();
    let error = made.expect_err("wrong, and taken");
    assert!(matches!(error, Error::Lent(_) | Error::Size { .. }), "{error:?}");
    error.to_string()
}

#[test]
fn a_depth_buffer_of_the_wrong_kind_is_an_error() {
    let gpu = gpu();
    let depth = |format, samples, layers, usage| texture(&gpu, format, samples, layers, usage);
    let whole = wgpu::TextureViewDescriptor::default();
    let right = (32, 16);
    let fine = depth(TextureFormat::Depth32Float, 1, 1, BOTH);
    assert!(Receivers::new(&gpu, &fine.create_view(&whole), None, right).is_ok());
    let says = |depth: &wgpu::Texture, of: &_, size, words: &str| {
        let text = refused(&gpu, depth, of, size);
        assert!(text.contains(words), "{text:?} does not say {words:?}");
    };
    says(&fine, &whole, (0, 16), "empty");
    says(&fine, &whole, (16, 16), "32×16 and not 16×16");
    says(&depth(TextureFormat::R32Float, 1, 1, BOTH), &whole, right, "R32Float; make it Depth32Float");
    says(&depth(TextureFormat::Depth16Unorm, 1, 1, BOTH), &whole, right, "Depth16Unorm");
    says(&depth(TextureFormat::Depth32Float, 4, 1, BOTH), &whole, right, "4 samples a pixel");
    let unread = depth(TextureFormat::Depth32Float, 1, 1, TextureUsages::RENDER_ATTACHMENT);
    says(&unread, &whole, right, "without TextureUsages(TEXTURE_BINDING)");
    let layers = depth(TextureFormat::Depth32Float, 1, 2, BOTH);
    says(&layers, &whole, right, "of one layer");
    let one =
        wgpu::TextureViewDescriptor { dimension: Some(TextureViewDimension::D2), base_array_layer: 1, ..whole.clone() };
    let one = wgpu::TextureViewDescriptor { array_layer_count: Some(1), ..one };
    assert!(Receivers::new(&gpu, &layers.create_view(&one), None, right).is_ok());
    let stencil = depth(TextureFormat::Depth24PlusStencil8, 1, 1, BOTH);
    says(&stencil, &whole, right, "the depth alone");
    let alone = wgpu::TextureViewDescriptor { aspect: TextureAspect::DepthOnly, ..whole.clone() };
    let receivers = Receivers::new(&gpu, &stencil.create_view(&alone), None, right).unwrap();
    assert!(receivers.clone().with_stencil(&stencil.create_view(&whole)).is_ok());
    let other = receivers.with_stencil(&fine.create_view(&whole)).unwrap_err().to_string();
    assert!(other.contains("another texture"), "{other}");
}

#[test]
fn normals_of_the_wrong_kind_are_an_error() {
    let gpu = gpu();
    let depth = texture(&gpu, TextureFormat::Depth32Float, 1, 1, BOTH).create_view(&Default::default());
    let of = |format| {
        let normal = texture(&gpu, format, 1, 1, BOTH).create_view(&Default::default());
        Receivers::new(&gpu, &depth, Some(&normal), (32, 16)).map(|_| ())
    };
    assert_eq!(of(TextureFormat::R32Uint), Ok(()));
    let error = of(TextureFormat::Rgba16Float).unwrap_err().to_string();
    assert!(error.contains("Rgba16Float; make it R32Uint"), "{error}");
}

#[test]
fn a_target_of_the_wrong_kind_is_an_error() {
    let gpu = gpu();
    let target = |format, samples, usage, layer| {
        VisibilityTarget::of_texture(&texture(&gpu, format, samples, if samples == 1 { 2 } else { 1 }, usage), layer)
            .map_err(|e| e.to_string())
    };
    assert_eq!(target(TextureFormat::R16Float, 1, BOTH, 1).unwrap().size, (32, 16));
    for (made, words) in [
        (target(TextureFormat::R8Unorm, 1, BOTH, 0), "R8Unorm; make it R16Float"),
        (target(TextureFormat::R16Float, 4, BOTH, 0), "4 samples"),
        (target(TextureFormat::R16Float, 1, TextureUsages::TEXTURE_BINDING, 0), "RENDER_ATTACHMENT"),
        (target(TextureFormat::R16Float, 1, BOTH, 2), "2 layers"),
    ] {
        let error = made.unwrap_err();
        assert!(error.contains(words), "{error:?} does not say {words:?}");
    }
}
