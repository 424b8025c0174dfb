//! Programs as text and formulas, as in a textbook.

use std::collections::BTreeSet;
use std::fmt;

use sinew_core::{Acceleration, VelocityTime};

use super::formula::Lines;
use super::number::significant;
use super::stretch::stretches;
use super::{Program, Quotient, Register, Sweep};

/// Significant digits of numbers by default.
const DIGITS: usize = 6;

/// Longest line of a list.
const WIDTH: usize = 96;

/// Sweep by sweep in formulas, numbers with six significant digits: `{:.17}` shows them in full. Loads are counted
/// from 1. Sweeps of one kind that follow each other are shown once, with a list of their coefficients.
impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = f.precision().unwrap_or(DIGITS);
        writeln!(f, "registers: {}", self.registers_in_words().join(", "))?;
        if !self.entry.is_empty() {
            writeln!(f, "before a batch")?;
            for update in &self.entry {
                for line in self.update_lines(update, digits) {
                    writeln!(f, "     {}", line.text(digits))?;
                }
            }
        }
        if !self.start.is_empty() {
            writeln!(f, "first step, from a velocity at the displacement's time")?;
            self.write_sweeps(f, &self.start, digits)?;
        }
        writeln!(f, "step")?;
        self.write_sweeps(f, &self.step, digits)?;
        let v = match self.velocity {
            VelocityTime::Same => "u and v at its end",
            VelocityTime::MiddleOfStep => "u at its end, v in its middle",
            VelocityTime::MeanOverStep => "u at its end, v the mean over it",
        };
        let a = match self.acceleration {
            Acceleration::None => "",
            Acceleration::Same => ", a at its end",
            Acceleration::Kick => ", a the acceleration that led to v",
        };
        writeln!(f, "after a step hold {v}{a}")?;
        if self.repeats > 1 {
            writeln!(f, "a step of the caller is {} such steps", self.repeats)?;
        }
        let plural = |count: usize, one: &str, more: &str| {
            format!("{count} {}", if count == 1 { one } else { more })
        };
        let traffic = self.traffic();
        writeln!(
            f,
            "work of a step of the caller: {} over neighbours, {} over the cells, {} read and {} written",
            plural(
                self.repeats as usize * self.products_a_step(),
                "sweep",
                "sweeps"
            ),
            plural(
                self.repeats as usize * self.passes_a_step(),
                "pass",
                "passes"
            ),
            plural(traffic.read, "vector", "vectors"),
            traffic.written,
        )?;
        for word in self.words(digits) {
            writeln!(f, "  {word}")?;
        }
        Ok(())
    }
}

impl Program {
    fn sweeps(&self) -> impl Iterator<Item = &Sweep> {
        self.start.iter().chain(&self.step)
    }

    fn registers_in_words(&self) -> Vec<String> {
        let used = |register: Register| {
            let mut updates = self.sweeps().flat_map(|sweep| &sweep.updates);
            register != Register::A || updates.any(|update| update.target == register)
        };
        let all = (0..self.registers().len()).map(|index| Register(index as u8));
        let word = |register: Register| {
            let meaning = match register {
                Register::U => " displacement (m)".to_owned(),
                Register::V => " velocity (m/s)".to_owned(),
                Register::A => " acceleration (m/s^2)".to_owned(),
                _ => String::new(),
            };
            format!("{}{meaning}", self.name(register))
        };
        all.filter(|register| used(*register)).map(word).collect()
    }

    fn write_sweeps(
        &self,
        f: &mut fmt::Formatter<'_>,
        sweeps: &[Sweep],
        digits: usize,
    ) -> fmt::Result {
        let lines: Vec<Lines> = sweeps
            .iter()
            .map(|sweep| self.lines(sweep, digits))
            .collect();
        for stretch in stretches(&lines) {
            let shown = stretch.from..stretch.from + stretch.shown;
            for number in shown {
                write_sweep(f, number + 1, &lines[number], digits)?;
            }
            if stretch.left_out() == 0 {
                continue;
            }
            let kind = match stretch.shown {
                1 => "of this kind",
                _ => "of these two kinds in turn",
            };
            let left_out = stretch.left_out();
            writeln!(f, "     ... {left_out} more {kind}, up to {}", stretch.to)?;
            for (pattern, values) in stretch.varying(&lines, digits) {
                let (from, to) = (stretch.from + 1, stretch.to);
                writeln!(f, "     coefficients of {pattern} in {from} to {to}:")?;
                write_list(f, &values)?;
            }
        }
        Ok(())
    }

    /// Meanings of the formulas' letters.
    fn words(&self, digits: usize) -> Vec<String> {
        let mut letters = BTreeSet::new();
        let mut text = String::new();
        for sweep in self.sweeps() {
            for line in self.lines(sweep, digits).lines {
                text.push_str(&line.text(digits));
                text.push(' ');
            }
        }
        let between = |c: char| !(c.is_alphanumeric() || c == '_');
        letters.extend(text.split(between));
        let letter_meanings = [
            ("F", "loads (N)"),
            ("M", "lumped masses (kg)"),
            ("K", "stiffness (N/m)"),
            ("E", "dashpots (N s/m)"),
            ("f_int", "internal forces (N)"),
        ];
        let used = letter_meanings
            .iter()
            .filter(|(letter, _)| letters.contains(letter));
        let mut meanings: Vec<String> = used
            .map(|(letter, meaning)| format!("{letter}: {meaning}"))
            .collect();
        if letters.iter().any(|letter| letter.starts_with("F_")) {
            meanings.push("F_n: load n at factor 1 (N)".into());
        }
        if self
            .sweeps()
            .any(|sweep| sweep.quotient == Quotient::Blocks)
        {
            meanings.push("P: one block for each cell (kg)".into());
            if let Some(blocks) = &self.blocks {
                let layers = blocks.layers();
                let rows = blocks.entries().chunks(layers).take(layers).map(|row| {
                    let entries = row.iter().map(|entry| significant(*entry, digits));
                    entries.collect::<Vec<_>>().join(", ")
                });
                let rows = rows.collect::<Vec<_>>().join("; ");
                meanings.push(format!("P^-1 of the first cell: [{rows}] (1/kg)"));
            }
        }
        let mut words = vec![
            "t: beginning of the step (s), dt: its length (s), q: what a sweep leaves in each cell"
                .to_owned(),
            meanings.join(", "),
        ];
        if let Some(limits) = &self.limits {
            let least = limits.iter().copied().fold(f64::INFINITY, f64::min);
            let most = limits.iter().copied().fold(0.0, f64::max);
            let [least, most] = [least, most].map(|limit| significant(limit, digits));
            words.push(format!("Q: a cell's limit, {least} to {most} m/s"));
        }
        if let Some(moments) = &self.moments {
            words.push(format!(
                "m_i: sum over j of w_ij (r(t + t_j) - r(t)), r the load's factor over time, t_j {} instants in the step",
                moments.times.len()
            ));
        }
        words.retain(|word| !word.is_empty());
        words
    }
}

fn write_sweep(
    f: &mut fmt::Formatter<'_>,
    number: usize,
    sweep: &Lines,
    digits: usize,
) -> fmt::Result {
    let mut place = format!("{number:>4} ");
    if let Some(when) = &sweep.when {
        writeln!(f, "{place}{when}:")?;
        place = " ".repeat(5);
    }
    for (index, line) in sweep.lines.iter().enumerate() {
        writeln!(f, "{place}{}", line.text(digits))?;
        place = " ".repeat(5);
        if index == 0
            && let Some(loads) = sweep.loads
        {
            writeln!(f, "       {loads}")?;
        }
    }
    Ok(())
}

/// Values in lines of a limited width.
fn write_list(f: &mut fmt::Formatter<'_>, values: &[String]) -> fmt::Result {
    let mut line = String::from("      ");
    for (index, value) in values.iter().enumerate() {
        let comma = if index + 1 < values.len() { "," } else { "" };
        if line.len() + value.len() + 2 > WIDTH {
            writeln!(f, "{line}")?;
            line = String::from("      ");
        }
        line.push_str(&format!(" {value}{comma}"));
    }
    writeln!(f, "{line}")
}
