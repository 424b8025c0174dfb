//! Rows of probes, energies and reactions.

use std::fmt::Write;
use std::sync::Arc;

use sinew_core::{LoadTime, Moment};
use sinew_fem::On;
use sinew_scene::{BodyModel, ProbeRows, ReactionOf, Simulation};

use crate::balance::{Balance, Energies};
use crate::error::RecordRunError;

pub(crate) const PROBES: &str = "probes.csv";
pub(crate) const ENERGY: &str = "energy.csv";
pub(crate) const REACTIONS: &str = "reactions.csv";

/// A line that says where each probe is, and the line of column names.
pub(crate) fn probes_head(simulation: &Simulation) -> String {
    let mut text = String::new();
    for probe in simulation.probes().iter() {
        let place = match (&probe.node, simulation.model().body()) {
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
    text.push_str(&ProbeRows::new(simulation).columns().join(","));
    text.push('\n');
    text
}

/// The line of column names. The work of tools has a column if there are tools, the energy of cuts if there may be
/// cuts, and the energy that the method takes if it is known; the energy that memory takes is part of the remainder.
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

/// A number that reads back with the same bits.
pub(crate) fn push(out: &mut String, value: f64) {
    // Writing to a string does not fail.
    let _ = write!(out, "{value:?}");
}

/// A part of the body that is held or moved.
#[derive(Debug, Clone)]
pub(crate) struct HeldPart {
    /// The beginning of its columns' names.
    pub(crate) name: String,
    /// Description of the table that holds or moves it.
    pub(crate) by: String,
    /// Its nodes, with the components that it holds and no part before it does.
    nodes: Vec<(u32, [bool; 3])>,
    /// Mean of its nodes at rest (m), about which moments are taken.
    pub(crate) centre: [f64; 3],
}

/// Forces and moments of supports.
pub(crate) struct Reactions {
    body: Arc<BodyModel>,
    pub(crate) parts: Vec<HeldPart>,
    forces: Vec<[f64; 3]>,
    u: Vec<[f64; 3]>,
}

impl Reactions {
    /// `None` where nothing is held or moved.
    pub(crate) fn of(simulation: &Simulation) -> Result<Option<Self>, RecordRunError> {
        let Some(body) = simulation.model().body() else {
            return Ok(None);
        };
        let parts: Vec<HeldPart> = simulation
            .held_parts()?
            .into_iter()
            .map(|held| HeldPart {
                name: column_name(held.by, &held.on),
                by: format!("{} on {}", held.by, held.on),
                nodes: held.nodes,
                centre: held.centre,
            })
            .collect();
        let nodes = body.mesh.points.len();
        Ok((!parts.is_empty()).then(|| Self {
            body: Arc::clone(body),
            parts,
            forces: vec![[0.0; 3]; nodes],
            u: vec![[0.0; 3]; nodes],
        }))
    }

    pub(crate) fn head(&self) -> String {
        let mut text = String::new();
        let mut columns = vec!["t_s".to_owned()];
        for HeldPart {
            name, by, centre, ..
        } in &self.parts
        {
            let [x, y, z] = centre;
            text.push_str(&format!(
                "# {name}: {by}; the moment is about {x:?} {y:?} {z:?} m, the mean of its nodes at rest\n"
            ));
            columns.extend(["x", "y", "z"].map(|axis| format!("{name}_f_{axis}_N")));
            columns.extend(["x", "y", "z"].map(|axis| format!("{name}_m_{axis}_Nm")));
        }
        text.push_str(&columns.join(","));
        text.push('\n');
        text
    }

    /// A row, with the times (s) between it and its two neighbours. If the speed of a moved part jumps, each row
    /// includes its share, so that all rows together have the whole impulse.
    pub(crate) fn row(
        &mut self,
        out: &mut String,
        moment: &Moment<'_>,
        [before, after]: [f64; 2],
    ) -> Result<(), RecordRunError> {
        let body = &self.body;
        let (t, u) = (moment.state.t(), &moment.state.u);
        let when = LoadTime::around(t, before, after).under(moment.inputs);
        body.model
            .reactions_in(when, moment.state, &mut self.forces)?;
        body.subtract_contact(moment.state, &mut self.forces);
        body.model.displacements_at(when, u, &mut self.u)?;
        out.clear();
        push(out, t);
        for part in &self.parts {
            let (mut force, mut torque) = ([0.0; 3], [0.0; 3]);
            for (node, own) in &part.nodes {
                let node = *node as usize;
                let f: [f64; 3] = std::array::from_fn(|axis| match own[axis] {
                    true => self.forces[node][axis],
                    false => 0.0,
                });
                let (point, moved) = (body.mesh.points[node], self.u[node]);
                let arm: [f64; 3] =
                    std::array::from_fn(|axis| point[axis] + moved[axis] - part.centre[axis]);
                let cross = [
                    arm[1] * f[2] - arm[2] * f[1],
                    arm[2] * f[0] - arm[0] * f[2],
                    arm[0] * f[1] - arm[1] * f[0],
                ];
                for axis in 0..3 {
                    force[axis] += f[axis];
                    torque[axis] += cross[axis];
                }
            }
            for value in force.into_iter().chain(torque) {
                out.push(',');
                push(out, value);
            }
        }
        out.push('\n');
        Ok(())
    }
}

/// A name without commas and quotes, such as `fixed_1_bottom`.
fn column_name(by: ReactionOf, on: &On) -> String {
    let (table, index) = match by {
        ReactionOf::Fixed(index) => ("fixed", index),
        ReactionOf::Move(index) => ("move", index),
    };
    let plain = |c: char| if c.is_alphanumeric() { c } else { '_' };
    let name: String = match on {
        On::Group(name) => name.chars().map(plain).collect(),
        _ => String::new(),
    };
    let name = format!("{table}_{}_{name}", index + 1);
    name.trim_end_matches('_').to_owned()
}
