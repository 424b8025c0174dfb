//! The library with and without its features: scenes run the same, and without the feature `implicit`
//! a static state is refused.

use sinew::prelude::*;
use sinew::scene::SceneSource;

const PRESSED: &str = r#"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[[load]]
name = "press"
group = "top"
traction = [0.0, 0.0, -10.0]
[run]
duration = 0.1
integrator = "central-difference"
dt = "auto"
"#;

fn scene(initial: &str) -> Scene {
    let text = PRESSED.replace("[run]", &format!("{initial}\n[run]"));
    Scene::parse(SceneSource::new("pressed.toml", text)).unwrap()
}

#[test]
fn a_scene_runs_without_the_command() {
    let simulation = scene("").build().unwrap();
    let mut integrator = simulation.integrator().unwrap();
    let mut state = simulation.initial_state().clone();
    let report = simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &simulation.run(),
        &mut (),
    );
    assert_eq!(report.unwrap().outcome, Outcome::Finished);
    let lowest = state.u.iter().skip(2).step_by(3).copied();
    assert!(lowest.fold(0.0, f64::min) < 0.0, "the top gives way");
}

/// The loop of a simulator takes the prelude and [`sinew::integrators::build`].
#[test]
fn a_frame_loop_needs_no_other_import() {
    let mesh = structured::cube(2, 0.1, Split::Mirrored).unwrap();
    let mut inputs = Inputs::new();
    let clamp: Channel = inputs.add_channel(Between::Line);
    let problem = Problem::of([Region::new(Law::linear(3500.0, 0.4), 1060.0)])
        .with_damping(Rayleigh::new(5.0, 0.0))
        .with_fixed(Fixed::at("bottom"))
        .with_move(Moving::new(
            "top",
            [Course::new([0.0, 0.0, -0.01], Ramp::Input(clamp))],
        ));
    let model = Model::build(&mesh, &problem).unwrap();
    let options = Options::new().with_text("substeps", "auto");
    let method = sinew::integrators::build("central-difference", &options);
    let mut method: Box<dyn Stepper> = method.unwrap();
    let (mut state, mut hand) = (State::at_rest(model.dofs()), NodalForces::default());
    let mut stress = vec![[0.0; 6]; mesh.tets.len()];
    let (middle, _) = mesh.nearest_node([0.05; 3]);
    for frame in 1..=30 {
        let pull = (middle, [0.05, 0.0, 0.0]);
        model.forces_into(&[pull], &mut hand).unwrap();
        inputs.set_forces(state.t(), &hand.entries).unwrap();
        let end = f64::from(frame) * 0.016;
        inputs.set(clamp, end, end).unwrap();
        method
            .step_under(&model, &inputs, &mut state, 0.016)
            .unwrap();
        assert_eq!(worst_beyond(&state.u, 0.1), None);
        let now = LoadTime::at(state.t()).under(&inputs);
        model.stress(now, &state.u, &mut stress).unwrap();
    }
    assert!(stress.iter().map(von_mises).all(|stress| stress > 1.0));
}

const AT_REST: &str = "[[initial]]\nstatic = [\"press\"]";

#[test]
#[cfg(feature = "implicit")]
fn a_body_at_rest_under_its_load_stays_there() {
    let simulation = scene(AT_REST).build().unwrap();
    let state = simulation.initial_state();
    let mut force = vec![0.0; simulation.system().dofs()];
    let load = LoadTime::at(0.0);
    let trial = sinew::core::Trial {
        load,
        dt: 0.0,
        u: &state.u,
        v: &state.v,
        internal: &[],
    };
    simulation.system().net_force(&trial, &mut force).unwrap();
    let worst = force.iter().fold(0.0_f64, |worst, f| worst.max(f.abs()));
    // 0.1 N act on 0.01 m2.
    assert!(worst < 1e-12, "{worst} N");
}

#[test]
#[cfg(not(feature = "implicit"))]
fn without_implicit_methods_a_static_state_is_refused_on_its_line() {
    let error = scene(AT_REST).build().expect_err("nothing to solve with");
    assert_eq!(
        error.to_string(),
        "pressed.toml:16: [[initial]] 1: this program cannot solve for a static state: it was built without the \
         feature `implicit`"
    );
}
