//! The reproduction as files.

use std::path::PathBuf;

use sinew_scene::output::{OutputError, OutputFolder};

use super::claims::Claim;
use super::figures::NUMBERS;
use super::reproduction::Reproduction;
use crate::report::escape;

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
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>The paper, reproduced</title>\n<style>\n{}{}</style>\n</head>\n<body>\n\
         <h1>The paper, reproduced</h1>\n\
         <p>Zhang, Zhong, Smith and Gu, <cite>Cellular neural network modelling of soft tissue \
         dynamics for surgical simulation</cite>, Technology and Health Care 25 (2017) S337-S344. \
         An error is relative to the exact motion; returning zero scores 100 %.</p>\n",
        include_str!("../report/report.css"),
        include_str!("page.css"),
    );
    page.push_str(
        "<h2>Claim by claim</h2>\n<div class=\"scroll\"><table class=\"claims\">\n<thead><tr>",
    );
    for heading in ["where", "the paper says", "measured", "verdict"] {
        page.push_str(&format!("<th>{heading}</th>"));
    }
    page.push_str("</tr></thead>\n<tbody>\n");
    for claim in &reproduction.claims {
        let class = claim.holds.word().replace(' ', "-");
        page.push_str(&format!(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{class}\">{}</td></tr>\n",
            escape(claim.place),
            escape(claim.says),
            escape(&claim.measured),
            claim.holds.word()
        ));
    }
    page.push_str("</tbody>\n</table></div>\n<h2>Figures</h2>\n");
    for figure in &reproduction.figures {
        page.push_str(&format!(
            "<figure>\n{}\n<figcaption>{}</figcaption>\n</figure>\n",
            figure.svg,
            escape(&figure.caption)
        ));
    }
    page.push_str("</body>\n</html>\n");
    page
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
