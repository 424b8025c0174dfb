//! Required numbers that cannot be shown: JSON has no NaN and no infinity.

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer, Serialize};

use super::{CaseInfo, Row, RowOutcome};

/// A required number that is not finite.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Gap {
    /// The field that it belongs to.
    pub field: String,
    /// The text that replaces it, such as `inf`; `None` without such a text.
    pub value: Option<String>,
    /// Reason why it cannot be shown.
    pub reason: &'static str,
}

/// Gaps in the order of the fields.
#[derive(Default)]
struct Gaps(Vec<Gap>);

impl Gaps {
    fn number(&mut self, field: &str, value: f64) {
        if !value.is_finite() {
            self.0.push(Gap {
                field: field.to_owned(),
                value: Some(value.to_string()),
                reason: "it is not a finite number",
            });
        }
    }

    /// A number that may be absent.
    fn maybe(&mut self, field: &str, value: Option<f64>) {
        if let Some(value) = value {
            self.number(field, value);
        }
    }

    /// A number that every finished run has.
    fn finished(&mut self, field: &str, value: Option<f64>, outcome: RowOutcome) {
        match (value, outcome) {
            (None, RowOutcome::Finished) => self.0.push(Gap {
                field: field.to_owned(),
                value: None,
                reason: "the run finished and no finite number came of it",
            }),
            _ => self.maybe(field, value),
        }
    }

    fn named(&mut self, field: &str, values: &BTreeMap<String, f64>) {
        for (name, value) in values {
            self.number(&format!("{field}.{name}"), *value);
        }
    }
}

impl Row {
    /// The numbers of the run that are required and cannot be shown.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        // All fields by name, so that a new one is not forgotten here.
        let Self {
            case: _,
            integrator: _,
            material: _,
            options: _,
            kernel: _,
            dt,
            steps: _,
            sweeps_per_s,
            outcome,
            diverged_at_s,
            refusal: _,
            bounded: _,
            settles: _,
            error,
            error_is_below,
            force_error,
            expected_error,
            max_u,
            late_amplitude,
            saturated,
            guarded: _,
            inverted: _,
            overlap,
            work: _,
            cpu_s_per_s,
            us_per_step,
            setup_cpu_s,
            facts,
            step_over_critical,
            static_error,
            energy_drift,
            energy_rise,
            smallest_volume_ratio,
            mesh_error,
            cost_ratio,
            pareto: _,
        } = self;
        let mut gaps = Gaps::default();
        gaps.number("dt", *dt);
        gaps.number("sweeps_per_s", *sweeps_per_s);
        gaps.maybe("diverged_at_s", *diverged_at_s);
        gaps.finished("error", *error, *outcome);
        gaps.maybe("error_is_below", *error_is_below);
        gaps.maybe("force_error", *force_error);
        gaps.maybe("expected_error", *expected_error);
        gaps.finished("max_u", *max_u, *outcome);
        gaps.finished("late_amplitude", *late_amplitude, *outcome);
        gaps.number("saturated", *saturated);
        gaps.number("cpu_s_per_s", *cpu_s_per_s);
        gaps.number("us_per_step", *us_per_step);
        gaps.number("setup_cpu_s", *setup_cpu_s);
        gaps.named("facts", facts);
        gaps.maybe("step_over_critical", *step_over_critical);
        gaps.maybe("static_error", *static_error);
        gaps.maybe("energy_drift", *energy_drift);
        gaps.maybe("overlap", *overlap);
        gaps.maybe("energy_rise", *energy_rise);
        gaps.maybe("smallest_volume_ratio", *smallest_volume_ratio);
        gaps.maybe("mesh_error", *mesh_error);
        gaps.maybe("cost_ratio", *cost_ratio);
        gaps.0
    }
}

impl CaseInfo {
    /// The numbers of the case that are required and cannot be shown.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        let Self {
            id: _,
            title: _,
            remarks: _,
            dofs: _,
            duration_s,
            reference: _,
            reference_error,
            max_u_m,
            late_amplitude_m,
            critical_step_s,
            stable_steps_s,
        } = self;
        let mut gaps = Gaps::default();
        gaps.number("duration_s", *duration_s);
        gaps.number("reference_error", *reference_error);
        gaps.number("max_u_m", *max_u_m);
        gaps.number("late_amplitude_m", *late_amplitude_m);
        gaps.maybe("critical_step_s", *critical_step_s);
        gaps.named("stable_steps_s", stable_steps_s);
        gaps.0
    }
}

/// Reads a number, NaN for the `null` that replaces a number that could not be shown.
pub(super) fn null_is_nan<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(from)?.unwrap_or(f64::NAN))
}

/// Like [`null_is_nan`], for numbers with names.
pub(super) fn nulls_are_nan<'de, D>(from: D) -> Result<BTreeMap<String, f64>, D::Error>
where
    D: Deserializer<'de>,
{
    let numbers: BTreeMap<String, Option<f64>> = Deserialize::deserialize(from)?;
    let numbers = numbers.into_iter();
    Ok(numbers
        .map(|(name, number)| (name, number.unwrap_or(f64::NAN)))
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_named_and_what_may_be_missing_is_not() {
        let fine = Row {
            error: Some(0.1),
            max_u: Some(0.1),
            late_amplitude: Some(0.0),
            ..Row::default()
        };
        assert_eq!(fine.gaps(), []);
        let bad = Row {
            cpu_s_per_s: f64::NAN,
            max_u: Some(f64::INFINITY),
            error: None,
            facts: [("degree".to_owned(), f64::NEG_INFINITY)].into(),
            ..fine.clone()
        };
        let gaps = bad.gaps();
        let named: Vec<(&str, Option<&str>)> = gaps
            .iter()
            .map(|gap| (gap.field.as_str(), gap.value.as_deref()))
            .collect();
        assert_eq!(
            named,
            [
                ("error", None),
                ("max_u", Some("inf")),
                ("cpu_s_per_s", Some("NaN")),
                ("facts.degree", Some("-inf")),
            ]
        );
        let diverged = Row {
            outcome: RowOutcome::Diverged,
            error: None,
            max_u: None,
            late_amplitude: None,
            ..fine
        };
        assert_eq!(diverged.gaps(), []);
    }

    #[test]
    fn a_null_is_read_as_nan() {
        let row = Row {
            us_per_step: f64::INFINITY,
            facts: [("degree".to_owned(), f64::NAN)].into(),
            ..Row::default()
        };
        let json = serde_json::to_string(&row).unwrap();
        let read: Row = serde_json::from_str(&json).unwrap();
        assert!(read.us_per_step.is_nan() && read.facts["degree"].is_nan());
        let case = CaseInfo {
            max_u_m: f64::INFINITY,
            ..CaseInfo::default()
        };
        let json = serde_json::to_string(&case).unwrap();
        let read: CaseInfo = serde_json::from_str(&json).unwrap();
        assert!(read.max_u_m.is_nan());
    }
}
