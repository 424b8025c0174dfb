//! `cargo xtask meshes`.

use sinew_bench::hard::meshes::{inclusion_cube, sliver_cube};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{TetMesh, write_msh41_ascii};
use sinew_scene::output::{Destination, say};

use crate::failure::Failure;
use crate::repository::root;

/// Cells along an edge of the paper's cube: 1331 nodes, 6000 tetrahedra.
const PAPER_CELLS: usize = 10;
/// Edge of the paper's cube (m). The paper gives none; at 0.2 m its three claims are true (see ARCHITECTURE.md).
const PAPER_EDGE: f64 = 0.2;

/// The cube with a sliver: cells along an edge, edge (m).
const SLIVER_CUBE: (usize, f64) = (5, 0.1);
/// Ratios of an ordinary element's thickness to the sliver's.
const THINNESS: [u32; 3] = [20, 100, 1000];
/// The cube with an inclusion: cells along an edge, number of cells in the core, edge (m).
const INCLUSION_CUBE: (usize, usize, f64) = (6, 2, 0.1);

pub(crate) fn run() -> Result<(), Failure> {
    let paper = cube(PAPER_CELLS, PAPER_EDGE, Split::Kuhn).map_err(Failure::chore)?;
    write("paper-cube", &paper)?;
    for thinness in THINNESS {
        let (cells, edge) = SLIVER_CUBE;
        let mesh = sliver_cube(cells, edge, thinness.into()).map_err(Failure::chore)?;
        write(&format!("sliver-{thinness}"), &mesh)?;
    }
    let (cells, core, edge) = INCLUSION_CUBE;
    let mesh = inclusion_cube(cells, core, edge).map_err(Failure::chore)?;
    write("inclusion", &mesh)
}

fn write(name: &str, mesh: &TetMesh) -> Result<(), Failure> {
    let mut bytes = Vec::new();
    write_msh41_ascii(&mesh.to_mesh(), &mut bytes).map_err(Failure::chore)?;
    let path = root().join("meshes").join(format!("{name}.msh"));
    let _ = Destination::new(&path, &[])?.write(&bytes)?;
    say(&format!(
        "{}: {} nodes, {} tetrahedra, {} bytes",
        path.display(),
        mesh.points.len(),
        mesh.tets.len(),
        bytes.len()
    ))?;
    Ok(())
}
