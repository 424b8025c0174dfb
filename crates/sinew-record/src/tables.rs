//! Rows of probes, energies and reactions.

use std::fmt::Write;

use sinew_core::{LoadTime, Moment};
use sinew_fem::On;
use sinew_scene::{HeldParts, HeldPlace, ProbeRows, ReactionOf, SceneBody};

use crate::balance::{Balance, Energies};
use crate::error::RecordRunError;

pub(crate) const PROBES: &str = "probes.csv";
pub(crate) const ENERGY: &str = "energy.csv";
pub(crate) const REACTIONS: &str = "reactions.csv";

/// A line with the position of each probe, and the line of column names.
pub(crate) fn probes_head(body: &SceneBody) -> String {
    let mut text = String::new();
    for probe in body.probes().iter() {
        let place = match (&probe.node, body.model().body()) {
            (Some(node), Some(body)) => {
                let [x, y, z] = body.mesh.points[node.index as usize];
                let (tag, distance) = (node.tag, node.distance);
                format!(
                    "node {tag} at {x:?} {y:?} {z:?} m, {distance:?} m from the point asked for"
                )
            }
            (None, Some(_)) => probe.place.clone(),
            (_, None) => continue,
        };
        text.push_str(&format!("# {}: {place}\n", probe.name));
    }
    text.push_str(&ProbeRows::new(body).columns().join(","));
    text.push('\n');
    text
}

/// The line of column names. The work of tools has a column if there are tools, the energy of cuts if there may be
/// cuts, and the energy that the method dissipates if it is known; the energy that memory dissipates is part of the
/// remainder.
pub(crate) fn energy_head(balance: &Balance) -> String {
    let column = |is_there: bool, name: &'static str| if is_there { name } else { "" };
    let tools = column(balance.has_tools(), "work_of_tools_J,");
    let cuts = column(balance.has_cuts(), "of_cuts_J,");
    let method = column(balance.knows_method(), "method_J,");
    let memory = column(balance.has_memory(), "memory_and_");
    format!(
        "t_s,kinetic_J,elastic_J,work_of_loads_J,work_of_supports_J,{tools}{cuts}damped_J,{method}{memory}remainder_J\n"
    )
}

pub(crate) fn energy_row(out: &mut String, row: &Energies) {
    out.clear();
    push(out, row.t);
    let columns = [row.kinetic, row.elastic, row.loads, row.supports];
    let columns = columns.into_iter().chain(row.tools).chain(row.cuts);
    let columns = columns.chain([row.damped]);
    for value in columns.chain(row.method).chain([row.remainder]) {
        out.push(',');
        push(out, value);
    }
    out.push('\n');
}

/// Appends a number in a form that is read back with the same bits.
pub(crate) fn push(out: &mut String, value: f64) {
    // Writing to a string does not fail.
    let _ = write!(out, "{value:?}");
}

/// The first lines of the table of the forces and moments of supports.
pub(crate) fn reactions_head(held: &HeldParts) -> String {
    let mut text = String::new();
    let mut columns = vec!["t_s".to_owned()];
    for part in held.parts() {
        let (name, [x, y, z]) = (column_name(part), part.centre);
        text.push_str(&format!(
            "# {name}: {}; the moment is about {x:?} {y:?} {z:?} m, the mean of its nodes at rest\n",
            table_of(part)
        ));
        columns.extend(["x", "y", "z"].map(|axis| format!("{name}_f_{axis}_N")));
        columns.extend(["x", "y", "z"].map(|axis| format!("{name}_m_{axis}_Nm")));
    }
    text.push_str(&columns.join(","));
    text.push('\n');
    text
}

/// A row of that table, with the times (s) between it and its two neighbours. If the velocity of a moved part jumps,
/// each row includes its share, so that all rows together contain the whole impulse.
pub(crate) fn reactions_row(
    out: &mut String,
    held: &mut HeldParts,
    moment: &Moment<'_>,
    [before, after]: [f64; 2],
) -> Result<(), RecordRunError> {
    let t = moment.state.t();
    let when = LoadTime::around(t, before, after).under(moment.inputs);
    held.take(when, moment.state)?;
    out.clear();
    push(out, t);
    for part in held.parts() {
        for value in held.force_and_moment(part).as_flattened() {
            out.push(',');
            push(out, *value);
        }
    }
    out.push('\n');
    Ok(())
}

/// The table of the scene that fixes or moves a part, and the part.
pub(crate) fn table_of(part: &HeldPlace) -> String {
    format!("{} on {}", part.by, part.on)
}

/// The beginning of the names of a part's columns, such as `fixed_1_bottom`: a name without commas and quotes.
pub fn column_name(part: &HeldPlace) -> String {
    let (table, index) = match part.by {
        ReactionOf::Fixed(index) => ("fixed", index),
        ReactionOf::Move(index) => ("move", index),
    };
    let plain = |c: char| if c.is_alphanumeric() { c } else { '_' };
    let name: String = match &part.on {
        On::Group(name) => name.chars().map(plain).collect(),
        _ => String::new(),
    };
    let name = format!("{table}_{}_{name}", index + 1);
    name.trim_end_matches('_').to_owned()
}
