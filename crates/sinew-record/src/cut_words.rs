//! A description of the cuts of a run.

use sinew_scene::CutTotals;

/// A line that describes the cuts and the pieces of the body at the end.
#[must_use]
pub fn words_of_cuts(CutTotals { report, .. }: &CutTotals, pieces: usize) -> String {
    let mut text = format!(
        "{:.4e} m2 in {} faces, {} new nodes, {} of the body",
        report.area,
        report.faces,
        report.new_nodes,
        match pieces {
            1 => "1 piece".to_owned(),
            _ => format!("{pieces} pieces"),
        }
    );
    if report.removed_tets > 0 {
        text.push_str(&format!(
            "; {} tetrahedra of {:.4e} kg taken away",
            report.removed_tets, report.removed_mass
        ));
    }
    if report.frozen_tets > 0 {
        text.push_str(&format!("; {} tetrahedra frozen", report.frozen_tets));
    }
    text
}
