//! Errors as users see them: one line, exit code 2.

use crate::say;
use clap::error::ErrorKind;
use std::{io, io::Write, process::ExitCode};

/// What a failed command ends with.
const FAILED: u8 = 2;

/// A wrong command line, or a call for help.
pub fn usage(error: &clap::Error) -> ExitCode {
    let help = matches!(
        error.kind(),
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion | ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    );
    if help {
        // Nobody reads on: that is no failure of ours.
        let is_printed = error.print().is_ok_and(|()| io::stdout().flush().is_ok());
        let is_asked = is_printed && !error.use_stderr();
        return if is_asked { ExitCode::SUCCESS } else { ExitCode::from(FAILED) };
    }
    say::error(&one_line(&error.render().to_string()));
    ExitCode::from(FAILED)
}

/// A command that failed. A reader that has gone (`umbrage list | head -1`) is not a failure.
pub fn report(error: &anyhow::Error) -> ExitCode {
    let gone = |e: &(dyn std::error::Error + 'static)| {
        e.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == io::ErrorKind::BrokenPipe)
    };
    if error.chain().any(gone) {
        return ExitCode::SUCCESS;
    }
    let text = format!("{error:#}{}", remedy(error).unwrap_or_default());
    say::error(&format!("error: {}", text.split_whitespace().collect::<Vec<_>>().join(" ")));
    ExitCode::from(FAILED)
}

/// What the command can do about an error of the library, which does not know the command.
fn remedy(error: &anyhow::Error) -> Option<&'static str> {
    use umbrage::Error;
    let of_library = error.chain().find_map(|e| match e.downcast_ref::<umbrage_report::Error>() {
        Some(umbrage_report::Error::Gpu(error)) => Some(error),
        _ => e.downcast_ref::<Error>(),
    })?;
    match of_library {
        Error::NoAdapter { .. } => Some(", or run `cargo xtask setup`"),
        Error::NoDevice { .. } | Error::NotCounted => Some(" with --adapter"),
        Error::Unknown { nearest: None, .. } => Some("; `umbrage list` shows what there is"),
        _ => None,
    }
}

/// The message and its tips, without the usage that follows.
fn one_line(rendered: &str) -> String {
    let mut paragraphs = rendered.split("\n\n");
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let message = words(paragraphs.next().unwrap_or_default());
    let tips = paragraphs.filter_map(|p| p.trim().strip_prefix("tip: ").map(words));
    std::iter::once(message).chain(tips).chain(["see --help".into()]).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_usage_error_becomes_one_line_with_its_tip() {
        let text = "error: unexpected argument '--siez' found\n\n  tip: a similar argument exists: '--size'\n\nUsage: umbrage\n";
        assert_eq!(
            one_line(text),
            "error: unexpected argument '--siez' found; a similar argument exists: '--size'; see --help"
        );
    }
}
