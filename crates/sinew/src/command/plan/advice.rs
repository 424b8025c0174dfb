//! Advice in words.

use comfy_table::{CellAlignment, ContentArrangement, LineStyle, Table, TableStyle};
use sinew_measure::number::{milliseconds, percent, short, three};
use sinew_measure::search::Pilot;
use sinew_measure::{Advice, Answer, Outcome, Row};

const RULED_HEAD: TableStyle =
    TableStyle::new().header_separator(LineStyle::new('─', '─', '─', '─'));

const HEAD: [&str; 9] = [
    "",
    "method",
    "dt\n[ms]",
    "error\n[%]",
    "CPU\n[s/s]",
    "set-up\n[s]",
    "in all\n[s]",
    "work\n[sweeps/s]",
    "verdicts",
];

/// Rows of other integrators beneath the advised one.
const RUNNERS_UP: usize = 3;

/// The advice as people read it.
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
        && let Some(best) = cheapest.first()
    {
        paragraphs.push(ten_times_better(advice, best, tenfold.as_deref()));
    }
    paragraphs.push(provenance(advice));
    paragraphs.join("\n\n")
}

fn answer(advice: &Advice) -> String {
    let asked = asked(advice);
    match &advice.answer {
        Answer::Met { cheapest, .. } => match cheapest.first() {
            Some(best) => format!(
                "cheapest with {asked}: {}\n\n{}",
                run(best),
                advice.run_table(best).trim_end()
            ),
            None => format!("nothing measured has {asked}"),
        },
        Answer::Missed {
            within_tolerance,
            within_budget,
        } => {
            let nearest = [within_tolerance, within_budget];
            let mut nearest: Vec<String> = nearest
                .into_iter()
                .flatten()
                .map(|pilot| run(pilot))
                .collect();
            nearest.dedup();
            let text = match nearest.len() {
                0 => format!("nothing measured has {asked}"),
                _ => format!(
                    "nothing measured has {asked}; nearest: {}",
                    nearest.join(" or ")
                ),
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
    let tolerance = format!(
        "an error of at most {} %",
        short(100.0 * question.tolerance)
    );
    match question.budget {
        None => tolerance,
        Some(budget) => format!("{tolerance} within {} CPU s/s", short(budget)),
    }
}

/// A run with its error and its cost.
fn run(pilot: &Pilot) -> String {
    let row = &pilot.row;
    format!(
        "{}, dt = {} ms (error {} at {} CPU s/s)",
        row.label(),
        milliseconds(row.dt),
        error_with_unit(row),
        three(row.cpu_s_per_s)
    )
}

fn error_with_unit(row: &Row) -> String {
    match row.error {
        Some(_) => format!("{} %", error(row)),
        None => error(row),
    }
}

fn error(row: &Row) -> String {
    row.error.map_or_else(|| "none".to_owned(), percent)
}

fn ten_times_better(advice: &Advice, best: &Pilot, tenfold: Option<&Pilot>) -> String {
    let error = format!("{} %", short(10.0 * advice.question.tolerance));
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
        run(tenfold)
    )
}

/// How the figures came about, and what they do not say.
fn provenance(advice: &Advice) -> String {
    let (whole, measured) = (advice.whole.duration, advice.measured.duration);
    let mut lines = vec![format!(
        "{} pilot runs in {} s of CPU time, one thread of this machine; in all = set-up and {} s simulated",
        advice.pilots,
        three(advice.spent_s),
        short(whole)
    )];
    if measured < whole {
        lines.push(format!(
            "errors and costs are those of the first {} s of {} s, all that the time for pilots allows; \
             phase errors grow with time, and later loads are not in them: --pilot-seconds follows more",
            short(measured),
            short(whole)
        ));
    }
    if let Err(reason) = &advice.written {
        lines.push(format!("the run as written was not measured: {reason}"));
    }
    for (method, reason) in &advice.refused {
        lines.push(format!("cannot run here: {}: {reason}", method.label()));
    }
    let what = match (advice.choice_cut_short, advice.others_cut_short) {
        (true, _) => Some("every candidate was followed, so that there may be something cheaper"),
        (false, true) => Some("all runners-up were followed to their own best"),
        (false, false) => None,
    };
    lines.extend(what.map(|what| {
        format!("the time for pilots ran out before {what}: --pilot-seconds looks further")
    }));
    lines.join("\n")
}

fn table(advice: &Advice, rows: &[(&str, &Pilot)]) -> String {
    let mut table = Table::new();
    table
        .load_style(RULED_HEAD)
        .set_content_arrangement(ContentArrangement::Disabled)
        .set_header(HEAD);
    for (label, pilot) in rows {
        let row = &pilot.row;
        table.add_row([
            (*label).to_owned(),
            row.label(),
            milliseconds(row.dt),
            error(row),
            three(row.cpu_s_per_s),
            three(row.setup_cpu_s),
            three(advice.total_cpu_s(pilot)),
            work(row),
            verdicts(row),
        ]);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if (2..8).contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<String> = table
        .lines()
        .map(|line| line.trim_end().to_owned())
        .collect();
    lines.join("\n")
}

/// Sweeps per simulated second, and solves where there are any.
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
    if row.outcome == Outcome::Diverged {
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
