//! Advice as text.

use crate::command::ruled;
use comfy_table::CellAlignment;
use sinew_measure::number::{milliseconds, percent, short, three};
use sinew_measure::search::Pilot;
use sinew_measure::{Advice, Answer, LeftOut, MethodChoice, Row, RowOutcome};

/// Heading of the column that is shown only if pilots covered a part of the scene.
const EXPECTED: &str = "expected\n[%]";

const HEAD: [&str; 10] = [
    "",
    "method",
    "dt\n[ms]",
    "error\n[%]",
    EXPECTED,
    "CPU\n[s/s]",
    "set-up\n[s]",
    "in all\n[s]",
    "work\n[sweeps/s]",
    "verdicts",
];

/// Number of instants of changing loads that are listed one by one.
const LISTED_CHANGES: usize = 3;

/// Number of rows for other integrators below the advised one.
const RUNNERS_UP: usize = 3;

/// The advice as text.
pub(super) fn text(advice: &Advice) -> String {
    let mut paragraphs = vec![answer(advice)];
    let mut rows = Vec::new();
    match &advice.answer {
        Answer::Met { cheapest, tenfold } => {
            let labels = std::iter::once("advised").chain(std::iter::repeat("runner-up"));
            rows.extend(labels.zip(cheapest).take(1 + RUNNERS_UP));
            let tenfold = tenfold.as_deref().filter(|pilot| !cheapest.contains(pilot));
            rows.extend(tenfold.map(|pilot| ("ten times better", pilot)));
        }
        Answer::Missed {
            within_tolerance,
            within_budget,
        } => {
            rows.extend(
                within_tolerance
                    .as_deref()
                    .map(|pilot| ("within the tolerance", pilot)),
            );
            rows.extend(
                within_budget
                    .as_deref()
                    .map(|pilot| ("within the budget", pilot)),
            );
        }
    }
    rows.extend(
        advice
            .written
            .as_ref()
            .ok()
            .map(|pilot| ("as written", pilot)),
    );
    if !rows.is_empty() {
        paragraphs.push(table(advice, &rows));
    }
    if let Answer::Met { cheapest, tenfold } = &advice.answer
        && let (Some(best), Some(tolerance)) = (cheapest.first(), advice.question.tolerance)
    {
        paragraphs.push(ten_times_better(
            advice,
            tolerance,
            best,
            tenfold.as_deref(),
        ));
    }
    paragraphs.push(provenance(advice));
    paragraphs.join("\n\n")
}

fn answer(advice: &Advice) -> String {
    let asked = asked(advice);
    let nothing = if advice.covers_the_scene() {
        format!("nothing measured has {asked}")
    } else {
        format!(
            "nothing measured{}{} can be expected to have {asked}",
            up_to(advice),
            if advice.unseen_changes.is_empty() {
                ""
            } else {
                ","
            }
        )
    };
    match &advice.answer {
        Answer::Met { cheapest, .. } => match cheapest.first() {
            Some(best) => format!(
                "{} {asked}{}: {}\n\n{}",
                match advice.question.tolerance {
                    Some(_) => "cheapest with",
                    None => "most accurate with",
                },
                up_to(advice),
                run(advice, best),
                advice.run_table(best).trim_end()
            ),
            None => nothing,
        },
        Answer::Missed {
            within_tolerance,
            within_budget,
        } => {
            let nearest = [within_tolerance, within_budget];
            let mut nearest: Vec<String> = nearest
                .into_iter()
                .flatten()
                .map(|pilot| run(advice, pilot))
                .collect();
            nearest.dedup();
            let text = match nearest.len() {
                0 => nothing,
                _ => format!("{nothing}; nearest: {}", nearest.join(" or ")),
            };
            match within_budget {
                Some(_) => text,
                None => format!("{text}; no sound run is within the budget"),
            }
        }
    }
}

fn asked(advice: &Advice) -> String {
    let question = advice.question;
    let tolerance = question.tolerance;
    let tolerance =
        tolerance.map(|error| format!("an error of at most {} %", short(100.0 * error)));
    let budget = question.budget;
    match (
        tolerance,
        budget.map(|budget| format!("{} CPU s/s", short(budget))),
    ) {
        (Some(tolerance), Some(budget)) => format!("{tolerance} within {budget}"),
        (Some(tolerance), None) => tolerance,
        (None, Some(budget)) => format!("at most {budget}"),
        (None, None) => String::new(),
    }
}

/// The part of the scene that pilots covered, with the loads that change after it; empty if they
/// covered all of it.
fn up_to(advice: &Advice) -> String {
    if advice.covers_the_scene() {
        return String::new();
    }
    let part = format!(
        " up to t = {} s of {} s",
        short(advice.measured.duration),
        short(advice.whole.duration)
    );
    match unseen_changes(advice) {
        Some(changes) => format!("{part}, before loads change at {changes}"),
        None => part,
    }
}

/// The instants after the covered part at which loads change.
fn unseen_changes(advice: &Advice) -> Option<String> {
    let instants = advice.unseen_changes.iter();
    let mut listed: Vec<String> = instants.map(|t| format!("{t} s")).collect();
    if listed.len() > LISTED_CHANGES {
        let more = listed.len() - LISTED_CHANGES;
        listed.truncate(LISTED_CHANGES);
        listed.push(format!("{more} later instants"));
    }
    let (last, before) = listed.split_last()?;
    Some(match before {
        [] => format!("t = {last}"),
        before => format!("t = {} and {last}", before.join(", ")),
    })
}

/// A run with its error and its cost.
fn run(advice: &Advice, pilot: &Pilot) -> String {
    let row = &pilot.row;
    let mut error = match row.error_in_percent() {
        Some(error) => format!("{error} %"),
        None => "none".to_owned(),
    };
    if row.expected_error.is_some() {
        error = format!(
            "{error}, {} % expected by {} s{},",
            expected(row),
            short(advice.whole.duration),
            if advice.unseen_changes.is_empty() {
                ""
            } else {
                " but for later loads"
            }
        );
    }
    format!(
        "{}, dt = {} ms (error {error} at {} CPU s/s)",
        row.label(),
        milliseconds(row.dt),
        three(row.cpu_s_per_s)
    )
}

/// The error expected over the whole scene (%).
fn expected(row: &Row) -> String {
    let expected = row.expected_error;
    expected.map_or_else(|| "none".to_owned(), percent)
}

fn ten_times_better(
    advice: &Advice,
    tolerance: f64,
    best: &Pilot,
    tenfold: Option<&Pilot>,
) -> String {
    let error = format!("{} %", short(10.0 * tolerance));
    let Some(tenfold) = tenfold else {
        return format!("ten times better ({error}): nothing measured reaches it");
    };
    if tenfold == best {
        return format!("ten times better ({error}): it already is");
    }
    let ratio = advice.total_cpu_s(tenfold) / advice.total_cpu_s(best);
    let beyond = match advice.question.budget {
        Some(budget) if tenfold.row.cpu_s_per_s > budget => ", beyond the budget",
        _ => "",
    };
    format!(
        "ten times better ({error}) costs {} times as much{beyond}: {}",
        three(ratio),
        run(advice, tenfold)
    )
}

/// The origin of the figures, and their limitations.
fn provenance(advice: &Advice) -> String {
    let (whole, measured) = (advice.whole.duration, advice.measured.duration);
    let mut lines = vec![format!(
        "{} pilot runs in {} s of CPU time, one thread of this machine; in all = set-up and {} s simulated",
        advice.pilots,
        three(advice.spent_s),
        short(whole)
    )];
    if !advice.covers_the_scene() {
        let unseen = unseen_changes(advice).map_or_else(String::new, |changes| {
            format!("; no short run covers the loads from {changes} on")
        });
        let later = if advice.stiffness_changes {
            "; large deformation changes the stiffness, and a step that is stable so far may not be so later"
        } else {
            ""
        };
        lines.push(format!(
            "errors, costs and verdicts are those of the first {} s of {} s, all that the time for pilots allows; \
             expected errors let phase errors grow on to {} s{unseen}{later}: raise --pilot-seconds to cover more",
            short(measured),
            short(whole),
            short(whole)
        ));
    }
    if advice.least_error > 0.0 {
        lines.push(format!(
            "reference: {}; itself within {} %, errors below {} % are shown as such",
            advice.reference,
            percent(advice.reference_error),
            percent(advice.least_error)
        ));
    }
    if let Err(reason) = &advice.written {
        lines.push(format!("the run as written was not measured: {reason}"));
    }
    lines.extend(left_out(&advice.refused));
    let what = match (advice.choice_cut_short, advice.others_cut_short) {
        (true, _) => Some("every candidate was tried, so there may be a cheaper one"),
        (false, true) => Some("all runners-up were followed to their own best"),
        (false, false) => None,
    };
    lines.extend(what.map(|what| {
        format!("the time for pilots ran out before {what}: raise --pilot-seconds to look further")
    }));
    lines.join("\n")
}

/// A line for each reason why methods were left out, with all these methods.
fn left_out(refused: &[(MethodChoice, LeftOut)]) -> Vec<String> {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (method, reason) in refused {
        let reason = reason.to_string();
        // Set-up names the method first, which would tell equal reasons apart.
        let named = format!("`{}`: ", method.integrator);
        let reason = reason.strip_prefix(&named).unwrap_or(&reason).to_owned();
        match reasons.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, methods)) => methods.push(method.label()),
            None => reasons.push((reason, vec![method.label()])),
        }
    }
    let line = |(reason, methods): (String, Vec<String>)| {
        format!("left out: {}: {reason}", methods.join(", "))
    };
    reasons.into_iter().map(line).collect()
}

fn table(advice: &Advice, rows: &[(&str, &Pilot)]) -> String {
    let mut table = ruled::table();
    let shown = |cells: [String; HEAD.len()]| {
        let cells = HEAD.into_iter().zip(cells);
        let cells = cells.filter(|(head, _)| *head != EXPECTED || !advice.covers_the_scene());
        cells.map(|(_, cell)| cell).collect::<Vec<String>>()
    };
    table.set_header(shown(HEAD.map(str::to_owned)));
    for (label, pilot) in rows {
        let row = &pilot.row;
        table.add_row(shown([
            (*label).to_owned(),
            row.label(),
            milliseconds(row.dt),
            row.error_in_percent().unwrap_or_else(|| "none".to_owned()),
            expected(row),
            three(row.cpu_s_per_s),
            three(row.setup_cpu_s),
            three(advice.total_cpu_s(pilot)),
            work(row),
            verdicts(row),
        ]));
    }
    let last = table.column_count().saturating_sub(1);
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if (2..last).contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<String> = table
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect();
    lines.join("\n")
}

/// Sweeps per simulated second, and solves if there are any.
fn work(row: &Row) -> String {
    let sweeps = short(row.sweeps_per_s);
    match row.work.solves {
        0 => sweeps,
        solves => {
            let simulated = row.steps as f64 * row.dt;
            format!("{sweeps} + {} solves", short(solves as f64 / simulated))
        }
    }
}

fn verdicts(row: &Row) -> String {
    if row.outcome == RowOutcome::Diverged {
        return "diverged".to_owned();
    }
    let mut words = vec![if row.bounded { "bounded" } else { "unbounded" }];
    words.push(if row.settles {
        "settles"
    } else {
        "does not settle"
    });
    if row.guarded {
        words.push("guarded");
    }
    words.join(", ")
}
