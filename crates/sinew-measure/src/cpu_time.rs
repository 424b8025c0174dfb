//! CPU time of the calling thread and of the process, and the clock that a run names.

use std::time::{Duration, Instant};

use sinew_core::CostClock;

/// An instant on all clocks that may measure a run.
#[derive(Clone, Copy, Debug)]
pub struct CostSince {
    thread: Duration,
    process: Duration,
    wall: Instant,
}

impl CostSince {
    /// The present instant.
    #[must_use]
    pub fn now() -> Self {
        Self {
            thread: thread_cpu_time(),
            process: process_cpu_time(),
            wall: Instant::now(),
        }
    }

    /// Time since this instant on the clock named by the integrator ([`sinew_core::Integrator::cost_clock`]).
    #[must_use]
    pub fn elapsed(&self, clock: CostClock) -> Duration {
        match clock {
            CostClock::CallingThread => thread_cpu_time() - self.thread,
            CostClock::AllThreads => process_cpu_time() - self.process,
            CostClock::Wall { .. } => self.wall.elapsed(),
        }
    }
}

/// Thread CPU time since some fixed instant, without that of other processes. Wall time if the platform has no
/// such clock.
#[must_use]
pub fn thread_cpu_time() -> Duration {
    #[cfg(unix)]
    {
        let now = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
        Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32)
    }
    #[cfg(not(unix))]
    {
        use std::sync::OnceLock;
        use std::time::Instant;
        static START: OnceLock<Instant> = OnceLock::new();
        START.get_or_init(Instant::now).elapsed()
    }
}

/// CPU time of all threads of the process since some fixed instant. Wall time if the platform has no such
/// clock.
#[must_use]
pub fn process_cpu_time() -> Duration {
    #[cfg(unix)]
    {
        let now = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Duration::new(now.tv_sec.unsigned_abs(), now.tv_nsec.unsigned_abs() as u32)
    }
    #[cfg(not(unix))]
    {
        thread_cpu_time()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn sleeping_costs_nothing() {
        let before = thread_cpu_time();
        std::thread::sleep(Duration::from_millis(50));
        assert!(thread_cpu_time() - before < Duration::from_millis(20));
    }
}
