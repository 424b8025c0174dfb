//! A bench of kernels as a page.

use super::KernelResults;
use super::row::KernelRow;
use super::table::{
    HEAD, HEAD_OF_ELEMENTS, HEAD_OF_PAIRS, HEAD_OF_PULLED, OF_PAIRS, OF_PULLED, cells,
    cells_of_element, cells_of_pair, cells_of_pulled,
};
use crate::plain_table::{groups, rows, table};
use sinew_draw::page::Table;
use sinew_draw::{Family, Page, Roofline};

impl KernelResults {
    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut page = Page::new(
            "sinew kernels. A step of central difference beneath what the computer allows",
        );
        page.facts([
            ("revision", &self.revision),
            ("processor", &self.machine.cpu),
        ]);
        page.section("roofline", "Roofline");
        page.figure(&self.roofline().svg(), "");
        page.paragraph(
            "One thread. A step cannot be above the roof of the memory that holds what it moves, nor above that of \
             its instructions; both are measured in the same run. Bytes are those that a step has to move once: \
             matrices or templates, and vectors. Operations are two for each entry of the matrix, however it is \
             stored, and those of each cell's own update.",
        );
        page.paragraph(&self.roofs.to_string());
        page.section("rows", "Rows");
        page.paragraph(
            "times B1: time of one scalar CSR product in f64 with the update, entry by entry, over that of a \
             step, in turn, medians; CPU time, or wall time where there are several threads. unchecked: beside the same \
             loops without checks of bounds. off: largest difference from the plain loops.",
        );
        page.table(&self.rows_on_page());
        page.section("elements", "Forces of hyperelastic elements");
        page.paragraph(
            "On one thread, CPU time, medians of laps in turn. over p1: time over that of plain neo-Hookean tetrahedra with the same \
             numbers and instructions. gain: time of plain numbers in f64 over that of the row. off: largest difference from the forces by plain \
             numbers in f64, relative to the largest force.",
        );
        page.table(&self.elements_on_page());
        page.section("pulled", "Steps of a pulled cube");
        page.paragraph(OF_PULLED);
        page.table(&self.pulled_on_page());
        page.section("pairs", "Runs in pairs");
        page.paragraph(OF_PAIRS);
        page.table(&table(
            &HEAD_OF_PAIRS,
            3,
            rows(self.pairs.iter().map(cells_of_pair)),
        ));
        page.list(self.marks.iter().map(ToString::to_string));
        page.section("guards", "Guards");
        page.list(self.guards.iter().map(|guard| {
            let verdict = if guard.holds() { "" } else { "FAIL " };
            format!("{verdict}{guard}")
        }));
        page.finish()
    }

    fn rows_on_page(&self) -> Table {
        let rows = self.rows.iter().map(|row| (&row.mesh, cells(row)));
        table(&HEAD, 3, groups(rows))
    }

    fn elements_on_page(&self) -> Table {
        let rows = self.elements.iter().map(|row| {
            let group = (&row.mesh, row.law, row.element);
            (group, cells_of_element(row))
        });
        table(&HEAD_OF_ELEMENTS, 5, groups(rows))
    }

    fn pulled_on_page(&self) -> Table {
        let pulled = self.pulled.iter().map(cells_of_pulled);
        table(&HEAD_OF_PULLED, 3, rows(pulled))
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
