//! Blocks of tissue under large deformation, for the verification and the hard cases.

use crate::error::LabError;
use std::f64::consts::{PI, TAU};

use sinew_core::{Integrator, LinearSystem, Ramp, State, StepError, StepReport, System};
use sinew_fem::hyperelastic::{Hyperelastic, Parameters};
use sinew_fem::{Element, Law, LoadKind, LoadSpec, Model, On, Problem, Rayleigh};
use sinew_integrators::explicit::PatchedCentralDifference;
use sinew_integrators::{Frame, StaticError, static_solution_under};
use sinew_measure::reference::ErrorNorm;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};

use crate::bodies::held;

pub use crate::bodies::{DENSITY, YOUNGS_MODULUS, of_law as free};

/// Edge (m) of the cubes.
pub const EDGE: f64 = 0.1;

/// Size (m) of the slender column.
pub const COLUMN: [f64; 3] = [0.02, 0.02, 0.12];

/// A hyperelastic law with these moduli at small strain, and example values of its other parameters; the model refuses
/// an unknown law.
pub fn law(id: &'static str, youngs_modulus: f64, poissons_ratio: f64) -> Law {
    let parameters = Hyperelastic::parameters(id, youngs_modulus, poissons_ratio);
    let parameters = parameters.unwrap_or_else(|_| Parameters::new(youngs_modulus, poissons_ratio));
    Law::hyperelastic(id, parameters)
}

/// The law of most blocks: `neo-hookean`, E = 3500 Pa, nu = .45.
pub fn soft() -> Law {
    law("neo-hookean", YOUNGS_MODULUS, 0.45)
}

/// Tetrahedra whose volume is averaged over patches, and nine tenths of their shear over edges.
pub const EDGES: Element = Element::FbarEdge {
    edge_share: 0.9,
    patch: None,
};

/// A body on its fixed bottom.
pub fn standing(law: Law, element: Element) -> Problem {
    Problem {
        fixed: vec![held("bottom", [true; 3])],
        ..free(law, element)
    }
}

/// Damping in proportion to the masses (1/s).
pub fn of_mass(mass: f64) -> Rayleigh {
    Rayleigh::new(mass, 0.0)
}

/// A body and the state from which it starts.
pub struct Specimen {
    /// The body.
    pub model: Model,
    /// The state from which it starts.
    pub start: State,
}

impl Specimen {
    /// A body at rest.
    ///
    /// # Errors
    /// [`LabError`].
    pub fn new(mesh: &TetMesh, problem: &Problem) -> Result<Self, LabError> {
        let model = Model::build(mesh, problem)?;
        let start = State::at_rest(model.dofs());
        Ok(Self { model, start })
    }

    /// The body at rest with these displacements (m), given by the position of each node.
    pub fn displaced(mut self, by: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.start.u = self.field(by);
        self
    }

    /// The body undeformed with these velocities (m/s), given by the position of each node.
    pub fn thrown(mut self, at: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.start.v = self.field(at);
        self
    }

    /// The displacement (m) at rest under all loads at their full value.
    ///
    /// # Errors
    /// [`StaticError`].
    pub fn equilibrium(&self) -> Result<Vec<f64>, StaticError> {
        let loads: Vec<usize> = (0..self.model.operators().loads().len()).collect();
        static_solution_under(&self.model, &self.model.full_loads(&loads))
    }

    /// Displacements (m) at equally spaced instants, `steps` steps apart, and the work of all of them.
    ///
    /// # Errors
    /// [`StepError`].
    pub fn track(
        &self,
        integrator: &mut dyn Integrator,
        dt: f64,
        steps: usize,
        instants: usize,
    ) -> Result<(Vec<Vec<f64>>, StepReport), StepError> {
        let (mut state, mut work) = (self.start.clone(), StepReport::default());
        let mut track = Vec::with_capacity(instants);
        for _ in 0..instants {
            for _ in 0..steps {
                work += integrator.step(&self.model, &mut state, dt)?;
            }
            track.push(state.u.clone());
        }
        Ok((track, work))
    }

    /// The same by central difference.
    ///
    /// # Errors
    /// [`StepError`].
    pub fn by_central_difference(
        &self,
        dt: f64,
        steps: usize,
        instants: usize,
    ) -> Result<Vec<Vec<f64>>, StepError> {
        let mut integrator = Frame::new(PatchedCentralDifference::default());
        Ok(self.track(&mut integrator, dt, steps, instants)?.0)
    }

    /// A vector at each free node given by its position (m); fixed components are 0.
    pub fn field(&self, of: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<f64> {
        let points = &self.model.mesh().points;
        let nodes = self.model.nodes().iter();
        let mut field: Vec<f64> = nodes.flat_map(|node| of(points[*node as usize])).collect();
        for (value, is_held) in field.iter_mut().zip(self.model.pinned()) {
            if *is_held {
                *value = 0.0;
            }
        }
        field
    }
}

/// Error of displacements at all instants over the size of exact ones; infinite if there are fewer instants.
pub fn relative_error(found: &[Vec<f64>], exact: &[Vec<f64>]) -> f64 {
    if found.len() != exact.len() {
        return f64::INFINITY;
    }
    ErrorNorm::between(found, exact)
}

/// A cube that is stretched by half along z at constant volume, and released.
///
/// # Errors
/// [`LabError`].
pub fn release(cells: usize, law: Law, element: Element) -> Result<Specimen, LabError> {
    let mesh = block([cells; 3], [EDGE; 3], Split::Mirrored)?;
    let specimen = Specimen::new(&mesh, &standing(law, element))?;
    Ok(specimen.displaced(|[x, y, z]| {
        let narrower = (1.5_f64.powf(-0.5) - 1.0) * z / EDGE;
        let middle = EDGE / 2.0;
        [narrower * (x - middle), narrower * (y - middle), 0.5 * z]
    }))
}

/// A column that rotates about its axis, with this rate (1/s) at the top, after Bonet, Gil, Lee and others (Comput.
/// Methods Appl. Mech. Eng. 283, 2015).
///
/// # Errors
/// [`LabError`].
pub fn spun_column(
    cells: [usize; 3],
    size: [f64; 3],
    spin: f64,
    problem: &Problem,
) -> Result<Specimen, LabError> {
    let mesh = block(cells, size, Split::Mirrored)?;
    let specimen = Specimen::new(&mesh, problem)?;
    let [width, depth, height] = size;
    Ok(specimen.thrown(|[x, y, z]| {
        let speed = spin * (PI * z / (2.0 * height)).sin();
        [speed * (y - depth / 2.0), -speed * (x - width / 2.0), 0.0]
    }))
}

/// A cube with mass damping (1/s) under a force of 12 N on its top, spread by the trapezoidal rule, that follows a ramp.
///
/// # Errors
/// [`LabError`].
pub fn pressed(
    cells: usize,
    law: Law,
    element: Element,
    damping: f64,
    ramp: Ramp,
) -> Result<Specimen, LabError> {
    let mesh = block([cells; 3], [EDGE; 3], Split::Mirrored)?;
    let mut problem = standing(law, element);
    problem.damping = of_mass(damping);
    problem.loads = trapezoid(&mesh, cells, -12.0, &ramp);
    Specimen::new(&mesh, &problem)
}

/// A vertical force (N) on the top of a cube, as the trapezoidal rule spreads a traction: nodes at the rim receive
/// half, those at corners a quarter.
fn trapezoid(mesh: &TetMesh, cells: usize, force: f64, ramp: &Ramp) -> Vec<LoadSpec> {
    let within = 1e-9..EDGE - 1e-9;
    let rims = |x: f64| usize::from(!within.contains(&x));
    let of_rims = |rim: usize| {
        let nodes = (0u32..).zip(&mesh.points);
        let nodes: Vec<u32> = nodes
            .filter(|(_, [x, y, z])| *z > within.end && rims(*x) + rims(*y) == rim)
            .map(|(node, _)| node)
            .collect();
        let share = nodes.len() as f64 * 0.5_f64.powi(rim as i32) / (cells * cells) as f64;
        LoadSpec::new(On::Nodes(nodes), LoadKind::Force([0.0, 0.0, share * force]))
            .with_ramp(ramp.clone())
    };
    (0..3).map(of_rims).collect()
}

/// The angle (rad) by which the nodes at the top of a column rotated about its axis: the best fit to all of them,
/// nearest to `near`. Angles beyond half a turn thus follow from previous angles.
pub fn rotation_of_top(specimen: &Specimen, u: &[f64], near: f64) -> f64 {
    let mesh = specimen.model.mesh();
    let (low, high) = mesh.bounding_box();
    let middle = [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0);
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (node, u) in specimen.model.nodes().iter().zip(u.as_chunks::<3>().0) {
        let point = mesh.points[*node as usize];
        if point[2] > high[2] - 1e-9 * (high[2] - low[2]) {
            let [x, y] = [0, 1].map(|axis| point[axis] - middle[axis]);
            let [now_x, now_y] = [x + u[0], y + u[1]];
            sine += x * now_y - y * now_x;
            cosine += x * now_x + y * now_y;
        }
    }
    let angle = sine.atan2(cosine);
    angle + ((near - angle) / TAU).round() * TAU
}
