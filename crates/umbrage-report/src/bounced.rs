//! Techniques by how often light is reflected in what they show: each has the truth of as many
//! bounces.

use crate::choice::Choice;
use std::collections::BTreeMap;
use umbrage_core::{LightKind, transfer::Kind};

/// Those that share a truth about a light of this kind, fewest bounces first. What can't do the
/// environment is told beside those that can.
pub(crate) fn groups(kind: LightKind, choices: &[Choice]) -> Vec<(u32, Vec<&Choice>)> {
    if kind != LightKind::Environment {
        return vec![(0, choices.iter().collect())];
    }
    let (able, others): (Vec<&Choice>, Vec<&Choice>) = choices.iter().partition(|c| c.supports(kind).is_ok());
    let mut groups: BTreeMap<u32, Vec<&Choice>> = BTreeMap::new();
    able.into_iter().for_each(|choice| groups.entry(bounces(choice)).or_default().push(choice));
    groups.entry(groups.keys().next().copied().unwrap_or_default()).or_default().extend(others);
    groups.into_iter().collect()
}

/// How often light is reflected on its way before the surface that is seen.
pub(crate) fn bounces(choice: &Choice) -> u32 {
    match choice.settings.wants().map(|wanted| wanted.kind) {
        Some(Kind::Interreflected { bounces }) => bounces,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage::Registry;

    #[test]
    fn choices_of_as_many_bounces_share_a_truth() {
        let names = ["prt:transfer=interreflected:bounces=3", "pcf", "prt", "prt:order=2"].map(String::from);
        let choices = Choice::list(&Registry::default(), &names, &[]).unwrap();
        let labels = |kind| {
            let groups = groups(kind, &choices).into_iter();
            groups
                .map(|(bounces, of)| (bounces, of.iter().map(|c| c.label()).collect()))
                .collect::<Vec<(u32, Vec<String>)>>()
        };
        let [reflected, pcf, plain, low]: [String; 4] = std::array::from_fn(|i| choices[i].label());
        assert_eq!(
            labels(LightKind::Environment),
            [(0, vec![plain.clone(), low.clone(), pcf.clone()]), (3, vec![reflected.clone()])]
        );
        assert_eq!(labels(LightKind::Point), [(0, vec![reflected, pcf, plain, low])]);
    }
}
