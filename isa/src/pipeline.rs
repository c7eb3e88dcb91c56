//! A pipeline of Vulkan from the parts of one of wgpu.

use crate::formats;
use crate::spirv::{self, Checks, Spirv};
use anyhow::{Context, Result, bail};
use ash::{Device, vk};
use naga::ShaderStage;
use std::ffi::CString;
use umbrage::{PipelineKind, PipelineParts, RenderParts, StageParts};

/// The shaders of a pipeline by stage, each under file and entry point.
pub type Names = Vec<(vk::ShaderStageFlags, String)>;

/// Compiles it. The caller destroys it.
pub fn create(device: &Device, parts: &PipelineParts, checks: Checks) -> Result<(vk::Pipeline, Names)> {
    let (sets, layout) = layout(device, parts)?;
    let made = match &parts.kind {
        PipelineKind::Compute(stage) => compute(device, layout, stage, checks),
        PipelineKind::Render(parts) => render(device, layout, parts, checks),
    };
    // SAFETY: a pipeline that is made needs its layout no longer.
    unsafe {
        device.destroy_pipeline_layout(layout, None);
        sets.into_iter().for_each(|set| device.destroy_descriptor_set_layout(set, None));
    }
    made
}

fn layout(device: &Device, parts: &PipelineParts) -> Result<(Vec<vk::DescriptorSetLayout>, vk::PipelineLayout)> {
    let mut sets = Vec::new();
    for group in &parts.groups {
        let entries = group.as_deref().unwrap_or_default();
        let bindings = entries.iter().map(binding).collect::<Result<Vec<_>>>()?;
        let asked = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: `bindings` live through the call.
        sets.push(unsafe { device.create_descriptor_set_layout(&asked, None) }?);
    }
    let asked = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
    // SAFETY: the sets live.
    let layout = unsafe { device.create_pipeline_layout(&asked, None) }?;
    Ok((sets, layout))
}

fn binding(entry: &wgpu::BindGroupLayoutEntry) -> Result<vk::DescriptorSetLayoutBinding<'static>> {
    use vk::DescriptorType as D;
    use wgpu::{BindingType as B, BufferBindingType as Of};
    let kind = match entry.ty {
        B::Buffer { ty: Of::Uniform, has_dynamic_offset: false, .. } => D::UNIFORM_BUFFER,
        B::Buffer { ty: Of::Uniform, .. } => D::UNIFORM_BUFFER_DYNAMIC,
        B::Buffer { has_dynamic_offset: false, .. } => D::STORAGE_BUFFER,
        B::Buffer { .. } => D::STORAGE_BUFFER_DYNAMIC,
        B::Sampler(_) => D::SAMPLER,
        B::Texture { .. } => D::SAMPLED_IMAGE,
        B::StorageTexture { .. } => D::STORAGE_IMAGE,
        ref other => bail!("no technique had a binding such as {other:?} before"),
    };
    Ok(vk::DescriptorSetLayoutBinding::default()
        .binding(entry.binding)
        .descriptor_type(kind)
        .descriptor_count(entry.count.map_or(1, |count| count.get()))
        .stage_flags(vk::ShaderStageFlags::ALL))
}

/// A shader as a pipeline takes it.
struct Stage {
    module: vk::ShaderModule,
    entry: CString,
    flag: vk::ShaderStageFlags,
    name: String,
}

impl Stage {
    fn new(device: &Device, stage: ShaderStage, parts: &StageParts, checks: Checks) -> Result<Self> {
        let Spirv { words, entry } = spirv::translate(stage, parts, checks)?;
        let asked = vk::ShaderModuleCreateInfo::default().code(&words);
        // SAFETY: naga has written valid SPIR-V, which lives through the call.
        let module = unsafe { device.create_shader_module(&asked, None) }?;
        let flag = match stage {
            ShaderStage::Vertex => vk::ShaderStageFlags::VERTEX,
            ShaderStage::Fragment => vk::ShaderStageFlags::FRAGMENT,
            _ => vk::ShaderStageFlags::COMPUTE,
        };
        let name = format!("{}: {entry}", parts.name);
        Ok(Self { module, entry: CString::new(entry)?, flag, name })
    }

    fn info(&self) -> vk::PipelineShaderStageCreateInfo<'_> {
        vk::PipelineShaderStageCreateInfo::default().stage(self.flag).module(self.module).name(&self.entry)
    }

    fn end(self, device: &Device) -> (vk::ShaderStageFlags, String) {
        // SAFETY: a pipeline that is made needs its modules no longer.
        unsafe { device.destroy_shader_module(self.module, None) };
        (self.flag, self.name)
    }
}

const ASKED: vk::PipelineCreateFlags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;

fn compute(
    device: &Device,
    layout: vk::PipelineLayout,
    parts: &StageParts,
    checks: Checks,
) -> Result<(vk::Pipeline, Names)> {
    let stage = Stage::new(device, ShaderStage::Compute, parts, checks)?;
    let asked = vk::ComputePipelineCreateInfo::default().flags(ASKED).stage(stage.info()).layout(layout);
    // SAFETY: all that it names lives through the call.
    let made = unsafe { device.create_compute_pipelines(vk::PipelineCache::null(), &[asked], None) };
    let made = made.map_err(|(_, error)| error).with_context(|| stage.name.clone());
    let name = stage.end(device);
    Ok((made?[0], vec![name]))
}

fn render(
    device: &Device,
    layout: vk::PipelineLayout,
    parts: &RenderParts,
    checks: Checks,
) -> Result<(vk::Pipeline, Names)> {
    let RenderParts { vertex, buffers, primitive, depth_stencil, multisample, fragment } = parts;
    let mut stages = vec![Stage::new(device, ShaderStage::Vertex, vertex, checks)?];
    let targets = fragment.as_ref().map_or(&[][..], |(_, targets)| targets);
    if let Some((parts, _)) = fragment {
        stages.push(Stage::new(device, ShaderStage::Fragment, parts, checks)?);
    }
    let infos: Vec<_> = stages.iter().map(Stage::info).collect();
    let (bindings, attributes) = vertex_input(buffers)?;
    let input = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(topology(primitive.topology));
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .depth_clamp_enable(primitive.unclipped_depth)
        .cull_mode(cull_mode(primitive.cull_mode))
        .line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::from_raw(multisample.count));
    let depth = depth_state(depth_stencil.as_ref());
    let blends: Vec<_> = targets.iter().map(blend).collect();
    let blending = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR, vk::DynamicState::STENCIL_REFERENCE];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let colors = targets.iter().map(|t| t.as_ref().map_or(Ok(vk::Format::UNDEFINED), |t| formats::texture(t.format)));
    let colors = colors.collect::<Result<Vec<_>>>()?;
    let mut attached = vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&colors);
    if let Some(state) = depth_stencil {
        let format = formats::texture(state.format)?;
        attached = attached.depth_attachment_format(format);
        if state.format.has_stencil_aspect() {
            attached = attached.stencil_attachment_format(format);
        }
    }
    let asked = vk::GraphicsPipelineCreateInfo::default()
        .flags(ASKED)
        .stages(&infos)
        .vertex_input_state(&input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .color_blend_state(&blending)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut attached);
    // SAFETY: all that it names lives through the call.
    let made = unsafe { device.create_graphics_pipelines(vk::PipelineCache::null(), &[asked], None) };
    let made = made.map_err(|(_, error)| error).with_context(|| stages[0].name.clone());
    let names = stages.into_iter().map(|stage| stage.end(device)).collect();
    Ok((made?[0], names))
}

type VertexBuffers = [Option<(u64, wgpu::VertexStepMode, Vec<wgpu::VertexAttribute>)>];
type Input = (Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>);

fn vertex_input(buffers: &VertexBuffers) -> Result<Input> {
    let (mut bindings, mut attributes) = (Vec::new(), Vec::new());
    for (number, buffer) in (0..).zip(buffers) {
        let Some((stride, step, fields)) = buffer else { continue };
        let input_rate = match step {
            wgpu::VertexStepMode::Vertex => vk::VertexInputRate::VERTEX,
            wgpu::VertexStepMode::Instance => vk::VertexInputRate::INSTANCE,
        };
        let stride = u32::try_from(*stride)?;
        bindings.push(vk::VertexInputBindingDescription { binding: number, stride, input_rate });
        for field in fields {
            attributes.push(vk::VertexInputAttributeDescription {
                location: field.shader_location,
                binding: number,
                format: formats::vertex(field.format)?,
                offset: u32::try_from(field.offset)?,
            });
        }
    }
    Ok((bindings, attributes))
}

fn topology(topology: wgpu::PrimitiveTopology) -> vk::PrimitiveTopology {
    match topology {
        wgpu::PrimitiveTopology::PointList => vk::PrimitiveTopology::POINT_LIST,
        wgpu::PrimitiveTopology::LineList => vk::PrimitiveTopology::LINE_LIST,
        wgpu::PrimitiveTopology::LineStrip => vk::PrimitiveTopology::LINE_STRIP,
        wgpu::PrimitiveTopology::TriangleList => vk::PrimitiveTopology::TRIANGLE_LIST,
        wgpu::PrimitiveTopology::TriangleStrip => vk::PrimitiveTopology::TRIANGLE_STRIP,
    }
}

fn cull_mode(face: Option<wgpu::Face>) -> vk::CullModeFlags {
    match face {
        None => vk::CullModeFlags::NONE,
        Some(wgpu::Face::Front) => vk::CullModeFlags::FRONT,
        Some(wgpu::Face::Back) => vk::CullModeFlags::BACK,
    }
}

/// Whether there is a test, and whether depth is written: what shaders depend on. Which
/// comparison it is makes no difference to them.
fn depth_state(state: Option<&wgpu::DepthStencilState>) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    let none = vk::PipelineDepthStencilStateCreateInfo::default();
    state.map_or(none, |state| {
        none.depth_test_enable(true)
            .depth_write_enable(state.depth_write_enabled.unwrap_or(false))
            .depth_compare_op(vk::CompareOp::GREATER_OR_EQUAL)
            .stencil_test_enable(state.stencil.is_enabled())
    })
}

/// Whether the target is blended: shaders depend on no more.
fn blend(target: &Option<wgpu::ColorTargetState>) -> vk::PipelineColorBlendAttachmentState {
    let (one, add) = (vk::BlendFactor::ONE, vk::BlendOp::ADD);
    let mask = target.as_ref().map_or(0, |target| target.write_mask.bits());
    vk::PipelineColorBlendAttachmentState {
        blend_enable: target.as_ref().is_some_and(|target| target.blend.is_some()).into(),
        src_color_blend_factor: one,
        dst_color_blend_factor: one,
        color_blend_op: add,
        src_alpha_blend_factor: one,
        dst_alpha_blend_factor: one,
        alpha_blend_op: add,
        color_write_mask: vk::ColorComponentFlags::from_raw(mask),
    }
}
