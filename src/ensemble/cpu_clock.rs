//! [`thread_seconds`]: the CPU time of this thread, which does not include the time of other programs.

/// CPU time that this thread has used, s, to the nanosecond.
#[cfg(unix)]
pub fn thread_seconds() -> f64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// Elapsed time, s: the standard library has no CPU time.
#[cfg(not(unix))]
pub fn thread_seconds() -> f64 {
    use std::sync::LazyLock;
    use std::time::Instant;
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed().as_secs_f64()
}
