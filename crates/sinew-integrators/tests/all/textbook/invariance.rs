//! Invariance of results under changes of units, numbering and the order of a tetrahedron's vertices, and their scaling
//! with modulus and density.

use proptest::prelude::*;
use sinew_cnn::{Saturation, Templates};
use sinew_core::{Integrator, State};
use sinew_fem::{LoadKind, Model};
use sinew_integrators::Frame;
use sinew_integrators::cnn::Cnn;
use sinew_testkit::body::{Body, bodies, fastest_time, orders, turned, turns};
use sinew_testkit::dense::{Dense, ROUNDING, dense};

fn templates(model: &Model) -> Templates {
    Templates::new(model).unwrap()
}

fn flat(rows: &Dense) -> Vec<f64> {
    rows.concat()
}

/// Initial motion of a body, and the steps in which it is followed.
#[derive(Clone, Copy)]
struct Motion {
    /// The largest first displacement; velocities are such that a step moves as far.
    u: f64,
    dt: f64,
    /// Q over the largest first velocity: below 1, some are saturated.
    share: f64,
}

impl Motion {
    /// A motion within the stable step of a model.
    fn of(model: &Model, share: f64) -> Self {
        let dt = 0.3 * fastest_time(model);
        Self { u: 1e-4, dt, share }
    }

    /// The displacements after each of twenty steps of the paper's network.
    fn follow(self, body: &Body, model: &Model) -> Dense {
        let v = self.u / self.dt;
        let mut network = Frame::new(Cnn(Saturation::at(self.share * v).unwrap()));
        let mut state: State = body.state(model, self.u, v);
        let mut step = || {
            network.step(model, &mut state, self.dt).unwrap();
            state.u.clone()
        };
        (0..20).map(|_| step()).collect()
    }
}

/// The largest difference of two trajectories over the largest displacement.
fn distance(a: &Dense, b: &Dense) -> f64 {
    let (a, b) = (flat(a), flat(b));
    let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    let sizes = b.iter().map(|b| b.abs());
    differences.fold(0.0, f64::max) / sizes.fold(0.0, f64::max)
}

fn scale_moduli(body: &mut Body, factor: f64) {
    for region in &mut body.problem.regions {
        region.law.scale_stiffness(factor);
    }
}

/// The same body in mm, N, s and tonnes, in which moduli are N/mm^2.
fn in_millimetres(mut body: Body) -> Body {
    for coordinate in body.mesh.points.as_flattened_mut() {
        *coordinate *= 1e3;
    }
    scale_moduli(&mut body, 1e-6);
    for region in &mut body.problem.regions {
        region.density *= 1e-12;
    }
    for load in &mut body.problem.loads {
        if let LoadKind::Traction(traction) = &mut load.kind {
            *traction = traction.map(|part| 1e-6 * part);
        }
    }
    let gravity = &mut body.problem.gravity;
    *gravity = gravity.map(|gravity| gravity.map(|part| 1e3 * part));
    body
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn twice_the_modulus_is_twice_the_feedback(body in bodies()) {
        let mut stiffer = body.clone();
        scale_moduli(&mut stiffer, 2.0);
        let a = dense(&templates(&body.model()).feedback());
        let twice = dense(&templates(&stiffer.model()).feedback());
        for (a, twice) in flat(&a).into_iter().zip(flat(&twice)) {
            prop_assert_eq!(2.0 * a, twice);
        }
    }

    #[test]
    fn twice_the_density_is_half_the_feedback_and_half_the_control(body in bodies()) {
        let mut heavier = body.clone();
        for region in &mut heavier.problem.regions {
            region.density *= 2.0;
        }
        let (light, heavy) = (templates(&body.model()), templates(&heavier.model()));
        let (a, half) = (dense(&light.feedback()), dense(&heavy.feedback()));
        for (a, half) in flat(&a).into_iter().zip(flat(&half)) {
            prop_assert_eq!(0.5 * a, half);
        }
        for (b, half) in light.control().iter().zip(heavy.control()) {
            prop_assert_eq!(0.5 * b, half);
        }
    }

    #[test]
    fn millimetres_give_the_motion_of_metres(body in bodies(), share in 0.2..2.0) {
        let model = body.model();
        let motion = Motion::of(&model, share);
        let scaled = in_millimetres(body.clone());
        let in_mm = Motion { u: 1e3 * motion.u, ..motion }.follow(&scaled, &scaled.model());
        let mut expected = motion.follow(&body, &model);
        expected.iter_mut().flatten().for_each(|u| *u *= 1e3);
        let distance = distance(&in_mm, &expected);
        prop_assert!(distance <= 1e-10, "{distance:e}");
    }

    #[test]
    fn renumbering_permutes_the_feedback_and_the_motion(
        (body, order) in bodies().prop_flat_map(|body| {
            let order = orders(body.mesh.points.len());
            (Just(body), order)
        }),
        share in 0.2..2.0,
    ) {
        let other = body.clone().renumbered(&order);
        let (model, other_model) = (body.model(), other.model());
        // Where each degree of freedom of the other model stands in the first.
        let cell = |node: &u32| model.cell_of_node(order[*node as usize]).unwrap() as usize;
        let cells = other_model.nodes().iter().map(cell);
        let place: Vec<usize> = cells.flat_map(|cell| 3 * cell..3 * cell + 3).collect();

        let a = dense(&templates(&model).feedback());
        for (i, row) in dense(&templates(&other_model).feedback()).iter().enumerate() {
            let size = a[place[i]][place[i]].abs();
            for (j, entry) in row.iter().enumerate() {
                let expected = a[place[i]][place[j]];
                prop_assert!((entry - expected).abs() <= ROUNDING * size, "({i}, {j})");
            }
        }

        let motion = Motion::of(&model, share);
        let permuted = |u: &Vec<f64>| place.iter().map(|dof| u[*dof]).collect();
        let expected = motion.follow(&body, &model).iter().map(permuted).collect();
        let distance = distance(&motion.follow(&other, &other_model), &expected);
        prop_assert!(distance <= 1e-12, "{distance:e}");
    }

    #[test]
    fn even_permutations_of_a_tetrahedron_change_nothing(
        (body, turns) in bodies().prop_flat_map(|body| {
            let turns = turns(body.mesh.tets.len());
            (Just(body), turns)
        }),
        share in 0.2..2.0,
    ) {
        let mut other = body.clone();
        other.mesh = turned(other.mesh, &turns);
        let (model, other_model) = (body.model(), other.model());
        let (before, after) = (templates(&model), templates(&other_model));
        for (before, after) in [
            (dense(&before.feedback()), dense(&after.feedback())),
            (dense(&before.damping()), dense(&after.damping())),
        ] {
            for (i, (before, after)) in before.iter().zip(&after).enumerate() {
                let size = before[i].abs();
                for (before, after) in before.iter().zip(after) {
                    prop_assert!((before - after).abs() <= 1e-12 * size, "row {i}");
                }
            }
        }
        let motion = Motion::of(&model, share);
        let expected = motion.follow(&body, &model);
        let distance = distance(&motion.follow(&other, &other_model), &expected);
        prop_assert!(distance <= 1e-12, "{distance:e}");
    }
}
