//! Advice on the scenes of the repository: correct when its run is repeated, and hard to beat.

use std::path::PathBuf;

use sinew_core::{Clock, LoadOverStep, OptionValue, Options, Run, StableStep, simulate};
use sinew_measure::search::Pilot;
use sinew_measure::{
    Advice, AdviceError, Answer, Case, Cost, Effort, LeftOut, MethodChoice, Question, Row, Span,
    advise, measure, on_one_thread,
};
use sinew_scene::{Scene, SceneSource, Simulation};

fn path(scene: &str) -> PathBuf {
    let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes.join(scene)
}

fn simulation(scene: &str) -> Simulation {
    Scene::load(path(scene)).unwrap().build().unwrap()
}

/// A question with enough time that nothing is cut short on any machine, and with costs that are the same on all.
fn question(tolerance: f64) -> Question {
    Question {
        pilot_seconds: 1e6,
        cost: Cost::Work,
        ..Question::new(tolerance)
    }
}

/// The paper's cube in 5 x 5 x 5 cells, on which many questions cost little.
fn small_cube() -> Simulation {
    let path = path("paper-cube.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let file = "file = \"../meshes/paper-cube.msh\"";
    assert!(text.contains(file));
    let cube = "cube = { cells = 5, edge = 0.2, split = \"kuhn\" }";
    let source = SceneSource::new(path, text.replace(file, cube));
    Scene::parse(source).unwrap().build().unwrap()
}

/// A cube that is pressed, with additional text at the end of its scene.
fn pressed_cube(cells: usize, rest: &str) -> Simulation {
    let text = pressed_text(cells, rest);
    let scene = Scene::parse(SceneSource::new("pressed.toml", text)).unwrap();
    scene.build().unwrap()
}

fn pressed_text(cells: usize, rest: &str) -> String {
    format!(
        "[mesh]
cube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}
[[region]]
group = \"tissue\"
density = 1060.0
model = \"linear\"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = \"sides\"
[[load]]
group = \"top\"
traction = [0.0, 0.0, -20.0]
ramp = {{ kind = \"step\" }}
{rest}"
    )
}

/// A cube that settles, and is pressed ten times as hard long after the end of the pilots' time.
fn pressed_late() -> Simulation {
    pressed_cube(
        6,
        "[damping]
mass = 2.0
[[load]]
group = \"top\"
traction = [0.0, 0.0, -200.0]
ramp = { kind = \"pulse\", from = 300.13, to = 300.33 }
[run]
duration = 400.0
samples = 4000
integrator = \"propagator\"
dt = 0.1
",
    )
}

/// Time for pilots in which only a small part of a long scene can be followed.
fn hasty(tolerance: f64) -> Question {
    Question {
        pilot_seconds: 1.0,
        ..Question::new(tolerance)
    }
}

fn advised(advice: &Advice) -> &Pilot {
    match &advice.answer {
        Answer::Met { cheapest, .. } => cheapest.first().unwrap(),
        Answer::Missed { .. } => panic!("{:?}", advice.answer),
    }
}

/// The scene with its table [run] replaced, read and measured as a user would.
fn repeated(scene: &str, table: &str) -> Row {
    let path = path(scene);
    let text = std::fs::read_to_string(&path).unwrap();
    let run = text.find("[run]").unwrap();
    let end = text[run..].find("\n[[").map_or(text.len(), |end| run + end);
    let text = format!("{}{table}{}", &text[..run], &text[end..]);
    let scene = Scene::parse(SceneSource::new(path, text)).unwrap();
    let simulation = scene.build().unwrap();
    let (dt, integrator) = (simulation.dt(), simulation.settings().integrator.clone());
    let mut case = Case::new("repeated", simulation).unwrap();
    let method = MethodChoice::on(&case, &integrator);
    on_one_thread(|| measure(&mut case, &method, dt, Effort::QUICK))
        .unwrap()
        .unwrap()
}

fn holds_when_repeated(scene: &str, tolerance: f64) {
    let advice = advise(simulation(scene), question(tolerance)).unwrap();
    // Some twenty methods at some twenty steps each are the grid that these stand for.
    assert!(advice.pilots < 100, "{} pilots", advice.pilots);
    assert_eq!(advice.measured, advice.whole);
    let Answer::Met { cheapest, tenfold } = &advice.answer else {
        panic!("{:?}", advice.answer);
    };
    let best = cheapest.first().unwrap();
    let tenfold = tenfold.as_deref().unwrap();
    for (pilot, tolerance) in [(best, tolerance), (tenfold, tolerance / 10.0)] {
        let row = repeated(scene, &advice.run_table(pilot));
        assert_eq!(row.error, pilot.row.error, "{}", advice.run_table(pilot));
        assert_eq!(row.label(), pilot.row.label());
        assert!(row.error.unwrap() <= tolerance);
        assert!(row.bounded && !row.guarded);
    }
}

#[test]
fn on_the_papers_cube_it_holds_when_repeated() {
    holds_when_repeated("paper-cube.toml", 1e-2);
}

#[test]
fn on_the_papers_oscillator_it_holds_when_repeated() {
    holds_when_repeated("paper-oscillator.toml", 1e-3);
}

/// Methods without set-up whose steps cost sweeps and little else, so that counts compare.
const SWEEPING: [&str; 4] = [
    "symplectic-euler",
    "central-difference",
    "rk4",
    "modified-leapfrog",
];

#[test]
fn the_whole_grid_needs_no_fewer_sweeps_and_a_tighter_tolerance_never_less_work() {
    let mut case = Case::new("small cube", small_cube()).unwrap();
    let mut grid = Vec::new();
    for integrator in SWEEPING {
        let method = MethodChoice::on(&case, integrator);
        for parts in 1..=24 {
            let dt = 0.02 / f64::from(parts);
            grid.push(measure(&mut case, &method, dt, Effort::QUICK).unwrap());
        }
    }
    let mut last = 0.0;
    for tolerance in [1e-1, 2e-2, 1e-2, 2e-3, 5e-4] {
        let advice = advise(small_cube(), question(tolerance)).unwrap();
        let fewest = grid
            .iter()
            .filter(|row| row.sound_error().is_some_and(|error| error <= tolerance))
            .map(|row| row.sweeps_per_s)
            .fold(f64::INFINITY, f64::min);
        let best = &advised(&advice).row;
        assert_eq!(
            best.work.solves,
            0,
            "{} does not count in sweeps",
            best.label()
        );
        // Of runs that cost the same within a tenth the most accurate is chosen.
        assert!(
            best.sweeps_per_s <= 1.1 * fewest,
            "{tolerance}: {} at {} sweeps/s, {fewest} would do",
            best.label(),
            best.sweeps_per_s
        );
        // As much may stand between two tolerances.
        assert!(
            1.1 * best.sweeps_per_s >= last,
            "{tolerance}: {} at {} sweeps/s after {last}",
            best.label(),
            best.sweeps_per_s
        );
        last = best.sweeps_per_s;
    }
}

#[test]
fn what_saturates_is_never_advised() {
    // The paper's oscillator starts beyond Q = 4, so that the networks that clamp are guarded.
    let advice = advise(simulation("paper-oscillator.toml"), question(0.5)).unwrap();
    let Answer::Met { cheapest, .. } = &advice.answer else {
        panic!("{:?}", advice.answer);
    };
    assert!(cheapest.iter().all(|pilot| !pilot.row.guarded));
    assert!(
        cheapest
            .iter()
            .all(|pilot| pilot.method.integrator != "cnn")
    );
    let json = serde_json::to_value(&advice).unwrap();
    assert_eq!(json["question"]["tolerance"], 0.5);
    assert_eq!(json["written"]["Ok"]["method"]["integrator"], "cnn");
    let written = advice.written.unwrap();
    assert!(written.row.guarded);
    // Section 2 of the paper's table at 20 ms.
    assert!(
        (written.row.error.unwrap() - 4.257).abs() < 5e-4,
        "{:?}",
        written.row.error
    );
}

#[test]
fn a_budget_filters_and_what_misses_it_comes_nearest() {
    let free = advise(small_cube(), question(1e-2)).unwrap();
    let cost = advised(&free).row.cpu_s_per_s;
    let asking = |tolerance, budget| Question {
        budget: Some(budget),
        ..question(tolerance)
    };
    let rich = advise(small_cube(), asking(1e-2, 3.0 * cost)).unwrap();
    assert!(advised(&rich).row.cpu_s_per_s <= 3.0 * cost);

    // One sweep every 20 ms costs a third of central difference at 6.67 ms.
    let poor = advise(small_cube(), asking(1e-2, cost / 20.0)).unwrap();
    let Answer::Missed {
        within_tolerance: Some(nearest),
        within_budget: None,
    } = poor.answer
    else {
        panic!("{:?}", poor.answer);
    };
    assert!(nearest.row.error.unwrap() <= 1e-2);
    assert!(nearest.row.cpu_s_per_s > cost / 20.0);

    let strict = advise(small_cube(), asking(1e-6, 1.5 * cost)).unwrap();
    let Answer::Missed {
        within_tolerance: Some(accurate),
        within_budget: Some(affordable),
    } = strict.answer
    else {
        panic!("{:?}", strict.answer);
    };
    assert!(accurate.row.error.unwrap() <= 1e-6);
    assert!(accurate.row.cpu_s_per_s > 1.5 * cost);
    assert!(affordable.row.cpu_s_per_s <= 1.5 * cost);
    let error = affordable.row.error.unwrap();
    assert!(error > 1e-6 && error <= 1e-2, "{error}");
}

#[test]
fn a_budget_alone_buys_the_smallest_error_and_twice_of_it_a_smaller_one() {
    let cost = advised(&advise(small_cube(), question(1e-2)).unwrap())
        .row
        .cpu_s_per_s;
    let within = |budget| {
        let question = Question {
            budget: Some(budget),
            tolerance: None,
            ..question(1e-2)
        };
        advise(small_cube(), question).unwrap()
    };
    let (once, twice) = (within(1.05 * cost), within(2.1 * cost));
    for (advice, budget) in [(&once, 1.05 * cost), (&twice, 2.1 * cost)] {
        let best = advised(advice).row.error.unwrap();
        assert!(advised(advice).row.cpu_s_per_s <= budget);
        let Answer::Met { cheapest, .. } = &advice.answer else {
            panic!("{:?}", advice.answer);
        };
        assert!(cheapest.iter().all(|run| run.row.error.unwrap() >= best));
    }
    let (once, twice) = (
        advised(&once).row.error.unwrap(),
        advised(&twice).row.error.unwrap(),
    );
    // What 1 % costs is there to be bought.
    assert!(once <= 1e-2, "{once}");
    // By a method of second order, half the step at the least.
    assert!(twice <= once / 3.0, "{once} {twice}");
    assert!(matches!(within(1e-9 * cost).answer, Answer::Missed { .. }));
}

#[test]
fn where_time_is_short_a_first_part_of_the_scene_is_measured() {
    // The reference of all four seconds takes several seconds of CPU time, in long steps too.
    let path = path("peers-cube.toml");
    let text = std::fs::read_to_string(&path).unwrap();
    let text = text.replace("duration = 1.0 ", "duration = 4.0 ");
    let text = text.replace("samples = 100 ", "samples = 400 ");
    let scene = Scene::parse(SceneSource::new(path, text)).unwrap();
    let short = Question {
        pilot_seconds: 1.0,
        ..question(1e-2)
    };
    let advice = advise(scene.build().unwrap(), short).unwrap();
    assert!(advice.measured.duration < advice.whole.duration);
    assert!(advice.measured.interval() <= advice.whole.interval() * (1.0 + 1e-9));
    let ratio = advice.whole.interval() / advice.measured.interval();
    assert!(
        (ratio - ratio.round()).abs() < 1e-9,
        "steps meet the scene's instants"
    );
    let row = &advised(&advice).row;
    assert!(row.expected_error.unwrap() <= 1e-2 && row.expected_error >= row.error);
    let best = advised(&advice);
    assert!(
        advice
            .run_table(best)
            .contains("duration = 4.0\nsamples = 400\n")
    );
}

#[test]
fn loads_that_change_after_the_part_that_was_measured_are_named() {
    let advice = advise(pressed_late(), hasty(1e-2)).unwrap();
    assert!(advice.measured.duration < 300.0);
    assert!(!advice.covers_the_scene());
    assert_eq!(advice.unseen_changes, [300.13, 300.33]);
    assert_eq!(advice.met_until(), Some(advice.measured.duration));

    let all = advise(small_cube(), question(1e-2)).unwrap();
    assert!(all.covers_the_scene());
    assert!(all.unseen_changes.is_empty());
    assert_eq!(all.met_until(), Some(1.0));
    assert_eq!(advised(&all).row.expected_error, None);
}

#[test]
fn no_run_is_named_that_a_later_load_would_end() {
    let advice = advise(pressed_late(), hasty(1e-4)).unwrap();
    let Answer::Met { cheapest, tenfold } = &advice.answer else {
        panic!("{:?}", advice.answer);
    };
    let mut exact = 0;
    for pilot in cheapest.iter().chain(tenfold.as_deref()) {
        let simulation = pressed_late();
        let MethodChoice {
            integrator,
            options,
        } = &pilot.method;
        let mut integrator = sinew_integrators::build(integrator, options).unwrap();
        exact += usize::from(integrator.properties().changing_loads.needed() != LoadOverStep::Any);
        // What is refused depends on times alone: from the last step before the load on.
        let dt = pilot.row.dt;
        let mut state = simulation.initial_state().clone();
        state.clock = Clock::at((300.0 / dt).floor() * dt);
        let run = Run::covering(1.0, dt);
        let ran = simulate(
            simulation.system(),
            &mut *integrator,
            &mut state,
            &run,
            &mut (),
        );
        let ran = ran.unwrap_or_else(|error| panic!("{}: {error}", pilot.row.label()));
        assert_eq!(ran.outcome, sinew_core::Outcome::Finished);
    }
    assert!(exact > 0, "steps of 10 ms meet the load: {cheapest:?}");
    // As written it steps over the load.
    let reason = advice.written.unwrap_err().to_string();
    assert!(
        reason.contains("a load changes at t = 300.13 s"),
        "{reason}"
    );
}

#[test]
fn phase_errors_are_expected_to_grow_beyond_the_part_that_was_measured() {
    let undamped = || {
        pressed_cube(
            3,
            "[run]\nduration = 12.0\nsamples = 600\nintegrator = \"rk4\"\ndt = 0.004\n",
        )
    };
    let mut whole = Case::new("whole", undamped()).unwrap();
    for (duration, samples) in [(0.4, 20), (1.0, 50), (3.0, 150)] {
        let span = Span { duration, samples };
        let mut part = Case::over("part", undamped(), span).unwrap();
        for integrator in [
            "central-difference",
            "symplectic-euler",
            "newmark",
            "implicit-euler",
            "cnn-stabilised",
        ] {
            let method = MethodChoice::new(integrator);
            let over = |case: &mut Case| measure(case, &method, 5e-4, Effort::UNTIMED).unwrap();
            let (seen, truth) = (over(&mut part), over(&mut whole).error.unwrap());
            let expected = seen.expected_error.unwrap();
            assert!(
                expected >= truth && expected >= seen.error.unwrap(),
                "{integrator} from {duration} s: {expected} expected, {truth} found"
            );
        }
    }
}

#[test]
fn an_unstable_run_is_shown_but_never_advised() {
    let slowly_pressed = |dt: f64| {
        let text = pressed_text(
            4,
            &format!(
                "[run]\nduration = {:e}\nsamples = 100\nintegrator = \"central-difference\"\ndt = {dt:e}\n",
                100.0 * dt
            ),
        );
        let text = text.replace("kind = \"step\"", "kind = \"sin2\", rise = 50.0");
        let scene = Scene::parse(SceneSource::new("slowly.toml", text)).unwrap();
        scene.build().unwrap()
    };
    let method = MethodChoice::new("central-difference");
    let limit = match method.stable_step(&slowly_pressed(1e-3)).unwrap() {
        StableStep::UpTo(limit) => limit,
        other => panic!("{other:?}"),
    };
    // Rounding grows too slowly to be seen by the end.
    for (dt, advisable) in [(0.9999 * limit, true), (1.0001 * limit, false)] {
        let advice = advise(slowly_pressed(dt), question(0.3)).unwrap();
        let written = advice.written.unwrap();
        assert!(written.row.sound_error().unwrap() < 0.3, "{written:?}");
        let Answer::Met { cheapest, .. } = &advice.answer else {
            panic!("{:?}", advice.answer);
        };
        let own = |pilot: &&Pilot| pilot.method == written.method;
        let best = cheapest.iter().find(own).unwrap();
        assert_eq!(best.row.dt == dt, advisable, "{best:?}");
    }
}

#[test]
fn a_method_that_cannot_tell_its_stable_step_is_not_trusted_beyond_what_was_followed() {
    let text = std::fs::read_to_string(path("hard/critical-damping.toml")).unwrap();
    let text = text.replace("cells = 10", "cells = 4");
    let text = text.replace("duration = 1.0 ", "duration = 1000.0\nsamples = 100000 ");
    let source = SceneSource::new(path("hard/critical-damping.toml"), text);
    let scene = Scene::parse(source).unwrap().build().unwrap();
    let advice = advise(scene, hasty(0.3)).unwrap();
    assert!(!advice.covers_the_scene());
    let refused = advice.refused.iter();
    let mut reasons = refused.filter(|(method, _)| method.integrator == "forward-euler");
    let (_, reason) = reasons.next().unwrap();
    assert!(matches!(reason, LeftOut::StabilityUnknown), "{reason}");
}

/// An undamped cube, for a hundred seconds.
fn undamped_cube(run: &str) -> Simulation {
    pressed_cube(
        3,
        &format!("[run]\nduration = 100.0\nsamples = 2500\n{run}\n"),
    )
}

#[test]
fn phase_errors_are_expected_behind_larger_errors_of_the_start() {
    let undamped = || undamped_cube("integrator = \"rk4\"\ndt = 0.004");
    let mut whole = Case::new("whole", undamped()).unwrap();
    let propagator = |kind: &str, tolerance| MethodChoice {
        integrator: "propagator".to_owned(),
        options: Options::new()
            .with("kind", OptionValue::Text(kind.to_owned()))
            .with_number("tolerance", tolerance),
    };
    let methods = [
        propagator("two-step", 1e-4),
        propagator("two-step", 1e-6),
        propagator("krylov", 1e-5),
        MethodChoice::new("modified-leapfrog"),
    ];
    for method in methods {
        let over = |case: &mut Case| measure(case, &method, 0.02, Effort::UNTIMED).unwrap();
        let truth = over(&mut whole).error.unwrap();
        for samples in [2, 3, 5, 10, 100] {
            let duration = 0.04 * samples as f64;
            let span = Span { duration, samples };
            let mut part = Case::over("part", undamped(), span).unwrap();
            let seen = over(&mut part);
            let expected = seen.expected_error.unwrap();
            assert!(
                expected >= truth,
                "{} from {duration} s: {expected} expected, {truth} found",
                method.label()
            );
        }
    }
}

fn spring(oscillator: &str) -> Result<Advice, AdviceError> {
    let text = format!(
        "[oscillator]\n{oscillator}\n[run]\nduration = 1.0\nintegrator = \"rk4\"\ndt = 0.02\n"
    );
    let scene = Scene::parse(SceneSource::new("spring.toml", text)).unwrap();
    advise(scene.build().unwrap(), Question::new(1e-2))
}

#[test]
fn a_scene_in_which_nothing_moves_is_refused_with_what_to_do() {
    let error = spring("mass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 0.0").unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("nothing moves") && text.contains("give it a load"),
        "{text}"
    );
}

#[test]
fn a_scene_too_fast_to_follow_is_refused_with_what_to_do() {
    let error = spring("mass = 0.1\nstiffness = 1e40\ndamping = 0.0\nvelocity = 1.0").unwrap_err();
    assert!(matches!(error, AdviceError::TooFast { .. }), "{error}");
    assert!(
        error.to_string().contains("shorten [run] duration"),
        "{error}"
    );
}

#[test]
fn a_tolerance_below_the_references_own_error_is_refused() {
    let error = advise(simulation("paper-oscillator.toml"), question(1e-17)).unwrap_err();
    assert!(
        matches!(error, AdviceError::BeyondReference { .. }),
        "{error}"
    );
}
