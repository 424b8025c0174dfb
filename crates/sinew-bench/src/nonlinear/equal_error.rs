//! Cost at equal error: elements that do not lock, compared with plain ones on finer meshes.

use std::sync::Arc;

use sinew_core::vectors::dot;
use sinew_core::{Integrator, Run, StableStep, State};
use sinew_fem::hyperelastic::{Hyperelastic, Parameters};
use sinew_fem::{Element, Law, LoadKind, Model, Problem};
use sinew_integrators::Method;
use sinew_integrators::explicit::CentralDifference;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};

use crate::median::median;
use crate::report::{percent, three};
use crate::results::Mark;
use crate::timed::time_run;
use sinew_verify::LabError;
use sinew_verify::MarkVerdict;
use sinew_verify::bodies::{DENSITY, YOUNGS_MODULUS, body, equilibrium, held, load, loads};
use sinew_verify::modes::lowest_omega_lumped;
use sinew_verify::places::triangles_where;
use sinew_verify::{Tet10, Tissue};

/// Largest CPU time over that of plain tetrahedra that passes.
const LIMIT: f64 = 0.25;

/// Share of the stable step.
const SHARE: f64 = 0.9;

/// The law of the simulated second.
const LAW: &str = Hyperelastic::IDS[0];

/// A body that bends or bulges, on meshes of any fineness.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    /// Ten times as long as thick, fixed at its root and pulled sideways at its tip.
    Cantilever,
    /// A cube fixed at its four sides and pressed from above.
    HeldCube,
}

/// A comparison: cells along an edge of the element that does not lock, those of the plain ones to be tried, coarse
/// ones first, and those of the 10-node tetrahedra of the reference.
struct Comparison {
    shape: Shape,
    cells: usize,
    plain: &'static [usize],
    reference: usize,
}

const COMPARISONS: [Comparison; 2] = [
    Comparison {
        shape: Shape::HeldCube,
        cells: 5,
        plain: &[10, 11, 12, 13, 14, 16, 18, 20],
        reference: 8,
    },
    Comparison {
        shape: Shape::Cantilever,
        cells: 2,
        plain: &[4, 8],
        reference: 2,
    },
];

/// Poisson's ratios.
const RATIOS: [f64; 3] = [0.45, 0.49, 0.499];

/// A body of one kind of element and its errors against 10-node tetrahedra.
struct Candidate {
    cells: usize,
    element: Element,
    /// Relative errors of the static deflection and of the first frequency.
    deflection: f64,
    frequency: f64,
}

/// The comparisons as marks; a quick run computes only the first one.
pub(super) fn marks(quick: bool, mut begins: impl FnMut(&str)) -> Vec<Mark> {
    let pairs = COMPARISONS
        .iter()
        .flat_map(|comparison| RATIOS.map(|nu| (comparison, nu)));
    let pairs = pairs.take(if quick { 1 } else { usize::MAX });
    pairs
        .map(|(comparison, nu)| {
            let case = format!(
                "the same error for less: {}, nu = {nu}",
                comparison.shape.words()
            );
            begins(&case);
            let (laps, meshes) = if quick { (1, 4) } else { (3, usize::MAX) };
            match comparison.measure(nu, laps, meshes) {
                Ok(mark) => Mark { case, ..mark },
                Err(error) => Mark {
                    case,
                    measured: error.to_string(),
                    ..asked()
                },
            }
        })
        .collect()
}

fn asked() -> Mark {
    Mark {
        asked: format!(
            "CPU of an explicit second at most {LIMIT} of that of plain tetrahedra with the same error"
        ),
        limit: Some(LIMIT),
        ..Mark::default()
    }
}

impl Comparison {
    fn measure(&self, nu: f64, laps: usize, most_meshes: usize) -> Result<Mark, LabError> {
        let reference = self.shape.tet10(self.reference, nu)?;
        let edge = Element::FbarEdge {
            edge_share: Element::EDGE_SHARE,
            patch: None,
        };
        let ours = self.shape.candidate(self.cells, edge, nu, reference)?;
        let mut plain = None;
        for &cells in self.plain.iter().take(most_meshes) {
            let candidate = self.shape.candidate(cells, Element::P1, nu, reference)?;
            let is_as_good = candidate.deflection.abs() <= ours.deflection.abs();
            plain = Some((candidate, is_as_good));
            if is_as_good {
                break;
            }
        }
        let (plain, is_as_good) =
            plain.ok_or_else(|| LabError::new("no mesh of plain tetrahedra is given"))?;
        let [mut first, mut second] = [
            Second::new(self.shape, &ours, nu)?,
            Second::new(self.shape, &plain, nu)?,
        ];
        let mut ratios = Vec::new();
        for _ in 0..laps {
            let (a, b) = (first.simulate()?, second.simulate()?);
            ratios.push(a / b);
        }
        let ratio = median(&mut ratios);
        Ok(Mark {
            // Plain tetrahedra that err more and cost so much would cost more yet with the same error.
            measured: match is_as_good {
                true => three(ratio),
                false => format!("below {}", three(ratio)),
            },
            figure: ratio.is_finite().then_some(ratio),
            by: format!("{} beside {}", ours.words("fbar-edge"), plain.words("p1")),
            verdict: MarkVerdict::of(ratio <= LIMIT),
            note: format!(
                "static deflection and first frequency (lumped mass) against 10-node tetrahedra, {} cells an edge; neo-hookean, {SHARE} of \
                 each one's stable step, laps in turn",
                self.reference
            ),
            ..asked()
        })
    }
}

impl Candidate {
    fn words(&self, element: &str) -> String {
        let signed = |error: f64| {
            let sign = if error < 0.0 { "−" } else { "+" };
            format!("{sign}{} %", percent(error.abs()))
        };
        format!(
            "{element}, {} cells: deflection {}, f1 {}",
            self.cells,
            signed(self.deflection),
            signed(self.frequency)
        )
    }
}

impl Shape {
    fn words(self) -> &'static str {
        match self {
            Self::Cantilever => "cantilever",
            Self::HeldCube => "cube held at its sides",
        }
    }

    fn mesh(self, cells: usize) -> Result<TetMesh, LabError> {
        let mesh = match self {
            Self::Cantilever => block([cells, cells, 10 * cells], [0.1, 0.1, 1.0], Split::Kuhn),
            Self::HeldCube => block([cells; 3], [0.1; 3], Split::Kuhn),
        };
        mesh.map_err(LabError::from)
    }

    /// Traction on the top (Pa): strains of a thousandth.
    fn traction(self) -> [f64; 3] {
        match self {
            Self::Cantilever => [0.01, 0.0, 0.0],
            Self::HeldCube => [0.0, 0.0, -4.0],
        }
    }

    fn problem(self, element: Element, nu: f64) -> Problem {
        let mut problem = body(YOUNGS_MODULUS, nu, element);
        let support = match self {
            Self::Cantilever => "bottom",
            Self::HeldCube => "sides",
        };
        problem.fixed = vec![held(support, [true; 3])];
        problem.loads = vec![load("top", LoadKind::Traction(self.traction()))];
        problem
    }

    /// Work (J) of the load on the equilibrium, and the first angular frequency (rad/s), of 10-node tetrahedra.
    fn tet10(self, cells: usize, nu: f64) -> Result<(f64, f64), LabError> {
        let mesh = self.mesh(cells)?;
        let tets = Tet10::new(&mesh);
        let top = triangles_where(&mesh, "top", |_| true)?;
        let force = tets.traction(&top, self.traction());
        let tissue = Tissue {
            youngs_modulus: YOUNGS_MODULUS,
            poissons_ratio: nu,
            density: DENSITY,
        };
        let is_side = |value: f64| value.min(0.1 - value) <= 1e-10;
        let held = tets.held(tissue, |[x, y, z]| match self {
            Self::Cantilever => z <= 1e-10,
            Self::HeldCube => is_side(x) || is_side(y),
        })?;
        let u = held.equilibrium(&force)?;
        Ok((
            dot(force.as_flattened(), u.as_flattened()),
            held.lowest_omega()?,
        ))
    }

    fn candidate(
        self,
        cells: usize,
        element: Element,
        nu: f64,
        (work, omega): (f64, f64),
    ) -> Result<Candidate, LabError> {
        let model = Model::build(&self.mesh(cells)?, &self.problem(element, nu))?;
        Ok(Candidate {
            cells,
            element,
            deflection: dot(&loads(&model), &equilibrium(&model)?) / work - 1.0,
            frequency: lowest_omega_lumped(&model)? / omega - 1.0,
        })
    }
}

/// A simulated second, to be timed repeatedly.
struct Second {
    model: Model,
    integrator: Box<dyn Integrator>,
    run: Run,
}

impl Second {
    fn new(shape: Shape, candidate: &Candidate, nu: f64) -> Result<Self, LabError> {
        let mut problem = shape.problem(candidate.element, nu);
        for region in &mut problem.regions {
            region.law = Law::hyperelastic(LAW, Parameters::new(YOUNGS_MODULUS, nu));
        }
        let model = Model::build_on(Arc::new(shape.mesh(candidate.cells)?), &problem)?;
        let mut integrator: Box<dyn Integrator> = CentralDifference.integrator();
        let StableStep::UpTo(stable) = integrator.stable_step(&model)? else {
            return Err(LabError::new("no stable step is known"));
        };
        let steps = (1.0 / (SHARE * stable)).ceil();
        let run = Run::covering(1.0, 1.0 / steps);
        integrator.prepare(&model, run.dt)?;
        Ok(Self {
            model,
            integrator,
            run,
        })
    }

    /// CPU time (s) of the second.
    fn simulate(&mut self) -> Result<f64, LabError> {
        let mut state = State::at_rest(sinew_core::System::dofs(&self.model));
        let (_, spent) = time_run(&self.model, &mut *self.integrator, &mut state, &self.run)?;
        Ok(spent.cpu)
    }
}
