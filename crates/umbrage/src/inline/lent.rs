//! What a technique lends to shaders of a host's own: the look-up of its maps and all that it
//! reads.

use crate::error::Error;
use crate::shader::Shader;

/// The look-up of one light's maps, as [`crate::Technique::lend`] gives it: what an
/// [`Inline`](super::Inline) is made of.
#[derive(Clone, Debug)]
pub struct Lent {
    /// `None` before there was anything to look up: all is lit.
    pub(crate) lookup: Option<LentLookup>,
}

/// The look-up of a light that has maps.
#[derive(Clone, Debug)]
pub(crate) struct LentLookup {
    pub shader: Shader,
    /// The overrides of the shader.
    pub constants: Vec<(&'static str, f64)>,
    pub bindings: Vec<Binding>,
}

/// Something that the look-up reads.
#[derive(Clone, Debug, PartialEq)]
pub struct Binding {
    /// Bind group and number that the look-up's shader declares it with.
    pub(crate) at: (u32, u32),
    /// What kind of thing it is.
    pub ty: wgpu::BindingType,
    /// The thing itself.
    pub resource: Resource,
}

/// What is bound.
#[derive(Clone, Debug, PartialEq)]
pub enum Resource {
    /// All of a buffer.
    Buffer(wgpu::Buffer),
    /// A view of a texture.
    View(wgpu::TextureView),
    /// A sampler.
    Sampler(wgpu::Sampler),
}

impl Resource {
    pub(super) fn as_binding(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::View(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

impl Binding {
    /// What the shader declares as `@group(2) @binding(number)`, for stages of map techniques.
    pub fn of_stage(number: u32, ty: wgpu::BindingType, resource: Resource) -> Self {
        Self { at: (2, number), ty, resource }
    }
}

impl Lent {
    /// Of what is lit everywhere.
    pub(crate) const LIT: Self = Self { lookup: None };

    /// What a technique says whose answer is no look-up of maps.
    pub(crate) fn refuse<T>(technique: &str) -> Result<T, Error> {
        let what = "shaders of hosts, since its answer is no look-up of maps".into();
        Err(Error::Unsupported { technique: technique.into(), what })
    }

    /// Whether both need the same WGSL and bind the same kinds of things.
    pub(super) fn is_alike(&self, other: &Self) -> bool {
        match (&self.lookup, &other.lookup) {
            (None, None) => true,
            (Some(a), Some(b)) => {
                let kinds = |of: &LentLookup| of.bindings.iter().map(|b| (b.at, b.ty)).collect::<Vec<_>>();
                a.shader.is(&b.shader) && a.constants == b.constants && kinds(a) == kinds(b)
            }
            _ => false,
        }
    }

    /// Whether both also bind the same things.
    pub(super) fn binds_the_same(&self, other: &Self) -> bool {
        self.bindings() == other.bindings()
    }

    pub(super) fn bindings(&self) -> &[Binding] {
        self.lookup.as_ref().map_or(&[], |lookup| &lookup.bindings)
    }
}
