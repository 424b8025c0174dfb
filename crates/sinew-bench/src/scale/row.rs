//! Rows of a bench over sizes.

use serde::Serialize;

/// A cube with its reference.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleBody {
    /// Its name, by the nodes on an edge.
    pub mesh: String,
    /// Number of its nodes, fixed ones included.
    pub nodes: usize,
    /// Its tetrahedra.
    pub tets: usize,
    /// Its free degrees of freedom.
    pub dofs: usize,
    /// Simulated time (s).
    pub simulated_s: f64,
    /// 2/omega (s) of its fastest motion.
    pub critical_step_s: f64,
    /// Wall time (s) for building mesh and matrices.
    pub build_wall_s: f64,
    /// Memory (bytes per tetrahedron) of mesh and matrices; none if no allocator counts it.
    pub bytes_per_tet: Option<f64>,
    /// Description of the method of the reference and its check.
    pub reference: String,
    /// The reference's own estimated relative error (fraction).
    pub reference_error: f64,
    /// Products with the matrices that it took, its check included.
    pub reference_sweeps: u64,
    /// Number of these products, divided by the largest angular frequency times the simulated time.
    pub reference_sweeps_per_omega_t: f64,
    /// Wall time (s) that it took, with the search for the largest frequency.
    pub reference_wall_s: f64,
}

/// A run on one cube.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleRow {
    /// The cube, by the nodes on an edge.
    pub mesh: String,
    /// Number of its nodes, fixed ones included.
    pub nodes: usize,
    /// Its tetrahedra.
    pub tets: usize,
    /// The method: "two-step" for the propagator of that kind, otherwise the id of an integrator.
    pub integrator: &'static str,
    /// Step (s).
    pub dt: f64,
    /// Step over 2/omega of the fastest motion.
    pub step_over_critical: f64,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Threads that it may use.
    pub threads: usize,
    /// Machine, precision and instructions; none for a method that is no program.
    pub kernel: Option<String>,
    /// Steps taken.
    pub steps: u64,
    /// Sweeps per simulated second (1/s).
    pub sweeps_per_s: f64,
    /// Simulated time (s).
    pub simulated_s: f64,
    /// Relative L2 error of the displacement (fraction); none for a run that diverged.
    pub error: Option<f64>,
    /// Bound (fraction) below which the error lies, if it is too small for the reference; `error` must not be
    /// quoted then.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_is_below: Option<f64>,
    /// The reference's own estimated relative error (fraction).
    pub reference_error: f64,
    /// CPU time of all threads (s) per simulated second, without the set-up; median of the laps.
    pub cpu_s_per_s: f64,
    /// Wall time (s) per simulated second, without the set-up; median of the laps.
    pub wall_s_per_s: f64,
    /// Laps that were timed.
    pub laps: usize,
    /// CPU time of all threads (s) of the set-up, on matrices without any derived data.
    pub setup_cpu_s: f64,
    /// Wall time (s) of the set-up.
    pub setup_wall_s: f64,
    /// Memory (bytes per tetrahedron) that the method keeps besides mesh and matrices; none if no
    /// allocator counts it.
    pub bytes_per_tet: Option<f64>,
}

/// A run that was not executed.
#[derive(Clone, Debug, Serialize)]
pub struct ScaleSkipped {
    /// The cube.
    pub mesh: String,
    /// Its tetrahedra.
    pub tets: usize,
    /// Method, precision and threads.
    pub method: String,
    /// Reason why it was not executed.
    pub reason: String,
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A row of a method with 1 kB a tetrahedron.
    pub(in super::super) fn row(
        integrator: &'static str,
        tets: usize,
        wall_s_per_s: f64,
        setup_cpu_s: f64,
    ) -> ScaleRow {
        ScaleRow {
            mesh: "cube".into(),
            nodes: tets / 6,
            tets,
            integrator,
            dt: 1e-3,
            step_over_critical: 0.9,
            precision: "f64",
            threads: 1,
            kernel: None,
            steps: 100,
            sweeps_per_s: 1e3,
            simulated_s: 0.1,
            error: Some(0.01),
            error_is_below: None,
            reference_error: 1e-11,
            cpu_s_per_s: wall_s_per_s,
            wall_s_per_s,
            laps: 1,
            setup_cpu_s,
            setup_wall_s: setup_cpu_s,
            bytes_per_tet: Some(1e3),
        }
    }
}
