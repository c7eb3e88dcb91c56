//! Materials and textures on the GPU.

use super::ids::Slots;
use super::journal::Journal;
use super::store::Store;
use crate::fullscreen::{self, bind, layout};
use crate::{error::Error, gpu::Gpu, shader::Shared, shader::shader_struct};
use std::collections::HashMap;
use umbrage_core::{Filter, Sampling, Texture, Wrap};
use wgpu::util::DeviceExt;

shader_struct! {
    /// Appearance of an instance.
    pub(crate) struct Material {
        base_color: [f32; 4],
        emissive: [f32; 3],
        alpha_cutoff: f32,
        specular: f32,
        shininess: f32,
        spare: [f32; 2],
    }
}

/// What the host has to agree on with `materials.wgsl`.
pub(super) const SHARED: Shared = Shared { module: "materials", layouts: &[Material::LAYOUT], constants: &[] };

/// A material, and what draws have to know of it.
pub(super) struct Look {
    pub masked: bool,
    /// Index into the textures.
    pub texture: Option<u32>,
    /// Places of the instances that it is the material of.
    pub members: Vec<u32>,
}

/// A texture, bound with its sampler.
pub(super) struct Picture {
    group: wgpu::BindGroup,
    /// When it was added.
    pub order: u64,
    /// How many materials have it.
    users: u32,
}

/// All materials and textures.
pub(super) struct Appearance {
    pub store: Store,
    pub looks: Vec<Look>,
    pub slots: Slots,
    pub pictures: Vec<Picture>,
    pub texture_slots: Slots,
    samplers: HashMap<Sampling, wgpu::Sampler>,
    /// Plain white, for materials without a texture.
    white: wgpu::BindGroup,
    added: u64,
}

impl Appearance {
    /// With room for so many materials.
    pub fn new(gpu: &Gpu, of: u32, materials: u64) -> Result<Self, Error> {
        let sampling = Sampling::default();
        let white = Texture { name: "white".into(), width: 1, height: 1, rgba: vec![[255; 4]], sampling };
        let plain = sampler(gpu, sampling);
        Ok(Self {
            store: Store::new(gpu, "materials", size_of::<Material>() as u64, materials)?,
            looks: Vec::new(),
            slots: Slots::new("material", of),
            pictures: Vec::new(),
            texture_slots: Slots::new("texture", of),
            white: bind_group(gpu, &white, &plain)?,
            samplers: HashMap::from([(sampling, plain)]),
            added: 0,
        })
    }

    /// What group 2 is for a texture, or for none.
    pub fn group(&self, texture: Option<u32>) -> &wgpu::BindGroup {
        texture.map_or(&self.white, |texture| &self.pictures[texture as usize].group)
    }

    /// Adds a texture; its number.
    pub fn add_texture(&mut self, gpu: &Gpu, texture: &Texture) -> Result<u32, Error> {
        let group = self.bound(gpu, texture)?;
        let (number, _) = self.texture_slots.insert();
        self.added += 1;
        let picture = Picture { group, order: self.added, users: 0 };
        match self.pictures.get_mut(number as usize) {
            Some(spare) => *spare = picture,
            None => self.pictures.push(picture),
        }
        Ok(number)
    }

    /// Puts another texture in the place of one. It is a new one on the GPU, since frames that were
    /// recorded before read the old one.
    pub fn replace_texture(&mut self, gpu: &Gpu, number: u32, texture: &Texture) -> Result<(), Error> {
        self.pictures[number as usize].group = self.bound(gpu, texture)?;
        Ok(())
    }

    /// # Errors
    /// [`Error::Scene`] while materials have it.
    pub fn remove_texture(&mut self, number: u32) -> Result<(), Error> {
        let picture = &mut self.pictures[number as usize];
        if picture.users > 0 {
            let users = picture.users;
            return Err(Error::Scene(format!("{users} materials have this texture; replace or remove them first")));
        }
        picture.group = self.white.clone();
        self.texture_slots.remove(number);
        Ok(())
    }

    /// Adds a material; its number.
    pub fn add(
        &mut self,
        gpu: &Gpu,
        journal: &mut Journal,
        material: &umbrage_core::Material,
        texture: Option<u32>,
    ) -> Result<u32, Error> {
        let (number, _) = self.slots.insert();
        if let Err(error) = self.store.fit(gpu, self.looks.len().max(number as usize + 1) as u64, journal) {
            self.slots.remove(number);
            return Err(error);
        }
        let look = Look { masked: false, texture: None, members: Vec::new() };
        match self.looks.get_mut(number as usize) {
            Some(spare) => *spare = look,
            None => self.looks.push(look),
        }
        self.set(journal, number, material, texture);
        Ok(number)
    }

    /// Changes a material.
    pub fn set(&mut self, journal: &mut Journal, number: u32, material: &umbrage_core::Material, texture: Option<u32>) {
        let look = &mut self.looks[number as usize];
        look.masked = material.alpha_cutoff.is_some();
        let before = std::mem::replace(&mut look.texture, texture);
        if let Some(before) = before {
            self.pictures[before as usize].users -= 1;
        }
        if let Some(texture) = texture {
            self.pictures[texture as usize].users += 1;
        }
        self.store.write(journal, number, &[data(material)]);
    }

    /// # Errors
    /// [`Error::Scene`] while instances have it.
    pub fn remove(&mut self, number: u32) -> Result<(), Error> {
        let look = &mut self.looks[number as usize];
        if !look.members.is_empty() {
            let users = look.members.len();
            return Err(Error::Scene(format!(
                "{users} instances have this material; remove them or give them another first"
            )));
        }
        if let Some(texture) = look.texture.take() {
            self.pictures[texture as usize].users -= 1;
        }
        self.slots.remove(number);
        Ok(())
    }

    fn bound(&mut self, gpu: &Gpu, texture: &Texture) -> Result<wgpu::BindGroup, Error> {
        let sampler = self.samplers.entry(texture.sampling).or_insert_with(|| sampler(gpu, texture.sampling));
        bind_group(gpu, texture, sampler)
    }
}

fn data(material: &umbrage_core::Material) -> Material {
    Material {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.to_array(),
        alpha_cutoff: material.alpha_cutoff.unwrap_or(0.0),
        specular: material.specular,
        shininess: material.shininess,
        spare: [0.0; 2],
    }
}

fn sampler(gpu: &Gpu, sampling: Sampling) -> wgpu::Sampler {
    let [address_mode_u, address_mode_v] = sampling.wrap.map(|wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
    });
    let filter = match sampling.filter {
        Filter::Linear => wgpu::FilterMode::Linear,
        Filter::Nearest => wgpu::FilterMode::Nearest,
    };
    gpu.sampler(&wgpu::SamplerDescriptor {
        label: Some("base colour"),
        address_mode_u,
        address_mode_v,
        mag_filter: filter,
        min_filter: filter,
        ..Default::default()
    })
}

fn bind_group(gpu: &Gpu, texture: &Texture, sampler: &wgpu::Sampler) -> Result<wgpu::BindGroup, Error> {
    gpu.check_size(&format!("texture `{}`", texture.name), texture.width, texture.height)?;
    if texture.rgba.len() as u64 != u64::from(texture.width) * u64::from(texture.height) {
        return Err(Error::Scene(format!("texture `{}` has not width × height pixels", texture.name)));
    }
    let descriptor = wgpu::TextureDescriptor {
        label: Some(&texture.name),
        size: wgpu::Extent3d { width: texture.width, height: texture.height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8UnormSrgb,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let data = texture.rgba.as_flattened();
    let on_gpu = gpu.device.create_texture_with_data(&gpu.queue, &descriptor, Default::default(), data);
    let view = on_gpu.create_view(&Default::default());
    let resources = [wgpu::BindingResource::TextureView(&view), wgpu::BindingResource::Sampler(sampler)];
    Ok(bind(gpu, &texture.name, &texture_layout(gpu), &resources))
}

/// Layout of the bind group that `materials.wgsl` declares as group 2.
pub(crate) fn texture_layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let filtered = fullscreen::texture(wgpu::TextureSampleType::Float { filterable: true });
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    layout(gpu, "base colour", wgpu::ShaderStages::FRAGMENT, &[filtered, sampler])
}
