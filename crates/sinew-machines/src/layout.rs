//! Matrices in the order of a machine.

use std::sync::Arc;

use sinew_core::{ElementForces, LinearOperators, LinearSystem};
use sinew_sparse::sweep::{Grid, Lattice, Numbering, Precision, Rows, Sell};

/// The matrices of a system as kernels read them.
#[derive(Clone, Debug)]
pub struct Layout<T> {
    pub(crate) numbering: Numbering,
    /// Positions before the first and after the last that products read.
    pub(crate) reach: usize,
    pub(crate) stiffness: Rows<T>,
    pub(crate) dashpots: Option<Rows<T>>,
    /// Blocks of the matrices, with each row counted separately.
    blocks: usize,
    /// Elements of the force law whose forces are added to those of the matrices; 0 without a force law.
    pub(crate) elements: usize,
}

/// The layout for any matrix.
struct General<T>(Arc<Layout<T>>);

/// The layout used together with the elements of a force law.
struct BesideElements<T>(Arc<Layout<T>>);

/// The layout of a lattice, if any.
struct Repeated<T>(Option<Arc<Layout<T>>>);

/// Approximate work of a batch (microseconds) below which sleeping threads are not woken.
const WAKE: usize = 400;

/// Approximate work of a sweep (microseconds) that is worth a thread.
const SHARE: usize = 30;

/// Approximate number of elements per microsecond.
const ELEMENTS: usize = 150;

/// Bytes of matrices that stay in a second cache, and in a third.
const SECOND_CACHE: usize = 2 << 20;
const THIRD_CACHE: usize = 32 << 20;

/// Approximate time of a cell's map for a vector of positions, relative to that of the product of a vector with a
/// template's block. Reading a block takes 4 of these in the second cache, 8 in the third and 12 in memory.
const MAP: usize = 8;

impl<T: Precision> Layout<T> {
    /// The rows of any matrix, each stored separately; built once for all clones of the operators.
    #[must_use]
    pub fn general(operators: &LinearOperators) -> Arc<Self> {
        let of = |operators: &LinearOperators| {
            let stiffness = operators.stiffness();
            let numbering = Numbering::near_neighbours(stiffness.pattern(), T::LANES);
            let rows = |matrix| Rows::General(Sell::new(matrix, &numbering));
            let extra = operators.damping().extra.as_ref();
            General(Arc::new(Self {
                stiffness: rows(stiffness),
                dashpots: extra.map(|extra| rows(extra)),
                reach: 0,
                numbering,
                blocks: blocks(operators),
                elements: 0,
            }))
        };
        Arc::clone(&operators.derived::<General<T>>(of).0)
    }

    /// The matrices used together with the elements of a force law, in the order of its forces; built once for all
    /// clones of the operators.
    #[must_use]
    pub fn beside_elements(forces: &dyn ElementForces) -> Arc<Self> {
        let of = |operators: &LinearOperators| {
            let order = forces.order();
            let positions = order.len().next_multiple_of(T::LANES);
            let mut position = vec![0; order.len()];
            for (place, cell) in (0..).zip(&order) {
                position[*cell as usize] = place;
            }
            let numbering = Numbering::at(position, positions);
            let rows = |matrix| Rows::General(Sell::new(matrix, &numbering));
            let extra = operators.damping().extra.as_ref();
            BesideElements(Arc::new(Self {
                stiffness: rows(operators.stiffness()),
                dashpots: extra.map(|extra| rows(extra)),
                reach: 0,
                numbering,
                blocks: blocks(operators),
                elements: forces.elements(),
            }))
        };
        Arc::clone(&forces.operators().derived::<BesideElements<T>>(of).0)
    }

    /// Templates on a lattice, if cells are on one and few templates make all rows; built once for all clones of the
    /// operators.
    #[must_use]
    pub fn repeated(system: &dyn LinearSystem) -> Option<Arc<Self>> {
        let of = |operators: &LinearOperators| {
            Repeated(Self::on_lattice(operators, system.cell_positions()).map(Arc::new))
        };
        system.operators().derived::<Repeated<T>>(of).0.clone()
    }

    fn on_lattice(operators: &LinearOperators, points: Option<Vec<[f64; 3]>>) -> Option<Self> {
        let stiffness = operators.stiffness();
        let points = points.filter(|points| points.len() == stiffness.pattern().cells())?;
        let grid = Grid::find(&points, T::LANES)?;
        let rows = |matrix| Lattice::new(matrix, &grid).map(Rows::Lattice);
        let dashpots = match &operators.damping().extra {
            Some(extra) => Some(rows(extra)?),
            None => None,
        };
        Some(Self {
            stiffness: rows(stiffness)?,
            dashpots,
            reach: grid.reach(),
            numbering: grid.numbering().clone(),
            blocks: blocks(operators),
            elements: 0,
        })
    }

    /// True if templates take less time than rows read from memory. Short runs, which free surfaces and holes cause,
    /// use vectors poorly, and the rows of a small body stay in a cache.
    pub(crate) fn pays(&self) -> bool {
        let Rows::Lattice(lattice) = &self.stiffness else {
            return true;
        };
        let block = match self.bytes_of_rows(lattice) {
            0..SECOND_CACHE => 4,
            SECOND_CACHE..THIRD_CACHE => 8,
            _ => 12,
        };
        let of_rows = block * self.blocks / T::LANES + MAP * self.numbering.cells() / T::LANES;
        lattice.vectors_of_blocks() + MAP * lattice.vectors_of_positions() < of_rows
    }

    /// Bytes of the rows that templates represent, if each were stored separately.
    fn bytes_of_rows(&self, lattice: &Lattice<T>) -> usize {
        let layers = lattice.layers();
        self.blocks * (layers * layers * size_of::<T>() + size_of::<u32>())
    }

    /// Description of the rows that kernels use, and of the memory that templates save.
    pub(crate) fn in_words(&self) -> String {
        let cells = self.numbering.cells();
        match &self.stiffness {
            _ if self.elements > 0 => format!("loops over {} elements", self.elements),
            Rows::General(_) => format!("rows of any mesh ({cells}, {})", size(self.bytes())),
            Rows::Lattice(rows) => {
                format!(
                    "{} templates in the place of {cells} rows ({} for {})",
                    rows.templates(),
                    size(self.bytes()),
                    size(self.bytes_of_rows(rows))
                )
            }
        }
    }

    /// Number of templates, if rows repeat.
    #[must_use]
    pub fn templates(&self) -> Option<usize> {
        match &self.stiffness {
            Rows::General(_) => None,
            Rows::Lattice(lattice) => Some(lattice.templates()),
        }
    }

    /// Bytes of the matrices that a sweep with all of them reads.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.stiffness.bytes() + self.dashpots.as_ref().map_or(0, Rows::bytes)
    }

    /// The best number of threads for sweeps over this number of chunks and elements: each has work for some tens of
    /// microseconds in a sweep; one thread if a batch ends before others are awake.
    pub(crate) fn threads_for(&self, chunks: usize, elements: usize, sweeps: usize) -> usize {
        // Microseconds, about: rows of blocks are read from memory, templates are not.
        let (work, vectors) = match self.stiffness {
            Rows::General(_) => (4, T::LANES),
            Rows::Lattice(_) => (1, 8),
        };
        let of_sweep = chunks * work * vectors / 8 + elements / ELEMENTS;
        if of_sweep.saturating_mul(sweeps) < WAKE {
            return 1;
        }
        (of_sweep / SHARE).max(1)
    }
}

/// Blocks of the matrices that sweeps read.
fn blocks(operators: &LinearOperators) -> usize {
    let extra = operators.damping().extra.as_ref();
    let matrices = [Some(operators.stiffness()), extra];
    let matrices = matrices.into_iter().flatten();
    matrices.map(|matrix| matrix.pattern().blocks()).sum()
}

/// Description of a number of bytes.
fn size(bytes: usize) -> String {
    match bytes {
        0..10_000 => format!("{bytes} bytes"),
        10_000..10_000_000 => format!("{} kB", bytes / 1000),
        _ => format!("{} MB", bytes / 1_000_000),
    }
}
