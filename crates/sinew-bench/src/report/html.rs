//! The page of a bench.

use sinew_draw::Page;
use sinew_draw::markup::{escape, slugs};
use sinew_draw::page::{Cell, Column, Table, TableRow};
use sinew_measure::RowVerdict;

use super::summary::{GOOD_ENOUGH, cheapest};
use super::{case_section, heat_map, marks, missing, number, verdict};
use crate::results::{BenchResults, Skipped, StabilityMap};

/// The whole page.
#[must_use]
pub fn html(results: &BenchResults) -> String {
    let mut page = Page::new(title(results));
    let missing = results.all_missing();
    header(&mut page, results, missing.len());
    how_to_read(&mut page, results);
    let ids = results.case_ids();
    let anchors = slugs(&ids);
    marks::section(&mut page, &results.marks);
    summary(&mut page, results, &ids, &anchors);
    maps(&mut page, &results.maps);
    for (id, anchor) in ids.iter().zip(&anchors) {
        case_section::write(&mut page, results, id, &case_anchor(anchor));
    }
    skipped(&mut page, &results.skipped);
    missing::section(&mut page, &missing);
    page.finish()
}

/// Title of a page: pages in neighbouring tabs of a browser have different titles.
fn title(results: &BenchResults) -> String {
    let subject = match &results.subject {
        Some(subject) => subject,
        None if results.marks.is_empty() && results.maps.is_empty() => {
            "What accuracy costs: methods, steps, verdicts"
        }
        None => "Hard cases: where methods fail, and what is asked of them",
    };
    format!("sinew bench. {subject}")
}

fn case_anchor(slug: &str) -> String {
    format!("case-{slug}")
}

fn header(page: &mut Page, results: &BenchResults, missing: usize) {
    let machine = &results.machine;
    let system = format!("{} {}", machine.os, machine.arch);
    page.facts([
        ("revision", results.revision.clone()),
        ("date", results.date.clone().unwrap_or_default()),
        ("processor", machine.cpu.clone()),
        ("threads", machine.threads.to_string()),
        ("system", system.trim().to_owned()),
        ("compiler", machine.compiler.clone().unwrap_or_default()),
        ("runs", runs(results, missing)),
    ]);
}

fn how_to_read(page: &mut Page, results: &BenchResults) {
    page.section("how-to-read", "How to read this");
    page.markup(
        "<ul>\n\
         <li><b>Error</b> is the relative L2 error of the displacement over all free degrees of \
         freedom and the sampled instants, against the reference of the case. <b>Returning zero \
         scores 100&nbsp;%</b>, so a larger error is worse than doing nothing. An error below the \
         reference's own estimated error says nothing; \"&lt; x\" is one below what the reference \
         of a large body can tell, a hundred times its own error.</li>\n\
         <li><b>Stable is not accurate.</b> A run can be bounded and wrong. Each run therefore \
         has three verdicts: is it bounded, does it settle as the reference does, and how large \
         is its error.</li>\n<li>",
    );
    for verdict in RowVerdict::ALL {
        page.markup(&format!(
            "<span class=\"sign\" style=\"background:{}\">{}</span> {} ({}){}",
            verdict::tint(verdict),
            verdict.symbol(),
            verdict.word(),
            escape(verdict::meaning(verdict)),
            if Some(&verdict) == RowVerdict::ALL.last() {
                ".</li>\n"
            } else {
                ", "
            }
        ));
    }
    page.markup(
        "<li><b>Times</b> are thread CPU time, the median of several repeats, per simulated \
         second and without the set-up, which has a column of its own. They belong to one \
         machine: <b>compare ratios, not seconds</b>. Work counts (sweeps, solves) are the \
         same everywhere.</li>\n\
         <li><b>Pareto</b> (●, ringed in the plots): no other run of the case is at least as \
         cheap and at least as accurate. Small differences in time are noise, so a run just \
         off the front is as good. Runs with an error above 50&nbsp;% are never on it, and the plots ring \
         none beyond the first with an error below 10<sup>−6</sup>&nbsp;%. Curves that lie under \
         others show as rims; a pointer over a mark names all runs there, a click on a name keeps \
         its curve in view.</li>\n",
    );
    if results
        .rows
        .iter()
        .any(|row| row.smallest_volume_ratio.is_some())
    {
        page.markup(
            "<li><b>Large deformation</b>: the error is that in time, against the same body in steps of no length. The <b>mesh error</b> \
             beside it is that of the mesh and its element alone, against finer meshes, and the same for all methods. <b>Times</b> is \
             the cost over that of central difference whose steps follow the stiffness. <b>Energy rise</b> is the largest excess of the energy \
             over that of the start and the work of loads since, with no share of damping. <b>Least J</b> is the smallest volume of an \
             element, over all steps, over that at rest.</li>\n",
        );
    }
    page.markup("</ul>\n");
}

fn summary(page: &mut Page, results: &BenchResults, ids: &[&str], anchors: &[String]) {
    if ids.is_empty() {
        return;
    }
    page.section("summary", "The cheapest run that is good enough");
    let limits = GOOD_ENOUGH.map(|limit| {
        let limit = number::short(100.0 * limit);
        Column::sentences(format!("error at most {limit} %"))
    });
    let rows = ids.iter().zip(anchors).map(|(id, anchor)| {
        let case = Cell::text(*id).linked(case_anchor(anchor));
        let cells = GOOD_ENOUGH.map(|limit| match cheapest(results.rows_of(id), limit) {
            Some(row) => Cell::text(format!(
                "{}, {} ms",
                row.label(),
                number::milliseconds(row.dt)
            ))
            .noted(format!(
                "error {}, {} CPU s/s",
                verdict::error_with_unit(row),
                number::three(row.cpu_s_per_s)
            )),
            None => Cell::text("none"),
        });
        TableRow::new([case].into_iter().chain(cells))
    });
    page.table(&Table {
        columns: [Column::text("case")].into_iter().chain(limits).collect(),
        rows: rows.collect(),
        ..Table::default()
    });
}

fn maps(page: &mut Page, maps: &[StabilityMap]) {
    if maps.is_empty() {
        return;
    }
    page.section(
        "maps",
        "Where methods hold: step against one property of the scene",
    );
    page.markup(
        "<p>Every square is a run on a small cube, coloured by its error. The line is the largest \
         stable step that each method computes from the matrices before it runs: theory, next to \
         the runs. With dashpots it is a bound from below, and the paper's network has none. \
         <b>Bounded is not accurate</b>: where there is no line, only the colour tells how far a \
         method can be trusted.</p>\n",
    );
    for map in maps {
        page.figure(&heat_map(map), "");
    }
}

fn skipped(page: &mut Page, skipped: &[Skipped]) {
    if skipped.is_empty() {
        return;
    }
    page.section("not-run", "Not run");
    let row = |run: &Skipped| {
        TableRow::new([
            Cell::text(&run.case),
            Cell::text(&run.integrator),
            Cell::text(number::milliseconds(run.dt)),
            Cell::text(&run.reason),
        ])
    };
    page.table(&Table {
        columns: vec![
            Column::text("case"),
            Column::text("method"),
            Column::number("dt", "ms"),
            Column::sentences("why"),
        ],
        rows: skipped.iter().map(row).collect(),
        ..Table::default()
    });
}

fn runs(results: &BenchResults, missing: usize) -> String {
    let (cases, rows) = (results.case_ids().len(), results.rows.len());
    let skipped = match results.skipped.len() {
        0 => String::new(),
        n => format!(", {n} not run (listed at the end)"),
    };
    let missing = match missing {
        0 => String::new(),
        n => format!(", {n} things missing (listed at the end)"),
    };
    format!("{rows} in {cases} cases{skipped}{missing}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers;
    use crate::results::{MapPanel, MapRun, Mark};
    use sinew_measure::{CaseInfo, Row, RowOutcome};
    use sinew_verify::Machine;

    #[test]
    fn nothing_from_the_results_escapes_into_markup() {
        let evil = "<script>alert(\"&'\")</script>".to_owned();
        let mut results = BenchResults::new(
            evil.clone(),
            Machine {
                cpu: evil.clone(),
                os: evil.clone(),
                arch: evil.clone(),
                compiler: Some(evil.clone()),
                ..Machine::default()
            },
        );
        results.date = Some(evil.clone());
        results.cases.push(CaseInfo {
            id: evil.clone(),
            title: evil.clone(),
            reference: evil.clone(),
            ..CaseInfo::default()
        });
        results.rows.push(Row {
            case: evil.clone(),
            integrator: evil.clone(),
            options: [(evil.clone(), evil.clone().into())].into(),
            dt: 0.01,
            error: Some(0.01),
            bounded: true,
            ..Row::default()
        });
        results.skipped.push(Skipped {
            case: evil.clone(),
            integrator: evil.clone(),
            dt: 0.1,
            reason: evil.clone(),
        });
        let page = html(&results);
        assert!(!page.contains("<script>alert"));
        assert_eq!(page.matches("<script>").count(), 1);
        assert!(
            page.matches("&lt;script&gt;alert(&quot;&amp;&#39;&quot;)")
                .count()
                > 10
        );
    }

    /// Runs with all kinds of outcomes on the peers' cube, a mark, a map, and missing results.
    fn every_kind_of_result() -> BenchResults {
        let mut results = BenchResults::new("r", Machine::default());
        results.cases.push(CaseInfo {
            id: peers::CASE.into(),
            critical_step_s: Some(3e-3),
            max_u_m: f64::INFINITY,
            ..CaseInfo::default()
        });
        let sound = Row {
            case: peers::CASE.into(),
            integrator: "rk4".into(),
            dt: 1e-3,
            bounded: true,
            error: Some(0.01),
            max_u: Some(1e-4),
            late_amplitude: Some(0.0),
            cpu_s_per_s: 0.1,
            facts: [("degree".to_owned(), 8.0)].into(),
            pareto: true,
            ..Row::default()
        };
        results.rows = vec![
            Row {
                guarded: true,
                dt: 2e-3,
                ..sound.clone()
            },
            Row {
                outcome: RowOutcome::Diverged,
                error: None,
                dt: 4e-3,
                ..sound.clone()
            },
            sound,
        ];
        results.marks.push(Mark::default());
        results.maps.push(StabilityMap {
            id: "map".into(),
            values: vec![1.0, 2.0],
            steps: vec![1e-3, 2e-3],
            panels: vec![MapPanel {
                method: "rk4".into(),
                stable_steps: vec![Some(1e-3), None],
                cannot_tell: true,
                runs: vec![vec![MapRun::default(); 2]; 2],
            }],
            ..StabilityMap::default()
        });
        results.skipped.push(Skipped::default());
        results
    }

    #[test]
    fn the_page_needs_no_network() {
        let page = html(&every_kind_of_result());
        for part in [
            "Other systems on this cube",
            "id=\"marks\"",
            "id=\"maps\"",
            "id=\"missing\"",
            "degree",
        ] {
            assert!(page.contains(part), "the page has no {part}");
        }
        assert!(page.matches("<svg").count() >= 3, "strip, plot and map");
        let elsewhere = page.replace("http://www.w3.org/2000/svg", "");
        for word in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!elsewhere.contains(word), "{word}");
        }
    }
}
