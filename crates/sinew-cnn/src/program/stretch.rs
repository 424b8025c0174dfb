//! Sweeps that differ by their coefficients only.

use super::formula::{Coefficient, Line, Lines};

/// Smallest number of sweeps that is worth omitting.
const FEWEST: usize = 3;

/// Consecutive sweeps of one kind, or of two kinds in turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    pub(super) from: usize,
    pub(super) to: usize,
    /// Number of kinds; all sweeps if none is omitted.
    pub(super) shown: usize,
}

/// Divides the sweeps of a program into stretches.
pub(super) fn stretches(sweeps: &[Lines]) -> Vec<Stretch> {
    let mut found = Vec::new();
    let mut from = 0;
    while from < sweeps.len() {
        let of_period = |period: usize| {
            let like = |i: &usize| sweeps[*i].are_like(&sweeps[*i + period]);
            let pairs = from..sweeps.len().saturating_sub(period);
            let to = from + period + pairs.take_while(like).count();
            Stretch {
                from,
                to: to.min(sweeps.len()),
                shown: period,
            }
        };
        let long = |stretch: &Stretch| stretch.to - stretch.from >= stretch.shown + FEWEST;
        let stretch = [1, 2].map(of_period).into_iter().find(long);
        let stretch = stretch.unwrap_or(Stretch {
            from,
            to: from + 1,
            shown: 1,
        });
        from = stretch.to;
        found.push(stretch);
    }
    found
}

impl Stretch {
    /// Number of sweeps omitted.
    pub(super) fn left_out(self) -> usize {
        self.to - self.from - self.shown
    }

    /// The lines whose coefficients are not the same in all sweeps, each with `_` in their place, and
    /// the coefficients sweep by sweep.
    pub(super) fn varying(self, sweeps: &[Lines], digits: usize) -> Vec<(String, Vec<String>)> {
        let sweeps = &sweeps[self.from..self.to];
        let Some(first) = sweeps.first() else {
            return Vec::new();
        };
        let mut varying = Vec::new();
        for (number, line) in first.lines.iter().enumerate() {
            let same: Vec<&Line> = sweeps
                .iter()
                .filter_map(|sweep| sweep.lines.get(number))
                .collect();
            let columns: Vec<usize> = (0..line.terms.len())
                .filter(|column| {
                    let of = |line: &&Line| line.terms.get(*column).map(|(value, _)| *value);
                    same.iter().any(|line| of(line) != of(&same[0]))
                })
                .collect();
            if columns.is_empty() {
                continue;
            }
            let values = same.iter().map(|line| {
                let value = |column: &usize| line.terms.get(*column).map(|(value, _)| *value);
                let values = columns.iter().filter_map(value);
                let texts: Vec<String> = values.map(|value| value.text(digits)).collect();
                match texts.as_slice() {
                    [one] => one.clone(),
                    _ => format!("({})", texts.join(", ")),
                }
            });
            varying.push((pattern(&same, &columns, digits), values.collect()));
        }
        varying
    }
}

/// The first line with `_` for the columns that vary; where two kinds in turn differ in a name it has
/// `one|other`.
fn pattern(lines: &[&Line], columns: &[usize], digits: usize) -> String {
    let [first, rest @ ..] = lines else {
        return String::new();
    };
    let second = rest.first().unwrap_or(first);
    let either = |one: &str, other: &str| match one == other {
        true => one.to_owned(),
        false => format!("{one}|{other}"),
    };
    let mut text = either(&first.head, &second.head);
    for (column, (coefficient, of)) in first.terms.iter().enumerate() {
        let of = either(of, second.terms.get(column).map_or(of, |(_, of)| of));
        let plus = if column > 0 { " + " } else { "" };
        let term = if columns.contains(&column) {
            format!("_ {of}")
        } else if *coefficient == Coefficient::Number(1.0) {
            of
        } else {
            format!("{} {of}", coefficient.text(digits))
        };
        text.push_str(plus);
        text.push_str(&term);
    }
    text + &first.tail
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(target: &str, weight: f64) -> Lines {
        Lines {
            when: None,
            lines: vec![Line {
                head: format!("{target} <- "),
                terms: vec![(Coefficient::Number(weight), "q".into())],
                tail: String::new(),
            }],
            loads: None,
        }
    }

    #[test]
    fn kinds_in_turn_are_one_stretch() {
        let mut sweeps = vec![sweep("u", 1.0)];
        for k in 0..7 {
            sweeps.push(sweep(["c", "d"][k % 2], k as f64));
        }
        sweeps.push(sweep("v", 1.0));
        let found = stretches(&sweeps);
        let bounds: Vec<_> = found
            .iter()
            .map(|stretch| (stretch.from, stretch.to))
            .collect();
        assert_eq!(bounds, [(0, 1), (1, 8), (8, 9)]);
        assert_eq!(found[1].left_out(), 5);
        let varying = found[1].varying(&sweeps, 6);
        assert_eq!(varying.len(), 1);
        assert_eq!(varying[0].0, "c <- |d <- _ q");
        assert_eq!(varying[0].1, ["0", "1", "2", "3", "4", "5", "6"]);
    }

    #[test]
    fn few_sweeps_are_all_shown() {
        let sweeps = vec![sweep("u", 1.0), sweep("u", 2.0), sweep("u", 3.0)];
        assert_eq!(stretches(&sweeps).len(), 3);
    }
}
