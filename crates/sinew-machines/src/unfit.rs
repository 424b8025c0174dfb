//! Reasons why settings do not fit a system.

/// Reasons why a machine with the given settings cannot run a system.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unfit {
    /// Templates were requested although rows do not repeat.
    #[error(
        "machine = \"repeated\" needs equal rows on a lattice, and this body has none; take \"auto\" or \"general\""
    )]
    NoTemplates,
    /// Kernels were requested although forces follow from a law.
    #[error(
        "machine = {0:?} runs matrices alone, and the forces of this system follow from a law; take \"auto\""
    )]
    Law(&'static str),
    /// Single precision was requested although forces follow from a law without kernels.
    #[error(
        "precision = \"f32\" is for matrices, and for hyperelastic bodies without stiffness damping and memory on any machine but the \
         reference; leave `precision` out"
    )]
    LawInSinglePrecision,
    /// A precision that the machine does not compute in.
    #[error("machine = {machine:?} does not compute in {precision}")]
    Precision {
        /// Id of the machine.
        machine: &'static str,
        /// Id of the precision.
        precision: &'static str,
    },
    /// The reason of a machine that a program added.
    #[error("{0}")]
    Other(String),
}
