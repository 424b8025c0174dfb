//! Why a model could not be built.

/// The part of a problem an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// The mesh.
    Mesh,
    /// A region, by its place in the list.
    Region(usize),
    /// The damping.
    Damping,
    /// A support, by its place in the list.
    Fixed(usize),
    /// A load, by its place in the list.
    Load(usize),
    /// Gravity.
    Gravity,
}

impl std::fmt::Display for Item {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Mesh => write!(f, "mesh"),
            Self::Region(index) => write!(f, "region {}", index + 1),
            Self::Damping => write!(f, "damping"),
            Self::Fixed(index) => write!(f, "support {}", index + 1),
            Self::Load(index) => write!(f, "load {}", index + 1),
            Self::Gravity => write!(f, "gravity"),
        }
    }
}

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{item}: {cause}")]
pub struct FemError {
    item: Item,
    cause: Cause,
}

impl FemError {
    pub(crate) fn new(item: Item, cause: Cause) -> Self {
        Self { item, cause }
    }

    /// The part of the problem at fault.
    #[must_use]
    pub fn item(&self) -> Item {
        self.item
    }

    /// What is wrong with it.
    #[must_use]
    pub fn cause(&self) -> &Cause {
        &self.cause
    }
}

/// What is wrong with a part of a problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Cause {
    /// A number outside its range.
    #[error("{quantity} = {found}: expected {expected}")]
    Value {
        /// Name of the quantity.
        quantity: &'static str,
        /// Its value.
        found: f64,
        /// What fits, with the unit.
        expected: &'static str,
    },
    /// A group the mesh does not have.
    #[error(transparent)]
    UnknownGroup(#[from] sinew_mesh::UnknownGroup),
    /// A group of the wrong kind.
    #[error("group `{group}` has cells of dimension {dim}, expected {expected}")]
    GroupDimension {
        /// Name of the group.
        group: String,
        /// Dimension of its cells.
        dim: u8,
        /// What fits.
        expected: &'static str,
    },
    /// A tetrahedron in two regions.
    #[error("tetrahedron {tag} is in region {first} already; regions must not overlap")]
    RegionsOverlap {
        /// Element tag.
        tag: u64,
        /// The other region, counted from 1.
        first: usize,
    },
    /// Tetrahedra in no region.
    #[error(
        "{count} tetrahedra are in no region (first: {tag}); give a region for them, or one without a group for the whole mesh"
    )]
    NoRegion {
        /// How many.
        count: usize,
        /// Element tag of the first.
        tag: u64,
    },
    /// A tetrahedron with negative volume.
    #[error(
        "tetrahedron {tag} is inverted (volume {volume:.3e} m3); {count} in all; swap two of their nodes or repair the mesh"
    )]
    Inverted {
        /// Element tag of the first.
        tag: u64,
        /// Its volume (m^3).
        volume: f64,
        /// How many.
        count: usize,
    },
    /// A tetrahedron without volume.
    #[error(
        "tetrahedron {tag} is flat (volume {volume:.3e} m3, longest edge {edge:.3e} m); repair the mesh"
    )]
    Flat {
        /// Element tag.
        tag: u64,
        /// Its volume (m^3).
        volume: f64,
        /// Its longest edge (m).
        edge: f64,
    },
    /// Supports that hold everything.
    #[error("no degree of freedom is free: all {nodes} nodes are held")]
    NothingFree {
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// A load of which nothing acts.
    #[error("every node of group `{group}` is held there, so the load acts on nothing")]
    NothingLoaded {
        /// Name of the group.
        group: String,
    },
    /// A ramp that makes no sense.
    #[error("ramp: {0}")]
    Ramp(#[from] sinew_core::RampError),
    /// Surface triangles that do not bound the body.
    #[error(transparent)]
    Surface(#[from] sinew_mesh::SurfaceError),
    /// The matrices.
    #[error(transparent)]
    Operators(#[from] sinew_core::OperatorError),
}
