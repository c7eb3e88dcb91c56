//! The driver that compiles and runs nothing, and what it says of shaders.

use crate::pipeline;
use crate::spirv::Checks;
use anyhow::{Context, Result, bail};
use ash::{khr, vk};
use std::ffi::CStr;
use umbrage::PipelineParts;

/// A device of RADV on hardware that is not there.
pub struct Driver {
    // The functions of both end with the library that they come from.
    _entry: ash::Entry,
    _instance: ash::Instance,
    pub device: ash::Device,
    statistics: khr::pipeline_executable_properties::Device,
}

/// What one shader of a pipeline takes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShaderCost {
    /// File and entry point.
    pub name: String,
    pub stage: &'static str,
    pub vgprs: u64,
    pub sgprs: u64,
    /// Registers that did not fit, of both kinds.
    pub spilled: u64,
    /// Bytes of memory a lane.
    pub scratch: u64,
    /// Bytes of workgroup memory.
    pub lds: u64,
    pub code: u64,
    pub instructions: u64,
    /// Cycles of one wave alone, as the compiler estimates them.
    pub latency: u64,
    /// Cycles a wave where there are many, by the same estimate.
    pub inverse_throughput: u64,
    /// The same without what wgpu adds so that shaders do no harm.
    pub unchecked: u64,
    /// Waves that fit on a SIMD at once.
    pub subgroups: u64,
}

impl ShaderCost {
    /// Orders variants of a shader: what spills is dearest, then what takes longest.
    pub fn rank(&self) -> impl Ord {
        (self.spilled + self.scratch, self.inverse_throughput, self.instructions)
    }

    fn take(&mut self, name: &str, value: u64) {
        match name {
            "VGPRs" => self.vgprs = value,
            "SGPRs" => self.sgprs = value,
            "Spilled VGPRs" | "Spilled SGPRs" => self.spilled += value,
            "Scratch size" => self.scratch = value,
            "LDS size" => self.lds = value,
            "Code size" => self.code = value,
            "Instructions" => self.instructions = value,
            "Latency" => self.latency = value,
            "Inverse Throughput" => self.inverse_throughput = value,
            "Subgroups per SIMD" => self.subgroups = value,
            _ => {}
        }
    }
}

impl Driver {
    /// Opens RADV's device.
    pub fn open() -> Result<Self> {
        // SAFETY: the Vulkan loader is a library that programs load so.
        let entry = unsafe { ash::Entry::load() }.context("there is no Vulkan loader: install libvulkan1")?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let asked = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: `asked` lives through the call, and the entry through the instance.
        let instance = unsafe { entry.create_instance(&asked, None) }.context("no Vulkan instance")?;
        // SAFETY: the instance lives.
        let all = unsafe { instance.enumerate_physical_devices() }?;
        let Some(physical) = all.into_iter().find(|physical| is_radv(&instance, *physical)) else {
            bail!("RADV offers no device: set RADV_FORCE_FAMILY, and VK_ICD_FILENAMES to its radeon_icd.*.json");
        };
        let device = open_device(&instance, physical)?;
        let statistics = khr::pipeline_executable_properties::Device::new(&instance, &device);
        Ok(Self { _entry: entry, _instance: instance, device, statistics })
    }

    /// Compiles a pipeline; returns the cost of each of its shaders.
    pub fn compile(&self, parts: &PipelineParts) -> Result<Vec<ShaderCost>> {
        let mut costs = self.compile_with(parts, Checks::OfWgpu)?;
        for (cost, bare) in costs.iter_mut().zip(self.compile_with(parts, Checks::None)?) {
            cost.unchecked = bare.inverse_throughput;
        }
        Ok(costs)
    }

    fn compile_with(&self, parts: &PipelineParts, checks: Checks) -> Result<Vec<ShaderCost>> {
        let (made, names) = pipeline::create(&self.device, parts, checks)?;
        let costs = self.costs(made, &names);
        // SAFETY: nothing uses the pipeline any more.
        unsafe { self.device.destroy_pipeline(made, None) };
        costs
    }

    fn costs(&self, made: vk::Pipeline, names: &[(vk::ShaderStageFlags, String)]) -> Result<Vec<ShaderCost>> {
        let asked = vk::PipelineInfoKHR::default().pipeline(made);
        // SAFETY: the pipeline lives and was made to be asked.
        let executables = unsafe { self.statistics.get_pipeline_executable_properties(&asked) }?;
        let mut costs = Vec::new();
        for (index, executable) in (0..).zip(&executables) {
            // RADV gives a pipeline without a fragment shader an empty one.
            if let Some((stage, name)) = names.iter().find(|(stage, _)| executable.stages.contains(*stage)) {
                costs.push(self.cost(made, index, *stage, name)?);
            }
        }
        Ok(costs)
    }

    fn cost(&self, made: vk::Pipeline, index: u32, stage: vk::ShaderStageFlags, name: &str) -> Result<ShaderCost> {
        let stage = match stage {
            vk::ShaderStageFlags::VERTEX => "vertex",
            vk::ShaderStageFlags::FRAGMENT => "fragment",
            _ => "compute",
        };
        let mut cost = ShaderCost { name: name.into(), stage, ..Default::default() };
        let asked = vk::PipelineExecutableInfoKHR::default().pipeline(made).executable_index(index);
        // SAFETY: the pipeline lives and has this executable.
        for statistic in unsafe { self.statistics.get_pipeline_executable_statistics(&asked) }? {
            if statistic.format == vk::PipelineExecutableStatisticFormatKHR::UINT64 {
                let name = statistic.name_as_c_str().unwrap_or_default().to_string_lossy();
                // SAFETY: the format says that it is this member.
                cost.take(&name, unsafe { statistic.value.u64 });
            }
        }
        Ok(cost)
    }
}

fn is_radv(instance: &ash::Instance, physical: vk::PhysicalDevice) -> bool {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: both are of this instance.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    driver.driver_id == vk::DriverId::MESA_RADV
}

fn open_device(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<ash::Device> {
    const EXTENSIONS: [&CStr; 2] = [khr::pipeline_executable_properties::NAME, ash::ext::robustness2::NAME];
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut robust = vk::PhysicalDeviceRobustness2FeaturesEXT::default();
    let mut statistics = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default();
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut v12)
        .push_next(&mut v13)
        .push_next(&mut robust)
        .push_next(&mut statistics);
    // SAFETY: both are of this instance, and the chain lives through the calls.
    unsafe { instance.get_physical_device_features2(physical, &mut features) };
    let queue = [vk::DeviceQueueCreateInfo::default().queue_family_index(0).queue_priorities(&[1.0])];
    let names = EXTENSIONS.map(CStr::as_ptr);
    let asked = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queue)
        .enabled_extension_names(&names)
        .push_next(&mut features);
    // SAFETY: as above.
    unsafe { instance.create_device(physical, &asked, None) }.context("RADV opens no device")
}
