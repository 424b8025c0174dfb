//! Linear systems: M, D, K on one pattern, and loads.

use std::sync::Arc;

use sinew_sparse::{AssemblyError, BlockMatrix, Layers, Pattern};

use crate::{
    Elements, Energy, EvaluationError, LoadTime, Ramp, RampError, Revision, System, Trial,
};

/// A [`System`] that shows its matrices.
pub trait LinearSystem: System {
    /// M, D, K and the loads.
    fn operators(&self) -> &LinearOperators;

    /// The elements that K is a sum of, where the system knows them.
    fn elements(&self) -> Option<&dyn Elements> {
        None
    }
}

/// D = alpha M + beta K + extra.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Damping {
    /// alpha (1/s).
    pub mass: f64,
    /// beta (s).
    pub stiffness: f64,
    /// Damping that is proportional to neither (N s/m), on the stiffness matrix's pattern.
    pub extra: Option<Arc<BlockMatrix>>,
}

/// A force with one factor over time: `ramp(t)` times `entries`.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// The factor over time.
    pub ramp: Ramp,
    /// (degree of freedom, force (N)) of each loaded degree of freedom.
    pub entries: Vec<(u32, f64)>,
}

/// Why matrices do not make a system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OperatorError {
    /// Vectors and matrices of different sizes.
    #[error("{what} has {found} degrees of freedom, the stiffness matrix has {expected}")]
    Size {
        /// Which of them.
        what: &'static str,
        /// Its size.
        found: usize,
        /// Size of the stiffness matrix.
        expected: usize,
    },
    /// Damping on another pattern than the stiffness.
    #[error("the extra damping has another pattern than the stiffness")]
    Pattern,
    /// A damping rate that is negative or not finite.
    #[error("{what} damping = {value}: expected a finite number, 0 or above")]
    Damping {
        /// `mass` or `stiffness`.
        what: &'static str,
        /// The rate.
        value: f64,
    },
    /// A load's ramp.
    #[error("ramp of load {load}: {source}")]
    Ramp {
        /// 0-based number of the load.
        load: usize,
        /// What is wrong with it.
        source: RampError,
    },
    /// Assembly of the matrix.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
}

/// M, D, K and the loads of a linear system. Clones share the matrices.
#[derive(Clone, Debug)]
pub struct LinearOperators {
    mass: Arc<[f64]>,
    stiffness: Arc<BlockMatrix>,
    damping: Damping,
    loads: Arc<[Load]>,
    revision: Revision,
}

impl LinearOperators {
    /// Puts matrices together. `mass` holds the lumped mass of each degree of freedom (kg);
    /// whether it is positive is checked by the integrators, which divide by it.
    ///
    /// # Errors
    /// [`OperatorError`] when sizes or patterns differ, a rate is negative or a ramp impossible.
    pub fn new(
        mass: Vec<f64>,
        stiffness: BlockMatrix,
        damping: Damping,
        loads: Vec<Load>,
    ) -> Result<Self, OperatorError> {
        let expected = stiffness.dofs();
        let same_size = |what, found| {
            if found == expected {
                return Ok(());
            }
            Err(OperatorError::Size {
                what,
                found,
                expected,
            })
        };
        same_size("the mass", mass.len())?;
        if let Some(extra) = &damping.extra {
            same_size("the extra damping", extra.dofs())?;
            if extra.pattern() != stiffness.pattern() {
                return Err(OperatorError::Pattern);
            }
        }
        for (what, value) in [("mass", damping.mass), ("stiffness", damping.stiffness)] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(OperatorError::Damping { what, value });
            }
        }
        for (load, Load { ramp, entries }) in loads.iter().enumerate() {
            ramp.check()
                .map_err(|source| OperatorError::Ramp { load, source })?;
            for &(dof, _) in entries {
                if dof as usize >= expected {
                    same_size("a load", dof as usize + 1)?;
                }
            }
        }
        Ok(Self {
            mass: mass.into(),
            stiffness: Arc::new(stiffness),
            damping,
            loads: loads.into(),
            revision: Revision::new(),
        })
    }

    /// One mass m (kg) on a spring k (N/m) and a dashpot d [N s/m]: one cell, one layer.
    ///
    /// # Errors
    /// As [`LinearOperators::new`].
    pub fn oscillator(mass: f64, stiffness: f64, damping: f64) -> Result<Self, OperatorError> {
        let pattern = Arc::new(Pattern::from_elements(1, [[0]])?);
        let mut matrix = BlockMatrix::zeros(pattern, Layers::One);
        matrix.add_block(0, 0, &[stiffness])?;
        let damping = Damping {
            mass: damping / mass,
            ..Damping::default()
        };
        Self::new(vec![mass], matrix, damping, Vec::new())
    }

    /// The same matrices under other loads.
    ///
    /// # Errors
    /// As [`LinearOperators::new`].
    pub fn with_loads(self, loads: Vec<Load>) -> Result<Self, OperatorError> {
        let stiffness = Arc::unwrap_or_clone(self.stiffness);
        Self::new(self.mass.to_vec(), stiffness, self.damping, loads)
    }

    /// Lumped mass of each degree of freedom (kg).
    #[must_use]
    pub fn mass(&self) -> &[f64] {
        &self.mass
    }

    /// K (N/m).
    #[must_use]
    pub fn stiffness(&self) -> &Arc<BlockMatrix> {
        &self.stiffness
    }

    /// D.
    #[must_use]
    pub fn damping(&self) -> &Damping {
        &self.damping
    }

    /// The loads.
    #[must_use]
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// Identity of these matrices; clones share it.
    #[must_use]
    pub fn revision(&self) -> Revision {
        self.revision
    }

    /// Degrees of freedom.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.mass.len()
    }

    /// `out = F` (N) as a step takes it, or at an instant (s).
    pub fn external_force(&self, when: impl Into<LoadTime>, out: &mut [f64]) {
        let when = when.into();
        out.fill(0.0);
        for Load { ramp, entries } in self.loads.iter() {
            let factor = ramp.factor(when);
            if factor != 0.0 {
                for &(dof, force) in entries {
                    out[dof as usize] += factor * force;
                }
            }
        }
    }

    /// `out += F(after) - F(before)` (N) of the loads that are not smooth between two instants
    /// `from` and `to` (s); whether there are any.
    pub fn add_load_change(
        &self,
        [before, after]: [LoadTime; 2],
        [from, to]: [f64; 2],
        out: &mut [f64],
    ) -> bool {
        let broken = |load: &&Load| !load.ramp.is_smooth_between(from, to);
        let mut any = false;
        for Load { ramp, entries } in self.loads.iter().filter(broken) {
            any = true;
            let change = ramp.factor(after) - ramp.factor(before);
            for &(dof, force) in entries {
                out[dof as usize] += change * force;
            }
        }
        any
    }

    /// `out -= K u + D v` (N): one sweep. Damping that a system does not have costs nothing, and
    /// stiffness-proportional damping shares the product with K.
    pub fn subtract_internal_force(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        if self.damping.stiffness == 0.0 {
            self.stiffness.subtract_product(u, out);
        } else {
            self.stiffness
                .subtract_product_combined(u, self.damping.stiffness, v, out);
        }
        self.subtract_damping_beyond_stiffness(v, out);
    }

    /// `out -= D v` (N).
    pub fn subtract_damping(&self, v: &[f64], out: &mut [f64]) {
        if self.damping.stiffness != 0.0 {
            self.stiffness
                .subtract_scaled_product(self.damping.stiffness, v, out);
        }
        self.subtract_damping_beyond_stiffness(v, out);
    }

    fn subtract_damping_beyond_stiffness(&self, v: &[f64], out: &mut [f64]) {
        let alpha = self.damping.mass;
        if alpha != 0.0 {
            for ((value, mass), v) in out.iter_mut().zip(self.mass.iter()).zip(v) {
                *value -= alpha * mass * v;
            }
        }
        if let Some(extra) = &self.damping.extra {
            extra.subtract_product(v, out);
        }
    }

    /// `out = F - K u - D v` (N).
    pub fn net_force(&self, when: impl Into<LoadTime>, u: &[f64], v: &[f64], out: &mut [f64]) {
        self.external_force(when, out);
        self.subtract_internal_force(u, v, out);
    }

    /// Kinetic energy and energy stored in deformation (J).
    #[must_use]
    pub fn energy(&self, u: &[f64], v: &[f64]) -> Energy {
        let mut force = vec![0.0; u.len()];
        self.stiffness.multiply(u, &mut force);
        let moving = v.iter().zip(self.mass.iter());
        Energy {
            kinetic: 0.5 * moving.map(|(v, mass)| mass * v * v).sum::<f64>(),
            elastic: 0.5 * u.iter().zip(&force).map(|(u, f)| u * f).sum::<f64>(),
        }
    }
}

/// The plainest [`LinearSystem`]: matrices and nothing else.
#[derive(Clone, Debug)]
pub struct LinearModel {
    operators: LinearOperators,
}

impl LinearModel {
    /// The system with these matrices.
    #[must_use]
    pub fn new(operators: LinearOperators) -> Self {
        Self { operators }
    }
}

impl System for LinearModel {
    fn dofs(&self) -> usize {
        self.operators.dofs()
    }

    fn mass(&self) -> &[f64] {
        self.operators.mass()
    }

    fn revision(&self) -> Revision {
        self.operators.revision()
    }

    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.operators.net_force(trial.load, trial.u, trial.v, out);
        Ok(())
    }

    fn external_force(&self, when: LoadTime, out: &mut [f64]) {
        self.operators.external_force(when, out);
    }

    fn mass_damping(&self) -> f64 {
        self.operators.damping.mass
    }

    fn energy(&self, u: &[f64], v: &[f64]) -> Option<Energy> {
        Some(self.operators.energy(u, v))
    }

    fn as_linear(&self) -> Option<&dyn LinearSystem> {
        Some(self)
    }
}

impl LinearSystem for LinearModel {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(damping: impl FnOnce(&BlockMatrix) -> Damping) -> LinearOperators {
        let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]]).unwrap());
        let mut stiffness = BlockMatrix::zeros(pattern, Layers::One);
        stiffness
            .add_element(&[0, 1], &[5.0, -2.0, -2.0, 3.0])
            .unwrap();
        let damping = damping(&stiffness);
        LinearOperators::new(vec![2.0, 4.0], stiffness, damping, Vec::new()).unwrap()
    }

    #[test]
    fn every_part_of_the_damping_is_felt_once() {
        let operators = pair(|stiffness| {
            let mut extra = stiffness.clone();
            extra.scale_rows(&[10.0, 10.0]);
            Damping {
                mass: 0.5,
                stiffness: 0.1,
                extra: Some(Arc::new(extra)),
            }
        });
        let (u, v) = ([1.0, 2.0], [3.0, -1.0]);
        // K u = (1, 4), K v = (17, -9), M v = (6, -4).
        let damping = [0.5 * 6.0 + 10.1 * 17.0, 0.5 * -4.0 + 10.1 * -9.0];
        let mut out = [0.0; 2];
        operators.subtract_damping(&v, &mut out);
        for (value, expected) in out.iter().zip(&damping) {
            assert!((value + expected).abs() < 1e-12);
        }
        operators.net_force(0.0, &u, &v, &mut out);
        for ((value, elastic), damping) in out.iter().zip([1.0, 4.0]).zip(damping) {
            assert!((value + elastic + damping).abs() < 1e-12);
        }
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let stiffness = || BlockMatrix::clone(pair(|_| Damping::default()).stiffness());
        let build = |mass: &[f64], damping, loads| {
            LinearOperators::new(mass.to_vec(), stiffness(), damping, loads).map(|_| ())
        };
        assert_eq!(
            build(&[1.0], Damping::default(), vec![])
                .unwrap_err()
                .to_string(),
            "the mass has 1 degrees of freedom, the stiffness matrix has 2"
        );
        let negative = Damping {
            mass: -1.0,
            ..Damping::default()
        };
        assert!(matches!(
            build(&[1.0, 1.0], negative, vec![]),
            Err(OperatorError::Damping { what: "mass", .. })
        ));
        let load = Load {
            ramp: Ramp::Step,
            entries: vec![(2, 1.0)],
        };
        assert!(build(&[1.0, 1.0], Damping::default(), vec![load]).is_err());
    }

    #[test]
    fn energy_of_a_known_state() {
        let energy = pair(|_| Damping::default()).energy(&[1.0, 2.0], &[3.0, -1.0]);
        assert_eq!(energy.kinetic, 0.5 * (2.0 * 9.0 + 4.0));
        assert_eq!(energy.elastic, 0.5 * (1.0 + 8.0));
    }
}
