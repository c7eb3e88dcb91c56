//! Progress bars on the terminal.

use crate::say;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Mutex;
use umbrage_report::{Progress, printable};

/// One bar on the standard error, where that is a terminal; nothing elsewhere.
#[derive(Default)]
pub struct Bars {
    bar: Mutex<Option<ProgressBar>>,
}

impl Bars {
    fn with(&self, f: impl FnOnce(&mut Option<ProgressBar>)) {
        // A bar that another thread left broken is not worth an error.
        if let Ok(mut bar) = self.bar.lock() {
            f(&mut bar);
        }
    }
}

impl Progress for Bars {
    fn begin(&self, what: &str, steps: u64) {
        let style = ProgressStyle::with_template("{msg:48!} {bar:32} {percent:>3} % {elapsed:>4}");
        let bar = ProgressBar::new(steps).with_message(printable(what, 200).into_owned());
        let bar = match style {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        bar.enable_steady_tick(std::time::Duration::from_millis(200));
        self.with(|slot| *slot = Some(bar));
    }

    fn at(&self, done: u64) {
        self.with(|slot| slot.iter().for_each(|bar| bar.set_position(done)));
    }

    fn of(&self, done: u64, steps: u64) {
        self.with(|slot| {
            slot.iter().for_each(|bar| {
                bar.set_length(steps);
                bar.set_position(done);
            });
        });
    }

    fn note(&self, text: &str) {
        self.with(|slot| match slot {
            Some(bar) => bar.suspend(|| say::note(text)),
            None => say::note(text),
        });
    }

    fn end(&self) {
        self.with(|slot| slot.take().iter().for_each(ProgressBar::finish_and_clear));
    }
}
