//! Reasons for which a model cannot be built.

use crate::On;

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
    /// A prescribed motion, by its place in the list.
    Move(usize),
    /// The supports together.
    Supports,
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
            Self::Move(index) => write!(f, "motion {}", index + 1),
            Self::Supports => write!(f, "supports"),
            Self::Load(index) => write!(f, "load {}", index + 1),
            Self::Gravity => write!(f, "gravity"),
        }
    }
}

/// A reason for which a model cannot be built, and the part of the problem at fault.
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

    /// A conversion from causes to errors of one item, for `map_err`.
    pub(crate) fn at<E: Into<Cause>>(item: Item) -> impl FnOnce(E) -> Self {
        move |cause| Self::new(item, cause.into())
    }

    /// The part of the problem at fault.
    #[must_use]
    pub fn item(&self) -> Item {
        self.item
    }

    /// The fault.
    #[must_use]
    pub fn cause(&self) -> &Cause {
        &self.cause
    }
}

/// A fault in a part of a problem.
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
        /// The range that fits, with the unit.
        expected: &'static str,
    },
    /// An element on a network of springs.
    #[error("a network of springs has no element: expected none but p1")]
    ElementOnSprings,
    /// More families of fibres than a region may have.
    #[error("{found} families of fibres: expected at most {most}")]
    Families {
        /// Number of families.
        found: usize,
        /// The most there may be.
        most: usize,
    },
    /// A direction without length.
    #[error("{quantity} = [0, 0, 0]: expected a vector that is not 0")]
    NoDirection {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// Axes whose first two directions are parallel.
    #[error("the first two axes are parallel: expected directions that are not")]
    ParallelAxes,
    /// Axes for an isotropic law.
    #[error("the law `{law}` is alike in all directions: expected no axes")]
    NeedlessAxes {
        /// The law's id.
        law: &'static str,
    },
    /// Axes that differ between the tetrahedra of an edge on an element that averages over edges.
    #[error(
        "the axes of the law `{law}` differ from tetrahedron to tetrahedron, and the element averages over the tetrahedra of an edge: expected p1 \
         or fbar, or the same axes everywhere"
    )]
    AxesOnEdges {
        /// The law's id.
        law: &'static str,
    },
    /// Data of the mesh that cannot give a property.
    #[error("{quantity}: {error}")]
    Data {
        /// Name of the property.
        quantity: &'static str,
        /// The reason.
        error: crate::from_mesh::DataError,
    },
    /// Fibres or memory with a law that supports neither.
    #[error("fibres and memory go with laws of large deformation only, such as `neo-hookean`")]
    TissueOfSmallStrain,
    /// A term of a Prony series outside its range.
    #[error("prony: {0}")]
    Prony(crate::hyperelastic::ParameterError),
    /// A Prony series without terms, or with too many.
    #[error("prony has {found} terms: expected 1 to {most}")]
    Terms {
        /// Number of terms.
        found: usize,
        /// The most there may be.
        most: usize,
    },
    /// Long-term moduli that give no valid instantaneous ones.
    #[error(
        "so much of the deviatoric stress relaxes that Poisson's ratio would be {poissons_ratio:.3} at once, and laws of large deformation \
         have none below 0: take smaller shares, or a larger long-term ratio"
    )]
    NoModuliAtOnce {
        /// Poisson's ratio of the instantaneous moduli.
        poissons_ratio: f64,
    },
    /// Deviatoric relaxation of a law that has no isochoric part.
    #[error(
        "the law `{law}` has no isochoric part that could relax alone; `neo-hookean-iso` and `mooney-rivlin` have one"
    )]
    NoIsochoricPart {
        /// The law's id.
        law: &'static str,
    },
    /// A law of large deformation that does not exist, or whose parameters are not allowed.
    #[error(transparent)]
    Law(#[from] crate::hyperelastic::LawError),
    /// A group the mesh does not have.
    #[error(transparent)]
    Group(#[from] sinew_mesh::FindGroupError),
    /// A group of the wrong kind.
    #[error("group `{group}` has cells of dimension {dim}, expected {expected}")]
    GroupDimension {
        /// Name of the group.
        group: String,
        /// Dimension of its cells.
        dim: u8,
        /// The kind of group that fits.
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
        /// Number of such tetrahedra.
        count: usize,
        /// Element tag of the first.
        tag: u64,
    },
    /// A tetrahedron with negative volume.
    #[error(
        "tetrahedron {tag} is inverted (volume {volume:.3e} m3), {count} in all; `sinew mesh check --fix orient` turns those that only count corners the other way, and says where a mesh is tangled"
    )]
    Inverted {
        /// Element tag of the first.
        tag: u64,
        /// Its volume (m^3).
        volume: f64,
        /// Number of such tetrahedra.
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
    /// Supports that fix all components.
    #[error("no degree of freedom is free: all {nodes} nodes are fixed; free some of them")]
    NothingFree {
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// Supports other than those of the model whose pattern is to be shared.
    #[error("node {tag} has other fixed directions than in the given model; build a new model")]
    OtherSupports {
        /// Tag of the first node that is fixed in other directions.
        tag: u64,
    },
    /// A load that falls on fixed components only.
    #[error("all nodes of {} are fixed, so the load has no effect", named(on))]
    NothingLoaded {
        /// The part of the mesh it is on.
        on: On,
    },
    /// A component that is both fixed and moved.
    #[error(
        "node {tag} is already fixed in {}; a direction can be fixed or moved, not both", axis_name(*axis)
    )]
    MovedAndHeld {
        /// Tag of the first such node.
        tag: u64,
        /// The component: 0, 1, 2 for x, y, z.
        axis: usize,
    },
    /// A component that two motions prescribe.
    #[error("node {tag} is moved in {} by motion {first} already", axis_name(*axis))]
    MovedTwice {
        /// Tag of the first such node.
        tag: u64,
        /// The component: 0, 1, 2 for x, y, z.
        axis: usize,
        /// The other motion, counted from 1.
        first: usize,
    },
    /// A motion along an axis that it does not prescribe.
    #[error("{found} along {}, which is not among the axes: expected 0", axis_name(*axis))]
    UnnamedAxis {
        /// The component: 0, 1, 2 for x, y, z.
        axis: usize,
        /// The displacement along it (m).
        found: f64,
    },
    /// A position that jumps although damping acts on its velocity.
    #[error(
        "the position jumps at t = {instant} s, and stiffness damping or dashpots would see an infinite \
         velocity: let it rise over some time"
    )]
    PositionJumps {
        /// The first such instant (s).
        instant: f64,
    },
    /// A node that does not exist.
    #[error("node index {node} is out of range: the mesh has {nodes} nodes, counted from 0")]
    NodeOutOfRange {
        /// The index (0-based).
        node: u32,
        /// Nodes of the mesh.
        nodes: usize,
    },
    /// Nodes given to a load that needs triangles.
    #[error("a traction or pressure acts on triangles, but {nodes} nodes are given")]
    NoTriangles {
        /// The nodes given.
        nodes: usize,
    },
    /// A displacement of a support that is refused.
    #[error(transparent)]
    SupportMotion(#[from] crate::vector_error::SupportMotionError),
    /// A ramp with a parameter outside its range.
    #[error("ramp: {0}")]
    Ramp(#[from] sinew_core::RampError),
    /// Surface triangles that do not bound the body.
    #[error(transparent)]
    Surface(#[from] sinew_mesh::SurfaceError),
    /// Matrices that do not make a system.
    #[error(transparent)]
    Operators(#[from] sinew_core::OperatorError),
}

/// The name of a component.
pub(crate) fn axis_name(axis: usize) -> &'static str {
    ["x", "y", "z"][axis % 3]
}

fn named(on: &On) -> String {
    match on {
        On::Group(_) => format!("group {on}"),
        On::Nodes(_) | On::Triangles(_) => on.to_string(),
    }
}
