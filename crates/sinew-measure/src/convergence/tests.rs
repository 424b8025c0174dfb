//! Errors in space compared with known solutions.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::PI;

use sinew_scene::{Scene, SceneSource};

use super::level::solve;
use super::*;

fn simulation(text: &str) -> Simulation {
    let scene = Scene::parse(SceneSource::new("test.toml", text)).unwrap();
    scene.build().unwrap()
}

/// A column that can only stretch along z, pulled at its top: one-dimensional waves of speed `sqrt((lambda + 2 mu)/rho)`.
fn column(cells: usize) -> String {
    format!(
        "[mesh]\ncube = {{ cells = {cells}, edge = {EDGE}, split = \"kuhn\" }}\n[[region]]\ndensity = {DENSITY}\nmodel = \"linear\"\n\
         youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\naxes = \"z\"\n[[fixed]]\n\
         where = {{ box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]] }}\naxes = \"xy\"\n[[load]]\ngroup = \"top\"\n\
         traction = [0.0, 0.0, {TRACTION}]\nramp = {{ kind = \"sin2\", rise = {RISE} }}\n[run]\nduration = 0.2\n\
         integrator = \"central-difference\"\ndt = 0.004\n[[probe]]\nname = \"top\"\npoint = [0.05, 0.05, 0.1]\n\
         [[probe]]\nname = \"between\"\npoint = [0.013, 0.022, 0.061]\n"
    )
}

const EDGE: f64 = 0.1;
const DENSITY: f64 = 1000.0;
const TRACTION: f64 = 10.0;
const RISE: f64 = 0.1;

/// The displacement (m) of the column's top by d'Alembert's solution: waves of the load that return from the fixed end
/// with reversed sign after each round trip.
fn top_of_column(t: f64) -> f64 {
    let modulus = 3000.0 * 0.7 / (1.3 * 0.4);
    let speed = (modulus / DENSITY).sqrt();
    // The integral of the load's ramp over time.
    let impulse = |t: f64| match t {
        t if t <= 0.0 => 0.0,
        t if t < RISE => 0.5 * t - 0.5 * RISE / PI * (PI * t / RISE).sin(),
        t => 0.5 * RISE + (t - RISE),
    };
    let mut sum = impulse(t);
    let mut sign = -1.0;
    for way in 1..20 {
        sum += 2.0 * sign * impulse(t - 2.0 * f64::from(way) * EDGE / speed);
        sign = -sign;
    }
    TRACTION / (DENSITY * speed) * sum
}

fn of<'a>(found: &'a Convergence, subject: &Subject, when: When) -> &'a Quantity {
    let mut quantities = found.quantities.iter();
    let quantity =
        quantities.find(|quantity| quantity.subject == *subject && quantity.when == when);
    quantity.unwrap()
}

/// Predicted counts: nodes and tetrahedra exactly, work within a factor of 2.
fn check_counts(prediction: &Prediction, found: &Convergence) {
    for (said, level) in prediction.levels.iter().zip(&found.levels) {
        assert_eq!((said.nodes, said.tets), (level.nodes, level.tets));
        let ratio =
            |said: f64, done: f64| assert!((0.5..2.0).contains(&(said / done)), "{said} {done}");
        ratio(said.dofs as f64, level.dofs as f64);
        ratio(
            said.sweeps,
            (level.work.sweeps + level.reference_sweeps) as f64,
        );
    }
}

#[test]
fn waves_in_a_column_have_the_error_of_dalemberts_solution_and_order_two() {
    let simulation = simulation(&column(4));
    let prediction = predict(&simulation, 3).unwrap();
    assert_eq!(prediction.time_check, TimeCheck::Reference);
    let found = converge(&simulation, &prediction).unwrap();
    let json = serde_json::to_value(&found).unwrap();
    let again: Convergence = serde_json::from_value(json).unwrap();
    assert_eq!(again, found);
    let top = Subject::Probe("top".into());
    let estimate = &of(&found, &top, When::Run).estimate;
    // The truth at the same instants.
    let places = Places::of(&simulation).unwrap();
    let solved = solve(&simulation, &prediction, 0, &places, false).unwrap();
    let (_, values) = places.subjects().into_iter().next().unwrap();
    let exact: Vec<f64> = prediction
        .instants()
        .iter()
        .flat_map(|t| [0.0, 0.0, top_of_column(*t)])
        .collect();
    let truth = distance(values(&solved.compared), &exact) / norm(&exact);
    let error = estimate.error.unwrap();
    assert!((0.7..1.4).contains(&(error / truth)), "{error} {truth}");
    for quantity in &found.quantities {
        // At rest linear elements are exact in one dimension.
        let Some(order) = quantity.estimate.observed_order else {
            assert!(quantity.estimate.error.unwrap() < 1e-6);
            assert_eq!(quantity.when, When::Rest);
            continue;
        };
        // Within an element the error depends on the place, not on the length of edges alone.
        let off = if quantity.subject == Subject::Probe("between".into()) {
            0.5
        } else {
            0.2
        };
        assert!((order - 2.0).abs() < off, "{:?}: {order}", quantity.subject);
        assert!(
            quantity
                .errors_in_time
                .iter()
                .all(|error| error.unwrap() < 1e-2)
        );
    }
    let steps: Vec<f64> = found.levels.iter().map(|level| level.dt).collect();
    assert_eq!(
        steps,
        [0.004, 0.004, 0.002],
        "the finest mesh needs shorter ones"
    );
    check_counts(&prediction, &found);
    // With two meshes the same, its order assumed.
    let prediction = predict(&simulation, 2).unwrap();
    let found = converge(&simulation, &prediction).unwrap();
    let estimate = &of(&found, &top, When::Run).estimate;
    assert_eq!((estimate.order, estimate.observed_order), (2.0, None));
    assert!((0.7..1.4).contains(&(estimate.error.unwrap() / truth)));
}

/// A cantilever of three by one by one, bent by a force on its end. Poisson's ratio 0.3; singular stresses at the clamped edges.
fn cantilever(cells: usize, dt: f64) -> String {
    format!(
        "[mesh]\nblock = {{ cells = [{}, {cells}, {cells}], size = [0.06, 0.02, 0.02] }}\n[[region]]\ndensity = 1000.0\n\
         model = \"linear\"\nyoungs_modulus = 5000.0\npoissons_ratio = 0.3\n[damping]\nmass = 30.0\n[[fixed]]\n\
         where = {{ below = {{ x = 0.0 }} }}\n[[load]]\nwhere = {{ above = {{ x = 0.06 }} }}\ntraction = [0.0, 0.0, -5.0]\n\
         [run]\nduration = 0.4\nintegrator = \"newmark\"\ndt = {dt}\n[[probe]]\nname = \"tip\"\npoint = [0.06, 0.011, 0.008]\n",
        3 * cells
    )
}

#[test]
fn the_error_of_a_cantilever_is_within_a_factor_of_two_of_that_against_finer_meshes() {
    let simulation = simulation(&cantilever(2, 0.01));
    let prediction = predict(&simulation, 2).unwrap();
    let found = converge(&simulation, &prediction).unwrap();
    check_counts(&prediction, &found);
    let truth = converge(&simulation, &predict(&simulation, 4).unwrap()).unwrap();
    let mut seen = 0;
    for quantity in &found.quantities {
        let finest = of(&truth, &quantity.subject, quantity.when);
        // What the finest mesh itself lacks is less than a tenth of that.
        let truth = finest.estimate.differences.iter().sum::<f64>() * finest.size / quantity.size;
        let ratio = quantity.estimate.error.unwrap() / truth;
        assert!(
            (0.5..2.0).contains(&ratio),
            "{:?} {ratio}",
            quantity.subject
        );
        seen += 1;
    }
    assert_eq!(seen, 6, "tip, all nodes and energy, in the run and at rest");
}

#[test]
fn half_the_step_shows_the_errors_that_a_reference_shows() {
    let simulation = simulation(&cantilever(1, 0.005));
    let mut prediction = predict(&simulation, 2).unwrap();
    let by_reference = converge(&simulation, &prediction).unwrap();
    prediction.time_check = TimeCheck::HalfStep;
    let by_halves = converge(&simulation, &prediction).unwrap();
    let pairs = by_reference.quantities.iter().zip(&by_halves.quantities);
    for (reference, halves) in pairs {
        let errors = reference.errors_in_time.iter().zip(&halves.errors_in_time);
        for (reference, halves) in errors {
            match (reference, halves) {
                (None, None) => {}
                (Some(reference), Some(halves)) => {
                    assert!(
                        (0.8..1.25).contains(&(halves / reference)),
                        "{halves} {reference}"
                    );
                }
                other => assert_eq!(other, (&None, &None)),
            }
        }
        let (reference, halves) = (reference.estimate.error, halves.estimate.error);
        assert!((halves.unwrap() / reference.unwrap() - 1.0).abs() < 0.1);
    }
    let work: Vec<u64> = by_halves
        .levels
        .iter()
        .map(|level| level.work.solves)
        .collect();
    assert!(
        work.iter().all(|solves| (240..260).contains(solves)),
        "80 steps and 160: {work:?}"
    );
}

#[test]
fn a_place_between_nodes_and_one_of_single_nodes_are_named() {
    let scene = |place: &str| {
        format!(
            "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
             youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\nwhere = {place}\n[[load]]\ngroup = \"top\"\n\
             pressure = 5.0\n[run]\nduration = 0.05\nintegrator = \"central-difference\"\ndt = 0.001\n"
        )
    };
    let caveats = |place: &str| {
        let simulation = simulation(&scene(place));
        let found = converge(&simulation, &predict(&simulation, 2).unwrap()).unwrap();
        let ids = found.caveats.iter().map(Caveat::id).collect::<Vec<_>>();
        ids.join(" ")
    };
    assert_eq!(caveats("{ below = { z = 0.0 } }"), "order-assumed");
    // Half of the side walls is held: on the finer mesh a quarter of an edge more.
    let between = caveats("{ below = { z = 0.04 } }");
    assert!(between.contains("place-changed"), "{between}");
    let points = caveats("{ nodes = [1, 3, 7, 9] }");
    assert!(points.contains("point-place"), "{points}");
}

/// A plate that moves down slowly on a light bar without lateral contraction receives `E A d/L` at all times, on every
/// mesh.
#[test]
fn the_force_on_a_tool_is_one_of_the_quantities() {
    let (speed, duration) = (-0.01, 0.2);
    let simulation = simulation(&format!(
        "[mesh]\ncube = {{ cells = 1, edge = {EDGE} }}\n[[region]]\ndensity = 10.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\n\
         poissons_ratio = 0.0\n[damping]\nmass = 300.0\n[[fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"plate\"\nshape = {{ plane = {{}} }}\n\
         start = [0.05, 0.05, {EDGE}]\nrotation = [{PI}, 0.0, 0.0]\nvelocity = [0.0, 0.0, {speed}]\n\
         [run]\nduration = {duration}\nintegrator = \"central-difference\"\ndt = 0.001\n"
    ));
    let found = converge(&simulation, &predict(&simulation, 2).unwrap()).unwrap();
    let force = of(&found, &Subject::Force("plate".into()), When::Run);
    let last = 3000.0 * EDGE * EDGE * -speed * duration / EDGE;
    let expected = last / 3.0_f64.sqrt();
    assert!(
        (force.size / expected - 1.0).abs() < 0.1,
        "{} {expected}",
        force.size
    );
    assert!(force.estimate.differences[0] < 0.1);
    assert!(
        force
            .errors_in_time
            .iter()
            .flatten()
            .all(|error| *error < 0.1)
    );
    // Held by a plate, it comes to rest elsewhere than under its loads.
    let rests = found.quantities.iter().filter(|of| of.when == When::Rest);
    assert_eq!(rests.count(), 0);
}

/// A cube of large deformation under a traction, in steps divided by its stiffness unless `dt` states otherwise.
fn squeezed(dt: &str) -> String {
    format!(
        "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 3500.0\n\
         poissons_ratio = 0.4\n[damping]\nmass = 5.0\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -400.0]\n\
         ramp = {{ kind = \"sin2\", rise = 0.1 }}\n[run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = {dt}\n"
    )
}

/// Half of a step that the stiffness divides in two is one substep of the same length, so the two runs would be the
/// same.
#[test]
fn steps_that_are_cut_by_the_stiffness_have_the_error_in_time_that_fine_steps_tell() {
    let (cut, fine) = (
        simulation(&squeezed("\"auto\"")),
        simulation(&squeezed("1e-4")),
    );
    let prediction = predict(&cut, 2).unwrap();
    assert_eq!(prediction.time_check, TimeCheck::HalfStep);
    let places = Places::of(&cut).unwrap();
    let found = solve(&cut, &prediction, 0, &places, false).unwrap();
    let run = found.run.unwrap();
    let shorter = Prediction {
        dt: prediction.dt / 64.0,
        steps: 64 * prediction.steps,
        stride: 64 * prediction.stride,
        ..prediction.clone()
    };
    let truth = solve(&fine, &shorter, 0, &places, false).unwrap().compared;
    let size = norm(truth.nodes());
    let truth = distance(run.nodes(), truth.nodes()) / size;
    let said = found.halving.error * distance(run.nodes(), found.compared.nodes()) / size;
    assert!(truth > 1e-4, "{truth}");
    assert!((0.7..1.4).contains(&(said / truth)), "{said} for {truth}");
}

/// A free body without loads, in steps of a power of two.
#[test]
fn runs_of_equal_bits_are_no_comparison() {
    let text = "[mesh]\ncube = { cells = 1, edge = 0.125 }\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 1000.0\n\
                poissons_ratio = 0.3\n[[initial]]\ngroup = \"tissue\"\nvelocity = [0.5, 0.0, 0.0]\n[run]\nduration = 0.25\n\
                integrator = \"central-difference\"\ndt = 0.00390625\nfree_flight = true\n";
    let simulation = simulation(text);
    let prediction = predict(&simulation, 2).unwrap();
    let refused = converge(&simulation, &prediction).unwrap_err();
    assert!(
        matches!(refused, ConvergeError::SameRun { level: 1, .. }),
        "{refused}"
    );
}
