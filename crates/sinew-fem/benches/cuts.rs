//! Time of a cut, from the stroke to the updated model.
//!
//! `cargo bench -p sinew-fem --bench cuts` cuts structured cubes by a blade that comes down, on a plane of nodes and
//! next to one, in many short strokes and in one. It prints the median time of the strokes that cut, their faces and
//! new nodes, the rows of the matrix that they touch, the time for each of these, and, for comparison, the time to set
//! up the model that can be cut, and the times of the parts of a rebuild: the mesh, the problem on it, the model, and
//! one sum of energy. Times are wall times (us) of one thread.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark ends in a panic and prints"
)]

use std::cell::Cell;
use std::collections::BTreeSet;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use sinew_core::{Inputs, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, Fixed, Law, LoadKind, LoadSpec, Model, Problem, Region};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

const EDGE: f64 = 0.1;

fn main() {
    for cells in [10, 20] {
        let mesh = Arc::new(cube(cells, EDGE, Split::Kuhn).expect("the mesh is small enough"));
        let grid = EDGE / cells as f64;
        println!(
            "{} nodes, {} tetrahedra",
            mesh.points.len(),
            mesh.tets.len()
        );
        anew(&mesh);
        for (name, x, snap) in [
            ("on a plane of nodes", 0.0, 0.0),
            ("beside one, nodes stay", 0.11 * grid, 0.0),
            ("beside one, nodes moved", 0.11 * grid, 0.25),
        ] {
            for (strokes, width) in [(cells, 0.5), (cells, 1.0), (1, 1.0)] {
                slit(&mesh, (name, 0.05 + x, snap), (strokes, width));
            }
        }
    }
}

/// A cube on its bottom, pressed from above, under its weight.
fn problem() -> Problem {
    Problem::of([Region::new(Law::linear(3500.0, 0.45), 1060.0)])
        .with_fixed(Fixed::at("bottom"))
        .with_load(LoadSpec::new("top", LoadKind::Pressure(100.0)))
        .with_gravity([0.0, 0.0, -9.81])
}

/// Prints the times of the parts of a complete rebuild.
fn anew(mesh: &Arc<TetMesh>) {
    let problem = problem();
    let cut = CutModel::new(Arc::clone(mesh), problem.clone(), 0.0).expect("it can be cut");
    let model = cut.model();
    let [rest, mut moved] = [0, 1].map(|_| State::at_rest(model.dofs()));
    moved.u[0] = 1e-6;
    let states = Cell::new([&rest, &moved]);
    let least = |work: &dyn Fn()| {
        let times = (0..7).map(|_| {
            let begin = Instant::now();
            work();
            begin.elapsed().as_secs_f64() * 1e6
        });
        times.fold(f64::INFINITY, f64::min)
    };
    println!(
        "  set up: {:.0} us; anew: mesh {:.0}, problem {:.0}, model {:.0}, energy {:.0} us",
        least(&|| drop(black_box(CutModel::new(
            Arc::clone(mesh),
            problem.clone(),
            0.0
        )))),
        least(&|| drop(black_box(cut.body().mesh(mesh)))),
        least(&|| drop(black_box(problem.after_cuts(mesh, cut.mesh())))),
        least(&|| drop(black_box(Model::build(&cut.mesh().mesh, &problem)))),
        least(&|| {
            // In turn, since an evaluation at the last displacement is known.
            let [state, next] = states.get();
            states.set([next, state]);
            black_box(model.energy(&state.u, &state.v));
        }),
    );
}

/// Cost of a stroke that cut.
struct Cost {
    micros: f64,
    faces: usize,
    new_nodes: usize,
    rows: usize,
    /// Time (us) to cut the same faces if they are given: without the time that the blade needs.
    of_faces: Option<f64>,
}

/// Reserves space in a state for a tenth more degrees of freedom.
fn make_room(state: &mut State) {
    for values in [&mut state.u, &mut state.v] {
        values.reserve(values.len() / 8);
    }
}

/// Time (us) to cut given faces of a body.
fn given(mesh: &Arc<TetMesh>, faces: &[(u32, u8)]) -> f64 {
    let mut cut = CutModel::new(Arc::clone(mesh), problem(), 0.0).expect("it can be cut");
    let mut state = State::at_rest(cut.model().dofs());
    make_room(&mut state);
    let faces = faces
        .iter()
        .map(|(tet, vertex)| (*tet, usize::from(*vertex)));
    let begin = Instant::now();
    cut.cut_faces(faces, &mut state, Inputs::none())
        .expect("they are there");
    begin.elapsed().as_secs_f64() * 1e6
}

/// A slit to half the depth in several strokes, over a share of the cube's width.
fn slit(mesh: &Arc<TetMesh>, (name, x, snap): (&str, f64, f64), (strokes, width): (usize, f64)) {
    let mut costs = Vec::new();
    for _ in 0..5 {
        let mut cut = CutModel::new(Arc::clone(mesh), problem(), snap).expect("it can be cut");
        let mut state = State::at_rest(cut.model().dofs());
        make_room(&mut state);
        let blade = |n: usize| {
            let depth = EDGE + 1e-4 - (EDGE / 2.0 + 2e-4) * n as f64 / strokes as f64;
            [[x, -0.01, depth], [x, EDGE * width + 1e-3, depth]]
        };
        for n in 0..strokes {
            let before = cut.body().tets().to_vec();
            let places = cut.body().points().to_vec();
            let sheet = Sheet::swept(blade(n), blade(n + 1)).expect("it has an area");
            let begin = Instant::now();
            let report = cut
                .stroke(&sheet, &mut state, Inputs::none())
                .expect("it cuts");
            let micros = begin.elapsed().as_secs_f64() * 1e6;
            if report.is_empty() {
                continue;
            }
            let body = cut.body();
            let is_other = |tet: &usize| {
                let nodes = body.tets()[*tet];
                nodes != before[*tet]
                    || nodes
                        .iter()
                        .any(|node| places.get(*node as usize) != body.points().get(*node as usize))
            };
            let changed = (0..before.len()).filter(is_other);
            let nodes =
                changed.flat_map(|tet| before[tet].into_iter().chain(cut.body().tets()[tet]));
            costs.push(Cost {
                micros,
                faces: report.faces,
                new_nodes: report.new_nodes,
                rows: nodes.collect::<BTreeSet<u32>>().len(),
                of_faces: (strokes == 1 && snap == 0.0)
                    .then(|| given(mesh, &cut.body().last_stroke().faces)),
            });
        }
    }
    costs.sort_by(|a, b| a.micros.total_cmp(&b.micros));
    let most = costs.last().map_or(0.0, |cost| cost.micros);
    let Some(Cost {
        micros,
        faces,
        new_nodes,
        rows,
        of_faces,
    }) = costs.get(costs.len() / 2)
    else {
        return;
    };
    let of_faces = of_faces.map_or(String::new(), |micros| {
        let by_row = micros / *rows as f64;
        format!("; the same faces without a blade {micros:.0} us, {by_row:.2} us a row")
    });
    println!(
        "  {name}, {strokes} strokes over {width} of the width: {micros:.0} us (at most {most:.0}) for {faces} faces, {new_nodes} new nodes, \
         {rows} rows: {:.2} us a row{of_faces}",
        micros / *rows as f64
    );
}
