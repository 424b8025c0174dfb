//! Methods whose steps support contact with tools.

/// Description of these methods; a separate list, because a frame cannot name the methods that are built on it.
pub(crate) const METHODS_WITH_CONTACT: &str = "`central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block \
     for each cell, or `cnn-energy` with kind = \"ie\"";
