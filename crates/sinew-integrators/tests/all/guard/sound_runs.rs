//! `saturation = "auto"` at and below the stable step: nothing is clamped, for any body.

use std::sync::Arc;

use crate::common::cube::{altered, mass_damping, scene};
use crate::common::tissue::{body, held, linear};
use crate::common::{build, plain};
use proptest::prelude::*;
use sinew_core::{
    BlockMatrix, Damping, Integrator, Layers, LinearModel, LinearOperators, LinearSystem, Load,
    OptionValue, Options, Pattern, Ramp, StableStep, State, System,
};
use sinew_fem::{LoadKind, LoadSpec, Model, Problem, Rayleigh, Region};
use sinew_integrators::explicit::Guarded;
use sinew_mesh::structured::{self, Split};
use sinew_mesh::{Group, GroupMembers, TetMesh};
use sinew_testkit::body::{Body, bodies_up_to, fastest_time};

/// Methods with a stable step on undamped bodies, and one that is stable at any step.
const METHODS: [&str; 5] = [
    "central-difference",
    "symplectic-euler",
    "rk4",
    "modified-leapfrog",
    "cnn-stabilised",
];

fn auto() -> Options {
    plain().with("saturation", OptionValue::Text("auto".into()))
}

/// The method's stable step [s]; twice that of leapfrog if it is stable at any step.
fn stable_step(id: &str, system: &dyn System) -> f64 {
    let of = |id| build(id, &plain()).stable_step(system).unwrap();
    match of(id) {
        StableStep::UpTo(limit) => limit,
        StableStep::Any => match of("central-difference") {
            StableStep::UpTo(limit) => 2.0 * limit,
            other => panic!("{other:?}"),
        },
        StableStep::Unknown => panic!("`{id}` has a stable step"),
    }
}

fn fact(integrator: &dyn Integrator, name: &str) -> f64 {
    let facts = integrator.facts();
    facts.iter().find(|fact| fact.name == name).unwrap().value
}

fn bits(state: &State) -> Vec<u64> {
    let all = [&state.u[..], &state.v, &state.a].concat();
    all.iter().map(|value| value.to_bits()).collect()
}

/// Follows a motion by each method with the guard and without, in steps that are these shares of the stable one.
fn assert_untouched(system: &dyn System, start: &State, shares: &[f64], steps: usize) {
    for id in METHODS {
        let limit = stable_step(id, system);
        for share in shares {
            let dt = share * limit;
            let (mut guarded, mut free) = (build(id, &auto()), build(id, &plain()));
            let (mut one, mut other) = (start.clone(), start.clone());
            for step in 0..steps {
                let work = guarded.step(system, &mut one, dt).unwrap();
                let expected = free.step(system, &mut other, dt).unwrap();
                assert_eq!(work, expected, "`{id}` at {share}, step {step}");
                let same = bits(&one) == bits(&other);
                assert!(same, "`{id}` at {share}, step {step}");
            }
            assert_eq!(fact(&*guarded, Guarded::SUBSTEPS), 1.0);
        }
    }
}

fn tissue() -> Region {
    Region::new(linear(3500.0, 0.3), 1060.0)
}

fn pulse(group: &str, traction: [f64; 3], to: f64) -> LoadSpec {
    LoadSpec::new(group, LoadKind::Traction(traction)).with_ramp(Ramp::Pulse { from: 0.0, to })
}

/// A bar whose width at each height (between 0 and 1) is this share of that of the block.
fn shaped(cells: [usize; 3], edges: [f64; 3], width: impl Fn(f64) -> f64) -> TetMesh {
    let mut mesh = structured::block(cells, edges, Split::Kuhn).unwrap();
    for [x, y, z] in &mut mesh.points {
        let width = width(*z / edges[2]);
        *x = edges[0] / 2.0 + width * (*x - edges[0] / 2.0);
        *y = edges[1] / 2.0 + width * (*y - edges[1] / 2.0);
    }
    mesh
}

/// A bar 0.3 m long and 15 mm thick at its foot, free, under a pulse on the foot.
fn whip(width: impl Fn(f64) -> f64) -> Model {
    let mesh = shaped([1, 1, 30], [0.015, 0.015, 0.3], width);
    let problem = Problem::of([tissue()]).with_load(pulse("bottom", [0.0, 0.0, 100.0], 0.015));
    Model::build(&mesh, &problem).unwrap()
}

fn cone(ratio: f64) -> impl Fn(f64) -> f64 {
    move |height| 1.0 + (1.0 / ratio - 1.0) * height
}

fn horn(ratio: f64) -> impl Fn(f64) -> f64 {
    move |height| ratio.powf(-height)
}

/// The motion until the pulse has come back from the tip: waves run at 1.82 m/s.
#[test]
fn cones_and_horns_whip_as_without_a_guard() {
    let time = 1.3 * 0.3 / 1.82;
    for model in [whip(cone(10.0)), whip(cone(20.0)), whip(horn(20.0))] {
        let start = State::at_rest(model.dofs());
        for share in [0.5, 0.9, 1.0] {
            let dt = share * stable_step("central-difference", &model);
            assert_untouched(&model, &start, &[share], (time / dt) as usize);
        }
    }
}

// Bodies at random.

/// A tapered, notched or two-material body, its loads and its initial motion.
#[derive(Clone, Debug)]
struct Slender {
    cells: [usize; 3],
    /// Widths of foot, tip and notch, relative.
    widths: [f64; 3],
    /// Height of the notch (between 0 and 1).
    notch: f64,
    /// Modulus (Pa) and density (kg/m^3) of the upper half, if it is of another material.
    upper: Option<(f64, f64)>,
    poissons_ratio: f64,
    damping: Rayleigh,
    acts: Acts,
    /// Size of the first displacements (m) and velocities (m/s).
    motion: [f64; 2],
    seed: u64,
}

#[derive(Clone, Debug)]
enum Acts {
    Nothing,
    /// A pulse on a free body, up to this time (s).
    Pulse([f64; 3], f64),
    /// A load on a body fixed at its foot, within this time (s).
    Sin2([f64; 3], f64),
    /// Gravity on a body fixed at its foot (m/s^2).
    Gravity([f64; 3]),
}

impl Slender {
    fn model(&self) -> Model {
        let [foot, tip, notch] = self.widths;
        let mut mesh = shaped(self.cells, [0.04, 0.04, 0.2], |height| {
            let depth = 1.0 - (1.0 - notch) * (-(12.0 * (height - self.notch)).powi(2)).exp();
            depth * (foot + (tip - foot) * height)
        });
        let mut regions = vec![tissue()];
        regions[0].law = linear(3500.0, self.poissons_ratio);
        if let Some((modulus, density)) = self.upper {
            let half = mesh.tets.len() as u32 / 2;
            for (name, tag, members) in [("lower", 11, 0..half), ("upper", 12, half..2 * half)] {
                mesh.groups.push(Group {
                    name: name.into(),
                    dim: 3,
                    tag,
                    members: GroupMembers::Tets(members.collect()),
                });
            }
            regions[0].group = Some("lower".into());
            regions.push(Region::new(linear(modulus, self.poissons_ratio), density).on("upper"));
        }
        let fixed = vec![held("bottom", [true; 3])];
        let mut problem = Problem::of(regions).with_damping(self.damping);
        match self.acts {
            Acts::Nothing => {}
            Acts::Pulse(traction, to) => problem.loads = vec![pulse("bottom", traction, to)],
            Acts::Sin2(traction, rise) => {
                problem.fixed = fixed;
                problem.loads = vec![LoadSpec {
                    ramp: Ramp::Sin2 { rise },
                    ..pulse("top", traction, 1.0)
                }];
            }
            Acts::Gravity(gravity) => {
                problem.fixed = fixed;
                problem.gravity = Some(gravity);
            }
        }
        Model::build(&mesh, &problem).unwrap()
    }

    fn start(&self, model: &Model) -> State {
        let mut seed = self.seed | 1;
        let mut field = |size: f64| -> Vec<f64> {
            let next = |_| {
                // xorshift64: Marsaglia, J. Stat. Softw. 8(14), 2003.
                seed ^= seed << 13;
                seed ^= seed >> 7;
                seed ^= seed << 17;
                size * (2.0 * (seed >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
            };
            (0..model.dofs()).map(next).collect()
        };
        let [u, v] = self.motion;
        State::new(field(u), field(v))
    }
}

fn slender_bodies() -> impl Strategy<Value = Slender> {
    let share = || (-1.5..0.0).prop_map(|power: f64| 10.0_f64.powf(power));
    let widths = prop_oneof![
        (share(), share()).prop_map(|(foot, tip)| [foot, tip, 1.0]),
        share().prop_map(|notch| [1.0, 1.0, notch]),
        (share(), share()).prop_map(|(tip, notch)| [1.0, tip, notch]),
    ];
    let material = ((1.0..6.0), (2.0..4.0))
        .prop_map(|(e, rho): (f64, f64)| (10.0_f64.powf(e), 10.0_f64.powf(rho)));
    let vector = |size: f64| [-size..size, -size..size, -size..size];
    let acts = prop_oneof![
        Just(Acts::Nothing),
        (vector(500.0), 1e-4..0.1).prop_map(|(traction, to)| Acts::Pulse(traction, to)),
        (vector(50.0), 1e-4..0.1).prop_map(|(traction, rise)| Acts::Sin2(traction, rise)),
        vector(10.0).prop_map(Acts::Gravity),
    ];
    let damping = prop_oneof![
        Just(Rayleigh::default()),
        (0.0..100.0, 0.0..1e-3).prop_map(|(mass, stiffness)| Rayleigh::new(mass, stiffness)),
    ];
    let size = |largest: f64| prop_oneof![Just(0.0), 0.0..largest];
    (
        [1..3_usize, 1..3_usize, 4..9_usize],
        (widths, 0.2..0.9),
        prop::option::of(material),
        (-0.3..0.49, damping),
        (acts, [size(1e-3), size(1.0)]),
        any::<u64>(),
    )
        .prop_map(
            |(cells, (widths, notch), upper, (poissons_ratio, damping), (acts, motion), seed)| {
                Slender {
                    cells,
                    widths,
                    notch,
                    upper,
                    poissons_ratio,
                    damping,
                    acts,
                    motion,
                    seed,
                }
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// A run in which nothing is saturated is the method's own, since a guard only clamps a step that it does not
    /// divide.
    #[test]
    fn no_slender_body_is_clamped_at_or_below_the_stable_step(body in slender_bodies()) {
        let model = body.model();
        let start = body.start(&model);
        for id in METHODS {
            let limit = stable_step(id, &model);
            for share in [0.95, 1.0] {
                let (mut guarded, mut state) = (build(id, &auto()), start.clone());
                for step in 0..120 {
                    let work = guarded.step(&model, &mut state, share * limit).unwrap();
                    prop_assert_eq!(work.saturated, 0, "`{}` at {}, step {}", id, share, step);
                }
                prop_assert_eq!(fact(&*guarded, Guarded::SUBSTEPS), 1.0);
            }
        }
    }
}

/// The same body with a load that acts for a while only, so that it needs no supports.
fn briefly_loaded(mut body: Body, time: f64) -> Body {
    body.problem.gravity = None;
    for load in &mut body.problem.loads {
        load.ramp = Ramp::Pulse {
            from: 0.0,
            to: time,
        };
    }
    body
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_body_on_the_ground_moves_as_without_a_guard(
        body in bodies_up_to(4),
        u in prop_oneof![Just(0.0), 1e-6..1e-2],
        v in prop_oneof![Just(0.0), 1e-6..1.0],
    ) {
        let body = body.on_the_ground();
        let model = body.model();
        assert_untouched(&model, &body.state(&model, u, v), &[0.9, 1.0], 100);
    }

    #[test]
    fn any_floating_body_moves_as_without_a_guard(
        body in bodies_up_to(4),
        u in prop_oneof![Just(0.0), 1e-6..1e-2],
        v in prop_oneof![Just(0.0), 1e-6..1.0],
        share in 1.0..100.0,
    ) {
        let body = body.free();
        let time = share * fastest_time(&body.model());
        let body = briefly_loaded(body, time);
        let model = body.model();
        assert_untouched(&model, &body.state(&model, u, v), &[0.9, 1.0], 100);
    }
}

/// A beam ten times as long as thick, fixed at its foot.
fn beam(traction: [f64; 3], gravity: Option<[f64; 3]>, poissons_ratio: f64) -> (TetMesh, Model) {
    let mesh = structured::block([1, 1, 10], [0.01, 0.01, 0.1], Split::Kuhn).unwrap();
    let problem = Problem {
        fixed: vec![held("bottom", [true; 3])],
        loads: vec![LoadSpec {
            ramp: Ramp::Step,
            ..pulse("top", traction, 1.0)
        }],
        gravity,
        ..body(linear(3500.0, poissons_ratio))
    };
    let model = Model::build(&mesh, &problem).unwrap();
    (mesh, model)
}

#[test]
fn slender_and_incompressible_bodies_move_as_without_a_guard() {
    let untouched = |model: &Model, start: &State| assert_untouched(model, start, &[0.9, 1.0], 500);
    for poissons_ratio in [0.3, 0.49] {
        let at_rest = |model: &Model| State::at_rest(model.dofs());
        let bent = beam([0.1, 0.0, 0.0], None, poissons_ratio).1;
        untouched(&bent, &at_rest(&bent));
        let heavy = beam([0.0; 3], Some([1.0, 0.0, 0.0]), poissons_ratio).1;
        untouched(&heavy, &at_rest(&heavy));

        let (mesh, unloaded) = beam([0.0; 3], None, poissons_ratio);
        let height = |node: &u32| mesh.points[*node as usize][2];
        let moved = |by: &dyn Fn(f64) -> [f64; 3]| -> Vec<f64> {
            let nodes = unloaded.nodes().iter();
            nodes.flat_map(|node| by(height(node))).collect()
        };
        let still = vec![0.0; unloaded.dofs()];
        for start in [
            State::new(still.clone(), moved(&|_| [1.0, 0.0, 0.0])),
            State::new(moved(&|z| [0.0, 0.0, 0.1 * z]), still.clone()),
            State::new(moved(&|z| [z * z, 0.0, 0.0]), still),
        ] {
            untouched(&unloaded, &start);
        }
    }
    for poissons_ratio in [0.45, 0.499] {
        let model = scene(6, 0.1, linear(3500.0, poissons_ratio), mass_damping(0.0));
        assert_untouched(&model, &State::at_rest(model.dofs()), &[0.9], 500);
    }
}

// One mode with all the energy, and whips without a body.

/// An oscillator of 1 rad/s under a load of 1 N.
fn oscillator(damping: Damping, ramp: Ramp) -> LinearModel {
    let operators = LinearOperators::oscillator(1.0, 1.0, 0.0).unwrap();
    let matrix = operators.stiffness().as_ref().clone();
    let load = Load {
        ramp,
        entries: vec![(0, 1.0)],
    };
    LinearModel::new(LinearOperators::new(vec![1.0], matrix, damping, vec![load]).unwrap())
}

fn ramps() -> impl Strategy<Value = Ramp> {
    let table = prop::collection::vec((0.01..3.0, -1.0..1.0), 1..12).prop_map(|points| {
        let mut time = 0.0;
        let (mut times, mut values) = (Vec::new(), Vec::new());
        for (apart, value) in points {
            time += apart;
            times.push(time);
            values.push(value);
        }
        Ramp::Table { times, values }
    });
    prop_oneof![
        Just(Ramp::Step),
        (0.01..5.0).prop_map(|rise| Ramp::Sin2 { rise }),
        (0.01..5.0).prop_map(|to| Ramp::Pulse { from: 0.0, to }),
        table,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    /// One mode with the whole energy reaches the bound of a body's energy. Cases: damping that is weak, critical or
    /// far beyond critical, of mass or of stiffness, and mass damping that no step resolves.
    #[test]
    fn no_mode_with_all_the_energy_is_clamped(
        mass in prop_oneof![Just(0.0), 0.0..4.0, Just(2.0), 0.0..50.0],
        stiffness in prop_oneof![Just(0.0), 0.0..4.0, Just(2.0), 0.0..50.0],
        ramp in ramps(),
        u in prop_oneof![Just(0.0), -2.0..2.0],
        v in prop_oneof![Just(0.0), -2.0..2.0],
        share in prop_oneof![Just(1.0), 0.0..1.0, 0.9..1.0],
    ) {
        let damping = Damping { mass, stiffness, extra: None };
        let system = oscillator(damping, ramp);
        for id in METHODS.into_iter().chain(["forward-euler", "cnn", "cnn-symplectic"]) {
            let limit = stable_step(id, &system);
            if limit == 0.0 {
                continue;
            }
            let (mut guarded, mut state) = (build(id, &auto()), State::new(vec![u], vec![v]));
            for step in 0..300 {
                let work = guarded.step(&system, &mut state, share * limit).unwrap();
                prop_assert_eq!(work.saturated, 0, "`{}`, step {}", id, step);
            }
        }
    }
}

/// Masses in a row, each lighter than the one before by the same factor, with springs that carry a wave to the lightest
/// without reflection; the first is fixed or pushed.
fn tapered_chain(masses: u32, lightest: f64) -> LinearModel {
    let factor = lightest.powf(1.0 / f64::from(masses - 1));
    let mass: Vec<f64> = (0..masses).map(|n| factor.powf(f64::from(n))).collect();
    let pairs: Vec<[u32; 2]> = (1..masses).map(|n| [n - 1, n]).collect();
    let pattern = Pattern::from_elements(masses as usize, pairs.iter()).unwrap();
    let mut stiffness = BlockMatrix::zeros(Arc::new(pattern), Layers::One);
    for pair in &pairs {
        let k = factor.powf(f64::from(pair[0]) + 0.5);
        stiffness.add_element(pair, &[k, -k, -k, k]).unwrap();
    }
    let load = Load {
        ramp: Ramp::Pulse { from: 0.0, to: 2.0 },
        entries: vec![(0, 1.0)],
    };
    LinearModel::new(LinearOperators::new(mass, stiffness, Damping::default(), vec![load]).unwrap())
}

/// In the exact motion, here rk4 at a twentieth of its stable step, each mass stays below a tenth of its limit: the
/// rest is a margin for the velocities that methods compute. The lightest mass becomes many times faster than the
/// first.
#[test]
fn the_limit_is_ten_times_a_bound_of_exact_motion_in_each_cell_of_a_whip() {
    for lightest in [0.1, 1e-3, 1e-6] {
        let chain = tapered_chain(30, lightest);
        let rest = State::at_rest(chain.dofs());
        let (mut rk4, mut state) = (build("rk4", &plain()), rest.clone());
        let mut guarded = build("rk4", &auto());
        guarded.step(&chain, &mut rest.clone(), 1e-9).unwrap();
        let largest = fact(&*guarded, Guarded::LARGEST_LIMIT);
        let dt = stable_step("rk4", &chain) / 20.0;
        let mut fastest = vec![0.0_f64; chain.dofs()];
        for _ in 0..4000 {
            rk4.step(&chain, &mut state, dt).unwrap();
            for (fastest, v) in fastest.iter_mut().zip(&state.v) {
                *fastest = fastest.max(v.abs());
            }
        }
        for (fastest, mass) in fastest.iter().zip(chain.mass()) {
            let limit = largest * f64::sqrt(lightest / mass);
            assert!(*fastest < limit / 10.0, "{mass}: {fastest} {limit}");
        }
        assert!(
            fastest[29] > 0.5 * fastest[0] / lightest.sqrt(),
            "{fastest:?}"
        );
        assert_untouched(&chain, &rest, &[0.5, 0.9, 1.0], 1000);
    }
}

#[test]
fn whips_of_extreme_taper_are_not_clamped() {
    for width in [1e-2, 1e-3] {
        let model = whip(horn(1.0 / width));
        let untouched = altered(
            &model,
            Damping::default(),
            model.operators().loads().to_vec(),
        );
        assert_untouched(&untouched, &State::at_rest(model.dofs()), &[0.9, 1.0], 200);
    }
}
