//! Other simulators on the same cube, each with its own method, law and stable step.

mod cube;
mod own_runs;
mod page;
mod said;
mod table;

use std::path::Path;

use serde::Serialize;
use sinew_measure::on_one_thread;
use sinew_measure::reference::ErrorNorm;
use sinew_verify::{LabError, Machine};

pub use cube::SharedCube;
pub use said::{Said, SaidError, SaidRun};

use own_runs::{OWN, OwnRun};

/// One run: a program with its own method, law and step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatorRow {
    /// The case: "pulled" or "pressed".
    pub case: String,
    /// Id of the law, by which the fine run is made that the error is taken against.
    pub law: String,
    /// The program with its version.
    pub program: String,
    /// Its method.
    pub method: String,
    /// Step (s), the mean one where steps follow the stiffness.
    pub dt_s: f64,
    /// True if longer steps are unstable.
    pub is_limit: bool,
    /// Steps of the run.
    pub steps: usize,
    /// CPU time (s) of the steps for a simulated second, least of the laps.
    pub cpu_s_per_s: f64,
    /// Relative L2 error of the displacement over all instants.
    pub error: f64,
    /// The same at the last instant alone.
    pub error_at_end: f64,
}

/// Runs of other simulators and of ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SimulatorResults {
    /// Revision of the code.
    pub revision: String,
    /// The computer.
    pub machine: Machine,
    /// Simulated time (s).
    pub duration_s: f64,
    /// Instants at which errors are taken, equally spaced, the last at the end.
    pub instants: usize,
    /// Laps of each run.
    pub laps: usize,
    /// Versions of each program and of what it is built on.
    pub versions: Vec<String>,
    /// The runs.
    pub rows: Vec<SimulatorRow>,
    /// Programs that were asked for and have no rows, with the reason.
    pub missing: Vec<String>,
}

impl SimulatorResults {
    /// Ours that others are compared with: single precision in fixed steps, of the same case and law.
    fn own(&self, other: &SimulatorRow) -> Option<&SimulatorRow> {
        let mut rows = self.rows.iter();
        rows.find(|row| row.case == other.case && row.law == other.law && row.method == OWN)
    }

    /// Errors and costs over those of ours, in a sentence for each run of another program.
    #[must_use]
    pub fn ratios(&self) -> Vec<String> {
        let others = self.rows.iter().filter(|row| !row.is_ours());
        let sentence = |row: &SimulatorRow| {
            let own = self.own(row)?;
            Some(format!(
                "{}, {}: {} {} has {} times the error of our {} at {} times its CPU time",
                row.case,
                row.law,
                row.program,
                row.method,
                crate::report::two(row.error / own.error),
                own.method,
                crate::report::two(row.cpu_s_per_s / own.cpu_s_per_s),
            ))
        };
        others.filter_map(sentence).collect()
    }
}

impl SimulatorRow {
    /// True for runs of this program.
    #[must_use]
    pub fn is_ours(&self) -> bool {
        self.program.starts_with(own_runs::PROGRAM)
    }
}

/// Measures ours under the laws that the others have, and takes all errors against fine runs of these laws.
///
/// `folder` is that of the cube's file, in which the others have written their displacements.
///
/// # Errors
/// [`LabError`], also where displacements of a program are missing or are not those of the cube.
pub fn compare(
    cube: &SharedCube,
    said: &[Said],
    folder: &Path,
    (revision, machine): (String, Machine),
) -> Result<SimulatorResults, LabError> {
    let work = || rows(cube, said, folder);
    let rows = on_one_thread(work)??;
    Ok(SimulatorResults {
        revision,
        machine,
        duration_s: cube::DURATION,
        instants: cube::INSTANTS,
        laps: cube.laps,
        versions: said.iter().map(Said::versions).collect(),
        rows,
        missing: Vec::new(),
    })
}

fn rows(cube: &SharedCube, said: &[Said], folder: &Path) -> Result<Vec<SimulatorRow>, LabError> {
    let mut rows = Vec::new();
    for body in &cube.bodies {
        let of = |run: &&SaidRun| run.case == body.case && run.law == body.law;
        let runs = said.iter().flat_map(|said| {
            let runs = said.runs.iter().filter(of);
            runs.map(move |run| (said, run))
        });
        let runs: Vec<_> = runs.collect();
        if runs.is_empty() {
            continue;
        }
        let fine = OwnRun::fine(body)?.motion;
        let row = |motion: &[Vec<f64>], row: SimulatorRow| SimulatorRow {
            case: body.case.to_owned(),
            law: body.law.to_owned(),
            error: ErrorNorm::between(motion, &fine),
            error_at_end: match (motion, fine.as_slice()) {
                ([.., end], [.., fine]) => {
                    let (end, fine) = (std::slice::from_ref(end), std::slice::from_ref(fine));
                    ErrorNorm::between(end, fine)
                }
                _ => f64::NAN,
            },
            ..row
        };
        for (said, run) in runs {
            let motion = said.motion(run, folder, body)?;
            rows.push(row(&motion, said.row(run)));
        }
        for own in OwnRun::all(body, cube.laps)? {
            rows.push(row(&own.motion, own.row()));
        }
    }
    Ok(rows)
}
