//! A mark for several runs, each of which ends in a checked state or in a refusal that names the fault.

use super::follow::{Followed, Planned};
use crate::hard::mark::{Asked, Worst};
use crate::report::three;
use crate::results::Mark;

/// Rounding of energies, over the largest of them.
pub(super) const ROUNDING: f64 = 1e-12;

/// Energy above that of start and loads, over the largest allowed, that methods without a guarantee need not report:
/// the threshold above which implicit methods report it.
pub(super) const LITTLE: f64 = 0.05;

/// Requirement for a run that reaches its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand {
    /// Description of the figure.
    pub(crate) what: &'static str,
    pub(crate) figure: f64,
    /// The largest figure that passes.
    pub(crate) limit: f64,
}

impl Demand {
    /// A figure, and the largest one that passes.
    pub(crate) fn new(what: &'static str, figure: f64, limit: f64) -> Self {
        Self {
            what,
            figure,
            limit,
        }
    }
}

/// Runs and their outcomes.
#[derive(Default)]
pub(crate) struct Tally {
    /// Figures over their limits.
    worst: Worst,
    right: usize,
    /// Descriptions of reported outcomes.
    told: Vec<String>,
    /// Descriptions of errors that must not occur.
    faults: Vec<String>,
}

impl Tally {
    /// Evaluates a run: it meets a demand, or reports that it does not. A refusal of a run that has to reach its end is
    /// a fault, and so is a refusal without a name.
    pub(crate) fn judge(&mut self, about: &str, planned: &Planned, run: &Followed, demand: Demand) {
        let label = format!("{about}: {}", planned.label());
        match &run.refusal {
            Some(reason) if planned.must_end || !is_named(reason) => {
                self.faults.push(format!("{label}: {reason}"));
            }
            Some(reason) => self.told.push(format!("{label}: {reason}")),
            None if planned.must_end => self.demand(label, demand),
            None if demand.figure <= demand.limit => self.demand(label, demand),
            None => match run.admits() {
                Some(words) => self.told.push(format!("{label}: {words}")),
                None => self.demand(label, demand),
            },
        }
    }

    /// Compares a figure that belongs to no run with a demand.
    pub(crate) fn demand(&mut self, label: String, demand: Demand) {
        let what = format!("{label}: {} {}", demand.what, three(demand.figure));
        // False for what is not a number.
        self.right += usize::from(demand.figure <= demand.limit);
        self.worst.include(demand.figure / demand.limit, what);
    }

    /// Records a fault.
    pub(crate) fn fault(&mut self, what: String) {
        self.faults.push(what);
    }

    /// The mark, from the figure that is nearest to its limit or farthest beyond.
    pub(crate) fn mark(self, asked: Asked) -> Mark {
        let shown = |share: f64| format!("{} of what is allowed", three(share));
        let faults = self.faults.iter().map(|fault| format!("FAULT {fault}"));
        let mut notes: Vec<String> = faults.collect();
        notes.push(format!("{} figures are right", self.right));
        if !self.told.is_empty() {
            notes.push(format!("told by name: {}", self.told.join("; ")));
        }
        asked
            .measured(self.worst.figure, shown, self.worst.by)
            .and(self.faults.is_empty() && self.right > 0)
            .noting(notes.join("; "))
    }
}

/// True if a refusal names the cause or its place: an element, a node or a method.
fn is_named(reason: &str) -> bool {
    let names = ["element", "node", "`"];
    names.iter().any(|name| reason.contains(name))
}
