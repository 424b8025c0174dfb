//! Forces of hyperelastic elements, compared with those of plain tetrahedra and with scalar code.

use serde::Serialize;
use sinew_core::{
    ElementPrecision, ElementSweep, Equations, EvaluationError, LoadTime, SweepShape, System,
    sweep_alone,
};
use sinew_fem::{Element, Model, Problem};
use sinew_measure::thread_cpu_time;
use sinew_mesh::structured::{Split, cube};
use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::{Fields, Numbering, Precision};
use sinew_verify::LabError;

use crate::median::median;
use sinew_verify::tissue;

/// Forces of one law and element on a cube.
#[derive(Clone, Debug, Serialize)]
pub struct ElementRow {
    /// The body.
    pub mesh: String,
    /// Its tetrahedra.
    pub tets: usize,
    /// The law.
    pub law: &'static str,
    /// The element: "p1", "fbar" or "fbar-edge".
    pub element: &'static str,
    /// "f64" or "f32".
    pub precision: &'static str,
    /// Instructions; "scalar" for plain numbers.
    pub instructions: &'static str,
    /// Time of a sweep for each tetrahedron (ns), median of alternating laps, on this computer.
    pub ns_per_tet: f64,
    /// Time over that of plain neo-Hookean tetrahedra with the same precision and instructions, median of laps.
    pub ratio_to_p1: f64,
    /// Time with plain numbers in f64 over its own time, median of laps.
    pub gain_over_scalar: f64,
    /// Largest difference from the forces with plain numbers in f64, relative to the largest force.
    pub difference: f64,
}

/// Mark for a ratio in a row.
#[derive(Clone, Debug, Serialize)]
pub struct ElementMark {
    /// The body, law, element and precision.
    pub row: String,
    /// The ratio.
    pub what: &'static str,
    /// Its value.
    pub value: f64,
    /// Bound that the value should keep: the largest, or the smallest.
    pub mark: f64,
    /// True if the mark is reached.
    pub reached: bool,
}

/// Law, element and its name.
type Material = (&'static str, Element, &'static str);

const MATERIALS: [Material; 6] = [
    ("neo-hookean", Element::P1, "p1"),
    ("stable-neo-hookean", Element::P1, "p1"),
    ("stvk", Element::P1, "p1"),
    ("corotational", Element::P1, "p1"),
    ("neo-hookean", Element::Fbar { patch: None }, "fbar"),
    (
        "neo-hookean",
        Element::FbarEdge {
            edge_share: 0.9,
            patch: None,
        },
        "fbar-edge",
    ),
];

/// Approximate number of evaluations of a lap, in tetrahedra.
const LAP: usize = 200_000;

/// Sweeps of a law and element in some precision.
struct Runner {
    sweep: Box<dyn Sweep>,
    precision: &'static str,
    instructions: &'static str,
    /// Time of each lap for a tetrahedron (ns).
    laps: Vec<f64>,
}

trait Sweep {
    fn run(&mut self) -> Result<(), EvaluationError>;
    /// The forces (N), cell by cell.
    fn forces(&mut self) -> Vec<f64>;
}

struct Of<T> {
    sweep: Box<dyn ElementSweep<T>>,
    numbering: Numbering,
    fields: Fields<T>,
}

const SOURCE: usize = 0;
const OUT: usize = 1;

impl<T: ElementPrecision> Of<T> {
    /// The sweep of a model about a displacement; `None` if it is no force law.
    fn new(model: &Model, u: &[f64], set: InstructionSet) -> Option<Self> {
        let Equations::Forces(law) = model.equations() else {
            return None;
        };
        let forces = law.element_forces()?;
        let order = forces.order();
        let positions = order.len().next_multiple_of(T::LANES);
        let mut position = vec![0; order.len()];
        for (place, cell) in (0..).zip(order) {
            position[cell as usize] = place;
        }
        let numbering = Numbering::at(position, positions);
        let shape = SweepShape {
            numbering: &numbering,
            set,
            parts: 1,
        };
        let sweep = T::sweep_of(forces, shape);
        let mut fields = Fields::new(2, 3, positions, 0);
        for axis in 0..3 {
            let layer = fields.layer(SOURCE, axis);
            for (cell, u) in (0..).zip(u.iter().skip(axis).step_by(3)) {
                layer[numbering.position(cell)] = T::of(*u);
            }
        }
        Some(Self {
            sweep,
            numbering,
            fields,
        })
    }
}

impl<T: ElementPrecision> Sweep for Of<T> {
    fn run(&mut self) -> Result<(), EvaluationError> {
        let places = [SOURCE, OUT];
        let (sweep, fields) = (&mut *self.sweep, &mut self.fields);
        sweep_alone(sweep, fields, places, LoadTime::at(0.0))
    }

    fn forces(&mut self) -> Vec<f64> {
        let mut forces = vec![0.0; 3 * self.numbering.cells()];
        for axis in 0..3 {
            let layer = self.fields.layer(OUT, axis);
            for (cell, force) in (0..).zip(forces.iter_mut().skip(axis).step_by(3)) {
                *force = layer[self.numbering.position(cell)].to_f64();
            }
        }
        forces
    }
}

/// Measures all laws and elements.
pub(super) fn rows(quick: bool) -> Result<Vec<ElementRow>, LabError> {
    let sizes: &[usize] = if quick { &[4] } else { &[10, 20] };
    let mut rows = Vec::new();
    for cells in sizes {
        rows.extend(on_cube(*cells, quick)?);
    }
    Ok(rows)
}

fn on_cube(cells: usize, quick: bool) -> Result<Vec<ElementRow>, LabError> {
    let mesh = cube(cells, 0.1, Split::Kuhn)?;
    let tets = mesh.tets.len();
    let (laps, sweeps) = if quick {
        (3, 1)
    } else {
        (25, (LAP / tets).max(2))
    };
    let best = InstructionSet::best();
    let mut all: Vec<(Material, Vec<Runner>)> = Vec::new();
    for material in MATERIALS {
        let model = Model::build(&mesh, &problem(material))?;
        let mut u = vec![0.0; model.dofs()];
        for (u, [x, y, z]) in u.chunks_exact_mut(3).zip(&mesh.points) {
            u[0] = 0.01 * (25.0 * z).sin() - 0.2 * x + 2.0 * y * z;
            u[1] = 0.005 * (31.0 * x + 8.0 * y).cos() - 0.3 * z;
            u[2] = -0.25 * z + 0.15 * y + 3.0 * x * x;
        }
        let scalar = runner::<f64>(&model, &u, InstructionSet::Portable, "scalar");
        let double = runner::<f64>(&model, &u, best, best.name());
        let single = runner::<f32>(&model, &u, best, best.name());
        all.push((
            material,
            [scalar, double, single].into_iter().flatten().collect(),
        ));
    }
    for _ in 0..laps {
        for runner in all.iter_mut().flat_map(|(_, runners)| runners) {
            let before = thread_cpu_time();
            for _ in 0..sweeps {
                runner.sweep.run()?;
            }
            let spent = (thread_cpu_time() - before).as_secs_f64();
            runner.laps.push(1e9 * spent / (sweeps * tets) as f64);
        }
    }
    let p1: Vec<Vec<f64>> = all[0].1.iter().map(|runner| runner.laps.clone()).collect();
    let mut rows = Vec::new();
    for ((law, _, element), mut runners) in all {
        let scalar = runners[0].laps.clone();
        let expected = runners[0].sweep.forces();
        for (mut runner, p1) in runners.drain(..).zip(&p1) {
            let over = |a: &[f64], b: &[f64]| {
                let mut ratios: Vec<f64> = a.iter().zip(b).map(|(a, b)| a / b).collect();
                median(&mut ratios)
            };
            rows.push(ElementRow {
                mesh: format!("cube {}^3", cells + 1),
                tets,
                law,
                element,
                precision: runner.precision,
                instructions: runner.instructions,
                ratio_to_p1: over(&runner.laps, p1),
                gain_over_scalar: over(&scalar, &runner.laps),
                difference: difference(&runner.sweep.forces(), &expected),
                ns_per_tet: median(&mut runner.laps),
            });
        }
    }
    Ok(rows)
}

fn problem((id, element, _): Material) -> Problem {
    tissue::free(tissue::law(id, tissue::YOUNGS_MODULUS, 0.45), element)
}

fn runner<T: ElementPrecision>(
    model: &Model,
    u: &[f64],
    set: InstructionSet,
    instructions: &'static str,
) -> Option<Runner> {
    Some(Runner {
        sweep: Box::new(Of::<T>::new(model, u, set)?),
        precision: <T as Precision>::NAME,
        instructions,
        laps: Vec::new(),
    })
}

fn difference(found: &[f64], expected: &[f64]) -> f64 {
    let size =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most: f64, x| x.abs().max(most));
    let off = size(&mut found.iter().zip(expected).map(|(a, b)| a - b));
    off / size(&mut expected.iter().copied())
}

/// Largest times over plain tetrahedra in f64 and in f32: of elements, and of rotations with vectors.
const TIMES: [(&str, &str, [f64; 2]); 3] = [
    ("neo-hookean", "fbar", [1.45, 1.45]),
    ("neo-hookean", "fbar-edge", [2.0, 2.2]),
    ("corotational", "p1", [2.4, 2.4]),
];

/// Laws whose vectors in single precision should be [`GAIN`] times as fast as plain numbers in double.
const GAINS: [&str; 2] = ["stvk", "neo-hookean"];
const GAIN: f64 = 4.5;

/// The ratios that have a mark.
pub(super) fn marks(rows: &[ElementRow]) -> Vec<ElementMark> {
    let mut marks = Vec::new();
    for row in rows.iter().filter(|row| row.instructions != "scalar") {
        let name = format!(
            "{}, {} {}, {} {}",
            row.mesh, row.law, row.element, row.precision, row.instructions
        );
        for (law, element, [in_double, in_single]) in TIMES {
            let mark = match row.precision {
                "f64" => in_double,
                _ => in_single,
            };
            if (row.law, row.element) == (law, element) {
                marks.push(ElementMark {
                    row: name.clone(),
                    what: "time over p1",
                    value: row.ratio_to_p1,
                    mark,
                    reached: row.ratio_to_p1 <= mark,
                });
            }
        }
        if GAINS.contains(&row.law) && row.element == "p1" && row.precision == "f32" {
            marks.push(ElementMark {
                row: name,
                what: "gain over f64 scalar",
                value: row.gain_over_scalar,
                mark: GAIN,
                reached: row.gain_over_scalar >= GAIN,
            });
        }
    }
    marks
}
