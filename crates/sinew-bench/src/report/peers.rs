//! The table of other systems, beneath the case they were measured on.

use std::fmt::Write;

use super::{markup::escape, number};
use crate::peers::{BODY, MACHINE, MEASURED_ON, PEERS};

/// Heading, provenance and table, as HTML.
pub(super) fn peers() -> String {
    let mut out = format!(
        "<h3>Other systems on this cube</h3>\n\
         <p>The cheapest run of each at about 5&nbsp;% error, measured by us, once, on {MEASURED_ON}: \
         each program in its newest release, package or source of that day, on {MACHINE}, with the \
         same mesh, lumped mass and load. These are not published figures, and the input files of \
         the other programs are not kept here. The body: {BODY}.</p>\n\
         <p>Cost is CPU time per simulated second over that of scipy's central difference at \
         1&nbsp;ms, measured there: only ratios carry over to another machine, and even those belong \
         to that one. <code>cargo xtask bench --beside scipy</code> measures scipy here, in turn with \
         our methods, and names its version.</p>\n\
         <p><b>Not comparable:</b> systems with a nonlinear law (StVK, neo-Hookean, corotational) \
         do more per step, which at this load moves the body by nearly the same; those marked f32 \
         compute in single precision; set-up is in no ratio. At a load 70 times larger the law \
         itself decides: over one second linear differs from StVK by 76&nbsp;%, corotational by \
         48&nbsp;%, neo-Hookean by 14&nbsp;%. With damping of 20/s times the mass the order \
         changes: central difference 2&nbsp;ms 0.6&nbsp;%, Newmark 10&nbsp;ms 4.1&nbsp;%, backward \
         Euler 10&nbsp;ms 7.4&nbsp;%.</p>\n\
         <div class=\"wide\"><table class=\"peers\">\n<thead><tr><th>system</th><th>version</th><th>setting</th>\
         <th class=\"n\">error<small>%</small></th>\
         <th class=\"n\">cost<small>scipy's central difference at 1 ms = 1</small></th>\
         <th></th></tr></thead>\n<tbody>\n",
    );
    for peer in &PEERS {
        let cost = peer.cost.map_or_else(|| "–".to_owned(), number::two);
        // Writing into a String cannot fail.
        let _ = writeln!(
            out,
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{cost}</td><td>{}</td></tr>",
            escape(peer.who),
            escape(peer.version),
            escape(peer.setting),
            escape(peer.error),
            escape(peer.note)
        );
    }
    out.push_str("</tbody>\n</table></div>\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::peers::CASE;
    use crate::report::html;
    use crate::results::{BenchResults, Machine};
    use sinew_measure::CaseInfo;

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
        let table = peers();
        assert!(table.contains("on 20 November 2026"));
        for (who, version) in [
            ("NiftySim", "2.5"),
            ("Newton, Semi", "1.8.0"),
            ("MuJoCo flex", "4.0.0"),
        ] {
            let mut rows = table.lines().filter(|line| line.starts_with("<tr><td>"));
            let row = rows.find(|row| row.contains(who)).unwrap();
            assert!(row.contains(&format!("<td>{version}</td>")), "{row}");
        }
        assert!(PEERS.iter().all(|peer| !peer.version.is_empty()));
    }

    #[test]
    fn costs_are_ratios_to_scipys_central_difference() {
        let table = peers();
        let cost_of = |who: &str| {
            let mut rows = table.lines().filter(|line| line.starts_with("<tr><td>"));
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
