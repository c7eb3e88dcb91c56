//! A second thread that ends the program where an input takes too long or too much memory. Started
//! again it takes the next input.

use std::fs::{self, File};
use std::io::{Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// Longest time for an input.
const LONGEST: Duration = Duration::from_secs(10);

/// Most memory that reading may hold.
const MOST_BYTES: u64 = 1 << 30;

pub struct Watch {
    began: Instant,
    now: Arc<Now>,
    /// Holds the number of the input for whoever finds this program ended.
    number: File,
}

#[derive(Default)]
struct Now {
    number: AtomicU64,
    /// When the input began, milliseconds; 0 between inputs.
    since_ms: AtomicU64,
}

impl Watch {
    pub fn start(folder: &Path, kept: &Path) -> Self {
        let number = File::create(kept.join("number.txt")).expect("a file for the number of the input");
        let watch = Self { began: Instant::now(), now: Arc::default(), number };
        let (began, now) = (watch.began, watch.now.clone());
        let (folder, kept) = (folder.to_path_buf(), kept.to_path_buf());
        std::thread::spawn(move || {
            loop {
                std::thread::sleep(Duration::from_millis(20));
                let since_ms = now.since_ms.load(Relaxed);
                // Between inputs nothing is read.
                if since_ms == 0 {
                    continue;
                }
                let is_late = began.elapsed().saturating_sub(Duration::from_millis(since_ms)) > LONGEST;
                let what = match (is_late, memory_bytes()) {
                    (true, _) => format!("takes over {} s", LONGEST.as_secs()),
                    (_, Some(bytes)) if bytes > MOST_BYTES => format!("takes {} MiB", bytes >> 20),
                    _ => continue,
                };
                let number = now.number.load(Relaxed);
                let kept = keep(&folder, &kept, number, &what);
                println!("found: {what}: {}", kept.display());
                println!("stopped at {number}");
                std::process::exit(3);
            }
        });
        watch
    }

    pub fn begin(&mut self, number: u64) {
        // In place: some systems wait for the disk where a file is emptied and written again.
        let written = self.number.rewind().and_then(|()| write!(self.number, "{number:020}"));
        written.expect("the number of the input");
        self.now.number.store(number, Relaxed);
        self.now.since_ms.store(1 + self.began.elapsed().as_millis() as u64, Relaxed);
    }

    pub fn end(&self) {
        self.now.since_ms.store(0, Relaxed);
    }
}

/// Memory of this process, where the system tells.
fn memory_bytes() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/statm").ok()?;
    let pages: u64 = text.split_whitespace().nth(1)?.parse().ok()?;
    Some(pages * 4096)
}

/// Copies an input to where it stays, with what was found.
pub fn keep(folder: &Path, kept: &Path, number: u64, what: &str) -> PathBuf {
    let to = kept.join(format!("input-{number}"));
    fs::create_dir_all(&to).expect("a folder for what is found");
    for entry in fs::read_dir(folder).expect("the folder of inputs").flatten() {
        fs::copy(entry.path(), to.join(entry.file_name())).expect("a copy of the input");
    }
    fs::write(to.join("found.txt"), what).expect("what was found");
    to
}
