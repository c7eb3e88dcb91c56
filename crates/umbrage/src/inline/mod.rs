//! Visibility inside a host's own shader: the look-up of a light's maps as a part of its module,
//! for what no full-screen pass sees, such as forward shading, panes, particles and fog.

mod lent;
mod limits;
mod wgsl;

use crate::{error::Error, gpu::Gpu};
pub(crate) use lent::LentLookup;
pub use lent::{Binding, Lent, Resource};
use std::fmt::Write;

/// The look-ups of one or several lights for a module of WGSL that is the host's.
///
/// With the prefix `sun` a host's shader, of fragments or compute, calls one of
///
/// ```wgsl
/// fn sun_visibility(position: vec3f, normal: vec3f) -> f32
/// fn sun_visibility_of_pane(position: vec3f, normal: vec3f) -> f32
/// fn sun_visibility_in_air(position: vec3f) -> f32
/// ```
///
/// anywhere, since nothing in them asks for uniform control flow. `position` is relative to the
/// eye of the [`View`](crate::View) that the technique was prepared for, in metres with the axes of
/// the world, so that it is exact however far that is from the origin. `normal` is the geometric
/// one, of any length but 0, and is turned to the eye. The first is for surfaces that are among the
/// [`Casters`](crate::Casters) or that cast shadows anyway: those that face away from the light are
/// dark. A pane is lit through its back, and what is in the air has no normal.
///
/// The answer is that of the technique's full-screen pass: the share of the light, 0 to 1. Maps
/// cover what the camera sees of the receivers; to have them cover more, see
/// [`Casters::receive_in`](crate::Casters::receive_in). Where they cover nothing, it is 1.
///
/// Of several lights the functions take a number first, as `lights_visibility(light: u32, position:
/// vec3f, normal: vec3f)`; a number beyond them is lit. All names in the WGSL begin with the
/// prefix, there are no overrides in it, and all that it reads is in one bind group.
#[derive(Debug)]
pub struct Inline {
    prefix: String,
    group: u32,
    several: bool,
    lights: Vec<Lent>,
    wgsl: String,
    layout: wgpu::BindGroupLayout,
    bind_group: wgpu::BindGroup,
}

/// What a host has to do after [`Inline::follow`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[must_use = "a bind group or a shader that has changed takes the place of the old one"]
pub enum Followed {
    /// Nothing.
    Same,
    /// To bind the new [`Inline::bind_group`].
    BindGroup,
    /// Besides, to make pipelines anew, with the new [`Inline::wgsl`] and [`Inline::layout`].
    Shader,
}

impl Inline {
    /// Of one light. `group` is the number of the bind group in the host's module, `prefix` what
    /// names begin with.
    ///
    /// # Errors
    /// [`Error::Inline`] for a prefix that is no name, and where the device's limits do not allow
    /// so many bindings in one stage.
    pub fn new(gpu: &Gpu, light: Lent, group: u32, prefix: &str) -> Result<Self, Error> {
        Self::make(gpu, vec![light], group, prefix, false)
    }

    /// Of several lights, each by its place in `lights`.
    ///
    /// # Errors
    /// As [`Inline::new`]. WebGPU promises 12 uniform buffers, 16 textures, 16 samplers and 8
    /// storage buffers a stage: 12 lights with `pcf`, 6 with moments, 4 with `pcss`, less what the
    /// host binds itself.
    pub fn join(gpu: &Gpu, lights: &[Lent], group: u32, prefix: &str) -> Result<Self, Error> {
        Self::make(gpu, lights.to_vec(), group, prefix, true)
    }

    fn make(gpu: &Gpu, lights: Vec<Lent>, group: u32, prefix: &str, several: bool) -> Result<Self, Error> {
        check_prefix(prefix)?;
        limits::check(gpu, group, &lights)?;
        let layout = layout(gpu, prefix, &lights);
        let bind_group = bind(gpu, prefix, &layout, &lights);
        let wgsl = text(&lights, group, prefix, several)?;
        Ok(Self { prefix: prefix.into(), group, several, lights, wgsl, layout, bind_group })
    }

    /// Functions and what they need, to be put before or after the host's own text.
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }

    /// Layout of [`Inline::bind_group`], seen by fragment and compute shaders.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group. What is in it is right after the techniques were recorded into an encoder,
    /// for what is recorded into it later.
    pub fn bind_group(&self) -> &wgpu::BindGroup {
        &self.bind_group
    }

    /// Takes what the techniques lend in this frame, in the same order. Mostly that is the same: a
    /// map of another size is another texture, and another kind of light another shader.
    ///
    /// # Errors
    /// As [`Inline::join`]; [`Error::Inline`] for another number of lights.
    pub fn follow(&mut self, gpu: &Gpu, lights: &[Lent]) -> Result<Followed, Error> {
        if lights.len() != self.lights.len() {
            let what = format!("{} lights follow {}; join them anew", lights.len(), self.lights.len());
            return Err(Error::Inline(what));
        }
        let of_all = |same: fn(&Lent, &Lent) -> bool| self.lights.iter().zip(lights).all(|(old, new)| same(old, new));
        if !of_all(Lent::is_alike) {
            *self = Self::make(gpu, lights.to_vec(), self.group, &self.prefix, self.several)?;
            return Ok(Followed::Shader);
        }
        if of_all(Lent::binds_the_same) {
            return Ok(Followed::Same);
        }
        self.lights = lights.to_vec();
        self.bind_group = bind(gpu, &self.prefix, &self.layout, &self.lights);
        Ok(Followed::BindGroup)
    }
}

/// A name in WGSL that another one may follow after an underscore.
fn check_prefix(prefix: &str) -> Result<(), Error> {
    let is_name = prefix.starts_with(|c: char| c.is_ascii_alphabetic())
        && prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_name {
        return Ok(());
    }
    let what = format!("`{prefix}` is no prefix: it has to begin with a letter, and letters, digits and _ follow");
    Err(Error::Inline(what))
}

/// All bindings, one after the other.
fn bindings(lights: &[Lent]) -> impl Iterator<Item = (u32, &Binding)> {
    (0..).zip(lights.iter().flat_map(Lent::bindings))
}

fn layout(gpu: &Gpu, prefix: &str, lights: &[Lent]) -> wgpu::BindGroupLayout {
    let visibility = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
    let entries: Vec<_> = bindings(lights)
        .map(|(binding, bound)| wgpu::BindGroupLayoutEntry { binding, visibility, ty: bound.ty, count: None })
        .collect();
    gpu.bind_group_layout(prefix, &entries)
}

fn bind(gpu: &Gpu, prefix: &str, layout: &wgpu::BindGroupLayout, lights: &[Lent]) -> wgpu::BindGroup {
    let entries: Vec<_> = bindings(lights)
        .map(|(binding, bound)| wgpu::BindGroupEntry { binding, resource: bound.resource.as_binding() })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(prefix), layout, entries: &entries })
}

/// The WGSL of all lights, and what chooses among them.
fn text(lights: &[Lent], group: u32, prefix: &str, several: bool) -> Result<String, Error> {
    let mut text = String::new();
    let mut first = 0;
    for (i, light) in lights.iter().enumerate() {
        let prefix = if several { format!("{prefix}_{i}") } else { prefix.to_string() };
        text.push_str(&of_light(light, group, &prefix, first)?);
        first += light.bindings().len() as u32;
    }
    if several {
        FUNCTIONS.iter().for_each(|function| choice(&mut text, prefix, lights.len(), function));
    }
    Ok(text)
}

/// Name of a function, and its parameters with types and without.
struct Function(&'static str, &'static str, &'static str);

/// As `depth_maps/lookup/map_inline.wgsl` has them.
const FUNCTIONS: [Function; 3] = [
    Function("visibility", "position: vec3f, normal: vec3f", "position, normal"),
    Function("visibility_of_pane", "position: vec3f, normal: vec3f", "position, normal"),
    Function("visibility_in_air", "position: vec3f", "position"),
];

fn of_light(light: &Lent, group: u32, prefix: &str, first: u32) -> Result<String, Error> {
    let Some(lookup) = &light.lookup else {
        let lit =
            |Function(name, typed, _): &Function| format!("fn {prefix}_{name}({typed}) -> f32 {{ return 1.0; }}\n");
        return Ok(FUNCTIONS.iter().map(lit).collect());
    };
    let text = lookup.shader.inline_text().map_err(|error| Error::Inline(error.to_string()))?;
    let number_of = |at| lookup.bindings.iter().position(|bound| bound.at == at).map_or(u32::MAX, |i| first + i as u32);
    Ok(wgsl::rewritten(&text, &wgsl::Into { prefix, constants: &lookup.constants, group, binding: &number_of }))
}

/// The function that calls one light's.
fn choice(text: &mut String, prefix: &str, lights: usize, Function(name, typed, plain): &Function) {
    let _ = writeln!(text, "\nfn {prefix}_{name}(light: u32, {typed}) -> f32 {{\n    switch light {{");
    for i in 0..lights {
        let _ = writeln!(text, "        case {i}u: {{ return {prefix}_{i}_{name}({plain}); }}");
    }
    let _ = writeln!(text, "        default: {{ return 1.0; }}\n    }}\n}}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shader;
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    /// The look-ups of all techniques that lend theirs.
    fn lookups() -> impl Iterator<Item = &'static Shader> {
        let shaders = crate::techniques().iter().filter(|info| info.is_lent()).flat_map(|info| info.shaders);
        shaders.filter(|shader| {
            let needs = shader.needs().expect("the needs of a shader of the library");
            let has = |name| needs.iter().any(|module| module.name == name);
            has("map_visibility") && !has("map_picture")
        })
    }

    fn into_host(shader: &Shader, prefix: &str, group: u32) -> String {
        let text = shader.inline_text().expect("modules that stand for those of full-screen passes");
        let binding = |(of, number): (u32, u32)| (of - 1) * 3 + number;
        wgsl::rewritten(&text, &wgsl::Into { prefix, constants: &[("LAYERS", 4.0)], group, binding: &binding })
    }

    #[test]
    fn look_ups_are_valid_in_a_module_of_a_hosts_and_all_names_have_the_prefix() {
        let mut count = 0;
        for shader in lookups() {
            count += 1;
            // Names that look-ups have without a prefix.
            let host = "struct Eye { at: vec2f, }\nfn visibility(eye: Eye) -> f32 { return eye.at.x; }\noverride PERSPECTIVE: f32 = 1.0;";
            let text = format!("{host}\n{}\n{}", into_host(shader, "sun", 1), into_host(shader, "lamp", 2));
            let module = naga::front::wgsl::parse_str(&text)
                .unwrap_or_else(|e| panic!("{}: {}", shader.name, e.emit_to_string(&text)));
            Validator::new(ValidationFlags::all(), Capabilities::empty())
                .validate(&module)
                .unwrap_or_else(|e| panic!("{}: {}", shader.name, e.emit_to_string(&text)));
            assert!(module.entry_points.is_empty() && module.overrides.len() == 1, "{}", shader.name);
            let names = module.functions.iter().filter_map(|(_, f)| f.name.as_deref());
            let names = names.chain(module.global_variables.iter().filter_map(|(_, v)| v.name.as_deref()));
            let foreign: Vec<_> = names.filter(|n| !n.starts_with("sun_") && !n.starts_with("lamp_")).collect();
            assert_eq!(foreign, ["visibility"], "{}", shader.name);
            for Function(name, typed, _) in &FUNCTIONS {
                assert!(text.contains(&format!("fn sun_{name}({typed}) -> f32")), "{}: {name}", shader.name);
            }
        }
        assert!(count >= 12, "{count} look-ups");
    }

    #[test]
    fn a_prefix_is_a_name() {
        for right in ["sun", "Light_2", "a"] {
            assert_eq!(check_prefix(right), Ok(()));
        }
        for wrong in ["", "2sun", "_sun", "sun light", "sün", "sun-"] {
            assert!(matches!(check_prefix(wrong), Err(Error::Inline(_))), "{wrong}");
        }
    }
}
