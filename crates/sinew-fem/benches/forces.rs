//! Time of the forces of hyperelastic bodies.
//!
//! `cargo bench -p sinew-fem --bench forces` evaluates the net force of structured cubes and, in addition, the elastic
//! force with its energy. The figures are nanoseconds a tetrahedron, the least of many evaluations on one thread, so
//! that other programs on the machine do not count. A number after `--` is the time for each figure (ms); a word is a
//! part of the names of the laws or elements to evaluate.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a benchmark ends in a panic and prints"
)]

use std::time::{Duration, Instant};

use sinew_core::{ElasticLaw, ForceLaw, LoadTime, System, Trial};
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::{Element, Law, Model, Problem, Region};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

fn main() {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    // Cargo's own.
    arguments.retain(|argument| argument != "--bench");
    let number = |argument: &String| argument.parse::<u64>().ok();
    let time = Duration::from_millis(arguments.iter().find_map(number).unwrap_or(300));
    let word = arguments
        .iter()
        .find(|argument| number(argument).is_none())
        .cloned()
        .unwrap_or_default();
    let edges = Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    };
    for cells in [10, 20] {
        let mesh = cube(cells, 0.1, Split::Kuhn).expect("the mesh is small enough");
        println!("{} tetrahedra: net force, elastic force", mesh.tets.len());
        let of_laws = Hyperelastic::IDS.iter().map(|id| (*id, Element::P1));
        let averaged = [
            ("neo-hookean", Element::Fbar { patch: None }),
            ("neo-hookean", edges),
        ];
        for (law, element) in of_laws.chain(averaged) {
            let name = format!("{law}, {element}");
            if name.contains(&word) {
                measure(&name, &mesh, &problem(law, element), time);
            }
        }
    }
}

fn problem(law: &'static str, element: Element) -> Problem {
    let parameters = Hyperelastic::parameters(law, 3500.0, 0.45).expect("every law has them");
    let region = Region::new(Law::hyperelastic(law, parameters), 1060.0);
    Problem::of([region.with_element(element)])
}

fn measure(name: &str, mesh: &TetMesh, problem: &Problem, time: Duration) {
    let model = Model::build(mesh, problem).expect("it can be built");
    let mut u = vec![0.0; model.dofs()];
    for (u, [x, y, z]) in u.chunks_exact_mut(3).zip(&mesh.points) {
        u[0] = 0.01 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z;
        u[1] = 0.005 * (31.0 * x + 8.0 * y).cos() - 0.3 * z;
        u[2] = -0.25 * z + 0.15 * y + 3.0 * x * x;
    }
    let (v, mut out) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    // In turn, since an evaluation at the last displacement is known.
    let smaller: Vec<f64> = u.iter().map(|u| 0.99 * u).collect();
    let mut trials = [&u, &smaller].map(|u| Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u,
        v: &v,
        internal: &[],
    });
    let per_tet = |least: Duration| least.as_secs_f64() * 1e9 / mesh.tets.len() as f64;
    let net = per_tet(least(time, || {
        trials.swap(0, 1);
        model
            .net_force(&trials[0], &mut out)
            .expect("it is defined");
    }));
    let elastic = per_tet(least(time, || {
        trials.swap(0, 1);
        model
            .elastic_force(&trials[0], &mut out)
            .expect("it is defined");
    }));
    println!("  {name:<40} {net:6.1} {elastic:6.1}");
}

fn least(time: Duration, mut work: impl FnMut()) -> Duration {
    let (mut least, start) = (Duration::MAX, Instant::now());
    while start.elapsed() < time {
        let before = Instant::now();
        work();
        least = least.min(before.elapsed());
    }
    least
}
