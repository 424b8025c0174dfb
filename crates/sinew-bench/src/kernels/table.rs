//! A bench of kernels as a table for readers.

use std::fmt;

use super::KernelResults;
use super::elements::{ElementMark, ElementRow};
use super::pairs::PairRow;
use super::pulled::PulledRow;
use super::roofs::{OperationRate, Roofs};
use super::row::KernelRow;
use crate::report::three;
use sinew_verify::ruled;

pub(super) const HEAD: [&str; 12] = [
    "body",
    "kernel",
    "precision",
    "threads",
    "times B1",
    "lowest .. highest",
    "unchecked",
    "off [relative]",
    "MB a step",
    "flop a byte",
    "GFLOP/s",
    "of bandwidth",
];

impl fmt::Display for KernelResults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Steps of central difference with mass damping; B1 is one scalar CSR product in f64 with the update, entry by \
             entry, in turn, medians; unchecked: beside the same loops without checks of bounds.\nCPU time; wall time where there are several threads. `off`: largest difference from the \
             plain loops.\n"
        )?;
        let table = ruled::table(HEAD, self.rows.iter().map(cells), 3);
        writeln!(f, "{}\n", ruled::lines(table, 2))?;
        writeln!(f, "{}", self.of_elements())?;
        writeln!(f, "{}", self.roofs)?;
        for guard in &self.guards {
            let verdict = if guard.holds() { "" } else { "FAIL " };
            writeln!(f, "{verdict}{guard}")?;
        }
        Ok(())
    }
}

impl KernelResults {
    /// The fastest kernel of each body and precision on one thread, and the guards, for a terminal.
    #[must_use]
    pub fn brief(&self) -> String {
        let mut fastest: Vec<&KernelRow> = Vec::new();
        for row in self.rows.iter().filter(|row| row.threads == 1) {
            let same = |other: &&mut &KernelRow| {
                (&other.mesh, other.precision) == (&row.mesh, row.precision)
            };
            match fastest.iter_mut().find(same) {
                Some(best) if best.step_s > row.step_s => *best = row,
                Some(_) => {}
                None => fastest.push(row),
            }
        }
        let table = ruled::table(HEAD, fastest.into_iter().map(cells), 3);
        let guards = self.guards.iter().map(|guard| {
            let verdict = if guard.holds() { "" } else { "FAIL " };
            format!("{verdict}{guard}")
        });
        let guards: Vec<String> = guards.collect();
        format!(
            "The fastest kernels on one thread beside one scalar CSR product in f64 with the update (B1)\n\n{}\n\n{}\n{}",
            ruled::lines(table, 2),
            self.of_elements(),
            guards.join("\n")
        )
    }

    /// The forces of hyperelastic elements, and their marks.
    fn of_elements(&self) -> String {
        let table = ruled::table(
            HEAD_OF_ELEMENTS,
            self.elements.iter().map(cells_of_element),
            5,
        );
        let pulled = ruled::table(HEAD_OF_PULLED, self.pulled.iter().map(cells_of_pulled), 3);
        let pairs = ruled::table(HEAD_OF_PAIRS, self.pairs.iter().map(cells_of_pair), 3);
        let marks: Vec<String> = self.marks.iter().map(ToString::to_string).collect();
        format!(
            "Forces of hyperelastic elements on one thread, CPU time, medians of laps in turn\n\n{}\n\n{OF_PULLED}\n\n{}\n\n{OF_PAIRS}\n\n{}\n\n{}\n",
            ruled::lines(table, 2),
            ruled::lines(pulled, 2),
            ruled::lines(pairs, 2),
            marks.join("\n")
        )
    }
}

pub(super) const HEAD_OF_ELEMENTS: [&str; 9] = [
    "body",
    "law",
    "element",
    "precision",
    "instructions",
    "ns a tetrahedron",
    "over p1",
    "gain",
    "off [relative]",
];

pub(super) fn cells_of_element(row: &ElementRow) -> [String; 9] {
    [
        row.mesh.clone(),
        row.law.to_owned(),
        row.element.to_owned(),
        row.precision.to_owned(),
        row.instructions.to_owned(),
        three(row.ns_per_tet),
        three(row.ratio_to_p1),
        three(row.gain_over_scalar),
        format!("{:.1e}", row.difference),
    ]
}

/// Meaning of [`HEAD_OF_PULLED`].
pub(super) const OF_PULLED: &str = "A cube pulled to 35 % stretch by a sudden traction, central difference on one thread, CPU time, medians of laps in turn. times plain: a plain \
                                    scalar loop over plain tetrahedra in f64 over the step. off plain: from that loop. of roof: of what instructions and memory allow, by operations and bytes of the \
                                    formulas. off: from an eighth of the step in f64. over fixed: automatic steps over as many forces in fixed ones.";

pub(super) const HEAD_OF_PULLED: [&str; 12] = [
    "body",
    "element",
    "precision",
    "us a step",
    "times plain",
    "flop a tetrahedron",
    "bytes a tetrahedron",
    "of roof",
    "off plain",
    "off [relative]",
    "automatic: off",
    "over fixed",
];

pub(super) fn cells_of_pulled(row: &PulledRow) -> [String; 12] {
    let tets = row.tets as f64;
    [
        row.mesh.clone(),
        row.element.to_owned(),
        row.precision.to_owned(),
        three(1e6 * row.step_s),
        three(row.times_plain),
        three(row.operations / tets),
        three(row.bytes / tets),
        format!("{:.0} %", 100.0 * row.share_of_roof),
        row.off_plain
            .map_or_else(String::new, |off| format!("{off:.1e}")),
        format!("{:.1e}", row.error),
        format!("{:.1e}", row.error_of_automatic),
        three(row.over_fixed),
    ]
}

/// Meaning of [`HEAD_OF_PAIRS`].
pub(super) const OF_PAIRS: &str = "Runs of scenes beside others that differ by one thing, in turn: steps alone, without outputs, CPU time on one thread, medians. off: relative difference \
                                   of displacements at the end, where both compute the same motion.";

pub(super) const HEAD_OF_PAIRS: [&str; 6] = [
    "body",
    "run",
    "beside",
    "CPU s a second",
    "time over the other",
    "off [relative]",
];

pub(super) fn cells_of_pair(row: &PairRow) -> [String; 6] {
    [
        row.mesh.clone(),
        row.run.to_owned(),
        row.beside.to_owned(),
        three(row.cpu_s_per_s),
        three(row.ratio),
        row.off.map_or_else(String::new, |off| format!("{off:.1e}")),
    ]
}

impl fmt::Display for ElementMark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.reached { "reached" } else { "MISSED" };
        let (value, mark) = (three(self.value), three(self.mark));
        write!(
            f,
            "{verdict}: {}, {} {value}, mark {mark}",
            self.row, self.what
        )
    }
}

impl fmt::Display for Roofs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reads = self.reads.iter().map(|read| {
            let (rate, size) = (
                three(1e-9 * read.bytes_per_s),
                three(1e-6 * read.bytes as f64),
            );
            format!("{rate} GB/s of {} ({size} MB)", read.memory)
        });
        let rates = self.multiply_adds.iter().map(|rate| {
            let OperationRate {
                instructions,
                precision,
                ..
            } = rate;
            let rate = three(1e-9 * rate.operations_per_s);
            format!("{rate} GFLOP/s ({instructions} {precision})")
        });
        let [reads, rates] =
            [reads.collect::<Vec<_>>(), rates.collect()].map(|list| list.join(", "));
        writeln!(
            f,
            "One thread of this computer reads {reads}; it multiplies and adds {rates}."
        )
    }
}

pub(super) fn cells(row: &KernelRow) -> [String; 12] {
    let kernel = match row.templates {
        Some(count) => format!("{} ({count} templates) {}", row.kernel, row.instructions),
        None => format!("{} {}", row.kernel, row.instructions),
    };
    [
        row.mesh.clone(),
        kernel,
        row.precision.to_owned(),
        row.threads.to_string(),
        three(row.ratio_to_b1),
        format!("{} .. {}", three(row.ratios[0]), three(row.ratios[1])),
        three(row.ratio_to_b1_without_checks),
        format!("{:.1e}", row.difference),
        three(1e-6 * row.bytes_per_step),
        three(row.intensity),
        three(row.gflops),
        format!("{:.0} %", 100.0 * row.share_of_bandwidth),
    ]
}
