//! Counts of the solutions of equations, with a description for reports.

/// Reasons why a step that began without a factor continues with one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reason {
    /// Conjugate gradients would take longer.
    Work,
    /// The tangent is not positive definite.
    Indefinite,
    /// The directions gave no progress.
    Stuck,
}

impl Reason {
    const ALL: [Self; 3] = [Self::Work, Self::Indefinite, Self::Stuck];

    /// The reason, to follow "since".
    fn in_words(self) -> &'static str {
        match self {
            Self::Work => "they would have taken longer",
            Self::Indefinite => "the tangent was not positive definite",
            Self::Stuck => "they led nowhere",
        }
    }
}

/// Counts of solutions and steps so far.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// Solutions by conjugate gradients, and iterations that these took.
    pub(super) solutions: u64,
    pub(super) iterations: u64,
    /// Steps, and those that continued with a factor, by reason.
    pub(super) steps: u64,
    went_on: [u64; Reason::ALL.len()],
}

impl Counts {
    /// Counts a step that continues with a factor.
    pub(super) fn went_on(&mut self, reason: Reason) {
        self.went_on[reason as usize] += 1;
    }

    /// Mean iterations of a solution, if there was any.
    pub(super) fn iterations_a_solution(&self) -> Option<f64> {
        (self.solutions > 0).then(|| self.iterations as f64 / self.solutions as f64)
    }

    /// Description of how equations were solved.
    pub(super) fn in_words(&self) -> String {
        let Some(iterations) = self.iterations_a_solution() else {
            return "each iteration made a factor: conjugate gradients would take longer in steps of this length on this body".to_owned();
        };
        let mut text = format!("conjugate gradients took {iterations:.1} iterations a solution");
        for reason in Reason::ALL {
            let (count, steps) = (self.went_on[reason as usize], self.steps);
            if count > 0 {
                let reason = reason.in_words();
                text +=
                    &format!("; {count} of {steps} steps went on with a factor, since {reason}");
            }
        }
        text
    }
}
