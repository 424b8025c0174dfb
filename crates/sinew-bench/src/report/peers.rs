//! The table of other systems, below the case on which they were measured.

use sinew_draw::Page;
use sinew_draw::page::{Cell, Column, Table, TableRow};

use super::number;
use crate::peers::{BODY, MACHINE, MEASURED_ON, PEERS, Peer};

/// Heading, provenance and table.
pub(super) fn peers(page: &mut Page) {
    page.heading("Other systems on this cube");
    page.paragraph(&format!(
        "The cheapest run of each at about 5 % error, measured by us, once, on {MEASURED_ON}: \
         each program in its newest release, package or source of that day, on {MACHINE}, with the \
         same mesh, lumped mass and load. These are not published figures, and the input files of \
         the other programs are not kept here. The body: {BODY}."
    ));
    page.paragraph(
        "Cost is CPU time per simulated second over that of scipy's central difference at \
         1 ms, measured there: only ratios carry over to another machine, and even those belong \
         to that one. `cargo xtask bench --beside scipy` measures scipy here, in turn with \
         our methods, and names its version.",
    );
    page.paragraph(
        "Not comparable: systems with a nonlinear law (StVK, neo-Hookean, corotational) \
         do more per step, which at this load moves the body by nearly the same; those marked f32 \
         compute in single precision; set-up is in no ratio. At a load 70 times larger the law \
         itself decides: over one second linear differs from StVK by 76 %, corotational by \
         48 %, neo-Hookean by 14 %. With damping of 20/s times the mass the order \
         changes: central difference 2 ms 0.6 %, Newmark 10 ms 4.1 %, backward \
         Euler 10 ms 7.4 %.",
    );
    page.table(&Table {
        columns: vec![
            Column::sentences("system"),
            Column::text("version"),
            Column::sentences("setting"),
            Column::number("error", "%"),
            Column::number("cost", "scipy = 1")
                .explained("over that of scipy's central difference at 1 ms"),
            Column::sentences("remarks"),
        ],
        rows: PEERS.iter().map(row).collect(),
        ..Table::default()
    });
}

fn row(peer: &Peer) -> TableRow {
    let cost = peer.cost.map_or_else(|| "–".to_owned(), number::two);
    let cells = [
        peer.who,
        peer.version,
        peer.setting,
        peer.error,
        &cost,
        peer.note,
    ];
    TableRow::new(cells.map(Cell::text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::CASE;
    use crate::report::html;
    use crate::results::BenchResults;
    use sinew_measure::CaseInfo;
    use sinew_verify::Machine;

    fn table() -> String {
        let mut page = Page::new("");
        peers(&mut page);
        page.finish()
    }

    fn page(id: &str) -> String {
        let mut results = BenchResults::new("r", Machine::default());
        results.cases.push(CaseInfo {
            id: id.into(),
            ..CaseInfo::default()
        });
        html(&results)
    }

    #[test]
    fn the_systems_stand_beneath_their_cube_and_nowhere_else() {
        assert!(page(CASE).contains("MuJoCo"));
        assert!(!page("paper-cube").contains("MuJoCo"));
    }

    #[test]
    fn every_system_has_a_version_and_all_have_a_date() {
        let table = table();
        assert!(table.contains("on 20 November 2026"));
        for (who, version) in [
            ("NiftySim", "2.5"),
            ("Newton, Semi", "1.8.0"),
            ("MuJoCo flex", "4.0.0"),
        ] {
            let mut rows = table.lines().filter(|line| line.starts_with("<tr><td"));
            let row = rows.find(|row| row.contains(who)).unwrap();
            assert!(row.contains(&format!("<td>{version}</td>")), "{row}");
        }
        assert!(PEERS.iter().all(|peer| !peer.version.is_empty()));
    }

    #[test]
    fn costs_are_ratios_to_scipys_central_difference() {
        let table = table();
        let cost_of = |who: &str| {
            let mut rows = table.lines().filter(|line| line.starts_with("<tr><td"));
            let line = rows.find(|line| line.contains(who)).unwrap();
            let cells: Vec<&str> = line.split("<td class=\"n\">").collect();
            cells[2].split_once('<').unwrap().0.to_owned()
        };
        assert_eq!(cost_of("modal truncation"), "0.17");
        assert_eq!(cost_of("central difference (scipy"), "1.0");
        assert_eq!(cost_of("NiftySim"), "3.5");
        assert_eq!(cost_of("Newmark + CG, corotational"), "110");
        assert_eq!(cost_of("backward Euler"), "–");
    }
}
