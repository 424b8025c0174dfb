//! `cargo xtask meshes`.

use sinew_bench::report::write_atomically;
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::write_msh41_ascii;

use crate::bench::say;
use crate::failure::Failure;
use crate::root;

/// Cells a side of the paper's cube: 1331 nodes, 6000 tetrahedra.
const PAPER_CELLS: usize = 10;
/// Edge (m). The paper gives none; at 0.2 m its three claims hold (see ARCHITECTURE.md).
const PAPER_EDGE: f64 = 0.2;

pub(crate) fn run() -> Result<(), Failure> {
    let mesh = cube(PAPER_CELLS, PAPER_EDGE, Split::Kuhn).map_err(Failure::chore)?;
    let mut bytes = Vec::new();
    write_msh41_ascii(&mesh.to_mesh(), &mut bytes).map_err(Failure::chore)?;
    let text = String::from_utf8(bytes).map_err(Failure::chore)?;
    let path = root().join("meshes").join("paper-cube.msh");
    write_atomically(&path, &text).map_err(Failure::chore)?;
    say(&format!(
        "{}: {} nodes, {} tetrahedra, {} bytes",
        path.display(),
        mesh.points.len(),
        mesh.tets.len(),
        text.len()
    ));
    Ok(())
}
