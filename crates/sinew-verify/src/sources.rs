//! Sources that several subjects share.

use crate::check::Source;

/// A second implementation of elements, in Python.
pub(crate) const PROTOTYPE: Source = Source::Independent(
    "prototype of the elements in Python, which shares no code with the library; its digits as it printed them",
);

/// A second implementation of laws and methods, in Python.
pub(crate) const PROTOTYPE_OF_MOTIONS: Source = Source::Independent(
    "prototype of laws and methods in Python, which shares no code with the library; its digits as it printed them",
);

/// A second computation of rows on meshes of gmsh.
pub(crate) const SECOND: Source = Source::Independent(
    "xtask/python/elements.py, which computes these elements with SciPy and shares no code with the library",
);

/// A computation with 10-node tetrahedra.
pub(crate) const TET10: Source =
    Source::Independent("10-node tetrahedra, which share no code with the library's elements");
