//! Steps of a pulled cube: compared with a plain scalar loop, and automatic steps with fixed ones.

use serde::Serialize;
use sinew_core::{Options, Run, StableStep, State, StepReport, System};
use sinew_fem::{Element, LoadKind, Model};
use sinew_integrators::Stepper;
use sinew_mesh::structured::{Split, cube};
use sinew_sparse::simd::InstructionSet;
use sinew_verify::{LabError, tissue};

use super::elements::ElementMark;
use super::memory::bandwidth;
use super::plain_tets::PlainTets;
use super::roofs::Roofs;
use crate::median::median;
use crate::timed::{time, time_run};

/// Steps of one element on a cube that is pulled to 35 % mean stretch by a sudden dead traction.
#[derive(Clone, Debug, Serialize)]
pub struct PulledRow {
    /// The body.
    pub mesh: String,
    /// Its tetrahedra.
    pub tets: usize,
    /// The element: "p1", "fbar" or "fbar-edge".
    pub element: &'static str,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// CPU time of a step (s), median of alternating laps, on this computer.
    pub step_s: f64,
    /// Time of a step of a plain scalar loop over plain tetrahedra in f64 over its own time, median of laps.
    pub times_plain: f64,
    /// Floating-point operations of a step according to the formulas.
    pub operations: f64,
    /// Bytes that a step has to read from memory once: the nodes of tetrahedra, and the places where their forces are
    /// added; their shapes are those of a lattice.
    pub bytes: f64,
    /// Rate of operations over the lower of the limits by instructions and by memory.
    pub share_of_roof: f64,
    /// Relative difference of the displacement from that of the plain loop after the same number of steps; for plain
    /// tetrahedra.
    pub off_plain: Option<f64>,
    /// Relative difference of the displacement from a run with an eighth of the step in f64, for fixed steps.
    pub error: f64,
    /// The same for `dt = "auto"`.
    pub error_of_automatic: f64,
    /// Force evaluations of automatic steps over those of the fixed ones.
    pub forces_of_automatic: f64,
    /// CPU time of the run in automatic steps over that of the same number of forces in fixed steps, median of laps.
    pub over_fixed: f64,
}

/// Traction (Pa) on the top.
const TRACTION: f64 = 600.0;

/// Time that runs simulate (s).
const DURATION: f64 = 0.5;

/// Fixed step over the stable step at rest: stretched tissue has a smaller stable step.
const SHARE: f64 = 0.7;

/// Half of an automatic step over the stable step at rest.
const SHARE_OF_AUTOMATIC: f64 = 0.9;

const ELEMENTS: [(Element, &str); 3] = [
    (Element::P1, "p1"),
    (Element::Fbar { patch: None }, "fbar"),
    (tissue::EDGES, "fbar-edge"),
];

/// A run of laps.
struct Runner {
    element: usize,
    precision: &'static str,
    fixed: Laps,
    automatic: Laps,
    /// Times (s) of the plain loop for the same number of steps as the fixed run, lap by lap.
    plain: Vec<f64>,
    /// Displacements (m) at the end of the plain loop.
    plain_end: Vec<f64>,
}

struct Laps {
    integrator: Box<dyn Stepper>,
    dt: f64,
    steps: usize,
    end: State,
    work: StepReport,
    times: Vec<f64>,
}

impl Laps {
    fn new(model: &Model, options: &Options, dt: f64) -> Result<Self, LabError> {
        let steps = (DURATION / dt - 1e-9).ceil() as usize;
        let mut laps = Self {
            integrator: sinew_integrators::build("central-difference", options)?,
            dt: DURATION / steps as f64,
            steps,
            end: State::at_rest(model.dofs()),
            work: StepReport::default(),
            times: Vec::new(),
        };
        laps.integrator.prepare(model, laps.dt)?;
        Ok(laps)
    }

    /// Takes a lap from rest.
    fn take(&mut self, model: &Model) -> Result<(), LabError> {
        let run = Run {
            dt: self.dt,
            steps: self.steps,
            divergence_limit: f64::INFINITY,
        };
        self.end = State::at_rest(model.dofs());
        let (report, spent) = time_run(model, &mut *self.integrator, &mut self.end, &run)?;
        self.work = report.work;
        self.times.push(spent.cpu);
        Ok(())
    }

    fn time_a_force(&self, lap: usize) -> f64 {
        self.times[lap] / self.work.force_evaluations as f64
    }
}

/// Measures all elements in both precisions.
pub(super) fn rows(quick: bool, roofs: &Roofs) -> Result<Vec<PulledRow>, LabError> {
    let sizes: &[usize] = if quick { &[4] } else { &[10, 20] };
    let mut rows = Vec::new();
    for cells in sizes {
        rows.extend(on_cube(*cells, quick, roofs)?);
    }
    Ok(rows)
}

fn on_cube(cells: usize, quick: bool, roofs: &Roofs) -> Result<Vec<PulledRow>, LabError> {
    let mesh = cube(cells, tissue::EDGE, Split::Kuhn)?;
    let laps = if quick { 1 } else { 5 };
    let mut models = Vec::new();
    for (element, _) in ELEMENTS {
        let mut problem = tissue::standing(tissue::soft(), element);
        let pull = LoadKind::Traction([0.0, 0.0, TRACTION]);
        problem.loads = vec![sinew_verify::bodies::load("top", pull)];
        models.push(Model::build(&mesh, &problem)?);
    }
    let mut runners = Vec::new();
    let mut fine = Vec::new();
    for (element, model) in models.iter().enumerate() {
        let limit = stable_step(model)?;
        let mut exact = Laps::new(model, &Options::new(), SHARE * limit / 8.0)?;
        exact.take(model)?;
        fine.push(exact.end.u);
        for precision in ["f64", "f32"] {
            let options = Options::new().with_text("precision", precision);
            let automatic = options.clone().with_text("substeps", "auto");
            runners.push(Runner {
                element,
                precision,
                fixed: Laps::new(model, &options, SHARE * limit)?,
                automatic: Laps::new(model, &automatic, 2.0 * SHARE_OF_AUTOMATIC * limit)?,
                plain: Vec::new(),
                plain_end: Vec::new(),
            });
        }
    }
    let lame = sinew_fem::tetra::lame(tissue::YOUNGS_MODULUS, 0.45);
    for _ in 0..laps {
        for runner in &mut runners {
            let mut plain = PlainTets::new(&mesh, &models[0], lame.into());
            let (steps, dt) = (runner.fixed.steps, runner.fixed.dt);
            plain.begin(dt);
            let ((), spent) = time(|| plain.steps(steps, dt));
            runner.plain.push(spent.cpu);
            runner.plain_end = plain.of_cells(&models[0]).collect();
            let model = &models[runner.element];
            runner.fixed.take(model)?;
            runner.automatic.take(model)?;
        }
    }
    let tets = mesh.tets.len();
    let of = |runner: Runner| {
        let Runner {
            element,
            precision,
            fixed,
            automatic,
            plain,
            plain_end,
        } = runner;
        let (_, name) = ELEMENTS[element];
        let in_laps = |of: &dyn Fn(usize) -> f64| {
            let mut values: Vec<f64> = (0..laps).map(of).collect();
            median(&mut values)
        };
        let step_s = in_laps(&|lap| fixed.times[lap] / fixed.steps as f64);
        let operations = tets as f64 * operations_of(name);
        let bytes = tets as f64 * BYTES;
        let roof = roof(roofs, precision, operations / bytes, bytes);
        PulledRow {
            mesh: format!("cube {}^3", cells + 1),
            tets,
            element: name,
            precision,
            step_s,
            times_plain: in_laps(&|lap| plain[lap] / fixed.times[lap]),
            operations,
            bytes,
            share_of_roof: operations / step_s / roof,
            off_plain: (name == "p1").then(|| apart(&fixed.end.u, &plain_end)),
            error: apart(&fixed.end.u, &fine[element]),
            error_of_automatic: apart(&automatic.end.u, &fine[element]),
            forces_of_automatic: automatic.work.force_evaluations as f64
                / fixed.work.force_evaluations as f64,
            over_fixed: in_laps(&|lap| automatic.time_a_force(lap) / fixed.time_a_force(lap)),
        }
    };
    Ok(runners.into_iter().map(of).collect())
}

fn stable_step(model: &Model) -> Result<f64, LabError> {
    let method = sinew_integrators::build("central-difference", &Options::new())?;
    match method.stable_step(model)? {
        StableStep::UpTo(limit) => Ok(limit),
        StableStep::Any | StableStep::Unknown => Ok(f64::NAN),
    }
}

/// Relative difference of displacements.
pub(super) fn apart(found: &[f64], expected: &[f64]) -> f64 {
    let pairs = found.iter().zip(expected);
    let squares: f64 = pairs.map(|(a, b)| (a - b).powi(2)).sum();
    let size: f64 = expected.iter().map(|u| u * u).sum();
    (squares / size).sqrt()
}

/// Number of operations of a step for a tetrahedron according to the formulas of an element, two for a multiply-add.
fn operations_of(element: &str) -> f64 {
    // H (54) and J - 1 (32), times the volume, added to its patch.
    const MEANS: f64 = 88.0;
    // H times the volume, six edges each way at nine numbers, and the law (75) at 1.3 edges for each tetrahedron.
    const EDGES: f64 = 9.0 + 2.0 * 54.0 + 1.3 * 75.0 + 18.0;
    match element {
        "p1" => PlainTets::OPERATIONS,
        "fbar" => PlainTets::OPERATIONS + MEANS,
        _ => PlainTets::OPERATIONS + MEANS + EDGES,
    }
}

/// Bytes of a step for a tetrahedron of a lattice: four nodes, and the places of four corners. Its shape is shared.
const BYTES: f64 = 16.0 + 16.0;

/// Operations per second that instructions and memory allow.
fn roof(roofs: &Roofs, precision: &str, intensity: f64, bytes: f64) -> f64 {
    let best = InstructionSet::best().name();
    let own = roofs
        .multiply_adds
        .iter()
        .find(|rate| rate.precision == precision && rate.instructions == best);
    let of_instructions = own.map_or(f64::INFINITY, |rate| rate.operations_per_s);
    of_instructions.min(intensity * bandwidth(bytes as usize))
}

/// Smallest gains over the plain loop, of plain tetrahedra in f64 and in f32, up to 10,000 tetrahedra and beyond.
const GAINS: [[f64; 2]; 2] = [[2.7, 3.7], [2.0, 3.2]];

/// Largest time of automatic steps over that of the same number of forces in fixed steps.
const MOST_OVER_FIXED: f64 = 1.3;

/// The ratios that have a mark.
pub(super) fn marks(rows: &[PulledRow]) -> Vec<ElementMark> {
    let mut marks = Vec::new();
    for row in rows {
        let name = format!("{} pulled, {} {}", row.mesh, row.element, row.precision);
        if row.element == "p1" {
            let mark = GAINS[usize::from(row.tets > 10_000)][usize::from(row.precision == "f32")];
            marks.push(ElementMark {
                row: name.clone(),
                what: "times a plain scalar loop",
                value: row.times_plain,
                mark,
                reached: row.times_plain >= mark,
            });
        }
        marks.push(ElementMark {
            row: name,
            what: "automatic steps over as many fixed ones",
            value: row.over_fixed,
            mark: MOST_OVER_FIXED,
            reached: row.over_fixed <= MOST_OVER_FIXED,
        });
    }
    marks
}
