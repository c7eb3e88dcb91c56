//! The numbers of all shaders as one table.

use crate::driver::ShaderCost;
use crate::techniques::Set;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A technique's shader, by file and entry point, in a stage.
type Key = (String, String, &'static str);

/// The shaders of all techniques: over the kinds of lights the dearest variant of each.
#[derive(Default)]
pub struct Table {
    at_defaults: BTreeMap<Key, ShaderCost>,
    /// Over all choices the dearest variant, and the setting that takes it.
    dearest: BTreeMap<Key, (ShaderCost, String)>,
}

impl Table {
    /// Adds the shaders of a pipeline.
    pub fn add(&mut self, technique: &str, set: &Set, shaders: Vec<ShaderCost>) {
        for shader in shaders {
            let key = (technique.to_string(), shader.name.clone(), shader.stage);
            if set.is_default() {
                keep_dearer(&mut self.at_defaults, key.clone(), shader.clone(), |cost| cost);
            }
            let setting = set.name.strip_prefix(technique).unwrap_or_default().trim_start_matches(':');
            keep_dearer(&mut self.dearest, key, (shader, setting.to_string()), |(cost, _)| cost);
        }
    }

    /// A line for each shader at the defaults, and one for the setting that makes it dearest.
    pub fn csv(&self) -> String {
        let mut text = String::from(
            "technique,setting,shader,stage,vgprs,sgprs,spilled,scratch_bytes,lds_bytes,code_bytes,instructions,\
             latency,inverse_throughput,unchecked,subgroups_per_simd\n",
        );
        // What technique `none` takes, as for casters that move, is nobody else's.
        let is_own = |(technique, shader, stage): &Key| {
            technique == "none" || !self.dearest.contains_key(&("none".to_string(), shader.clone(), *stage))
        };
        for (key, (dearest, setting)) in self.dearest.iter().filter(|(key, _)| is_own(key)) {
            let at_defaults = self.at_defaults.get(key);
            if let Some(cost) = at_defaults {
                line(&mut text, key, "", cost);
            }
            if at_defaults != Some(dearest) {
                line(&mut text, key, setting, dearest);
            }
        }
        text
    }
}

fn keep_dearer<V>(costs: &mut BTreeMap<Key, V>, key: Key, new: V, cost: impl Fn(&V) -> &ShaderCost) {
    let is_dearer = |old: &V| cost(&new).rank() > cost(old).rank();
    if costs.get(&key).is_none_or(is_dearer) {
        costs.insert(key, new);
    }
}

fn line(text: &mut String, (technique, shader, stage): &Key, setting: &str, c: &ShaderCost) {
    // Writing to a text can't fail.
    let _ = writeln!(
        text,
        "{technique},{setting},{shader:?},{stage},{},{},{},{},{},{},{},{},{},{},{}",
        c.vgprs,
        c.sgprs,
        c.spilled,
        c.scratch,
        c.lds,
        c.code,
        c.instructions,
        c.latency,
        c.inverse_throughput,
        c.unchecked,
        c.subgroups,
    );
}
