//! Newton's method in steps.

use sinew_core::vectors::{largest, scale};
use sinew_core::{Fact, Needs, SetupError, State, Step, StepError, StepReport, System};

use super::by_products::Products;
use super::derivative::AtRest;
use super::energy_watch::EnergyWatch;
use super::equations::Equations;
use super::follow::follow;
use super::newton_error::NewtonError;
use super::settings::NewtonSettings;
use super::solver::Newton;
use super::step_equations::{StepEquations, Unknown, Viscous, ViscousPlace};
use crate::implicit::factor::Factor;
use crate::stiffening::stiffened_element;

/// Share of the size of body and motion by which rounding moves positions.
const ROUNDING: f64 = 1e-14;

/// Newton's method in steps, with all its memory.
pub(in crate::implicit) struct NewtonSteps {
    integrator: &'static str,
    newton: Newton,
    u: Vec<f64>,
    v: Vec<f64>,
    old_forces: Vec<f64>,
    viscous: Viscous,
    /// Size of the body (m), 0 if it has none.
    extent: f64,
    watch: EnergyWatch,
    steps: u64,
    work: StepReport,
    most: u64,
}

impl NewtonSteps {
    /// Sets up for a system's elastic law in steps of `dt` (s) with these d and k; the analysis of a suitable factor is
    /// reused. Also returns the work of this.
    pub(in crate::implicit) fn set_up(
        integrator: &'static str,
        system: &dyn System,
        (dt, coefficients): (f64, [f64; 2]),
        settings: NewtonSettings,
        known: Option<Factor>,
    ) -> Result<(Self, StepReport), SetupError> {
        let law = system
            .as_elastic()
            .ok_or_else(|| Needs::Tangents.lacking(integrator))?;
        let per_mass = system.mass().iter().map(|mass| mass.recip()).collect();
        let mut at_rest = AtRest::new(system, law, dt, coefficients);
        let (of, at_rest) = (
            (law, system.layers()),
            Some(&mut at_rest as &mut dyn Products),
        );
        let mut work = StepReport::default();
        let newton = Newton::set_up(of, per_mass, settings, known, at_rest, &mut work)
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
        let steps = Self {
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
        };
        Ok((steps, work))
    }

    pub(in crate::implicit) fn into_factor(self) -> Option<Factor> {
        self.newton.linear.into_factor()
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
        let elastic = &mut point.elastic;
        let energy = self.watch.look(step, state, law, elastic, &mut work);
        let size = self.extent.max(largest(&state.u));
        if unknown.of_old_forces != 0.0 {
            let point = [&state.u[..], &state.v, &state.internal];
            step.net_force(unknown.loads[0], 0.0, point, &mut self.old_forces)?;
            work += StepReport::ONE_FORCE;
            scale(&mut self.old_forces, unknown.of_old_forces);
        }
        let loads = unknown.loads.map(|load| load.under(step.inputs));
        let viscous = unknown.viscosity.load.under(step.inputs);
        let mut equations = StepEquations {
            step,
            law,
            state,
            unknown: Unknown {
                loads,
                viscosity: ViscousPlace {
                    load: viscous,
                    ..unknown.viscosity
                },
                ..unknown
            },
            end: [loads[1], viscous],
            old_forces: &self.old_forces,
            u: &mut self.u,
            v: &mut self.v,
            rounding: ROUNDING * size,
            viscous: &mut self.viscous,
        };
        equations.begin_at(0.0, &mut point.x);
        equations.begin_at(step.dt, &mut trial.x);
        let stayed = match energy {
            // Where supports rest, that is the state itself.
            Some(energy) if unknown.reach() > 0.0 && !law.supports_move() => {
                equations.place(&point.x);
                equations.complete(energy, point, &mut work)
            }
            _ => equations.evaluate(point, &mut work),
        };
        let moved = equations.evaluate(trial, &mut work);
        let refused = |source| StepError::Refused {
            t: unknown.loads[1].t(),
            source,
        };
        if stayed.is_ok() && unknown.reach() > 0.0 {
            let energy = point.energy * unknown.reach() / unknown.of_forces;
            self.watch.supports(energy);
        }
        let before = work.newton_iterations;
        let begun = self.newton.take_better(stayed, &moved);
        let mut solved = begun
            .map_err(NewtonError::Refused)
            .and_then(|()| self.newton.solve(&mut equations, &mut work));
        let is_open = matches!(
            solved,
            Err(NewtonError::Unbalanced { .. } | NewtonError::Singular(_))
        );
        if is_open && self.newton.linear.insist_on_factor() {
            let Newton { point, trial, .. } = &mut self.newton;
            equations.begin_at(0.0, &mut point.x);
            equations.begin_at(step.dt, &mut trial.x);
            let stayed = equations.evaluate(point, &mut work);
            let moved = equations.evaluate(trial, &mut work);
            self.newton.take_better(stayed, &moved).map_err(refused)?;
            solved = self.newton.solve(&mut equations, &mut work);
        }
        if solved.is_err() && unknown.reach() > 0.0 && law.supports_move() {
            equations.begin_at(0.0, &mut self.newton.point.x);
            self.watch.restart();
            match (follow(&mut self.newton, &mut equations, &mut work), &solved) {
                (Ok(()), _) => solved = Ok(()),
                (Err(_), Err(NewtonError::Refused(_))) => {}
                (Err(unreached), _) => solved = Err(unreached.error),
            }
        }
        solved.map_err(|failure| match failure {
            NewtonError::Refused(refusal) => refused(refusal),
            NewtonError::Unbalanced {
                iterations,
                residual,
                reason,
            } => self.not_converged((step, state), iterations, residual, reason),
            NewtonError::Singular(_) => self.not_converged(
                (step, state),
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
        (step, state): (&Step<'_>, &State),
        iterations: u64,
        residual: f64,
        mut reason: String,
    ) -> StepError {
        if let Some(element) = stiffened_element(step.system, step.inputs, state) {
            reason.push_str(&format!("; before the step {element}"));
        }
        StepError::NotConverged {
            integrator: self.integrator,
            t: state.t(),
            iterations,
            residual,
            reason,
        }
    }

    /// Mean number of iterations of a step.
    fn mean(&self) -> f64 {
        self.work.newton_iterations as f64 / self.steps as f64
    }

    /// Iterations per step, once a step was taken.
    pub(in crate::implicit) fn facts(&self) -> Vec<Fact> {
        if self.steps == 0 {
            return Vec::new();
        }
        let gradients = self
            .newton
            .linear
            .iterations_a_solution()
            .map(|value| Fact {
                name: "gradient_iterations_a_solution",
                value,
            });
        let of_newton = [
            Fact {
                name: "newton_iterations_a_step",
                value: self.mean(),
            },
            Fact {
                name: "most_newton_iterations",
                value: self.most as f64,
            },
        ];
        of_newton.into_iter().chain(gradients).collect()
    }

    /// Iterations per step, and growth of the energy.
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
            .chain(self.newton.linear.remark())
            .chain(self.watch.remark())
            .collect()
    }
}
