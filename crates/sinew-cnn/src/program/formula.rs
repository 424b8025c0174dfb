//! Sweeps and updates as lines of formulas.

use super::number::significant;
use super::{
    Clamp, Forces, LoadAt, Loads, OwnTerm, Program, Quotient, Register, Sweep, Update, Weight, When,
};

/// Coefficient of a term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Coefficient {
    Number(f64),
    /// A moment of a load over the step, by its number.
    Moment(u32),
}

/// A formula: words, a sum of terms with their coefficients, words.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) head: String,
    pub(super) terms: Vec<(Coefficient, String)>,
    pub(super) tail: String,
}

/// A sweep in formulas.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lines {
    /// Steps that execute it, if these are not all.
    pub(super) when: Option<String>,
    /// The sweep's q, then the updates in order.
    pub(super) lines: Vec<Line>,
    /// Description of the time of the loads.
    pub(super) loads: Option<&'static str>,
}

impl Coefficient {
    pub(super) fn text(self, digits: usize) -> String {
        match self {
            Self::Number(number) => significant(number, digits),
            Self::Moment(moment) => format!("m_{moment}"),
        }
    }
}

impl Line {
    /// The line with numbers of this many significant digits.
    pub(super) fn text(&self, digits: usize) -> String {
        let mut sum = String::new();
        for (coefficient, of) in &self.terms {
            let negative =
                matches!(coefficient, Coefficient::Number(number) if number.is_sign_negative());
            sum.push_str(match (sum.is_empty(), negative) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            });
            let size = match coefficient {
                Coefficient::Number(number) => Coefficient::Number(number.abs()),
                Coefficient::Moment(_) => *coefficient,
            };
            if size != Coefficient::Number(1.0) {
                sum.push_str(&size.text(digits));
                sum.push(' ');
            }
            sum.push_str(of);
        }
        if self.terms.is_empty() {
            sum.push('0');
        }
        format!("{}{sum}{}", self.head, self.tail)
    }

    /// True if both lines differ at most in coefficients.
    fn is_like(&self, other: &Self) -> bool {
        let of = |line: &Self| -> Vec<String> {
            let terms = line.terms.iter();
            terms.map(|(_, of)| of.clone()).collect()
        };
        self.head == other.head && self.tail == other.tail && of(self) == of(other)
    }
}

impl Lines {
    /// True if both sweeps differ at most in coefficients.
    pub(super) fn are_like(&self, other: &Self) -> bool {
        let pairs = || self.lines.iter().zip(&other.lines);
        self.when == other.when
            && self.loads == other.loads
            && self.lines.len() == other.lines.len()
            && pairs().all(|(line, other)| line.is_like(other))
    }
}

impl Program {
    /// A sweep in formulas.
    pub(super) fn lines(&self, sweep: &Sweep, digits: usize) -> Lines {
        let mut lines = Vec::new();
        let rho = self.rho(sweep);
        if !rho.is_empty() {
            let (head, tail) = match sweep.quotient {
                Quotient::Plain => ("q = ", ""),
                Quotient::Mass => ("q = M^-1 (", ")"),
                Quotient::Blocks => ("q = P^-1 (", ")"),
            };
            lines.push(Line {
                head: head.into(),
                terms: rho,
                tail: tail.into(),
            });
        }
        for update in &sweep.updates {
            lines.extend(self.update_lines(update, digits));
        }
        Lines {
            when: match sweep.when {
                When::Always => None,
                When::LoadChanges(load) => Some(format!("where load {} changes", load + 1)),
                When::LoadsJump => Some("where a load jumps at t".into()),
            },
            lines,
            loads: match (sweep.loads, sweep.forces) {
                (Loads::All { at, .. }, _) => Some(taken(at)),
                (_, Forces::Internal { .. }) => Some(taken(LoadAt::StartOf)),
                _ => None,
            },
        }
    }

    /// The terms of rho.
    fn rho(&self, sweep: &Sweep) -> Vec<(Coefficient, String)> {
        let number = Coefficient::Number;
        let mut terms = Vec::new();
        match (sweep.loads, sweep.forces) {
            (Loads::All { factor, at }, _) => terms.push((number(factor), instant(at))),
            (_, Forces::Internal { .. }) => terms.push((number(1.0), instant(LoadAt::StartOf))),
            (Loads::HalfJump, _) => terms.push((number(0.5), "(F(t+) - F(t-))".into())),
            (Loads::One(load), _) => terms.push((number(1.0), format!("F_{}", load + 1))),
            (Loads::None, _) => {}
        }
        match sweep.forces {
            Forces::Products {
                stiffness,
                dashpots,
            } => {
                for (product, matrix) in [(stiffness, "K"), (dashpots, "E")] {
                    if let Some(product) = product {
                        let of = format!("{matrix} {}", self.name(product.source));
                        terms.push((number(-product.factor), of));
                    }
                }
            }
            Forces::Internal { u, v } => {
                let of = format!("f_int({}, {})", self.name(u), self.name(v));
                terms.push((number(-1.0), of));
            }
        }
        for OwnTerm {
            register,
            plain,
            per_mass,
        } in &sweep.own
        {
            let name = self.name(*register);
            if *plain != 0.0 {
                terms.push((number(*plain), name.into()));
            }
            if *per_mass != 0.0 {
                terms.push((number(*per_mass), format!("M {name}")));
            }
        }
        terms
    }

    /// An update as a formula, and its clamp, if any, as another.
    pub(super) fn update_lines(&self, update: &Update, digits: usize) -> Vec<Line> {
        let target = self.name(update.target);
        let mut terms: Vec<(Coefficient, String)> = Vec::new();
        for term in &update.terms {
            let coefficient = match term.weight {
                Weight::Number(number) => Coefficient::Number(number),
                Weight::OfLoad { moment, .. } => Coefficient::Moment(moment),
            };
            terms.push((coefficient, self.name(term.register).into()));
        }
        if update.of_q != 0.0 {
            terms.push((Coefficient::Number(update.of_q), "q".into()));
        }
        let last = if update.last_only {
            "  (in the last step of a batch only)"
        } else {
            ""
        };
        let keeps = terms == [(Coefficient::Number(1.0), target.to_owned())];
        let mut lines = Vec::new();
        if !keeps {
            lines.push(Line {
                head: format!("{target} <- "),
                terms,
                tail: last.into(),
            });
        }
        if let Some(clamp) = update.clamp {
            lines.push(Line {
                head: format!("{target} <- "),
                terms: vec![(Coefficient::Number(1.0), target.into())],
                tail: format!(
                    " clamped: {}{last}",
                    self.bound(clamp, update.target, digits)
                ),
            });
        }
        lines
    }

    /// The bound of a clamp.
    fn bound(&self, clamp: Clamp, target: Register, digits: usize) -> String {
        let target = self.name(target);
        match clamp {
            Clamp::Component(limit) => {
                format!("each component at most {}", significant(limit, digits))
            }
            Clamp::Vector { from, factor } => {
                let way = match from {
                    Some(from) => format!("|{target} - {}|", self.name(from)),
                    None => format!("|{target}|"),
                };
                let factor = match factor {
                    1.0 => String::new(),
                    factor => format!("{} ", significant(factor, digits)),
                };
                format!("{way} <= {factor}Q")
            }
        }
    }
}

/// The loads as a formula names them.
fn instant(at: LoadAt) -> String {
    match at {
        LoadAt::Within(1.0) => "F(t + dt)".into(),
        LoadAt::Within(share) if share == 1.0 / 3.0 => "F(t + dt/3)".into(),
        LoadAt::Within(share) if share != 0.0 => format!("F(t + {share} dt)"),
        LoadAt::StartOf | LoadAt::Within(_) | LoadAt::Around | LoadAt::From | LoadAt::Smooth => {
            "F(t)".into()
        }
    }
}

/// Treatment of loads that are not smooth about their instant.
fn taken(at: LoadAt) -> &'static str {
    match at {
        LoadAt::StartOf => "where a load jumps or bends in the step, F is its mean over the step",
        LoadAt::Within(_) => {
            "where a load jumps or bends in the step, F is the line of the same impulse and first moment"
        }
        LoadAt::Around => {
            "where a load jumps or bends near t, F is its mean over t - dt .. t + dt, weights falling from t"
        }
        LoadAt::From => {
            "where a load jumps or bends in the step, F is its mean over t .. t + dt, weights falling from t"
        }
        LoadAt::Smooth => "where a load jumps at t, F is what it is after the jump",
    }
}
