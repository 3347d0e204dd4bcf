//! The clock that costs are measured by.

use crate::platform::thread_time;

/// What `work` returns, and the seconds that it has taken on the clock.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = thread_time();
    let result = work();
    (result, thread_time().saturating_sub(start).as_secs_f64())
}
