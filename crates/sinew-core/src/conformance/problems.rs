//! Small linear systems with known motions.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use crate::closed_form::DampedOscillator;
use crate::{
    BlockMatrix, Damping, Inputs, Integrator, Layers, LinearModel, LinearOperators, LinearSystem,
    Load, OperatorError, Pattern, Ramp, StableStep, State, System,
};

pub(super) const MASS: f64 = 0.5;
pub(super) const SPRING: f64 = 200.0;
pub(super) const FORCE: f64 = 3.0;

/// Largest angular frequency of the chain (rad/s): sqrt(3 k/m).
pub(super) const OMEGA_MAX: f64 = 34.641_016_151_377_55;

/// Damping of a problem.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Dampers {
    /// alpha (1/s).
    pub(super) mass: f64,
    /// beta (s).
    pub(super) stiffness: f64,
    /// Rate of a dashpot that mixes the modes (N s/m).
    pub(super) dashpot: f64,
}

impl Dampers {
    pub(super) const NONE: Self = Self {
        mass: 0.0,
        stiffness: 0.0,
        dashpot: 0.0,
    };
    pub(super) const MASS: Self = Self {
        mass: 2.0,
        ..Self::NONE
    };
    pub(super) const STIFFNESS: Self = Self {
        stiffness: 0.01,
        ..Self::NONE
    };
    pub(super) const DASHPOT: Self = Self {
        dashpot: 4.0,
        ..Self::NONE
    };
    pub(super) const ALL: Self = Self {
        mass: 2.0,
        stiffness: 0.01,
        dashpot: 4.0,
    };

    fn on(self, dashpots: BlockMatrix) -> Damping {
        Damping {
            mass: self.mass,
            stiffness: self.stiffness,
            extra: (self.dashpot > 0.0).then(|| Arc::new(dashpots)),
        }
    }
}

/// A linear system and the state that its motion starts from.
pub(super) struct Problem {
    pub(super) name: &'static str,
    pub(super) system: LinearModel,
    pub(super) start: State,
}

/// The problems under constant loads: a chain of two masses, one layer, and a body in space.
pub(super) fn problems(damping: Dampers, force: f64) -> [Problem; 2] {
    [
        Problem {
            name: "chain",
            system: damped_chain(Ramp::Step, damping, force, [MASS; 2]),
            start: moving(),
        },
        body(damping, force),
    ]
}

/// wall - mass - mass - wall with equal springs: modes (1, 1) at sqrt(k/m) and (1, -1) at
/// sqrt(3k/m); a force on the first mass from t = 0.
pub(super) fn chain(damping: f64, force: f64, masses: [f64; 2]) -> LinearModel {
    chain_under(Ramp::Step, damping, force, masses)
}

/// The chain under a force that changes.
pub(super) fn chain_under(ramp: Ramp, damping: f64, force: f64, masses: [f64; 2]) -> LinearModel {
    let damping = Dampers {
        mass: damping,
        ..Dampers::NONE
    };
    damped_chain(ramp, damping, force, masses)
}

/// The chain with other damping; the dashpot is between the wall and the first mass.
pub(super) fn damped_chain(
    ramp: Ramp,
    damping: Dampers,
    force: f64,
    masses: [f64; 2],
) -> LinearModel {
    let load = Load {
        ramp,
        entries: vec![(0, force)],
    };
    loaded_chain(damping, masses, vec![load])
}

/// The chain under any loads.
pub(super) fn loaded_chain(damping: Dampers, masses: [f64; 2], loads: Vec<Load>) -> LinearModel {
    sound(|| {
        let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]])?);
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
        let element = [2.0 * SPRING, -SPRING, -SPRING, 2.0 * SPRING];
        stiffness.add_element(&[0, 1], &element)?;
        let mut dashpots = BlockMatrix::zeros(pattern, Layers::One);
        dashpots.add_block(0, 0, &[damping.dashpot])?;
        LinearOperators::new(masses.to_vec(), stiffness, damping.on(dashpots), loads)
    })
}

/// The component of the body in which one of its nodes is fixed.
pub(super) const HELD: usize = 7;

/// Three nodes in space, each connected to the ground and to both others by springs in no special direction, so that
/// all blocks of K are full; the last is fixed in y and keeps that component, on which no force acts.
fn body(damping: Dampers, force: f64) -> Problem {
    let directions = [[0.6, 0.64, 0.48], [-0.36, 0.48, 0.8], [0.8, -0.36, 0.48]];
    let outer = |n: [f64; 3]| move |i: usize, j: usize| n[i] * n[j];
    let system = sound(|| {
        let pattern = Arc::new(Pattern::from_elements(3, [[0, 1, 2]])?);
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::Three);
        let mut dashpots = BlockMatrix::zeros(pattern, Layers::Three);
        let pairs = [[0, 1], [1, 2], [0, 2]];
        for ((pair, n), share) in pairs.into_iter().zip(directions).zip([0.3, 0.5, 0.2]) {
            let along = outer(n);
            let between = |factor: f64| -> Vec<f64> {
                let entry = |row: usize, column: usize| {
                    let sign = if row / 3 == column / 3 { 1.0 } else { -1.0 };
                    factor * sign * along(row % 3, column % 3)
                };
                (0..36).map(|at| entry(at / 6, at % 6)).collect()
            };
            stiffness.add_element(&pair, &between(share * SPRING))?;
            dashpots.add_element(&pair, &between(share * damping.dashpot))?;
        }
        for node in 0..3_u32 {
            // 1 - n n'/2 has no negative eigenvalue.
            let along = outer(directions[node as usize]);
            let ground =
                |at: usize| f64::from(u8::from(at.is_multiple_of(4))) - 0.5 * along(at / 3, at % 3);
            let block: Vec<f64> = (0..9).map(|at| 0.4 * SPRING * ground(at)).collect();
            stiffness.add_block(node, node, &block)?;
        }
        let mut held = [false; 9];
        held[HELD] = true;
        stiffness.clear_pinned(&held);
        dashpots.clear_pinned(&held);
        let mass = [0.5, 0.3, 0.7].into_iter().flat_map(|mass| [mass; 3]);
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(0, force), (4, -0.5 * force), (8, 0.7 * force)],
        };
        LinearOperators::new(mass.collect(), stiffness, damping.on(dashpots), vec![load])
    });
    Problem {
        name: "body in space",
        system,
        start: State::new(
            vec![0.02, -0.01, 0.005, 0.0, 0.015, -0.02, 0.01, 0.0, -0.005],
            vec![0.3, 0.5, -0.2, 0.1, -0.4, 0.2, 0.6, 0.0, -0.3],
        ),
    }
}

fn sound(build: impl FnOnce() -> Result<LinearOperators, OperatorError>) -> LinearModel {
    match build() {
        Ok(operators) => LinearModel::new(operators),
        Err(error) => unreachable!("the problem is sound: {error}"),
    }
}

/// A state in which both masses of the chain move.
pub(super) fn moving() -> State {
    State::new(vec![0.02, -0.01], vec![0.3, 0.5])
}

/// The displacements of the mass-damped chain at `t` (s).
pub(super) fn exact(damping: f64, start: &State, t: f64) -> [f64; 2] {
    let mode = |sign: f64, omega: f64| {
        let project = |x: &[f64]| (x[0] + sign * x[1]) * FRAC_1_SQRT_2;
        DampedOscillator {
            omega,
            damping,
            load: FORCE / MASS * FRAC_1_SQRT_2,
            displacement: project(&start.u),
            velocity: project(&start.v),
        }
        .at(t)
        .0
    };
    let slow = mode(1.0, (SPRING / MASS).sqrt());
    let fast = mode(-1.0, OMEGA_MAX);
    [(slow + fast) * FRAC_1_SQRT_2, (slow - fast) * FRAC_1_SQRT_2]
}

impl Problem {
    /// The displacements after each of `count` times `interval` (s), by the Taylor series of the motion
    /// in steps far below 1/omega_max. Loads are those at t = 0.
    pub(super) fn motion(&self, interval: f64, count: usize) -> Vec<Vec<f64>> {
        let operators = self.system.operators();
        let parts = (interval / 0.01).ceil().max(1.0);
        let (mut u, mut v) = (self.start.u.clone(), self.start.v.clone());
        let mut instants = Vec::with_capacity(count);
        for _ in 0..count {
            for _ in 0..parts as usize {
                // The derivatives number k and k + 1, and h^k/k!.
                let (mut low, mut high, mut weight) = (u.clone(), v.clone(), 1.0);
                u.fill(0.0);
                v.fill(0.0);
                for k in 0..25 {
                    let mut next = vec![0.0; u.len()];
                    if k == 0 {
                        operators.external_force(0.0, &mut next);
                    }
                    operators.subtract_internal_force(&low, &high, &mut next);
                    for dof in 0..u.len() {
                        u[dof] += weight * low[dof];
                        v[dof] += weight * high[dof];
                        next[dof] /= operators.mass()[dof];
                    }
                    (low, high) = (high, next);
                    weight *= interval / parts / f64::from(k + 1);
                }
            }
            instants.push(u.clone());
        }
        instants
    }
}

/// Takes steps that must succeed.
pub(super) fn advance(
    integrator: &mut dyn Integrator,
    system: &dyn System,
    state: &mut State,
    steps: usize,
    dt: f64,
) {
    for _ in 0..steps {
        if let Err(error) = integrator.step(system, state, dt) {
            unreachable!("`{}` refused a sound step: {error}", integrator.id());
        }
    }
}

/// Sets forces; they must be accepted.
pub(super) fn give(inputs: &mut Inputs, t: f64, forces: &[(u32, f64)]) {
    if let Err(error) = inputs.set_forces(t, forces) {
        unreachable!("the forces are sound: {error}");
    }
}

/// A step within the stable one: a quarter of it, or of 2/omega_max if there is no limit or
/// the method is never stable.
pub(super) fn gentle_step(integrator: &dyn Integrator, system: &dyn System) -> f64 {
    match (integrator.stable_step(system), system.spectrum(None)) {
        (Ok(StableStep::UpTo(limit)), _) if limit > 0.0 => limit / 4.0,
        (_, Some(spectrum)) => spectrum.critical_step() / 4.0,
        (_, None) => 0.5 / OMEGA_MAX,
    }
}

/// True if the method is never stable on this system.
pub(super) fn is_never_stable(integrator: &dyn Integrator, system: &dyn System) -> bool {
    matches!(integrator.stable_step(system), Ok(StableStep::UpTo(limit)) if limit <= 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_is_the_closed_form_under_mass_damping() {
        let [problem, _] = problems(Dampers::MASS, FORCE);
        for (interval, count) in [(0.003, 1), (0.05, 2), (0.47, 1)] {
            let found = problem.motion(interval, count);
            let expected = exact(2.0, &problem.start, interval * count as f64);
            for (u, expected) in found[count - 1].iter().zip(expected) {
                assert!((u - expected).abs() <= 1e-14, "{u} {expected}");
            }
        }
    }

    #[test]
    fn the_body_has_full_blocks_and_one_component_without_force() {
        let [_, body] = problems(Dampers::ALL, FORCE);
        let operators = body.system.operators();
        for matrix in [
            operators.stiffness(),
            operators.damping().extra.as_ref().unwrap(),
        ] {
            for (row, column) in [(0, 0), (0, 1), (1, 2), (2, 0)] {
                for (at, entry) in matrix.block(row, column).unwrap().iter().enumerate() {
                    let held = 3 * row + at / 3 == HELD || 3 * column + at % 3 == HELD;
                    assert_eq!(*entry == 0.0, held, "block {row} {column}, entry {at}");
                }
            }
        }
        let motion = body.motion(0.1, 3);
        assert!(motion.iter().all(|u| u[HELD] == 0.0 && u[0] != 0.0));
    }
}
