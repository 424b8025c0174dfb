//! Conversions between fields over nodes and vectors over degrees of freedom.

use super::Model;
use super::field_error::{FieldError, require_length};
use crate::error::Cause;

impl Model {
    /// Writes a vector over the degrees of freedom, such as a force (N) or the shape of a mode, to all nodes of the
    /// mesh: three components a node, zero if they are fixed or moved. Allocates nothing. See
    /// [`Model::displacements_at`] for displacements with supports in motion.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `values` has one entry for each degree of freedom and `out` one for
    /// each node of the mesh.
    pub fn to_nodes(&self, values: &[f64], out: &mut [[f64; 3]]) -> Result<(), FieldError> {
        self.require_dofs("the vector", values)?;
        self.require_nodes("the output", out)?;
        for (node, out) in (0..).zip(out) {
            *out = self.body.cells.at_node(values, node);
        }
        Ok(())
    }

    /// Writes values at all nodes of the mesh, three components a node, into a vector over the degrees
    /// of freedom. Fixed components are left out; if a node is fixed in some directions only, their
    /// entries become zero. Allocates nothing.
    ///
    /// # Errors
    /// [`FieldError::Length`] unless `values` has one entry for each node of the mesh and `out` one for
    /// each degree of freedom.
    pub fn to_dofs(&self, values: &[[f64; 3]], out: &mut [f64]) -> Result<(), FieldError> {
        self.require_nodes("the field", values)?;
        self.require_dofs("the output", out)?;
        let cells = &self.body.cells;
        let components = out.as_chunks_mut::<3>().0.iter_mut().zip(&cells.nodes);
        for ((components, node), held) in components.zip(cells.pinned.as_chunks::<3>().0) {
            for axis in 0..3 {
                let value = values[*node as usize][axis];
                components[axis] = if held[axis] { 0.0 } else { value };
            }
        }
        Ok(())
    }

    pub(super) fn require_dofs(
        &self,
        what: &'static str,
        values: &[f64],
    ) -> Result<(), FieldError> {
        require_length(what, values.len(), self.body.cells.pinned.len())
    }

    pub(super) fn require_node(&self, node: u32) -> Result<(), FieldError> {
        let nodes = self.mesh.points.len();
        if node as usize >= nodes {
            return Err(Cause::NodeOutOfRange { node, nodes }.into());
        }
        Ok(())
    }

    pub(super) fn require_nodes<T>(&self, what: &'static str, of: &[T]) -> Result<(), FieldError> {
        require_length(what, of.len(), self.mesh.points.len())
    }
}
