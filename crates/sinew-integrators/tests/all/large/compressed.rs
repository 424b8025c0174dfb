//! Blocks that a moved support compresses far, in steps that are divided by their stiffness.

use crate::common::tissue::{body, held};
use crate::common::{build, plain};
use sinew_core::{ElasticLaw, Inputs, LoadTime, Ramp, StableStep, State, System, Trial};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::{Course, Element, Law, Model, Moving};
use sinew_integrators::explicit::Substeps;
use sinew_mesh::structured::{self, Split};

const EDGE: Element = Element::FbarEdge {
    edge_share: 0.9,
    patch: None,
};

/// A block of 60 by 60 by 100 mm whose top moves by `displacement` (m) within `rise` (s).
fn block(
    cells: [usize; 3],
    (law, poissons_ratio, element): (&'static str, f64, Element),
    (displacement, rise): ([f64; 3], f64),
) -> Model {
    let mesh = structured::block(cells, [0.06, 0.06, 0.1], Split::Kuhn).unwrap();
    let parameters = Parameters::new(4000.0, poissons_ratio);
    let mut problem = body(Law::hyperelastic(law, parameters));
    problem.regions[0].element = element;
    problem.fixed = vec![held("bottom", [true; 3])];
    let ramp = Ramp::Sin2 { rise };
    problem.moves = vec![Moving::new("top", [Course::new(displacement, ramp)])];
    Model::build(&mesh, &problem).unwrap()
}

/// Kinetic and elastic energy (J) while the supports are at rest.
fn energy(model: &Model, state: &State) -> f64 {
    let mut v = vec![0.0; state.u.len()];
    state.velocity_at_t(model, Inputs::none(), &mut v).unwrap();
    let trial = Trial::of(state, LoadTime::at(state.t()));
    let elastic = model.elastic_force(&trial, &mut vec![0.0; v.len()]);
    let moving = v.iter().zip(model.mass());
    elastic.unwrap().energy + moving.map(|(v, mass)| 0.5 * mass * v * v).sum::<f64>()
}

/// Supports at rest do no work: from the end of the rise on the body has the same energy as with fixed steps of a tenth
/// of the stable one. In tissue compressed to 60 % of its height, between two checks the fastest motion became a third
/// faster in time than the diagonal blocks of the cells show.
#[test]
fn compressed_tissue_gets_no_energy_from_steps_that_are_cut_by_its_stiffness() {
    let duration = 1.07;
    let down = |way: f64, rise| ([0.0, 0.0, -way], rise);
    for (cells, law, motion) in [
        ([3, 3, 5], ("neo-hookean", 0.45, EDGE), down(0.04, 0.25)),
        ([2, 2, 4], ("neo-hookean", 0.45, EDGE), down(0.033, 0.1)),
        (
            [2, 2, 4],
            ("stable-neo-hookean", 0.45, EDGE),
            down(0.033, 0.1),
        ),
        ([2, 2, 4], ("neo-hookean", 0.45, EDGE), down(0.04, 0.25)),
        // Strains that pass by within a part.
        ([2, 2, 4], ("stvk", 0.48, Element::P1), down(0.04, 0.1)),
        (
            [2, 2, 4],
            ("neo-hookean", 0.48, Element::P1),
            ([0.03, 0.03, 0.03], 0.1),
        ),
    ] {
        let model = block(cells, law, motion);
        let rest = build("central-difference", &plain()).stable_step(&model);
        let Ok(StableStep::UpTo(rest)) = rest else {
            panic!("{rest:?}");
        };
        let (mut fine, mut expected) = (
            build("central-difference", &plain()),
            State::at_rest(model.dofs()),
        );
        while expected.t() <= motion.1 {
            fine.step(&model, &mut expected, 0.1 * rest).unwrap();
        }
        let expected = energy(&model, &expected);

        let dt = Substeps::longest_part(duration / 50.0, 2.0 * rest);
        let mut integrator = build("central-difference", &plain().with_text("substeps", "auto"));
        let mut state = State::at_rest(model.dofs());
        let mut most = 0.0_f64;
        while state.t() < duration - 0.5 * dt {
            integrator.step(&model, &mut state, dt).unwrap();
            if state.t() > motion.1 {
                most = most.max(energy(&model, &state));
            }
        }
        let made = most / expected - 1.0;
        assert!(made < 0.005, "{cells:?} {law:?} {motion:?}: {made}");
    }
}

/// A motion that once needed many substeps does not need them permanently.
#[test]
fn steps_are_cut_into_fewer_parts_again_once_a_while_has_needed_fewer() {
    let law = ("neo-hookean", 0.45, EDGE);
    let model = block([2, 2, 4], law, ([0.0, 0.0, -0.005], 0.1));
    let rest = build("central-difference", &plain()).stable_step(&model);
    let Ok(StableStep::UpTo(rest)) = rest else {
        panic!("{rest:?}");
    };
    let dt = Substeps::longest_part(1.0, 2.0 * rest);
    let after = |disturbed: Option<u32>, steps: usize| {
        let mut integrator = build("central-difference", &plain().with_text("substeps", "auto"));
        let mut state = State::at_rest(model.dofs());
        for step in 0..steps {
            integrator.step(&model, &mut state, dt).unwrap();
            let cut = state.cut.as_mut().unwrap();
            if let Some(parts) = disturbed.filter(|_| step == 9) {
                cut.parts = parts;
            }
        }
        state
    };
    let parts = |state: &State| state.cut.unwrap().parts;
    let (usual, soon, later) = (after(None, 80), after(Some(12), 20), after(Some(12), 80));
    assert_eq!(parts(&soon), 12);
    assert_eq!(parts(&later), parts(&usual));
    assert!(parts(&usual) <= 3, "{}", parts(&usual));
    let mut fine = (
        build("central-difference", &plain()),
        State::at_rest(model.dofs()),
    );
    for _ in 0..80 * 20 {
        fine.0.step(&model, &mut fine.1, dt / 20.0).unwrap();
    }
    let error = |state: &State| {
        let off = state.u.iter().zip(&fine.1.u).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max)
    };
    let [usual, later] = [usual, later].map(|state| error(&state));
    assert!(later < 1.2 * usual, "{later} m, and {usual} m");
}
