//! A bench of kernels as a page: one file, nothing from the network.

use super::KernelResults;
use super::row::KernelRow;
use super::table::{HEAD, cells};
use crate::report::{Family, Roofline, escape};

impl KernelResults {
    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>sinew kernels, {revision}</title>\n<style>\n{style}</style>\n</head>\n<body>\n\
             <h1>Kernels: a step of central difference beneath what the computer allows</h1>\n\
             <dl><dt>revision</dt><dd>{revision}</dd><dt>processor</dt><dd>{cpu}</dd></dl>\n\
             <h2>Roofline</h2>\n<div class=\"wide plot\">{plot}</div>\n\
             <p>One thread. A step cannot be above the roof of the memory that holds what it moves, nor above that of \
             its instructions; both are measured in the same run. Bytes are those that a step has to move once: \
             matrices or templates, and vectors. Operations are two for each entry of the matrix, however it is \
             stored, and those of each cell's own update.</p>\n",
            revision = escape(&self.revision),
            cpu = escape(&self.machine.cpu),
            style = include_str!("../report/report.css"),
            plot = self.roofline().svg(),
        );
        page.push_str(&format!("<p>{}</p>\n", escape(&self.roofs.to_string())));
        page.push_str(
            "<h2>Rows</h2>\n<p>times B1: time of one scalar CSR product in f64 with the update, entry by entry, over that of a \
             step, in turn, medians; CPU time, or wall time where there are several threads. unchecked: beside the same loops \
             without checks of bounds. off: largest difference from the plain loops.</p>\n<div class=\"wide\"><table>\n<thead><tr>",
        );
        for head in HEAD {
            page.push_str(&format!("<th>{head}</th>"));
        }
        page.push_str("</tr></thead>\n<tbody>\n");
        let mut body = "";
        for row in &self.rows {
            let class = if row.mesh == body {
                ""
            } else {
                " class=\"new\""
            };
            body = &row.mesh;
            page.push_str(&format!("<tr{class}>"));
            for (column, cell) in cells(row).iter().enumerate() {
                let class = if column > 2 { " class=\"n\"" } else { "" };
                page.push_str(&format!("<td{class}>{}</td>", escape(cell)));
            }
            page.push_str("</tr>\n");
        }
        page.push_str("</tbody>\n</table></div>\n<h2>Guards</h2>\n<ul>\n");
        for guard in &self.guards {
            let verdict = if guard.holds() { "" } else { "<b>FAIL</b> " };
            page.push_str(&format!(
                "<li>{verdict}{}</li>\n",
                escape(&guard.to_string())
            ));
        }
        page.push_str("</ul>\n</body>\n</html>\n");
        page
    }

    fn roofline(&self) -> Roofline {
        let memories = self.roofs.reads.iter();
        let memories = memories.map(|read| {
            let rate = 1e-9 * read.bytes_per_s;
            (format!("{} {rate:.0} GB/s", read.memory), rate)
        });
        let arithmetic = self.roofs.multiply_adds.iter();
        let arithmetic = arithmetic.map(|rate| {
            let gflops = 1e-9 * rate.operations_per_s;
            let name = format!(
                "{} {}, {gflops:.0} GFLOP/s",
                rate.instructions, rate.precision
            );
            (name, gflops)
        });
        let alone = |row: &&KernelRow| row.threads == 1;
        let mut families: Vec<Family> = Vec::new();
        for row in self.rows.iter().filter(alone) {
            let name = format!("{} {}, {}", row.kernel, row.precision, row.instructions);
            let mark = (row.mesh.clone(), row.intensity, row.gflops);
            match families.iter_mut().find(|family| family.name == name) {
                Some(family) => family.marks.push(mark),
                None => families.push(Family {
                    name,
                    marks: vec![mark],
                }),
            }
        }
        Roofline {
            title: "Kernels on one thread".into(),
            memories: memories.collect(),
            arithmetic: arithmetic.collect(),
            families,
        }
    }
}
