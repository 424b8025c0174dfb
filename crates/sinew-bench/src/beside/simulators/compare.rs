//! Errors of all runs, relative to fine runs of ours.

use std::path::Path;

use sinew_measure::on_one_thread;
use sinew_measure::reference::ErrorNorm;
use sinew_verify::{LabError, Machine};

use super::cube::{DURATION, INSTANTS, SharedCube};
use super::own_runs::OwnRun;
use super::results::SimulatorResults;
use super::row::SimulatorRow;
use super::said::{Said, SaidRun};

/// Measures our runs with the laws of the other programs, and computes all errors relative to fine runs with these
/// laws.
///
/// `folder` contains the cube's file and the displacements that the other programs wrote.
///
/// # Errors
/// [`LabError`], also if displacements of a program are missing or do not belong to the cube.
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
        duration_s: DURATION,
        instants: INSTANTS,
        laps: cube.laps,
        versions: said.iter().map(Said::versions).collect(),
        rows,
        missing: Vec::new(),
    })
}

fn rows(cube: &SharedCube, said: &[Said], folder: &Path) -> Result<Vec<SimulatorRow>, LabError> {
    let runs = || said.iter().flat_map(|said| &said.runs);
    let is_known = |run: &SaidRun| cube.bodies.iter().any(|body| run.is_of(body));
    if let Some(run) = runs().find(|run| !is_known(run)) {
        return Err(LabError::new(format!(
            "{}: no case `{}` with the law `{}`",
            run.method, run.case, run.law
        )));
    }
    let mut rows = Vec::new();
    for body in &cube.bodies {
        let of = |run: &&SaidRun| run.is_of(body);
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

#[cfg(test)]
mod tests {
    use super::*;

    fn said(law: &str) -> Said {
        let run = format!(
            "{{\"case\": \"pulled\", \"method\": \"Euler\", \"law\": \"{law}\", \"dt_s\": 0.001, \"is_limit\": true, \
             \"steps\": 500, \"cpu_s\": 0.2, \"file\": \"x.f64\"}}"
        );
        let lines = format!("{{\"versions\": {{\"X\": \"1.0\"}}}}\n{run}");
        Said::read("x_cube.py", "X", &lines).unwrap()
    }

    #[test]
    fn a_program_is_held_against_its_own_law_and_an_unknown_one_is_an_error() {
        let cube = SharedCube::new(true).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let by = || ("r".to_owned(), sinew_verify::machine());
        let compared = |law| compare(&cube, &[said(law)], folder.path(), by());
        let error = compared("ogden").unwrap_err().to_string();
        assert!(
            error.contains("no case `pulled` with the law `ogden`"),
            "{error}"
        );

        // A program that gives our fine motion has no error, and four rows of ours are next to it.
        let body = cube.bodies.iter().find(|body| body.law == "stvk").unwrap();
        let fine = OwnRun::fine(body).unwrap().motion;
        let bytes: Vec<u8> = fine
            .iter()
            .flatten()
            .flat_map(|u| u.to_le_bytes())
            .collect();
        std::fs::write(folder.path().join("x.f64"), bytes).unwrap();
        let results = compared("stvk").unwrap();
        assert_eq!(results.rows.len(), 5);
        assert!(results.rows[0].error < 1e-12 && results.rows[0].error_at_end < 1e-12);
        assert_eq!(results.ratios().len(), 1);
    }
}
