//! Parts of a mesh chosen by position or by the values of data, for meshes that lack a group.

mod condition;
mod data;
mod data_values;
mod error;
mod members;

pub use condition::Condition;
pub use data_values::DataValues;
pub use error::SelectionError;

use std::fmt;

/// Conditions on the nodes of a mesh, all of which must be met. A triangle or tetrahedron is selected if all its
/// nodes are. Conditions on data of tetrahedra are met by tetrahedra themselves, by their triangles of the boundary
/// and by their nodes.
///
/// Bounds include nodes on them, up to rounding: they are moved outward by 1e-9 of the longest edge of the mesh's
/// bounding box.
///
/// ```
/// use sinew_mesh::structured::{self, Split};
/// use sinew_mesh::{Condition, Selection};
///
/// let cube = structured::cube(4, 0.1, Split::Kuhn)?;
/// let floor = Selection::new(vec![Condition::facing([0.0, 0.0, -1.0], 10.0)]);
/// assert_eq!(floor.to_string(), "facing (0, 0, -1) within 10 degrees");
/// assert_eq!(floor.nodes(&cube)?.len(), 25);
/// assert_eq!(floor.triangles(&cube)?.len(), 32);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    conditions: Vec<Condition>,
}

impl Selection {
    /// The selection of all parts that meet all conditions; without conditions, of the whole mesh.
    #[must_use]
    pub fn new(conditions: Vec<Condition>) -> Self {
        Self { conditions }
    }

    /// The conditions.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }
}

impl fmt::Display for Selection {
    /// Description of the conditions; two selections with the same description are equal.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, condition) in self.conditions.iter().enumerate() {
            if index > 0 {
                f.write_str(" and ")?;
            }
            write!(f, "{condition}")?;
        }
        Ok(())
    }
}
