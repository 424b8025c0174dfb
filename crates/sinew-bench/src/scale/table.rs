//! A bench over sizes as a table for readers.

use std::fmt;

use super::row::{ScaleBody, ScaleRow};
use super::{ScaleFit, ScaleResults};
use sinew_verify::ruled;

use crate::report::{milliseconds, percent, three, two};

const BODIES: [&str; 8] = [
    "body",
    "tets",
    "build\n[s]",
    "memory\n[bytes/tet]",
    "reference\n[s]",
    "sweeps over\nomega t",
    "its error\n[%]",
    "critical step\n[ms]",
];

const ROWS: [&str; 12] = [
    "body",
    "method",
    "precision",
    "threads",
    "dt\n[ms]",
    "dt/crit.",
    "error\n[%]",
    "CPU\n[s/s]",
    "wall\n[s/s]",
    "set-up\n[CPU s]",
    "memory\n[bytes/tet]",
    "kernel",
];

const FITS: [&str; 9] = [
    "method",
    "precision",
    "threads",
    "error",
    "CPU",
    "wall",
    "set-up",
    "memory",
    "in real time\n[tets]",
];

impl fmt::Display for ScaleResults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let simulated = self.bodies.first().map_or(0.0, |body| body.simulated_s);
        writeln!(
            f,
            "The peers' cube with mass damping 20/s at several sizes; about {} s simulated. CPU time is that of all threads.\n",
            two(simulated)
        )?;
        let bodies = ruled::table(BODIES, self.bodies.iter().map(body), 1);
        writeln!(f, "{}\n", ruled::lines(bodies, 2))?;
        if let Some(body) = self.bodies.first() {
            writeln!(f, "reference: {}\n", body.reference)?;
        }
        let rows = ruled::table(ROWS, self.rows.iter().map(cells), 4);
        writeln!(f, "{}\n", ruled::lines(rows, 2))?;
        for run in &self.skipped {
            writeln!(f, "not run: {} on {}: {}", run.method, run.mesh, run.reason)?;
        }
        write!(f, "\n{}", self.brief())
    }
}

impl ScaleResults {
    /// Growth of all figures with the size, for a terminal.
    #[must_use]
    pub fn brief(&self) -> String {
        let fits = ruled::table(FITS, self.fits.iter().map(fit), 3);
        format!(
            "Powers of the number of tetrahedra, and the largest body in real time (* beyond the sizes measured)\n\n{}",
            ruled::lines(fits, 2)
        )
    }
}

fn body(body: &ScaleBody) -> [String; 8] {
    [
        body.mesh.clone(),
        body.tets.to_string(),
        three(body.build_wall_s),
        whole(body.bytes_per_tet),
        three(body.reference_wall_s),
        three(body.reference_sweeps_per_omega_t),
        percent(body.reference_error),
        milliseconds(body.critical_step_s),
    ]
}

fn cells(row: &ScaleRow) -> [String; 12] {
    [
        row.mesh.clone(),
        row.integrator.to_owned(),
        row.precision.to_owned(),
        row.threads.to_string(),
        milliseconds(row.dt),
        three(row.step_over_critical),
        error(row),
        three(row.cpu_s_per_s),
        three(row.wall_s_per_s),
        three(row.setup_cpu_s),
        whole(row.bytes_per_tet),
        row.kernel.clone().unwrap_or_default(),
    ]
}

/// The error in per cent, or its bound.
pub(super) fn error(row: &ScaleRow) -> String {
    match (row.error_is_below, row.error) {
        (Some(bound), _) => format!("< {}", percent(bound)),
        (None, Some(error)) => percent(error),
        (None, None) => "diverged".to_owned(),
    }
}

fn fit(fit: &ScaleFit) -> [String; 9] {
    let power = |exponent: Option<f64>| exponent.map_or_else(String::new, |p| format!("{p:.2}"));
    let exponents = &fit.exponents;
    [
        fit.integrator.to_owned(),
        fit.precision.to_owned(),
        fit.threads.to_string(),
        power(exponents.error),
        power(exponents.cpu_s_per_s),
        power(exponents.wall_s_per_s),
        power(exponents.setup_cpu_s),
        power(exponents.bytes_per_tet),
        real_time(fit).unwrap_or_default(),
    ]
}

/// The largest body in real time, with a star if it is beyond the measured sizes.
pub(super) fn real_time(fit: &ScaleFit) -> Option<String> {
    let star = if fit.real_time_is_extrapolated {
        "*"
    } else {
        ""
    };
    let tets = fit.real_time_tets?;
    Some(match tets {
        tets if tets >= 1e6 => format!("{} M{star}", three(1e-6 * tets)),
        tets => format!("{} k{star}", three(1e-3 * tets)),
    })
}

fn whole(bytes: Option<f64>) -> String {
    bytes.map_or_else(|| "n/a".to_owned(), |bytes| format!("{bytes:.0}"))
}
