//! Where, when and by what a report was made.

use serde::Serialize;
use std::{fs, process::Command, time::SystemTime};
use umbrage::AdapterSummary;

/// Circumstances of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Made {
    /// RFC 3339, UTC.
    pub date: String,
    /// Version of umbrage.
    pub version: &'static str,
    /// Abbreviated git commit that the program was built from, changes beyond it aside; null where
    /// it is not known.
    pub commit: Option<&'static str>,
    /// The command line, word by word.
    pub command: Vec<String>,
    /// The computer.
    pub machine: Machine,
    /// The graphics adapter and its driver.
    pub adapter: Adapter,
}

/// A computer.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// Name of the processor.
    pub cpu: String,
    /// Cores that the program may use.
    pub cores: usize,
    /// Operating system and architecture.
    pub os: String,
}

/// A graphics adapter.
#[derive(Clone, Debug, Serialize)]
pub struct Adapter {
    /// The driver's name for it.
    pub name: String,
    /// `Vulkan`, `Metal`, `Dx12`, …
    pub backend: String,
    /// `software`, `integrated`, `discrete`, `virtual` or `other`.
    pub kind: String,
    /// Driver and version.
    pub driver: String,
}

impl From<&AdapterSummary> for Adapter {
    fn from(summary: &AdapterSummary) -> Self {
        let AdapterSummary { name, backend, kind, driver, .. } = summary;
        Self { name: name.clone(), backend: backend.clone(), kind: (*kind).into(), driver: driver.clone() }
    }
}

impl Made {
    /// Here and now, by `command`, on this adapter.
    pub fn now(command: Vec<String>, adapter: &AdapterSummary) -> Self {
        Self {
            date: rfc3339(SystemTime::now()),
            version: env!("CARGO_PKG_VERSION"),
            commit: option_env!("UMBRAGE_COMMIT"),
            command,
            machine: Machine::this(),
            adapter: adapter.into(),
        }
    }
}

impl Machine {
    fn this() -> Self {
        Self {
            cpu: cpu_name().unwrap_or_else(|| "unknown processor".into()),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            os: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

fn cpu_name() -> Option<String> {
    let from_proc = || {
        let text = fs::read_to_string("/proc/cpuinfo").ok()?;
        let line = text.lines().find(|l| l.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    let from_sysctl = || output("sysctl", &["-n", "machdep.cpu.brand_string"]);
    from_proc().or_else(from_sysctl).or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
}

/// What a program printed, trimmed; `None` where it failed or printed nothing.
fn output(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).output().ok().filter(|o| o.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_string();
    (!text.is_empty()).then_some(text)
}

/// Seconds are exact enough; leap seconds are not counted, as in Unix time.
fn rfc3339(time: SystemTime) -> String {
    let seconds = time.duration_since(SystemTime::UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let (year, month, day) = civil(seconds / 86_400);
    let (h, m, s) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("{year:04}-{month:02}-{day:02}T{h:02}:{m:02}:{s:02}Z")
}

/// Year, month and day of a day counted from 1970-01-01, by eras of 400 years that start in March
/// (Howard Hinnant, "chrono-Compatible Low-Level Date Algorithms", `civil_from_days`).
fn civil(day: u64) -> (u64, u64, u64) {
    let day = day + 719_468;
    let (era, day) = (day / 146_097, day % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (day, month) = (day - (153 * month + 2) / 5 + 1, if month < 10 { month + 3 } else { month - 9 });
    (era * 400 + year + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn dates_are_those_of_the_calendar() {
        let at = |s| rfc3339(SystemTime::UNIX_EPOCH + Duration::from_secs(s));
        assert_eq!(at(0), "1970-01-01T00:00:00Z");
        assert_eq!(at(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(at(1_709_251_199), "2024-02-29T23:59:59Z");
        assert_eq!(at(4_107_542_400), "2100-03-01T00:00:00Z");
    }

    #[test]
    fn this_machine_has_a_core() {
        let machine = Machine::this();
        assert!(machine.cores > 0 && !machine.cpu.is_empty(), "{machine:?}");
    }
}
