//! Sessions: the effects of commands, and errors.

use crate::common::{CUBE, scene, session};
use sinew_core::{LinearModel, LinearOperators, Load, Options, Ramp, Run, State, simulate};
use sinew_testkit::scenes::ROLLED;
use sinew_tools::Pose;
use sinew_world::{Command, CommandError, Ended, World, WorldStepError};

fn steps(session: &mut World, count: usize) {
    for _ in 0..count {
        session.step().unwrap();
    }
}

fn pose(tool: &str, position: [f64; 3]) -> Command {
    Command::Pose {
        tool: tool.into(),
        position,
        rotation_vector: [0.0; 3],
    }
}

fn other(id: &str) -> Command {
    Command::Integrator {
        id: id.to_owned(),
        options: Options::new(),
    }
}

#[test]
fn without_commands_it_is_the_run_of_the_scene() {
    let mut simulation = scene(CUBE).build().unwrap();
    simulation.end_at_duration();
    let mut integrator = simulation.integrator().unwrap();
    let mut expected = simulation.initial_state().clone();
    let run = simulation.run();
    simulate(
        simulation.system(),
        &mut *integrator,
        &mut expected,
        &run,
        &mut (),
    )
    .unwrap();
    let mut session = session(CUBE);
    steps(&mut session, run.steps);
    // Tools that may be told to hold have room for what they hold.
    let (found, reached) = (session.state(), (&expected.u, &expected.v, expected.clock));
    assert!((&found.u, &found.v, found.clock) == reached);
    let tools = simulation.model().tools().unwrap();
    assert!(tools.report(&expected, 0).contacts > 0, "the ball touches");
}

#[test]
fn ids_of_another_world_are_refused_as_such() {
    let whole = session(CUBE);
    let (plate, load) = (whole.tool("plate").unwrap(), whole.load("gravity").unwrap());
    let (head, run) = (
        CUBE.split("[[load]]\ngroup = \"sides\"").next().unwrap(),
        &CUBE[CUBE.find("[run]").unwrap()..],
    );
    let mut bare = session(&format!("{head}{run}"));
    let steered = bare.steer(plate, [0.0; 3], [0.0; 3]);
    assert!(matches!(steered, Err(CommandError::ForeignId)));
    let scaled = bare.scale_load(load, 0.5);
    assert!(matches!(scaled, Err(CommandError::ForeignId)));
    assert!(bare.log().entries().is_empty());
}

/// An id means the same in each world of its scene, and is not valid in those of other scenes, even if they have a tool
/// with this index.
#[test]
fn ids_are_of_a_scene_and_not_of_the_place_in_its_list() {
    let (own, mut same) = (session(CUBE), session(CUBE));
    let mut other = session(&CUBE.replace("\"ball\"", "\"hammer\""));
    let (ball, pull) = (own.tool("ball").unwrap(), own.load("pull").unwrap());
    let steered = other.steer(ball, [0.04, 0.04, 0.2], [0.0; 3]);
    assert!(matches!(steered, Err(CommandError::ForeignId)));
    let scaled = other.scale_load(pull, 0.5);
    assert!(matches!(scaled, Err(CommandError::ForeignId)));
    assert!(other.log().entries().is_empty());
    assert!(other.tool_report(ball).is_none() && other.tool_gap(ball).is_none());
    assert_eq!(other.tool_pose(ball), Pose::identity());
    same.steer(ball, [0.04, 0.04, 0.2], [0.0; 3]).unwrap();
    same.scale_load(pull, 0.5).unwrap();
    assert!(same.tool_report(ball).is_some());
    assert_eq!(same.tools().next(), Some(ball));
}

#[test]
fn a_time_that_is_past_or_none_is_refused() {
    let mut world = session(CUBE);
    world.advance_to(0.1, &mut ()).unwrap();
    let before = world.save();
    for t in [0.05, -1.0, f64::NAN, f64::NEG_INFINITY, f64::INFINITY] {
        let refused = world.advance_to(t, &mut ()).expect_err("a past time");
        let said = refused.to_string();
        let from = format!("t = {t} s: expected a finite time from {} s on", world.t());
        assert_eq!(said, from);
        assert!(world.save() == before);
    }
    for t in [0.1, world.t()] {
        assert_eq!(world.advance_to(t, &mut ()).unwrap(), Ended::Finished);
        assert!(world.save() == before);
    }
    // A time that the last step passed is reached.
    world.advance_to(0.1005, &mut ()).unwrap();
    let t = world.t();
    world.advance_to(0.101, &mut ()).unwrap();
    assert_eq!(world.t(), t);
}

#[test]
fn a_tool_goes_where_it_is_told_and_stays() {
    let mut session = session(CUBE);
    steps(&mut session, 10);
    let place = [0.04, 0.02, 0.066];
    session.command(pose("ball", place)).unwrap();
    let ball = session.tool("ball").unwrap();
    let (t, before) = (session.t(), session.tool_pose(ball));
    steps(&mut session, 1);
    assert_eq!(session.tool_pose(ball).position(), place);
    steps(&mut session, 500);
    assert_eq!(session.tool_pose(ball).position(), place);
    assert!(
        session.tool_report(ball).unwrap().force[2] > 0.01,
        "it presses"
    );
    let tools = session.body().model().tools().unwrap();
    let own = &tools.tools()[0].motion;
    let still_there = own.at(t, session.inputs()).position()[2];
    assert!((still_there - before.position()[2]).abs() < 1e-15);
}

#[test]
fn a_tip_that_is_led_between_nodes_far_from_its_path_does_not_pass_through() {
    let text = CUBE
        .replace("radius = 0.012", "radius = 0.002")
        .replace("velocity = [0.0, 0.0, -0.05]", "hold = true")
        .replace("start = [0.04, 0.04, 0.08]", "start = [0.034, 0.03, 0.3]");
    let mut session = session(&text);
    for depth in 0..10 {
        let z = 0.064 - 1e-3 * f64::from(depth);
        session.command(pose("ball", [0.034, 0.03, z])).unwrap();
        steps(&mut session, 1);
    }
    let ball = session.tool("ball").unwrap();
    let report = session.tool_report(ball).unwrap();
    assert!(report.contacts > 0 && report.force[2] > 0.0, "{report:?}");
}

#[test]
fn sessions_are_sent_to_other_threads() {
    fn is_send<T: Send>() {}
    is_send::<World>();
}

#[test]
fn a_method_that_no_tool_can_push_is_refused_and_the_session_goes_on() {
    let (mut session, mut undisturbed) = (session(CUBE), session(CUBE));
    for session in [&mut session, &mut undisturbed] {
        steps(session, 30);
    }
    for id in ["rk4", "newmark", "cnn"] {
        let said = session.command(other(id)).unwrap_err().to_string();
        assert!(
            said.contains(id) && said.contains("symplectic-euler"),
            "{said}"
        );
    }
    let unknown = session.command(other("simplectic")).unwrap_err();
    assert!(
        unknown
            .to_string()
            .contains("unknown integrator `simplectic`")
    );
    for session in [&mut session, &mut undisturbed] {
        steps(session, 30);
    }
    assert!(session.state() == undisturbed.state());
    assert!(session.log().entries().is_empty());
    assert_eq!(session.integrator().id(), "symplectic-euler");
}

#[test]
fn a_reset_begins_again_and_counts_on() {
    let mut session = session(CUBE);
    steps(&mut session, 40);
    let expected = session.state().clone();
    session.command(pose("ball", [0.03, 0.03, 0.06])).unwrap();
    session.command(other("cnn-stabilised")).unwrap();
    session.command(Command::Dt(0.01)).unwrap();
    steps(&mut session, 20);
    session.command(Command::Reset).unwrap();
    assert_eq!(
        (session.t(), session.steps(), session.dt()),
        (0.0, 60, 0.002)
    );
    steps(&mut session, 40);
    assert!(*session.state() == expected);
    assert_eq!(session.steps(), 100);
}

fn factor(load: &str, factor: f64) -> Command {
    Command::LoadFactor {
        load: load.into(),
        factor,
    }
}

#[test]
fn a_factor_of_one_changes_no_bit() {
    for method in ["symplectic-euler", "central-difference", "cnn-stabilised"] {
        let text = CUBE.replace("symplectic-euler", method);
        let (mut driven, mut plain) = (session(&text), session(&text));
        steps(&mut driven, 40);
        driven.command(factor("pull", 1.0)).unwrap();
        steps(&mut driven, 40);
        steps(&mut plain, 80);
        assert!(driven.state() == plain.state(), "{method}");
    }
}

/// m u'' + d u' + k u = f, with f twice as large from .1 s on.
#[test]
fn a_factor_is_a_load_that_jumps() {
    let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 0.0\nforce = 2.0\n[run]\nduration = 1.0\n\
                integrator = \"central-difference\"\ndt = 0.01\n";
    for method in [
        "central-difference",
        "symplectic-euler",
        "newmark",
        "rk4",
        "cnn",
        "propagator",
    ] {
        let text = text.replace("central-difference", method);
        let mut session = session(&text);
        steps(&mut session, 10);
        session.command(factor("force", 2.0)).unwrap();
        steps(&mut session, 30);
        let load = Load {
            ramp: Ramp::Hold {
                times: vec![0.0, 0.1],
                values: vec![1.0, 2.0],
            },
            entries: vec![(0, 2.0)],
        };
        let operators = LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap();
        let model = LinearModel::new(operators.with_loads(vec![load]).unwrap());
        let mut integrator = sinew_integrators::build(method, &Options::new()).unwrap();
        let mut expected = State::at_rest(1);
        let run = Run::covering(0.4, 0.01);
        simulate(&model, &mut *integrator, &mut expected, &run, &mut ()).unwrap();
        let (found, expected) = (session.state().u[0], expected.u[0]);
        assert!(
            (found / expected - 1.0).abs() < 1e-12,
            "{method}: {found} {expected}"
        );
        assert!(found > 0.03, "{method}: 20 mm were the load at once");
    }
}

#[test]
fn gravity_and_loads_without_a_name_are_driven() {
    let mut session = session(CUBE);
    let names = session.body().load_names();
    assert_eq!(names, ["pull", "load 2", "gravity"]);
    session.command(Command::Dt(0.001)).unwrap();
    for name in names {
        session.command(factor(&name, 0.0)).unwrap();
    }
    steps(&mut session, 50);
    assert!(session.state().u.iter().all(|u| *u == 0.0), "nothing pulls");
    session.command(factor("gravity", -1.0)).unwrap();
    steps(&mut session, 50);
    let upwards = session.state().u.iter().skip(2).step_by(3);
    assert!(upwards.clone().all(|u| *u > 0.0), "it falls upwards");
}

#[test]
fn a_reset_gives_loads_back_to_the_scene() {
    let (mut driven, mut plain) = (session(CUBE), session(CUBE));
    driven.command(factor("gravity", 3.0)).unwrap();
    steps(&mut driven, 20);
    driven.command(Command::Reset).unwrap();
    steps(&mut driven, 30);
    steps(&mut plain, 30);
    assert!(driven.state() == plain.state());
}

#[test]
fn methods_that_must_know_loads_beforehand_refuse_factors_by_name() {
    let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 0.0\nforce = 2.0\n[run]\nduration = 1.0\n\
                integrator = \"modal\"\ndt = 0.01\n";
    let (mut session, mut undisturbed) = (session(text), session(text));
    steps(&mut session, 10);
    let checked = session.check(&factor("force", 2.0)).unwrap_err();
    let given = session.command(factor("force", 2.0)).unwrap_err();
    for said in [checked.to_string(), given.to_string()] {
        assert!(
            said.contains("`modal` needs loads that are known before the run"),
            "{said}"
        );
    }
    steps(&mut session, 10);
    steps(&mut undisturbed, 20);
    assert!(session.state() == undisturbed.state());
    // The other way round.
    session.command(other("newmark")).unwrap();
    session.command(factor("force", 2.0)).unwrap();
    steps(&mut session, 1);
    assert!(session.command(other("modal")).is_err());
    steps(&mut session, 1);
}

#[test]
fn commands_that_make_no_sense_are_refused_by_what_is_wrong() {
    let mut session = session(CUBE);
    steps(&mut session, 3);
    let before = session.state().clone();
    let nan = f64::NAN;
    for (command, said) in [
        (
            pose("needle", [0.0; 3]),
            "no tool is named \"needle\"; there are \"ball\", \"plate\"",
        ),
        (
            pose("ball", [0.0, nan, 0.0]),
            "pose of \"ball\": NaN: expected finite numbers, at most 1e6 m or rad in size",
        ),
        (
            pose("ball", [0.0, 0.0, 1e7]),
            "pose of \"ball\": 10000000.0: expected finite numbers, at most 1e6 m or rad in size",
        ),
        (
            factor("push", 1.0),
            "no load is named \"push\"; there are \"pull\", \"load 2\", \"gravity\"",
        ),
        (
            factor("pull", f64::INFINITY),
            "factor of \"pull\": inf: expected a finite number, at most 1e6 in size",
        ),
        (
            Command::Dt(0.0),
            "dt = 0 s: expected a finite step above 0 that advances the time, 0.006 s",
        ),
        (
            Command::Dt(nan),
            "dt = NaN s: expected a finite step above 0 that advances the time, 0.006 s",
        ),
        (
            Command::Dt(1e-20),
            "dt = 0.00000000000000000001 s: expected a finite step above 0 that advances the time, 0.006 s",
        ),
        (
            Command::Cut {
                from: [[0.0; 3]; 2],
                to: [[0.0; 3]; 2],
            },
            "the scene has no table [cutting], so its body cannot be cut: add one",
        ),
    ] {
        assert_eq!(session.command(command).unwrap_err().to_string(), said);
    }
    assert!(session.log().entries().is_empty());
    assert!(*session.state() == before);
    steps(&mut session, 1);
}

#[test]
fn a_motion_that_diverges_ends_by_name_and_can_be_reset() {
    let mut session = session(CUBE);
    session.command(Command::Dt(0.2)).unwrap();
    let failed = (0..1000).find_map(|_| session.step().err()).unwrap();
    assert!(
        matches!(failed, WorldStepError::Diverged { .. }),
        "{failed}"
    );
    assert_eq!(session.step().unwrap_err().to_string(), failed.to_string());
    let said = session.command(Command::Dt(0.001)).unwrap_err().to_string();
    assert_eq!(said, "the last step failed: reset to continue");
    session.command(Command::Reset).unwrap();
    steps(&mut session, 10);
    assert!(session.failure().is_none());
}

/// A run takes one step instead that ends with the duration; a session steered by the user has no end.
#[test]
fn a_step_longer_than_the_duration_is_refused_at_its_line() {
    let text = CUBE.replace("dt = 0.002", "dt = 100.0");
    let line = 1 + text.lines().position(|line| line == "dt = 100.0").unwrap();
    let refused = World::new(scene(&text)).err().unwrap();
    assert_eq!(
        refused.to_string(),
        format!(
            "cube.toml:{line}: [run]: dt = 100 s is longer than the duration, 0.3 s: expected a step within it"
        )
    );
}

/// The cube has no supports, so that each of its pieces is loose.
#[test]
fn a_cut_that_leaves_nothing_fails_by_name_and_leaves_the_body_before_it() {
    let held = "[[fixed]]\ngroup = \"bottom\"\n";
    let text = CUBE
        .replace(held, "")
        .replace("[run]", "[cutting]\npieces = \"remove\"\n[run]");
    let mut session = session(&text);
    steps(&mut session, 3);
    let before = session.state().clone();
    let blade = |x: f64| [[x, -0.1, 0.03], [x, 0.1, 0.03]];
    let cut = |from: f64, to: f64| Command::Cut {
        from: blade(from),
        to: blade(to),
    };
    // The second sheet meets what the first left.
    session.command(cut(-0.1, 0.2)).unwrap();
    session.command(cut(0.2, -0.1)).unwrap();
    let failed = session.step().unwrap_err();
    assert!(matches!(failed, WorldStepError::Cutting(_)), "{failed}");
    assert_eq!(failed.to_string(), "nothing that moves is left of the body");
    assert!(*session.state() == before);
    assert_eq!(session.body().system().dofs(), before.u.len());
    session.command(Command::Reset).unwrap();
    steps(&mut session, 3);
    assert!(session.state().u == before.u);
}

#[test]
fn a_session_tells_where_its_body_is_in_itself() {
    let mut rolled = session(ROLLED);
    let told = rolled.overlap().unwrap();
    assert!((0.003..=0.005).contains(&told.depth), "{told}");
    rolled.step().unwrap();
    assert_eq!(rolled.overlap().unwrap().t, 0.001);
    assert_eq!(session(CUBE).overlap(), None);
}
