//! The equations of a step.

use sinew_core::vectors::{add_scaled, dot, largest, weighted_dot};
use sinew_core::{
    BlockMatrix, ElasticLaw, EvaluationError, LoadTime, State, Step, StepReport, TangentKind,
    Trial, Velocities,
};

use super::by_products::Products;
use super::derivative::Derivative;
use super::equations::{Equations, Point};
use super::follow::ByShare;
use crate::implicit::factor::Combination;

/// Distance of the difference for the change of stiffness damping, as a share of the smallest cell.
const PROBE: f64 = 1e-6;

/// The acceleration x that a step seeks: `M x + m M a = c net(u* + c_u x, v* + c_v x) + c_old net(u, v)`, with the state's
/// u, v and a.
#[derive(Clone, Copy)]
pub(in crate::implicit) struct Unknown<'e> {
    /// u* (m) and v* (m/s).
    pub(in crate::implicit) predicted: [&'e [f64]; 2],
    /// d and k of the matrix `M + d D + k K`, which are `c c_v` and `c c_u`.
    pub(in crate::implicit) coefficients: [f64; 2],
    /// c.
    pub(in crate::implicit) of_forces: f64,
    /// m; if it is not 0 the state keeps an acceleration.
    pub(in crate::implicit) of_last_inertia: f64,
    /// `c_old`.
    pub(in crate::implicit) of_old_forces: f64,
    /// Times of the loads at both ends of the step.
    pub(in crate::implicit) loads: [LoadTime<'e>; 2],
    /// Displacement at which stiffness damping acts.
    pub(in crate::implicit) viscosity: ViscousPlace<'e>,
}

/// The displacement at which stiffness damping acts on the velocity at a step's end.
#[derive(Clone, Copy)]
pub(in crate::implicit) struct ViscousPlace<'e> {
    /// Position and velocity of supports.
    pub(in crate::implicit) load: LoadTime<'e>,
    /// The time (s) by which the displacement is before the end, at that velocity. A velocity that is a step's
    /// displacement over its length belongs to the middle of the step: there `sym(F'dF)` is the change of Green's
    /// strain, for any rotation in a step.
    pub(in crate::implicit) before: f64,
}

impl<'e> ViscousPlace<'e> {
    /// The end of a step with these times of loads.
    pub(in crate::implicit) fn at_end([_, load]: [LoadTime<'e>; 2]) -> Self {
        Self { load, before: 0.0 }
    }
}

impl Unknown<'_> {
    /// `c_u`.
    pub(super) fn reach(&self) -> f64 {
        self.coefficients[1] / self.of_forces
    }
}

pub(super) struct StepEquations<'s> {
    pub(super) step: &'s Step<'s>,
    pub(super) law: &'s dyn ElasticLaw,
    pub(super) state: &'s State,
    pub(super) unknown: Unknown<'s>,
    /// Times of the loads, and of the supports for stiffness damping, at the step's end.
    pub(super) end: [LoadTime<'s>; 2],
    /// `c_old net(u, v)` (N), if `c_old` is not 0.
    pub(super) old_forces: &'s [f64],
    /// Displacement and velocity of the point evaluated.
    pub(super) u: &'s mut [f64],
    pub(super) v: &'s mut [f64],
    /// Change of positions (m) that is lost in rounding.
    pub(super) rounding: f64,
    pub(super) viscous: &'s mut Viscous,
}

/// Scratch space for stiffness damping.
#[derive(Default)]
pub(super) struct Viscous {
    /// Its force (N) at the last tangent's point, and at a point next to it.
    pub(super) force: Vec<f64>,
    pub(super) beside: Vec<f64>,
    /// Displacement (m) at which it acts, and one next to it.
    pub(super) at: Vec<f64>,
    pub(super) u: Vec<f64>,
    /// Size of the smallest cell (m), or a substitute.
    pub(super) cell: f64,
}

impl StepEquations<'_> {
    pub(super) fn place(&mut self, x: &[f64]) {
        let [of_v, of_u] = self
            .unknown
            .coefficients
            .map(|c| c / self.unknown.of_forces);
        let [u, v] = self.unknown.predicted;
        for (i, x) in x.iter().enumerate() {
            self.u[i] = u[i] + of_u * x;
            self.v[i] = v[i] + of_v * x;
        }
        if self.is_viscous() {
            let before = self.unknown.viscosity.before;
            let ends = self.u.iter().zip(&*self.v);
            for (at, (u, v)) in self.viscous.at.iter_mut().zip(ends) {
                *at = u - before * v;
            }
        }
    }

    fn trial(&self) -> Trial<'_> {
        Trial {
            load: self.unknown.loads[1],
            dt: self.step.dt,
            u: self.u,
            v: self.v,
            internal: &self.state.internal,
        }
    }

    /// The point at which stiffness damping acts.
    fn viscous_trial(&self) -> Trial<'_> {
        Trial {
            load: self.unknown.viscosity.load,
            u: &self.viscous.at,
            ..self.trial()
        }
    }

    /// The derivative at the point that was set last, by its products.
    fn derivative_there(&self) -> Derivative<'_> {
        Derivative {
            law: self.law,
            mass: self.step.system.mass(),
            coefficients: self.unknown.coefficients,
            at: self.trial(),
            viscous_at: self.viscous_trial(),
        }
    }

    fn is_viscous(&self) -> bool {
        self.law.damping().stiffness != 0.0
    }

    /// Completes the point that was set last, from its elastic energy (J) and forces (N).
    pub(super) fn complete(
        &mut self,
        energy: f64,
        point: &mut Point,
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        self.net_force(point, work)?;
        let Unknown {
            of_forces: c,
            of_last_inertia: m,
            of_old_forces,
            ..
        } = self.unknown;
        let mass = self.step.system.mass();
        for (i, residual) in point.residual.iter_mut().enumerate() {
            let before = if m == 0.0 { 0.0 } else { m * self.state.a[i] };
            *residual = mass[i] * (point.x[i] + before) - c * *residual;
            point.elastic[i] *= c;
        }
        if of_old_forces != 0.0 {
            add_scaled(-1.0, self.old_forces, &mut point.residual);
        }
        point.energy = match self.unknown.reach() {
            0.0 => dot(&point.elastic, &point.x),
            reach => c * energy / reach,
        };
        Ok(())
    }

    /// Writes the net force (N) into the residual, from the known elastic force; only stiffness damping takes another
    /// sweep.
    fn net_force(
        &mut self,
        point: &mut Point,
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        let mut viscous = std::mem::take(&mut self.viscous.beside);
        let (trial, system, damping) = (self.trial(), self.step.system, self.law.damping());
        let net = &mut point.residual;
        system.external_force(trial.load, trial.u, net);
        let mut found = Ok(());
        if damping.stiffness != 0.0 {
            work.sweeps += 1;
            viscous.resize(net.len(), 0.0);
            let all = Velocities::All(trial.v);
            found = self
                .law
                .viscous_force(&self.viscous_trial(), all, &mut viscous);
            add_scaled(-1.0, &viscous, net);
        }
        let forces = net.iter_mut().zip(&point.elastic);
        for (((net, elastic), mass), v) in forces.zip(system.mass()).zip(trial.v) {
            *net -= elastic + damping.mass * mass * v;
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_product(trial.v, net);
        }
        self.viscous.beside = viscous;
        found
    }

    /// `out += dV/du(change) v` (N), c and k included: the part of the derivative of stiffness damping that is not in
    /// its matrix, by a difference.
    fn add_change_of_viscosity(&mut self, change: &[f64], out: &mut [f64]) {
        let size = largest(change);
        if !(size > 0.0 && size.is_finite()) {
            return;
        }
        let Viscous {
            force,
            beside,
            at,
            u,
            cell,
        } = &mut *self.viscous;
        let length = PROBE * if *cell > 0.0 { *cell } else { size } / size;
        u.copy_from_slice(at);
        add_scaled(length, change, u);
        let trial = Trial {
            load: self.unknown.viscosity.load,
            dt: self.step.dt,
            u,
            v: self.v,
            internal: &self.state.internal,
        };
        let all = Velocities::All(self.v);
        // Where the law has no meaning beside the point, iterations continue without.
        if self.law.viscous_force(&trial, all, beside).is_ok() {
            let [d, k] = self.unknown.coefficients;
            let k = k - self.unknown.viscosity.before * d;
            for (out, (beside, force)) in out.iter_mut().zip(beside.iter().zip(&*force)) {
                *out += k / length * (beside - force);
            }
        }
    }

    /// Sets x so that the displacement is the state's plus its velocity times `after` (s), in the components that x
    /// changes.
    pub(super) fn begin_at(&self, after: f64, x: &mut [f64]) {
        let reach = self.unknown.reach();
        let [predicted, _] = self.unknown.predicted;
        for (i, x) in x.iter_mut().enumerate() {
            let wanted = self.state.u[i] + after * self.state.v[i];
            *x = match reach {
                0.0 => 0.0,
                _ => (wanted - predicted[i]) / reach,
            };
        }
    }
}

impl Equations for StepEquations<'_> {
    fn evaluate(
        &mut self,
        point: &mut Point,
        work: &mut StepReport,
    ) -> Result<(), EvaluationError> {
        self.place(&point.x);
        *work += StepReport::ONE_FORCE;
        let deformed = self.law.elastic_force(&self.trial(), &mut point.elastic)?;
        self.complete(deformed.energy, point, work)
    }

    fn tangent(
        &mut self,
        x: &[f64],
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        self.place(x);
        self.law.tangent(&self.trial(), kind, out)?;
        if kind == TangentKind::Exact {
            self.law.add_load_stiffness(&self.trial(), 1.0, out)?;
        }
        let [d, k] = self.unknown.coefficients;
        out.scale(k);
        if !self.is_viscous() {
            return Ok(());
        }
        self.law.add_viscosity(&self.viscous_trial(), d, out)?;
        let mut viscous = std::mem::take(&mut self.viscous.force);
        let all = Velocities::All(self.v);
        let found = self
            .law
            .viscous_force(&self.viscous_trial(), all, &mut viscous);
        self.viscous.force = viscous;
        found
    }

    fn skew_product(&mut self, x: &[f64], change: &[f64], out: &mut [f64]) -> bool {
        if !self.law.loads_follow() && !self.is_viscous() {
            return false;
        }
        self.place(x);
        let [_, k] = self.unknown.coefficients;
        // Zeros where loads do not follow.
        self.law.load_skew_product(&self.trial(), k, change, out);
        if self.is_viscous() {
            self.add_change_of_viscosity(change, out);
        }
        true
    }

    fn viscous_sweeps(&self) -> u64 {
        u64::from(self.is_viscous())
    }

    fn derivative(&self) -> (&[f64], Combination) {
        let [d, k] = self.unknown.coefficients;
        // The tangent has k and stiffness damping.
        let combination = Combination {
            stiffness: 1.0,
            ..Combination::of_step(self.law.damping(), d, k)
        };
        (self.step.system.mass(), combination)
    }

    fn products_at(&mut self, x: &[f64]) -> Option<&mut dyn Products> {
        self.place(x);
        Some(self)
    }

    fn forces(&self, point: &Point, weights: &[f64]) -> f64 {
        let inertia = weighted_dot(self.step.system.mass(), &point.x, &point.x);
        let elastic = weighted_dot(weights, &point.elastic, &point.elastic);
        inertia.max(elastic).sqrt()
    }

    fn is_rounding(&self, _point: &Point, change: &[f64]) -> bool {
        let reach = self.unknown.reach();
        reach > 0.0 && reach * largest(change) <= self.rounding
    }
}

/// Products at the point that was set last.
impl Products for StepEquations<'_> {
    fn product(
        &mut self,
        kind: TangentKind,
        change: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let mut beside = std::mem::take(&mut self.viscous.beside);
        let found = self
            .derivative_there()
            .product(kind, change, &mut beside, out);
        self.viscous.beside = beside;
        found
    }

    fn sweeps(&self) -> u64 {
        Derivative::sweeps(self.law)
    }

    fn blocks(&mut self, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.derivative_there().blocks(out)
    }

    fn inertia(&self, dof: usize) -> f64 {
        self.derivative_there().inertia(dof)
    }
}

/// The path of the supports, and the loads with it, to their end.
impl ByShare for StepEquations<'_> {
    fn take_share(&mut self, share: f64) {
        let start = self.state.t();
        let [load, viscous] = self.end.map(|end| match share {
            1.0 => end,
            _ => LoadTime::at(start + share * (end.t() - start)).under(end.inputs()),
        });
        self.unknown.loads[1] = load;
        self.unknown.viscosity.load = viscous;
    }
}
