//! The clock for cost measurements.

use crate::platform::thread_time;

/// Runs `work` and returns its result and the CPU time of the thread, s.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = thread_time();
    let result = work();
    (result, thread_time().saturating_sub(start).as_secs_f64())
}
