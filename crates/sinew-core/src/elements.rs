//! Elements from which a stiffness matrix is assembled.

use crate::lanczos::largest_eigenvalue;

/// A stiffness matrix as a sum of small matrices, one for each element.
pub trait Elements: Send + Sync {
    /// Number of elements.
    fn count(&self) -> usize;

    /// Name of an element (0-based) in the user's terms, for messages.
    fn name(&self, element: usize) -> String;

    /// Writes the contribution of an element (0-based) to K. The sum over all elements is K.
    fn stiffness(&self, element: usize, out: &mut ElementStiffness);
}

/// Contribution of one element to K.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElementStiffness {
    /// The cells it couples.
    pub cells: Vec<u32>,
    /// Its entries (N/m), row-major and cell-major, with all layers of its cells in rows and columns.
    pub matrix: Vec<f64>,
}

impl ElementStiffness {
    /// Rows of the matrix.
    fn rows(&self) -> usize {
        self.matrix.len().isqrt()
    }

    /// The degree of freedom of the whole system that a row represents.
    fn dof(&self, row: usize) -> usize {
        let layers = self.rows() / self.cells.len().max(1);
        self.cells[row / layers] as usize * layers + row % layers
    }

    /// `out += factor K_e x`, both of the whole system.
    pub fn add_product(&self, factor: f64, x: &[f64], out: &mut [f64]) {
        let rows = self.rows();
        for (row, entries) in self.matrix.chunks_exact(rows.max(1)).enumerate() {
            let columns = entries.iter().enumerate();
            let sum: f64 = columns.map(|(column, k)| k * x[self.dof(column)]).sum();
            out[self.dof(row)] += factor * sum;
        }
    }

    /// The square (1/s^2) of the largest frequency at which the element alone would vibrate with the masses of its
    /// cells: never above omega_max^2 of the whole.
    #[must_use]
    pub fn omega_squared(&self, mass: &[f64]) -> f64 {
        let rows = self.rows();
        let own: Vec<f64> = (0..rows).map(|row| mass[self.dof(row)]).collect();
        largest_eigenvalue(&own, |x, out| {
            for (out, entries) in out.iter_mut().zip(self.matrix.chunks_exact(rows)) {
                *out = entries.iter().zip(x).map(|(k, x)| k * x).sum();
            }
        })
    }
}

impl ElementStiffness {
    /// An upper bound (1/s^2) of [`ElementStiffness::omega_squared`] for far less work: the Frobenius norm of
    /// `M^-1/2 K_e M^-1/2`. `inverse_mass` (1/kg) is the diagonal of `M^-1` of the whole system.
    #[must_use]
    pub fn omega_squared_bound(&self, inverse_mass: &[f64]) -> f64 {
        let rows = self.rows();
        let layers = rows / self.cells.len().max(1);
        let of_cell = |cell: &u32| {
            let first = *cell as usize * layers;
            &inverse_mass[first..first + layers]
        };
        let of_rows = self.cells.iter().flat_map(of_cell);
        let entries = self.matrix.chunks_exact(rows.max(1));
        let mut sum = 0.0;
        for (of_row, entries) in of_rows.zip(entries) {
            let mut row = 0.0;
            for (entries, cell) in entries.chunks_exact(layers).zip(&self.cells) {
                for (k, of_column) in entries.iter().zip(of_cell(cell)) {
                    row += k * k * of_column;
                }
            }
            sum += row * of_row;
        }
        sum.sqrt()
    }
}

/// `omega^2` (1/s^2) of each element, see [`ElementStiffness::omega_squared`].
#[must_use]
pub fn element_omegas_squared(elements: &dyn Elements, mass: &[f64]) -> Vec<f64> {
    let mut stiffness = ElementStiffness::default();
    (0..elements.count())
        .map(|element| {
            elements.stiffness(element, &mut stiffness);
            stiffness.omega_squared(mass)
        })
        .collect()
}
