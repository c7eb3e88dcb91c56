//! From what a frame has left to the picture of a pane, and to numbers that are read back.

use super::{Drawn, Pane, Shared};
use crate::show::{Way, truth_texture, upload};
use crate::slow;
use crate::stage::Stage;
use crate::state::{COLOR, ERROR, VISIBILITY};
use crate::truth::Traced;
use std::sync::Arc;
use umbrage::{Gpu, read};
use umbrage_core::{Camera, Image};

impl Pane {
    /// Brings what the frame has left into the pane's own picture.
    pub(super) fn copy(
        &mut self,
        shared: &Shared<'_>,
        stage: &Stage,
        drawn: &Drawn,
        main: usize,
        camera: &Camera,
    ) -> Result<(), String> {
        let gpu = shared.gpu;
        let renderer = &stage.renderer;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let view = |texture: &wgpu::Texture| texture.create_view(&Default::default());
        let visibility = || renderer.visibility_texture(main).map(view).map_err(|e| e.to_string());
        match drawn.pane.picture.as_str() {
            COLOR => {
                // They differ in how the same bytes are read alone.
                let (from, to) = (renderer.picture().as_image_copy(), self.texture.as_image_copy());
                encoder.copy_texture_to_texture(from, to, self.texture.size());
            }
            VISIBILITY => shared.show.draw(&mut encoder, &visibility()?, None, &self.view, Way::Numbers([0.0, 1.0])),
            ERROR => {
                let truth = truth_view(gpu, shared.main_truth().map(|t| &**t), drawn.size);
                let way = Way::Difference(drawn.gain);
                shared.show.draw(&mut encoder, &visibility()?, Some(&truth), &self.view, way);
            }
            "depth" => {
                let depth =
                    wgpu::TextureViewDescriptor { aspect: wgpu::TextureAspect::DepthOnly, ..Default::default() };
                let depth = renderer.depth_texture().create_view(&depth);
                let high = self.extremes.map_or(1.0, |[_, high]| high);
                shared.show.draw(
                    &mut encoder,
                    &depth,
                    None,
                    &self.view,
                    Way::Numbers(drawn.range.unwrap_or([0.0, high])),
                );
                self.look(gpu, renderer.depth_texture(), 0);
            }
            other if slow::is_slow(other) => {
                self.slow.ask(other, shared, stage, main, drawn.size, camera)?;
            }
            other => {
                let technique = renderer.technique(main).ok_or("no light shines")?;
                let views = technique.inside().debug_views();
                let view = views.iter().find(|v| v.name == other).ok_or_else(|| {
                    let names: Vec<_> = views.iter().map(|v| v.name).collect();
                    let names = if names.is_empty() { "no views at all".into() } else { names.join(", ") };
                    format!("there is no `{other}` of this light; its views: {names}")
                })?;
                let is_color = view.texture.format().components() == 4;
                let has_depth = view.texture.format().has_depth_aspect();
                let source = view.texture.create_view(&wgpu::TextureViewDescriptor {
                    dimension: Some(wgpu::TextureViewDimension::D2),
                    aspect: if has_depth { wgpu::TextureAspect::DepthOnly } else { wgpu::TextureAspect::All },
                    base_array_layer: view.layer,
                    array_layer_count: Some(1),
                    base_mip_level: 0,
                    mip_level_count: Some(1),
                    ..Default::default()
                });
                let way = if is_color {
                    Way::Colors
                } else {
                    Way::Numbers(drawn.range.unwrap_or([0.0, self.extremes.map_or(1.0, |[_, high]| high)]))
                };
                shared.show.draw(&mut encoder, &source, None, &self.view, way);
                if !is_color {
                    self.look(gpu, view.texture, view.layer);
                }
            }
        }
        gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Asks for the numbers of a view, once, to stretch them.
    pub(super) fn look(&mut self, gpu: &Gpu, texture: &wgpu::Texture, layer: u32) {
        if self.extremes.is_none() && !self.looking.is_under_way() {
            let (gpu, texture) = (gpu.clone(), texture.clone());
            let found = self.looking.ask(async move { read::later::one_channel(&gpu, &texture, layer).await });
            self.is_stale |= found.is_some();
            self.extremes = found.and_then(Result::ok).map(|image| extremes(&image));
        }
    }

    /// Asks for the visibility, unless it is under way.
    pub(super) fn read(&mut self, shared: &Shared<'_>, stage: &Stage, main: usize) {
        self.is_unread = self.reading.is_under_way();
        if self.is_unread {
            return;
        }
        if let Ok(texture) = stage.renderer.visibility_texture(main) {
            let (gpu, texture) = (shared.gpu.clone(), texture.clone());
            let found = self.reading.ask(async move { read::later::one_channel(&gpu, &texture, 0).await });
            self.visibility = found.and_then(Result::ok).map(Arc::new).or(self.visibility.take());
        }
    }
}

/// Smallest and largest of a picture's numbers.
pub(super) fn extremes(image: &Image<f32>) -> [f32; 2] {
    let finite = image.data.iter().copied().filter(|v| v.is_finite());
    let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
    if low < high { [low, high] } else { [0.0, if high > 0.0 { high } else { 1.0 }] }
}

pub(super) fn truth_view(gpu: &Gpu, truth: Option<&Traced>, size: (u32, u32)) -> wgpu::TextureView {
    let texture = truth_texture(gpu, size);
    let picture = match truth.filter(|truth| truth.visibility.size() == size) {
        None => Image::filled(size.0, size.1, -1.0),
        Some(truth) => {
            let pairs = truth.visibility.data.iter().zip(&truth.scored.data);
            Image { width: size.0, height: size.1, data: pairs.map(|(v, s)| if *s { *v } else { -1.0 }).collect() }
        }
    };
    upload(gpu, &texture, &picture);
    texture.create_view(&Default::default())
}
