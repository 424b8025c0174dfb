//! Methods, precisions and threads of a bench over sizes.

use sinew_core::{OptionValue, Options};
use sinew_measure::MethodChoice;

use super::cube::SHARE;

/// Rule by which a method's step follows from the body.
#[derive(Clone, Copy, Debug)]
enum StepRule {
    /// At most this share of the critical step.
    Share(f64),
    /// This step (s), for any body.
    Fixed(f64),
}

/// Number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Threads {
    One,
    Several,
}

/// A method with precision and threads.
#[derive(Clone, Debug)]
pub(super) struct Variant {
    pub(super) name: &'static str,
    integrator: &'static str,
    options: Options,
    rule: StepRule,
    pub(super) precision: &'static str,
    pub(super) threads: Threads,
    /// True if it factorises a matrix; it is then no program.
    pub(super) factorises: bool,
}

/// Number of threads of runs with several.
const SEVERAL: usize = 2;

pub(super) fn has_several_threads() -> bool {
    sinew_machines::Threads::All.most() >= SEVERAL
}

/// All methods in all precisions and with all numbers of threads that they support.
pub(super) fn variants() -> Vec<Variant> {
    let two_step = Options::new()
        .with("kind", OptionValue::Text("two-step".into()))
        .with("tolerance", OptionValue::Number(1e-2));
    let programs = [
        (
            "central-difference",
            "central-difference",
            Options::new(),
            StepRule::Share(SHARE),
        ),
        (
            "cnn-stabilised",
            "cnn-stabilised",
            Options::new(),
            StepRule::Share(2.0 * SHARE),
        ),
        ("two-step", "propagator", two_step, StepRule::Fixed(5e-3)),
    ];
    let mut variants = Vec::new();
    for (name, integrator, options, rule) in programs {
        for precision in ["f64", "f32"] {
            for threads in [Threads::One, Threads::Several] {
                variants.push(Variant {
                    name,
                    integrator,
                    options: options.clone(),
                    rule,
                    precision,
                    threads,
                    factorises: false,
                });
            }
        }
    }
    variants.push(Variant {
        name: "newmark",
        integrator: "newmark",
        options: Options::new(),
        rule: StepRule::Fixed(1e-3),
        precision: "f64",
        threads: Threads::One,
        factorises: true,
    });
    variants
}

impl Threads {
    pub(super) fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Several => SEVERAL,
        }
    }
}

impl Variant {
    /// Method, precision and threads, as in `two-step, f32, 2 threads`.
    pub(super) fn label(&self) -> String {
        let threads = match self.threads {
            Threads::One => "1 thread".to_owned(),
            Threads::Several => format!("{SEVERAL} threads"),
        };
        format!("{}, {}, {threads}", self.name, self.precision)
    }

    /// The integrator with its options.
    pub(super) fn method(&self) -> MethodChoice {
        let method = MethodChoice::new(self.integrator);
        let mut options = self.options.clone();
        if !self.factorises {
            options.insert("precision", OptionValue::Text(self.precision.into()));
            options.insert("threads", OptionValue::Number(self.threads.count() as f64));
        }
        method.with_options(&options)
    }

    /// The step (s) on a body with this critical step (s): the longest that its rule allows and that meets
    /// all instants, `interval` (s) apart.
    pub(super) fn step(&self, critical: f64, interval: f64) -> f64 {
        let most = match self.rule {
            StepRule::Share(share) => share * critical,
            StepRule::Fixed(step) => step,
        };
        interval / (interval / most - 1e-9).ceil().max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_meet_the_instants_and_keep_to_their_share() {
        for variant in variants() {
            for (critical, steps) in [(2.02e-3, 11.0), (5.05e-4, 44.0), (3.3e-4, 67.0)] {
                let interval = steps * SHARE * critical;
                let dt = variant.step(critical, interval);
                let parts = interval / dt;
                assert!((parts - parts.round()).abs() < 1e-9);
                match variant.rule {
                    StepRule::Share(share) => {
                        assert!(
                            dt <= (1.0 + 1e-9) * share * critical && dt > 0.9 * share * critical
                        );
                    }
                    StepRule::Fixed(step) => assert!(dt <= step && dt > 0.75 * step),
                }
            }
        }
    }

    #[test]
    fn programs_run_in_both_precisions_and_factors_in_one() {
        let count = |name| variants().iter().filter(|v| v.name == name).count();
        assert_eq!(count("central-difference"), 4);
        assert_eq!(count("newmark"), 1);
    }
}
