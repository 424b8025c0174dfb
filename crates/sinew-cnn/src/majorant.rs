//! A block-diagonal matrix that lies above what a large step needs.

use sinew_core::spectrum::{critical_step, largest_eigenvalue_of_pencil};
use sinew_core::{BlockMatrix, Damping, LinearOperators};

use crate::blocks::{CellBlocks, largest_eigenvalue_of_block};
use crate::damping_matrix::damping_matrix;

/// By how much a factor found by iteration, which comes from below, is raised.
const MARGIN: f64 = 1e-3;

/// Share of the critical step up to which nothing is added to M.
const FREE: f64 = 0.99;

/// How the factor gamma in `K <= gamma blockdiag(K)` is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GammaRule {
    /// The largest eigenvalue of `blockdiag(K)^-1 K` by iteration, with a margin.
    #[default]
    Power,
    /// Block Gershgorin circles: a bound that needs no iteration and is a little larger.
    Gershgorin,
}

/// How much of `dt^2/4 K` is added to M.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// `s = max(0, 1 - (.99 dt_c/dt)^2)` with dt_c = 2/omega_max: nothing below the critical step.
    #[default]
    Auto,
    /// s = 1 at every step.
    Full,
}

/// `P1 = M + dt/2 gamma_D blockdiag(D) + s dt^2/4 gamma_K blockdiag(K)`: one block per cell, above
/// `A = M + dt/2 D + s dt^2/4 K`.
#[derive(Clone, Debug)]
pub struct Majorant {
    operators: LinearOperators,
    dt: f64,
    s: f64,
    gamma_stiffness: f64,
    gamma_damping: f64,
    inverse: CellBlocks,
    floor: f64,
}

impl Majorant {
    /// For these matrices and a step of `dt` (s).
    #[must_use]
    pub fn new(operators: &LinearOperators, dt: f64, rule: GammaRule, blend: Blend) -> Self {
        let s = match blend {
            Blend::Full => 1.0,
            Blend::Auto => {
                let share = FREE * blunted(critical_step(operators)) / dt;
                (1.0 - share * share).max(0.0)
            }
        };
        let (mass, stiffness) = (operators.mass(), operators.stiffness());
        let layers = stiffness.layers();
        let empty = || CellBlocks::of_mass(layers, mass, 0.0);
        let mut of_stiffness = empty();
        of_stiffness.add_diagonal(stiffness, 1.0);
        let mut of_damping = CellBlocks::of_mass(layers, mass, operators.damping().mass);
        let Damping {
            stiffness: beta,
            extra,
            ..
        } = operators.damping();
        of_damping.add(&of_stiffness, *beta);
        if let Some(extra) = extra {
            of_damping.add_diagonal(extra, 1.0);
        }

        let gamma_stiffness = if s > 0.0 {
            gamma(rule, stiffness, &of_stiffness, |x, out| {
                stiffness.multiply(x, out);
            })
        } else {
            1.0
        };
        let proportional_to_mass = *beta == 0.0 && extra.is_none();
        let gamma_damping = if proportional_to_mass {
            1.0
        } else {
            let whole = damping_matrix(operators);
            gamma(rule, &whole, &of_damping, |x, out| whole.multiply(x, out))
        };

        let of_mass = CellBlocks::of_mass(layers, mass, 1.0);
        let mut blocks = of_mass.clone();
        blocks.add(&of_damping, dt / 2.0 * gamma_damping);
        blocks.add(&of_stiffness, s * dt * dt / 4.0 * gamma_stiffness);
        let inverse = blocks.inverse();
        Self {
            floor: blunted(smallest_ratio(&of_mass, &blocks, layers.count())),
            operators: operators.clone(),
            dt,
            s,
            gamma_stiffness,
            gamma_damping,
            inverse,
        }
    }

    /// The share s of `dt^2/4 K` that is in it.
    #[must_use]
    pub fn s(&self) -> f64 {
        self.s
    }

    /// gamma_K.
    #[must_use]
    pub fn gamma_stiffness(&self) -> f64 {
        self.gamma_stiffness
    }

    /// gamma_D.
    #[must_use]
    pub fn gamma_damping(&self) -> f64 {
        self.gamma_damping
    }

    /// The smallest eigenvalue of `P1^-1 M` over all cells, a lower bound of `P1^-1 A`.
    #[must_use]
    pub fn floor(&self) -> f64 {
        self.floor
    }

    /// Degrees of freedom.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.operators.dofs()
    }

    /// `out = P1^-1 x`.
    pub fn apply_inverse(&self, x: &[f64], out: &mut [f64]) {
        self.inverse.multiply(x, out);
    }

    /// `out -= A x` with `A = M + dt/2 D + s dt^2/4 K`: one sweep.
    pub fn subtract_target(&self, x: &[f64], out: &mut [f64]) {
        let damping = self.operators.damping();
        let of_mass = 1.0 + self.dt / 2.0 * damping.mass;
        let masses = out.iter_mut().zip(self.operators.mass());
        for ((out, mass), x) in masses.zip(x) {
            *out -= of_mass * mass * x;
        }
        let of_stiffness = self.stiffness_weight();
        self.operators
            .stiffness()
            .subtract_scaled_product(of_stiffness, x, out);
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(self.dt / 2.0, x, out);
        }
    }

    /// `out = (dt/2 D + dt^2/4 K) x`: what P must exceed.
    pub fn multiply_required(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let damping = self.operators.damping();
        let half = self.dt / 2.0;
        let stiffness = self.operators.stiffness();
        stiffness.subtract_scaled_product(-(half * half + half * damping.stiffness), x, out);
        let masses = out.iter_mut().zip(self.operators.mass());
        for ((out, mass), x) in masses.zip(x) {
            *out += half * damping.mass * mass * x;
        }
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(-half, x, out);
        }
    }

    fn stiffness_weight(&self) -> f64 {
        let half = self.dt / 2.0;
        self.s * half * half + half * self.operators.damping().stiffness
    }

    /// The row of A that belongs to a cell, as (column, entry of K's weight applied) for sweeps in
    /// order: calls `each(column, block)` with row-major blocks.
    pub(crate) fn target_row(&self, cell: usize, mut each: impl FnMut(usize, &[f64; 9])) {
        let damping = self.operators.damping();
        let layers = self.operators.stiffness().layers().count();
        let weight = self.stiffness_weight();
        let mut extra_row = damping.extra.as_ref().map(|extra| extra.row_blocks(cell));
        for (column, of_stiffness) in self.operators.stiffness().row_blocks(cell) {
            let of_extra = extra_row.as_mut().and_then(Iterator::next);
            let mut block = [0.0; 9];
            for (k, (entry, value)) in block.iter_mut().zip(of_stiffness).enumerate() {
                *entry = weight * value;
                if let Some((_, extra)) = of_extra {
                    *entry += self.dt / 2.0 * extra[k];
                }
            }
            if column == cell {
                for layer in 0..layers {
                    block[layer * (layers + 1)] += (1.0 + self.dt / 2.0 * damping.mass)
                        * self.operators.mass()[cell * layers + layer];
                }
            }
            each(column, &block);
        }
    }

    pub(crate) fn operators(&self) -> &LinearOperators {
        &self.operators
    }
}

/// Rounds a positive number down to 26 binary digits. Eigenvalues found by iteration differ in their
/// last digits with the order of nodes and the unit of length, and would let the motion differ with
/// them; where a smaller number is on the safe side those digits are given up.
fn blunted(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & !((1 << 26) - 1))
}

fn gamma(
    rule: GammaRule,
    matrix: &BlockMatrix,
    diagonal: &CellBlocks,
    multiply: impl FnMut(&[f64], &mut [f64]),
) -> f64 {
    let inverse = diagonal.inverse();
    match rule {
        GammaRule::Power => {
            let n = matrix.dofs();
            let largest =
                largest_eigenvalue_of_pencil(n, multiply, |x, out| inverse.multiply(x, out));
            // A diagonal matrix has gamma 1.
            // The margin is far larger than what blunting takes.
            blunted(largest * (1.0 + MARGIN)).max(1.0)
        }
        GammaRule::Gershgorin => gershgorin(matrix, &inverse),
    }
}

/// `max_i sum_j ||B_i^-1/2 K_ij B_j^-1/2||_2`, with the square of each norm as the largest
/// eigenvalue of `B_i^-1 K_ij B_j^-1 K_ji`, which is similar to a symmetric matrix; it is bounded
/// by its trace, so that no eigenproblem is solved.
fn gershgorin(matrix: &BlockMatrix, inverse: &CellBlocks) -> f64 {
    let n = matrix.layers().count();
    let mut largest = 1.0_f64;
    for cell in 0..matrix.pattern().cells() {
        let mut sum = 1.0;
        for (column, block) in matrix
            .row_blocks(cell)
            .filter(|(column, _)| *column != cell)
        {
            let (left, right) = (inverse.of_cell(cell), inverse.of_cell(column));
            let mut trace = 0.0;
            for i in 0..n {
                for j in 0..n {
                    for k in 0..n {
                        for l in 0..n {
                            trace += left[i * n + j]
                                * block[j * n + k]
                                * right[k * n + l]
                                * block[i * n + l];
                        }
                    }
                }
            }
            sum += trace.max(0.0).sqrt();
        }
        largest = largest.max(sum);
    }
    largest
}

/// The smallest eigenvalue of `P1^-1 M` over all cells: the inverse of the largest of `M^-1 P1`,
/// where M is a multiple of the identity on each cell or, with unequal masses, bounded by them.
fn smallest_ratio(mass: &CellBlocks, blocks: &CellBlocks, layers: usize) -> f64 {
    let cells = mass.len() / (layers * layers);
    (0..cells)
        .map(|cell| {
            let smallest_mass = (0..layers)
                .map(|layer| mass.of_cell(cell)[layer * (layers + 1)])
                .fold(f64::INFINITY, f64::min);
            smallest_mass / largest_eigenvalue_of_block(blocks.of_cell(cell))
        })
        .fold(1.0, f64::min)
}
