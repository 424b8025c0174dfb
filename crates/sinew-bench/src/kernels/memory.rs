//! What one thread reads of memory.

use std::hint::black_box;

use sinew_measure::thread_cpu_time;

/// Bytes read in a measurement, at least.
const READ: usize = 400_000_000;

/// Bytes per second that one thread reads of so many bytes, over and over: those of the cache that they
/// fit into.
pub(super) fn bandwidth(bytes: usize) -> f64 {
    let words = (bytes / 8).max(4096);
    let values: Vec<u64> = (0..words as u64).collect();
    let rounds = (READ / (8 * words)).max(2);
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let before = thread_cpu_time();
        for _ in 0..rounds {
            // Several sums, so that no addition waits for the one before.
            let mut sums = [0_u64; 32];
            for chunk in black_box(&values).chunks_exact(32) {
                for (sum, value) in sums.iter_mut().zip(chunk) {
                    *sum = sum.wrapping_add(*value);
                }
            }
            black_box(sums);
        }
        best = best.min((thread_cpu_time() - before).as_secs_f64());
    }
    (8 * words * rounds) as f64 / best
}
