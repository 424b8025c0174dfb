//! Values in tetrahedra.

/// Values in tetrahedra, from one view of the file (`$ElementData`).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TetData {
    /// Name of the view.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Values per tetrahedron.
    pub components: usize,
    /// `components` values for each tetrahedron in turn; NaN if the file gives none.
    pub values: Vec<f64>,
}

impl TetData {
    /// The values of each tetrahedron in turn.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> + Clone {
        self.values.chunks_exact(self.components.max(1))
    }

    /// True if some tetrahedron has values.
    pub(super) fn has_any(&self) -> bool {
        self.values.iter().any(|value| !value.is_nan())
    }

    /// Takes values from data of the same name, step and width for tetrahedra without a value. Returns false, and changes
    /// nothing, for other data or if some tetrahedron has both values.
    pub(super) fn complete_with(&mut self, other: &TetData) -> bool {
        let names = (&self.name, self.step, self.components);
        let is_part = names == (&other.name, other.step, other.components);
        let has_both = |(own, other): (&f64, &f64)| !own.is_nan() && !other.is_nan();
        if !is_part || self.values.iter().zip(&other.values).any(has_both) {
            return false;
        }
        for (own, other) in self.values.iter_mut().zip(&other.values) {
            if own.is_nan() {
                *own = *other;
            }
        }
        true
    }

    /// The same data with each tetrahedron replaced by its eight parts.
    pub(super) fn refined(&self) -> TetData {
        let parts = self.rows().flat_map(|row| [row; 8]).flatten();
        TetData {
            values: parts.copied().collect(),
            name: self.name.clone(),
            ..*self
        }
    }
}
