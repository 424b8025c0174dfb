//! Computation of a sweep, as plain coefficients.

/// A vector of [`super::Fields`] by its number.
pub type Field = u32;

/// A sweep over all positions:
///
/// `rho = f - sum of factor A x + sum of (plain + per_mass m) r`, `q = rho`, `M^-1 rho` or
/// `P^-1 rho`, and then, in order, `target <- sum of weight r + of_q q`, bounded.
///
/// Products read neighbours; everything else uses the values of one position. No vector that a product reads may be a
/// target.
#[derive(Clone, Debug)]
pub struct CellMap<T> {
    /// The forces f, if any.
    pub forces: Option<Field>,
    /// The products that are subtracted.
    pub products: Vec<Product<T>>,
    /// The position's own terms of rho.
    pub own: Vec<Own<T>>,
    /// Definition of q.
    pub quotient: Quotient,
    /// The updates.
    pub updates: Vec<Update<T>>,
}

/// `factor A source`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Product<T> {
    /// Number of A among the sweep's matrices.
    pub matrix: usize,
    /// The factor.
    pub factor: T,
    /// The vector that neighbours read.
    pub source: Field,
}

/// `(plain + per_mass m) r`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Own<T> {
    /// r.
    pub field: Field,
    /// The plain factor.
    pub plain: T,
    /// The factor of the mass.
    pub per_mass: T,
}

/// Definition of q, with the vectors that it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quotient {
    /// rho. Positions without a cell are where `live` is 0 instead of 1.
    Plain {
        /// The masses.
        mass: Field,
        /// 1 where a cell is.
        live: Field,
    },
    /// `M^-1 rho`.
    Mass {
        /// The inverse masses, 0 at positions without a cell.
        inverse: Field,
    },
    /// `P^-1 rho`, the rows of the blocks of P^-1 in as many vectors as there are layers.
    Blocks {
        /// The masses.
        mass: Field,
        /// The first row of each position; 0 at positions without a cell.
        rows: Field,
    },
}

/// `target <- sum of weight r + of_q q`, bounded.
#[derive(Clone, Debug, PartialEq)]
pub struct Update<T> {
    /// The vector that is written.
    pub target: Field,
    /// The vectors that are read, with their weights.
    pub terms: Vec<(T, Field)>,
    /// Weight of q.
    pub of_q: T,
    /// The bound.
    pub clamp: Option<Clamp<T>>,
    /// True if sizes of the result are compared with the sweep's limit.
    pub watched: bool,
}

/// A bound; values that reach it are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clamp<T> {
    /// Bounds each component to this size.
    Component(T),
    /// Bounds a position's vector, measured from another or from 0, to `factor` times the limit in layer
    /// 0 of `limits`.
    Vector {
        /// Vector from which it is measured; 0 if `None`.
        from: Option<Field>,
        /// The factor.
        factor: T,
        /// The limits.
        limits: Field,
    },
}
