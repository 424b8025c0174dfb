//! Methods whose steps tools can push.

/// Description of these methods; a list of its own, since a frame cannot name the methods that are built on it.
pub(crate) const METHODS_WITH_CONTACT: &str = "`central-difference` without `patches`, `symplectic-euler`, `cnn-symplectic`, `cnn-stabilised` with one block \
     for each cell, or `cnn-energy` with kind = \"ie\"";
