//! The reproduction scene of the paper's second example, section 4.2, to the digits printed.

use crate::common::cube::{INSTANT, error, paper_cube, run};
use crate::common::{assert_prints, build, largest, plain, saturation};
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, Options, State, System};

/// The error at so many steps for every 20 ms.
fn error_of(id: &str, options: &Options, steps_per_instant: usize) -> f64 {
    let (instants, _, _) = run(paper_cube(), &mut *build(id, options), steps_per_instant);
    error(&instants)
}

#[test]
fn the_scene_is_the_one_described() {
    let model = paper_cube();
    assert_eq!(model.dofs(), 2673);
    assert_prints(model.report().loads[0].asked[2], "-20.0");
    assert_prints(model.report().loads[0].acting[2], "-16.2");
    let critical = Spectrum::of(model.operators()).critical_step();
    assert_prints(1e3 * critical, "7.9");
}

#[test]
fn at_1_ms_the_network_is_forward_euler() {
    let states = |id, options: &Options| -> (Vec<Vec<f64>>, State) {
        let (instants, state, report) = run(paper_cube(), &mut *build(id, options), 20);
        assert_eq!(report.work.saturated, 0);
        assert_eq!(report.work.sweeps, 1000);
        (instants, state)
    };
    let (euler, network) = (
        states("forward-euler", &plain()),
        states("cnn", &saturation(4.0)),
    );
    assert_eq!(euler, network);
    assert_prints(error(&network.0), "0.0024");
}

#[test]
fn at_20_ms_forward_euler_is_unbounded() {
    let (instants, _, _) = run(paper_cube(), &mut *build("forward-euler", &plain()), 1);
    let size = largest(&instants[50]);
    assert!(size > 1e30, "{size:e}");
    assert_prints(size, "4e30");
}

#[test]
fn at_20_ms_the_network_is_bounded_and_wrong() {
    let model = paper_cube();
    let (instants, state, report) = run(model, &mut *build("cnn", &saturation(4.0)), 1);
    let error = error(&instants);
    assert!((error / 25.2 - 1.0).abs() < 0.02, "{error}");
    assert_prints(
        report.work.saturated as f64 / (50 * model.dofs()) as f64,
        "0.766",
    );
    let max_u = instants.iter().map(|u| largest(u)).fold(0.0, f64::max);
    assert_prints(max_u, "0.160");
    let inverted = |u: &Vec<f64>| model.inverted_elements(0.0.into(), u).unwrap();
    assert_eq!(inverted(&state.u), 1676);
    let late = instants[22..].iter().map(inverted);
    assert_eq!((late.clone().min(), late.max()), (Some(1646), Some(2984)));
    // At the end everything is saturated: every jump is the voltage times the step.
    for (before, after) in instants[49].iter().zip(&instants[50]) {
        assert!(((after - before).abs() - 4.0 * INSTANT).abs() < 1e-12);
    }
}

#[test]
fn the_best_voltage_scores_no_better_than_doing_little() {
    assert_prints(error_of("cnn", &saturation(0.0097), 1), "0.82");
}

#[cfg(feature = "implicit")]
#[test]
fn newmark_at_20_ms() {
    assert_prints(error_of("newmark", &plain(), 1), "0.00924");
}

#[test]
fn central_difference_in_three_sub_steps() {
    let substeps = plain().with_number("substeps", 3.0);
    let model = paper_cube();
    let (by_option, option_state, report) =
        run(model, &mut *build("central-difference", &substeps), 1);
    let (by_step, step_state, _) = run(model, &mut *build("central-difference", &plain()), 3);
    assert_eq!(report.work.sweeps, 150);
    assert_prints(error(&by_option), "0.00123");
    assert!(by_option == by_step);
    assert!(option_state == step_state);
}
