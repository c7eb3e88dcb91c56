//! The lines of OBJ and MTL files: a keyword, then words.

use crate::{Error, error::Place};
use std::borrow::Cow;
use std::path::Path;
use std::str::FromStr;

/// One line that says something.
pub(crate) struct Line<'a> {
    pub file: &'a Path,
    /// From 1; of a line that continues over several, the first.
    pub number: usize,
    pub keyword: &'a str,
    /// What follows the keyword, without spaces at its ends.
    pub rest: &'a str,
}

/// Calls `each` with every line that is neither empty nor a comment. A line may continue after a
/// `\` at its end.
pub(crate) fn for_each(
    file: &Path,
    text: &str,
    mut each: impl FnMut(Line<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut lines = text.lines().enumerate();
    while let Some((index, first)) = lines.next() {
        let mut whole = Cow::Borrowed(first);
        while let Some(start) = whole.trim_end().strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, next)| next);
            whole = Cow::Owned(format!("{start} {next}"));
        }
        // A `#` further on may belong to a name: `usemtl Material #25`.
        let content = whole.trim();
        let (keyword, rest) = content.split_once(char::is_whitespace).unwrap_or((content, ""));
        if !keyword.is_empty() && !keyword.starts_with('#') {
            each(Line { file, number: index + 1, keyword, rest: rest.trim() })?;
        }
    }
    Ok(())
}

impl Line<'_> {
    /// An error at this line.
    pub fn error(&self, what: impl std::fmt::Display) -> Error {
        Error::new(self.file, what).at(Place::Line(self.number, None))
    }

    /// The first `N` words as numbers; there may be more words.
    pub fn numbers<const N: usize>(&self) -> Result<[f32; N], Error> {
        let mut words = self.rest.split_ascii_whitespace();
        let mut numbers = [0.0; N];
        for (i, number) in numbers.iter_mut().enumerate() {
            let word = words.next().ok_or_else(|| {
                self.error(format!("`{}` needs {N} numbers and has {i}", self.keyword))
                    .remedy("the file may be cut off or damaged: export it again")
            })?;
            *number = f32::from_str(word).map_err(|_| {
                self.error(format!("`{word}` is not a number")).remedy("mend it, or export the file again")
            })?;
            if !number.is_finite() {
                return Err(self
                    .error(format!("`{} {}` is not finite", self.keyword, self.rest))
                    .remedy("every number must be finite: mend it, or export the file again"));
            }
        }
        Ok(numbers)
    }
}
