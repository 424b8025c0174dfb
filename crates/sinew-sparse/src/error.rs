//! Errors of assembly.

/// Reasons for which an element cannot be assembled.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyError {
    /// An element names a cell that does not exist.
    #[error("cell {cell} does not exist: there are {cells} cells (0-based)")]
    CellOutOfRange {
        /// The cell named.
        cell: u32,
        /// Number of cells.
        cells: usize,
    },
    /// More elements than 32-bit numbers can count.
    #[error("{elements} elements: at most {} can be numbered", u32::MAX)]
    TooManyElements {
        /// Number of elements.
        elements: usize,
    },
    /// Two cells of an element are not neighbours in the pattern.
    #[error("cells {row} and {column} are not neighbours in the pattern")]
    NotNeighbours {
        /// Row cell.
        row: u32,
        /// Column cell.
        column: u32,
    },
    /// A row whose columns do not increase, or without its own cell.
    #[error("the columns of row {row} must increase, the row's own cell among them")]
    Row {
        /// Row cell.
        row: u32,
    },
    /// The element matrix has the wrong number of entries.
    #[error("the element matrix has {found} entries, expected {expected} (row-major)")]
    ElementSize {
        /// Entries given.
        found: usize,
        /// Entries needed: (cells of the element x layers) squared.
        expected: usize,
    },
}
