//! Sweeps that lower a step's potential.

use sinew_core::vectors::{add_scaled, dot, dot_of_difference, norm, weighted_dot};
use sinew_core::{ElasticLaw, EvaluationError, StepReport, System, TangentKind};

use super::point::{Law, Point};
use super::quadratic::Quadratic;
use super::rigid::Rigid;
use crate::cell_factors::CellFactors;

/// Minimum decrease of the potential in a sweep, as a share of the first slope (Armijo, Pacific J. Math. 16, 1966).
const ARMIJO: f64 = 1e-4;

/// Largest step along a direction, in multiples of the preconditioned gradient.
const LONGEST: f64 = 10.0;

/// Number of halvings after which a direction is given up.
pub(super) const MOST_HALVINGS: u32 = 60;

/// Multiples of the rounding of forces within which a slope is meaningless.
pub(super) const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A displacement over a step that is improved by nonlinear conjugate gradients with the cells' diagonal blocks as
/// preconditioner.
///
/// Directions are those of Polak and Ribiere, never negative (Gilbert and Nocedal, SIAM J. Optim. 2, 1992). They
/// restart with every step, so that no history is stored.
///
/// The sweeps start from the displacement by the velocity at the start of the step, if the potential is not higher
/// there than at the start: steady motion is found at once, and no stiffness of a block slows it down. Parts that may
/// move as rigid bodies are moved to the minimum of the potential over such motions, which do not change the elastic
/// energy. The blocks are then those of a [`Deflation`](sinew_cnn::Deflation), and sweeps find the rest.
pub(super) struct Descent {
    /// The displacement over the step (m).
    pub(super) moved: Vec<f64>,
    /// The law at the end of the step.
    pub(super) reached: Point,
    trial: Point,
    layers: usize,
    /// The cells' diagonal blocks (N/m) of the potential's second derivative without inertia, row by row.
    pub(super) own: Vec<f64>,
    pub(super) blocks: CellFactors,
    /// Diagonal blocks of stiffness damping in the step (N s/m); empty without such damping.
    viscous_blocks: Vec<f64>,
    gradient: Vec<f64>,
    gradient_before: Vec<f64>,
    preconditioned: Vec<f64>,
    direction: Vec<f64>,
    /// d2W/du2 times the direction.
    curved: Vec<f64>,
    /// The root of the sum of squares of the energies (J) at the start of the step of springs as stiff as each cell's
    /// diagonal block.
    pub(super) stiff: f64,
    /// D times `moved`, and times the direction, without alpha M.
    damped: Vec<f64>,
    damped_direction: Vec<f64>,
    /// Present if parts may move as rigid bodies.
    pub(super) rigid: Option<Rigid>,
}

/// End of the sweeps of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Found {
    /// Some sweep lowered the potential, or the potential was at its minimum.
    Lower,
    /// No sweep could lower the potential, although it has a slope.
    Nothing,
    /// The slope is not finite.
    NotFinite,
}

/// The next direction.
enum Turn {
    /// The slope of the potential is zero to rounding.
    Level,
    NotFinite,
    /// A direction of descent.
    Down {
        /// Slope of the potential along the direction (J).
        slope: f64,
        /// The gradient times the preconditioned gradient (J).
        steepness: f64,
    },
}

impl Descent {
    pub(super) fn new(system: &dyn System) -> Self {
        let (layers, dofs) = (system.layers().count(), system.dofs());
        let is_viscous = |law: &dyn ElasticLaw| law.damping().stiffness != 0.0;
        let is_viscous = system.as_elastic().is_some_and(is_viscous);
        let zeros = || vec![0.0; dofs];
        Self {
            moved: zeros(),
            reached: Point::new(dofs),
            trial: Point::new(dofs),
            layers,
            own: vec![0.0; dofs * layers],
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
            rigid: Rigid::new(system.free_parts(), dofs),
        }
    }

    /// Returns to the start of the step.
    pub(super) fn restart(&mut self, start: &Point) {
        self.moved.fill(0.0);
        self.damped.fill(0.0);
        self.reached.u.copy_from_slice(&start.u);
        self.reached.force.copy_from_slice(&start.force);
        self.reached.energy = start.energy;
    }

    /// Runs `sweeps` descent sweeps from the start of the step.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law has a force but no tangent.
    pub(super) fn lower(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
        sweeps: u32,
        work: &mut StepReport,
    ) -> Result<Found, EvaluationError> {
        self.restart(start);
        self.look(law, quadratic, start)?;
        self.factorise(quadratic, 1.0);
        work.sweeps += 1;
        let (mut before, mut found) = (None, Found::Nothing);
        if self.lead(law, quadratic, start, work)? {
            found = Found::Lower;
        }
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

    /// Takes the diagonal blocks of stiffness damping at its constant point of the step.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain there.
    pub(super) fn take_viscosity(&mut self, law: &Law<'_>) -> Result<(), EvaluationError> {
        self.viscous_blocks.fill(0.0);
        law.law
            .add_viscous_blocks(&law.damped(), 1.0, &mut self.viscous_blocks)
    }

    /// Moves by the velocity at the start of the step, and moves parts that may move as rigid bodies to the minimum of
    /// the potential over such motions, if the potential is lower there; or does only the latter. Then removes rigid
    /// motions from the blocks. Returns true if anything moved.
    fn lead(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        for (y, v) in self.direction.iter_mut().zip(law.v) {
            *y = law.dt * v;
        }
        if let Some(rigid) = &mut self.rigid {
            rigid.lead(&start.u, quadratic, law.is_quadratic, &mut self.direction);
        }
        let mut is_lower = self.go_to_direction(law, quadratic, start, work)?;
        let Some(rigid) = &mut self.rigid else {
            return Ok(is_lower);
        };
        if !is_lower {
            self.direction.fill(0.0);
            rigid.lead(&start.u, quadratic, law.is_quadratic, &mut self.direction);
            is_lower = self.go_to_direction(law, quadratic, start, work)?;
        }
        if let Some(rigid) = &mut self.rigid {
            self.blocks.write_inverse(1.0, &mut rigid.inverse);
            let about = (!law.is_quadratic).then_some(&*self.reached.u);
            let inertia = |dof: usize| quadratic.mass_weight * quadratic.masses[dof];
            let (added, inverse) = ((1.0, &*self.own), (1.0, &*rigid.inverse));
            rigid.deflation.weigh(about, added, inverse, inertia);
        }
        Ok(is_lower)
    }

    /// Moves from the start of the step by the whole direction if the potential is not higher there; returns true if
    /// it moved.
    fn go_to_direction(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
        work: &mut StepReport,
    ) -> Result<bool, EvaluationError> {
        let y = &self.direction;
        if norm(y) == 0.0 {
            return Ok(false);
        }
        for ((u, start), y) in self.trial.u.iter_mut().zip(&start.u).zip(y) {
            *u = start + y;
        }
        *work += StepReport::ONE_FORCE;
        if self.trial.evaluate(law).is_err() || !self.trial.is_finite() {
            return Ok(false);
        }
        let mut curvature = quadratic.mass_weight * weighted_dot(quadratic.masses, y, y);
        if law.is_damped() {
            law.damping_product(y, &mut self.damped_direction)?;
            work.sweeps += 1;
            curvature += quadratic.damping_weight * dot(y, &self.damped_direction);
        }
        let slope = dot_of_difference(&start.force, quadratic.pull, y);
        let beyond = start.energy_beyond_slope(&self.trial, (y, 1.0), (law, self.stiff));
        let change = slope + 0.5 * curvature + beyond;
        let forces = norm(&start.force) + norm(&self.trial.force);
        if change > ROUNDING * norm(y) * forces {
            return Ok(false);
        }
        self.moved.copy_from_slice(y);
        if law.is_damped() {
            self.damped.copy_from_slice(&self.damped_direction);
        }
        std::mem::swap(&mut self.reached, &mut self.trial);
        Ok(true)
    }

    /// Finds the diagonal blocks of the potential's second derivative at the start of the step, without inertia.
    pub(super) fn look(
        &mut self,
        law: &Law<'_>,
        quadratic: &Quadratic<'_>,
        start: &Point,
    ) -> Result<(), EvaluationError> {
        let own = &mut self.own;
        law.law.node_blocks(&law.at(&start.u), own)?;
        let layers = self.layers;
        let terms = self.preconditioned.iter_mut().zip(&start.u).enumerate();
        for (dof, (term, u)) in terms {
            *term = own[dof * layers + dof % layers] * u * u;
        }
        self.stiff = norm(&self.preconditioned);
        let damping = law.law.damping();
        let weight = quadratic.damping_weight;
        add_scaled(weight, &self.viscous_blocks, own);
        if let Some(extra) = &damping.extra {
            let of_cell = extra.layers().count().pow(2);
            for (cell, entries) in own.chunks_exact_mut(of_cell).enumerate() {
                if let Some(block) = extra.block(cell, cell) {
                    add_scaled(weight, block, entries);
                }
            }
        }
        Ok(())
    }

    /// Factorises these blocks, `factor` times, with the inertia.
    pub(super) fn factorise(&mut self, quadratic: &Quadratic<'_>, factor: f64) {
        let entries = self.blocks.entries_mut().iter_mut();
        entries
            .zip(&self.own)
            .for_each(|(entry, own)| *entry = factor * own);
        self.blocks
            .factorise(|dof| quadratic.mass_weight * quadratic.masses[dof]);
    }

    /// `x'B x` (J) for the blocks B of the cells without inertia.
    pub(super) fn own_product(&self, x: &[f64]) -> f64 {
        let n = self.layers;
        let cells = self.own.chunks_exact(n * n).zip(x.chunks_exact(n));
        let of_cell = |(block, x): (&[f64], &[f64])| {
            let rows = block.chunks_exact(n).zip(x);
            rows.map(|(row, x_i)| x_i * row.iter().zip(x).map(|(b, x_j)| b * x_j).sum::<f64>())
                .sum::<f64>()
        };
        cells.map(of_cell).sum()
    }

    /// Finds the next direction; `before` is the steepness of the last direction.
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
        if let Some(rigid) = &self.rigid {
            rigid
                .deflation
                .correct(&self.gradient, &mut self.preconditioned);
        }
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

    /// Moves along the direction as far as the potential falls; returns true if it does.
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
