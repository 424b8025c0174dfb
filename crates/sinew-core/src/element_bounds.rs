//! Bounds that follow from single elements.

/// Bounds that follow from single elements (Irons and Treharne 1971), and so hold for whatever body the elements are put together to: also
/// after cuts that split cells, or take elements away with their mass.
///
/// With `K_e` and `M_e` those of an element: the quotient `x'K x / x'M x` is a mean of the elements' own, and `K_e <= gamma blockdiag(K_e)`
/// for all of them is the same for their sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementBounds {
    /// No undamped angular frequency (rad/s) is larger.
    pub omega_max: f64,
    /// gamma in `K <= gamma blockdiag(K)`.
    pub block_factor: f64,
}
