//! Names of the mesh's data that give properties of materials for each tetrahedron.

use sinew_mesh::TetDataError;

/// The names of the mesh's data ([`sinew_mesh::TetMesh::data`]) that give properties of a region for each of its tetrahedra.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FromMesh {
    /// Factor of Young's modulus of the law: with 1 Pa there, the data are moduli (Pa).
    pub youngs_modulus: Option<String>,
    /// Factor of the density: with 1 kg/m^3 there, the data are densities.
    pub density: Option<String>,
}

impl FromMesh {
    /// True if the region takes nothing from the mesh.
    #[must_use]
    pub(crate) fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Data that cannot give a property.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataError {
    /// Data that the mesh does not have exactly once.
    #[error(transparent)]
    Name(#[from] TetDataError),
    /// Another number of values for each tetrahedron than the property has.
    #[error(
        "data \"{name}\" are {} for each tetrahedron: expected {}",
        numbers(*found), numbers(*expected)
    )]
    Components {
        /// Name of the data.
        name: String,
        /// Their values for each tetrahedron.
        found: usize,
        /// Values of the property for each tetrahedron.
        expected: usize,
    },
    /// Tetrahedra without a value.
    #[error("data \"{name}\" have no value for {count} of the region's tetrahedra (first: {tag})")]
    NoValue {
        /// Name of the data.
        name: String,
        /// Number of such tetrahedra.
        count: usize,
        /// Element tag of the first.
        tag: u64,
    },
    /// A value outside its range.
    #[error("data \"{name}\" are {found} in tetrahedron {tag}: expected {expected}")]
    Value {
        /// Name of the data.
        name: String,
        /// Element tag.
        tag: u64,
        /// The value.
        found: f64,
        /// The values that fit.
        expected: &'static str,
    },
    /// Axes whose first two directions are parallel.
    #[error(
        "the first two axes are {:?} and {:?} in tetrahedron {tag}: expected directions that are not parallel",
        found[0], found[1]
    )]
    Parallel {
        /// Element tag.
        tag: u64,
        /// Unit vectors.
        found: [[f64; 3]; 2],
    },
    /// A direction without length, or that is not finite.
    #[error(
        "data \"{name}\" are {found:?} in tetrahedron {tag}: expected a finite vector that is not 0"
    )]
    Direction {
        /// Name of the data.
        name: String,
        /// Element tag.
        tag: u64,
        /// The vector.
        found: [f64; 3],
    },
}

fn numbers(count: usize) -> String {
    match count {
        1 => "a number".to_owned(),
        _ => format!("{count} numbers"),
    }
}
