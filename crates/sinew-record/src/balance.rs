//! The balance of energy of a run.

use serde::{Deserialize, Serialize};
use sinew_core::vectors::dot;
use sinew_core::{Acceleration, LinearOperators, Moment};
use sinew_fem::Model;
use sinew_integrators::{NumericalDissipation, StepEnd, Stepper};
use sinew_scene::{SceneModel, Simulation};

use crate::error::RecordRunError;
use crate::schedule::Schedule;

/// Energies (J) of a run at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Energies {
    pub(crate) t: f64,
    pub(crate) kinetic: f64,
    pub(crate) elastic: f64,
    /// Work of loads and gravity since the beginning.
    pub(crate) loads: f64,
    /// Work of supports in motion since the beginning.
    pub(crate) supports: f64,
    /// Energy that damping took since the beginning.
    pub(crate) damped: f64,
    /// Energy that the method took since the beginning, where its closed form is known.
    pub(crate) method: Option<f64>,
    /// What the energy gained beyond all that: what the method, where that is not known, and the distance of the rows bring
    /// in or take away.
    pub(crate) remainder: f64,
}

/// Sums of a balance, all that a checkpoint keeps of it beside the last motion.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sums {
    first: f64,
    loads: f64,
    supports: f64,
    damped: f64,
    method: f64,
}

/// Motion at the last row: time (s), displacement (m) and velocity (m/s) of the degrees of freedom, and the acceleration
/// (m/s^2) where what the method takes is known.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct LastRow {
    pub(crate) t: f64,
    pub(crate) u: Vec<f64>,
    pub(crate) v: Vec<f64>,
    pub(crate) a: Vec<f64>,
}

/// Sums up, from row to row, what loads, moved supports and damping do.
///
/// Between two rows forces are taken as the mean of both ends and velocities as `du/dt`, so that for the mean
/// acceleration method (Newmark with gamma 1/2 and beta 1/4), with a row for every step and loads that do not jump, nothing
/// remains but rounding. Jumps and kinks of loads and of prescribed motions between two rows remain in part.
pub(crate) struct Balance<'a> {
    simulation: &'a Simulation,
    pub(crate) sums: Sums,
    pub(crate) last: Option<LastRow>,
    /// Forces and displacements at the last row.
    acting: Option<Acting>,
    /// What the method takes, where that is known.
    form: Option<NumericalDissipation>,
}

/// Forces (N) and displacements (m) that do work.
struct Acting {
    /// Of degrees of freedom, or of all nodes where some are moved.
    loads: Vec<f64>,
    u: Vec<f64>,
    /// Of moved nodes; empty where there are none.
    supports: Vec<f64>,
}

impl<'a> Balance<'a> {
    /// Begins with rows at these steps of the method.
    pub(crate) fn new(simulation: &'a Simulation, method: &dyn Stepper, rows: Schedule) -> Self {
        let mut balance = Self {
            simulation,
            sums: Sums::default(),
            last: None,
            acting: None,
            form: None,
        };
        // The form is that of one step of free degrees of freedom.
        if rows.is_every_step() && balance.moved_body().is_none() && balance.operators().is_some() {
            balance.form = method.numerical_dissipation();
        }
        balance
    }

    /// Whether it is known what the method takes.
    pub(crate) fn knows_method(&self) -> bool {
        self.form.is_some()
    }

    /// Goes on after a row that was written by an earlier run.
    pub(crate) fn resumed(mut self, sums: Sums, last: LastRow) -> Result<Self, RecordRunError> {
        self.sums = sums;
        self.acting = Some(self.acting(&last)?);
        self.last = Some(last);
        Ok(self)
    }

    fn operators(&self) -> Option<&'a LinearOperators> {
        Some(self.simulation.system().as_linear()?.operators())
    }

    /// The body, where parts of it are moved.
    fn moved_body(&self) -> Option<&'a Model> {
        let body = self.simulation.model().body()?;
        (!body.problem.moves.is_empty()).then_some(&body.model)
    }

    /// The next row, with the velocity `v` (m/s) at its time.
    pub(crate) fn row(
        &mut self,
        moment: &Moment<'_>,
        v: &[f64],
    ) -> Result<Energies, RecordRunError> {
        let here = LastRow {
            t: moment.state.t(),
            u: moment.state.u.clone(),
            v: v.to_vec(),
            a: self.acceleration(moment, v)?,
        };
        let acting = self.acting(&here)?;
        let (kinetic, elastic) = self.stored(&here, &acting)?;
        match (&self.acting, &self.last) {
            (Some(before), Some(last)) => {
                let work = |before: &[f64], after: &[f64], u_before: &[f64]| -> f64 {
                    let forces = before.iter().zip(after);
                    let moved = acting.u.iter().zip(u_before);
                    let terms = forces.zip(moved);
                    terms
                        .map(|((before, after), (u, u_before))| {
                            0.5 * (before + after) * (u - u_before)
                        })
                        .sum()
                };
                self.sums.loads += work(&before.loads, &acting.loads, &before.u);
                self.sums.supports += work(&before.supports, &acting.supports, &before.u);
                self.sums.damped += self.damped(last, &here, &before.u, &acting.u)?;
                self.sums.method += self.taken_by_method([(last, before), (&here, &acting)]);
            }
            _ => self.sums.first = kinetic + elastic,
        }
        self.acting = Some(acting);
        let t = here.t;
        self.last = Some(here);
        let Sums {
            first,
            loads,
            supports,
            damped,
            method,
        } = self.sums;
        Ok(Energies {
            t,
            kinetic,
            elastic,
            loads,
            supports,
            damped,
            method: self.form.map(|_| method),
            remainder: kinetic + elastic - first - loads - supports + damped + method,
        })
    }

    /// The acceleration that the method keeps, where it matters; before the first step the consistent one.
    fn acceleration(&self, moment: &Moment<'_>, v: &[f64]) -> Result<Vec<f64>, RecordRunError> {
        if self.form.is_none() {
            return Ok(Vec::new());
        }
        if moment.state.acceleration == Acceleration::Same {
            return Ok(moment.state.a.clone());
        }
        let mut a = vec![0.0; v.len()];
        moment.acceleration(v, &mut a)?;
        Ok(a)
    }

    /// The energy (J) that the method takes in a step between two rows, 0 where that is not known.
    fn taken_by_method(&self, [before, after]: [(&LastRow, &Acting); 2]) -> f64 {
        let (Some(form), Some(operators)) = (self.form, self.operators()) else {
            return 0.0;
        };
        let dt = after.0.t - before.0.t;
        let ends = [before, after].map(|(row, acting)| StepEnd {
            u: &row.u,
            v: &row.v,
            a: &row.a,
            load: &acting.loads,
        });
        form.taken(operators, dt, ends)
    }

    fn acting(&self, row: &LastRow) -> Result<Acting, RecordRunError> {
        let Some(model) = self.moved_body() else {
            let mut loads = vec![0.0; row.u.len()];
            self.simulation
                .system()
                .external_force(row.t.into(), &mut loads);
            return Ok(Acting {
                loads,
                u: row.u.clone(),
                supports: Vec::new(),
            });
        };
        let nodes = model.mesh().points.len();
        let mut u = vec![[0.0; 3]; nodes];
        let (mut loads, mut supports) = (u.clone(), u.clone());
        model.displacements_at(row.t, &row.u, &mut u)?;
        model.load_forces(row.t, &mut loads)?;
        model.reactions(row.t, &row.u, &row.v, &mut supports)?;
        Ok(Acting {
            loads: loads.into_flattened(),
            u: u.into_flattened(),
            supports: supports.into_flattened(),
        })
    }

    /// Kinetic and elastic energy.
    fn stored(&self, row: &LastRow, acting: &Acting) -> Result<(f64, f64), RecordRunError> {
        let Some(model) = self.moved_body() else {
            let energy = match self.simulation.model() {
                SceneModel::Body(_) => self.simulation.system().energy(&row.u, &row.v),
                SceneModel::Oscillator(_) => self
                    .operators()
                    .map(|operators| operators.energy(&row.u, &row.v)),
            };
            return Ok(energy.map_or((f64::NAN, f64::NAN), |energy| {
                (energy.kinetic, energy.elastic)
            }));
        };
        let mut v = vec![[0.0; 3]; model.mesh().points.len()];
        model.velocities_at(row.t, &row.v, &mut v)?;
        let moving = v.iter().zip(model.node_masses());
        let kinetic = moving.map(|(v, mass)| 0.5 * mass * v.iter().map(|v| v * v).sum::<f64>());
        let elastic = model.elastic_energy(acting.u.as_chunks::<3>().0)?;
        Ok((kinetic.sum(), elastic))
    }

    /// Energy (J) that damping takes between two rows: `w' D w dt` with `w = du/dt`.
    fn damped(
        &self,
        last: &LastRow,
        here: &LastRow,
        u_before: &[f64],
        u_after: &[f64],
    ) -> Result<f64, RecordRunError> {
        let span = here.t - last.t;
        let Some(operators) = self.operators() else {
            return Ok(0.0);
        };
        let damping = operators.damping();
        if span <= 0.0
            || (damping.mass == 0.0 && damping.stiffness == 0.0 && damping.extra.is_none())
        {
            return Ok(0.0);
        }
        let mean = |after: &[f64], before: &[f64]| -> Vec<f64> {
            let ends = after.iter().zip(before);
            ends.map(|(after, before)| (after - before) / span)
                .collect()
        };
        let own = mean(&here.u, &last.u);
        let power = |product: &dyn Fn(&mut [f64])| -> f64 {
            let mut force = vec![0.0; own.len()];
            product(&mut force);
            -dot(&force, &own)
        };
        let Some(model) = self.moved_body() else {
            return Ok(span * power(&|out| operators.subtract_damping(&own, out)));
        };
        let w = mean(u_after, u_before);
        let w = w.as_chunks::<3>().0;
        // With f for free components and p for held ones, and D being symmetric, w' D w is
        // w_f' D_ff w_f + 2 w_p' (D w)_p - w_p' D_pp w_p.
        let mut held = w.to_vec();
        for (node, own) in (0..).zip(&mut held) {
            for (axis, own) in own.iter_mut().enumerate() {
                if moves_by_itself(model, node, axis) {
                    *own = 0.0;
                }
            }
        }
        let still = vec![[0.0; 3]; w.len()];
        let rows = |v: &[[f64; 3]]| -> Result<Vec<[f64; 3]>, RecordRunError> {
            let mut out = vec![[0.0; 3]; w.len()];
            model.moving_reactions(here.t, [&still, v, &still], &mut out)?;
            Ok(out)
        };
        // Without motion they are the loads alone.
        let (all, own_rows, loads) = (rows(w)?, rows(&held)?, rows(&still)?);
        let mut at_held = 0.0;
        for (((w, all), own), load) in held.iter().zip(&all).zip(&own_rows).zip(&loads) {
            for axis in 0..3 {
                at_held += w[axis] * (2.0 * all[axis] - own[axis] - load[axis]);
            }
        }
        let free = power(&|out| operators.subtract_damping(&own, out));
        Ok(span * (free + at_held))
    }
}

/// Whether a component of a node is a degree of freedom.
fn moves_by_itself(model: &Model, node: u32, axis: usize) -> bool {
    let dof = |cell: u32| 3 * cell as usize + axis;
    model
        .cell_of_node(node)
        .is_some_and(|cell| !model.pinned()[dof(cell)])
}
