//! What the command prints: names in files can't command a terminal, and streams that take nothing
//! are errors with a remedy, not panics.

use anyhow::{Context, Result};
use std::io::{self, Write};
use umbrage_report::printable;

/// Longer errors and notes repeat a damaged file.
const LONGEST: usize = 1_500;

/// Prints a note on the standard error. Where that takes nothing, nobody is there to be told.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr(), "note: {}", printable(text, LONGEST));
}

/// Prints an error, in the same way.
pub fn error(text: &str) {
    let _ = writeln!(io::stderr(), "{}", printable(text, LONGEST));
}

/// Prints lines of text on the standard output.
pub fn text(text: &str) -> Result<()> {
    let lines = text.split_inclusive('\n').flat_map(|line| match line.strip_suffix('\n') {
        // Bold numbers are the table's own.
        Some(line) => [plain(line), "\n".into()],
        None => [plain(line), String::new()],
    });
    write(&lines.collect::<String>())
}

/// Prints JSON on the standard output. What a terminal obeys is escaped there as JSON does it.
pub fn json(text: &str) -> Result<()> {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter == '\n' || printable(letter.encode_utf8(&mut [0; 4]), 1).len() == letter.len_utf8() {
            true => escaped.push(letter),
            false => escaped += &format!("\\u{:04x}", u32::from(letter)),
        }
    }
    write(&escaped)
}

fn write(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .context("the standard output can't be written to; send it elsewhere, or free the disk it goes to")
}

/// A line without control characters but those that make numbers bold.
fn plain(line: &str) -> String {
    let mut parts = Vec::new();
    for part in line.split(BOLD) {
        parts.push(part.split(RESET).map(|p| printable(p, usize::MAX)).collect::<Vec<_>>().join(RESET));
    }
    parts.join(BOLD)
}

/// How tables begin and end bold text.
const BOLD: &str = "\u{1b}[1m";
const RESET: &str = "\u{1b}[0m";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_what_is_bold_and_nothing_else() {
        assert_eq!(plain("a \u{1b}[1m0.5\u{1b}[0m \u{1b}[31mred\u{7}"), "a \u{1b}[1m0.5\u{1b}[0m \\u{1b}[31mred\\u{7}");
    }
}
