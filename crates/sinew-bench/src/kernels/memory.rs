//! Memory bandwidth of one thread.

use std::hint::black_box;

use sinew_measure::thread_cpu_time;
use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::read_all;

/// Minimum number of bytes read in a measurement.
const READ: usize = 400_000_000;

/// Bytes per second at which one thread reads `bytes` bytes repeatedly: the bandwidth of the cache that contains them.
pub(super) fn bandwidth(bytes: usize) -> f64 {
    let words = (bytes / 8).max(4096);
    let values = vec![1.0_f64; words];
    let set = InstructionSet::best();
    let rounds = (READ / (8 * words)).max(2);
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let before = thread_cpu_time();
        for _ in 0..rounds {
            black_box(read_all(set, black_box(&values)));
        }
        best = best.min((thread_cpu_time() - before).as_secs_f64());
    }
    (8 * words * rounds) as f64 / best
}
