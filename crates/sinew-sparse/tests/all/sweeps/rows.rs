//! Cells with matrices and vectors in a kernel's order.

use std::ops::Range;
use std::sync::Arc;

use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::{
    CHUNK, CellMap, Fields, Grid, Lattice, Numbering, Outcome, Precision, Rows, Sell, Sweep,
};
use sinew_sparse::{BlockMatrix, Layers, Pattern};

use super::{FORCES, INVERSE, LIMITS, LIVE, MASS, ROWS, U, V, W};

/// Numbers from -0.5 to 0.5 without a pattern.
pub(crate) fn scattered(index: usize) -> f64 {
    let value = (12.9898 * index as f64 + 0.5).sin() * 43_758.545;
    value - value.floor() - 0.5
}

/// A layout of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Every row stored separately with its own entries, of a graph without a lattice.
    General,
    /// Templates: one for each position of cells relative to the border.
    Border,
    /// Templates that rows at the border share with those inside.
    Merged,
    /// The same with a cut between cells: their rows lack neighbours although those cells exist.
    Cut,
}

/// Cells with two matrices and all vectors of a test.
pub(crate) struct Case<T> {
    kind: Kind,
    size: [usize; 3],
    pub(crate) layers: usize,
    numbering: Numbering,
    reach: usize,
    pub(crate) matrices: [BlockMatrix; 2],
    rows: [Rows<T>; 2],
    loaded: Vec<bool>,
}

impl<T> std::fmt::Debug for Case<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self {
            kind, size, layers, ..
        } = self;
        write!(
            f,
            "{kind:?} {size:?} x {layers} in {} bytes",
            size_of::<T>()
        )
    }
}

/// Bodies whose rows end within a vector, within a chunk and at its end, on one chunk and on several.
pub(crate) fn cases<T: Precision>() -> Vec<Case<T>> {
    // Watched or interpreted, a few: one layer of one kind, three of another, on more than one chunk in f64.
    if cfg!(miri) || std::env::var_os("SINEW_SMALL_TESTS").is_some() {
        let [one, three] = [(Kind::Merged, 1), (Kind::General, 3)];
        return [one, three]
            .map(|(kind, layers)| Case::new(kind, layers, [5, 3, 9]))
            .into();
    }
    let mut cases = Vec::new();
    for size in [[2, 1, 1], [5, 4, 7], [8, 4, 8], [13, 4, 10], [3, 16, 9]] {
        for kind in [Kind::General, Kind::Border, Kind::Merged, Kind::Cut] {
            for layers in [1, 3] {
                cases.push(Case::new(kind, layers, size));
            }
        }
    }
    cases
}

impl<T: Precision> Case<T> {
    pub(crate) fn new(kind: Kind, layers: usize, size: [usize; 3]) -> Self {
        let cells: usize = size.iter().product();
        let place = |cell: usize| {
            [
                cell % size[0],
                cell / size[0] % size[1],
                cell / (size[0] * size[1]),
            ]
        };
        // A cell's neighbours are the cells around it; without a lattice, any three as well.
        let near = |a: usize, b: usize| {
            let pairs = place(a).into_iter().zip(place(b));
            pairs.fold(0, |most, (a, b)| a.abs_diff(b).max(most)) <= 1
        };
        let mut links: Vec<[u32; 2]> = Vec::new();
        for a in 0..cells {
            for b in a + 1..cells {
                let leaps = kind == Kind::General && (a * 7919 + b * 104_729) % cells == 3;
                let thinned = kind == Kind::General && scattered(a + b * cells) > 0.0;
                let across =
                    |cell: usize| place(cell)[0] < size[0] / 2 && place(cell)[2] > size[2] / 2;
                let cut = kind == Kind::Cut && across(a) != across(b);
                if near(a, b) && !thinned && !cut || leaps {
                    links.push([a as u32, b as u32]);
                }
            }
        }
        let pattern = Arc::new(Pattern::from_elements(cells, links).unwrap());
        let of_layers = if layers == 1 {
            Layers::One
        } else {
            Layers::Three
        };
        let matrix = |seed: usize| {
            let mut matrix = BlockMatrix::zeros(Arc::clone(&pattern), of_layers);
            for a in 0..cells {
                for &b in pattern.neighbours(a) {
                    let b = b as usize;
                    let index = match kind {
                        Kind::General => a * cells + b,
                        // By the step between them, and of the cell itself by its number of neighbours.
                        _ => {
                            let steps = place(a).into_iter().zip(place(b));
                            let step = steps.fold(0, |all, (a, b)| 3 * all + 1 + b - a);
                            let own = a == b && kind == Kind::Border;
                            let border = pattern.neighbours(a).len();
                            step + if own { 1000 * border } else { 0 }
                        }
                    };
                    let entry = |entry| scattered(seed + 9 * index + entry);
                    let block: Vec<f64> = (0..layers * layers).map(entry).collect();
                    matrix.add_block(a as u32, b as u32, &block).unwrap();
                }
            }
            matrix
        };
        let matrices = [matrix(0), matrix(77)];
        let (numbering, reach, rows) = if kind == Kind::General {
            let numbering = Numbering::near_neighbours(&pattern, T::LANES);
            let rows = matrices
                .each_ref()
                .map(|matrix| Rows::General(Sell::new(matrix, &numbering)));
            (numbering, 0, rows)
        } else {
            let points: Vec<[f64; 3]> = (0..cells)
                .map(|cell| place(cell).map(|x| 0.1 * x as f64))
                .collect();
            let grid = Grid::find(&points, T::LANES).unwrap();
            let rows = matrices
                .each_ref()
                .map(|matrix| Rows::Lattice(Lattice::new(matrix, &grid).unwrap()));
            (grid.numbering().clone(), grid.reach(), rows)
        };
        let chunks = numbering.positions().div_ceil(CHUNK * T::LANES);
        // Forces act in every other chunk; of the last it is not said.
        let loaded = (1..chunks).map(|chunk| chunk % 2 == 1).collect();
        Self {
            kind,
            size,
            layers,
            numbering,
            reach,
            matrices,
            rows,
            loaded,
        }
    }

    /// Number of templates, if any.
    pub(crate) fn templates(&self) -> Option<usize> {
        match &self.rows[0] {
            Rows::General(_) => None,
            Rows::Lattice(lattice) => Some(lattice.templates()),
        }
    }

    pub(crate) fn cells(&self) -> usize {
        self.numbering.cells()
    }

    pub(crate) fn positions(&self) -> usize {
        self.numbering.positions()
    }

    pub(crate) fn chunks(&self) -> usize {
        self.positions().div_ceil(CHUNK * T::LANES)
    }

    /// Number of vectors.
    pub(crate) fn fields(&self) -> usize {
        ROWS as usize + self.layers
    }

    /// Initial value of a vector at a cell, rounded as the kernel rounds it.
    pub(crate) fn value(&self, field: usize, layer: usize, cell: usize) -> f64 {
        let number = scattered(31 * (field + 1) + 17 * layer + 1009 * cell);
        let mass = 1.25 + scattered(cell);
        let value = match field as u32 {
            U | V | W => number,
            FORCES => {
                let chunk = self.numbering.position(cell as u32) / (CHUNK * T::LANES);
                if self.loaded.get(chunk).copied().unwrap_or(true) {
                    number
                } else {
                    0.0
                }
            }
            MASS => mass,
            INVERSE => 1.0 / mass,
            LIMITS => 0.3 + number.abs(),
            LIVE => 1.0,
            _ => number,
        };
        T::of(value).to_f64()
    }

    /// Vectors of zeros.
    pub(crate) fn zero(&self) -> Fields<T> {
        Fields::new(self.fields(), self.layers, self.positions(), self.reach)
    }

    /// All vectors at the beginning of a test.
    pub(crate) fn filled(&self) -> Fields<T> {
        let mut fields = self.zero();
        for field in 0..self.fields() {
            for layer in 0..self.layers {
                for cell in 0..self.cells() {
                    let value = T::of(self.value(field, layer, cell));
                    let position = self.numbering.position(cell as u32);
                    fields.layer(field, layer)[position] = value;
                }
            }
        }
        fields
    }

    /// A sweep over all chunks.
    pub(crate) fn sweep(
        &self,
        fields: &mut Fields<T>,
        map: &CellMap<T>,
        set: InstructionSet,
        limit: T,
    ) -> Outcome {
        self.run(fields, map, (set, limit), 0..self.chunks())
    }

    /// A sweep over some chunks.
    pub(crate) fn sweep_on(
        &self,
        fields: &mut Fields<T>,
        map: &CellMap<T>,
        set: InstructionSet,
        chunks: Range<usize>,
    ) {
        let _ = self.run(fields, map, (set, T::of(1e30)), chunks);
    }

    #[allow(unsafe_code, reason = "the entrance to the kernels")]
    fn run(
        &self,
        fields: &mut Fields<T>,
        map: &CellMap<T>,
        (set, limit): (InstructionSet, T),
        chunks: Range<usize>,
    ) -> Outcome {
        let sweep = Sweep {
            map,
            matrices: &self.rows.each_ref(),
            fields,
            loaded: &self.loaded,
            limit,
        };
        // SAFETY: the vectors are borrowed for this thread alone.
        unsafe { sweep.run(set, chunks) }
    }

    /// A vector at a cell.
    pub(crate) fn found(
        &self,
        fields: &mut Fields<T>,
        field: usize,
        layer: usize,
        cell: usize,
    ) -> f64 {
        fields.layer(field, layer)[self.numbering.position(cell as u32)].to_f64()
    }

    /// The bits of vectors at all cells.
    pub(crate) fn bits(&self, fields: &mut Fields<T>, of: &[u32]) -> Vec<u64> {
        let mut bits = Vec::new();
        for field in of {
            for layer in 0..self.layers {
                for cell in 0..self.cells() {
                    bits.push(self.found(fields, *field as usize, layer, cell).to_bits());
                }
            }
        }
        bits
    }

    /// True if all vectors are 0 at positions without a cell.
    pub(crate) fn is_zero_elsewhere(&self, fields: &mut Fields<T>) -> bool {
        let mut layers =
            (0..self.fields()).flat_map(|field| (0..self.layers).map(move |layer| (field, layer)));
        layers.all(|(field, layer)| {
            let mut values = fields.layer(field, layer).iter().enumerate();
            values.all(|(position, value)| {
                self.numbering.cell(position).is_some() || *value == T::default()
            })
        })
    }
}
