//! The equations of a step, and the acceleration that solves them.

use sinew_core::vectors::{add_scaled, dot, largest, scale, weighted_dot};
use sinew_core::{
    BlockMatrix, ElasticLaw, EvaluationError, Fact, LoadTime, Needs, SetupError, State, Step,
    StepError, StepReport, System, TangentKind, Trial, Velocities,
};

use super::energy_watch::EnergyWatch;
use super::newton_error::NewtonError;
use super::settings::NewtonSettings;
use super::solver::{Equations, Newton, Point};
use crate::implicit::factor::{Combination, Factor};

/// Distance over which the change of stiffness damping is measured, as a share of the smallest cell.
const PROBE: f64 = 1e-6;

/// Share of the size of body and motion by which rounding moves positions.
const ROUNDING: f64 = 1e-14;

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
    /// m; where it is not 0 the state keeps an acceleration.
    pub(in crate::implicit) of_last_inertia: f64,
    /// `c_old`.
    pub(in crate::implicit) of_old_forces: f64,
    /// Times of the loads at both ends of the step.
    pub(in crate::implicit) loads: [LoadTime<'e>; 2],
    /// Displacement at which stiffness damping acts.
    pub(in crate::implicit) viscosity: ViscousPlace<'e>,
}

/// The displacement at which stiffness damping acts on the velocity of a step's end.
#[derive(Clone, Copy)]
pub(in crate::implicit) struct ViscousPlace<'e> {
    /// Position and velocity of supports.
    pub(in crate::implicit) load: LoadTime<'e>,
    /// The time (s) by which the displacement lies before the end, at that velocity. A velocity that is the way of a step over its time belongs to the middle:
    /// there `sym(F'dF)` is the change of Green's strain, whatever the body turns in a step.
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
    fn reach(&self) -> f64 {
        self.coefficients[1] / self.of_forces
    }
}

struct StepEquations<'s> {
    step: &'s Step<'s>,
    law: &'s dyn ElasticLaw,
    state: &'s State,
    unknown: Unknown<'s>,
    /// `c_old net(u, v)` (N), where `c_old` is not 0.
    old_forces: &'s [f64],
    /// Displacement and velocity of the point evaluated.
    u: &'s mut [f64],
    v: &'s mut [f64],
    /// Change of positions (m) that is lost in rounding.
    rounding: f64,
    viscous: &'s mut Viscous,
}

/// Scratch space for stiffness damping.
#[derive(Default)]
struct Viscous {
    /// Its force (N) where the last tangent was made, and beside it.
    force: Vec<f64>,
    beside: Vec<f64>,
    /// Displacement (m) at which it acts, and beside that.
    at: Vec<f64>,
    u: Vec<f64>,
    /// Size of the smallest cell (m), or what there is in its place.
    cell: f64,
}

impl StepEquations<'_> {
    fn place(&mut self, x: &[f64]) {
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

    fn is_viscous(&self) -> bool {
        self.law.damping().stiffness != 0.0
    }

    /// Writes the net force (N) into the residual, from the elastic one, which is known; only stiffness damping takes another sweep.
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

    /// `out += dV/du(change) v` (N), c and k included: the part of the derivative of stiffness damping that its matrix lacks, by a difference.
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

    /// Sets x so that the displacement is the state's moved on by its velocity for a time (s), as far as x moves it.
    fn begin_at(&self, after: f64, x: &mut [f64]) {
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
            reach => c * deformed.energy / reach,
        };
        Ok(())
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

/// Newton's method in steps, with all its memory.
pub(in crate::implicit) struct NewtonSteps {
    integrator: &'static str,
    newton: Newton,
    u: Vec<f64>,
    v: Vec<f64>,
    old_forces: Vec<f64>,
    viscous: Viscous,
    /// Size of the body (m), 0 where it has none.
    extent: f64,
    watch: EnergyWatch,
    steps: u64,
    work: StepReport,
    most: u64,
}

impl NewtonSteps {
    /// Analyses the pattern of a system's elastic law, or takes that of a factor that fits.
    pub(in crate::implicit) fn set_up(
        integrator: &'static str,
        system: &dyn System,
        settings: NewtonSettings,
        known: Option<Factor>,
    ) -> Result<Self, SetupError> {
        let law = system
            .as_elastic()
            .ok_or_else(|| Needs::Tangents.lacking(integrator))?;
        let per_mass = system.mass().iter().map(|mass| mass.recip()).collect();
        let newton = Newton::set_up(law, system.layers(), per_mass, settings, known)
            .map_err(|error| error.at_set_up(integrator))?;
        let zeros = || vec![0.0; system.dofs()];
        let smallest = |sizes: &[f64]| sizes.iter().copied().fold(f64::INFINITY, f64::min);
        let cell = system.scales().map(|scales| smallest(scales.cell_size));
        let mut viscous = Viscous {
            cell: cell.filter(|cell| cell.is_finite()).unwrap_or(0.0),
            ..Viscous::default()
        };
        if law.damping().stiffness != 0.0 {
            (viscous.force, viscous.beside) = (zeros(), zeros());
            (viscous.at, viscous.u) = (zeros(), zeros());
        }
        Ok(Self {
            integrator,
            newton,
            viscous,
            u: zeros(),
            v: zeros(),
            old_forces: zeros(),
            extent: system.extent().unwrap_or(0.0),
            watch: EnergyWatch::new(integrator, system.dofs()),
            steps: 0,
            work: StepReport::default(),
            most: 0,
        })
    }

    pub(in crate::implicit) fn into_factor(self) -> Factor {
        self.newton.into_factor()
    }

    /// Solves the equations of a step for the acceleration.
    pub(in crate::implicit) fn solve(
        &mut self,
        step: &Step<'_>,
        state: &State,
        unknown: Unknown<'_>,
        acceleration: &mut [f64],
    ) -> Result<StepReport, StepError> {
        let law = step
            .system
            .as_elastic()
            .ok_or_else(|| Needs::Tangents.lacking(self.integrator))?;
        let mut work = StepReport::default();
        let Newton { point, trial, .. } = &mut self.newton;
        self.watch
            .look(step, state, law, &mut trial.elastic, &mut work);
        let size = self.extent.max(largest(&state.u));
        if unknown.of_old_forces != 0.0 {
            let point = [&state.u[..], &state.v, &state.internal];
            step.net_force(unknown.loads[0], 0.0, point, &mut self.old_forces)?;
            work += StepReport::ONE_FORCE;
            scale(&mut self.old_forces, unknown.of_old_forces);
        }
        let mut equations = StepEquations {
            step,
            law,
            state,
            unknown: Unknown {
                loads: unknown.loads.map(|load| load.under(step.inputs)),
                viscosity: ViscousPlace {
                    load: unknown.viscosity.load.under(step.inputs),
                    ..unknown.viscosity
                },
                ..unknown
            },
            old_forces: &self.old_forces,
            u: &mut self.u,
            v: &mut self.v,
            rounding: ROUNDING * size,
            viscous: &mut self.viscous,
        };
        equations.begin_at(0.0, &mut point.x);
        equations.begin_at(step.dt, &mut trial.x);
        let stayed = equations.evaluate(point, &mut work);
        let moved = equations.evaluate(trial, &mut work);
        let refused = |source| StepError::Refused {
            t: unknown.loads[1].t(),
            source,
        };
        match (stayed, moved) {
            (Ok(()), moved) => {
                if unknown.reach() > 0.0 {
                    let energy = point.energy * unknown.reach() / unknown.of_forces;
                    self.watch.supports(energy);
                }
                if moved.is_ok() {
                    self.newton.take_lower();
                }
            }
            (Err(_), Ok(())) => self.newton.take_trial(),
            (Err(refusal), Err(_)) => return Err(refused(refusal)),
        }
        let before = work.newton_iterations;
        let solved = self.newton.solve(&mut equations, &mut work);
        solved.map_err(|failure| match failure {
            NewtonError::Refused(refusal) => refused(refusal),
            NewtonError::Unbalanced {
                iterations,
                residual,
                reason,
            } => self.not_converged(state, iterations, residual, reason),
            NewtonError::Singular(_) => self.not_converged(
                state,
                work.newton_iterations - before,
                f64::INFINITY,
                "not even the projected tangent is positive definite".to_owned(),
            ),
        })?;
        acceleration.copy_from_slice(&self.newton.point.x);
        self.steps += 1;
        self.work += work;
        self.most = self.most.max(work.newton_iterations);
        Ok(work)
    }

    fn not_converged(
        &self,
        state: &State,
        iterations: u64,
        residual: f64,
        reason: String,
    ) -> StepError {
        StepError::NotConverged {
            integrator: self.integrator,
            t: state.t(),
            iterations,
            residual,
            reason,
        }
    }

    /// Iterations of a step, in the mean.
    fn mean(&self) -> f64 {
        self.work.newton_iterations as f64 / self.steps as f64
    }

    /// Iterations a step, once a step was taken.
    pub(in crate::implicit) fn facts(&self) -> Vec<Fact> {
        if self.steps == 0 {
            return Vec::new();
        }
        vec![
            Fact {
                name: "newton_iterations_a_step",
                value: self.mean(),
            },
            Fact {
                name: "most_newton_iterations",
                value: self.most as f64,
            },
        ]
    }

    /// Iterations a step, and growth of the energy.
    pub(in crate::implicit) fn remarks(&self) -> Vec<String> {
        if self.steps == 0 {
            return Vec::new();
        }
        let projected = match self.work.projected_solves {
            0 => String::new(),
            solves => format!("; {solves} solutions with a projected tangent"),
        };
        let iterations = format!(
            "Newton's method took {:.2} iterations a step, {} at most{projected}",
            self.mean(),
            self.most
        );
        std::iter::once(iterations)
            .chain(self.watch.remark())
            .collect()
    }
}
