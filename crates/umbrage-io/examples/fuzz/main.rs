//! Reads damaged files for so many minutes: `cargo xtask fuzz MINUTES` builds and starts this.
//!
//! Each input is a small scene in which one file is changed along its structure. Reading it must
//! come back within ten seconds, with a scene that is finite or with one line that names a file and
//! the remedy. One input in many goes through the `umbrage` command, too. The folder of an input
//! that fails is kept.

mod binary;
mod check;
mod corpus;
mod dice;
mod json;
mod text;
mod watch;

use check::Check;
use corpus::Case;
use dice::Dice;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use watch::Watch;

/// One input in so many goes through the command.
const THROUGH_COMMAND: u64 = 500;

/// Bytes of a file that is read.
const LARGEST: usize = 1 << 20;

/// What the command line says: for how long, where failing inputs are kept, where the command is,
/// and the number of the first input.
struct Arguments {
    time: Duration,
    kept: PathBuf,
    command: PathBuf,
    first: u64,
}

fn main() {
    let Some(arguments) = read_arguments() else {
        eprintln!("error: use `cargo xtask fuzz MINUTES`");
        std::process::exit(2);
    };
    // A panic is what this looks for: it is told with the input, not here.
    std::panic::set_hook(Box::new(|_| {}));
    let folder = arguments.kept.join("now");
    std::fs::create_dir_all(&folder).expect("a folder for inputs");
    let started = Instant::now();
    let mut watch = Watch::start(&folder, &arguments.kept);
    let check = Check::new(&folder, &arguments.command);
    let corpus = corpus::all();
    let mut number = arguments.first;
    let mut findings = 0;
    while started.elapsed() < arguments.time {
        let case = change(&corpus, number);
        case.write(&folder);
        watch.begin(number);
        let mut found = check.read(&case);
        if found.is_ok() && number.is_multiple_of(THROUGH_COMMAND) {
            found = check.command(&case);
        }
        watch.end();
        if let Err(what) = found {
            findings += 1;
            let kept = watch::keep(&folder, &arguments.kept, number, &what);
            println!("found: {what}: {}", kept.display());
        }
        number += 1;
    }
    let (inputs, seconds) = (number - arguments.first, started.elapsed().as_secs_f64());
    println!("done: {inputs} inputs, {} of them opened, {findings} findings, {seconds:.0} s", check.opened());
}

fn read_arguments() -> Option<Arguments> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [seconds, kept, command, first] = words.as_slice() else { return None };
    Some(Arguments {
        time: Duration::from_secs_f64(seconds.parse().ok()?),
        kept: Path::new(kept).to_path_buf(),
        command: Path::new(command).to_path_buf(),
        first: first.parse().ok()?,
    })
}

/// The input of this number: one of the corpus, changed in one to four places.
fn change(corpus: &[Case], number: u64) -> Case {
    let mut dice = Dice::new(number);
    let mut case = corpus[dice.below(corpus.len())].clone();
    for _ in 0..1 + dice.below(4) {
        let other = &corpus[dice.below(corpus.len())];
        let other = &other.files[dice.below(other.files.len())].bytes;
        let index = dice.below(case.files.len());
        let file = &mut case.files[index];
        let changed = match file.name.rsplit('.').next().unwrap_or_default() {
            _ if dice.is_one_in(40) => binary::splice(&mut dice, &file.bytes, other),
            "obj" | "mtl" | "toml" => text::change(&mut dice, &file.bytes),
            "gltf" => json::change(&mut dice, &file.bytes),
            "glb" => json::change_glb(&mut dice, &file.bytes),
            "png" => binary::change_png(&mut dice, &file.bytes),
            _ => binary::change(&mut dice, &file.bytes),
        };
        // Files that are large cost what they cost; those looked for are small.
        if changed.len() <= LARGEST {
            file.bytes = changed;
        }
    }
    case
}
