//! Large motions of neo-hookean blocks, a released stretch and a push: with substeps, in single precision and with the
//! paper's network. The results of fixed steps are in the verification.

use crate::common::{build, plain, relative_error};
use sinew_core::spectrum::largest_eigenvalue;
use sinew_core::{
    Batch, ElasticLaw, Inputs, LoadTime, Options, Ramp, StableStep, State, StepError, StepReport,
    System, TangentKind, Trial,
};
use sinew_fem::hyperelastic::Parameters;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::{
    Element, FibreFamily, Fixed, Law, LoadKind, LoadSpec, Model, On, Problem, Rayleigh, Region,
    Tissue,
};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{self, Split};

/// A block with its bottom fixed, and an initial state.
struct Scene {
    mesh: TetMesh,
    model: Model,
    problem: Problem,
    start: State,
    duration: f64,
}

impl Scene {
    fn new(
        (cells, size): ([usize; 3], [f64; 3]),
        duration: f64,
        change: impl FnOnce(&TetMesh, &mut Problem),
    ) -> Self {
        let mesh = structured::block(cells, size, Split::Mirrored).unwrap();
        let parameters = Parameters::new(3500.0, 0.45);
        let mut problem = Problem::of([Region::new(
            Law::hyperelastic("neo-hookean", parameters),
            1060.0,
        )])
        .with_fixed(Fixed::at("bottom"));
        change(&mesh, &mut problem);
        let model = Model::build(&mesh, &problem).unwrap();
        Self {
            start: State::at_rest(model.dofs()),
            mesh,
            model,
            problem,
            duration,
        }
    }

    /// Gives it another mass damping (1/s).
    fn damp(&mut self, rate: f64) {
        self.problem.damping.mass = rate;
        self.model = self.model.with_problem(&self.problem).unwrap();
    }

    /// Gives it another law, with exponential fibres along z: k1 (Pa) and k2.
    fn take_fibres(&mut self, id: &'static str, parameters: Parameters, [k1, k2]: [f64; 2]) {
        let region = &mut self.problem.regions[0];
        region.law = Law::hyperelastic(id, parameters);
        let stiffening = Stiffening::Exponential {
            k1,
            k2,
            dispersion: 0.0,
        };
        region.tissue = Tissue {
            fibres: vec![FibreFamily::new(
                Fibres::new(stiffening).unwrap(),
                [0.0, 0.0, 1.0],
            )],
            ..Tissue::default()
        };
        self.model = self.model.with_problem(&self.problem).unwrap();
    }

    /// A cube stretched by half along z at the volume of rest, and let go.
    fn release() -> Self {
        let mut scene = Self::new(([6; 3], [0.1; 3]), 0.5, |_, _| {});
        scene.start.u = scene.field(|[x, y, z]| {
            let s = 1.0 + (1.5_f64.powf(-0.5) - 1.0) * z / 0.1;
            [(s - 1.0) * (x - 0.05), (s - 1.0) * (y - 0.05), 0.5 * z]
        });
        scene
    }

    /// A cube under 12 N down, spread over its top by the trapezoidal rule.
    fn push() -> Self {
        Self::new(([6; 3], [0.1; 3]), 0.5, |mesh, problem| {
            problem.damping = Rayleigh::new(10.0, 0.0);
            let rims = |x: f64| !(1e-9..0.1 - 1e-9).contains(&x);
            for rim in 0..3 {
                let nodes = (0u32..).zip(&mesh.points).filter(|(_, [x, y, z])| {
                    *z > 0.1 - 1e-9 && usize::from(rims(*x)) + usize::from(rims(*y)) == rim
                });
                let nodes: Vec<u32> = nodes.map(|(node, _)| node).collect();
                let weight = nodes.len() as f64 * 0.5_f64.powi(rim as i32);
                problem.loads.push(
                    LoadSpec::new(
                        On::Nodes(nodes),
                        LoadKind::Force([0.0, 0.0, -12.0 * weight / 36.0]),
                    )
                    .with_ramp(Ramp::Sin2 { rise: 0.2 }),
                );
            }
        })
    }

    fn field(&self, of: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let nodes = self.model.nodes().iter();
        nodes
            .flat_map(|node| of(self.mesh.points[*node as usize]))
            .collect()
    }

    /// The displacements by central difference at `instants` instants, with `rate` steps per second.
    fn run(&self, rate: usize, instants: usize) -> Result<Vec<Vec<f64>>, StepError> {
        self.run_by("central-difference", &plain(), rate, instants)
    }

    fn run_by(
        &self,
        id: &str,
        options: &Options,
        rate: usize,
        instants: usize,
    ) -> Result<Vec<Vec<f64>>, StepError> {
        let mut integrator = build(id, options);
        let (mut state, dt) = (self.start.clone(), 1.0 / rate as f64);
        let steps = (self.duration * rate as f64 / instants as f64).round() as usize;
        let mut seen = Vec::new();
        for _ in 0..instants {
            for _ in 0..steps {
                integrator.step(&self.model, &mut state, dt)?;
            }
            seen.push(state.u.clone());
        }
        Ok(seen)
    }

    /// [`Scene::run`] extrapolated to a step of zero length.
    fn reference(&self, rate: usize, instants: usize) -> Vec<Vec<f64>> {
        let [coarse, fine] = [rate / 2, rate].map(|rate| self.run(rate, instants).unwrap());
        let pairs = coarse.into_iter().zip(fine);
        pairs
            .map(|(coarse, fine)| {
                let pairs = coarse.iter().zip(fine);
                pairs
                    .map(|(coarse, fine)| (4.0 * fine - coarse) / 3.0)
                    .collect()
            })
            .collect()
    }

    /// The stable step (s) of undamped leapfrog about a state, from the largest eigenvalue of the tangent with many
    /// digits.
    fn limit(&self, state: &State) -> f64 {
        let zero = vec![0.0; state.u.len()];
        let trial = Trial {
            load: LoadTime::at(state.t()),
            dt: 0.0,
            u: &state.u,
            v: &zero,
            internal: &[],
        };
        let omega_squared = largest_eigenvalue(self.model.mass(), |x, out| {
            let product = self
                .model
                .tangent_product(&trial, TangentKind::Exact, x, out);
            product.unwrap();
        });
        2.0 / omega_squared.sqrt()
    }
}

/// Checks that each value is within the tolerance of the expected one.
#[track_caller]
fn assert_near(found: impl IntoIterator<Item = f64>, expected: &[f64], tolerance: f64) {
    let found: Vec<f64> = found.into_iter().collect();
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        println!("{found:.6}, expected {expected}");
        assert!(
            (found - expected).abs() <= tolerance,
            "{found}, expected {expected}"
        );
    }
}

/// Steps divided by the current stiffness complete a release in which steps of the stable length at rest fail, and
/// continue from a saved state with the same bits.
#[test]
fn steps_follow_the_current_stiffness() {
    let scene = Scene::release();
    let by_stiffness = || build("central-difference", &plain().with_text("substeps", "auto"));
    let rest = match build("central-difference", &plain())
        .stable_step(&scene.model)
        .unwrap()
    {
        StableStep::UpTo(limit) => limit,
        other => panic!("{other:?}"),
    };
    assert_near([rest], &[3.539e-3], 1e-6);
    // At nine tenths of the stable step at rest the motion ends in a refusal or runs away.
    let plain_end = scene.run((1.0 / (0.9 * rest)) as usize, 50);
    assert!(plain_end.is_err(), "the stretch stiffens");

    let (dt, steps) = (0.01, 50);
    let mut state = scene.start.clone();
    let mut integrator = by_stiffness();
    let reference = scene.reference(16_000, 50);
    let (mut seen, mut parts, mut saved) = (Vec::new(), Vec::new(), None);
    for step in 0..steps {
        integrator.step(&scene.model, &mut state, dt).unwrap();
        seen.push(state.u.clone());
        let cut = state.cut.unwrap();
        parts.push(cut.parts);
        let true_limit = scene.limit(&state);
        let part = state.clock.last_step().unwrap();
        println!(
            "{step}: {part} s, {:.3} of the stable step",
            part / true_limit
        );
        // A few per cent beyond for a few steps leave the motion as it is.
        assert!(
            part <= 1.05 * true_limit,
            "step {step}: {part} s of {true_limit} s"
        );
        if step == 17 {
            saved = Some(state.to_bytes(&scene.model).unwrap());
        }
    }
    assert!(parts.iter().min() < parts.iter().max(), "{parts:?}");
    let error = relative_error(&seen, &reference);
    // Steps of 1/600 s have an error of 0.127.
    assert!(error < 0.15, "{error}");

    let mut resumed = State::from_bytes(&saved.unwrap(), &scene.model).unwrap();
    let mut fresh = by_stiffness();
    for _ in 18..steps {
        fresh.step(&scene.model, &mut resumed, dt).unwrap();
    }
    assert_eq!(resumed, state);
}

/// Fibres that stiffen a hundredfold within a step stop a pull of 4 kPa. Some steps are too long and are taken again.
/// The motion is that of fine steps, and continues from a saved state with the same bits.
#[test]
fn steps_that_fibres_stop_are_taken_again_in_shorter_parts() {
    let mut scene = Scene::new(([4; 3], [0.04; 3]), 0.1, |_, problem| {
        problem.damping.mass = 10.0;
        problem.loads = vec![LoadSpec::new("top", LoadKind::Traction([0.0, 0.0, 4000.0]))];
    });
    scene.take_fibres("neo-hookean", Parameters::new(5000.0, 0.45), [2000.0, 20.0]);
    let (options, dt, steps) = (plain().with_text("substeps", "auto"), 2e-3, 50);
    let mut integrator = build("central-difference", &options);
    let (mut state, mut saved, mut work) = (scene.start.clone(), None, StepReport::default());
    let mut seen = Vec::new();
    for step in 0..steps {
        work += integrator.step(&scene.model, &mut state, dt).unwrap();
        seen.push(state.u.clone());
        if step == 3 {
            saved = Some(state.to_bytes(&scene.model).unwrap());
        }
    }
    assert!(work.retaken > 0, "{work:?}");
    let error = relative_error(&seen, &scene.run(50_000, steps).unwrap());
    assert!(error < 0.1, "{error}");

    let mut resumed = State::from_bytes(&saved.unwrap(), &scene.model).unwrap();
    let mut fresh = build("central-difference", &options);
    let mut batch = Batch::new(&scene.model, Inputs::none(), dt, steps - 4);
    batch.take(&mut *fresh, &mut resumed).unwrap();
    assert_eq!(resumed, state);
}

/// A cube is thrown so fast that without fibres it would be half as long again after one step, which is far below the
/// stable step at rest. The fibres stop it, and its energy is kept.
#[test]
fn a_throw_against_fibres_keeps_its_energy() {
    let mut scene = Scene::new(([3; 3], [0.1; 3]), 0.3, |_, _| {});
    let parameters = Parameters::new(2000.0, 0.3);
    scene.take_fibres("stable-neo-hookean", parameters, [200.0, 35.0]);
    let mut integrator = build("central-difference", &plain().with_text("substeps", "auto"));
    let mut state = State::at_rest(scene.model.dofs());
    state.v = scene.field(|[_, _, z]| [0.0, 0.0, 8.0 * z / 0.1]);
    let energy = |state: &State| scene.model.energy(&state.u, &state.v).unwrap().total();
    let start = energy(&state);
    for step in 0..50 {
        integrator.step(&scene.model, &mut state, 6e-3).unwrap();
        let ratio = energy(&state) / start;
        assert!((0.9..1.1).contains(&ratio), "step {step}: {ratio}");
    }
}

/// The paper's network accepts the force of a law like any other: it is exact below forward Euler's stable step, which
/// damping provides, and refused by name if longer steps invert an element.
#[test]
fn the_papers_network_presses_tissue_below_its_stable_step_and_is_refused_beyond() {
    let mut scene = Scene::push();
    scene.damp(80.0);
    let reference = scene.reference(8000, 50);
    let network = |rate| scene.run_by("cnn", &plain(), rate, 50);
    let found = relative_error(&network(4000).unwrap(), &reference);
    assert_near([found], &[3e-4], 5e-5);
    let refused = network(2000).unwrap_err().to_string();
    assert!(
        refused.contains("element") && refused.contains("neo-hookean"),
        "{refused}"
    );
}

#[test]
#[cfg(feature = "implicit")]
fn options_that_need_matrices_are_refused_by_name_with_what_does_instead() {
    let scene = Scene::push();
    for (id, option, instead) in [
        ("cnn", "saturation", "give a number instead"),
        ("central-difference", "patches", "substeps = \"auto\""),
    ] {
        let options = plain().with_text(option, "auto");
        let refused = build(id, &options).prepare(&scene.model, 1e-4).unwrap_err();
        let refused = refused.to_string();
        let named = format!("`{id}` needs the matrices of a linear system for {option} = \"auto\"");
        assert!(
            refused.starts_with(&named) && refused.contains(instead),
            "{refused}"
        );
    }
}

/// An undamped cube that sags under its weight, at nine tenths of the stable step: a reduced number of substeps would
/// increase its oscillation.
#[test]
fn steps_by_the_current_stiffness_make_no_energy() {
    const GRAVITY: f64 = 9.81;
    let mut scene = Scene::new(([3; 3], [0.1; 3]), 5.0, |_, problem| {
        problem.gravity = Some([0.0, 0.0, -GRAVITY]);
    });
    scene.problem.regions[0].law = Law::hyperelastic("neo-hookean", Parameters::new(6000.0, 0.45));
    scene.model = scene.model.with_problem(&scene.problem).unwrap();
    for rate in [105, 120, 130] {
        let mut integrator = build("central-difference", &plain().with_text("substeps", "auto"));
        let mut state = scene.start.clone();
        let (mut most, mut off) = (0.0_f64, 0.0_f64);
        for _ in 0..5 * rate {
            integrator
                .step(&scene.model, &mut state, 1.0 / f64::from(rate))
                .unwrap();
            let mut v = vec![0.0; state.v.len()];
            state
                .velocity_at_t(&scene.model, Inputs::none(), &mut v)
                .unwrap();
            let stored = scene.model.energy(&state.u, &v).unwrap();
            let heights = state.u.iter().zip(scene.model.mass()).skip(2).step_by(3);
            let lost: f64 = heights.map(|(u, mass)| GRAVITY * mass * u).sum();
            most = most.max(stored.elastic);
            off = off.max((stored.total() + lost).abs());
        }
        assert!(off < 0.01 * most, "{rate}/s: {off} of {most} J");
    }
}

/// Comparison with the same steps in f64, also for a pressure that is a hundred times as large as the bending stress:
/// nothing in the loops is a difference of large numbers. An oscillating stretch has the largest error.
#[test]
fn single_precision_is_off_by_its_rounding() {
    let in_f32 = plain().with_text("precision", "f32");
    let mut stiff = Scene::push();
    let region = &mut stiff.problem.regions[0];
    region.law = Law::hyperelastic("neo-hookean", Parameters::new(3500.0, 0.499));
    region.element = Element::FbarEdge {
        edge_share: 0.9,
        patch: None,
    };
    stiff.model = stiff.model.with_problem(&stiff.problem).unwrap();
    for (name, scene, rate, most) in [
        ("push", Scene::push(), 2000, 1e-5),
        ("push, nu .499", stiff, 8000, 1e-4),
        ("release", Scene::release(), 4000, 1e-4),
    ] {
        let expected = scene.run(rate, 50).unwrap();
        let found = scene.run_by("central-difference", &in_f32, rate, 50);
        let off = relative_error(&found.unwrap(), &expected);
        println!("{name}: {off:.1e}");
        assert!(off < most && off > 1e-8, "{name}: {off:.1e}");
    }
}
