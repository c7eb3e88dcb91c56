//! How many fragments passes draw, and what these touch in their attachments.

use super::{Owner, queries::Queries};
use std::ops::{Deref, DerefMut};

/// What a pass, or all passes of one name in a frame, drew.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PassFragments {
    /// Who recorded it.
    pub owner: Owner,
    /// The pass.
    pub pass: String,
    /// Fragments that reached the target: those that a test of depth or stencil rejects, and that
    /// the shader discards, are not among them.
    pub fragments: u64,
    /// Bytes that all of them read and wrote in the attachments: depth and stencil once to test and
    /// once to write, colour once; that blending reads it is the technique's to say, see
    /// [`Inside::reads`](crate::Inside::reads).
    pub attachment_bytes: u64,
}

/// A render pass whose fragments may be counted: a [`wgpu::RenderPass`] in all other respects.
pub struct Pass<'a> {
    pass: wgpu::RenderPass<'a>,
    counts: bool,
}

impl<'a> Pass<'a> {
    /// Counts into this query, if there is one.
    pub(super) fn new(mut pass: wgpu::RenderPass<'a>, query: Option<u32>) -> Self {
        if let Some(query) = query {
            pass.begin_occlusion_query(query);
        }
        Self { pass, counts: query.is_some() }
    }
}

impl<'a> Deref for Pass<'a> {
    type Target = wgpu::RenderPass<'a>;

    fn deref(&self) -> &Self::Target {
        &self.pass
    }
}

impl DerefMut for Pass<'_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.pass
    }
}

impl Drop for Pass<'_> {
    fn drop(&mut self) {
        if self.counts {
            self.pass.end_occlusion_query();
        }
    }
}

/// A pass that was recorded, and bytes that one of its fragments touches in the attachments.
pub(super) struct Counted {
    pub owner: Owner,
    pub pass: String,
    pub attachment_bytes: u64,
}

/// One occlusion query for each pass.
pub(super) struct Counter {
    pub queries: Queries<Counted>,
    pub latest: Vec<PassFragments>,
}

impl Counter {
    #[cfg(not(target_family = "wasm"))]
    pub fn new(gpu: &crate::Gpu) -> Self {
        Self { queries: Queries::new(gpu, "fragments", wgpu::QueryType::Occlusion, 1), latest: Vec::new() }
    }

    pub fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.collect();
        if !self.queries.resolve(encoder) {
            self.latest.clear();
        }
    }

    /// Takes what has arrived.
    pub fn collect(&mut self) {
        if let Some((passes, counts)) = self.queries.newest() {
            self.latest = sum_by_name(passes, &counts);
        }
    }
}

fn sum_by_name(passes: Vec<Counted>, counts: &[u64]) -> Vec<PassFragments> {
    let mut sums: Vec<PassFragments> = Vec::new();
    for (Counted { owner, pass, attachment_bytes }, &fragments) in passes.into_iter().zip(counts) {
        let attachment_bytes = fragments * attachment_bytes;
        match sums.iter_mut().find(|sum| sum.owner == owner && sum.pass == pass) {
            Some(sum) => {
                sum.fragments += fragments;
                sum.attachment_bytes += attachment_bytes;
            }
            None => sums.push(PassFragments { owner, pass, fragments, attachment_bytes }),
        }
    }
    sums
}

/// Bytes that a fragment touches in the attachments of a pass.
pub(super) fn touched(
    color: &[Option<wgpu::RenderPassColorAttachment<'_>>],
    depth_stencil: Option<&wgpu::RenderPassDepthStencilAttachment<'_>>,
) -> u64 {
    let size = |format: wgpu::TextureFormat| format.block_copy_size(None).map_or(0, u64::from);
    let colors = color.iter().flatten().map(|c| size(c.view.texture().format())).sum::<u64>();
    let Some(attachment) = depth_stencil else { return colors };
    let format = attachment.view.texture().format();
    // To test, and to write where it is not read-only.
    let times = |is_written: bool| if is_written { 2 } else { 1 };
    // Depth of 24 bits is stored in four bytes.
    let depth = match format {
        _ if !format.has_depth_aspect() => 0,
        wgpu::TextureFormat::Depth16Unorm => 2 * times(attachment.depth_ops.is_some()),
        _ => 4 * times(attachment.depth_ops.is_some()),
    };
    let stencil = if format.has_stencil_aspect() && attachment.stencil_ops.is_some() { 2 } else { 0 };
    colors + depth + stencil
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fragments_of_one_name_add_up() {
        let pass =
            |light, attachment_bytes| Counted { owner: Owner::Light(light), pass: "map".into(), attachment_bytes };
        let sums = sum_by_name(vec![pass(0, 8), pass(1, 8), pass(0, 4)], &[10, 5, 3]);
        let expected = [(Owner::Light(0), 13, 92), (Owner::Light(1), 5, 40)];
        assert!(sums.iter().map(|s| (s.owner, s.fragments, s.attachment_bytes)).eq(expected), "{sums:?}");
    }
}
