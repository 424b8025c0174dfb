//! Lists the groups of a gmsh file: `cargo run -- FILE.msh`, or of a cube without a file.

use std::error::Error;

use sinew_mesh::read_msh_file;
use sinew_mesh::structured::{Split, cube};

fn main() -> Result<(), Box<dyn Error>> {
    let mesh = match std::env::args().nth(1) {
        Some(path) => read_msh_file(path)?.to_tet_mesh()?,
        None => cube(4, 0.1, Split::Mirrored)?,
    };
    println!(
        "{} nodes, {} tetrahedra",
        mesh.points.len(),
        mesh.tets.len()
    );
    for group in &mesh.groups {
        println!(
            "{} (dimension {}): {}",
            group.name,
            group.dim,
            group.members.len()
        );
    }
    Ok(())
}
