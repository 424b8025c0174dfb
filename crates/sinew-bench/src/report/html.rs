//! The page of a bench: one file, nothing from the network, readable without scripts.

use std::fmt::{self, Display, Write};

use super::{
    columns::{Column, columns_of},
    front::{self, front_members},
    heat_map, marks,
    markup::{escape, slugs},
    missing::{self, shown},
    number, peers, strip,
    summary::cheapest,
    verdict, work_precision,
};
use crate::results::{BenchResults, Skipped, StabilityMap};
use sinew_measure::{ACCURATE, CaseInfo, Row, RowVerdict};

/// The whole page.
#[must_use]
pub fn html(results: &BenchResults) -> String {
    let mut page = Page::default();
    page.put(format_args!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>sinew bench, {}</title>\n<style>\n{}</style>\n</head>\n<body>\n",
        Escaped(&results.revision),
        include_str!("report.css")
    ));
    let missing = results.all_missing();
    page.header(results, missing.len());
    page.how_to_read();
    let ids = results.case_ids();
    let anchors = slugs(&ids);
    page.out.push_str(&marks::section(&results.marks));
    page.summary(results, &ids, &anchors);
    page.maps(&results.maps);
    for (id, anchor) in ids.iter().zip(&anchors) {
        page.case(results, id, anchor);
    }
    page.skipped(&results.skipped);
    page.out.push_str(&missing::section(&missing));
    page.put(format_args!(
        "<script>\n{}</script>\n</body>\n</html>\n",
        include_str!("sort.js")
    ));
    page.out
}

#[derive(Default)]
struct Page {
    out: String,
}

impl Page {
    fn put(&mut self, arguments: fmt::Arguments<'_>) {
        // Writing into a String cannot fail.
        let _ = self.out.write_fmt(arguments);
    }

    fn header(&mut self, results: &BenchResults, missing: usize) {
        let machine = &results.machine;
        self.out
            .push_str("<header>\n<h1>What accuracy costs: methods, steps, verdicts</h1>\n");
        let system = format!("{} {}", machine.os, machine.arch);
        self.facts(&[
            ("revision", results.revision.clone()),
            ("date", results.date.clone().unwrap_or_default()),
            ("processor", machine.cpu.clone()),
            ("threads", machine.threads.to_string()),
            ("system", system.trim().to_owned()),
            ("compiler", machine.compiler.clone().unwrap_or_default()),
            ("runs", runs(results, missing)),
        ]);
        self.out.push_str("</header>\n");
    }

    fn how_to_read(&mut self) {
        self.out.push_str(
            "<section>\n<h2 id=\"how-to-read\">How to read this</h2>\n<ul>\n\
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
            self.put(format_args!(
                "<span class=\"sign\" style=\"background:{}\">{}</span> {} ({}){}",
                verdict::tint(verdict),
                verdict.symbol(),
                verdict.word(),
                Escaped(verdict::meaning(verdict)),
                if verdict == RowVerdict::Diverged {
                    ".</li>\n"
                } else {
                    ", "
                }
            ));
        }
        self.out.push_str(
            "<li><b>Times</b> are thread CPU time, the median of several repeats, per simulated \
             second and without the set-up, which has a column of its own. They belong to one \
             machine: <b>compare ratios, not seconds</b>. Work counts (sweeps, solves) are the \
             same everywhere.</li>\n\
             <li><b>Pareto</b> (●, ringed in the plots): no other run of the case is at least as \
             cheap and at least as accurate. Small differences in time are noise, so a run just \
             off the front is as good. Runs worse than returning zero are never on it.</li>\n\
             </ul>\n</section>\n",
        );
    }

    fn summary(&mut self, results: &BenchResults, ids: &[&str], anchors: &[String]) {
        const LIMITS: [f64; 3] = [ACCURATE, 0.01, 0.001];
        if ids.is_empty() {
            return;
        }
        self.out.push_str(
            "<section>\n<h2 id=\"summary\">The cheapest run that is good enough</h2>\n\
             <div class=\"wide\"><table class=\"summary\">\n<thead><tr><th>case</th>",
        );
        for limit in LIMITS {
            let limit = number::short(100.0 * limit);
            self.put(format_args!("<th>error at most {limit} %</th>"));
        }
        self.out.push_str("</tr></thead>\n<tbody>\n");
        for (id, anchor) in ids.iter().zip(anchors) {
            self.put(format_args!(
                "<tr><td><a href=\"#case-{}\">{}</a></td>",
                Escaped(anchor),
                Escaped(id)
            ));
            for limit in LIMITS {
                match cheapest(results.rows_of(id), limit) {
                    Some(row) => self.put(format_args!(
                        "<td>{}, {} ms<small>error {}, {} CPU s/s</small></td>",
                        Escaped(&row.label()),
                        number::milliseconds(row.dt),
                        verdict::error_with_unit(row),
                        number::three(row.cpu_s_per_s)
                    )),
                    None => self.out.push_str("<td class=\"none\">none</td>"),
                }
            }
            self.out.push_str("</tr>\n");
        }
        self.out.push_str("</tbody>\n</table></div>\n</section>\n");
    }

    fn maps(&mut self, maps: &[StabilityMap]) {
        if maps.is_empty() {
            return;
        }
        self.out.push_str(
            "<section>\n<h2 id=\"maps\">Where methods hold: step against one property of the scene</h2>\n\
             <p>Every square is a run on a small cube, coloured by its error. The line is the largest \
             stable step that each method computes from the matrices before it runs: theory, next to \
             the runs. With dashpots it is a bound from below, and the paper's network has none. \
             <b>Bounded is not accurate</b>: where there is no line, only the colour tells how far a \
             method can be trusted.</p>\n",
        );
        for map in maps {
            self.figure(&heat_map(map));
        }
        self.out.push_str("</section>\n");
    }

    fn case(&mut self, results: &BenchResults, id: &str, anchor: &str) {
        let info = results.case(id);
        let title = info.map_or(id, |info| info.title.as_str());
        self.put(format_args!(
            "<section>\n<h2 id=\"case-{}\">{} <code>{}</code></h2>\n",
            Escaped(anchor),
            Escaped(title),
            Escaped(id)
        ));
        if let Some(info) = info {
            self.case_facts(info);
        }
        let rows: Vec<&Row> = results.rows_of(id).collect();
        if rows.is_empty() {
            self.out.push_str("<p class=\"none\">No run.</p>\n");
        } else {
            self.figure(&work_precision(results, id).svg());
            self.front(results, id);
            self.figure(&strip(results, id));
            self.runs(&rows);
            self.findings(&rows);
        }
        if id == crate::peers::CASE {
            self.out.push_str(&peers::peers());
        }
        self.out.push_str("</section>\n");
    }

    fn case_facts(&mut self, info: &CaseInfo) {
        let metres = |x: f64| shown(1e3 * x, |mm| format!("{} mm", number::three(mm)));
        let critical = info.critical_step_s.map(|dt| {
            shown(1e3 * dt, |dt| {
                let dt = number::three(dt);
                format!("{dt} ms (2/ω of the fastest mode, undamped)")
            })
        });
        self.facts(&[
            ("free degrees of freedom", info.dofs.to_string()),
            (
                "simulated time",
                shown(info.duration_s, |s| format!("{} s", number::short(s))),
            ),
            ("critical step", critical.unwrap_or_default()),
            ("reference", info.reference.clone()),
            (
                "its own estimated error",
                shown(100.0 * info.reference_error, |x| {
                    format!("{} %", number::three(x))
                }),
            ),
            ("largest |u| in it", metres(info.max_u_m)),
            (
                "its late amplitude",
                format!(
                    "{} (half the range of the worst dof over the last fifth)",
                    metres(info.late_amplitude_m)
                ),
            ),
        ]);
    }

    /// Who is on the front, and why.
    fn front(&mut self, results: &BenchResults, id: &str) {
        self.out.push_str("<h3>The front</h3>\n<ul>\n");
        for member in front_members(results, id) {
            self.put(format_args!(
                "<li><b>{}</b>: {}. <small>{}</small></li>\n",
                Escaped(&member.label),
                Escaped(&member.says),
                Escaped(&member.summary)
            ));
        }
        self.out.push_str("</ul>\n");
        for sentence in front::sentences(results, id) {
            self.put(format_args!("<p>{}</p>\n", Escaped(&sentence)));
        }
    }

    /// The facts of the methods' set-ups, folded away.
    fn findings(&mut self, rows: &[&Row]) {
        let telling: Vec<&&Row> = rows.iter().filter(|row| !row.facts.is_empty()).collect();
        if telling.is_empty() {
            return;
        }
        self.out.push_str(
            "<details>\n<summary>What methods found out at set-up</summary>\n\
             <p>A certificate below 1 proves that a stabilised network cannot gain energy on this \
             case at this step. <code>left_out</code> is what a truncated method estimates it loses.</p>\n<ul>\n",
        );
        for row in telling {
            let facts = row.facts.iter();
            let facts: Vec<String> = facts
                .map(|(name, value)| format!("{name} {}", shown(*value, number::short)))
                .collect();
            self.put(format_args!(
                "<li>{}, {} ms: {}</li>\n",
                Escaped(&row.label()),
                number::milliseconds(row.dt),
                Escaped(&facts.join(", "))
            ));
        }
        self.out.push_str("</ul>\n</details>\n");
    }

    /// Facts; empty ones are left out.
    fn facts(&mut self, facts: &[(&str, String)]) {
        self.out.push_str("<dl>\n");
        for (name, value) in facts.iter().filter(|(_, value)| !value.is_empty()) {
            self.put(format_args!("<dt>{name}</dt><dd>{}</dd>\n", Escaped(value)));
        }
        self.out.push_str("</dl>\n");
    }

    fn figure(&mut self, svg: &str) {
        self.put(format_args!("<div class=\"wide plot\">\n{svg}</div>\n"));
    }

    fn runs(&mut self, rows: &[&Row]) {
        let columns = columns_of(rows);
        self.out
            .push_str("<h3>All runs</h3>\n<div class=\"wide\"><table class=\"runs\">\n<thead><tr>");
        for column in &columns {
            self.put(format_args!(
                "<th{} title=\"{}\">{}<small>{}</small></th>",
                class(column),
                Escaped(column.explained),
                column.head,
                column.unit
            ));
        }
        self.out.push_str("</tr></thead>\n<tbody>\n");
        let mut last = None;
        for row in rows {
            let label = row.label();
            let classes = match (last.as_ref() != Some(&label), row.pareto) {
                (true, true) => " class=\"new pareto\"",
                (true, false) => " class=\"new\"",
                (false, true) => " class=\"pareto\"",
                (false, false) => "",
            };
            self.put(format_args!("<tr{classes}>"));
            for column in &columns {
                self.cell(column, row);
            }
            self.out.push_str("</tr>\n");
            last = Some(label);
        }
        self.out.push_str("</tbody>\n</table></div>\n");
    }

    fn cell(&mut self, column: &Column, row: &Row) {
        let key = column.key.map(|key| key(row));
        let key = key.map_or_else(String::new, |key| {
            // As scripts write it.
            let infinite = if key.is_finite() {
                None
            } else {
                Some("Infinity")
            };
            let key = key.to_string();
            format!(" data-k=\"{}\"", infinite.unwrap_or(&key))
        });
        let cell = (column.cell)(row);
        if column.head == "error" {
            let verdict = row.verdict();
            let symbol = match verdict {
                // The cell says so in words.
                RowVerdict::Diverged => "",
                verdict => verdict.symbol(),
            };
            self.put(format_args!(
                "<td class=\"n verdict\" style=\"background:{}\" title=\"{}\"{key}>{} {symbol}</td>",
                verdict::tint(verdict),
                verdict.word(),
                Escaped(&cell),
            ));
        } else {
            self.put(format_args!(
                "<td{}{key}>{}</td>",
                class(column),
                Escaped(&cell)
            ));
        }
    }

    fn skipped(&mut self, skipped: &[Skipped]) {
        if skipped.is_empty() {
            return;
        }
        self.out.push_str(
            "<section>\n<h2 id=\"not-run\">Not run</h2>\n<div class=\"wide\"><table>\n\
             <thead><tr><th>case</th><th>method</th><th class=\"n\">dt [ms]</th><th>why</th></tr></thead>\n\
             <tbody>\n",
        );
        for run in skipped {
            self.put(format_args!(
                "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
                Escaped(&run.case),
                Escaped(&run.integrator),
                number::milliseconds(run.dt),
                Escaped(&run.reason)
            ));
        }
        self.out.push_str("</tbody>\n</table></div>\n</section>\n");
    }
}

struct Escaped<'a>(&'a str);

impl Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&escape(self.0))
    }
}

fn class(column: &Column) -> &'static str {
    if column.key.is_some() {
        " class=\"n\""
    } else {
        ""
    }
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
    use crate::results::{Machine, MapPanel, MapRun, Mark};
    use sinew_measure::RowOutcome;

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

    /// Runs that end in all ways on the peers' cube, a mark, a map, and what is missing.
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
            "<table class=\"peers\"",
            "<table class=\"marks\"",
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
