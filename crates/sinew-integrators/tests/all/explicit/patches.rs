//! `patches`: a few stiff elements solved as small blocks inside central difference.

use std::sync::OnceLock;

use crate::common::sliver::{MASS_DAMPING, auto, model, with_sliver};
use crate::common::{
    advance, build, diverged, largest, plain, relative_error, velocity_after, watch,
};
use sinew_core::{
    Integrator, LinearModel, LinearOperators, LinearSystem, OptionValue, Options, Run, StableStep,
    State, System,
};
use sinew_fem::{Model, Rayleigh};
use sinew_mesh::structured::{self, Split};

fn patched() -> Box<dyn Integrator> {
    build("central-difference", &auto())
}

fn limit(integrator: &dyn Integrator, system: &dyn System) -> f64 {
    match integrator.stable_step(system).unwrap() {
        StableStep::UpTo(limit) => limit,
        other => panic!("{other:?}"),
    }
}

fn plain_limit(system: &dyn System) -> f64 {
    limit(&*build("central-difference", &plain()), system)
}

/// Displacements every 20 ms of the first .4 s, if the run reached that time.
fn displacements(
    model: &Model,
    integrator: &mut dyn Integrator,
    parts: usize,
) -> Option<Vec<Vec<f64>>> {
    let run = Run {
        steps: 20 * parts,
        ..Run::covering(0.4, 0.02 / parts as f64).with_divergence_limit(10.0)
    };
    let (mut step, mut instants) = (0, Vec::new());
    let start = State::at_rest(model.dofs());
    let (_, report) = watch(model, integrator, start, &run, |state| {
        if step % parts == 0 {
            instants.push(state.u.clone());
        }
        step += 1;
    });
    (!diverged(&report)).then_some(instants)
}

/// Error of a method in steps of 20 ms divided by `parts`.
fn error(model: &Model, integrator: &mut dyn Integrator, parts: usize) -> Option<f64> {
    let mut exact = build("propagator", &plain().with_number("tolerance", 1e-12));
    let reference = displacements(model, &mut *exact, 1).unwrap();
    let found = displacements(model, integrator, parts)?;
    Some(relative_error(&found, &reference))
}

/// The uniform cube's error without patches, in steps of three quarters of its critical step.
fn uniform_error() -> f64 {
    static ERROR: OnceLock<f64> = OnceLock::new();
    *ERROR.get_or_init(|| {
        let uniform = model(
            &structured::cube(6, 0.1, Split::Kuhn).unwrap(),
            MASS_DAMPING,
        );
        assert!((0.7..0.8).contains(&(0.004 / plain_limit(&uniform))));
        error(&uniform, &mut *build("central-difference", &plain()), 5).unwrap()
    })
}

/// The target: at the uniform mesh's step at most twice its error.
#[test]
fn a_sliver_costs_neither_step_nor_accuracy() {
    for thinness in [20.0, 100.0, 1000.0] {
        let model = model(&with_sliver(thinness), MASS_DAMPING);
        if thinness > 50.0 {
            assert!(plain_limit(&model) < 0.004 / 1.9, "{thinness}");
            let unpatched = error(&model, &mut *build("central-difference", &plain()), 5);
            assert_eq!(unpatched, None, "{thinness}");
        }
        let error = error(&model, &mut *patched(), 5).unwrap();
        println!("{thinness}: {error:.3e}, uniform {:.3e}", uniform_error());
        assert!(error <= 2.0 * uniform_error(), "{thinness}: {error}");
    }
}

/// The patch also contains the part whose stiffness-proportional damping would limit the step.
#[test]
fn a_sliver_under_stiffness_damping() {
    let damping = Rayleigh::new(0.0, 2e-4);
    let model = model(&with_sliver(1000.0), damping);
    assert!(plain_limit(&model) < 0.004 / 8.0, "{}", plain_limit(&model));
    let error = error(&model, &mut *patched(), 5).unwrap();
    println!("{error:.3e}");
    assert!(error <= 0.05, "{error}");
}

/// With every element in a patch, P = M + dt^2/4 K, which is Newmark's method with beta = 1/4.
#[test]
fn patches_of_all_elements_are_newmark() {
    let mesh = structured::cube(1, 0.1, Split::Kuhn).unwrap();
    let model = model(&mesh, Rayleigh::default());
    let dt = 30.0 * plain_limit(&model);
    let start = State::new(
        vec![0.0; model.dofs()],
        (0..model.dofs()).map(|i| (2.3 * i as f64).cos()).collect(),
    );
    let mut one = patched();
    let mut other = build("newmark", &plain());
    let (mut a, mut b) = (start.clone(), start);
    let mut size = 0.0_f64;
    for step in 0..50 {
        advance(&mut *one, &model, &mut a, 1, dt);
        advance(&mut *other, &model, &mut b, 1, dt);
        size = size.max(largest(&b.u));
        let difference = a.u.iter().zip(&b.u).map(|(a, b)| (a - b).abs());
        let difference = difference.fold(0.0, f64::max);
        assert!(
            difference <= 1e-9 * size,
            "step {step}: {difference:e} of {size:e}"
        );
    }
    let facts = one.facts();
    assert!(
        facts
            .iter()
            .any(|fact| fact.name == "patch_elements" && fact.value == 6.0)
    );
}

/// The equation of the step itself, under mass damping: with every element in a patch P is
/// `(1 + alpha dt/2) M + dt^2/4 K`, and the start damps and filters the first velocity alike.
#[test]
fn steps_solve_their_equation() {
    let mesh = structured::cube(1, 0.1, Split::Kuhn).unwrap();
    let model = model(&mesh, MASS_DAMPING);
    let alpha = MASS_DAMPING.mass;
    let (mass, stiffness) = (model.mass(), model.operators().stiffness());
    let dt = 30.0 * plain_limit(&model);
    let n = model.dofs();
    let product = |x: &[f64]| {
        let mut out = vec![0.0; n];
        stiffness.multiply(x, &mut out);
        out
    };
    let force = |state: &State| {
        let mut out = vec![0.0; n];
        let operators = model.operators();
        operators.net_force(state.t(), &state.u, &state.v, &mut out);
        out
    };
    let check = |change: &[f64], expected: &[f64]| {
        let elastic = product(change);
        let size = largest(expected);
        for i in 0..n {
            let found = (1.0 + alpha * dt / 2.0) * mass[i] * change[i] + dt * dt / 4.0 * elastic[i];
            assert!(
                (found - expected[i]).abs() <= 1e-11 * size,
                "{i}: {found} {expected:?}"
            );
        }
    };
    let v0: Vec<f64> = (0..n).map(|i| (2.3 * i as f64).cos()).collect();
    let start = State::new(vec![0.0; n], v0.clone());
    let mut integrator = patched();
    let mut state = start.clone();
    advance(&mut *integrator, &model, &mut state, 1, dt);
    let (f, kv) = (force(&start), product(&v0));
    let halfway = |i: usize| state.v[i] - v0[i] + dt / 2.0 * alpha * v0[i];
    let right = |i: usize| dt / 2.0 * (f[i] + alpha * mass[i] * v0[i]) - dt * dt / 4.0 * kv[i];
    let (change, expected): (Vec<f64>, Vec<f64>) = (0..n).map(|i| (halfway(i), right(i))).unzip();
    check(&change, &expected);

    let before = state.clone();
    advance(&mut *integrator, &model, &mut state, 1, dt);
    let change: Vec<f64> = state.v.iter().zip(&before.v).map(|(a, b)| a - b).collect();
    let expected: Vec<f64> = force(&before).iter().map(|f| dt * f).collect();
    check(&change, &expected);

    // Where the step is long, M^-1 of the force is no acceleration: the velocity at t must not be
    // made with it.
    let mut v = vec![0.0; n];
    state
        .velocity_at_t(&model, sinew_core::Inputs::none(), &mut v)
        .unwrap();
    assert!(
        largest(&v) <= 3.0 * largest(&before.v).max(largest(&state.v)),
        "{v:?}"
    );
}

/// The velocity at the displacement's time, as a staggered method reports it.
#[test]
fn velocities_of_a_patch_are_those_of_the_motion() {
    let model = model(&with_sliver(1000.0), MASS_DAMPING);
    let exact = velocity_after(&mut *build("propagator", &plain()), &model, 5, 0.02);
    let found = velocity_after(&mut *patched(), &model, 100, 0.001);
    let error = relative_error(&[found], &[exact]);
    assert!(error <= 0.05, "{error}");
}

#[test]
fn a_checkpoint_continues_to_the_same_bits() {
    let model = model(&with_sliver(1000.0), MASS_DAMPING);
    let mut through = State::at_rest(model.dofs());
    advance(&mut *patched(), &model, &mut through, 20, 0.004);
    let mut halves = State::at_rest(model.dofs());
    advance(&mut *patched(), &model, &mut halves, 10, 0.004);
    let mut halves = halves.clone();
    advance(&mut *patched(), &model, &mut halves, 10, 0.004);
    assert_eq!(through, halves);
}

/// The two tetrahedra at the coplanar faces towards which the vertex was moved.
#[test]
fn the_elements_that_forced_a_patch_are_named() {
    let model = model(&with_sliver(1000.0), MASS_DAMPING);
    let mut integrator = patched();
    integrator.prepare(&model, 0.004).unwrap();
    let limit = plain_limit(&model);
    assert_eq!(
        integrator.remarks(),
        [format!(
            "dt = 0.004 s is {:.3} times the stable step without patches, {limit:.3e} s, which \
             tetrahedron 522, tetrahedron 517 set; 2 of 1296 elements, on 5 cells, are solved in 1 \
             small block(s)",
            0.004 / limit
        )]
    );
    integrator.prepare(&model, 0.5 * limit).unwrap();
    let remarks = integrator.remarks();
    assert!(
        remarks[0].ends_with("is stable without patches; none are made"),
        "{remarks:?}"
    );
}

/// On a uniform mesh no element stands out, and no element is put into a patch for a slightly longer step.
#[test]
fn the_stable_step_counts_on_patches_only_where_they_pay() {
    let uniform = model(
        &structured::cube(6, 0.1, Split::Kuhn).unwrap(),
        MASS_DAMPING,
    );
    assert_eq!(limit(&*patched(), &uniform), plain_limit(&uniform));
    let sliver = model(&with_sliver(1000.0), MASS_DAMPING);
    let with_patches = limit(&*patched(), &sliver);
    assert!(with_patches > 0.9 * plain_limit(&uniform), "{with_patches}");
    // Sub-steps are cut by it.
    let options = auto().with("substeps", OptionValue::Text("auto".into()));
    let mut state = State::at_rest(sliver.dofs());
    let work = build("central-difference", &options)
        .step(&sliver, &mut state, 0.02)
        .unwrap();
    assert_eq!(work.sweeps, (0.02 / (0.9 * with_patches)).ceil() as u64);
}

#[test]
fn what_has_no_patches_says_so() {
    let message = |system: &dyn System, dt| patched().prepare(system, dt).unwrap_err().to_string();
    let operators = LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap();
    assert_eq!(
        message(&LinearModel::new(operators), 0.02),
        "`central-difference`: patches = \"auto\" needs a body of elements, and this system has \
         none: leave `patches` out"
    );
    let uniform = model(
        &structured::cube(6, 0.1, Split::Kuhn).unwrap(),
        MASS_DAMPING,
    );
    let message = message(&uniform, 0.02);
    let start = "`central-difference`: dt = 0.02 s is too long for patches: with 64 of 1296 \
                 elements in them the step may be 5.";
    assert!(message.starts_with(start), "{message}");
    let end = "take that, substeps = \"auto\", or a method that is stable at any step";
    assert!(message.ends_with(end), "{message}");

    let refusal = |id: &str, value: OptionValue| {
        let options = Options::new().with("patches", value);
        sinew_integrators::build(id, &options)
            .err()
            .map(|error| error.to_string())
    };
    assert_eq!(
        refusal("newmark", OptionValue::Text("auto".into())).unwrap(),
        "`newmark` has no option `patches`; it takes `beta`, `gamma`, `newton_tolerance`, `newton_iterations`, `factor`"
    );
    assert_eq!(
        refusal("central-difference", OptionValue::Number(3.0)).unwrap(),
        "`central-difference`: patches = 3: expected \"auto\" or \"off\""
    );
}
