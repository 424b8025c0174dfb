//! The memory that a factor may take.

use std::fs;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::implicit::factor_error::FactorError;

/// Share of the memory left that a factor may take.
const SHARE: f64 = 0.9;

const NOT_SET: u64 = u64::MAX;

/// Bytes that a user set for this process.
static SET: AtomicU64 = AtomicU64::new(NOT_SET);

/// The most memory that a factor may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memory(Option<u64>);

impl Memory {
    /// So many bytes.
    #[must_use]
    pub fn of(bytes: u64) -> Self {
        Self(Some(bytes))
    }

    /// What was set by [`Memory::set_left`], or nine tenths of what this computer has left, as far as the system tells: where it does not, any amount.
    #[must_use]
    pub fn left() -> Self {
        let set = SET.load(Ordering::Relaxed);
        if set != NOT_SET {
            return Self(Some(set));
        }
        let left = [of_computer(), of_group(), of_process()];
        let least = left.into_iter().flatten().min();
        Self(least.map(|bytes| (SHARE * bytes as f64) as u64))
    }

    /// Sets what [`Memory::left`] says from now on in this process, whatever the system tells; `None` ends that.
    pub fn set_left(memory: Option<Self>) {
        let bytes = memory.and_then(|memory| memory.0);
        SET.store(bytes.unwrap_or(NOT_SET), Ordering::Relaxed);
    }

    /// Whether a factor of so many bytes may be taken.
    #[must_use]
    pub fn holds(self, bytes: u64) -> bool {
        self.check(bytes).is_ok()
    }

    /// Refuses a factor of so many bytes if they are too many.
    pub(super) fn check(self, bytes: u64) -> Result<(), FactorError> {
        match self.0 {
            Some(most) if bytes > most => Err(FactorError::Memory {
                needed: bytes / 1_000_000,
                left: most / 1_000_000,
            }),
            _ => Ok(()),
        }
    }
}

/// Memory that is available without swapping (proc(5)).
fn of_computer() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    in_kilobytes(&text, "MemAvailable:")
}

/// Memory that the control group of the process has left (cgroups(7), version 2).
fn of_group() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/cgroup").ok()?;
    let group = text.lines().find_map(|line| line.strip_prefix("0::"))?;
    let read = |name: &str| fs::read_to_string(format!("/sys/fs/cgroup{group}/{name}")).ok();
    let most: u64 = read("memory.max")?.trim().parse().ok()?;
    let taken: u64 = read("memory.current")?.trim().parse().ok()?;
    Some(most.saturating_sub(taken))
}

/// Addresses that the process may still use.
fn of_process() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits
        .lines()
        .find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = line.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").ok()?;
    Some(most.saturating_sub(in_kilobytes(&status, "VmSize:")?))
}

fn in_kilobytes(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(1024 * kilobytes)
}
