//! Implicit methods in dense arithmetic, by other formulas than those tested.

use nalgebra::{DMatrix, DVector};
use sinew_core::{LinearSystem, LoadTime, State, System};
use sinew_fem::Model;

use sinew_testkit::dense::{dense, dense_damping};

/// Steps that are compared.
pub(crate) const STEPS: u32 = 20;

fn state(u: &DVector<f64>, v: &DVector<f64>) -> State {
    State::new(u.as_slice().to_vec(), v.as_slice().to_vec())
}

/// M, D and K in full, and the load.
pub(crate) struct Dense {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    model: Model,
}

impl Dense {
    pub(crate) fn of(model: &Model) -> Self {
        let matrix = |rows: Vec<Vec<f64>>| {
            let n = rows.len();
            DMatrix::from_row_iterator(n, n, rows.into_iter().flatten())
        };
        let operators = model.operators();
        Self {
            mass: DMatrix::from_diagonal(&DVector::from_row_slice(operators.mass())),
            damping: matrix(dense_damping(operators)),
            stiffness: matrix(dense(operators.stiffness())),
            model: model.clone(),
        }
    }

    fn force(&self, t: f64) -> DVector<f64> {
        let mut force = vec![0.0; self.model.dofs()];
        self.model
            .operators()
            .external_force(LoadTime::at(t), &mut force);
        DVector::from_vec(force)
    }

    /// The states after each step of Newmark's method for beta = 1/4 and gamma = 1/2, the
    /// displacement being the unknown (Bathe, Finite Element Procedures, section 9.2.4).
    pub(crate) fn newmark(&self, start: &State, dt: f64) -> Vec<State> {
        let Self {
            mass,
            damping,
            stiffness,
            ..
        } = self;
        let mut u = DVector::from_row_slice(&start.u);
        let mut v = DVector::from_row_slice(&start.v);
        let rest = self.force(0.0) - damping * &v - stiffness * &u;
        let mut a = mass.clone().lu().solve(&rest).unwrap();
        let effective = stiffness + mass * (4.0 / (dt * dt)) + damping * (2.0 / dt);
        let effective = effective.lu();
        let mut step = |t| {
            let load = self.force(t)
                + mass * (&u * (4.0 / (dt * dt)) + &v * (4.0 / dt) + &a)
                + damping * (&u * (2.0 / dt) + &v);
            let next = effective.solve(&load).unwrap();
            let new_a = (&next - &u) * (4.0 / (dt * dt)) - &v * (4.0 / dt) - &a;
            v += (&a + &new_a) * (dt / 2.0);
            (u, a) = (next, new_a);
            state(&u, &v)
        };
        (1..=STEPS).map(|n| step(f64::from(n) * dt)).collect()
    }

    /// The states after each step of backward Euler as one system for the new velocity.
    pub(crate) fn implicit_euler(&self, start: &State, dt: f64) -> Vec<State> {
        let mut u = DVector::from_row_slice(&start.u);
        let mut v = DVector::from_row_slice(&start.v);
        let matrix = &self.mass + &self.damping * dt + &self.stiffness * (dt * dt);
        let matrix = matrix.lu();
        let mut step = |t| {
            let load = &self.mass * &v + (self.force(t) - &self.stiffness * &u) * dt;
            v = matrix.solve(&load).unwrap();
            u += &v * dt;
            state(&u, &v)
        };
        (1..=STEPS).map(|n| step(f64::from(n) * dt)).collect()
    }
}
