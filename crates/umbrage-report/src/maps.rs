//! What maps a technique has, as far as its settings say.

use crate::choice::Choice;

/// What maps a technique has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Maps {
    /// Parts of what the camera sees with a map each.
    pub splits: u32,
    /// Texels across.
    pub size: u32,
}

impl Maps {
    /// Where a technique has no parameters for them.
    pub const USUAL: Self = Self { splits: 1, size: 1024 };

    /// Those of a choice, the usual ones where it does not say.
    pub fn of(choice: &Choice) -> Self {
        let value = |name: &str| {
            let (_, value) = choice.settings.iter().find(|(n, _)| *n == name)?;
            value.to_string().parse().ok()
        };
        let Self { splits, size } = Self::USUAL;
        Self { splits: value("splits").unwrap_or(splits), size: value("size").unwrap_or(size) }
    }

    /// As a setting has them.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn settings(self) -> std::collections::BTreeMap<String, String> {
        let splits = (self.splits > 1).then(|| ("splits".to_string(), self.splits.to_string()));
        splits.into_iter().chain([("size".into(), self.size.to_string())]).collect()
    }
}
