//! The clock of a thread.

use std::time::Duration;

/// Name of the clock, for reports.
#[cfg(target_os = "linux")]
pub const CLOCK_NAME: &str = "CPU time of the thread";
/// Name of the clock, for reports.
#[cfg(not(target_os = "linux"))]
pub const CLOCK_NAME: &str = "wall time";

/// Returns the CPU time of this thread. Unlike wall time, it does not grow while other programs run.
#[cfg(target_os = "linux")]
pub fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.try_into().unwrap_or(0), time.tv_nsec.try_into().unwrap_or(0))
}

/// Returns wall time: the thread's CPU time is not available here without unsafe code.
#[cfg(not(target_os = "linux"))]
pub fn thread_time() -> Duration {
    use std::{sync::LazyLock, time::Instant};
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}
