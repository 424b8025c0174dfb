//! Time and memory for reading a large mesh, in comparison with meshio on the same files.
//!
//! `cargo bench -p sinew-mesh` makes a structured mesh of a million tetrahedra, writes it in every version and
//! encoding, and reads each file several times. The ratio to meshio is printed if `python3` has meshio. A number after
//! `--` is the number of cells along an edge of the cube, for smaller or larger meshes.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark ends in a panic and prints"
)]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use sinew_core::CountingAllocator;
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{Mesh, MshEncoding, MshVersion, read_msh_file, write_msh};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

const REPEATS: usize = 7;

fn main() {
    let cells = std::env::args()
        .find_map(|argument| argument.parse().ok())
        .unwrap_or(56);
    let mesh = cube(cells, 1.0 / 3.0, Split::Mirrored)
        .expect("the mesh is small enough")
        .to_mesh();
    let tets: usize = mesh
        .cells
        .iter()
        .filter(|b| b.kind.dim() == 3)
        .map(sinew_mesh::CellBlock::len)
        .sum();
    println!("{tets} tetrahedra, {} nodes", mesh.points.len());
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let has_meshio = Command::new("python3")
        .args(["-c", "import meshio"])
        .output()
        .is_ok_and(|output| output.status.success());
    if !has_meshio {
        println!("python3 has no meshio: nothing to compare with");
    }
    for (name, version, encoding) in [
        ("4.1 binary", MshVersion::V41, MshEncoding::Binary),
        ("4.1 ASCII", MshVersion::V41, MshEncoding::Text),
        ("2.2 binary", MshVersion::V22, MshEncoding::Binary),
        ("2.2 ASCII", MshVersion::V22, MshEncoding::Text),
    ] {
        let path = dir.join("mesh.msh");
        let file = fs::File::create(&path).expect("it can be written");
        write_msh(&mesh, version, encoding, &mut &file).expect("it can be written");
        measure(name, &path, has_meshio);
    }
}

fn measure(name: &str, path: &Path, has_meshio: bool) {
    let megabytes = fs::metadata(path).expect("it was written").len() as f64 / 1e6;
    let mut seconds = Vec::new();
    let mut memory = 0.0;
    for _ in 0..REPEATS {
        let start = Instant::now();
        let (mesh, peak) = CountingAllocator::peak(|| read_msh_file(path).expect("it was written"));
        seconds.push(start.elapsed().as_secs_f64());
        memory = peak as f64 / array_bytes(&mesh) as f64;
    }
    seconds.sort_unstable_by(f64::total_cmp);
    let median = seconds[REPEATS / 2];
    let speed = megabytes / median;
    println!(
        "{name}: {megabytes:.1} MB in {:.1} ms (median of {REPEATS}): {speed:.0} MB/s; peak memory {memory:.2} x the arrays",
        median * 1e3
    );
    if has_meshio && let Some(meshio) = meshio_seconds(path) {
        println!(
            "{name}: meshio takes {meshio:.2} s, {:.1} x as long",
            meshio / median
        );
    }
}

/// The size of the reader's result (bytes).
fn array_bytes(mesh: &Mesh) -> usize {
    let cells = mesh.cells.iter().map(|block| {
        let per_cell = 8 + 4 + 4;
        4 * block.connectivity.len() + per_cell * block.len()
    });
    24 * mesh.points.len()
        + 8 * mesh.node_tags.len()
        + 8 * mesh.node_entities.len()
        + cells.sum::<usize>()
}

/// The median of three readings, without the time it takes to load Python.
fn meshio_seconds(path: &Path) -> Option<f64> {
    const SCRIPT: &str = "
import sys, time, meshio
seconds = []
for _ in range(3):
    start = time.perf_counter()
    meshio.gmsh.read(sys.argv[1])
    seconds.append(time.perf_counter() - start)
print(sorted(seconds)[1])
";
    let output = Command::new("python3")
        .args(["-c", SCRIPT])
        .arg(path)
        .output()
        .ok()?;
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .last()?
        .parse()
        .ok()
}
