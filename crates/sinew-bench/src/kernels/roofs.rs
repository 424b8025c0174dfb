//! Peak rates of one thread of the computer: bytes read and floating-point operations in a second.

use std::fs;
use std::hint::black_box;

use serde::Serialize;
use sinew_measure::thread_cpu_time;
use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::{Precision, multiply_adds};

use super::memory::bandwidth;

/// Peak rates of one thread, measured in the same run as the rows.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Roofs {
    /// Rates of reading, the fastest memory first.
    pub reads: Vec<ReadRate>,
    /// Rates of multiply-adds, for each instruction set and precision.
    pub multiply_adds: Vec<OperationRate>,
}

/// The rate at which one thread reads a number of bytes repeatedly.
#[derive(Clone, Debug, Serialize)]
pub struct ReadRate {
    /// The memory that contains them: "L2", "L3" or "DRAM".
    pub memory: &'static str,
    /// The bytes.
    pub bytes: usize,
    /// Bytes per second.
    pub bytes_per_s: f64,
}

/// The rate at which one thread multiplies and adds in registers.
#[derive(Clone, Debug, Serialize)]
pub struct OperationRate {
    /// The instruction set.
    pub instructions: &'static str,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Floating-point operations per second, two for each multiply-add.
    pub operations_per_s: f64,
}

/// Sizes of caches (bytes) if the system does not report them.
const CACHES: [usize; 2] = [1 << 20, 32 << 20];

/// Largest number of bytes read to measure memory.
const MOST: usize = 1 << 30;

impl Roofs {
    /// Measures all rates; a quick measurement leaves out large sizes.
    pub(super) fn measure(quick: bool) -> Self {
        let l2 = cache(2).unwrap_or(CACHES[0]);
        let l3 = cache(3).unwrap_or(CACHES[1]);
        // Half of a private cache; of a shared one, what many programs beside may leave.
        let mut memories = vec![("L2", l2 / 2)];
        if !quick {
            memories.push(("L3", (8 * l2).min(l3 / 2)));
            memories.push(("DRAM", (2 * l3).min(MOST)));
        }
        let reads = memories.into_iter().map(|(memory, bytes)| ReadRate {
            memory,
            bytes,
            bytes_per_s: bandwidth(bytes),
        });
        let mut rates = Vec::new();
        for set in InstructionSet::available() {
            rates.push(rate::<f64>(set, quick));
            rates.push(rate::<f32>(set, quick));
        }
        Self {
            reads: reads.collect(),
            multiply_adds: rates,
        }
    }
}

fn rate<T: Precision>(set: InstructionSet, quick: bool) -> OperationRate {
    let rounds = if quick { 20_000 } else { 2_000_000 };
    let mut best: f64 = 0.0;
    for _ in 0..5 {
        let before = thread_cpu_time();
        let (operations, result) = multiply_adds::<T>(black_box(set), black_box(rounds));
        black_box(result);
        best = best.max(operations / (thread_cpu_time() - before).as_secs_f64().max(1e-9));
    }
    OperationRate {
        instructions: set.name(),
        precision: T::NAME,
        operations_per_s: best,
    }
}

/// Bytes of a processor's cache of this level, if Linux reports it.
fn cache(level: u32) -> Option<usize> {
    let of = |index: u32, name: &str| {
        let path = format!("/sys/devices/system/cpu/cpu0/cache/index{index}/{name}");
        Some(fs::read_to_string(path).ok()?.trim().to_owned())
    };
    let index =
        (0..8).find(|index| of(*index, "level").is_some_and(|of| of == level.to_string()))?;
    let size = of(index, "size")?;
    let (number, unit) = size.split_at(size.len().checked_sub(1)?);
    let unit = match unit {
        "K" => 1 << 10,
        "M" => 1 << 20,
        _ => return None,
    };
    Some(number.parse::<usize>().ok()? * unit)
}
