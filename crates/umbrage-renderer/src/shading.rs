//! Lights under their visibility: the standard lighting model (PX 2.2.4), per pixel. All lights
//! that answer with visibility go to the picture in one pass where they are few; else each is added
//! to the radiance of those before.

use crate::gbuffer::SURFACE_MODULE;
use crate::lit::Target;
use crate::radiance::RadiancePass;
use crate::targets::{GBuffer, PICTURE, Targets, WIDE};
use crate::tonemap::{DISPLAY_MODULE, encodes};
use umbrage::fullscreen::{self, FLOATS, Fullscreen, UNIFORM, additive, attachment, bind, layout};
use umbrage::{Eye, Gpu, Passes, Receivers, Shader, View, VisibilityTarget, shader_struct};
use umbrage_core::{LightShape, glam::DVec3};

/// The shader.
pub const SHADER: Shader = Shader::new("shading", include_str!("shading.wgsl"))
    .with_modules(&[SURFACE_MODULE, DISPLAY_MODULE])
    .with_layouts(&[ShadingLight::LAYOUT, ShadingInput::LAYOUT]);

/// As many lights as one pass shades.
pub(crate) const MOST_LIGHTS: usize = 4;

shader_struct! {
    /// A light as the shader reads it, relative to the eye.
    struct ShadingLight {
        /// Place of the light's centre (w = 1) or direction to it (w = 0).
        center: [f32; 4],
        /// Colour times intensity.
        color: [f32; 3],
        range: f32,
        attenuation: [f32; 3],
        /// Cosine at which a spot has full strength.
        inner_cos: f32,
        /// The way the light travels, or the emitting side.
        direction: [f32; 3],
        /// Cosine at which the light has fallen to nothing; −2 for lights to all sides.
        outer_cos: f32,
    }
}

shader_struct! {
    /// All that a pass shades by.
    struct ShadingInput {
        eye: Eye,
        ambient: [f32; 3],
        spare: f32,
        /// Where lines of sight are parallel; else zero.
        toward_eye: [f32; 3],
        more_spare: f32,
        lights: [ShadingLight; MOST_LIGHTS],
    }
}

/// Shades a G-buffer.
pub(crate) struct Shading {
    module: wgpu::ShaderModule,
    /// Adds a light to radiance.
    add: wgpu::RenderPipeline,
    /// Leaves what lights are added to.
    start: (wgpu::RenderPipeline, [wgpu::BindGroup; 2]),
    /// To pictures of a format, by how many lights there are.
    pictures: Vec<(wgpu::TextureFormat, Vec<wgpu::RenderPipeline>)>,
    surface_layout: wgpu::BindGroupLayout,
    light_layout: wgpu::BindGroupLayout,
    /// For techniques that leave nothing to shade.
    pub radiance: RadiancePass,
}

/// What a pass of one light needs of its own, or of some lights together.
pub(crate) struct Slot {
    uniforms: wgpu::Buffer,
    bind_group: wgpu::BindGroup,
}

/// Lights that one pass shades, as long as they are the same.
pub(crate) struct Together {
    visibilities: Vec<wgpu::Texture>,
    slot: Slot,
}

impl Shading {
    /// For a scene of this ambient light.
    pub fn new(gpu: &Gpu, ambient: [f32; 3]) -> Self {
        let stage = wgpu::ShaderStages::FRAGMENT;
        let surface_layout = layout(gpu, "surface", stage, &[fullscreen::texture(wgpu::TextureSampleType::Uint)]);
        let floats = fullscreen::texture(FLOATS);
        let light_layout = layout(gpu, "lights", stage, &[UNIFORM, floats, floats, floats, floats]);
        let module = SHADER.module(gpu);
        let radiance = RadiancePass::new(gpu);
        let groups = [&surface_layout, &light_layout];
        let add = pipeline(gpu, &module, groups, ("add", 1), additive(WIDE));
        let start_layout = layout(gpu, "no light", stage, &[UNIFORM]);
        let groups_of = |ambient| {
            let input = ShadingInput { ambient, ..ShadingInput::default() };
            let uniforms = gpu.buffer("no light", &[input], wgpu::BufferUsages::UNIFORM);
            bind(gpu, "no light", &start_layout, &[uniforms.as_entire_binding()])
        };
        let start = (
            pipeline(gpu, &module, [&surface_layout, &start_layout], ("start", 0), WIDE.into()),
            [ambient, [0.0; 3]].map(groups_of),
        );
        let mut shading = Self { module, add, start, pictures: Vec::new(), surface_layout, light_layout, radiance };
        shading.prepare(gpu, PICTURE);
        shading
    }

    /// What is read of a G-buffer.
    pub fn surface(&self, gpu: &Gpu, gbuffer: &GBuffer) -> wgpu::BindGroup {
        bind(gpu, "surface", &self.surface_layout, &[wgpu::BindingResource::TextureView(&gbuffer.surface_view)])
    }

    pub fn slot(&self, gpu: &Gpu, visibilities: &[&VisibilityTarget]) -> Slot {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniforms = gpu.buffer("lights", &[ShadingInput::default()], usage);
        // Those beyond the last light are not read.
        let views = visibilities.iter().cycle().take(MOST_LIGHTS);
        let views = views.map(|target| wgpu::BindingResource::TextureView(&target.view));
        let resources: Vec<_> = std::iter::once(uniforms.as_entire_binding()).chain(views).collect();
        let bind_group = bind(gpu, "lights", &self.light_layout, &resources);
        Slot { uniforms, bind_group }
    }

    /// Makes what one pass needs for the visibilities of some lights, where `together` has it not.
    pub fn join(&self, gpu: &Gpu, visibilities: &[&VisibilityTarget], together: &mut Option<Together>) {
        let is_it = |known: &&mut Together| known.visibilities.iter().eq(visibilities.iter().map(|v| &v.texture));
        if together.as_mut().filter(is_it).is_none() {
            let slot = self.slot(gpu, visibilities);
            let visibilities = visibilities.iter().map(|target| target.texture.clone()).collect();
            *together = Some(Together { visibilities, slot });
        }
    }

    /// Makes what pictures of this format need, under however many lights, where it is not there
    /// yet: another light that comes then compiles nothing.
    pub fn prepare(&mut self, gpu: &Gpu, format: wgpu::TextureFormat) {
        if self.pictures.iter().all(|(known, _)| *known != format) {
            let groups = [&self.surface_layout, &self.light_layout];
            let of = |lights| pipeline(gpu, &self.module, groups, ("picture", lights), format.into());
            self.pictures.push((format, (1..=MOST_LIGHTS).map(of).collect()));
        }
    }

    /// Draws the picture under the lights of `views`, for which all was prepared.
    pub fn record_picture(
        &self,
        passes: &mut Passes<'_>,
        targets: &Targets,
        (views, ambient): (&[View<'_>], [f32; 3]),
        together: &Together,
        (target, format): (&wgpu::TextureView, wgpu::TextureFormat),
    ) {
        let known = self.pictures.iter().find(|(known, _)| *known == format);
        let Some(pipeline) = known.and_then(|(_, by_count)| by_count.get(views.len().checked_sub(1)?)) else { return };
        passes.upload(&together.slot.uniforms, bytemuck::bytes_of(&shading_input(views, ambient)));
        let target = attachment(target, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render("picture", &[target], None);
        draw(&mut pass, pipeline, targets, &together.slot.bind_group);
    }

    /// Leaves in the radiance what surfaces send out without any light.
    ///
    /// Ambient light stands for that of a sky, and is left out where one shines.
    pub fn record_start(&self, passes: &mut Passes<'_>, targets: &Targets, has_sky: bool) {
        let target = attachment(&targets.gbuffer.radiance_view, wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT));
        let mut pass = passes.render("start", &[target], None);
        draw(&mut pass, &self.start.0, targets, &self.start.1[usize::from(has_sky)]);
    }

    /// Adds the light of `view` within these pixels, by the answer of its technique.
    pub fn record(
        &self,
        passes: &mut Passes<'_>,
        targets: &Targets,
        view: &View<'_>,
        pixels: [u32; 4],
        answer: &Target,
    ) {
        match answer {
            Target::Visibility(_, slot) => self.record_light(passes, targets, view, pixels, slot),
            Target::Radiance(_, read) => self.radiance.record(passes, &targets.gbuffer.radiance_view, pixels, read),
        }
    }

    fn record_light(
        &self,
        passes: &mut Passes<'_>,
        targets: &Targets,
        view: &View<'_>,
        [x, y, width, height]: [u32; 4],
        slot: &Slot,
    ) {
        passes.upload(&slot.uniforms, bytemuck::bytes_of(&shading_input(&[*view], [0.0; 3])));
        let target = attachment(&targets.gbuffer.radiance_view, wgpu::LoadOp::Load);
        let mut pass = passes.render("light", &[target], None);
        pass.set_scissor_rect(x, y, width, height);
        draw(&mut pass, &self.add, targets, &slot.bind_group);
    }
}

fn draw(pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, targets: &Targets, lights: &wgpu::BindGroup) {
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, targets.receivers.bind_group(), &[]);
    pass.set_bind_group(1, &targets.surface, &[]);
    pass.set_bind_group(2, lights, &[]);
    pass.draw(0..3, 0..1);
}

fn pipeline(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    [surface, lights]: [&wgpu::BindGroupLayout; 2],
    (entry, count): (&'static str, usize),
    target: wgpu::ColorTargetState,
) -> wgpu::RenderPipeline {
    let constants = [("LIGHTS", count as f64), ("ENCODES", f64::from(u8::from(encodes(target.format))))];
    // A constant that an entry point does not use is none of the module's.
    let constants = match entry {
        "picture" => &constants[..],
        "add" => &constants[..1],
        _ => &[],
    };
    let groups = &[&Receivers::layout(gpu), surface, lights];
    Fullscreen { label: "shading", module, entry, groups, target, constants }.pipeline(gpu)
}

/// What the shader reads of at most [`MOST_LIGHTS`] lights seen by one camera.
fn shading_input(views: &[View<'_>], ambient: [f32; 3]) -> ShadingInput {
    let mut input = ShadingInput { ambient, ..ShadingInput::default() };
    for (light, view) in input.lights.iter_mut().zip(views) {
        *light = shading_light(view);
    }
    if let Some(view) = views.first() {
        input.eye = Eye::new(view);
        let camera = &view.camera;
        input.toward_eye = if camera.is_parallel() { (-camera.forward()).as_vec3().to_array() } else { [0.0; 3] };
    }
    input
}

fn shading_light(view: &View<'_>) -> ShadingLight {
    let light = view.light;
    let cos = |angle_deg: f64| angle_deg.to_radians().cos() as f32;
    let (direction, inner_cos, outer_cos) = match light.shape {
        LightShape::Spot { direction, inner_angle_deg, outer_angle_deg, .. } => {
            (direction, cos(inner_angle_deg), cos(outer_angle_deg))
        }
        // One side only: nothing behind the plane, full strength in front of it.
        LightShape::Disc { direction, .. } | LightShape::Rect { direction, .. } => (direction, 1e-3, 0.0),
        _ => (DVec3::ZERO, -1.0, -2.0),
    };
    let center = light.shape.center();
    ShadingLight {
        center: (center.truncate() - view.camera.eye * center.w).extend(center.w).as_vec4().to_array(),
        color: (light.color * light.intensity).to_array(),
        range: light.range.map_or(f32::MAX, |r| r as f32),
        attenuation: light.attenuation.to_array(),
        inner_cos,
        direction: direction.as_vec3().to_array(),
        outer_cos,
    }
}
