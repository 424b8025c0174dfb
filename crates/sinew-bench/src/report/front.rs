//! A case's Pareto front in sentences.

use sinew_integrators::Scheme;
use sinew_integrators::cnn::Cnn;
use sinew_integrators::implicit::Modal;
use sinew_measure::{CaseInfo, Row};

use super::number;
use super::work_precision::LEAST_SHOWN_ERROR;
use crate::results::BenchResults;

/// The paper's network.
const PAPER: &str = Cnn::ID;
/// The global method with which local ones are compared.
const NON_LOCAL: &str = Modal::ID;
/// Errors (fraction) below which they are compared.
const COMPARED_BELOW: f64 = 0.01;

/// A method on the front.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontMember {
    /// The method with its options.
    pub label: String,
    /// A sentence with the errors for which it is the cheapest, its steps and its work.
    pub says: String,
    /// One line about the method.
    pub summary: String,
}

/// The methods on a case's front, the cheapest first.
#[must_use]
pub fn front_members(results: &BenchResults, case: &str) -> Vec<FrontMember> {
    let mut front: Vec<&Row> = results.rows_of(case).filter(|row| row.pareto).collect();
    front.sort_by(|a, b| a.cpu_s_per_s.total_cmp(&b.cpu_s_per_s));
    let good_enough = |row: &&Row| row.error.is_some_and(|error| error <= LEAST_SHOWN_ERROR);
    if let Some(best) = front.iter().position(good_enough) {
        front.truncate(best + 1);
    }
    // Runs in a row of one method are one member: for errors from that of the run before it on.
    let mut groups: Vec<Vec<&Row>> = Vec::new();
    for row in front {
        match groups.last_mut() {
            Some(group) if group[0].label() == row.label() => group.push(row),
            _ => groups.push(vec![row]),
        }
    }
    let mut above = None;
    groups
        .iter()
        .map(|group| {
            let member = member(group, above);
            above = group.last().and_then(|row| row.error_at_most());
            member
        })
        .collect()
}

fn member(group: &[&Row], above: Option<f64>) -> FrontMember {
    let (first, last) = (group[0], group[group.len() - 1]);
    let error = |row: &Row| format!("{} %", row.error_in_percent().unwrap_or_default());
    let least = error(last);
    let errors = match above.map(|error| format!("{} %", number::percent(error))) {
        None => format!("errors down to {least}"),
        Some(from) if from == least => format!("an error of {least}"),
        Some(from) => format!("errors from {from} down to {least}"),
    };
    let steps = match group.len() {
        1 => format!("a step of {} ms", number::milliseconds(first.dt)),
        _ => format!(
            "steps of {} to {} ms",
            number::milliseconds(first.dt),
            number::milliseconds(last.dt)
        ),
    };
    let sweeps = |row: &Row| number::short(row.sweeps_per_s);
    let work = range(sweeps(first), sweeps(last), "");
    let entry = sinew_integrators::entry(&first.integrator);
    FrontMember {
        label: first.label(),
        says: format!(
            "the cheapest for {errors}, in {steps}, with {work} sweeps per simulated second"
        ),
        summary: entry.map_or_else(String::new, |entry| entry.summary.to_owned()),
    }
}

/// A sentence on the paper's network beyond forward Euler's limit; `None` if it did not run there.
#[must_use]
pub fn paper_sentence(results: &BenchResults, case: &CaseInfo) -> Option<String> {
    let rows = || {
        results
            .rows_of(&case.id)
            .filter(|row| row.integrator == PAPER)
    };
    let label = rows().next()?.label();
    let limit = *case.stable_steps_s.get(&label)?;
    let beyond: Vec<&Row> = rows().filter(|row| row.dt > limit).collect();
    if beyond.is_empty() {
        return None;
    }
    let beyond_it = match limit {
        0.0 => "here, where no step of forward Euler is stable".to_owned(),
        limit => format!(
            "beyond forward Euler's limit of {} ms",
            number::milliseconds(limit)
        ),
    };
    let on_it: Vec<&&Row> = beyond.iter().filter(|row| row.pareto).collect();
    if let Some(row) = on_it.first() {
        return Some(format!(
            "The paper's network ({PAPER}) is on the front {beyond_it}: at {} ms with an error of {} %.",
            number::milliseconds(row.dt),
            row.error_in_percent().unwrap_or_default()
        ));
    }
    let errors = beyond.iter().filter_map(|row| row.error);
    let (least, largest) = errors.fold((f64::INFINITY, 0.0_f64), |(low, high), error| {
        (low.min(error), high.max(error))
    });
    let finished = beyond.iter().filter(|row| row.error.is_some()).count();
    let runs = match beyond.len() {
        1 => "its one run there".to_owned(),
        count => format!("its {count} runs there"),
    };
    let found = match (finished, beyond.len()) {
        (0, 1) => format!("{runs} diverges"),
        (0, _) => format!("all {runs} diverge").replace("all its", "all of its"),
        (1, 1) => format!("{runs} has an error of {} %", number::percent(least)),
        (1, _) => format!(
            "of {runs} one ends, with an error of {} %",
            number::percent(least)
        ),
        (all, count) => format!(
            "{runs} have errors of {}{}",
            range(number::percent(least), number::percent(largest), " %"),
            if all < count { ", or diverge" } else { "" }
        ),
    };
    Some(format!(
        "The paper's network ({PAPER}) is on no front {beyond_it}: {found}."
    ))
}

/// The two ends of a range, or one value if both are equal.
fn range(low: String, high: String, unit: &str) -> String {
    if low == high {
        format!("{low}{unit}")
    } else {
        format!("{low}{unit} to {high}{unit}")
    }
}

/// A sentence that compares local methods with `modal` below 1 %, set-up included.
#[must_use]
pub fn modal_sentence(results: &BenchResults, case: &CaseInfo) -> Option<String> {
    let total = |row: &Row| row.total_cpu_s(case.duration_s);
    let (modal, local): (Vec<&Row>, Vec<&Row>) = results
        .rows_of(&case.id)
        .filter(|row| total(row).is_finite())
        .partition(|row| row.integrator == NON_LOCAL);
    let mut ratios = Vec::new();
    let mut wins = Vec::new();
    for row in modal {
        let Some(error) = row.sound_error().filter(|error| *error < COMPARED_BELOW) else {
            continue;
        };
        let as_good = local
            .iter()
            .filter(|other| other.sound_error().is_some_and(|e| e <= error));
        let cheapest = as_good
            .map(|other| total(other))
            .fold(f64::INFINITY, f64::min);
        let ratio = total(row) / cheapest;
        if ratio < 1.0 {
            wins.push(format!(
                "at {} ms (error {} %)",
                number::milliseconds(row.dt),
                number::percent(error)
            ));
        }
        ratios.push(ratio);
    }
    let (least, most) = ratios
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), ratio| {
            (low.min(*ratio), high.max(*ratio))
        });
    if ratios.is_empty() {
        return None;
    }
    let duration = number::short(case.duration_s);
    if wins.len() == ratios.len() {
        wins = vec!["at every step".to_owned()];
    }
    if wins.is_empty() {
        return Some(format!(
            "Below 1 % local methods hold every point against {NON_LOCAL}: set-up included, for \
             {duration} s, one of at most the same error costs {} times less.",
            range(number::two(least), number::two(most), "")
        ));
    }
    Some(format!(
        "Below 1 %, set-up included, for {duration} s, {NON_LOCAL} is cheaper than every local method of at \
         most the same error {}.",
        wins.join(", ")
    ))
}

/// Members and sentences as plain lines.
pub(super) fn lines(results: &BenchResults, case: &str) -> Vec<String> {
    let mut lines: Vec<String> = front_members(results, case)
        .into_iter()
        .map(|member| format!("{}: {} ({})", member.label, member.says, member.summary))
        .collect();
    lines.extend(sentences(results, case));
    lines
}

/// The sentences on the paper's network and on modal.
pub(super) fn sentences(results: &BenchResults, case: &str) -> Vec<String> {
    let Some(info) = results.case(case) else {
        return Vec::new();
    };
    let sentences = [paper_sentence(results, info), modal_sentence(results, info)];
    sentences.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use sinew_measure::mark_pareto;

    use super::*;
    use sinew_verify::Machine;

    fn row(integrator: &str, dt: f64, cpu_s_per_s: f64, error: f64) -> Row {
        Row {
            case: "a".into(),
            integrator: integrator.into(),
            dt,
            cpu_s_per_s,
            error: Some(error),
            bounded: true,
            sweeps_per_s: 1.0 / dt,
            ..Row::default()
        }
    }

    fn results(rows: Vec<Row>) -> BenchResults {
        let mut results = BenchResults::new("", Machine::default());
        results.cases.push(CaseInfo {
            id: "a".into(),
            duration_s: 2.0,
            stable_steps_s: BTreeMap::from([("cnn".to_owned(), 0.001)]),
            ..CaseInfo::default()
        });
        results.rows = rows;
        mark_pareto(&mut results.rows);
        results
    }

    #[test]
    fn members_share_the_errors_among_them() {
        let results = results(vec![
            row("rk4", 0.001, 9.0, 1e-6),
            row("newmark", 0.02, 1.0, 0.1),
            row("newmark", 0.01, 2.0, 0.01),
            row("symplectic-euler", 0.01, 3.0, 0.5),
            row("rk4", 0.0001, 90.0, 1e-10),
            row("newmark", 0.0001, 91.0, 1e-11),
        ]);
        let members = front_members(&results, "a");
        let said: Vec<(&str, &str)> = members
            .iter()
            .map(|member| (member.label.as_str(), member.says.as_str()))
            .collect();
        assert_eq!(
            said,
            [
                (
                    "newmark",
                    "the cheapest for errors down to 1.00 %, in steps of 20 to 10 \
                     ms, with 50 to 100 sweeps per simulated second"
                ),
                (
                    "rk4",
                    "the cheapest for errors from 1.00 % down to 1.00e-8 %, in steps of 1 to 0.1 ms, \
                     with 1000 to 10000 sweeps per simulated second"
                ),
            ]
        );
        assert!(members[1].summary.contains("order 4"), "{members:?}");
    }

    #[test]
    fn the_papers_network_is_judged_beyond_its_limit() {
        let said = |rows| {
            let results = results(rows);
            paper_sentence(&results, &results.cases[0])
        };
        assert_eq!(said(vec![row("cnn", 0.0005, 1.0, 0.01)]), None);
        assert_eq!(
            said(vec![
                row("cnn", 0.02, 1.0, 25.2),
                row("cnn", 0.01, 2.0, 9.99)
            ])
            .unwrap(),
            "The paper's network (cnn) is on no front beyond forward Euler's limit of 1 ms: its 2 \
             runs there have errors of 999 % to 2520 %."
        );
        assert_eq!(
            said(vec![row("cnn", 0.02, 1.0, 280.0)]).unwrap(),
            "The paper's network (cnn) is on no front beyond forward Euler's limit of 1 ms: its one \
             run there has an error of 28000 %."
        );
        let diverged = || Row {
            error: None,
            ..row("cnn", 0.02, 1.0, 0.0)
        };
        let all = said(vec![diverged(), diverged()]).unwrap();
        assert!(
            all.ends_with("ms: all of its 2 runs there diverge."),
            "{all}"
        );
        let some = said(vec![diverged(), row("cnn", 0.02, 1.0, 280.0)]).unwrap();
        assert!(
            some.ends_with("of its 2 runs there one ends, with an error of 28000 %."),
            "{some}"
        );
        let same = said(vec![
            row("cnn", 0.02, 1.0, 280.0),
            row("cnn", 0.01, 1.0, 280.01),
        ]);
        assert!(same.unwrap().ends_with("have errors of 28000 %."));
        let on_it = said(vec![row("cnn", 0.02, 1.0, 0.5)]).unwrap();
        assert!(on_it.contains("is on the front beyond"), "{on_it}");
    }

    #[test]
    fn a_limit_of_zero_is_said_in_words() {
        let mut results = results(vec![row("cnn", 0.02, 1.0, 25.2)]);
        results.cases[0].stable_steps_s.insert("cnn".into(), 0.0);
        assert_eq!(
            paper_sentence(&results, &results.cases[0]).unwrap(),
            "The paper's network (cnn) is on no front here, where no step of forward Euler is stable: \
             its one run there has an error of 2520 %."
        );
    }

    #[test]
    fn modal_is_compared_with_its_set_up() {
        let said = |setup| {
            let mut modal = row("modal", 0.01, 1.0, 0.005);
            modal.setup_cpu_s = setup;
            let results = results(vec![modal, row("newmark", 0.01, 2.0, 0.004)]);
            modal_sentence(&results, &results.cases[0]).unwrap()
        };
        // 2 s of modal cost 2 and its set-up, of newmark 4.
        assert_eq!(
            said(10.0),
            "Below 1 % local methods hold every point against modal: set-up included, for 2 s, one of \
             at most the same error costs 3.0 times less."
        );
        assert_eq!(
            said(1.0),
            "Below 1 %, set-up included, for 2 s, modal is cheaper than every local method of at most \
             the same error at every step."
        );
    }
}
