//! Animations: channels that move nodes.

use super::File;
use super::accessor::Accessors;
use super::nodes::Nodes;
use crate::Error;
use glam::Vec4;
use gltf::animation::{self, Interpolation as Between, Property as Moves};
use umbrage_core::rig::{Animation, Channel, Interpolation, Local, Property};

/// Larger values are slips.
const LARGEST: f32 = 1e15;

/// Reads an animation; one without a name is called by its number.
pub(super) fn read(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    nodes: &Nodes,
    animation: &gltf::Animation<'_>,
) -> Result<Animation, Error> {
    let name = animation.name().map_or_else(|| animation.index().to_string(), str::to_owned);
    let mut read = Animation { name, channels: Vec::new() };
    for channel in animation.channels() {
        let part = format!("animation {}, channel {}", animation.index(), channel.index());
        if let Some(channel) = read_channel(file, accessors, nodes, &channel, &part)? {
            read.channels.push(channel);
        }
    }
    Ok(read)
}

fn read_channel(
    file: &mut File<'_>,
    accessors: &Accessors<'_>,
    nodes: &Nodes,
    channel: &animation::Channel<'_>,
    part: &str,
) -> Result<Option<Channel>, Error> {
    let (target, sampler) = (channel.target(), channel.sampler());
    let node = nodes.place(target.node().index());
    let property = match target.property() {
        Moves::Translation => Property::Translation,
        Moves::Rotation => Property::Rotation,
        Moves::Scale => Property::Scale,
        Moves::MorphTargetWeights => {
            file.note("morph targets are not applied");
            return Ok(None);
        }
    };
    if matches!(nodes.rig[node].local, Local::Matrix(_)) {
        file.note(format!("node {} is placed by a matrix, which no animation moves", target.node().index()));
        return Ok(None);
    }
    let times_s: Vec<f32> = accessors.floats::<1>(&sampler.input())?.into_iter().map(|[t]| t).collect();
    let values: Vec<Vec4> = match property {
        Property::Rotation => accessors.floats::<4>(&sampler.output())?.into_iter().map(Vec4::from).collect(),
        _ => accessors.floats::<3>(&sampler.output())?.into_iter().map(|[x, y, z]| Vec4::new(x, y, z, 0.0)).collect(),
    };
    let (interpolation, values_per_key) = match sampler.interpolation() {
        Between::Step => (Interpolation::Step, 1),
        Between::Linear => (Interpolation::Linear, 1),
        Between::CubicSpline => (Interpolation::Cubic, 3),
    };
    let ascending = times_s.is_sorted_by(|a, b| a < b);
    if !ascending || times_s.iter().any(|t| !(0.0..=LARGEST).contains(t)) {
        return Err(file.error(part, "its times do not ascend from 0 or more"));
    }
    if values.len() != values_per_key * times_s.len() {
        let what =
            format!("has {} values for {} times; {values_per_key} for each are due", values.len(), times_s.len());
        return Err(file.error(part, what));
    }
    if values.iter().any(|v| !v.is_finite() || v.abs().max_element() > LARGEST) {
        return Err(file.error(part, "has a value that is not finite or too large"));
    }
    Ok(Some(Channel { node, property, interpolation, times_s, values }))
}
