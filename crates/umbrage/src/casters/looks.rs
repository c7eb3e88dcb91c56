//! What an instance looks like, for techniques that draw it with its colours.

use super::world::Casters;

impl Casters {
    /// The number of an instance's texture, for [`Casters::texture_group`]; `None` for a plain one.
    pub(crate) fn texture_of(&self, place: u32) -> Option<u32> {
        let material = self.placed.get(place as usize)?.material;
        self.appearance.looks.get(material as usize)?.texture
    }

    /// What draws of instances with this texture have as group 2.
    pub(crate) fn texture_group(&self, texture: Option<u32>) -> &wgpu::BindGroup {
        self.appearance.group(texture)
    }
}
