//! The sizes by which a guard judges velocities: closed forms.

#![cfg(test)]

mod common;

use common::{DENSITY, add_node_group, body, build, figure, held, linear, load, springs};
use sinew_core::{Layers, Ramp, System};
use sinew_fem::{Law, LoadKind, LoadSpec, Model, Problem, Region, SpringRule};
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};

const YOUNGS_MODULUS: f64 = 3500.0;

fn block() -> TetMesh {
    structured::block([2, 3, 4], [0.2, 0.3, 0.8], Split::Kuhn).unwrap()
}

fn impedance(model: &Model) -> f64 {
    model.scales().unwrap().impedance
}

fn pressure(problem: &Problem) -> f64 {
    build(&block(), problem).scales().unwrap().pressure
}

#[test]
fn a_cells_size_is_the_shortest_edge_at_it() {
    let mesh = block();
    let mut problem = body(linear(YOUNGS_MODULUS, 0.3));
    problem.fixed = vec![held("bottom")];
    let model = build(&mesh, &problem);
    assert_eq!(model.layers(), Layers::Three);
    let sizes = model.scales().unwrap().cell_size.to_vec();
    assert_eq!(sizes.len(), 3 * 4 * 4);
    for size in sizes {
        figure("size", size, 0.1, 1e-15);
    }
    // A node drawn near to its neighbour shortens the size of both, and of no other.
    let mut mesh = block();
    let (node, _) = mesh.nearest_node([0.1, 0.1, 0.4]);
    mesh.points[node as usize][0] = 0.04;
    let model = build(&mesh, &problem);
    let short = model.scales().unwrap().cell_size.iter();
    assert_eq!(short.filter(|size| **size < 0.05).count(), 2);
}

/// rho c_p^2 = E (1 - nu)/((1 + nu)(1 - 2 nu)), and 3 mu where that is less.
#[test]
fn impedance_is_density_times_the_speed_of_pressure_waves_or_of_fast_shear() {
    let of = |law: Law| impedance(&build(&block(), &body(law)));
    let e = YOUNGS_MODULUS;
    for (poissons_ratio, modulus) in [
        (0.0, e),
        (0.2, e * 0.8 / (1.2 * 0.6)),
        (0.25, 1.2 * e),
        (0.45, 3.0 * e / (2.0 * 1.45)),
        (0.499, 3.0 * e / (2.0 * 1.499)),
    ] {
        let expected = f64::sqrt(DENSITY * modulus);
        let found = of(linear(e, poissons_ratio));
        figure("impedance", found / expected, 1.0, 1e-12);
    }
    // Springs are a material of nu 1/4 whose modulus calibration sets.
    let found = of(springs(e, SpringRule::Lloyd, true));
    figure(
        "of springs",
        found / f64::sqrt(DENSITY * 1.2 * e),
        1.0,
        1e-12,
    );
}

#[test]
fn the_slowest_of_two_materials_counts() {
    let mut mesh = block();
    let half = mesh.tets.len() as u32 / 2;
    let groups = [("a", 11, 0..half), ("b", 12, half..2 * half)];
    for (name, tag, members) in groups {
        mesh.groups.push(Group {
            name: name.into(),
            dim: 3,
            tag,
            members: GroupMembers::Tets(members.collect()),
        });
    }
    let region = |group: &str, density, modulus| Region {
        group: Some(group.into()),
        density,
        law: linear(modulus, 0.0),
    };
    let problem = Problem {
        regions: vec![region("a", 1000.0, 4000.0), region("b", 4000.0, 900.0)],
        ..Problem::default()
    };
    let found = impedance(&build(&mesh, &problem));
    figure("impedance", found, f64::sqrt(4000.0 * 900.0), 1e-9);
}

#[test]
fn pressures_of_all_loads_at_their_largest_add_up() {
    let mut problem = body(linear(YOUNGS_MODULUS, 0.3));
    assert_eq!(pressure(&problem), 0.0);
    problem.loads = vec![load("top", LoadKind::Traction([30.0, 0.0, -40.0]))];
    figure("traction", pressure(&problem), 50.0, 1e-12);
    problem.loads.push(LoadSpec {
        ramp: Ramp::Table {
            times: vec![0.0, 1.0, 2.0],
            values: vec![0.0, -3.0, 1.0],
        },
        ..load("sides", LoadKind::Pressure(-7.0))
    });
    figure("and pressure", pressure(&problem), 71.0, 1e-12);
    // The column of tissue above: rho g times the longest edge.
    problem.gravity = Some([0.0, 6.0, -8.0]);
    let weight = DENSITY * 10.0 * 0.8;
    figure("and weight", pressure(&problem), 71.0 + weight, 1e-9);
}

/// A force of 0.5 N on two nodes of size 0.1 m: 0.25 N on 0.01 m^2 each.
#[test]
fn a_force_presses_on_squares_of_the_cells_size() {
    let mut mesh = block();
    add_node_group(&mut mesh, "tool", |[x, y, z]| {
        x == 0.0 && y == 0.0 && z > 0.5
    });
    let mut problem = body(linear(YOUNGS_MODULUS, 0.3));
    problem.loads = vec![load("tool", LoadKind::Force([0.3, 0.0, 0.4]))];
    let model = build(&mesh, &problem);
    figure("force", model.scales().unwrap().pressure, 25.0, 1e-9);
}
