//! GPU times of passes.

use super::{Owner, PassTime, queries::Queries};
use crate::gpu::Gpu;

/// Timestamps at the start and the end of every pass.
pub(super) struct Timer {
    pub queries: Queries<(Owner, String)>,
    period_ns: f64,
    pub latest: Vec<PassTime>,
}

impl Timer {
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            queries: Queries::new(gpu, "timestamps", wgpu::QueryType::Timestamp, 2),
            period_ns: f64::from(gpu.queue.get_timestamp_period()),
            latest: Vec::new(),
        }
    }

    pub fn resolve(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.collect();
        if !self.queries.resolve(encoder) {
            self.latest.clear();
        }
    }

    /// Takes what has arrived.
    pub fn collect(&mut self) {
        if let Some((names, ticks)) = self.queries.newest() {
            self.latest = sum_by_name(names, &ticks, self.period_ns);
        }
    }
}

/// Start and end of each pass, in ticks, to milliseconds by name.
fn sum_by_name(names: Vec<(Owner, String)>, ticks: &[u64], period_ns: f64) -> Vec<PassTime> {
    let mut times: Vec<PassTime> = Vec::new();
    for ((owner, pass), pair) in names.into_iter().zip(ticks.as_chunks::<2>().0) {
        let time_ms = pair[1].saturating_sub(pair[0]) as f64 * period_ns * 1e-6;
        match times.iter_mut().find(|t| t.owner == owner && t.pass == pass) {
            Some(t) => t.time_ms += time_ms,
            None => times.push(PassTime { owner, pass, time_ms }),
        }
    }
    times
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn passes_of_one_name_add_up() {
        let name = |p: &str| (Owner::Light(0), p.to_string());
        let times = sum_by_name(vec![name("map"), name("map"), name("test")], &[0, 1000, 2000, 4000, 10, 5], 1000.0);
        assert_eq!(times.len(), 2);
        assert!((times[0].time_ms - 3.0).abs() < 1e-9);
        assert_eq!(times[1].time_ms, 0.0, "a clock that ran backwards is no time");
    }
}
