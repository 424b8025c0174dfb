//! Time of a stroke.
//!
//! `cargo bench -p sinew-cutting` slits structured cubes to half their depth, in one stroke and in many, along a plane
//! of nodes and next to one, and prints the smallest time of a stroke that cuts, its faces, and the time per row of the
//! matrices that it touches.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark ends in a panic and prints"
)]

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

#[path = "../tests/all/common/mod.rs"]
mod common;

use sinew_cutting::Sheet;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

const EDGE: f64 = 0.1;
const LAPS: usize = 5;

/// Cost of one stroke.
#[derive(Clone)]
struct Cost {
    time: Duration,
    faces: usize,
    moved: usize,
    rows: usize,
}

fn main() {
    println!("half-depth slits: least time of a stroke that cuts");
    for cells in [10, 20, 40] {
        let mesh = cube(cells, EDGE, Split::Kuhn).expect("the mesh is small enough");
        let grid = EDGE / cells as f64;
        let rows_deep = cells / 2;
        for (name, x) in [("on a plane of nodes", 0.0), ("beside one", 0.11 * grid)] {
            for strokes in [1, 2 * rows_deep, 16 * rows_deep] {
                let laps = (0..LAPS).map(|_| slit(&mesh, 0.05 + x, grid, strokes));
                let least = laps.reduce(|least, lap| {
                    let pairs = least.into_iter().zip(lap);
                    pairs
                        .map(|(a, b)| if a.time < b.time { a } else { b })
                        .collect()
                });
                let strokes = least.expect("there are laps");
                let worst = strokes
                    .iter()
                    .filter(|cost| cost.faces > 0)
                    .max_by_key(|cost| cost.time);
                let Some(Cost {
                    time,
                    faces,
                    moved,
                    rows,
                }) = worst.cloned()
                else {
                    continue;
                };
                let whole: Duration = strokes.iter().map(|cost| cost.time).sum();
                let micros = time.as_secs_f64() * 1e6;
                println!(
                    "  {:5} nodes, {name:<19} {:3} strokes, {:9.1} us in all; the longest: {faces:4} faces, {moved:3} nodes moved, {micros:8.1} us, \
                     {rows:5} rows, {:.2} us a row",
                    mesh.points.len(),
                    strokes.len(),
                    whole.as_secs_f64() * 1e6,
                    micros / rows.max(1) as f64,
                );
            }
        }
    }
}

fn slit(mesh: &TetMesh, x: f64, grid: f64, strokes: usize) -> Vec<Cost> {
    let mut body = common::body(mesh, 0.45);
    let mut positions = mesh.points.clone();
    positions.reserve(mesh.points.len() / 10 + 16);
    let blade = |n: usize| {
        let depth = EDGE + 0.1 * grid - (EDGE / 2.0 + 0.2 * grid) * n as f64 / strokes as f64;
        [[x, -0.01, depth], [x, EDGE + 0.01, depth]]
    };
    let costs = (0..strokes).map(|n| {
        let sheet = Sheet::swept(blade(n), blade(n + 1)).expect("it has an area");
        let before = Instant::now();
        let stroke = body
            .stroke(&sheet, &mut positions, 0.25)
            .expect("positions fit");
        let time = before.elapsed();
        let (faces, moved, changed) = (
            stroke.faces.len(),
            stroke.moved.len(),
            stroke.changed_tets.clone(),
        );
        let nodes = changed.iter().flat_map(|tet| body.tets()[*tet as usize]);
        let rows = nodes.collect::<BTreeSet<u32>>().len();
        Cost {
            time,
            faces,
            moved,
            rows,
        }
    });
    costs.collect()
}
