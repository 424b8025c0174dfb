//! Messages after a run.

use std::path::Path;

use sinew_core::StepReport;
use sinew_record::{MOST_NUMBERS, RecordRunError, RunEnd, words_of_cuts};
use sinew_scene::output::{Replaced, complain};
use sinew_scene::{ProbeRows, SceneBody, Schedule, Simulation};

/// Largest number of rows of a table of probes, unless the scene requests more.
const MOST_ROWS: usize = 100_000;

/// The steps after which probes are recorded; prints a message if these are not all steps. A table that is kept has no
/// more rows than can be read.
pub(super) fn schedule(
    simulation: &Simulation,
    rows: &ProbeRows,
    steps: (usize, f64),
    is_kept: bool,
) -> Result<Schedule, RecordRunError> {
    let asked = simulation.scene().output().probes;
    if asked.is_none() && !is_kept {
        // A pipe stores nothing, and its reader takes the rows that it wants.
        return Ok(Schedule::at_most(usize::MAX, steps.0));
    }
    let columns = rows.columns().len();
    let schedule = Schedule::of_probes(asked, columns, MOST_ROWS, steps);
    let numbers = schedule.count().saturating_mul(columns);
    if is_kept && numbers > MOST_NUMBERS {
        return Err(RecordRunError::TooMuch {
            asked: numbers,
            what: "numbers in the table of probes",
            most: MOST_NUMBERS,
            key: "probes",
        });
    }
    if asked.is_none() && !schedule.is_every_step() {
        complain(&format!(
            "probes: a row after every {:.1} steps on average; `probes` in [output] sets other instants",
            schedule.spacing()
        ));
    }
    Ok(schedule)
}

/// Statement about the error, which no run can measure itself.
const ERROR_NOT_KNOWN: &str =
    "the error of this run is not known: `sinew plan --tolerance` measures it";

/// A line about steps that were taken again, if there were any.
fn retaken(times: u64) -> Option<String> {
    let times = match times {
        0 => return None,
        1 => "once".to_owned(),
        times => format!("{times} times"),
    };
    Some(format!(
        "{times} a step was taken again in shorter parts, because the body stiffened within it"
    ))
}

/// At most seventeen lines about a run.
pub(super) fn summary_of(simulation: &Simulation, end: &RunEnd, path: &Path) -> Vec<String> {
    let (steps, wall) = end.own;
    let own = steps as f64 * end.stepping.dt();
    let (sweeps, solves) = end.work;
    let mut lines = vec![
        format!(
            "{}: {} steps of {} by {}: {sweeps} sweeps, {solves} solves",
            simulation.scene().title_or_path(),
            end.steps,
            end.stepping.length_in_words(),
            end.stepping.methods_in_words(),
        ),
        format!(
            "{own:.4} s in {wall:.2} s, outputs included: {:.3} times real time",
            own / wall.max(1e-9)
        ),
    ];
    if simulation.model().body().is_some() {
        let (u, t, node) = end.largest;
        lines.push(format!(
            "largest displacement in {} frames: {u:.6e} m at t = {t:.6} s, node {node}",
            end.frames
        ));
    }
    if let Some((totals, pieces)) = &end.cuts {
        lines.push(format!("cut: {}", words_of_cuts(totals, *pieces)));
    }
    if end.saturated > 0.0 {
        lines.push(format!(
            "guarded: {:.3} % of all velocities were saturated; the motion is bounded, not accurate",
            100.0 * end.saturated
        ));
    }
    lines.extend(retaken(end.retaken));
    lines.extend(end.remarks.iter().cloned());
    let warnings = end.warnings.iter();
    lines.extend(warnings.map(|warning| format!("warning: {warning}")));
    lines.push(ERROR_NOT_KNOWN.to_owned());
    lines.push(format!(
        "{}: report.html, fields.pvd for ParaView, tables, summary.json",
        path.display()
    ));
    if let Replaced::KeptIn(kept) = &end.replaced {
        lines.push(format!(
            "{}: the earlier results in {}",
            kept.display(),
            path.display()
        ));
    }
    lines
}

/// Some lines about a run of which only the motion of probes is kept.
pub(super) fn summary(
    simulation: &Simulation,
    body: &SceneBody,
    steps: usize,
    work: StepReport,
) -> String {
    let settings = simulation.settings();
    let pairs = steps as f64 * body.system().dofs() as f64;
    let mut text = format!(
        "{}: {} steps of {} s by `{}`: {} sweeps, {} solves",
        simulation.scene().title_or_path(),
        steps,
        simulation.dt(),
        settings.integrator,
        work.sweeps,
        work.solves
    );
    if work.saturated > 0 {
        let share = 100.0 * work.saturated as f64 / pairs;
        text.push_str(&format!(
            "\nguarded: {share:.3} % of all velocities were saturated; the motion is bounded, not accurate"
        ));
    }
    for line in retaken(work.retaken)
        .into_iter()
        .chain([ERROR_NOT_KNOWN.to_owned()])
    {
        text.push('\n');
        text.push_str(&line);
    }
    text
}
