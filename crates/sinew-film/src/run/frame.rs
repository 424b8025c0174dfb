//! Content of a frame's file.

use sinew_mesh::{CellType, Mesh};

use crate::body::{Boundary, Surface, Uncut, boundary_of};
use crate::field::{Field, Shown};

/// The array of displacements (m).
const DISPLACEMENT: &str = "displacement";

/// The array of regions, by their numbers from 1 on.
const REGION: &str = "region";

/// The cells of a frame. Frames with the same cells show the same body.
#[derive(Debug, Default)]
pub(super) struct Cells {
    /// Positions (m) of the nodes at rest.
    pub(super) points: Vec<[f64; 3]>,
    tets: Vec<[u32; 4]>,
    triangles: Vec<[u32; 3]>,
    /// The region of each tetrahedron.
    regions: Vec<u8>,
    /// Nodes on the surface, increasing; none until the surface was made.
    surface: Vec<u32>,
}

/// Cells are the same if nodes, tetrahedra and triangles are.
impl PartialEq for Cells {
    fn eq(&self, other: &Self) -> bool {
        self.points == other.points
            && self.tets == other.tets
            && self.triangles == other.triangles
            && self.regions == other.regions
    }
}

impl Cells {
    /// The cells of a frame, given by their corners.
    pub(super) fn of(mesh: &Mesh) -> Result<Self, String> {
        let mut cells = Self {
            points: mesh.points.clone(),
            ..Self::default()
        };
        let numbers = mesh.cell_data.iter().find(|data| data.name == REGION);
        for (place, block) in mesh.cells.iter().enumerate() {
            let corner = |nodes: &[u32], index: usize| nodes.get(index).copied().unwrap_or(0);
            match block.kind.linear() {
                CellType::Tetra => {
                    let tets = block.cells();
                    let tets = tets.map(|nodes| [0, 1, 2, 3].map(|index| corner(nodes, index)));
                    cells.tets.extend(tets);
                    let numbers = numbers.and_then(|data| data.blocks.get(place));
                    let of_cell = |cell| numbers.and_then(|numbers: &Vec<f64>| numbers.get(cell));
                    let regions = (0..block.len())
                        .map(|cell| of_cell(cell).map_or(1, |number| *number as u8));
                    cells.regions.extend(regions);
                }
                CellType::Triangle => {
                    let triangles = block.cells();
                    let triangles =
                        triangles.map(|nodes| [0, 1, 2].map(|index| corner(nodes, index)));
                    cells.triangles.extend(triangles);
                }
                _ => {}
            }
        }
        let all = cells
            .tets
            .as_flattened()
            .iter()
            .chain(cells.triangles.as_flattened());
        let most = all.max().copied();
        match most {
            None => Err("expected tetrahedra or triangles, found none".to_owned()),
            Some(node) if node as usize >= cells.points.len() => {
                let count = cells.points.len();
                Err(format!(
                    "a cell has the node {node}, but there are {count} points"
                ))
            }
            Some(_) => Ok(cells),
        }
    }

    /// Their boundary, with the nodes on it.
    pub(super) fn boundary(&self, before: Option<&Uncut>) -> Boundary {
        boundary_of(
            &self.points,
            &self.tets,
            &self.regions,
            &self.triangles,
            before,
        )
    }

    /// The surface of a boundary. Keeps the nodes on it.
    pub(super) fn surface(&mut self, boundary: &Boundary) -> Surface {
        let mut nodes = boundary.triangles.as_flattened().to_vec();
        nodes.sort_unstable();
        nodes.dedup();
        let place = |node: &u32| nodes.binary_search(node).unwrap_or_default() as u32;
        let triangles: Vec<[u32; 3]> = boundary
            .triangles
            .iter()
            .map(|triangle| triangle.each_ref().map(place))
            .collect();
        let rest = nodes
            .iter()
            .map(|node| self.points[*node as usize])
            .collect();
        self.surface = nodes;
        Surface::new(rest, &triangles, &boundary.kinds)
    }

    /// The nodes on the surface, in the order of its points.
    pub(super) fn surface_nodes(&self) -> &[u32] {
        &self.surface
    }
}

/// The fields of a frame: all its arrays.
pub(super) fn fields_of(mesh: &Mesh) -> Vec<Field> {
    let field = |name: &String, components, of_cells| Field {
        name: name.clone(),
        components,
        of_cells,
    };
    let of_points = mesh.point_data.iter();
    let of_points = of_points.map(|data| field(&data.name, data.components, false));
    let of_cells = mesh.cell_data.iter();
    let of_cells = of_cells.map(|data| field(&data.name, data.components, true));
    of_points.chain(of_cells).collect()
}

/// Displacements (m) of nodes.
pub(super) fn displacements(mesh: &Mesh, nodes: &[u32]) -> Result<Vec<[f32; 3]>, String> {
    let array = mesh
        .point_data
        .iter()
        .find(|data| data.name == DISPLACEMENT && data.components == 3)
        .ok_or("expected an array `displacement` with three components")?;
    let of_node = |node: &u32| {
        let first = 3 * *node as usize;
        [0, 1, 2].map(|axis| array.values.get(first + axis).copied().unwrap_or(0.0) as f32)
    };
    Ok(nodes.iter().map(of_node).collect())
}

/// Values of a field on the surface: those of nodes, or the mean over the cells at each node.
pub(super) fn values(mesh: &Mesh, shown: &Shown, cells: &Cells) -> Result<Vec<f32>, String> {
    let name = &shown.field.name;
    let components = shown.field.components.max(1);
    let of_points = mesh.point_data.iter().find(|data| data.name == *name);
    if let Some(data) = of_points.filter(|data| data.components == components) {
        let rows: Vec<&[f64]> = data.values.chunks(components).collect();
        let value = |node: &u32| rows.get(*node as usize).map_or(0.0, |row| shown.of(row));
        return Ok(cells
            .surface_nodes()
            .iter()
            .map(|node| value(node) as f32)
            .collect());
    }
    let of_cells = mesh.cell_data.iter().find(|data| data.name == *name);
    let data = of_cells
        .filter(|data| data.components == components)
        .ok_or_else(|| {
            format!(
                "expected an array `{name}` with {components} components, as the first frame has"
            )
        })?;
    let mut sums = vec![(0.0_f64, 0_u32); mesh.points.len()];
    for (block, values) in mesh.cells.iter().zip(&data.blocks) {
        for (nodes, row) in block.cells().zip(values.chunks(components)) {
            let value = shown.of(row);
            if !value.is_finite() {
                continue;
            }
            for node in nodes {
                if let Some((sum, times)) = sums.get_mut(*node as usize) {
                    *sum += value;
                    *times += 1;
                }
            }
        }
    }
    let mean = |node: &u32| {
        let (sum, times) = sums.get(*node as usize).copied().unwrap_or_default();
        (sum / f64::from(times.max(1))) as f32
    };
    Ok(cells.surface_nodes().iter().map(mean).collect())
}
