//! Result of a reproduction.

use super::claims::Claim;
use super::figures::Figure;

/// Figures and claims.
#[derive(Clone, Debug, PartialEq)]
pub struct Reproduction {
    /// The figures, in the paper's order.
    pub figures: Vec<Figure>,
    /// The claims, in the paper's order.
    pub claims: Vec<Claim>,
}
