//! Linear systems: M, D, K on one pattern, and loads.

mod cut_rows;

pub use cut_rows::CutRows;

use std::sync::Arc;

use sinew_sparse::{AssemblyError, BlockMatrix, Layers, Pattern};

use crate::derived::Derived;
use crate::element_bounds::ElementBounds;
use crate::energy::Energy;
use crate::input::Inputs;
use crate::load::Load;
use crate::load_time::LoadTime;
use crate::ramp::RampError;
use crate::revision::Revision;

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

/// Reasons for which matrices do not make a system.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OperatorError {
    /// Vectors and matrices of different sizes.
    #[error("{what} has {found} degrees of freedom, the stiffness matrix has {expected}")]
    Size {
        /// Name of the vector or matrix.
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
    /// An invalid ramp of a load.
    #[error("ramp of load {load}: {source}")]
    Ramp {
        /// 0-based number of the load.
        load: usize,
        /// The error of the ramp.
        source: RampError,
    },
    /// A load on a degree of freedom that does not exist.
    #[error("load {load} acts on degree of freedom {dof}: there are {dofs} (0-based)")]
    LoadOutOfRange {
        /// 0-based number of the load.
        load: usize,
        /// The degree of freedom named.
        dof: u32,
        /// Degrees of freedom of the system.
        dofs: usize,
    },
    /// An error in the assembly of a matrix.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
}

/// M, D, K and the loads of a linear system. Clones share the matrices, and values derived from
/// them are computed once for all clones.
#[derive(Clone, Debug)]
pub struct LinearOperators {
    matrices: Arc<Matrices>,
    loads: Arc<[Load]>,
    loads_revision: Revision,
}

#[derive(Clone, Debug)]
struct Matrices {
    mass: Vec<f64>,
    stiffness: Arc<BlockMatrix>,
    damping: Damping,
    /// Bounds used in place of eigenvalues.
    bounds: Option<ElementBounds>,
    revision: Revision,
    derived: Derived,
}

impl LinearOperators {
    /// Combines matrices into a system. `mass` holds the lumped mass of each degree of freedom (kg); integrators, which
    /// divide by it, check that it is positive.
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
        check_loads(&loads, expected)?;
        Ok(Self {
            matrices: Arc::new(Matrices {
                mass,
                stiffness: Arc::new(stiffness),
                damping,
                bounds: None,
                revision: Revision::new(),
                derived: Derived::default(),
            }),
            loads: loads.into(),
            loads_revision: Revision::new(),
        })
    }

    /// One mass m (kg) on a spring k (N/m) and a dashpot d [N s/m]: one cell, one layer.
    ///
    /// # Errors
    /// Same as [`LinearOperators::new`].
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

    /// These matrices, shared, under other loads.
    ///
    /// The new loads count from t = 0: a run that changes to them later continues with one-step
    /// methods only. Forces that change during a run are [`Inputs`].
    ///
    /// # Errors
    /// [`OperatorError`] when a ramp is impossible or a degree of freedom does not exist.
    pub fn with_loads(&self, loads: Vec<Load>) -> Result<Self, OperatorError> {
        check_loads(&loads, self.dofs())?;
        Ok(Self {
            matrices: Arc::clone(&self.matrices),
            loads: loads.into(),
            loads_revision: Revision::new(),
        })
    }

    /// These matrices with bounds that replace estimates of the largest eigenvalues of `M^-1 K` and
    /// `blockdiag(K)^-1 K`: bounds of elements stay valid after cuts, at no cost. They are not checked.
    #[must_use]
    pub fn with_element_bounds(mut self, bounds: ElementBounds) -> Self {
        let matrices = Arc::make_mut(&mut self.matrices);
        matrices.bounds = Some(bounds);
        matrices.revision = Revision::new();
        matrices.derived = Derived::default();
        self
    }

    /// Bounds used in place of estimated eigenvalues, if any.
    #[must_use]
    pub fn element_bounds(&self) -> Option<ElementBounds> {
        self.matrices.bounds
    }

    /// Lumped mass of each degree of freedom (kg).
    #[must_use]
    pub fn mass(&self) -> &[f64] {
        &self.matrices.mass
    }

    /// K (N/m).
    #[must_use]
    pub fn stiffness(&self) -> &Arc<BlockMatrix> {
        &self.matrices.stiffness
    }

    /// The damping matrix D.
    #[must_use]
    pub fn damping(&self) -> &Damping {
        &self.matrices.damping
    }

    /// D = alpha M + beta K + extra (N s/m) as one matrix, built on each call.
    #[must_use]
    pub fn damping_matrix(&self) -> BlockMatrix {
        let damping = self.damping();
        let mut whole = self.stiffness_and_dashpots(damping.stiffness, 1.0);
        let layers = whole.layers().count();
        for (cell, mass) in self.mass().chunks_exact(layers).enumerate() {
            // Every row of a pattern has its own cell.
            let blocks = whole.row_blocks_mut(cell);
            for (_, block) in blocks.filter(|(column, _)| *column == cell) {
                let diagonal = block.iter_mut().step_by(layers + 1);
                for (entry, mass) in diagonal.zip(mass) {
                    *entry += damping.mass * mass;
                }
            }
        }
        whole
    }

    /// `of_stiffness K + of_dashpots extra` as one matrix, built on each call.
    #[must_use]
    pub fn stiffness_and_dashpots(&self, of_stiffness: f64, of_dashpots: f64) -> BlockMatrix {
        let mut sum = BlockMatrix::clone(self.stiffness());
        sum.scale_rows(&vec![of_stiffness; self.dofs()]);
        if let Some(dashpots) = &self.damping().extra {
            for cell in 0..sum.pattern().cells() {
                // Both have one pattern (`LinearOperators::new`).
                let blocks = sum.row_blocks_mut(cell).zip(dashpots.row_blocks(cell));
                for ((_, block), (_, added)) in blocks {
                    for (entry, added) in block.iter_mut().zip(added) {
                        *entry += of_dashpots * added;
                    }
                }
            }
        }
        sum
    }

    /// The loads.
    #[must_use]
    pub fn loads(&self) -> &[Load] {
        &self.loads
    }

    /// The loads, and the forces from outside that act at some time from `from` to `to` (s): a step asks
    /// for those of its window, so that its cost does not grow with the record.
    pub fn loads_between<'a>(
        &'a self,
        inputs: &'a Inputs,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = &'a Load> {
        self.loads.iter().chain(inputs.forces_between(from, to))
    }

    /// Identity of these matrices; clones share it, also under other loads.
    #[must_use]
    pub fn revision(&self) -> Revision {
        self.matrices.revision
    }

    /// Identity of these loads; clones share it.
    #[must_use]
    pub fn loads_revision(&self) -> Revision {
        self.loads_revision
    }

    /// A value derived from the matrices alone, computed at the first request and shared by
    /// all clones: one value for each type.
    pub fn derived<T: Send + Sync + 'static>(&self, compute: impl FnOnce(&Self) -> T) -> Arc<T> {
        self.matrices.derived.get(|| compute(self))
    }

    /// Degrees of freedom.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.matrices.mass.len()
    }

    /// `out = F` (N) as a step takes it, or at an instant (s).
    pub fn external_force<'a>(&self, when: impl Into<LoadTime<'a>>, out: &mut [f64]) {
        let when = when.into();
        out.fill(0.0);
        let (from, to) = when.span();
        for Load { ramp, entries } in self.loads_between(when.inputs(), from, to) {
            let factor = ramp.factor(when);
            if factor != 0.0 {
                for &(dof, force) in entries {
                    if let Some(out) = out.get_mut(dof as usize) {
                        *out += factor * force;
                    }
                }
            }
        }
    }

    /// `out += F(after) - F(before)` (N) of the loads that are not smooth between two instants
    /// `from` and `to` (s); returns true if there are any.
    pub fn add_load_change(
        &self,
        [before, after]: [LoadTime<'_>; 2],
        [from, to]: [f64; 2],
        out: &mut [f64],
    ) -> bool {
        let inputs = after.inputs();
        let broken = |load: &&Load| !load.ramp.known(inputs).is_smooth_between(from, to);
        let mut any = false;
        let loads = self.loads_between(inputs, from, to);
        for Load { ramp, entries } in loads.filter(broken) {
            any = true;
            let change = ramp.factor(after) - ramp.factor(before);
            for &(dof, force) in entries {
                if let Some(out) = out.get_mut(dof as usize) {
                    *out += change * force;
                }
            }
        }
        any
    }

    /// `out -= K u + D v` (N): one sweep. Absent damping costs nothing, and stiffness-proportional damping shares the
    /// product with K.
    pub fn subtract_internal_force(&self, u: &[f64], v: &[f64], out: &mut [f64]) {
        if self.damping().stiffness == 0.0 {
            self.stiffness().subtract_product(u, out);
        } else {
            self.stiffness()
                .subtract_product_combined(u, self.damping().stiffness, v, out);
        }
        self.subtract_damping_beyond_stiffness(v, out);
    }

    /// `out -= D v` (N).
    pub fn subtract_damping(&self, v: &[f64], out: &mut [f64]) {
        if self.damping().stiffness != 0.0 {
            self.stiffness()
                .subtract_scaled_product(self.damping().stiffness, v, out);
        }
        self.subtract_damping_beyond_stiffness(v, out);
    }

    fn subtract_damping_beyond_stiffness(&self, v: &[f64], out: &mut [f64]) {
        // Products before each cell's own terms: the order in which programs add up.
        if let Some(extra) = &self.damping().extra {
            extra.subtract_product(v, out);
        }
        let alpha = self.damping().mass;
        if alpha != 0.0 {
            for ((value, mass), v) in out.iter_mut().zip(self.mass().iter()).zip(v) {
                *value -= alpha * mass * v;
            }
        }
    }

    /// `out = F - K u - D v` (N).
    pub fn net_force<'a>(
        &self,
        when: impl Into<LoadTime<'a>>,
        u: &[f64],
        v: &[f64],
        out: &mut [f64],
    ) {
        self.external_force(when, out);
        self.subtract_internal_force(u, v, out);
    }

    /// Kinetic energy and energy stored in deformation (J).
    #[must_use]
    pub fn energy(&self, u: &[f64], v: &[f64]) -> Energy {
        let mut force = vec![0.0; u.len()];
        self.stiffness().multiply(u, &mut force);
        let moving = v.iter().zip(self.mass().iter());
        Energy {
            kinetic: 0.5 * moving.map(|(v, mass)| mass * v * v).sum::<f64>(),
            elastic: 0.5 * u.iter().zip(&force).map(|(u, f)| u * f).sum::<f64>(),
        }
    }
}

fn check_loads(loads: &[Load], dofs: usize) -> Result<(), OperatorError> {
    for (load, Load { ramp, entries }) in loads.iter().enumerate() {
        ramp.check()
            .map_err(|source| OperatorError::Ramp { load, source })?;
        if let Some(&(dof, _)) = entries.iter().find(|(dof, _)| *dof as usize >= dofs) {
            return Err(OperatorError::LoadOutOfRange { load, dof, dofs });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ramp::Ramp;

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
        // As a matrix, and its block sparse rows one by one: D = .5 M + .1 K + 10 K.
        let matrix = operators.damping_matrix();
        let bsr = matrix.to_bsr();
        let expected = [1.0 + 50.5, -20.2, -20.2, 2.0 + 30.3];
        for (value, expected) in bsr.blocks.iter().zip(expected) {
            assert!((value - expected).abs() < 1e-12);
        }
        assert_eq!(
            (&bsr.indptr[..], &*bsr.indices),
            (&[0, 2, 4][..], &[0, 1, 0, 1][..])
        );
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
    fn forces_that_do_not_act_in_a_step_are_passed_over_and_change_no_bit() {
        let operators = pair(|_| Damping::default());
        let (dt, mut inputs) = (0.05, Inputs::new());
        for n in 0..60 {
            let force = f64::from(n + 1) * 0.1;
            let entries = [(0, force), (1, -0.3 * force)];
            let pause = n % 7 == 3;
            let given = if pause { &[][..] } else { &entries };
            inputs.set_forces(0.07 * f64::from(n), given).unwrap();
        }
        let all = |when: LoadTime<'_>| {
            let mut sum = [0.0; 2];
            for load in inputs.forces() {
                let factor = load.ramp.factor(when);
                if factor != 0.0 {
                    (0..2).for_each(|dof| sum[dof] += factor * load.entries[dof].1);
                }
            }
            sum
        };
        // Steps that begin on jumps, between them and a rounding beside them.
        let starts = (0..90).map(|n| 0.05 * f64::from(n));
        let jumps = (0..60).map(|n| 0.07 * f64::from(n));
        let times = starts.chain(jumps.flat_map(|t: f64| [t.next_down(), t, t.next_up(), t - dt]));
        for t in times {
            let [first, second] = LoadTime::at_both_ends(t, dt, 0.8);
            for when in [
                LoadTime::at(t),
                LoadTime::start_of(t, dt),
                LoadTime::end_of(t, dt),
                LoadTime::within(t, dt, 0.3),
                LoadTime::around(t, dt, dt),
                LoadTime::around(t, 0.0, dt),
                LoadTime::smooth_in(t + dt, t, dt),
                first,
                second,
            ] {
                let (when, mut out) = (when.under(&inputs), [0.0; 2]);
                operators.external_force(when, &mut out);
                assert_eq!(out, all(when), "{when:?}");
                let (from, to) = when.span();
                // Two steps of 0.05 s meet three forces of 0.07 s at most.
                assert!(operators.loads_between(&inputs, from, to).count() <= 3);
            }
            let [before, after] = [LoadTime::start_of(t - dt, dt), LoadTime::start_of(t, dt)]
                .map(|when| when.under(&inputs));
            let mut change = [0.0; 2];
            operators.add_load_change([before, after], [t - dt, t + dt], &mut change);
            let mut expected = [0.0; 2];
            for load in inputs.forces() {
                if !load.ramp.is_smooth_between(t - dt, t + dt) {
                    let factor = load.ramp.factor(after) - load.ramp.factor(before);
                    (0..2).for_each(|dof| expected[dof] += factor * load.entries[dof].1);
                }
            }
            assert_eq!(change, expected, "at {t} s");
        }
    }

    #[test]
    fn energy_of_a_known_state() {
        let energy = pair(|_| Damping::default()).energy(&[1.0, 2.0], &[3.0, -1.0]);
        assert_eq!(energy.kinetic, 0.5 * (2.0 * 9.0 + 4.0));
        assert_eq!(energy.elastic, 0.5 * (1.0 + 8.0));
    }
}
