//! Shaders: a file of WGSL, the modules that its first line needs, and what the host has to agree
//! on with it.

mod library;
mod needs;

use crate::gpu::Gpu;
pub use library::PACK_NORMAL;
pub use needs::{Module, Unresolved};

/// One shader. Its source and its modules are plain WGSL whose first line may say which modules
/// they need:
///
/// ```wgsl
/// // needs: map_visibility, light_kernel
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// For messages and labels.
    pub name: &'static str,
    /// The file that nothing else needs; a line of needs alone where the shader is one of several
    /// modules' combinations.
    pub source: &'static str,
    /// The technique's own modules, in which needs are looked for before those of the library.
    pub modules: &'static [Module],
    /// Host structs that the shader reads; a test compares them with the WGSL of the same name.
    /// Those of the library's modules need not be named again.
    pub layouts: &'static [HostLayout],
    /// Constants that host and shader share; the same test compares them.
    pub constants: &'static [HostConstant],
}

impl Shader {
    /// A shader that needs modules of the library at most.
    pub const fn new(name: &'static str, source: &'static str) -> Self {
        Self { name, source, modules: &[], layouts: &[], constants: &[] }
    }

    /// With modules of its own.
    pub const fn with_modules(self, modules: &'static [Module]) -> Self {
        Self { modules, ..self }
    }

    /// With host structs of its own.
    pub const fn with_layouts(self, layouts: &'static [HostLayout]) -> Self {
        Self { layouts, ..self }
    }

    /// With constants that it shares with the host.
    pub const fn with_constants(self, constants: &'static [HostConstant]) -> Self {
        Self { constants, ..self }
    }

    /// The modules that it needs, each after those that it needs itself.
    ///
    /// # Errors
    /// [`Unresolved`] where there is no such module, or where modules need each other.
    pub fn needs(&self) -> Result<Vec<Module>, Unresolved> {
        needs::resolve(self.name, self.source, &[self.modules, library::LIBRARY])
    }

    /// The whole text.
    ///
    /// # Errors
    /// As [`Shader::needs`].
    pub fn text(&self) -> Result<String, Unresolved> {
        let needs = self.needs()?;
        let sources: Vec<_> = needs.iter().map(|module| module.source).chain([self.source]).collect();
        Ok(sources.join("\n"))
    }

    /// The text of a look-up of maps as a part of a host's shader: what stands for the full-screen
    /// pass comes before the modules of the same names.
    ///
    /// # Errors
    /// As [`Shader::needs`].
    pub(crate) fn inline_text(&self) -> Result<String, Unresolved> {
        let needs = needs::resolve(self.name, self.source, &[library::INLINE, self.modules, library::LIBRARY])?;
        let sources: Vec<_> = needs.iter().map(|module| module.source).chain([self.source]).collect();
        Ok(sources.join("\n"))
    }

    /// Whether both are the same text.
    pub(crate) fn is(&self, other: &Self) -> bool {
        (self.name, self.source) == (other.name, other.source)
    }

    /// Compiles it, once for each device. What can't be resolved is reported as any other error in
    /// a shader is.
    pub fn module(&self, gpu: &Gpu) -> wgpu::ShaderModule {
        gpu.shader_module(self.name, (self.source, self.modules), || {
            self.text().unwrap_or_else(|error| format!("const_assert false; // {error}"))
        })
    }
}

/// Name, members (name, byte offset, byte size) and size of a struct on the host's side.
#[derive(Clone, Copy, Debug)]
pub struct HostLayout {
    /// The struct's name, the same in WGSL.
    pub name: &'static str,
    /// Members in order.
    pub members: &'static [(&'static str, usize, usize)],
    /// Bytes in all.
    pub size: usize,
}

/// Name and value of a number that host and shader share. In WGSL it is a constant or the default
/// of an override, or the size in bytes of a struct of that name.
pub type HostConstant = (&'static str, f64);

/// What the host has to agree on with a module of the library, whatever shader needs it.
#[derive(Clone, Copy, Debug)]
pub struct Shared {
    /// The module's name.
    pub module: &'static str,
    /// Its structs.
    pub layouts: &'static [HostLayout],
    /// Its constants.
    pub constants: &'static [HostConstant],
}

/// Declares a struct that a shader reads, together with its [`HostLayout`], the constant `LAYOUT`.
/// The crate that uses this depends on `bytemuck` with its feature `derive`.
#[macro_export]
macro_rules! shader_struct {
    (
        $(#[$doc:meta])*
        $vis:vis struct $name:ident { $($(#[$field_doc:meta])* $field:ident: $type:ty,)* }
    ) => {
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        $vis struct $name { $($(#[$field_doc])* pub $field: $type,)* }

        impl $name {
            /// What a test compares with the WGSL struct of the same name.
            $vis const LAYOUT: $crate::HostLayout = $crate::HostLayout {
                name: stringify!($name),
                members: &[$((stringify!($field), std::mem::offset_of!($name, $field), size_of::<$type>()),)*],
                size: size_of::<$name>(),
            };
        }
    };
}
pub(crate) use shader_struct;
