//! `report.html`: a run at a glance, in one page without network.

mod beside;
mod body;
mod curves;

use sinew_draw::Page;
use sinew_mesh::BoundarySurface;
use sinew_scene::Quantity;
use sinew_scene::output::OwnedFolder;

use crate::csv::Table;
use crate::cut_words::words_of_cuts;
use crate::error::RecordRunError;
use crate::run_end::Ended;
use crate::summary::Summary;
use crate::tables;
use crate::tool_rows;
use curves::plot;

pub(crate) const NAME: &str = "report.html";

/// Largest number of probes whose curves are drawn.
const MOST_DRAWN: usize = 24;

/// The page. It contains no facts about the computer, so that it is the same on all computers.
pub(crate) fn page(
    summary: &Summary<'_>,
    surface: Option<&BoundarySurface>,
    folder: &OwnedFolder,
) -> Result<String, RecordRunError> {
    let (scene, body) = (summary.scene.scene(), summary.body);
    let title = match scene.title() {
        "" => "A run",
        title => title,
    };
    let mut page = Page::new(title)
        .with_style(beside::STYLE)
        .with_style(body::STYLE);
    for warning in summary.record.warnings.iter().chain(summary.warnings) {
        page.warning(warning);
    }
    page.facts(facts(summary));
    page.paragraph("The error of this run is not known: `sinew plan --tolerance` measures it.");
    if let Some(surface) = surface {
        body::section(&mut page, summary, surface, folder);
    }
    let read = |name: &'static str| -> Result<Option<Table>, RecordRunError> {
        let Some(content) = folder.read(name)? else {
            return Ok(None);
        };
        let table = Table::parse(&String::from_utf8_lossy(&content));
        table.map(Some).map_err(|reason| RecordRunError::Unusable {
            folder: folder.path().to_owned(),
            name,
            reason,
        })
    };
    if let Some(probes) = read(tables::PROBES)? {
        page.section("probes", "Probes");
        let shown = body.probes().iter().take(MOST_DRAWN);
        let drawn = shown.map(|probe| {
            let (letter, label, unit) = match probe.quantity {
                Quantity::Displacement => ("u", "displacement [m]", "m"),
                Quantity::Velocity => ("v", "velocity [m/s]", "m_per_s"),
                Quantity::Stress => ("s", "stress [Pa]", "Pa"),
            };
            let begin = format!("{}_{letter}_", probe.name);
            let plot = plot(&probes, &probe.name, label, |column| {
                let part = column.strip_prefix(&begin)?;
                // The mass of an oscillator has one direction without a name.
                if part == unit {
                    return Some(letter.to_owned());
                }
                let part = part.strip_suffix(unit)?.strip_suffix('_')?;
                Some(part.replace('_', " "))
            });
            plot.svg()
        });
        beside::figures(&mut page, &drawn.collect::<Vec<_>>());
        match body.probes().len() {
            0 => page.paragraph(
                "The scene has none: a table `[[probe]]` with `name` and `point` makes one.",
            ),
            count if count > MOST_DRAWN => page.paragraph(&format!(
                "The first {MOST_DRAWN} of {count}: all are in {}.",
                tables::PROBES
            )),
            _ => {}
        }
    }
    if let Some(energy) = read(tables::ENERGY)? {
        page.section("energy", "Energy");
        let plot = plot(&energy, "Balance of energy", "energy [J]", |column| {
            Some(column.strip_suffix("_J")?.replace('_', " "))
        });
        page.figure(
            &plot.svg(),
            "The remainder is energy added or removed by the method (if not known), or by rows that are several steps apart.",
        );
    }
    if let Some(reactions) = read(tables::REACTIONS)? {
        page.section("reactions", "Forces of supports");
        let drawn = summary.parts.iter().map(|part| {
            let begin = format!("{}_f_", tables::column_name(part));
            let plot = plot(
                &reactions,
                &tables::table_of(part).replace('`', ""),
                "force [N]",
                |column| {
                    let axis = column.strip_prefix(&begin)?.strip_suffix("_N")?;
                    Some(axis.to_owned())
                },
            );
            plot.svg()
        });
        beside::figures(&mut page, &drawn.collect::<Vec<_>>());
    }
    if let Some(rows) = read(tool_rows::NAME)? {
        page.section("tools", "Forces on tools");
        let tools = body.model().tools().into_iter();
        let tools = tools.flat_map(|tools| tools.tools());
        let drawn = tools.map(|tool| {
            let begin = format!("{}_force_", tool.name);
            let plot = plot(&rows, &tool.name, "force [N]", |column| {
                let axis = column.strip_prefix(&begin)?.strip_suffix("_N")?;
                Some(axis.to_owned())
            });
            plot.svg()
        });
        beside::figures(&mut page, &drawn.collect::<Vec<_>>());
    }
    page.section("scene", "The scene as it was run");
    let text = sinew_draw::markup::escape(scene.source().text());
    page.folded("Its text", |page| {
        page.markup(&format!("<pre>{text}</pre>\n"));
    });
    Ok(page.finish())
}

fn facts(summary: &Summary<'_>) -> Vec<(&'static str, String)> {
    let (body, progress) = (summary.body, summary.progress);
    let outcome = match summary.ended {
        Ended::Finished => "finished".to_owned(),
        Ended::Diverged { t, place } => format!("diverged at t = {t:.6} s, first at {place}"),
        Ended::Refused { t, reason } => format!("refused at t = {t:.6} s: {reason}"),
        Ended::Interrupted { t } => format!("interrupted at t = {t:.6} s"),
    };
    let work = progress.work;
    let mut facts = vec![
        ("outcome", outcome),
        (
            "time",
            format!(
                "{:.6} s in {} steps of {}",
                summary.t,
                summary.steps,
                summary.stepping.length_in_words()
            ),
        ),
        (
            "integrator",
            summary.stepping.methods_in_words().replace('`', ""),
        ),
        (
            "work",
            format!("{} sweeps, {} solves", work.sweeps, work.solves),
        ),
    ];
    if let Some(body) = body.model().body() {
        let report = body.model.report();
        facts.push((
            "body",
            format!(
                "{} nodes, {} tetrahedra, {:.4e} m3, {:.4e} kg",
                report.nodes, report.tets, report.volume, report.mass
            ),
        ));
        let seen = &progress.seen;
        let most = seen.displacement;
        facts.push((
            "largest displacement",
            format!(
                "{:.4e} m at t = {:.6} s, node {}",
                most.value, most.t, most.at
            ),
        ));
        facts.push((
            "largest strain and rotation",
            format!(
                "{:.2} %, {:.1} degrees",
                100.0 * seen.strain.value,
                seen.rotation.value.to_degrees()
            ),
        ));
    }
    if let Some(cuts) = summary.cuts {
        facts.push(("cut", words_of_cuts(&cuts.totals, cuts.pieces)));
    }
    if work.saturated > 0 {
        facts.push((
            "guarded",
            "velocities were saturated: the motion is bounded, not accurate".to_owned(),
        ));
    }
    if work.retaken > 0 {
        facts.push((
            "current stiffness",
            format!(
                "steps, or parts of them, taken again in shorter ones: {}",
                work.retaken
            ),
        ));
    }
    if work.limiter_hits + work.fallbacks > 0 {
        facts.push((
            "energy limiter",
            format!(
                "velocities were reduced in {} steps, {} were taken again by another formula",
                work.limiter_hits, work.fallbacks
            ),
        ));
    }
    facts
}
