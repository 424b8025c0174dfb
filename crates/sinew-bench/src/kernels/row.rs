//! A row of a bench of kernels.

use serde::Serialize;

/// Steps of a program on one machine.
#[derive(Clone, Debug, Serialize)]
pub struct KernelRow {
    /// The body.
    pub mesh: String,
    /// Number of its nodes, fixed ones included.
    pub nodes: usize,
    /// Its tetrahedra.
    pub tets: usize,
    /// The machine: "template" in the name if equal rows are stored once.
    pub kernel: String,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Instructions.
    pub instructions: &'static str,
    /// Threads that it may use.
    pub threads: usize,
    /// Time of a step of plain loops over its own time, median of alternating laps: CPU time, or wall time with several
    /// threads.
    pub ratio_to_b1: f64,
    /// The same over plain loops that check no bounds of values and columns.
    pub ratio_to_b1_without_checks: f64,
    /// Lowest and highest ratio to B1.
    pub ratios: [f64; 2],
    /// Time of a step (s), on this computer only.
    pub step_s: f64,
    /// Largest difference of a displacement from the plain machine's after the steps of a lap, relative to
    /// the largest displacement.
    pub difference: f64,
    /// Bytes that a step moves: matrices or templates, and vectors.
    pub bytes_per_step: f64,
    /// Floating-point operations of a step: two for each entry of the matrix, independent of its storage, and those
    /// of the cells' own maps.
    pub operations_per_step: f64,
    /// Operations per second, in thousands of millions.
    pub gflops: f64,
    /// Operations for each byte that a step moves.
    pub intensity: f64,
    /// Bandwidth of a step over that at which one thread reads this many bytes, measured in the same run.
    pub share_of_bandwidth: f64,
    /// Templates, if equal rows are stored once.
    pub templates: Option<usize>,
    /// Allocations of the calling thread in a step; `None` if they are not counted.
    pub allocations_per_step: Option<f64>,
}
