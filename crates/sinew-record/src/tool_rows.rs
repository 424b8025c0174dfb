//! Rows of tools: where they are, and what holds them back.

use std::fmt::Write;

use sinew_core::State;
use sinew_scene::Simulation;
use sinew_tools::{Motion, Tool, Tools};

use crate::tables;

pub(crate) const NAME: &str = "tools.csv";

/// Positions, forces and contacts of all tools.
pub(crate) struct ToolRows<'a> {
    tools: &'a Tools,
}

impl<'a> ToolRows<'a> {
    /// `None` where there is no tool.
    pub(crate) fn of(simulation: &'a Simulation) -> Option<Self> {
        let tools = simulation.model().tools()?;
        Some(Self { tools })
    }

    /// The names of the columns.
    pub(crate) fn columns(&self) -> Vec<String> {
        let mut columns = vec!["t_s".to_owned()];
        for tool in self.tools.tools() {
            let mut add = |part: &str, unit: &str| {
                let axes = ["x", "y", "z"];
                columns.extend(axes.map(|axis| format!("{}_{part}{axis}_{unit}", tool.name)));
            };
            add("", "m");
            if turns(tool) {
                add("r", "rad");
            }
            add("force_", "N");
            add("torque_", "Nm");
            let single = ["work_J", "contacts", "gap_m", "passes"];
            columns.extend(single.map(|name| format!("{}_{name}", tool.name)));
        }
        columns
    }

    /// Lines that say what is in the columns, and the line of their names.
    pub(crate) fn head(&self) -> String {
        let mut text = String::new();
        for Tool { name, .. } in self.tools.tools() {
            let _ = writeln!(
                text,
                "# {name}: force and torque about its own origin are those on the tool, means over the step before; work is done on the body; \
                 the gap is that of its deepest node; passes are the pieces in which its stroke is followed"
            );
        }
        text.push_str(&self.columns().join(","));
        text.push('\n');
        text
    }

    pub(crate) fn row(&self, out: &mut String, state: &State) {
        out.clear();
        tables::push(out, state.t());
        for (index, tool) in self.tools.tools().iter().enumerate() {
            let report = self.tools.report(state, index);
            let gap = self.tools.deepest(&state.u, state.t(), index);
            let rotation = turns(tool).then_some(report.rotation_vector);
            let vectors = [Some(report.position), rotation];
            let vectors = vectors.into_iter().flatten();
            let vectors = vectors.chain([report.force, report.torque]).flatten();
            for value in vectors.chain([report.work]) {
                out.push(',');
                tables::push(out, value);
            }
            let _ = write!(out, ",{},", report.contacts);
            tables::push(out, gap.map_or(f64::INFINITY, |depth| depth.gap));
            let _ = write!(out, ",{}", report.passes);
        }
        out.push('\n');
    }
}

/// Whether a tool is turned at some time.
fn turns(tool: &Tool) -> bool {
    match &tool.motion {
        Motion::Held(_) | Motion::Steady { .. } => false,
        Motion::Table(table) => table
            .rows()
            .iter()
            .any(|row| row.rotation_vector != [0.0; 3]),
    }
}
