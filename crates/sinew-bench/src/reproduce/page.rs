//! The reproduction as files.

use std::path::PathBuf;

use sinew_draw::page::{Cell, Column, Table, TableRow};
use sinew_draw::{Colour, Page};
use sinew_scene::output::{OutputError, OutputFolder};

use super::claims::{Claim, Holds};
use super::figures::NUMBERS;
use super::reproduction::Reproduction;

const CLAIMS: &str = "claims.md";
const PAGE: &str = "reproduction.html";

/// The names of all files of a reproduction.
pub(super) fn file_names() -> Vec<String> {
    let fixed = [CLAIMS, PAGE].map(str::to_owned);
    fixed.into_iter().chain(NUMBERS.map(of_figure)).collect()
}

fn of_figure(number: &str) -> String {
    format!("fig-{number}.svg")
}

/// The files that were written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenReproduction {
    /// `reproduction.html`.
    pub page: PathBuf,
    /// `claims.md`.
    pub claims: PathBuf,
    /// `fig-<number>.svg` of every figure.
    pub figures: Vec<PathBuf>,
}

pub(super) fn write(
    reproduction: &Reproduction,
    folder: &OutputFolder,
) -> Result<WrittenReproduction, OutputError> {
    let figures = reproduction.figures.iter().map(|figure| {
        let name = of_figure(figure.number);
        folder.write(&name, figure.svg.as_bytes())
    });
    Ok(WrittenReproduction {
        figures: figures.collect::<Result<_, _>>()?,
        claims: folder.write(CLAIMS, markdown(&reproduction.claims).as_bytes())?,
        page: folder.write(PAGE, html(reproduction).as_bytes())?,
    })
}

fn markdown(claims: &[Claim]) -> String {
    let mut table = String::from(
        "| where | the paper says | measured | verdict |\n| --- | --- | --- | --- |\n",
    );
    for claim in claims {
        let row = [claim.place, claim.says, &claim.measured, claim.holds.word()];
        let row = row.map(|cell| cell.replace('|', "\\|"));
        table.push_str(&format!("| {} |\n", row.join(" | ")));
    }
    table
}

fn html(reproduction: &Reproduction) -> String {
    let mut page = Page::new("The paper, reproduced");
    page.markup(
        "<p>Zhang, Zhong, Smith and Gu, <cite>Cellular neural network modelling of soft tissue \
         dynamics for surgical simulation</cite>, Technology and Health Care 25 (2017) S337-S344. \
         An error is relative to the exact motion; returning zero scores 100 %.</p>\n",
    );
    page.section("claims", "Claim by claim");
    let row = |claim: &Claim| {
        let verdict = Cell::text(claim.holds.word()).tinted(tint(claim.holds));
        let cells = [claim.place, claim.says, &claim.measured].map(Cell::text);
        TableRow::new(cells.into_iter().chain([verdict]))
    };
    page.table(&Table {
        columns: ["where", "the paper says", "measured", "verdict"]
            .map(Column::sentences)
            .into(),
        rows: reproduction.claims.iter().map(row).collect(),
        ..Table::default()
    });
    page.section("figures", "Figures");
    for figure in &reproduction.figures {
        page.figure(&figure.svg, &figure.caption);
    }
    page.finish()
}

fn tint(holds: Holds) -> Colour {
    match holds {
        Holds::Yes => Colour(0xb8, 0xe6, 0xd4),
        Holds::InPart => Colour(0xf9, 0xe4, 0xae),
        Holds::No => Colour(0xf5, 0xb8, 0x95),
    }
}

impl Reproduction {
    /// Writes `fig-*.svg`, `claims.md` and `reproduction.html` into a folder.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn write(&self, folder: &OutputFolder) -> Result<WrittenReproduction, OutputError> {
        write(self, folder)
    }

    /// The names of the files that [`Reproduction::write`] writes.
    #[must_use]
    pub fn output_files() -> Vec<String> {
        file_names()
    }
}
