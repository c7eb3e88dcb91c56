//! What times are set against.

use crate::choice::Choice;
use std::collections::BTreeMap;

/// What the others are set against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Baseline {
    /// One full-screen pass that reads depth and writes visibility.
    Floor,
    /// A depth-only pass over the casters into each of the maps, and one full-screen one-tap pass.
    BareMinimum(Maps),
}

/// What maps a technique has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Maps {
    /// Parts of what the camera sees with a map each.
    pub splits: u32,
    /// Texels across.
    pub size: u32,
}

impl Maps {
    /// Where a technique has no parameters for them.
    pub(crate) const USUAL: Self = Self { splits: 1, size: 1024 };

    pub(crate) fn of(choice: &Choice) -> Self {
        let value = |name: &str| {
            let (_, value) = choice.settings.iter().find(|(n, _)| *n == name)?;
            value.to_string().parse().ok()
        };
        let Self { splits, size } = Self::USUAL;
        Self { splits: value("splits").unwrap_or(splits), size: value("size").unwrap_or(size) }
    }

    pub(crate) fn settings(self) -> BTreeMap<String, String> {
        let splits = (self.splits > 1).then(|| ("splits".to_string(), self.splits.to_string()));
        splits.into_iter().chain([("size".into(), self.size.to_string())]).collect()
    }
}
