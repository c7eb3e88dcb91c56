//! Which settings of which technique one kind of light is looked at under.

use crate::{
    choice::Choice,
    error::Error,
    sweep::{
        curve::{Curve, changed},
        rule,
        vary::Vary,
    },
};
use umbrage::Registry;

/// Settings, each once, and the curves through them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    pub settings: Vec<Setting>,
    pub curves: Vec<Curve>,
}

/// A choice to look at.
#[derive(Clone, Debug)]
pub(crate) struct Setting {
    pub choice: Choice,
    /// Nobody asked for it: it is left out where the adapter can't do it.
    pub by_rule: bool,
}

impl Plan {
    /// What `vary` says of the technique of each base; where it says nothing, the built-in rule.
    ///
    /// # Errors
    /// Names and values of `vary` that are not known, or not of a technique among the bases.
    pub(crate) fn new(bases: &[Choice], vary: &[Vary], soft: bool) -> Result<Self, Error> {
        let mut plan = Self::default();
        for base in bases {
            let own: Vec<&Vary> = vary.iter().filter(|v| v.technique == base.info.id).collect();
            if own.is_empty() {
                let (choices, curves) = rule::around(base, soft)?;
                let setting = |choice: Choice| Setting { by_rule: choice.label() != base.label(), choice };
                plan.add(choices.into_iter().map(setting), curves);
            }
            for vary in own {
                let (choices, curves) = product(base, vary)?;
                plan.add(choices.into_iter().map(|choice| Setting { choice, by_rule: false }), curves);
            }
        }
        Ok(plan)
    }

    fn add(&mut self, settings: impl Iterator<Item = Setting>, curves: Vec<Curve>) {
        for setting in settings {
            match self.settings.iter_mut().find(|own| own.choice.label() == setting.choice.label()) {
                Some(own) => own.by_rule &= setting.by_rule,
                None => self.settings.push(setting),
            }
        }
        self.curves.extend(curves);
    }
}

/// What `--vary` asks for, checked by name.
///
/// # Errors
/// A technique that is not known, with the nearest one, or not among the bases.
pub(crate) fn check_vary(registry: &Registry, bases: &[Choice], vary: &[Vary]) -> Result<(), Error> {
    for Vary { technique, .. } in vary {
        registry.find(technique)?;
        if !bases.iter().any(|base| base.info.id == technique) {
            return Err(Error::Name(format!(
                "--vary {technique}: `{technique}` is not among the techniques asked for"
            )));
        }
    }
    Ok(())
}

/// All combinations of the values, with curves along the last parameter.
fn product(base: &Choice, vary: &Vary) -> Result<(Vec<Choice>, Vec<Curve>), Error> {
    let choices: Vec<Choice> =
        vary.combinations().iter().map(|set| changed(base, set)).collect::<Result<_, Error>>()?;
    let Some((parameter, length)) = vary.along().filter(|(_, length)| *length > 1) else {
        return Ok((choices, Vec::new()));
    };
    let curve = |choices: &[Choice]| Curve {
        technique: base.info.id,
        parameter: parameter.into(),
        labels: choices.iter().map(Choice::label).collect(),
        values: choices.iter().map(|choice| choice.number(parameter)).collect::<Option<_>>().unwrap_or_default(),
    };
    let curves = choices.chunks(length).map(curve).collect();
    Ok((choices, curves))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(bases: &str, vary: &[&str]) -> Result<Plan, Error> {
        let bases = Choice::list(&Registry::default(), &bases.split(' ').map(String::from).collect::<Vec<_>>(), &[])?;
        let vary = vary.iter().map(|v| Vary::parse(v)).collect::<Result<Vec<_>, _>>()?;
        check_vary(&Registry::default(), &bases, &vary)?;
        Plan::new(&bases, &vary, false)
    }

    fn labels(plan: &Plan) -> Vec<String> {
        plan.settings.iter().map(|setting| setting.choice.label()).collect()
    }

    #[test]
    fn a_product_takes_the_place_of_the_rule_and_keeps_what_is_set() {
        let plan = plan("shadow-map:faces=back", &["shadow-map:bias=0|2,size=256|512"]).unwrap();
        let label = |bias, size| format!("shadow-map:bias={bias}:faces=back:size={size}");
        assert_eq!(labels(&plan), [label(0, 256), label(0, 512), label(2, 256), label(2, 512)]);
        assert_eq!(plan.curves.len(), 2);
        let Curve { parameter, labels: on_it, values, .. } = &plan.curves[1];
        assert_eq!((&**parameter, &**on_it, &**values), ("size", &labels(&plan)[2..], &[256.0, 512.0][..]));
    }

    #[test]
    fn words_have_no_values_and_points_of_the_light_do() {
        let plan = plan("shadow-map", &["shadow-map:faces=front|back", "shadow-map:light-samples=1|4"]).unwrap();
        let values: Vec<_> = plan.curves.into_iter().map(|curve| curve.values).collect();
        assert_eq!(values, [vec![], vec![1.0, 4.0]]);
    }

    #[test]
    fn settings_come_once() {
        let plan = plan("none shadow-map shadow-map", &["shadow-map:size=1024|64", "shadow-map:size=64|32"]).unwrap();
        assert_eq!(labels(&plan), ["none", "shadow-map", "shadow-map:size=64", "shadow-map:size=32"]);
    }

    #[test]
    fn what_nobody_asked_for_is_marked() {
        let bases = [Choice::new(&Registry::default(), "shadow-map", &[]).unwrap()];
        let by_rule = |vary: &[Vary]| -> Vec<bool> {
            Plan::new(&bases, vary, false).unwrap().settings.iter().map(|setting| setting.by_rule).collect()
        };
        let rule = by_rule(&[]);
        assert!(rule.len() > 2 && !rule[0] && rule[1..].iter().all(|by_rule| *by_rule), "{rule:?}");
        assert_eq!(by_rule(&[Vary::parse("shadow-map:size=64|32").unwrap()]), [false, false]);
    }

    #[test]
    fn mistakes_are_named() {
        let text = |bases, vary: &str| plan(bases, &[vary]).map(|p| labels(&p)).unwrap_err().to_string();
        assert!(text("none", "shadowmap:size=1").contains("did you mean `shadow-map`"));
        assert!(text("none", "shadow-map:size=1").contains("not among"));
        assert!(text("shadow-map", "shadow-map:siez=1").contains("did you mean `size`"));
        assert!(text("shadow-map", "shadow-map:size=1|0").contains("1 to"));
    }
}
