//! Bounds that follow from single elements.

/// Eigenvalue bounds from single elements (Irons and Treharne 1971), valid for any body assembled from the elements:
/// also after cuts that split cells, or remove elements with their mass.
///
/// With the matrices `K_e` and `M_e` of an element, the quotient `x'K x / x'M x` is a mean of the elements' quotients,
/// and `K_e <= gamma blockdiag(K_e)` for all elements implies the same for their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementBounds {
    /// No undamped angular frequency (rad/s) is larger.
    pub omega_max: f64,
    /// gamma in `K <= gamma blockdiag(K)`.
    pub block_factor: f64,
}
