//! Rows of a table of probes: the time, then the displacement of each probe.

use std::fmt::Write;

use crate::simulation::Probe;

/// Names of the columns: `t_s`, then `<probe>_u_x_m`, `<probe>_u_y_m`, `<probe>_u_z_m` of each probe (`<probe>_u_m` for an
/// oscillator).
#[must_use]
pub fn columns(probes: &[Probe]) -> Vec<String> {
    let mut columns = vec!["t_s".to_owned()];
    for Probe { name, dofs, .. } in probes {
        match dofs.len() {
            1 => columns.push(format!("{name}_u_m")),
            _ => columns.extend(["x", "y", "z"].map(|axis| format!("{name}_u_{axis}_m"))),
        }
    }
    columns
}

/// Degrees of freedom whose displacements a row takes, at least one.
#[must_use]
pub fn watched(probes: &[Probe]) -> Vec<u32> {
    let dofs = probes.iter().flat_map(|probe| &probe.dofs);
    let dofs: Vec<u32> = dofs.flatten().map(|dof| *dof as u32).collect();
    // Steps are shown to those who watch something; where all is held or moved, anything will do.
    if dofs.is_empty() { vec![0] } else { dofs }
}

/// Writes a row over the content of `out`, with the end of its line; `moving` holds the displacements (m) of the
/// [`watched`] degrees of freedom at time `t` (s). Numbers are written so that reading them gives the same bits.
pub fn write(out: &mut String, probes: &[Probe], t: f64, moving: &[f64]) {
    out.clear();
    // Writing to a string does not fail.
    let _ = write!(out, "{t:?}");
    let mut moving = moving.iter().copied();
    for probe in probes {
        for (axis, dof) in probe.dofs.iter().enumerate() {
            let value = match dof {
                Some(_) => moving.next().unwrap_or(f64::NAN),
                None => probe.prescribed(axis, t),
            };
            let _ = write!(out, ",{value:?}");
        }
    }
    out.push('\n');
}
