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
/// `\` at its end; a comment does not.
pub(crate) fn for_each(
    file: &Path,
    text: &str,
    mut each: impl FnMut(Line<'_>) -> Result<(), Error>,
) -> Result<(), Error> {
    let mut lines = text.split('\n').enumerate();
    while let Some((index, first)) = lines.next() {
        let mut whole = Cow::Borrowed(first);
        let mut continued = continued(first);
        while let Some(start) = continued.take() {
            let joined = whole.to_mut();
            joined.truncate(start);
            joined.push(' ');
            if let Some((_, next)) = lines.next() {
                let before = joined.len();
                joined.push_str(next);
                continued = self::continued(next).map(|end| before + end);
            }
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

/// Where the `\` at the end of a line stands, after which it continues.
fn continued(line: &str) -> Option<usize> {
    let line = line.trim_end();
    let start = line.strip_suffix('\\')?;
    let first = start.trim_start();
    let is_comment = first.starts_with('#') || (has_numbers(first) && first.contains(" #"));
    (!is_comment).then_some(start.len())
}

/// True for lines that hold no names: there a `#` always starts a comment.
fn has_numbers(line: &str) -> bool {
    matches!(
        line.split_whitespace().next(),
        Some("v" | "vt" | "vn" | "f" | "fo" | "Kd" | "Ks" | "Ke" | "Ns" | "d" | "Tr")
    )
}

impl Line<'_> {
    /// An error at this line.
    pub fn error(&self, what: impl std::fmt::Display) -> Error {
        Error::new(self.file, what).at(Place::Line(self.number, None)).remedy("mend it, or export the file again")
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
            *number = f32::from_str(word).map_err(|_| self.error(format!("`{word}` is not a number")))?;
            if !number.is_finite() {
                return Err(self
                    .error(format!("`{} {}` is not finite", self.keyword, self.rest))
                    .remedy("every number must be finite: mend it, or export the file again"));
            }
        }
        Ok(numbers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<(usize, String, String)> {
        let mut lines = Vec::new();
        let each = |line: Line<'_>| {
            lines.push((line.number, line.keyword.to_owned(), line.rest.to_owned()));
            Ok(())
        };
        for_each(Path::new("a"), text, each).unwrap();
        lines
    }

    #[test]
    fn lines_continue_but_comments_do_not() {
        let text = "# C:\\\nv 1 \\\n 2 \\\n3\n  # a \\\nv 4 5 6 # b \\\nusemtl a #2\nf 1\\\n2 3\\";
        let want = [(2, "v", "1   2  3"), (6, "v", "4 5 6 # b \\"), (7, "usemtl", "a #2"), (8, "f", "1 2 3")];
        assert_eq!(read(text), want.map(|(n, k, r)| (n, k.to_owned(), r.to_owned())));
    }

    #[test]
    fn many_continued_lines_take_no_time() {
        let started = std::time::Instant::now();
        assert_eq!(read(&format!("o {}x", "\\\n".repeat(300_000))).len(), 1);
        assert!(started.elapsed().as_secs() < 5);
    }
}
