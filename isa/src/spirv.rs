//! WGSL to SPIR-V, as wgpu does it for this driver.

use anyhow::{Context, Result, anyhow};
use naga::ShaderStage;
use naga::back::{pipeline_constants, spv};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use umbrage::StageParts;

/// What is added to shaders so that they do no harm whatever they are given.
#[derive(Clone, Copy, PartialEq)]
pub enum Checks {
    /// Loops end, indices stay in range, nothing is divided by zero.
    OfWgpu,
    /// Nothing.
    None,
}

/// A shader to hand to the driver.
pub struct Spirv {
    pub words: Vec<u32>,
    pub entry: String,
}

/// Translates one stage with its constants in place.
pub fn translate(stage: ShaderStage, parts: &StageParts, checks: Checks) -> Result<Spirv> {
    let module = naga::front::wgsl::parse_str(&parts.text).with_context(|| parts.name.to_string())?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module)?;
    let named = |entry: &&naga::EntryPoint| parts.entry.as_ref().is_none_or(|name| *name == entry.name);
    let entry = module.entry_points.iter().filter(|entry| entry.stage == stage).find(named);
    let entry = entry.with_context(|| format!("{} has no entry {:?}", parts.name, parts.entry))?.name.clone();
    let constants = parts.constants.iter().map(|(name, value)| (name.clone(), *value)).collect();
    let (module, info) = pipeline_constants::process_overrides(&module, &info, Some((stage, &entry)), &constants)
        .map_err(|error| anyhow!("{}: {error}", parts.name))?;
    let options = options(parts.zeroes, checks);
    let pipeline = spv::PipelineOptions { shader_stage: stage, entry_point: entry.clone() };
    let words = spv::write_vec(&module, &info, &options, Some(&pipeline))?;
    Ok(Spirv { words, entry })
}

/// Those of wgpu for a driver with robust access to buffers and images.
fn options(zeroes: bool, checks: Checks) -> spv::Options<'static> {
    let unchecked = BoundsCheckPolicy::Unchecked;
    let is_checked = checks == Checks::OfWgpu;
    spv::Options {
        lang_version: (1, 6),
        flags: spv::WriterFlags::ADJUST_COORDINATE_SPACE | spv::WriterFlags::CLAMP_FRAG_DEPTH,
        bounds_check_policies: BoundsCheckPolicies {
            index: if is_checked { BoundsCheckPolicy::Restrict } else { unchecked },
            buffer: unchecked,
            image_load: unchecked,
            binding_array: unchecked,
        },
        zero_initialize_workgroup_memory: match zeroes {
            true => spv::ZeroInitializeWorkgroupMemoryMode::Native,
            false => spv::ZeroInitializeWorkgroupMemoryMode::None,
        },
        force_loop_bounding: is_checked,
        emit_int_div_checks: is_checked,
        ..Default::default()
    }
}
