//! Sweeps that lower a step's potential.

use sinew_core::vectors::{add_scaled, dot, norm, weighted_dot};
use sinew_core::{EvaluationError, StepReport, TangentKind};

use super::cell_factors::CellFactors;
use super::point::{Law, Point};

/// Share of the first slope by which a sweep lowers the potential at least (Armijo, Pacific J. Math. 16, 1966).
const ARMIJO: f64 = 1e-4;

/// Largest step along a direction, in multiples of the preconditioned gradient.
const LONGEST: f64 = 10.0;

/// Halvings after which a direction is given up.
pub(super) const MOST_HALVINGS: u32 = 60;

/// Multiples of the rounding of forces within which a slope says nothing.
pub(super) const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// `m/2 y'M y + d/2 y'D y - b'y`, y being the displacement over the step: what a step's potential holds besides `W`.
pub(super) struct Quadratic<'a> {
    /// M (kg).
    pub(super) masses: &'a [f64],
    /// m (1/s^2).
    pub(super) mass_weight: f64,
    /// d (1/s).
    pub(super) damping_weight: f64,
    /// b (N).
    pub(super) pull: &'a [f64],
}

impl Quadratic<'_> {
    /// The potential's slope (N) where a displacement y (m), with D y (N) where anything damps, has led to the law's force (N).
    pub(super) fn write_slope(
        &self,
        (moved, damped): (&[f64], Option<&[f64]>),
        force: &[f64],
        out: &mut [f64],
    ) {
        let values = moved.iter().zip(self.masses).zip(self.pull);
        let values = values.zip(force).zip(&mut *out);
        for ((((moved, mass), pull), force), slope) in values {
            *slope = self.mass_weight * mass * moved - pull + force;
        }
        if let Some(damped) = damped {
            add_scaled(self.damping_weight, damped, out);
        }
    }
}

/// A displacement over a step that is improved by nonlinear conjugate gradients with the cells' own blocks for a preconditioner.
///
/// Directions are those of Polak and Ribiere, never negative (Gilbert and Nocedal, SIAM J. Optim. 2, 1992). They begin anew with every step,
/// so that nothing is remembered.
pub(super) struct Descent {
    /// The displacement over the step (m).
    pub(super) moved: Vec<f64>,
    /// The law at the end of the step.
    pub(super) reached: Point,
    trial: Point,
    layers: usize,
    pub(super) blocks: CellFactors,
    /// Own blocks of stiffness damping in the step (N s/m); empty where there is none.
    viscous_blocks: Vec<f64>,
    gradient: Vec<f64>,
    gradient_before: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    /// d2W/du2 times the direction.
    curved: Vec<f64>,
    /// The sum of squares, rooted, of what springs as stiff as each cell's own block would hold at the start of the step (J).
    pub(super) stiff: f64,
    /// D times `moved`, and times the direction, without alpha M.
    damped: Vec<f64>,
    damped_direction: Vec<f64>,
}

/// End of the sweeps of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// Some sweep lowered the potential, or nothing was left to lower.
    Lower,
    /// No sweep could lower it, though it has a slope.
    Nothing,
    /// The slope is not finite.
    NotFinite,
}

/// The next direction.
enum Turn {
    /// The potential is level to rounding.
    Level,
    NotFinite,
    /// Down.
    Down {
        /// Slope of the potential along the direction (J).
        slope: f64,
        /// The gradient times the preconditioned gradient (J).
        steepness: f64,
    },
}

impl Descent {
    /// Room for cells with so many layers, and for stiffness damping where there is any.
    pub(super) fn new(layers: usize, dofs: usize, is_viscous: bool) -> Self {
        let zeros = || vec![0.0; dofs];
        Self {
            moved: zeros(),
            reached: Point::new(dofs),
            trial: Point::new(dofs),
            layers,
            blocks: CellFactors::new(layers, dofs),
            viscous_blocks: vec![0.0; if is_viscous { layers * dofs } else { 0 }],
            gradient: zeros(),
            gradient_before: zeros(),
            preconditioned: zeros(),
            direction: zeros(),
            curved: zeros(),
            stiff: 0.0,
            damped: zeros(),
            damped_direction: zeros(),
        }
    }

    /// Goes back to the start of the step.
    pub(super) fn restart(&mut self, start: &Point) {
        self.moved.fill(0.0);
        self.damped.fill(0.0);
        self.reached.u.copy_from_slice(&start.u);
        self.reached.force.copy_from_slice(&start.force);
        self.reached.energy = start.energy;
    }

    /// Lowers the potential by so many sweeps from the start of the step.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law has no tangent where it has a force.
    pub(super) fn lower(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
        sweeps: u32,
        work: &mut StepReport,
    ) -> Result<Found, EvaluationError> {
        self.restart(start);
        self.factorise(law, quadratic, start)?;
        work.sweeps += 1;
        let (mut before, mut found) = (None, Found::Nothing);
        for _ in 0..sweeps {
            let (slope, steepness) = match self.turn(law, quadratic, before) {
                Turn::Level => return Ok(Found::Lower),
                Turn::NotFinite => return Ok(Found::NotFinite),
                Turn::Down { slope, steepness } => (slope, steepness),
            };
            if self.walk(law, quadratic, start, slope, work)? {
                (before, found) = (Some(steepness), Found::Lower);
            } else if before.take().is_none() {
                // Not even along the steepest descent.
                break;
            }
        }
        Ok(found)
    }

    /// Takes the own blocks of stiffness damping where it is held in the step.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain there.
    pub(super) fn take_viscosity(&mut self, law: &Law<'_>) -> Result<(), EvaluationError> {
        self.viscous_blocks.fill(0.0);
        law.law
            .add_viscous_blocks(&law.damped(), 1.0, &mut self.viscous_blocks)
    }

    /// Factorises the diagonal blocks of the potential's second derivative at the start of the step.
    pub(super) fn factorise(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
    ) -> Result<(), EvaluationError> {
        let entries = self.blocks.entries_mut();
        law.law.node_blocks(&law.at(&start.u), entries)?;
        let layers = self.layers;
        let terms = self.preconditioned.iter_mut().zip(&start.u).enumerate();
        for (dof, (term, u)) in terms {
            *term = entries[dof * layers + dof % layers] * u * u;
        }
        self.stiff = norm(&self.preconditioned);
        let damping = law.law.damping();
        let weight = quadratic.damping_weight;
        add_scaled(weight, &self.viscous_blocks, entries);
        if let Some(extra) = &damping.extra {
            let of_cell = extra.layers().count().pow(2);
            for (cell, entries) in entries.chunks_exact_mut(of_cell).enumerate() {
                if let Some(block) = extra.block(cell, cell) {
                    add_scaled(weight, block, entries);
                }
            }
        }
        let masses = quadratic.masses;
        self.blocks
            .factorise(|dof| quadratic.mass_weight * masses[dof]);
        Ok(())
    }

    /// Finds the next direction; `before` is the steepness of the last.
    fn turn(&mut self, law: &Law<'_>, quadratic: &Quadratic<'_>, before: Option<f64>) -> Turn {
        std::mem::swap(&mut self.gradient, &mut self.gradient_before);
        let damped = law.is_damped().then_some(&*self.damped);
        quadratic.write_slope(
            (&self.moved, damped),
            &self.reached.force,
            &mut self.gradient,
        );
        self.preconditioned.copy_from_slice(&self.gradient);
        self.blocks.solve(&mut self.preconditioned);
        let steepness = dot(&self.gradient, &self.preconditioned);
        if !steepness.is_finite() {
            return Turn::NotFinite;
        }
        if steepness <= 0.0 {
            return Turn::Level;
        }
        let conjugate = before.map_or(0.0, |before| {
            let change = steepness - dot(&self.gradient_before, &self.preconditioned);
            (change / before).max(0.0)
        });
        for (direction, preconditioned) in self.direction.iter_mut().zip(&self.preconditioned) {
            *direction = conjugate * *direction - preconditioned;
        }
        let mut slope = dot(&self.gradient, &self.direction);
        if !(slope.is_finite() && slope < 0.0) {
            for (direction, preconditioned) in self.direction.iter_mut().zip(&self.preconditioned) {
                *direction = -preconditioned;
            }
            slope = -steepness;
        }
        Turn::Down { slope, steepness }
    }

    /// Walks along the direction as far as the potential falls; whether it does.
    fn walk(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
        slope: f64,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        let direction = &self.direction;
        law.law.tangent_product(
            &law.at(&self.reached.u),
            TangentKind::Exact,
            direction,
            &mut self.curved,
        )?;
        work.sweeps += 1;
        let mut curvature =
            quadratic.mass_weight * weighted_dot(quadratic.masses, direction, direction);
        if law.is_damped() {
            law.damping_product(direction, &mut self.damped_direction)?;
            work.sweeps += 1;
            curvature += quadratic.damping_weight * dot(direction, &self.damped_direction);
        }
        let of_law = dot(direction, &self.curved);
        let mut length = match curvature + of_law {
            whole if whole > 0.0 => (-slope / whole).min(LONGEST),
            _ => 1.0,
        };
        for _ in 0..=MOST_HALVINGS {
            let ends = self.trial.u.iter_mut().zip(&start.u);
            for ((end, start), (moved, direction)) in ends.zip(self.moved.iter().zip(direction)) {
                *end = start + (moved + length * direction);
            }
            *work += StepReport::ONE_FORCE;
            // A point that the law refuses is one that is too far.
            if self.trial.evaluate(law).is_ok() && self.trial.is_finite() {
                let beyond = self.reached.energy_beyond_slope(
                    &self.trial,
                    (direction, length),
                    (law, self.stiff),
                );
                let change = length * slope + 0.5 * length * length * curvature + beyond;
                let forces = norm(&self.reached.force) + norm(&self.trial.force);
                let rounding = ROUNDING * length * norm(direction) * forces;
                if change <= ARMIJO * length * slope + rounding {
                    add_scaled(length, direction, &mut self.moved);
                    if law.is_damped() {
                        add_scaled(length, &self.damped_direction, &mut self.damped);
                    }
                    std::mem::swap(&mut self.reached, &mut self.trial);
                    return Ok(true);
                }
            }
            work.backtracks += 1;
            length *= 0.5;
        }
        Ok(false)
    }
}
