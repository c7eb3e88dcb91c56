//! The laboratory on its page: it starts, is clicked on, walks through all techniques, and each is
//! as near to the truth as in a window of the same size on this machine.

use super::{pictures, said_by};
use crate::{shell, web};
use anyhow::{Context, Result, ensure};
use std::path::Path;
use std::thread;

/// The walk, which is in the laboratory's own code.
const HERE: [&str; 4] = ["--package", "umbrage-viewer", "--example", "walk"];

/// Walks here and in the browser, and fails where the browser's pictures are worse, where a click
/// is not answered, or where the console has an error.
pub fn run(browser: &str, folder: &Path) -> Result<()> {
    web::build()?;
    let mut here = shell::cargo();
    here.args(["run", "--quiet"]).args(HERE).env("NODEVICE_SELECT", "1");
    let here = Walk::read(shell::output(here)?.lines().map(String::from).collect())?;
    let server = web::Server::open(Path::new(web::OUT), 0)?;
    let page = format!("http://localhost:{}/index.html?walk", server.port());
    thread::spawn(|| server.run());
    let there = Walk::read(said_by(browser, folder, &page)?)?;
    ensure!(there.is_clicked, "the laboratory did not answer a click");
    ensure!(here.size == there.size, "pictures have {} pixels there and {} here", there.size, here.size);
    println!("the laboratory, {} pixels", here.size);
    pictures::compare(&here.scores, &there.scores)
}

/// What the walk says.
struct Walk {
    size: String,
    is_clicked: bool,
    scores: pictures::Scores,
}

impl Walk {
    fn read(mut lines: Vec<String>) -> Result<Self> {
        let is_clicked = lines.iter().any(|line| line == "click");
        let size = lines.iter().find_map(|line| line.strip_prefix("size ")).context("no size was said")?.to_string();
        lines.retain(|line| line != "click" && !line.starts_with("size "));
        Ok(Self { size, is_clicked, scores: pictures::scores(lines.iter().map(String::as_str))? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_has_a_size_and_scores_and_no_error() {
        let read = |lines: &[&str]| Walk::read(lines.iter().map(|line| (*line).to_string()).collect());
        let walk = read(&["click", "picture pcf 0.00100 99.900", "size 160 120", "end"]).unwrap();
        assert_eq!((walk.size.as_str(), walk.is_clicked, walk.scores.len()), ("160 120", true, 1));
        assert!(read(&["picture pcf 0.00100 99.900", "end"]).is_err(), "no size");
        assert!(read(&["error panicked", "size 160 120", "end"]).is_err(), "an error");
    }
}
