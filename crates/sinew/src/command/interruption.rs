//! Ctrl-C and similar signals: a run ends in order.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::TERM_SIGNALS;

/// A flag, set once this process is asked to end. A second request ends it immediately.
#[derive(Clone, Debug)]
pub(crate) struct Interruption(Arc<AtomicBool>);

impl Interruption {
    /// Listens from now on.
    pub(crate) fn listen() -> io::Result<Self> {
        let flag = Arc::new(AtomicBool::new(false));
        let ignored = ignored();
        let signals = TERM_SIGNALS.iter().copied().chain(hang_up());
        // What was to be ignored from the beginning, as under nohup, stays so.
        for signal in signals.filter(|signal| ignored >> (signal - 1) & 1 == 0) {
            // The first request sets the flag; where it is set already, the default follows.
            signal_hook::flag::register_conditional_default(signal, Arc::clone(&flag))?;
            signal_hook::flag::register(signal, Arc::clone(&flag))?;
        }
        Ok(Self(flag))
    }

    pub(crate) fn is_asked_for(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Clears the request once it is served: the next request is the first again.
    #[cfg(feature = "live")]
    pub(crate) fn is_followed(&self) {
        self.0.store(false, Ordering::Relaxed);
    }
}

#[cfg(unix)]
fn hang_up() -> Option<i32> {
    Some(signal_hook::consts::SIGHUP)
}

#[cfg(not(unix))]
fn hang_up() -> Option<i32> {
    None
}

/// The signals that this process was started to ignore, one bit each from 1 on, if the system reports them.
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok())
        .unwrap_or(0)
}
