//! A block-diagonal upper bound of the matrix that a large step needs.

use std::sync::Arc;

use sinew_core::spectrum::{critical_step, largest_eigenvalue, largest_eigenvalue_of_pencil};
use sinew_core::{BlockMatrix, LinearOperators};

use crate::blocks::{CellBlocks, largest_eigenvalue_of_block};

/// Margin added to an eigenvalue that an iteration approaches from below.
const MARGIN: f64 = 1e-3;

/// Share of the limit up to which nothing is added to M.
const FREE: f64 = 0.99;

/// Rule by which the factor gamma in `W <= gamma blockdiag(W)` is found, W being the weighted sum of K
/// and dashpots that is added to M.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GammaRule {
    /// The largest eigenvalue of `blockdiag(W)^-1 W` by iteration, with a margin.
    #[default]
    Power,
    /// Block Gershgorin circles: a bound that needs no iteration and is a little larger.
    Gershgorin,
}

/// Share of `dt^2/4 K` that is added to M.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Blend {
    /// The smallest share that the step needs: 0 below .99 of central difference's limit.
    #[default]
    Auto,
    /// s = 1 at every step.
    Full,
}

/// Share of `dt/2 D'` that is added to M, D' being the damping other than alpha M.
///
/// The force `F - K u - D' v` is taken with the velocity half a step behind the displacement; the
/// share of `dt/2 D'` in P moves that share of the damping to the middle of the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DampingShare {
    /// The share s, as of `dt^2/4 K`. The rest lags by half a step as in central difference.
    AsStiffness,
    /// The whole damping, at every step.
    Whole,
}

/// `P1 = M' + gamma blockdiag(W)`: one block per cell, an upper bound of `A = M' + W`, where `M' = (1 + alpha dt/2) M`
/// and W is the part of `G = dt/2 D' + dt^2/4 K` that is added, D' being the damping other than alpha M.
///
/// A step needs `P > dt/2 alpha M + G`. With mu the largest eigenvalue of `M^-1 G`, M' alone
/// suffices up to mu = 1, the limit of central difference; P1 is then M'. Beyond,
///
/// * [`DampingShare::AsStiffness`]: `W = s G`, `s = 1 - .99^2/mu`, since `(1 - s) G <= .99^2 M`;
/// * [`DampingShare::Whole`]: `W = dt/2 D' + s dt^2/4 K` with mu of `M^-1 dt^2/4 K` alone, which is
///   `(dt omega_max/2)^2`.
#[derive(Clone, Debug)]
pub struct Majorant {
    operators: LinearOperators,
    dt: f64,
    s: f64,
    damping_share: f64,
    mass_suffices: bool,
    gamma: f64,
    /// `gamma blockdiag(W)`; empty if M' suffices.
    added: CellBlocks,
    inverse: Arc<CellBlocks>,
    floor: f64,
}

impl Majorant {
    /// The majorant for these matrices and a step of `dt` (s).
    #[must_use]
    pub fn new(
        operators: &LinearOperators,
        dt: f64,
        rule: GammaRule,
        blend: Blend,
        damping: DampingShare,
    ) -> Self {
        let (s, mass_suffices) = match blend {
            Blend::Full => (1.0, false),
            Blend::Auto => {
                let undamped = critical_step(operators);
                let needed = share_beyond(with_damping(operators, undamped, dt), dt);
                match damping {
                    DampingShare::AsStiffness => (needed, needed == 0.0),
                    DampingShare::Whole => (share_beyond(undamped, dt), needed == 0.0),
                }
            }
        };
        let damping_share = match damping {
            DampingShare::AsStiffness => s,
            DampingShare::Whole => 1.0,
        };
        let (mass, layers) = (operators.mass(), operators.stiffness().layers());
        let mut blocks = CellBlocks::of_mass(layers, mass, 1.0);
        let mass_damping = CellBlocks::of_mass(layers, mass, operators.damping().mass);
        blocks.add(&mass_damping, dt / 2.0);
        let mut majorant = Self {
            operators: operators.clone(),
            dt,
            s,
            damping_share,
            mass_suffices,
            gamma: 0.0,
            added: CellBlocks::default(),
            inverse: Arc::default(),
            floor: 1.0,
        };
        if !mass_suffices {
            let (gamma, added) = majorant.majorant_of_w(rule);
            blocks.add(&added, 1.0);
            (majorant.gamma, majorant.added) = (gamma, added);
        }
        majorant.inverse = Arc::new(blocks.inverse());
        majorant.floor = blunted(smallest_ratio(mass, &blocks, layers.count()));
        majorant
    }

    /// Finds gamma and `gamma blockdiag(W)`.
    fn majorant_of_w(&self, rule: GammaRule) -> (f64, CellBlocks) {
        let operators = &self.operators;
        let of_stiffness = self.stiffness_weight();
        let sum;
        // Without dashpots W is a multiple of K, and gamma that of K to the last digit.
        let (matrix, weight) = if operators.damping().extra.is_none() {
            (operators.stiffness().as_ref(), of_stiffness)
        } else {
            sum = operators.stiffness_and_dashpots(of_stiffness, self.dashpot_weight());
            (&sum, 1.0)
        };
        let mut diagonal = CellBlocks::of_mass(matrix.layers(), operators.mass(), 0.0);
        diagonal.add_diagonal(matrix, 1.0);
        let gamma = match rule {
            GammaRule::Power if operators.damping().extra.is_none() => {
                let found = |_: &LinearOperators| GammaOfStiffness(gamma(rule, matrix, &diagonal));
                match operators.element_bounds() {
                    Some(bounds) => bounds.block_factor,
                    None => operators.derived(found).0,
                }
            }
            _ => gamma(rule, matrix, &diagonal),
        };
        let mut added = CellBlocks::of_mass(matrix.layers(), operators.mass(), 0.0);
        added.add(&diagonal, weight * gamma);
        (gamma, added)
    }

    /// The share s of `dt^2/4 K` that is in it.
    #[must_use]
    pub fn s(&self) -> f64 {
        self.s
    }

    /// The share of `dt/2 D'` that is in it, D' being the damping other than alpha M.
    #[must_use]
    pub fn damping_share(&self) -> f64 {
        self.damping_share
    }

    /// The factor gamma in `W <= gamma blockdiag(W)`; 0 if M' suffices.
    #[must_use]
    pub fn gamma(&self) -> f64 {
        self.gamma
    }

    /// True if the step is below .99 of central difference's limit, so that P1 is M'.
    #[must_use]
    pub fn mass_suffices(&self) -> bool {
        self.mass_suffices
    }

    /// True if W is 0: the step is then central difference's.
    #[must_use]
    pub fn adds_nothing(&self) -> bool {
        self.stiffness_weight() == 0.0 && self.dashpot_weight() == 0.0
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

    /// P1^-1.
    #[must_use]
    pub fn inverse(&self) -> &Arc<CellBlocks> {
        &self.inverse
    }

    /// `gamma blockdiag(W)`; empty if M' suffices.
    #[must_use]
    pub(crate) fn added(&self) -> &CellBlocks {
        &self.added
    }

    /// M' of a degree of freedom (kg).
    pub(crate) fn inertia(&self, dof: usize) -> f64 {
        (1.0 + self.dt / 2.0 * self.operators.damping().mass) * self.operators.mass()[dof]
    }

    /// `out = W x`: one sweep.
    pub(crate) fn multiply_added(&self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        let stiffness = self.operators.stiffness();
        stiffness.subtract_scaled_product(-self.stiffness_weight(), x, out);
        if let Some(extra) = &self.operators.damping().extra {
            extra.subtract_scaled_product(-self.dashpot_weight(), x, out);
        }
    }

    /// A as weights of the mass, of K and of the dashpots, if any.
    pub(crate) fn weights_of_target(&self) -> (f64, f64, Option<f64>) {
        let damping = self.operators.damping();
        (
            1.0 + self.dt / 2.0 * damping.mass,
            self.stiffness_weight(),
            damping.extra.as_ref().map(|_| self.dashpot_weight()),
        )
    }

    /// `out -= A x`: one sweep.
    pub(crate) fn subtract_target(&self, x: &[f64], out: &mut [f64]) {
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
            extra.subtract_scaled_product(self.dashpot_weight(), x, out);
        }
    }

    /// `out = (dt/2 D + dt^2/4 K) x`: the matrix below P.
    pub(crate) fn multiply_required(&self, x: &[f64], out: &mut [f64]) {
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

    /// The factor of K in W.
    fn stiffness_weight(&self) -> f64 {
        let half = self.dt / 2.0;
        self.s * half * half + self.damping_share * half * self.operators.damping().stiffness
    }

    /// The factor of the dashpots in W.
    fn dashpot_weight(&self) -> f64 {
        match self.operators.damping().extra {
            Some(_) => self.damping_share * self.dt / 2.0,
            None => 0.0,
        }
    }

    /// The row of A that belongs to a cell, as (column, entry of K's weight applied) for sweeps in
    /// order: calls `each(column, block)` with row-major blocks.
    pub(crate) fn target_row(&self, cell: usize, mut each: impl FnMut(usize, &[f64; 9])) {
        let damping = self.operators.damping();
        let layers = self.operators.stiffness().layers().count();
        let (weight, of_dashpots) = (self.stiffness_weight(), self.dashpot_weight());
        let mut extra_row = damping.extra.as_ref().map(|extra| extra.row_blocks(cell));
        for (column, of_stiffness) in self.operators.stiffness().row_blocks(cell) {
            let of_extra = extra_row.as_mut().and_then(Iterator::next);
            let mut block = [0.0; 9];
            for (k, (entry, value)) in block.iter_mut().zip(of_stiffness).enumerate() {
                *entry = weight * value;
                if let Some((_, extra)) = of_extra {
                    *entry += of_dashpots * extra[k];
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

/// Rounds a positive number down to 26 binary digits. Eigenvalues found by iteration differ in their last digits with
/// the order of nodes and the unit of length, and would make the motion depend on these; if a smaller number is on the
/// safe side, those digits are discarded.
fn blunted(value: f64) -> f64 {
    f64::from_bits(value.to_bits() & !((1 << 26) - 1))
}

/// `max(0, 1 - (.99 limit/dt)^2)`.
fn share_beyond(limit: f64, dt: f64) -> f64 {
    let share = FREE * blunted(limit) / dt;
    (1.0 - share * share).max(0.0)
}

/// `dt/sqrt mu`, mu being the largest eigenvalue of `M^-1 (dt/2 D' + dt^2/4 K)`, where `undamped` is
/// 2/omega_max.
fn with_damping(operators: &LinearOperators, undamped: f64, dt: f64) -> f64 {
    let damping = operators.damping();
    // dt^2/4 (of_stiffness K + 2/dt extra).
    let of_stiffness = 1.0 + 2.0 * damping.stiffness / dt;
    if damping.extra.is_none() {
        return undamped / of_stiffness.sqrt();
    }
    let sum = operators.stiffness_and_dashpots(of_stiffness, 2.0 / dt);
    let largest = largest_eigenvalue(operators.mass(), |x, out| sum.multiply(x, out));
    2.0 / largest.max(0.0).sqrt()
}

/// Gamma of K by iteration, which does not depend on the step.
struct GammaOfStiffness(f64);

fn gamma(rule: GammaRule, matrix: &BlockMatrix, diagonal: &CellBlocks) -> f64 {
    let inverse = diagonal.inverse();
    match rule {
        GammaRule::Power => {
            let n = matrix.dofs();
            let largest = largest_eigenvalue_of_pencil(
                n,
                |x, out| matrix.multiply(x, out),
                |x, out| inverse.multiply(x, out),
            );
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

/// The smallest eigenvalue of `P1^-1 M` over all cells: the inverse of the largest of
/// `M^-1/2 P1 M^-1/2`.
fn smallest_ratio(mass: &[f64], blocks: &CellBlocks, layers: usize) -> f64 {
    let of_cell = |(cell, mass): (usize, &[f64])| {
        let mut scaled = [0.0; 9];
        let entries = blocks.of_cell(cell);
        let scaled = &mut scaled[..entries.len()];
        for (index, (scaled, entry)) in scaled.iter_mut().zip(entries).enumerate() {
            let (row, column) = (index / layers, index % layers);
            *scaled = entry / (mass[row] * mass[column]).sqrt();
        }
        1.0 / largest_eigenvalue_of_block(scaled)
    };
    let cells = mass.chunks_exact(layers).enumerate();
    cells.map(of_cell).fold(1.0, f64::min)
}
