//! The clock of a thread.

use std::time::Duration;

/// What the clock shows, for reports.
#[cfg(target_os = "linux")]
pub const CLOCK: &str = "CPU time of the thread";
/// What the clock shows, for reports.
#[cfg(not(target_os = "linux"))]
pub const CLOCK: &str = "wall time";

/// Time on this thread's own clock, which other programs do not slow down as they do the wall's.
#[cfg(target_os = "linux")]
pub fn thread_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec.try_into().unwrap_or(0), time.tv_nsec.try_into().unwrap_or(0))
}

/// Time on the wall's clock, where the thread's own is not to be had without unsafe code.
#[cfg(not(target_os = "linux"))]
pub fn thread_time() -> Duration {
    use std::{sync::LazyLock, time::Instant};
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}
