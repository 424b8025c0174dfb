//! A bench of kernels as people read it.

use std::fmt;

use super::KernelResults;
use super::row::KernelRow;
use crate::report::ruled;
use crate::report::three;

const HEAD: [&str; 9] = [
    "body",
    "kernel",
    "precision",
    "threads",
    "times B1",
    "lowest .. highest",
    "off [relative]",
    "MB a step",
    "of bandwidth",
];

impl fmt::Display for KernelResults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "Steps of central difference with mass damping; B1 is one scalar CSR product in f64 with the update, in \
             turn, medians.\nCPU time; wall time where there are several threads. `off`: largest difference from the \
             plain loops.\n"
        )?;
        let table = ruled::table(HEAD, self.rows.iter().map(cells), 3);
        f.write_str(&ruled::lines(table, 2))
    }
}

fn cells(row: &KernelRow) -> [String; 9] {
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
        format!("{:.1e}", row.difference),
        three(1e-6 * row.bytes_per_step),
        format!("{:.0} %", 100.0 * row.share_of_bandwidth),
    ]
}
