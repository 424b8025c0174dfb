//! The memory that is left to this process.

use std::fs;

/// Memory (bytes) that the computer, the control group and the limits of the process leave, if the system reports it.
pub(crate) fn memory_left() -> Option<u64> {
    let left = [of_computer(), of_group(), of_process()];
    left.into_iter().flatten().min()
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
