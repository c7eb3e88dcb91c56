//! Animations: properties of nodes over time.

use super::Local;
use glam::{DQuat, DVec4, Vec4};

/// A named motion of some nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// What users type.
    pub name: String,
    /// Each moves one property of one node. Of two that move the same the last counts.
    pub channels: Vec<Channel>,
}

/// One property of one node over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index into [`super::Rig::nodes`].
    pub node: usize,
    /// What moves.
    pub property: Property,
    /// What is between two keys.
    pub interpolation: Interpolation,
    /// Seconds, ascending.
    pub times_s: Vec<f32>,
    /// One a key: x, y, z, or a quaternion x, y, z, w. For [`Interpolation::Cubic`] three a key:
    /// the tangent that arrives, the value, the tangent that leaves, tangents per second.
    pub values: Vec<Vec4>,
}

/// What an animation can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// [`super::Parts::translation`].
    Translation,
    /// [`super::Parts::rotation`].
    Rotation,
    /// [`super::Parts::scale`].
    Scale,
}

/// What is between two keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the earlier one.
    Step,
    /// A straight line; for rotations the shortest turn at even speed.
    Linear,
    /// A cubic Hermite spline.
    Cubic,
}

impl Animation {
    /// When the last key is, seconds; 0 without any.
    pub fn duration_s(&self) -> f64 {
        self.channels.iter().filter_map(|c| c.times_s.last()).fold(0.0, |d, t| d.max(f64::from(*t)))
    }

    /// A time brought into the animation: from 0 to its end it stays as it is; beyond both ends the
    /// animation starts over again and again. What is no number is 0.
    pub fn within(&self, time_s: f64) -> f64 {
        let duration = self.duration_s();
        if (0.0..=duration).contains(&time_s) {
            return time_s;
        }
        let wrapped = time_s.rem_euclid(duration);
        if wrapped.is_finite() { wrapped } else { 0.0 }
    }

    /// Moves nodes to where they are at `time_s`. A channel holds its first value before its first
    /// key and its last one after its last. Nodes placed by a matrix stay.
    pub(super) fn pose(&self, time_s: f64, local: &mut [Local]) {
        let time_s = self.within(time_s);
        for channel in &self.channels {
            let Some(Local::Parts(parts)) = local.get_mut(channel.node) else { continue };
            let Some(value) = channel.value(time_s) else { continue };
            match channel.property {
                Property::Translation => parts.translation = value.truncate(),
                Property::Scale => parts.scale = value.truncate(),
                Property::Rotation => parts.rotation = quaternion(value),
            }
        }
    }
}

impl Channel {
    /// Its value; `None` without keys.
    fn value(&self, time_s: f64) -> Option<DVec4> {
        let after = self.times_s.partition_point(|t| f64::from(*t) <= time_s);
        let Some(before) = after.checked_sub(1) else { return self.key(0) };
        let (Some(&start), Some(&end)) = (self.times_s.get(before), self.times_s.get(after)) else {
            return self.key(before);
        };
        let (start, step) = (f64::from(start), f64::from(end) - f64::from(start));
        let t = (time_s - start) / step;
        let (a, b) = (self.key(before)?, self.key(after)?);
        Some(match (self.interpolation, self.property) {
            (Interpolation::Step, _) => a,
            (Interpolation::Linear, Property::Rotation) => DVec4::from(quaternion(a).slerp(quaternion(b), t)),
            (Interpolation::Linear, _) => a.lerp(b, t),
            (Interpolation::Cubic, _) => {
                let (leaving, arriving) = (self.stored(3 * before + 2)?, self.stored(3 * after)?);
                hermite(t, a, leaving * step, b, arriving * step)
            }
        })
    }

    /// The value at a key.
    fn key(&self, key: usize) -> Option<DVec4> {
        self.stored(if self.interpolation == Interpolation::Cubic { 3 * key + 1 } else { key })
    }

    fn stored(&self, index: usize) -> Option<DVec4> {
        self.values.get(index).map(|v| v.as_dvec4())
    }
}

/// From `a` with the slope `da` at 0 to `b` with the slope `db` at 1 (glTF, appendix C.5).
fn hermite(t: f64, a: DVec4, da: DVec4, b: DVec4, db: DVec4) -> DVec4 {
    let (t2, t3) = (t * t, t * t * t);
    a * (2.0 * t3 - 3.0 * t2 + 1.0) + da * (t3 - 2.0 * t2 + t) + b * (3.0 * t2 - 2.0 * t3) + db * (t3 - t2)
}

/// A rotation; none where there is no direction.
fn quaternion(v: DVec4) -> DQuat {
    v.try_normalize().map_or(DQuat::IDENTITY, DQuat::from_vec4)
}
