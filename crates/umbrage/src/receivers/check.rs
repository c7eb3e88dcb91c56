//! Whether what a host lends is what shaders can read.

use crate::error::Error;
use wgpu::{TextureFormat, TextureUsages};

/// Of a depth buffer that [`crate::Resolve`] reads, of any size.
pub(crate) fn depth_of_any_samples(view: &wgpu::TextureView) -> Result<(), Error> {
    depth_format(view.texture().format())?;
    usages("depth buffer", view.texture(), TextureUsages::TEXTURE_BINDING)
}

/// Of normals that go with such a depth buffer; there is no `R32Uint` with several samples.
pub(crate) fn normal_beside(normal: &wgpu::TextureView, depth: &wgpu::TextureView) -> Result<(), Error> {
    let depth = depth.texture();
    self::normal(normal, (depth.width(), depth.height()))
}

/// Of a depth buffer with one sample a pixel.
pub(super) fn depth(view: &wgpu::TextureView, size: (u32, u32)) -> Result<(), Error> {
    let texture = view.texture();
    depth_format(texture.format())?;
    check_texture("depth buffer", texture, size, TextureUsages::TEXTURE_BINDING)
}

/// 24 bits or floats.
fn depth_format(format: TextureFormat) -> Result<(), Error> {
    use TextureFormat::{Depth24Plus, Depth24PlusStencil8, Depth32Float, Depth32FloatStencil8};
    match format {
        Depth24Plus | Depth24PlusStencil8 | Depth32Float | Depth32FloatStencil8 => Ok(()),
        other => lent(format!(
            "the depth buffer is {other:?}; make it Depth32Float, Depth24Plus or one of these with stencil"
        )),
    }
}

/// Of packed normals.
pub(super) fn normal(view: &wgpu::TextureView, size: (u32, u32)) -> Result<(), Error> {
    normal_format(view.texture().format())?;
    check_texture("texture of normals", view.texture(), size, TextureUsages::TEXTURE_BINDING)
}

fn normal_format(found: TextureFormat) -> Result<(), Error> {
    if found == TextureFormat::R32Uint {
        return Ok(());
    }
    lent(format!(
        "the texture of normals is {found:?}; make it R32Uint, packed as `wgsl::PACK_NORMAL` does, or give none"
    ))
}

/// Of `depth`'s texture with both aspects.
pub(super) fn stencil(view: &wgpu::TextureView, depth: &wgpu::TextureView) -> Result<(), Error> {
    let texture = view.texture();
    if texture != depth.texture() {
        return lent("the stencil is of another texture than the depth; lend a view of the same one".into());
    }
    if !texture.format().has_stencil_aspect() {
        let found = texture.format();
        return lent(format!(
            "the depth buffer is {found:?}, which has no stencil; lend none, or add one to the format"
        ));
    }
    usages("depth buffer", texture, TextureUsages::RENDER_ATTACHMENT)
}

/// A texture with one sample a pixel that has a level of `size` and the usages of `needed`.
pub(crate) fn check_texture(
    what: &str,
    texture: &wgpu::Texture,
    (width, height): (u32, u32),
    needed: TextureUsages,
) -> Result<(), Error> {
    if texture.dimension() != wgpu::TextureDimension::D2 {
        let found = texture.dimension();
        return lent(format!("the {what} is {found:?}; make it a two-dimensional texture"));
    }
    let samples = texture.sample_count();
    if samples != 1 {
        return lent(format!(
            "the {what} has {samples} samples a pixel; `Resolve` makes receivers with one of it, every frame"
        ));
    }
    usages(what, texture, needed)?;
    let (w, h) = (texture.width(), texture.height());
    let has_level = |level: u32| (1.max(w >> level), 1.max(h >> level)) == (width, height);
    if !(0..texture.mip_level_count()).any(has_level) {
        return lent(format!(
            "the {what} is {w}×{h} and not {width}×{height}; give its size, or use a part of it by `Resolve`"
        ));
    }
    Ok(())
}

fn usages(what: &str, texture: &wgpu::Texture, needed: TextureUsages) -> Result<(), Error> {
    let lacking = needed - texture.usage();
    if lacking.is_empty() {
        return Ok(());
    }
    lent(format!("the {what} was made without {lacking:?}; add that to its usages"))
}

/// What only the driver knows of a view.
pub(crate) fn rejected(reason: String) -> Error {
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    Error::Lent(format!(
        "a view of receivers can't be bound; make it two-dimensional, of one layer, one level and the depth alone ({reason})"
    ))
}

/// What the driver says of a host's WGSL.
pub(crate) fn not_compiled(reason: String) -> Error {
    Error::Lent(format!(
        "the host's WGSL does not compile; it has to declare `fn view_distance(stored: f32) -> f32` ({})",
        reason.split_whitespace().collect::<Vec<_>>().join(" ")
    ))
}

fn lent(text: String) -> Result<(), Error> {
    Err(Error::Lent(text))
}
