//! Rows of tools: positions and contact forces.

use std::fmt::Write;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sinew_core::Moment;
use sinew_scene::SceneBody;
use sinew_tools::{Motion, Tool, ToolReport, Tools};

use crate::tables;

pub(crate) const NAME: &str = "tools.csv";

/// Impulses received by tools up to the last row: the time (s), and for each tool its impulse (N s) and angular impulse
/// (N m s).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Received {
    t: f64,
    impulses: Vec<[[f64; 3]; 2]>,
}

impl Received {
    /// The mean force (N) and torque (N m) on a tool from the last row to a time (s); for the first row those of the
    /// step before.
    fn means(&self, t: f64, index: usize, report: &ToolReport) -> [[f64; 3]; 2] {
        let span = t - self.t;
        let Some(before) = self.impulses.get(index).filter(|_| span > 0.0) else {
            return [report.force, report.torque];
        };
        let now = impulses(report);
        let mean = |vector: usize, axis: usize| (now[vector][axis] - before[vector][axis]) / span;
        [0, 1].map(|vector| [0, 1, 2].map(|axis| mean(vector, axis)))
    }

    /// Records a row.
    fn note(&mut self, t: f64, reports: impl Iterator<Item = ToolReport>) {
        self.t = t;
        self.impulses.clear();
        self.impulses
            .extend(reports.map(|report| impulses(&report)));
    }
}

fn impulses(report: &ToolReport) -> [[f64; 3]; 2] {
    [report.impulse, report.angular_impulse]
}

/// Positions, forces and contacts of all tools.
pub(crate) struct ToolRows {
    tools: Arc<Tools>,
}

impl ToolRows {
    /// The rows of the tools of a body; `None` if there are none.
    pub(crate) fn of(body: &SceneBody) -> Option<Self> {
        let tools = Arc::clone(body.model().tools()?);
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
            let of_bodies = ["hand_work_J", "energy_J"];
            let of_bodies = of_bodies.into_iter().filter(|_| tool.body.is_some());
            let all = single.into_iter().chain(of_bodies).chain(["residual"]);
            columns.extend(all.map(|name| format!("{}_{name}", tool.name)));
        }
        columns
    }

    /// Lines that describe the columns, and the line of their names.
    pub(crate) fn head(&self) -> String {
        let mut text = String::new();
        for Tool { name, body, .. } in self.tools.tools() {
            let _ = writeln!(
                text,
                "# {name}: force and torque about its own origin are those on the tool, means over the time since the row before; work is done on the body; \
                 the gap is that of its deepest node; passes are the pieces in which its stroke is followed; the residual is what an iteration for its contacts left, a share of the largest displacement by a contact"
            );
            if body.is_some() {
                let _ = writeln!(
                    text,
                    "# {name}: a body on a coupling; the hand's work is done on its path, and its energy is kinetic and of the coupling, in the middle of the step before, or at its end where the method's \
                     velocities hold there"
                );
            }
        }
        text.push_str(&self.columns().join(","));
        text.push('\n');
        text
    }

    /// A row of the mean forces since the row before.
    pub(crate) fn row(&self, out: &mut String, moment: &Moment<'_>, received: &mut Received) {
        out.clear();
        let Moment { state, inputs, .. } = moment;
        let t = state.t();
        tables::push(out, t);
        for (index, tool) in self.tools.tools().iter().enumerate() {
            let report = self.tools.report(state, index);
            let pose = self.tools.pose(state, inputs, index);
            let gap = self.tools.deepest(&state.u, &pose, index);
            let rotation = turns(tool).then(|| pose.rotation_vector());
            let vectors = [Some(pose.position()), rotation];
            let vectors = vectors.into_iter().flatten();
            let means = received.means(t, index, &report);
            let vectors = vectors.chain(means).flatten();
            for value in vectors.chain([report.work]) {
                out.push(',');
                tables::push(out, value);
            }
            let _ = write!(out, ",{},", report.contacts);
            tables::push(out, gap.map_or(f64::INFINITY, |depth| depth.gap));
            let _ = write!(out, ",{}", report.passes);
            let body = self.tools.body_report(state, inputs, index);
            let body = body.map(|body| [body.hand_work, body.energy]);
            for value in body.into_iter().flatten().chain([report.residual]) {
                out.push(',');
                tables::push(out, value);
            }
        }
        out.push('\n');
        let all = 0..self.tools.tools().len();
        received.note(t, all.map(|index| self.tools.report(state, index)));
    }
}

/// True if a tool may be turned at some time.
fn turns(tool: &Tool) -> bool {
    tool.body.is_some() || is_turned(&tool.motion)
}

fn is_turned(motion: &Motion) -> bool {
    match motion {
        Motion::Held(_) | Motion::Steady { .. } => false,
        Motion::Steered(..) => true,
        Motion::Table(table) => table
            .rows()
            .iter()
            .any(|row| row.rotation_vector != [0.0; 3]),
    }
}
