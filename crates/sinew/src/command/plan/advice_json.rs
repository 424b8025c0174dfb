//! Advice as JSON.

use serde_json::{Value, json};
use sinew_measure::search::Pilot;
use sinew_measure::{Advice, Answer, RowOutcome};

/// Advice as one JSON object. Each `null` in it is named, with its reason, in the list `missing`.
pub(super) struct AdviceJson {
    /// The object.
    pub(super) object: Value,
    /// Sentences about numbers that should be in the object and cannot be shown.
    pub(super) gaps: Vec<String>,
}

/// The fields that are missing from the object, by their paths.
#[derive(Default)]
struct Missing {
    list: Vec<Value>,
    gaps: Vec<String>,
}

impl Missing {
    /// Adds a field that is null for a good reason.
    fn explain(&mut self, field: impl Into<String>, reason: &str) {
        self.list
            .push(json!({ "field": field.into(), "reason": reason }));
    }

    /// Adds a number that should be in the object and cannot be shown.
    fn gap(&mut self, field: &str, value: Option<&str>, reason: &str) {
        let mut entry = json!({ "field": field, "reason": reason });
        if let (Some(entry), Some(value)) = (entry.as_object_mut(), value) {
            entry.insert("value".to_owned(), value.into());
        }
        self.list.push(entry);
        let is = value.map_or_else(String::new, |value| format!(" = {value}"));
        self.gaps.push(format!("{field}{is}: {reason}"));
    }

    fn run(&mut self, path: &str, advice: &Advice, pilot: &Pilot) -> Value {
        let row = &pilot.row;
        for gap in row.gaps() {
            let field = format!("{path}.row.{}", gap.field);
            self.gap(&field, gap.value.as_deref(), gap.reason);
        }
        if row.outcome == RowOutcome::Diverged {
            for (field, value) in [
                ("error", row.error),
                ("max_u", row.max_u),
                ("late_amplitude", row.late_amplitude),
            ] {
                if value.is_none() {
                    self.explain(format!("{path}.row.{field}"), "the run diverged");
                }
            }
        }
        let total = advice.total_cpu_s(pilot);
        if !total.is_finite() {
            let field = format!("{path}.total_cpu_s");
            self.gap(
                &field,
                Some(&total.to_string()),
                "it is not a finite number",
            );
        }
        json!({
            "row": row,
            "total_cpu_s": total,
            "run_table": advice.run_table(pilot),
        })
    }

    fn maybe(&mut self, path: &str, advice: &Advice, pilot: Option<&Pilot>, reason: &str) -> Value {
        match pilot {
            Some(pilot) => self.run(path, advice, pilot),
            None => {
                self.explain(path, reason);
                Value::Null
            }
        }
    }
}

/// Turns advice into JSON. `met` is true only if the measured error of the advised run is within the tolerance over the
/// whole scene; `met_until_s` is the time up to which it is, `unseen_load_changes_s` lists the later changes of loads,
/// and a row's `error_is_below` is a bound if its error is too small for the reference; `reference_error` is the
/// reference's own error.
pub(super) fn as_json(advice: &Advice) -> AdviceJson {
    let mut missing = Missing::default();
    let refused = advice.refused.iter();
    let refused: Vec<Value> = refused
        .map(|(method, reason)| json!({ "method": method.label(), "reason": reason.to_string() }))
        .collect();
    if advice.question.tolerance.is_none() {
        missing.explain("tolerance", "no tolerance was asked for");
    }
    if advice.question.budget.is_none() {
        missing.explain("budget_cpu_s_per_s", "no budget was asked for");
    }
    let met_until = advice.met_until();
    if met_until.is_none() {
        missing.explain("met_until_s", "nothing measured keeps to what was asked");
    }
    let reason = advice.written.as_ref().err().map(ToString::to_string);
    let written = advice.written.as_ref().ok();
    let written = missing.maybe("as_written", advice, written, &reason.unwrap_or_default());
    let answer = match &advice.answer {
        Answer::Met { cheapest, tenfold } => {
            let others = cheapest.iter().skip(1).enumerate();
            let runners_up: Vec<Value> = others
                .map(|(index, pilot)| missing.run(&format!("runners_up.{index}"), advice, pilot))
                .collect();
            json!({
                "met": advice.covers_the_scene(),
                "advised": missing.maybe(
                    "advised",
                    advice,
                    cheapest.first(),
                    "nothing measured keeps to what was asked",
                ),
                "runners_up": runners_up,
                "ten_times_better": missing.maybe(
                    "ten_times_better",
                    advice,
                    tenfold.as_deref(),
                    match advice.question.tolerance {
                        Some(_) => "nothing measured reaches a tenth of the tolerance",
                        None => "no tolerance was asked for",
                    },
                ),
            })
        }
        Answer::Missed {
            within_tolerance,
            within_budget,
        } => json!({
            "met": false,
            "within_tolerance": missing.maybe(
                "within_tolerance",
                advice,
                within_tolerance.as_deref(),
                match advice.question.tolerance {
                    Some(_) => "nothing measured is within the tolerance",
                    None => "no tolerance was asked for",
                },
            ),
            "within_budget": missing.maybe(
                "within_budget",
                advice,
                within_budget.as_deref(),
                "no sound run is within the budget",
            ),
        }),
    };
    let mut object = json!({
        "tolerance": advice.question.tolerance,
        "budget_cpu_s_per_s": advice.question.budget,
        "duration_s": advice.whole.duration,
        "measured_s": advice.measured.duration,
        "met_until_s": met_until,
        "stiffness_changes": advice.stiffness_changes,
        "unseen_load_changes_s": advice.unseen_changes,
        "reference": advice.reference,
        "reference_error": advice.reference_error,
        "pilots": advice.pilots,
        "spent_cpu_s": advice.spent_s,
        "choice_cut_short": advice.choice_cut_short,
        "others_cut_short": advice.others_cut_short,
        "refused": refused,
        "as_written": written,
        "missing": missing.list,
    });
    if let (Some(object), Value::Object(answer)) = (object.as_object_mut(), answer) {
        object.extend(answer);
    }
    AdviceJson {
        object,
        gaps: missing.gaps,
    }
}

#[cfg(test)]
mod tests {
    use sinew_measure::{Cost, MethodChoice, NotMeasured, Question, Row, Span};

    use super::*;

    fn pilot(row: Row) -> Pilot {
        Pilot {
            method: MethodChoice::new("rk4"),
            row: Row {
                integrator: "rk4".into(),
                dt: 0.01,
                steps: 100,
                ..row
            },
        }
    }

    fn advice(answer: Answer, written: Result<Pilot, NotMeasured>) -> Advice {
        let span = Span {
            duration: 1.0,
            samples: 10,
        };
        Advice {
            question: Question {
                tolerance: Some(0.01),
                budget: None,
                pilot_seconds: 10.0,
                cost: Cost::CpuTime,
            },
            whole: span,
            measured: span,
            stiffness_changes: false,
            unseen_changes: Vec::new(),
            reference: "a closed form".to_owned(),
            reference_error: 1e-12,
            least_error: 0.0,
            written,
            answer,
            refused: Vec::new(),
            pilots: 2,
            spent_s: 0.1,
            choice_cut_short: false,
            others_cut_short: false,
        }
    }

    /// The paths of all null fields.
    fn nulls(path: &str, value: &Value, found: &mut Vec<String>) {
        let below = |name: &str| match path {
            "" => name.to_owned(),
            path => format!("{path}.{name}"),
        };
        match value {
            Value::Null => found.push(path.to_owned()),
            Value::Array(values) => {
                for (index, value) in values.iter().enumerate() {
                    nulls(&below(&index.to_string()), value, found);
                }
            }
            Value::Object(entries) => {
                for (name, value) in entries {
                    nulls(&below(name), value, found);
                }
            }
            _ => {}
        }
    }

    fn check(advice: &Advice) -> AdviceJson {
        let said = as_json(advice);
        let mut found = Vec::new();
        nulls("", &said.object, &mut found);
        let missing = said.object["missing"].as_array().unwrap().iter();
        let mut named: Vec<&str> = missing
            .map(|entry| {
                assert!(!entry["reason"].as_str().unwrap().is_empty());
                entry["field"].as_str().unwrap()
            })
            .collect();
        found.sort();
        named.sort_unstable();
        assert_eq!(found, named);
        said
    }

    #[test]
    fn every_null_has_a_reason() {
        let sound = pilot(Row {
            error: Some(1e-3),
            max_u: Some(1.0),
            late_amplitude: Some(0.0),
            ..Row::default()
        });
        let diverged = pilot(Row {
            outcome: RowOutcome::Diverged,
            ..Row::default()
        });
        let met = Answer::Met {
            cheapest: vec![sound],
            tenfold: None,
        };
        let said = check(&advice(met, Ok(diverged)));
        assert_eq!(said.gaps, [] as [String; 0]);
        let missed = Answer::Missed {
            within_tolerance: None,
            within_budget: None,
        };
        let said = check(&advice(missed, Err(NotMeasured::TooLong)));
        let missing = said.object["missing"].to_string();
        assert!(
            missing.contains("too little time for other pilots"),
            "{missing}"
        );
        assert_eq!(said.gaps, [] as [String; 0]);
    }

    #[test]
    fn a_number_that_cannot_be_shown_is_named_with_what_it_is() {
        let odd = pilot(Row {
            error: Some(1e-3),
            max_u: Some(f64::INFINITY),
            late_amplitude: Some(0.0),
            cpu_s_per_s: f64::NAN,
            ..Row::default()
        });
        let met = Answer::Met {
            cheapest: vec![odd.clone(), odd],
            tenfold: None,
        };
        let said = check(&advice(met, Err(NotMeasured::TooLong)));
        assert_eq!(
            said.gaps[3..],
            [
                "advised.row.max_u = inf: it is not a finite number",
                "advised.row.cpu_s_per_s = NaN: it is not a finite number",
                "advised.total_cpu_s = NaN: it is not a finite number",
            ]
        );
        assert_eq!(said.gaps.len(), 6);
    }
}
