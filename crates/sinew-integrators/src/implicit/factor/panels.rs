//! Solution with a factor that is stored in panels.

use faer::sparse::linalg::cholesky::{SymbolicCholesky, SymbolicCholeskyRaw};

/// Layout of the columns of a factor L: adjacent columns with the same rows below them form a panel, a dense matrix,
/// column by column.
///
/// A solution reads each number of the factor twice and does two operations per number, so that memory bandwidth limits
/// its speed: four columns are read in one pass over the right-hand side.
#[derive(Debug)]
pub(super) struct Panels {
    panels: Vec<Panel>,
    /// Rows below the diagonal blocks of all panels.
    rows: Vec<u32>,
}

#[derive(Debug)]
struct Panel {
    first: usize,
    width: usize,
    values: usize,
    rows: usize,
    below: usize,
}

/// Columns that are read together.
const COLUMNS: usize = 4;

/// Partial sums of a dot product.
const SUMS: usize = 8;

impl Panels {
    /// The panels of an analysed factor.
    pub(super) fn of(symbolic: &SymbolicCholesky<usize>) -> Self {
        let mut panels = Self {
            panels: Vec::new(),
            rows: Vec::new(),
        };
        match symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(supernodes) => {
                for i in 0..supernodes.n_supernodes() {
                    let (first, end) = (
                        supernodes.supernode_begin()[i],
                        supernodes.supernode_end()[i],
                    );
                    let values = supernodes.col_ptr_for_val()[i];
                    panels.push(
                        first,
                        end - first,
                        values,
                        supernodes.supernode(i).pattern(),
                    );
                }
            }
            SymbolicCholeskyRaw::Simplicial(columns) => {
                let start = columns.col_ptr();
                for column in 0..columns.ncols() {
                    // The first row is that of the diagonal.
                    let below = &columns.row_idx()[start[column] + 1..start[column + 1]];
                    panels.push(column, 1, start[column], below);
                }
            }
        }
        panels
    }

    fn push(&mut self, first: usize, width: usize, values: usize, below: &[usize]) {
        self.panels.push(Panel {
            first,
            width,
            values,
            rows: self.rows.len(),
            below: below.len(),
        });
        self.rows.extend(below.iter().map(|row| *row as u32));
    }

    /// Replaces `x` by the solution of `L L' x = b`. `work` is as long as x.
    pub(super) fn solve(&self, values: &[f64], x: &mut [f64], work: &mut [f64]) {
        pulp::Arch::new().dispatch(
            #[inline(always)]
            || {
                self.lower(values, x, work);
                self.upper(values, x, work);
            },
        );
    }

    /// `L y = b`.
    #[inline(always)]
    fn lower(&self, values: &[f64], x: &mut [f64], work: &mut [f64]) {
        for panel in &self.panels {
            let products = &mut work[..panel.below];
            products.fill(0.0);
            let own = &mut x[panel.first..panel.first + panel.width];
            panel.lower(&values[panel.values..], own, products);
            for (row, product) in self.rows[panel.rows..].iter().zip(products) {
                x[*row as usize] -= *product;
            }
        }
    }

    /// `L' x = y`.
    #[inline(always)]
    fn upper(&self, values: &[f64], x: &mut [f64], work: &mut [f64]) {
        for panel in self.panels.iter().rev() {
            let below = &mut work[..panel.below];
            for (below, row) in below.iter_mut().zip(&self.rows[panel.rows..]) {
                *below = x[*row as usize];
            }
            let own = &mut x[panel.first..panel.first + panel.width];
            panel.upper(&values[panel.values..], own, below);
        }
    }
}

impl Panel {
    /// Consecutive columns, the last one repeated if there are fewer.
    #[inline(always)]
    fn columns<'a>(&self, values: &'a [f64], first: usize) -> [&'a [f64]; COLUMNS] {
        let height = self.width + self.below;
        std::array::from_fn(|i| {
            let column = (first + i).min(self.width - 1);
            &values[column * height..(column + 1) * height]
        })
    }

    /// Solves with the panel's triangle, and adds the products of the rows below it.
    #[inline(always)]
    fn lower(&self, values: &[f64], x: &mut [f64], below: &mut [f64]) {
        for first in (0..self.width).step_by(COLUMNS) {
            let columns = self.columns(values, first);
            let end = (first + COLUMNS).min(self.width);
            let mut known = [0.0; COLUMNS];
            for i in first..end {
                let column = columns[i - first];
                known[i - first] = x[i] / column[i];
                x[i] = known[i - first];
                for j in i + 1..end {
                    x[j] -= column[j] * known[i - first];
                }
            }
            let (inside, outside) = (end..self.width, self.width..self.width + below.len());
            add_products(
                columns.map(|column| &column[inside.clone()]),
                known.map(|x| -x),
                &mut x[end..],
            );
            add_products(columns.map(|column| &column[outside.clone()]), known, below);
        }
    }

    /// Subtracts the products of the rows below the panel's triangle, and solves with its transpose.
    #[inline(always)]
    fn upper(&self, values: &[f64], x: &mut [f64], below: &[f64]) {
        for first in (0..self.width).step_by(COLUMNS).rev() {
            let columns = self.columns(values, first);
            let end = (first + COLUMNS).min(self.width);
            let (inside, outside) = (end..self.width, self.width..self.width + below.len());
            let near = dot_products(columns.map(|column| &column[inside.clone()]), &x[end..]);
            let far = dot_products(columns.map(|column| &column[outside.clone()]), below);
            for i in (first..end).rev() {
                let column = columns[i - first];
                let mut sum = x[i] - (near[i - first] + far[i - first]);
                for j in i + 1..end {
                    sum -= column[j] * x[j];
                }
                x[i] = sum / column[i];
            }
        }
    }
}

/// Adds to `out` the columns times `factors`.
#[inline(always)]
fn add_products([a, b, c, d]: [&[f64]; COLUMNS], factors: [f64; COLUMNS], out: &mut [f64]) {
    let [p, q, r, s] = factors;
    let columns = a.iter().zip(b).zip(c.iter().zip(d));
    for (out, ((a, b), (c, d))) in out.iter_mut().zip(columns) {
        *out += (a * p + b * q) + (c * r + d * s);
    }
}

/// The dot product of each column with `x`.
#[inline(always)]
fn dot_products(columns: [&[f64]; COLUMNS], x: &[f64]) -> [f64; COLUMNS] {
    let mut sums = [[0.0; SUMS]; COLUMNS];
    let (x, last) = x.as_chunks::<SUMS>();
    let [a, b, c, d] = columns.map(|column| column.as_chunks::<SUMS>());
    let chunks = a.0.iter().zip(b.0).zip(c.0.iter().zip(d.0));
    for (x, ((a, b), (c, d))) in x.iter().zip(chunks) {
        for (sums, column) in sums.iter_mut().zip([a, b, c, d]) {
            for i in 0..SUMS {
                sums[i] += column[i] * x[i];
            }
        }
    }
    let rests = [a.1, b.1, c.1, d.1];
    std::array::from_fn(|k| {
        let sums = &sums[k];
        let sum =
            (sums[0] + sums[4]) + (sums[1] + sums[5]) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
        let rest = rests[k].iter().zip(last);
        rest.fold(sum, |sum, (a, x)| sum + a * x)
    })
}
