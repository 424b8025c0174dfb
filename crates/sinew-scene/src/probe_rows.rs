//! Rows of a table of probes: the time, then the values of each probe.

use std::fmt::Write;
use std::sync::Arc;

use sinew_core::{EvaluationError, Moment};
use sinew_fem::{FieldError, stress};

use crate::scene::Quantity;
use crate::simulation::{BodyModel, Probe, ProbeNode, SceneBody};

/// The first column's name: the time.
pub(crate) const BEGIN: &str = "t_s";

/// True if a name is that of a column of a probe.
pub(crate) fn is_column(name: &str) -> bool {
    const AXES: [&str; 6] = ["x", "y", "z", "xx", "yy", "zz"];
    let of = |letter: &str, unit: &str| {
        let Some(rest) = name.strip_suffix(unit) else {
            return false;
        };
        let Some((probe, part)) = rest.rsplit_once(letter) else {
            return false;
        };
        let part = part.trim_matches('_');
        let is_part = AXES.contains(&part) || ["", "xy", "yz", "zx", "von_mises"].contains(&part);
        !probe.is_empty() && is_part
    };
    of("_u_", "_m")
        || of("_u", "_m")
        || of("_v_", "_m_per_s")
        || of("_v", "_m_per_s")
        || of("_s_", "_Pa")
}

/// A reason for which a row cannot be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProbeRowError {
    /// A state that the system refuses.
    #[error(transparent)]
    State(#[from] EvaluationError),
    /// A field that the body does not have in this state.
    #[error(transparent)]
    Field(#[from] FieldError),
}

/// Rows of the probes of a simulation. If all of them record displacements, a row needs only the
/// degrees of freedom that are [watched](ProbeRows::watched), so that a method can take many steps in one batch.
#[derive(Debug, Clone)]
pub struct ProbeRows {
    probes: Arc<[Probe]>,
    /// The body; `None` for an oscillator.
    body: Option<Arc<BodyModel>>,
    row: String,
    /// Velocity (m/s) at the moment that is written.
    v: Vec<f64>,
}

impl ProbeRows {
    /// The rows of a body's probes.
    #[must_use]
    pub fn new(body: &SceneBody) -> Self {
        let model = body.model().body().map(Arc::clone);
        Self::of(Arc::clone(body.probes()), model)
    }

    pub(crate) fn of(probes: Arc<[Probe]>, body: Option<Arc<BodyModel>>) -> Self {
        Self {
            probes,
            body,
            row: String::new(),
            v: Vec::new(),
        }
    }

    /// Names of the columns: `t_s`, then of each probe `<probe>_u_x_m`, `<probe>_u_y_m`, `<probe>_u_z_m` (`<probe>_u_m`
    /// for an oscillator), or `<probe>_v_x_m_per_s` and so on, or `<probe>_s_xx_Pa`, yy, zz, xy, yz, zx and
    /// `<probe>_s_von_mises_Pa`.
    #[must_use]
    pub fn columns(&self) -> Vec<String> {
        let mut columns = vec![BEGIN.to_owned()];
        for probe in self.probes.iter() {
            let name = &probe.name;
            let (letter, unit) = match probe.quantity {
                Quantity::Displacement => ("u", "m"),
                Quantity::Velocity => ("v", "m_per_s"),
                Quantity::Stress => ("s", "Pa"),
            };
            match (probe.quantity, probe.axes()) {
                (Quantity::Stress, _) => {
                    let parts = ["xx", "yy", "zz", "xy", "yz", "zx", "von_mises"];
                    columns.extend(parts.map(|part| format!("{name}_{letter}_{part}_{unit}")));
                }
                (_, 1) => columns.push(format!("{name}_{letter}_{unit}")),
                _ => {
                    let axes = ["x", "y", "z"];
                    columns.extend(axes.map(|axis| format!("{name}_{letter}_{axis}_{unit}")));
                }
            }
        }
        columns
    }

    /// True if a row needs the whole state, as for velocities and stresses.
    #[must_use]
    pub fn need_moments(&self) -> bool {
        let others = |probe: &Probe| probe.quantity != Quantity::Displacement;
        self.probes.iter().any(others)
    }

    /// Degrees of freedom whose displacements a row needs, at least one; none if rows [need
    /// moments](ProbeRows::need_moments).
    #[must_use]
    pub fn watched(&self) -> Vec<u32> {
        if self.need_moments() {
            return Vec::new();
        }
        let nodes = self.probes.iter().flat_map(|probe| &probe.nodes);
        let dofs = nodes.flat_map(|node| &node.dofs);
        let dofs: Vec<u32> = dofs.flatten().map(|dof| *dof as u32).collect();
        // Steps are shown to those who watch something; where all is fixed or moved, anything will do.
        if dofs.is_empty() { vec![0] } else { dofs }
    }

    /// A row with the end of its line; `moving` has the displacements (m) of the watched degrees of freedom at time `t`
    /// (s). Numbers are written so that they are read back with the same bits.
    pub fn of_watched(&mut self, t: f64, moving: &[f64]) -> &str {
        self.begin(t);
        let mut rest = moving;
        for probe in self.probes.iter() {
            let of_node = |node: &ProbeNode| node.dofs.iter().flatten().count();
            let own: usize = probe.nodes.iter().map(of_node).sum();
            let (own, others) = rest.split_at_checked(own).unwrap_or((rest, &[]));
            rest = others;
            for axis in 0..probe.axes() {
                // Those of its nodes come one after the other, each with its moving directions.
                let mut next = 0;
                let value = probe.mean(|node| {
                    let first = next;
                    next += of_node(node);
                    match node.dofs[axis] {
                        Some(_) => {
                            let before = node.dofs[..axis].iter().flatten().count();
                            own.get(first + before).copied().unwrap_or(f64::NAN)
                        }
                        None => node.prescribed(axis, t),
                    }
                });
                push(&mut self.row, value);
            }
        }
        self.end()
    }

    /// A row of a moment, in the format of [`ProbeRows::of_watched`].
    ///
    /// # Errors
    /// [`ProbeRowError`] if the system refuses the state.
    pub fn of_moment(&mut self, moment: &Moment<'_>) -> Result<&str, ProbeRowError> {
        let (t, u) = (moment.state.t(), &moment.state.u);
        self.begin(t);
        let Self {
            probes,
            body,
            row,
            v,
        } = self;
        let needs_velocity = |probe: &Probe| probe.quantity == Quantity::Velocity;
        if probes.iter().any(needs_velocity) {
            v.resize(u.len(), 0.0);
            moment.velocity(v)?;
        }
        let model = body.as_ref().map(|body| &body.model);
        for probe in probes.iter() {
            match (probe.quantity, model) {
                (Quantity::Displacement, _) | (_, None) => {
                    probe.displacement(t, u).for_each(|value| push(row, value));
                }
                (Quantity::Velocity, Some(model)) => {
                    let velocity = model.node_velocities(t, v)?;
                    for axis in 0..3 {
                        push(row, probe.mean(|node| velocity(node.index)[axis]));
                    }
                }
                (Quantity::Stress, Some(model)) => {
                    let mut mean = match probe.is_gone {
                        true => [f64::NAN; 6],
                        false => [0.0; 6],
                    };
                    let model = model.with_memory(&moment.state.internal);
                    for (tet, share) in &probe.tets {
                        let stress = model.tet_stress(t, u, *tet as usize)?;
                        for (mean, stress) in mean.iter_mut().zip(stress) {
                            *mean += share * stress;
                        }
                    }
                    let von_mises = stress::von_mises(&mean);
                    mean.into_iter()
                        .chain([von_mises])
                        .for_each(|value| push(row, value));
                }
            }
        }
        Ok(self.end())
    }

    fn begin(&mut self, t: f64) {
        self.row.clear();
        // Writing to a string does not fail.
        let _ = write!(self.row, "{t:?}");
    }

    fn end(&mut self) -> &str {
        self.row.push('\n');
        &self.row
    }
}

fn push(row: &mut String, value: f64) {
    // Writing to a string does not fail.
    let _ = write!(row, ",{value:?}");
}
