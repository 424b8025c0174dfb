//! A verification as a page.

use sinew_draw::page::{Cell, Column, Table, TableRow};
use sinew_draw::{Colour, Page};

use crate::results::{Verification, VerifiedRow, VerifiedSubject};
use crate::verdict::MarkVerdict;

const PASSES: Colour = Colour(0xb8, 0xe6, 0xd4);
const FAILS: Colour = Colour(0xf5, 0xb8, 0x95);

impl Verification {
    /// The page.
    #[must_use]
    pub fn html(&self) -> String {
        let mut page = Page::new("sinew: what it is held to, and what it gives");
        page.facts([
            ("revision", self.revision.as_str()),
            ("processor", &self.machine.cpu),
            (
                "compiler",
                self.machine.compiler.as_deref().unwrap_or_default(),
            ),
        ]);
        let summary = self.summary();
        match self.failures().next() {
            None => page.paragraph(&summary),
            Some(_) => page.warning(&summary),
        }
        page.paragraph(
            "Each figure was computed anew by the library, and is asked for with a tolerance and a source: a closed form, a figure in \
             print, or an independent computation. Quoted figures belong to other elements, for comparison, and are not computed.",
        );
        page.section("subjects", "In short");
        page.table(&self.overview());
        if self.failures().next().is_some() {
            page.section("failures", "Rows that fail");
            page.table(&table(self.failures().map(|(_, row)| row)));
        }
        for subject in &self.subjects {
            page.section(subject.id, subject.title);
            page.paragraph(subject.says);
            page.table(&table(subject.rows.iter()));
            if !subject.quoted.is_empty() {
                page.heading("Quoted, not computed");
                page.table(&quoted(subject));
            }
        }
        page.finish()
    }

    fn overview(&self) -> Table {
        let row = |subject: &VerifiedSubject| {
            let fails = |row: &&VerifiedRow| row.verdict == MarkVerdict::Fail;
            let failed = subject.rows.iter().filter(fails).count();
            let nearest = subject.rows.iter().filter_map(VerifiedRow::of_tolerance);
            let nearest = nearest.fold(0.0, f64::max);
            let verdict = match failed {
                0 => MarkVerdict::Pass,
                _ => MarkVerdict::Fail,
            };
            TableRow::new([
                Cell::text(subject.title).linked(subject.id),
                Cell::number(subject.rows.len().to_string(), subject.rows.len() as f64),
                Cell::number(failed.to_string(), failed as f64),
                Cell::number(format!("{:.0}", 100.0 * nearest), nearest),
                tinted(verdict),
            ])
        };
        Table {
            columns: vec![
                Column::sentences("subject"),
                Column::number("rows", ""),
                Column::number("fail", ""),
                Column::number("most of a tolerance", "%")
                    .explained("the largest difference of a row, as a share of what it may be"),
                Column::text("verdict"),
            ],
            rows: self.subjects.iter().map(row).collect(),
            ..Table::default()
        }
    }
}

fn tinted(verdict: MarkVerdict) -> Cell {
    let tint = match verdict {
        MarkVerdict::Pass => PASSES,
        MarkVerdict::Fail => FAILS,
    };
    Cell::text(verdict.word()).tinted(tint)
}

fn table<'a>(rows: impl Iterator<Item = &'a VerifiedRow>) -> Table {
    let row = |row: &VerifiedRow| {
        TableRow::new([
            Cell::text(&row.case).noted(row.note),
            Cell::text(&row.figure),
            Cell::text(row.asked.to_string()),
            Cell::number(row.got_in_words(), row.got.unwrap_or(f64::INFINITY)),
            Cell::text(row.source.words()),
            tinted(row.verdict),
        ])
    };
    Table {
        columns: vec![
            Column::sentences("case"),
            Column::sentences("figure"),
            Column::text("asked"),
            Column::number("got", ""),
            Column::sentences("source"),
            Column::text("verdict"),
        ],
        rows: rows.map(row).collect(),
        ..Table::default()
    }
}

fn quoted(subject: &VerifiedSubject) -> Table {
    let row = |quoted: &crate::subject::Quoted| {
        TableRow::new([quoted.what, quoted.case, quoted.figures].map(Cell::text))
    };
    Table {
        columns: ["element", "case", "figures"].map(Column::sentences).into(),
        rows: subject.quoted.iter().map(row).collect(),
        ..Table::default()
    }
}
