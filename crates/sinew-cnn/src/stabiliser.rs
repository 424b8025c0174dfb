//! The matrix P that takes the place of M, and its inverse by sweeps of the network.

use sinew_core::LinearOperators;
use sinew_core::spectrum::largest_eigenvalue_of_pencil;

use crate::blocks::CellBlocks;
use crate::majorant::{Blend, DampingShare, GammaRule, Majorant};

/// How P is built from a [`Majorant`] P1 and its A. All start cold: truncated iterations that start
/// from the last step's result are not a fixed P, and blow up.
///
/// One iteration leaves no room for the whole damping, which would add `gamma blockdiag` of it to the
/// inertia: it takes [`DampingShare::AsStiffness`]. More iterations take [`DampingShare::Whole`], so
/// that damping is centred in time.
///
/// Where M' suffices ([`Majorant::mass_suffices`]) every kind is the Neumann series about M' with as
/// many products: `P = A (I - (I - M'^-1 A)^p)^-1`. With `X = M'^-1 dt/2 D' < I` each mode of X has
/// `P = M' (1 + X)/(1 - (-X)^p) >= M'`, and is off from A by X^p where lagging damping is off by X;
/// iterations about blocks would move the slowest modes by more than that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Inner {
    /// P = P1: one block per cell, no sweep beside the step's own.
    #[default]
    Block,
    /// Block Jacobi iterations; the first needs no sweep.
    Jacobi {
        /// Iterations, at least 1.
        sweeps: u32,
    },
    /// Chebyshev iterations; the first needs no sweep.
    Chebyshev {
        /// Iterations, at least 1.
        sweeps: u32,
    },
    /// Symmetric block Gauss-Seidel iterations, in the order of the nodes: in steps far beyond the
    /// critical one the motion depends on how nodes are numbered.
    GaussSeidel {
        /// Iterations, at least 1.
        sweeps: u32,
    },
}

impl Inner {
    /// The share of the damping that is in A.
    #[must_use]
    pub fn damping_share(self) -> DampingShare {
        match self {
            Self::Block | Self::Jacobi { sweeps: 1 } | Self::Chebyshev { sweeps: 1 } => {
                DampingShare::AsStiffness
            }
            Self::Jacobi { .. } | Self::Chebyshev { .. } | Self::GaussSeidel { .. } => {
                DampingShare::Whole
            }
        }
    }

    /// Sweeps of the network that one solution takes.
    #[must_use]
    pub fn sweeps(self) -> u64 {
        match self {
            Self::Block => 0,
            Self::Jacobi { sweeps } | Self::Chebyshev { sweeps } => u64::from(sweeps) - 1,
            // Each goes once forward over the lower half and once back over the upper, and all but
            // the first need the residual.
            Self::GaussSeidel { sweeps } => 2 * u64::from(sweeps) - 1,
        }
    }
}

/// A symmetric positive definite P, above A or above M' where M' suffices, and its inverse.
///
/// With `P > dt/2 D + dt^2/4 K` the leapfrog step `P (v+ - v-) = dt (F - K u - D v-)`, `u += dt v+`
/// never gains energy, whatever the step (see [`Stabiliser::certificate`]).
#[derive(Clone, Debug)]
pub struct Stabiliser {
    majorant: Majorant,
    inner: Inner,
    /// Inverse diagonal blocks of A, for Gauss-Seidel.
    pivots: Option<CellBlocks>,
    residual: Vec<f64>,
    correction: Vec<f64>,
    direction: Vec<f64>,
}

impl Stabiliser {
    /// For these matrices and a step of `dt` (s).
    #[must_use]
    pub fn new(
        operators: &LinearOperators,
        dt: f64,
        rule: GammaRule,
        blend: Blend,
        inner: Inner,
    ) -> Self {
        let majorant = Majorant::new(operators, dt, rule, blend, inner.damping_share());
        let n = operators.dofs();
        let pivots = matches!(inner, Inner::GaussSeidel { .. }).then(|| {
            let layers = operators.stiffness().layers();
            let mut diagonal = CellBlocks::of_mass(layers, operators.mass(), 0.0);
            for cell in 0..operators.stiffness().pattern().cells() {
                majorant.target_row(cell, |column, block| {
                    if column == cell {
                        diagonal.set(cell, block);
                    }
                });
            }
            diagonal.inverse()
        });
        Self {
            majorant,
            inner,
            pivots,
            residual: vec![0.0; n],
            correction: vec![0.0; n],
            direction: vec![0.0; n],
        }
    }

    /// The block majorant behind it.
    #[must_use]
    pub fn majorant(&self) -> &Majorant {
        &self.majorant
    }

    /// `out = P^-1 r`. Allocates nothing.
    pub fn solve(&mut self, r: &[f64], out: &mut [f64]) {
        if self.majorant.mass_suffices() {
            return self.jacobi(r, out, self.inner.sweeps() + 1);
        }
        match self.inner {
            Inner::Block => self.majorant.apply_inverse(r, out),
            Inner::Jacobi { sweeps } => self.jacobi(r, out, u64::from(sweeps)),
            Inner::Chebyshev { sweeps } => self.chebyshev(r, out, sweeps),
            Inner::GaussSeidel { sweeps } => self.gauss_seidel(r, out, sweeps),
        }
    }

    /// The largest eigenvalue of `P^-1 (dt/2 D + dt^2/4 K)`. Below 1 it proves that no motion of
    /// this system gains energy at this step: with u the mean of two displacements,
    /// `E = v'(P - dt/2 D - dt^2/4 K) v/2 + u' K u/2` falls by `dt v' D v` in each step.
    #[must_use]
    pub fn certificate(&self) -> f64 {
        let (majorant, mut solver) = (&self.majorant, self.clone());
        largest_eigenvalue_of_pencil(
            majorant.dofs(),
            |x, out| majorant.multiply_required(x, out),
            |x, out| solver.solve(x, out),
        )
    }

    /// `P_p = A (I - (I - P1^-1 A)^p)^-1`, above A for every p where P1 is above A.
    fn jacobi(&mut self, r: &[f64], out: &mut [f64], sweeps: u64) {
        self.majorant.apply_inverse(r, out);
        for _ in 1..sweeps {
            self.residual.copy_from_slice(r);
            self.majorant.subtract_target(out, &mut self.residual);
            self.majorant
                .apply_inverse(&self.residual, &mut self.correction);
            for (out, correction) in out.iter_mut().zip(&self.correction) {
                *out += correction;
            }
        }
    }

    /// Chebyshev iteration (Saad, Iterative Methods for Sparse Linear Systems, algorithm 12.1) on
    /// [floor, 1], which holds the spectrum of `P1^-1 A`. The residual polynomial is at most
    /// `eps = 1/T_p((1 + a)/(1 - a))`; dividing by 1 + eps keeps P above A.
    fn chebyshev(&mut self, r: &[f64], out: &mut [f64], sweeps: u32) {
        let a = self.majorant.floor();
        let (centre, radius) = ((1.0 + a) / 2.0, (1.0 - a) / 2.0);
        if radius <= f64::EPSILON {
            return self.majorant.apply_inverse(r, out);
        }
        let sigma = centre / radius;
        let mut rho = 1.0 / sigma;
        self.majorant.apply_inverse(r, &mut self.direction);
        for (out, direction) in out.iter_mut().zip(&mut self.direction) {
            *direction /= centre;
            *out = *direction;
        }
        for _ in 1..sweeps {
            self.residual.copy_from_slice(r);
            self.majorant.subtract_target(out, &mut self.residual);
            self.majorant
                .apply_inverse(&self.residual, &mut self.correction);
            let next = 1.0 / (2.0 * sigma - rho);
            let (keep, add) = (next * rho, 2.0 * next / radius);
            let updates = out.iter_mut().zip(&mut self.direction);
            for ((out, direction), correction) in updates.zip(&self.correction) {
                *direction = keep * *direction + add * correction;
                *out += *direction;
            }
            rho = next;
        }
        let epsilon = 1.0 / (f64::from(sweeps) * sigma.acosh()).cosh();
        for out in out {
            *out /= 1.0 + epsilon;
        }
    }

    /// `P = (D + L) D^-1 (D + L')` of `A = L + D + L'`, which is `A + L D^-1 L'`, repeated.
    fn gauss_seidel(&mut self, r: &[f64], out: &mut [f64], sweeps: u32) {
        let Some(pivots) = &self.pivots else {
            return self.majorant.apply_inverse(r, out);
        };
        out.fill(0.0);
        for sweep in 0..sweeps {
            self.residual.copy_from_slice(r);
            if sweep > 0 {
                self.majorant.subtract_target(out, &mut self.residual);
            }
            symmetric_sweep(&self.majorant, pivots, &self.residual, &mut self.correction);
            for (out, correction) in out.iter_mut().zip(&self.correction) {
                *out += correction;
            }
        }
    }
}

/// `x = (D + L')^-1 D (D + L)^-1 r`.
fn symmetric_sweep(majorant: &Majorant, pivots: &CellBlocks, r: &[f64], x: &mut [f64]) {
    let layers = majorant.operators().stiffness().layers().count();
    let cells = majorant.operators().stiffness().pattern().cells();
    x.fill(0.0);
    // Forward with what stands left of the diagonal; x holds (D + L)^-1 r afterwards. Back with
    // what stands right of it: x_i -= D_ii^-1 sum_j>i A_ij x_j.
    for forward in [true, false] {
        for step in 0..cells {
            let cell = if forward { step } else { cells - 1 - step };
            let at = cell * layers;
            let mut sum = [0.0; 3];
            if forward {
                sum[..layers].copy_from_slice(&r[at..at + layers]);
            }
            majorant.target_row(cell, |column, block| {
                let wanted = if forward {
                    column < cell
                } else {
                    column > cell
                };
                if wanted {
                    for i in 0..layers {
                        for j in 0..layers {
                            sum[i] -= block[i * layers + j] * x[column * layers + j];
                        }
                    }
                }
            });
            let pivot = pivots.of_cell(cell);
            for i in 0..layers {
                for j in 0..layers {
                    x[at + i] += pivot[i * layers + j] * sum[j];
                }
            }
        }
    }
}
