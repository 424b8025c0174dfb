//! Advice on the scenes of the repository: true when its run is repeated, and hard to beat.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a helper that fails fails its test"
)]

use std::path::PathBuf;

use sinew_measure::search::Pilot;
use sinew_measure::{
    Advice, AdviceError, Answer, Case, Effort, Method, Question, Row, advise, measure,
    on_one_thread,
};
use sinew_scene::{Scene, SceneSource, Simulation};

fn path(scene: &str) -> PathBuf {
    let scenes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes.join(scene)
}

fn simulation(scene: &str) -> Simulation {
    Scene::load(path(scene)).unwrap().build().unwrap()
}

/// Time enough that the choice is not cut short, on slow machines too.
fn question(tolerance: f64) -> Question {
    Question {
        pilot_seconds: 20.0,
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
    let method = Method::on(&case, &integrator);
    on_one_thread(|| measure(&mut case, &method, dt, Effort::QUICK))
        .unwrap()
        .unwrap()
}

fn holds_when_repeated(scene: &str, tolerance: f64) {
    let advice = advise(simulation(scene), question(tolerance)).unwrap();
    assert!(!advice.choice_cut_short);
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

#[test]
fn on_the_peers_cube_it_holds_when_repeated() {
    holds_when_repeated("peers-cube.toml", 1e-2);
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
        let method = Method::on(&case, integrator);
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
        // Beside its sweep a step of one method does a little more than that of another.
        assert!(
            best.sweeps_per_s <= 1.1 * fewest,
            "{tolerance}: {} at {} sweeps/s, {fewest} would do",
            best.label(),
            best.sweeps_per_s
        );
        // Times decide, and sweeps follow them to a tenth.
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
fn where_time_is_short_a_first_part_of_the_scene_is_measured() {
    // The reference of the whole second takes some 3 s of CPU time.
    let short = Question {
        pilot_seconds: 1.0,
        ..question(1e-2)
    };
    let advice = advise(simulation("peers-cube.toml"), short).unwrap();
    assert!(advice.measured.duration < advice.whole.duration);
    assert!(advice.measured.interval() <= advice.whole.interval() * (1.0 + 1e-9));
    let ratio = advice.whole.interval() / advice.measured.interval();
    assert!(
        (ratio - ratio.round()).abs() < 1e-9,
        "steps meet the scene's instants"
    );
    // The pilot that is under way when time runs out is finished.
    assert!(advice.spent_s < 10.0, "{} s", advice.spent_s);
    let best = advised(&advice);
    assert!(
        advice
            .run_table(best)
            .contains("duration = 1.0\nsamples = 100\n")
    );
}

fn spring(oscillator: &str) -> Result<Advice, AdviceError> {
    let text = format!(
        "[oscillator]\n{oscillator}\n[run]\nduration = 1.0\nintegrator = \"rk4\"\ndt = 0.02\n"
    );
    let scene = Scene::parse(SceneSource::new("spring.toml", text)).unwrap();
    advise(scene.build().unwrap(), Question::new(1e-2))
}

#[test]
fn nothing_moves() {
    let error = spring("mass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = 0.0").unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("nothing moves") && text.contains("give it a load"),
        "{text}"
    );
}

#[test]
fn a_scene_too_fast_to_follow_is_refused_at_once() {
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
