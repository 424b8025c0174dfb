//! Laws of the templates A = -M^-1 K, C = M^-1 D and B = M^-1 of bodies at random.

use std::sync::Arc;

use proptest::prelude::*;
use sinew_cnn::Templates;
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, LinearSystem, LoadTime, Pattern,
    State, System,
};
use sinew_fem::{Fixed, Law, Model, Problem, Region};
use sinew_mesh::structured::{self, Split};
use sinew_testkit::body::bodies;
use sinew_testkit::dense::{ROUNDING, dense, dense_damping, row_product};

fn templates(model: &Model) -> Templates {
    Templates::new(model).unwrap()
}

/// A x = 0 for a motion x of the nodes, to rounding.
fn annihilates(model: &Model, motion: impl Fn([f64; 3]) -> [f64; 3], points: &[[f64; 3]]) {
    let x: Vec<f64> = points.iter().flat_map(|point| motion(*point)).collect();
    for (i, row) in dense(&templates(model).feedback()).iter().enumerate() {
        let (sum, size) = row_product(row, &x);
        assert!(
            sum.abs() <= ROUNDING * size,
            "row {i}: {sum:e} of terms that add up to {size:e}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn the_network_is_the_equation_of_motion(body in bodies(), t in 0.0..1.0) {
        let model = body.model();
        let (templates, operators) = (templates(&model), model.operators());
        let (a, c, b) = (dense(&templates.feedback()), dense(&templates.damping()), templates.control());
        let (k, d) = (dense(operators.stiffness()), dense_damping(operators));
        let State { u: y, v: x, .. } = body.state(&model, 1e-3, 1.0);
        let mut force = vec![0.0; model.dofs()];
        model.operators().external_force(LoadTime::at(t), &mut force);
        let mut sweep = vec![0.0; model.dofs()];
        templates.sweep(t, &y, &x, &mut sweep);
        for (i, mass) in operators.mass().iter().enumerate() {
            let (ay, size_ay) = row_product(&a[i], &y);
            let (cx, size_cx) = row_product(&c[i], &x);
            let control = b[i] * force[i];
            let network = ay - cx + control;
            let motion = (force[i] - row_product(&k[i], &y).0 - row_product(&d[i], &x).0) / mass;
            let rounding = ROUNDING * (size_ay + size_cx + control.abs());
            prop_assert!((network - motion).abs() <= rounding, "row {i}: {network:e} {motion:e}");
            prop_assert!((sweep[i] - motion).abs() <= rounding, "row {i}: {:e} {motion:e}", sweep[i]);
        }
    }

    #[test]
    fn a_sweep_is_the_net_force_over_the_mass_to_the_last_bit(body in bodies(), t in 0.0..1.0) {
        let model = body.model();
        let State { u, v, .. } = body.state(&model, 1e-3, 1.0);
        let mut force = vec![0.0; model.dofs()];
        model.operators().net_force(LoadTime::at(t), &u, &v, &mut force);
        let mut sweep = vec![0.0; model.dofs()];
        templates(&model).sweep(t, &u, &v, &mut sweep);
        for ((sweep, force), mass) in sweep.iter().zip(&force).zip(model.mass()) {
            prop_assert_eq!(sweep.to_bits(), (force / mass).to_bits());
        }
    }

    #[test]
    fn mass_times_feedback_is_symmetric(body in bodies()) {
        let model = body.model();
        let a = dense(&templates(&model).feedback());
        let ma = |i: usize, j: usize| model.mass()[i] * a[i][j];
        for i in 0..model.dofs() {
            for j in 0..i {
                let size = ma(i, i).abs().max(ma(j, j).abs());
                prop_assert!((ma(i, j) - ma(j, i)).abs() <= ROUNDING * size, "({i}, {j})");
            }
        }
    }

    #[test]
    fn feedback_annihilates_translations(body in bodies(), x in [-1.0..1.0, -1.0..1.0, -1.0..1.0]) {
        let body = body.free();
        annihilates(&body.model(), |_| x, &body.mesh.points);
    }

    #[test]
    fn feedback_annihilates_infinitesimal_rotations(
        body in bodies(),
        w in [-1.0..1.0, -1.0..1.0, -1.0..1.0],
    ) {
        let body = body.free();
        let turn = |[x, y, z]: [f64; 3]| {
            [w[1] * z - w[2] * y, w[2] * x - w[0] * z, w[0] * y - w[1] * x]
        };
        annihilates(&body.model(), turn, &body.mesh.points);
    }

    #[test]
    fn neighbourhoods_are_the_edges_of_the_mesh(body in bodies()) {
        let model = body.model();
        prop_assert_eq!(templates(&model).cells(), model.nodes().len());
        let pattern = model.operators().stiffness().pattern();
        let mut expected: Vec<Vec<u32>> = (0..model.nodes().len() as u32).map(|cell| vec![cell]).collect();
        for edge in body.mesh.edges() {
            if let [Some(a), Some(b)] = edge.map(|node| model.cell_of_node(node)) {
                expected[a as usize].push(b);
                expected[b as usize].push(a);
            }
        }
        for (cell, mut expected) in expected.into_iter().enumerate() {
            expected.sort_unstable();
            prop_assert_eq!(pattern.neighbours(cell), &expected[..], "cell {}", cell);
        }
    }

    #[test]
    fn rayleigh_damping_is_a_combination_of_identity_and_feedback(body in bodies()) {
        let body = body.without_dashpots();
        let model = body.model();
        let (a, c) = (dense(&templates(&model).feedback()), dense(&templates(&model).damping()));
        let (alpha, beta) = (body.problem.damping.mass, body.problem.damping.stiffness);
        for i in 0..model.dofs() {
            for j in 0..model.dofs() {
                let identity = if i == j { alpha } else { 0.0 };
                let expected = identity - beta * a[i][j];
                let size = alpha + beta * a[i][i].abs();
                prop_assert!((c[i][j] - expected).abs() <= ROUNDING * size, "({i}, {j})");
            }
        }
    }
}

#[test]
fn a_cell_without_mass_is_refused_by_name() {
    let pattern = Arc::new(Pattern::from_elements(2, [[0, 1]]).unwrap());
    let stiffness = || {
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
        stiffness
            .add_element(&[0, 1], &[1.0, -1.0, -1.0, 1.0])
            .unwrap();
        stiffness
    };
    for (mass, shown) in [
        (0.0, "0"),
        (-2.0, "-2"),
        (f64::NAN, "NaN"),
        (f64::INFINITY, "inf"),
    ] {
        let operators =
            LinearOperators::new(vec![1.0, mass], stiffness(), Damping::default(), vec![]);
        let error = Templates::new(&LinearModel::new(operators.unwrap())).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("degree of freedom 1 has a mass of {shown} kg: expected a finite mass above 0")
        );
    }
}

#[test]
fn a_node_of_no_tetrahedron_is_refused_by_its_tag() {
    let mut mesh = structured::cube(1, 0.1, Split::Kuhn).unwrap();
    mesh.points.push([1.0; 3]);
    mesh.node_tags.push(77);
    let problem = Problem::of([Region::new(Law::linear(1000.0, 0.3), 1000.0)])
        .with_fixed(Fixed::at("bottom"));
    let model = Model::build(&mesh, &problem).unwrap();
    assert_eq!(
        Templates::new(&model).unwrap_err().to_string(),
        "node 77 (x) has a mass of 0 kg: expected a finite mass above 0"
    );
}
