//! Boxes of tetrahedra on a regular grid.
//!
//! Each hexahedron of the grid is cut into six tetrahedra around one of its space diagonals. Nodes are numbered x
//! fastest: node (i, j, k) has index `i + (nx + 1) * (j + (ny + 1) * k)`. The groups are
//!
//! | name | dimension | tag | members |
//! |---|---|---|---|
//! | `tissue` | 3 | 1 | all tetrahedra |
//! | `sides` | 2 | 2 | the four lateral faces x = 0, x = max, y = 0, y = max |
//! | `top` | 2 | 3 | the face z = max |
//! | `bottom` | 2 | 4 | the face z = 0 |

use crate::tet_mesh::{Group, GroupMembers, OUTWARD_FACES, TetMesh};

/// Way of cutting the hexahedra of a grid into tetrahedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Split {
    /// Every hexahedron around its diagonal from the lowest to the highest corner (Kuhn 1960). All diagonals have the
    /// same direction, which makes the mesh stiffer in some directions than in others: a beam of plain tetrahedra bends
    /// sideways, too.
    Kuhn,
    /// [`Split::Kuhn`] with hexahedron (i, j, k) reflected in x, y, z if i, j, k is odd. No direction is preferred over
    /// its mirror image.
    Mirrored,
}

/// A grid cannot be built.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StructuredError {
    /// An axis has no cells.
    #[error("the number of cells along {axis} is 0; at least 1 is needed")]
    NoCells {
        /// `x`, `y` or `z`.
        axis: char,
    },
    /// An edge length is not positive and finite.
    #[error("the edge along {axis} is {size:?} long; a positive, finite length is needed")]
    BadSize {
        /// `x`, `y` or `z`.
        axis: char,
        /// The requested length.
        size: f64,
    },
    /// Floating-point numbers cannot distinguish neighbouring nodes, or overflow.
    #[error(
        "{cells} cells along {axis} on an edge of {size:?} cannot be told apart in floating point"
    )]
    BadResolution {
        /// `x`, `y` or `z`.
        axis: char,
        /// Cells along the axis.
        cells: usize,
        /// The requested length.
        size: f64,
    },
    /// More nodes or tetrahedra than a 32-bit index can count.
    #[error("{} x {} x {} cells make more than {} tetrahedra or nodes", cells[0], cells[1], cells[2], u32::MAX)]
    TooLarge {
        /// Cells along x, y, z.
        cells: [usize; 3],
    },
}

/// A cube with `cells` hexahedra along each edge of length `edge`, from the origin to (edge, edge, edge).
///
/// # Errors
///
/// If `cells` is 0, `edge` is not a positive finite length, or the mesh is too large for 32-bit indices.
///
/// ```
/// use sinew_mesh::structured::{self, Split};
/// let cube = structured::cube(10, 0.2, Split::Kuhn)?;
/// assert_eq!((cube.points.len(), cube.tets.len()), (1331, 6000));
/// # Ok::<(), structured::StructuredError>(())
/// ```
pub fn cube(cells: usize, edge: f64, split: Split) -> Result<TetMesh, StructuredError> {
    block([cells; 3], [edge; 3], split)
}

/// A box with `cells` hexahedra along x, y, z, from the origin to `size`.
///
/// # Errors
///
/// If a number of cells is 0, a size is not a positive finite length, or the mesh is too large for 32-bit indices.
pub fn block(cells: [usize; 3], size: [f64; 3], split: Split) -> Result<TetMesh, StructuredError> {
    let ticks = [
        ticks('x', cells[0], size[0])?,
        ticks('y', cells[1], size[1])?,
        ticks('z', cells[2], size[2])?,
    ];
    let grid = Grid::new(cells)?;
    let tets = grid.tets(split);
    let points = grid.points(&ticks);
    let group = |name: &str, dim, tag, members| Group {
        name: name.to_owned(),
        dim,
        tag,
        members,
    };
    let faces = |on_face: &dyn Fn([usize; 3], [usize; 3]) -> bool| {
        GroupMembers::Triangles(grid.surface(&tets, on_face))
    };
    let groups = vec![
        group(
            "tissue",
            3,
            1,
            GroupMembers::Tets((0u32..).take(tets.len()).collect()),
        ),
        group(
            "sides",
            2,
            2,
            faces(&|low, high| {
                high[0] == 0 || low[0] == cells[0] || high[1] == 0 || low[1] == cells[1]
            }),
        ),
        group("top", 2, 3, faces(&|low, _| low[2] == cells[2])),
        group("bottom", 2, 4, faces(&|_, high| high[2] == 0)),
    ];
    Ok(TetMesh {
        tet_tags: (1..).take(tets.len()).collect(),
        node_tags: (1..).take(points.len()).collect(),
        points,
        tets,
        groups,
        data: Vec::new(),
        node_data: Vec::new(),
        notes: Vec::new(),
    })
}

/// The coordinates along one axis: `i * size / cells` for i = 0..=cells.
fn ticks(axis: char, cells: usize, size: f64) -> Result<Vec<f64>, StructuredError> {
    if cells == 0 {
        return Err(StructuredError::NoCells { axis });
    }
    if !(size.is_finite() && size > 0.0) {
        return Err(StructuredError::BadSize { axis, size });
    }
    // Checked here as well, so that an absurd number of cells is refused before its coordinates are stored.
    if u32::try_from(cells).is_err() {
        return Err(StructuredError::TooLarge { cells: [cells; 3] });
    }
    let tick = |i: usize| i as f64 * size / cells as f64;
    let ascends = |i: usize| tick(i) < tick(i + 1) && tick(i + 1).is_finite();
    if !(0..cells).all(ascends) {
        return Err(StructuredError::BadResolution { axis, cells, size });
    }
    Ok((0..=cells).map(tick).collect())
}

struct Grid {
    cells: [usize; 3],
}

impl Grid {
    fn new(cells: [usize; 3]) -> Result<Grid, StructuredError> {
        let fits = |factors: [Option<usize>; 4]| {
            let product = factors
                .into_iter()
                .try_fold(1usize, |product, factor| product.checked_mul(factor?));
            product.is_some_and(|product| u32::try_from(product).is_ok())
        };
        let [nx, ny, nz] = cells;
        let nodes_fit = fits([
            nx.checked_add(1),
            ny.checked_add(1),
            nz.checked_add(1),
            Some(1),
        ]);
        if nodes_fit && fits([Some(6), Some(nx), Some(ny), Some(nz)]) {
            Ok(Grid { cells })
        } else {
            Err(StructuredError::TooLarge { cells })
        }
    }

    /// Index of a node. [`Grid::new`] makes sure that it fits into 32 bits.
    fn node(&self, [i, j, k]: [usize; 3]) -> u32 {
        let [nx, ny, _] = self.cells;
        (i + (nx + 1) * (j + (ny + 1) * k)) as u32
    }

    /// Grid position of a node: the inverse of [`Grid::node`].
    fn position(&self, node: u32) -> [usize; 3] {
        let (row, column) = (self.cells[0] + 1, self.cells[1] + 1);
        let node = node as usize;
        [node % row, node / row % column, node / (row * column)]
    }

    fn points(&self, ticks: &[Vec<f64>; 3]) -> Vec<[f64; 3]> {
        let [x, y, z] = ticks;
        let mut points = Vec::with_capacity(x.len() * y.len() * z.len());
        for &z in z {
            for &y in y {
                points.extend(x.iter().map(|&x| [x, y, z]));
            }
        }
        points
    }

    fn tets(&self, split: Split) -> Vec<[u32; 4]> {
        let [nx, ny, nz] = self.cells;
        let mut tets = Vec::with_capacity(6 * nx * ny * nz);
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    let mirrored = match split {
                        Split::Kuhn => [false; 3],
                        Split::Mirrored => [i % 2 == 1, j % 2 == 1, k % 2 == 1],
                    };
                    tets.extend(self.split_hexahedron([i, j, k], mirrored));
                }
            }
        }
        tets
    }

    /// Six tetrahedra, each along one of the monotone paths from a corner to the opposite one.
    fn split_hexahedron(&self, corner: [usize; 3], mirrored: [bool; 3]) -> [[u32; 4]; 6] {
        // The even permutations of the axes come first; their tetrahedra are positively oriented.
        const PATHS: [[usize; 3]; 6] = [
            [0, 1, 2],
            [1, 2, 0],
            [2, 0, 1],
            [0, 2, 1],
            [2, 1, 0],
            [1, 0, 2],
        ];
        let reflections = mirrored.iter().filter(|&&m| m).count();
        let node = |steps: [bool; 3]| {
            let mut position = corner;
            for axis in 0..3 {
                position[axis] += usize::from(steps[axis] != mirrored[axis]);
            }
            self.node(position)
        };
        let mut tets = [[0; 4]; 6];
        for (index, (tet, path)) in tets.iter_mut().zip(PATHS).enumerate() {
            let mut steps = [false; 3];
            tet[0] = node(steps);
            for (corner, axis) in tet[1..].iter_mut().zip(path) {
                steps[axis] = true;
                *corner = node(steps);
            }
            if (index >= 3) != (reflections % 2 == 1) {
                tet.swap(1, 2);
            }
        }
        tets
    }

    /// The faces, turned outwards, whose nodes lie on one plane of the box: `on_face` receives the least and the
    /// largest grid position of a face.
    fn surface(
        &self,
        tets: &[[u32; 4]],
        on_face: &dyn Fn([usize; 3], [usize; 3]) -> bool,
    ) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        for tet in self.tets_at_surface(tets) {
            for face in OUTWARD_FACES {
                let nodes = face.map(|i| tet[i]);
                let [a, b, c] = nodes.map(|node| self.position(node));
                let low = [0, 1, 2].map(|axis| a[axis].min(b[axis]).min(c[axis]));
                let high = [0, 1, 2].map(|axis| a[axis].max(b[axis]).max(c[axis]));
                if on_face(low, high) {
                    triangles.push(nodes);
                }
            }
        }
        triangles
    }

    /// The tetrahedra of the hexahedra at the surface of the box, in order.
    fn tets_at_surface<'a>(&self, tets: &'a [[u32; 4]]) -> impl Iterator<Item = &'a [u32; 4]> {
        let [nx, ny, nz] = self.cells;
        let hexahedra = tets.as_chunks::<6>().0.iter().enumerate();
        let at_surface = hexahedra.filter(move |(index, _)| {
            let row = index / nx;
            let places = [(index % nx, nx), (row % ny, ny), (row / ny, nz)];
            places
                .into_iter()
                .any(|(place, cells)| place == 0 || place + 1 == cells)
        });
        at_surface.flat_map(|(_, tets)| tets)
    }
}
