//! The reference of large bodies: compared with closed forms and with the reference that is exact to rounding, and its
//! cost.

use std::sync::Arc;

use sinew_core::closed_form::DampedOscillator;
use sinew_core::spectrum::Spectrum;
use sinew_core::{
    BlockMatrix, Damping, Layers, LinearModel, LinearOperators, Load, Pattern, Ramp, State,
};
use sinew_measure::reference::{ErrorNorm, ReferenceMethod, Track, follow, follow_affordably};
use sinew_measure::{Case, Effort, MethodChoice, measure};
use sinew_scene::{Scene, SceneSource, Simulation};

fn instants(duration: f64, count: u32) -> Vec<f64> {
    (0..=count)
        .map(|j| f64::from(j) * duration / f64::from(count))
        .collect()
}

/// A mass of 1 kg on a spring of omega^2, under loads that its ramps multiply.
fn oscillator(omega: f64, damping: f64, loads: &[(Ramp, f64)]) -> LinearModel {
    let loads = loads.iter().map(|(ramp, force)| Load {
        ramp: ramp.clone(),
        entries: vec![(0, *force)],
    });
    let operators = LinearOperators::oscillator(1.0, omega * omega, damping)
        .and_then(|operators| operators.with_loads(loads.collect()))
        .unwrap();
    LinearModel::new(operators)
}

#[test]
fn oscillators_of_any_damping_have_their_closed_form() {
    let omega = 40.0;
    for ratio in [0.0, 0.01, 0.3, 1.0, 2.5] {
        let damping = 2.0 * ratio * omega;
        let model = oscillator(omega, damping, &[(Ramp::Step, 12.0)]);
        let exact = DampedOscillator {
            omega,
            damping,
            load: 12.0,
            displacement: 0.01,
            velocity: -0.5,
        };
        let start = State::new(vec![0.01], vec![-0.5]);
        let times = instants(3.0, 30);
        let track = follow_affordably(&model, &start, &times).unwrap();
        let closed: Vec<Vec<f64>> = times.iter().map(|t| vec![exact.at(*t).0]).collect();
        let error = ErrorNorm::between(&track.displacements, &closed);
        assert!(error < 1e-12, "damping ratio {ratio}: {error:e}");
        assert!(
            error <= track.error.max(1e-14),
            "{error:e}, it says {:e}",
            track.error
        );
    }
}

#[test]
fn what_nothing_holds_flies_on() {
    let model = oscillator(0.0, 0.0, &[(Ramp::Linear, 3.0)]);
    let start = State::new(vec![1.0], vec![2.0]);
    let track = follow_affordably(&model, &start, &[0.0, 0.5, 4.0]).unwrap();
    // u = u0 + v0 t + t^3/2.
    for (found, exact) in track.displacements.iter().zip([1.0, 2.0625, 41.0]) {
        assert!((found[0] / exact - 1.0).abs() < 1e-10, "{found:?} {exact}");
    }
}

#[test]
fn a_chain_is_the_sum_of_its_modes() {
    // Masses m between springs k, held at both ends: omega_j = 2 sqrt(k/m) sin(j pi/(2 (n + 1))).
    let (n, k, m) = (30_u32, 900.0, 0.25);
    let (alpha, beta) = (0.7, 2e-4);
    let pattern = Pattern::from_elements(n as usize, (1..n).map(|i| [i - 1, i])).unwrap();
    let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
    for i in 0..n {
        stiffness.add_block(i, i, &[2.0 * k]).unwrap();
        if i > 0 {
            stiffness.add_block(i - 1, i, &[-k]).unwrap();
            stiffness.add_block(i, i - 1, &[-k]).unwrap();
        }
    }
    let damping = Damping {
        mass: alpha,
        stiffness: beta,
        extra: None,
    };
    let load = Load {
        ramp: Ramp::Step,
        entries: vec![(4, 2.0)],
    };
    let masses = vec![m; n as usize];
    let operators = LinearOperators::new(masses, stiffness, damping, vec![load]).unwrap();
    let times = instants(2.0, 40);
    let start = State::at_rest(n as usize);
    let track = follow_affordably(&LinearModel::new(operators), &start, &times).unwrap();

    let ends = f64::from(n + 1);
    let shape = |mode: u32, mass: u32| {
        let angle = f64::from(mode) * f64::from(mass + 1) * std::f64::consts::PI / ends;
        (2.0 / ends / m).sqrt() * angle.sin()
    };
    let at = |t: f64| {
        let mut u = vec![0.0; n as usize];
        for mode in 1..=n {
            let half = f64::from(mode) * std::f64::consts::PI / (2.0 * ends);
            let omega = 2.0 * (k / m).sqrt() * half.sin();
            let oscillator = DampedOscillator {
                omega,
                damping: alpha + beta * omega * omega,
                load: 2.0 * shape(mode, 4),
                displacement: 0.0,
                velocity: 0.0,
            };
            let q = oscillator.at(t).0;
            for (i, u) in (0..n).zip(&mut u) {
                *u += q * shape(mode, i);
            }
        }
        u
    };
    let modal: Vec<Vec<f64>> = times.iter().map(|t| at(*t)).collect();
    let error = ErrorNorm::between(&track.displacements, &modal);
    assert!(error < 1e-12, "{error:e}");
    assert!(error <= track.error, "{error:e}, it says {:e}", track.error);
    assert!(track.error < 1e-9, "{:e}", track.error);
}

#[test]
fn a_moved_base_swings_its_oscillator_as_duhamels_integral_says() {
    // q'' + d q' + w^2 q = w^2 x + d x' with x = (1 - cos(r t))/2 up to its rise.
    let (w, d, rise) = (50.0_f64, 3.0_f64, 0.4);
    let base = Ramp::Sin2 { rise };
    let model = oscillator(w, d, &[(base.clone(), w * w), (base.rate(), d)]);
    let times = instants(rise, 8);
    let track = follow_affordably(&model, &State::at_rest(1), &times).unwrap();
    // The steady part solves the equation: Q = 1/2 + a cos(r t) + b sin(r t), from
    // (w^2 - r^2) a + d r b = -w^2/2 and (w^2 - r^2) b - d r a = d r/2.
    let r = std::f64::consts::PI / rise;
    let (p, s) = (w * w - r * r, d * r);
    let size = p * p + s * s;
    let a = (-w * w / 2.0 * p - s * s / 2.0) / size;
    let b = (s / 2.0 * p - s * w * w / 2.0) / size;
    let free = DampedOscillator {
        omega: w,
        damping: d,
        load: 0.0,
        displacement: -0.5 - a,
        velocity: -r * b,
    };
    for (t, u) in times.iter().zip(&track.displacements) {
        let (sin, cos) = (r * t).sin_cos();
        let exact = 0.5 + a * cos + b * sin + free.at(*t).0;
        assert!((u[0] - exact).abs() < 1e-13, "{} {exact} at {t}", u[0]);
    }
}

/// A body of a few cells.
fn body(material: &str, more: &str) -> Simulation {
    let text = format!(
        "[mesh]\ncube = {{ cells = 4, edge = 0.1, split = \"kuhn\" }}\n[[region]]\ndensity = 1060.0\n\
         youngs_modulus = 3500.0\n{material}\n{more}\n\
         [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.1\n"
    );
    let scene = Scene::parse(SceneSource::new("small.toml", text)).unwrap();
    scene.build().unwrap()
}

const LINEAR: &str = "model = \"linear\"\npoissons_ratio = 0.45";
const LOADED: &str =
    "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\nforce = [0.0, 0.01, -0.04]\n";

/// Bodies with everything that a reference must follow, by name.
fn bodies() -> Vec<(&'static str, Simulation)> {
    let step = format!("{LOADED}ramp = {{ kind = \"step\" }}\n");
    let jumps = format!(
        "{LOADED}ramp = {{ kind = \"pulse\", from = 0.0613, to = 0.1207 }}\n\
         [[load]]\ngroup = \"bottom\"\nforce = [0.02, 0.0, 0.0]\n\
         ramp = {{ kind = \"table\", times = [0.0, 0.05, 0.2], values = [0.0, 2.0, -1.0] }}\n"
    );
    let moved = "[[fixed]]\ngroup = \"bottom\"\n[[move]]\ngroup = \"top\"\n\
                 displacement = [0.0, 0.0, -0.01]\nramp = { kind = \"sin2\", rise = 0.1 }\n";
    let springs =
        "model = \"springs\"\nsprings = { rule = \"lloyd\", damping_ratio = 0.05 }".to_owned();
    vec![
        ("undamped", body(LINEAR, &step)),
        (
            "mass damping",
            body(LINEAR, &format!("{step}[damping]\nmass = 20.0\n")),
        ),
        (
            "stiffness damping",
            body(LINEAR, &format!("{step}[damping]\nstiffness = 1e-4\n")),
        ),
        ("dashpots", body(&springs, &step)),
        (
            "jumps",
            body(LINEAR, &format!("{jumps}[damping]\nmass = 5.0\n")),
        ),
        (
            "a moved support",
            body(
                LINEAR,
                &format!("{moved}[damping]\nmass = 5.0\nstiffness = 1e-4\n"),
            ),
        ),
    ]
}

/// omega t after some time (s).
fn turned(simulation: &Simulation, duration: f64) -> f64 {
    let operators = simulation.system().as_linear().unwrap().operators();
    Spectrum::of(operators).omega_max * duration
}

fn affordable(simulation: &Simulation, times: &[f64]) -> Track {
    follow_affordably(simulation.system(), simulation.initial_state(), times).unwrap()
}

#[test]
fn it_differs_from_the_reference_to_rounding_by_no_more_than_it_says() {
    let times = instants(0.3, 30);
    for (name, simulation) in bodies() {
        let track = affordable(&simulation, &times);
        let exact = follow(simulation.system(), simulation.initial_state(), &times).unwrap();
        let error = ErrorNorm::between(&track.displacements, &exact.displacements);
        let said = track.error;
        // The other has rounding of its own.
        let both = said + exact.error;
        assert!(
            error <= both,
            "{name}: {error:e}, they say {both:e}, it {said:e}"
        );
        assert!(said < 1e-8, "{name}: {said:e}");
        assert_eq!(track.method, ReferenceMethod::Faber);
        assert_eq!(exact.method, ReferenceMethod::Taylor);
        assert!((track.max_u / exact.max_u - 1.0).abs() < 0.05, "{name}");
        let late = track.late_amplitude / exact.late_amplitude;
        assert!((0.75..1.05).contains(&late), "{name}: {late}");
    }
}

#[test]
fn it_takes_at_most_4_sweeps_for_each_unit_of_omega_t() {
    for (name, simulation) in bodies() {
        // Three jumps cut as many steps short, which counts in a short run.
        let turns: &[f64] = match name {
            "jumps" => &[400.0],
            _ => &[150.0, 400.0],
        };
        for omega_t in turns {
            let duration = omega_t / turned(&simulation, 1.0);
            let track = affordable(&simulation, &instants(duration, 20));
            let sweeps = track.sweeps as f64 / omega_t;
            assert!(sweeps <= 4.0, "{name}, {omega_t}: {sweeps}");
            assert!(track.error < 1e-8, "{name}: {:e}", track.error);
        }
    }
}

#[test]
fn errors_below_a_hundred_times_its_own_are_no_numbers_for_it() {
    let (_, simulation) = bodies().swap_remove(1);
    let times = instants(0.3, 30);
    let track = affordable(&simulation, &times);
    assert_eq!(track.least_error(), 100.0 * track.error);
    let exact = follow(simulation.system(), simulation.initial_state(), &times).unwrap();
    assert_eq!(exact.least_error(), 0.0);
}

#[test]
fn from_100_000_tetrahedra_on_a_case_has_it_and_tiny_errors_are_bounds() {
    let case = |cells: u32| {
        let text = format!(
            "[mesh]\ncube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}\n[[region]]\n\
             density = 1060.0\nyoungs_modulus = 3500.0\n{LINEAR}\n{LOADED}[damping]\nmass = 20.0\n\
             [run]\nduration = 0.01\nsamples = 4\nintegrator = \"newmark\"\ndt = 0.005\n"
        );
        let scene = Scene::parse(SceneSource::new("large.toml", text)).unwrap();
        Case::new("large", scene.build().unwrap()).unwrap()
    };
    let small = case(4);
    assert_eq!(small.samples().method, ReferenceMethod::Taylor);
    assert!(small.info().reference.starts_with("Taylor"));

    // 105 456 tetrahedra.
    let mut large = case(26);
    assert_eq!(large.samples().method, ReferenceMethod::Faber);
    let info = large.info();
    assert!(
        info.reference.starts_with("Faber series")
            && info.reference.contains("checked by its Taylor series"),
        "{}",
        info.reference
    );
    let mut measured = |integrator: &str, dt: f64| {
        let method = MethodChoice::new(integrator);
        measure(&mut large, &method, dt, Effort::UNTIMED).unwrap()
    };
    let exact = measured("propagator", 2.5e-3);
    let bound = exact.error_is_below.unwrap();
    assert_eq!(bound, 100.0 * info.reference_error);
    assert!(exact.error.unwrap() < bound && bound < 1e-6);
    assert!(exact.error_in_percent().unwrap().starts_with("< "));
    let rough = measured("central-difference", 5e-4);
    assert_eq!(rough.error_is_below, None);
    assert!(rough.error.unwrap() > 1e-4 && !rough.error_in_percent().unwrap().contains('<'));
}
