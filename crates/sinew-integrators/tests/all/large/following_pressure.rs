//! Pressure that follows the surface of bodies in large deformation.

use crate::common::{build, plain};
use sinew_core::{
    BlockMatrix, ElasticLaw, ForceLaw, Inputs, LoadTime, Options, Pattern, State, StaticLoad,
    System, Trial,
};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Element, Fixed, Law, LoadKind, LoadSpec, Model, On, Problem, Region};
use sinew_integrators::static_solution_under;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};
use sinew_mesh::vector::cross;

const SIZE: f64 = 0.1;

/// Groups of all surfaces of a block.
const ALL_ROUND: [&str; 3] = ["bottom", "sides", "top"];

fn block(cells: usize) -> TetMesh {
    structured::cube(cells, SIZE, Split::Kuhn).unwrap()
}

fn neo_hookean(element: Element) -> Region {
    Region::new(
        Law::hyperelastic("neo-hookean", Parameters::new(3500.0, 0.45)),
        1060.0,
    )
    .with_element(element)
}

fn load(group: &str, kind: LoadKind) -> LoadSpec {
    LoadSpec::new(group, kind)
}

/// A body under pressure (Pa) on these groups.
fn pressed(element: Element, pressure: f64, groups: &[&str]) -> Problem {
    let loads = groups.iter();
    let loads = loads.map(|group| load(group, LoadKind::FollowingPressure(pressure)));
    Problem {
        regions: vec![neo_hookean(element)],
        loads: loads.collect(),
        ..Problem::default()
    }
}

/// A displacement (m) of the degrees of freedom as a function of the position of their nodes.
fn displaced(model: &Model, by: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
    let points = model.nodes().iter();
    let points = points.map(|node| model.mesh().points[*node as usize]);
    points.flat_map(by).collect()
}

/// Bent and stretched by a third.
fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        0.3 * x + 0.02 * (20.0 * z).sin(),
        -0.2 * y + 1.5 * x * z,
        0.01 * (30.0 * y).cos() - 2.0 * x * y,
    ]
}

fn external(model: &Model, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    ForceLaw::external_force(model, LoadTime::at(0.0), u, &mut force);
    force
}

/// Volume (m^3) of the displaced body.
fn volume(model: &Model, u: &[f64]) -> f64 {
    let mut mesh = model.mesh().clone();
    for (point, u) in mesh.points.iter_mut().zip(u.as_chunks::<3>().0) {
        for (x, u) in point.iter_mut().zip(u) {
            *x += u;
        }
    }
    mesh.signed_volumes().iter().sum()
}

#[test]
fn pressure_all_round_pulls_and_turns_nothing_in_any_shape() {
    let model = Model::build(&block(3), &pressed(Element::P1, 500.0, &ALL_ROUND)).unwrap();
    let u = displaced(&model, bent);
    let force = external(&model, &u);
    let points = model.mesh().points.iter();
    let places = points.zip(u.as_chunks::<3>().0);
    let places = places.map(|(point, u)| [0, 1, 2].map(|k| point[k] + u[k]));
    let (mut sum, mut moment, mut size) = ([0.0; 3], [0.0; 3], 0.0);
    for (place, force) in places.zip(force.as_chunks::<3>().0) {
        let turning = cross(place, *force);
        for k in 0..3 {
            sum[k] += force[k];
            moment[k] += turning[k];
            size += force[k].abs();
        }
    }
    for k in 0..3 {
        assert!(sum[k].abs() < 1e-14 * size, "{sum:?} of {size}");
        assert!(moment[k].abs() < 1e-15 * size, "{moment:?} of {size}");
    }
}

/// The work of a pressure p all round is -p times the change of the volume.
#[test]
fn forces_of_pressure_all_round_are_the_gradient_of_the_volume_and_their_stiffness_is_symmetric() {
    let pressure = 500.0;
    let model = Model::build(&block(2), &pressed(Element::P1, pressure, &ALL_ROUND)).unwrap();
    let u = displaced(&model, bent);
    let force = external(&model, &u);
    let at = |dof: usize, h: f64| {
        let mut moved = u.clone();
        moved[dof] += h;
        moved
    };
    let mut stiffness = BlockMatrix::zeros(ElasticLaw::pattern(&model).clone(), model.layers());
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &u,
        v: &vec![0.0; u.len()],
        internal: &[],
    };
    model
        .add_load_stiffness(&trial, 2.0, &mut stiffness)
        .unwrap();
    let (mut product, mut unit) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    let h = 1e-3 * SIZE;
    let size = force.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for dof in 0..u.len() {
        // The volume is cubic in all places together and linear in each.
        let slope = (volume(&model, &at(dof, h)) - volume(&model, &at(dof, -h))) / (2.0 * h);
        assert!(
            (force[dof] + pressure * slope).abs() < 1e-10 * size,
            "{dof}"
        );
        unit[dof] = 1.0;
        stiffness.multiply(&unit, &mut product);
        unit[dof] = 0.0;
        let [after, before] = [h, -h].map(|h| external(&model, &at(dof, h)));
        for ((after, before), product) in after.iter().zip(&before).zip(&product) {
            let expected = -(after - before) / h;
            assert!(
                (product - expected).abs() < 1e-9 * size / SIZE,
                "{dof}: {product} {expected}"
            );
        }
    }
}

/// Under pressure on one side alone the derivative has an unsymmetric part, which enters as products.
#[test]
fn the_derivative_of_pressure_on_one_side_is_the_sum_of_its_symmetric_and_its_skew_part() {
    let model = Model::build(&block(2), &pressed(Element::P1, 500.0, &["top"])).unwrap();
    let u = displaced(&model, bent);
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &u,
        v: &vec![0.0; u.len()],
        internal: &[],
    };
    let mut stiffness = BlockMatrix::zeros(ElasticLaw::pattern(&model).clone(), model.layers());
    model
        .add_load_stiffness(&trial, 1.0, &mut stiffness)
        .unwrap();
    let along = displaced(&model, |[x, y, z]| {
        [y - z, 2.0 * x * z, (40.0 * x).sin() * 0.1]
    });
    let (mut symmetric, mut skew) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    stiffness.multiply(&along, &mut symmetric);
    model.load_skew_product(&trial, 1.0, &along, &mut skew);
    let [after, before] = [0.5, -0.5].map(|h: f64| {
        let moved: Vec<f64> = u.iter().zip(&along).map(|(u, w)| u + h * w).collect();
        external(&model, &moved)
    });
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(largest(&skew) > 0.1 * largest(&symmetric));
    for (i, (after, before)) in after.iter().zip(&before).enumerate() {
        // Forces are quadratic, so that central differences are exact.
        let difference = symmetric[i] + skew[i] + after - before;
        assert!(
            difference.abs() < 1e-12 * largest(&symmetric),
            "{i}: {difference}"
        );
    }
}

#[test]
fn a_turned_body_has_its_forces_turned() {
    let model = Model::build(&block(2), &pressed(Element::P1, 500.0, &["top"])).unwrap();
    let still = external(&model, &vec![0.0; model.dofs()]);
    // By a right angle about x.
    let turned = displaced(&model, |[_, y, z]| [0.0, -z - y, y - z]);
    let force = external(&model, &turned);
    let size = still.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
    for (still, force) in still
        .as_chunks::<3>()
        .0
        .iter()
        .zip(force.as_chunks::<3>().0)
    {
        for (expected, found) in [still[0], -still[2], still[1]].iter().zip(force) {
            assert!((expected - found).abs() < 1e-14 * size);
        }
    }
    let mut dead = pressed(Element::P1, 500.0, &["top"]);
    dead.loads = vec![load("top", LoadKind::Pressure(500.0))];
    let dead = Model::build(&block(2), &dead).unwrap();
    assert_eq!(external(&dead, &turned), still);
}

/// Neo-hookean with E = 3500 Pa and nu = .45: nominal stress P at the stretch a in all directions, by its closed form. A pressure p acts on
/// the area a^2, so that P = -p a^2.
#[test]
fn a_cube_under_pressure_all_round_shrinks_as_the_closed_form_says() {
    let symmetric = |mesh: &TetMesh| -> Vec<Fixed> {
        let hold = |axis: usize| {
            let nodes = (0u32..).zip(&mesh.points);
            let nodes = nodes.filter(|(_, point)| point[axis] == 0.0);
            Fixed::at(On::Nodes(nodes.map(|(node, _)| node).collect()))
                .along([0, 1, 2].map(|other| other == axis))
        };
        (0..3).map(hold).collect()
    };
    let mesh = block(3);
    for (stretch, nominal) in [(0.8, -3935.54483), (0.9, -2639.12203)] {
        for element in [
            Element::P1,
            Element::FbarEdge {
                edge_share: 0.9,
                patch: None,
            },
        ] {
            let mut problem = pressed(element, -nominal / (stretch * stretch), &["sides", "top"]);
            problem.fixed = symmetric(&mesh);
            let model = Model::build(&mesh, &problem).unwrap();
            let u = static_solution_under(&model, &model.full_loads(&[0, 1])).unwrap();
            let expected = displaced(&model, |point| point.map(|x| (stretch - 1.0) * x));
            for (u, expected) in u.iter().zip(&expected) {
                assert!(
                    (u - expected).abs() < 2e-8 * SIZE,
                    "{element} {stretch}: {u} {expected}"
                );
            }
        }
    }
}

#[test]
fn supports_carry_what_the_pressure_on_the_deformed_surface_asks() {
    let pressure = 800.0;
    let mut problem = pressed(Element::P1, pressure, &["sides", "top"]);
    problem.fixed = vec![Fixed::at("bottom")];
    problem
        .loads
        .push(load("top", LoadKind::Traction([300.0, 0.0, 0.0])));
    let model = Model::build(&block(3), &problem).unwrap();
    let u = static_solution_under(&model, &model.full_loads(&[0, 1, 2])).unwrap();
    let mut reactions = vec![[0.0; 3]; model.mesh().points.len()];
    let v = vec![0.0; u.len()];
    model.reactions(0.0, &u, &v, &mut reactions).unwrap();
    // The surface with its bottom, which does not move, is closed: pressure on the rest pulls as one on the bottom pushes.
    let area = SIZE * SIZE;
    let expected = [-300.0 * area, 0.0, pressure * area];
    for (axis, expected) in expected.into_iter().enumerate() {
        let sum: f64 = reactions.iter().map(|reaction| reaction[axis]).sum();
        assert!(
            (sum - expected).abs() < 1e-6 * pressure * area,
            "{axis}: {sum} {expected}"
        );
    }
    let tilt = u.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    assert!(tilt > 0.05 * SIZE, "{tilt}");
}

/// With W the elastic energy, `T + W + p V` is constant under pressure all round, which a method of order 2 conserves
/// to order 2.
#[test]
fn a_body_that_breathes_under_pressure_keeps_its_energy() {
    let pressure = 1500.0;
    let model = Model::build(&block(2), &pressed(Element::P1, pressure, &ALL_ROUND)).unwrap();
    let rest = volume(&model, &vec![0.0; model.dofs()]);
    let worst_over = |id: &str, options: &Options, dt: f64| {
        let mut integrator = build(id, options);
        let mut state = State::at_rest(model.dofs());
        // Turns while it breathes.
        state.v = displaced(&model, |[_, y, z]| {
            [0.0, -4.0 * (z - 0.05), 4.0 * (y - 0.05)]
        });
        let energy = |state: &State, v: &[f64]| {
            let energy = model.energy(&state.u, v).unwrap();
            let work = pressure * (volume(&model, &state.u) - rest);
            [energy.kinetic + energy.elastic + work, energy.elastic]
        };
        let [first, _] = energy(&state, &state.v);
        let (mut worst, mut stored): (f64, f64) = (0.0, 0.0);
        for _ in 0..(0.1 / dt).round() as usize {
            integrator.step(&model, &mut state, dt).unwrap();
            let mut v = vec![0.0; state.v.len()];
            state.velocity_at_t(&model, Inputs::none(), &mut v).unwrap();
            let [total, elastic] = energy(&state, &v);
            worst = worst.max((total - first).abs());
            stored = stored.max(elastic);
        }
        worst / stored
    };
    for id in ["central-difference", "newmark"] {
        let [coarse, fine] = [4e-4, 2e-4].map(|dt| worst_over(id, &plain(), dt));
        assert!(
            coarse < 0.02 && (3.0..5.0).contains(&(coarse / fine)),
            "{id}: {coarse:.2e} {fine:.2e}"
        );
    }
}

/// A load that lags behind the surface is no load of constant direction: the trapezoidal rule would turn the difference
/// into energy.
#[test]
fn cellular_energy_steps_follow_a_surface_by_implicit_euler_alone() {
    let model = Model::build(&block(2), &pressed(Element::P1, 300.0, &ALL_ROUND)).unwrap();
    let of = |kind: &str| build("cnn-energy", &plain().with_text("kind", kind));
    let refused = of("trap").prepare(&model, 1e-3).unwrap_err().to_string();
    assert!(
        refused.contains("kind = \"ie\"") && refused.contains("`newmark`"),
        "{refused}"
    );
    of("ie").prepare(&model, 1e-3).unwrap();
}

/// A pressure on one side alone has an unsymmetric derivative at the rim, so that the iteration converges linearly.
#[test]
fn a_cube_finds_its_equilibrium_under_pressure_on_one_side() {
    for (cells, pressure) in [(2, -2500.0), (4, -1500.0), (4, 1500.0)] {
        let mut problem = pressed(Element::P1, pressure, &["top"]);
        problem.fixed = vec![Fixed::at("bottom")];
        let model = Model::build(&block(cells), &problem).unwrap();
        let u = static_solution_under(&model, &model.full_loads(&[0])).unwrap();
        let trial = Trial {
            load: LoadTime::at(0.0),
            dt: 0.0,
            u: &u,
            v: &vec![0.0; u.len()],
            internal: &[],
        };
        let mut left = vec![0.0; u.len()];
        model.net_force(&trial, &mut left).unwrap();
        let size = |force: &[f64]| force.iter().map(|f| f * f).sum::<f64>().sqrt();
        assert!(
            size(&left) < 1e-7 * size(&external(&model, &u)),
            "{pressure}"
        );
    }
}

#[test]
fn the_derivative_of_pressure_needs_a_matrix_with_the_couplings_of_its_surface() {
    let model = Model::build(&block(2), &pressed(Element::P1, 500.0, &ALL_ROUND)).unwrap();
    let u = displaced(&model, bent);
    let trial = Trial {
        load: LoadTime::at(0.0),
        dt: 0.0,
        u: &u,
        v: &vec![0.0; u.len()],
        internal: &[],
    };
    let cells = ElasticLaw::pattern(&model).cells();
    let alone = Pattern::from_elements(cells, (0..cells as u32).map(|cell| [cell])).unwrap();
    let mut diagonal = BlockMatrix::zeros(alone.into(), model.layers());
    for refused in [
        model.add_load_stiffness(&trial, 1.0, &mut diagonal),
        StaticLoad::add_stiffness(&model.full_loads(&[0]), &u, 1.0, &mut diagonal),
    ] {
        let reason = refused.unwrap_err().reason;
        assert!(reason.contains("not neighbours in the pattern"), "{reason}");
    }
}
