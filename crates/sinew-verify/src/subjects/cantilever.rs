//! A cantilever ten times as long as thick under shear at its tip.

use sinew_core::System;
use sinew_core::vectors::dot;
use sinew_fem::{LoadKind, Model};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};

use crate::bodies::{DENSITY, YOUNGS_MODULUS, body, equilibrium, held, load, loads};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::inputs::Inputs;
use crate::kinds::Kind;
use crate::modes::lowest_omega_lumped;
use crate::places::{nodes_where, triangles_where};
use crate::reference::tet10::{Tet10, Tissue};
use crate::sources::{PROTOTYPE, SECOND};
use crate::subject::{Quoted, Subject};

pub(super) const SUBJECT: Subject = Subject {
    id: "cantilever",
    title: "Cantilever ten times as long as thick",
    says: "Work of a uniform shear traction on the tip over that of Timoshenko's beam, P L^3/(3 E I) + P L/(5/6 G A); the root is held \
           in x, y and z. Plain tetrahedra are too stiff in bending and far too stiff where the volume hardly changes. The first \
           frequency, with lumped mass, is beside Euler's and Bernoulli's 1.8751^2 sqrt(E I/(rho A L^4)). On meshes of gmsh patches \
           have 8 tetrahedra; those of the prototype grew in another way, so that its digits are held to 3 % there, and those of the \
           second computation, whose patches grow as ours, to the last. Twisted by forces on its tip that grow with the distance from the axis, \
           the beam turns between .3 and .7 of its length by less than Saint-Venant's M l/(.1406 G a^4).",
    checks,
    quoted: &[
        Quoted::new(
            "average nodal pressure",
            "Kuhn, 2 cells thick, nu .3/.45/.49/.499",
            ".602/.570/.534/.473",
        ),
        Quoted::new(
            "average nodal pressure",
            "Kuhn, 4 cells thick",
            ".846/.822/.804/.791",
        ),
        Quoted::new(
            "average nodal pressure",
            "gmsh, h = thickness/2, /4",
            ".611/.570/.519/.461, .869/.841/.815/.787",
        ),
        Quoted::new(
            "uniform strain by nodes, 5 % of the isochoric part local",
            "Kuhn, 2 and 4 cells thick",
            "1.351/1.296/1.212/.937, 1.089/1.073/1.064/1.055",
        ),
        Quoted::new(
            "shear by faces, volume by patches",
            "Kuhn, 2 and 4 cells thick",
            ".749/.749/.744/.742, .916/.907/.902/.901",
        ),
        Quoted::new(
            "shear by edges, volume by nodes",
            "Kuhn, 2 and 4 cells thick",
            "1.006/.940/.877/.723, 1.007/.983/.966/.953",
        ),
        Quoted::new(
            "MINI",
            "Kuhn, 2 and 4 cells thick",
            ".582/.555/.534/.527, .837/.816/.804/.800",
        ),
        Quoted::new(
            "MINI",
            "gmsh, h = thickness/2, /4",
            ".585/.547/.518/.508, .857/.832/.816/.811",
        ),
    ],
};

const THICKNESS: f64 = 0.1;
const LENGTH: f64 = 10.0 * THICKNESS;
/// Traction at the tip (Pa).
const TRACTION: f64 = 0.1;

/// A mesh of the beam.
#[derive(Clone, Copy)]
enum BeamMesh {
    /// Cells over the thickness, ten times as many along z.
    Kuhn(usize),
    /// Six cells over the thickness and forty along z, which are longer than thick.
    Long,
    /// A file, along x.
    Gmsh(&'static str),
}

/// A file whose edges are half the thickness.
const HALF: BeamMesh = BeamMesh::Gmsh("cantilever-2");
/// A file whose edges are a quarter of the thickness.
const QUARTER: BeamMesh = BeamMesh::Gmsh("cantilever-4");

/// Figures from before the library.
const LOCKING: Source = Source::Independent(
    "figures worked out once for this project, as the price of locking; their digits as printed",
);

const DEFLECTION_NAME: &str = "deflection over Timoshenko's";

/// Poisson's ratios and the corresponding figures.
type Figures = &'static [(f64, f64)];

const DEFLECTION: &[(BeamMesh, Kind, Figures)] = &[
    (
        BeamMesh::Kuhn(2),
        Kind::P1,
        &[(0.3, 0.504), (0.45, 0.299), (0.49, 0.104), (0.499, 0.021)],
    ),
    (
        BeamMesh::Kuhn(2),
        Kind::Fbar,
        &[(0.3, 0.613), (0.45, 0.614), (0.49, 0.608), (0.499, 0.607)],
    ),
    (
        BeamMesh::Kuhn(2),
        Kind::Edge(1.0),
        &[(0.3, 1.033), (0.45, 1.036), (0.49, 1.033), (0.499, 1.033)],
    ),
    (
        BeamMesh::Kuhn(4),
        Kind::P1,
        &[(0.3, 0.787), (0.45, 0.598), (0.49, 0.288), (0.499, 0.053)],
    ),
    (
        BeamMesh::Kuhn(4),
        Kind::Fbar,
        &[(0.3, 0.850), (0.45, 0.840), (0.49, 0.835), (0.499, 0.833)],
    ),
    (
        BeamMesh::Kuhn(4),
        Kind::Edge(1.0),
        &[(0.3, 1.012), (0.45, 1.005), (0.49, 1.002), (0.499, 1.001)],
    ),
    (
        BeamMesh::Kuhn(4),
        Kind::Edge(0.9),
        &[(0.3, 0.993), (0.45, 0.985), (0.499, 0.981)],
    ),
    (
        HALF,
        Kind::P1,
        &[(0.3, 0.529), (0.45, 0.371), (0.49, 0.196), (0.499, 0.078)],
    ),
    (
        HALF,
        Kind::Fbar,
        &[(0.3, 0.632), (0.45, 0.638), (0.49, 0.633), (0.499, 0.632)],
    ),
    (
        HALF,
        Kind::Edge(1.0),
        &[(0.3, 1.039), (0.45, 1.071), (0.49, 1.077), (0.499, 1.078)],
    ),
    (
        QUARTER,
        Kind::P1,
        &[(0.3, 0.831), (0.45, 0.723), (0.49, 0.520), (0.499, 0.212)],
    ),
    (
        QUARTER,
        Kind::Fbar,
        &[(0.3, 0.869), (0.45, 0.853), (0.49, 0.843), (0.499, 0.840)],
    ),
    (
        QUARTER,
        Kind::Edge(1.0),
        &[(0.3, 0.998), (0.45, 0.986), (0.49, 0.980), (0.499, 0.979)],
    ),
    (
        QUARTER,
        Kind::Edge(0.9),
        &[(0.3, 0.982), (0.45, 0.969), (0.499, 0.961)],
    ),
];

/// Poisson's ratios of the second computation.
const RATIOS: [f64; 4] = [0.3, 0.45, 0.49, 0.499];

/// The second computation on meshes of gmsh, at each of [`RATIOS`].
const SECOND_DEFLECTION: &[(BeamMesh, Kind, [f64; 4])] = &[
    (HALF, Kind::Fbar, [0.6311, 0.6400, 0.6369, 0.6358]),
    (HALF, Kind::Edge(1.0), [1.0163, 1.0413, 1.0458, 1.0467]),
    (HALF, Kind::Edge(0.9), [0.9491, 0.9710, 0.9741, 0.9746]),
    (QUARTER, Kind::Fbar, [0.8688, 0.8502, 0.8390, 0.8358]),
    (QUARTER, Kind::Edge(1.0), [0.9987, 0.9863, 0.9802, 0.9786]),
    (QUARTER, Kind::Edge(0.9), [0.9825, 0.9688, 0.9619, 0.9601]),
];

/// Deflection of 10-node tetrahedra by cells over the thickness.
const OF_TET10: &[(usize, Figures)] = &[
    (
        1,
        &[(0.3, 0.976), (0.45, 0.925), (0.49, 0.883), (0.499, 0.863)],
    ),
    (
        2,
        &[(0.3, 0.989), (0.45, 0.969), (0.49, 0.953), (0.499, 0.944)],
    ),
    (4, &[(0.3, 0.992), (0.499, 0.969)]),
];

/// Deflection of plain tetrahedra to two digits, with those of the prototype.
const TWO_DIGITS: &[(BeamMesh, Figures)] = &[
    (BeamMesh::Kuhn(2), &[(0.0, 0.55)]),
    (BeamMesh::Kuhn(4), &[(0.0, 0.82)]),
    (
        BeamMesh::Long,
        &[(0.0, 0.87), (0.3, 0.86), (0.45, 0.73), (0.49, 0.44)],
    ),
];

/// First frequency of plain tetrahedra on elongated cells.
const FREQUENCY_OF_LONG: Figures = &[(0.3, 1.057), (0.45, 1.119), (0.49, 1.354)];

const FREQUENCY_NAME: &str = "f1 over Euler's and Bernoulli's";

const FREQUENCY: &[(Kind, Figures)] = &[
    (Kind::P1, &[(0.45, 1.167), (0.499, 2.100)]),
    (Kind::Fbar, &[(0.45, 1.077), (0.499, 1.086)]),
    (Kind::Edge(1.0), &[(0.45, 1.002), (0.499, 1.006)]),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for &(mesh, kind, figures) in DEFLECTION {
        for &(nu, ratio) in figures {
            let case = format!("{kind}, {}, nu = {nu}", mesh.words());
            let asked = mesh.asked(kind, ratio);
            let deflection = move |inputs: &Inputs| deflection(&mesh.read(inputs)?, kind, nu);
            checks.push(Check::one(
                case,
                DEFLECTION_NAME,
                asked,
                PROTOTYPE,
                deflection,
            ));
        }
    }
    for &(mesh, kind, ratios) in SECOND_DEFLECTION {
        for (nu, ratio) in RATIOS.into_iter().zip(ratios) {
            let case = format!("{kind}, {}, nu = {nu}", mesh.words());
            let asked = Asked::value(ratio, 1e-4);
            let deflection = move |inputs: &Inputs| deflection(&mesh.read(inputs)?, kind, nu);
            checks.push(Check::one(case, DEFLECTION_NAME, asked, SECOND, deflection));
        }
    }
    for &(mesh, figures) in TWO_DIGITS {
        for &(nu, ratio) in figures {
            let case = format!("{}, {}, nu = {nu}", Kind::P1, mesh.words());
            let asked = Asked::value(ratio, 0.006);
            let deflection = move |inputs: &Inputs| deflection(&mesh.read(inputs)?, Kind::P1, nu);
            checks.push(Check::one(
                case,
                DEFLECTION_NAME,
                asked,
                LOCKING,
                deflection,
            ));
        }
    }
    let mirrored = Check::one(
        "p1, mirrored, 4 cells thick, nu = 0.499",
        DEFLECTION_NAME,
        Asked::value(0.802, 0.002),
        PROTOTYPE,
        |_| deflection(&Beam::of_cells(4, 40, Split::Mirrored)?, Kind::P1, 0.499),
    );
    checks.push(mirrored.noted("mirrored cells hide locking: measure it on others"));
    for &(thick, figures) in OF_TET10 {
        for &(nu, ratio) in figures {
            let case = format!("10-node tetrahedra, Kuhn, {thick} cells thick, nu = {nu}");
            let asked = Asked::value(ratio, 0.002);
            let deflection = move |_: &Inputs| deflection_of_tet10(thick, nu);
            let check = Check::one(case, DEFLECTION_NAME, asked, PROTOTYPE, deflection);
            checks.push(
                check
                    .noted("control of the reference that other subjects use")
                    .long(thick == 4),
            );
        }
    }
    for &(kind, figures) in FREQUENCY {
        for &(nu, ratio) in figures {
            let case = format!("{kind}, {}, nu = {nu}", QUARTER.words());
            let asked = QUARTER.asked(kind, ratio);
            let frequency = move |inputs: &Inputs| frequency(&QUARTER.read(inputs)?, kind, nu);
            checks.push(Check::one(
                case,
                FREQUENCY_NAME,
                asked,
                PROTOTYPE,
                frequency,
            ));
        }
    }
    for &(nu, ratio) in FREQUENCY_OF_LONG {
        let mesh = BeamMesh::Long;
        let case = format!("{}, {}, nu = {nu}", Kind::P1, mesh.words());
        let asked = Asked::value(ratio, 6e-4);
        let frequency = move |inputs: &Inputs| frequency(&mesh.read(inputs)?, Kind::P1, nu);
        checks.push(Check::one(case, FREQUENCY_NAME, asked, LOCKING, frequency));
    }
    for nu in [0.3, 0.45, 0.49, 0.499, 0.4999] {
        let kind = Kind::Edge(0.9);
        let mesh = BeamMesh::Kuhn(6);
        let case = format!("{kind}, {}, nu = {nu}", mesh.words());
        let timoshenko = Source::ClosedForm(
            "Timoshenko, Phil. Mag. 41, 1921; the held root alone takes 1 to 3 % where nu is high",
        );
        let deflection = move |inputs: &Inputs| deflection(&mesh.read(inputs)?, kind, nu);
        let check = Check::one(
            case,
            DEFLECTION_NAME,
            Asked::value(1.0, 0.03),
            timoshenko,
            deflection,
        );
        checks.push(check.long(nu != 0.499));
    }
    for (split, thick, short_by) in [
        (Split::Kuhn, 4, 0.06),
        (Split::Kuhn, 6, 0.02),
        (Split::Mirrored, 4, 0.13),
        (Split::Mirrored, 6, 0.06),
    ] {
        let kind = Kind::Edge(0.9);
        let nu = 0.45;
        let case = format!("{kind}, {split:?}, {thick} cells thick, nu = {nu}");
        let torsion = Source::ClosedForm(
            "Saint-Venant; Timoshenko and Goodier, Theory of Elasticity, section 109",
        );
        let asked = Asked::value(1.0, short_by);
        let twist = move |_: &Inputs| twist(thick, split, kind, nu);
        let check = Check::one(case, "twist over Saint-Venant's", asked, torsion, twist);
        checks.push(
            check
                .long(thick > 4)
                .noted("averages over edges leave torsion too stiff where bending is nearly right"),
        );
    }
    checks
}

impl BeamMesh {
    fn words(self) -> String {
        match self {
            Self::Kuhn(thick) => format!("Kuhn, {thick} cells thick"),
            Self::Long => "Kuhn, 6 cells thick, 40 long".to_owned(),
            Self::Gmsh(name) => format!("gmsh, {name}.msh"),
        }
    }

    /// The printed digits for meshes that are identical to the last node; patches grow differently on meshes without a
    /// grid.
    fn asked(self, kind: Kind, value: f64) -> Asked {
        match self {
            Self::Gmsh(_) if kind != Kind::P1 => Asked::relative(value, 0.03),
            Self::Kuhn(_) | Self::Long | Self::Gmsh(_) => Asked::value(value, 0.002),
        }
    }

    fn read(self, inputs: &Inputs) -> Result<Beam, LabError> {
        match self {
            Self::Kuhn(thick) => Beam::of_cells(thick, 10 * thick, Split::Kuhn),
            Self::Long => Beam::of_cells(6, 40, Split::Kuhn),
            Self::Gmsh(name) => Ok(Beam {
                mesh: inputs.mesh(name)?,
                root: "clamped",
                tip: "tip",
                across: 2,
                patch: Some(8),
            }),
        }
    }
}

/// A beam that is to be bent.
struct Beam {
    mesh: TetMesh,
    root: &'static str,
    tip: &'static str,
    /// Axis of the traction.
    across: usize,
    patch: Option<u32>,
}

impl Beam {
    fn of_cells(thick: usize, long: usize, split: Split) -> Result<Self, LabError> {
        let size = [THICKNESS, THICKNESS, LENGTH];
        Ok(Self {
            mesh: block([thick, thick, long], size, split)?,
            root: "bottom",
            tip: "top",
            across: 0,
            patch: None,
        })
    }

    fn traction(&self) -> [f64; 3] {
        let mut traction = [0.0; 3];
        traction[self.across] = TRACTION;
        traction
    }

    fn model(&self, kind: Kind, nu: f64) -> Result<Model, LabError> {
        let mut problem = body(YOUNGS_MODULUS, nu, kind.element(self.patch));
        problem.fixed = vec![held(self.root, [true; 3])];
        problem.loads = vec![load(self.tip, LoadKind::Traction(self.traction()))];
        Ok(Model::build(&self.mesh, &problem)?)
    }
}

fn area() -> f64 {
    THICKNESS * THICKNESS
}

fn second_moment() -> f64 {
    THICKNESS.powi(4) / 12.0
}

/// The deflection (m) of Timoshenko's beam under the traction.
fn timoshenko(nu: f64) -> f64 {
    let force = TRACTION * area();
    let shear_modulus = YOUNGS_MODULUS / (2.0 * (1.0 + nu));
    let bending = force * LENGTH.powi(3) / (3.0 * YOUNGS_MODULUS * second_moment());
    let shear = force * LENGTH / (5.0 / 6.0 * shear_modulus * area());
    bending + shear
}

fn deflection(beam: &Beam, kind: Kind, nu: f64) -> Result<f64, LabError> {
    let model = beam.model(kind, nu)?;
    let mean = dot(&loads(&model), &equilibrium(&model)?) / (TRACTION * area());
    Ok(mean / timoshenko(nu))
}

fn deflection_of_tet10(thick: usize, nu: f64) -> Result<f64, LabError> {
    let beam = Beam::of_cells(thick, 10 * thick, Split::Kuhn)?;
    let body = Tet10::new(&beam.mesh);
    let force = body.traction(
        &triangles_where(&beam.mesh, beam.tip, |_| true)?,
        beam.traction(),
    );
    let tissue = Tissue {
        youngs_modulus: YOUNGS_MODULUS,
        poissons_ratio: nu,
        density: DENSITY,
    };
    let u = body.held(tissue, |[.., z]| z == 0.0)?.equilibrium(&force)?;
    let work = dot(force.as_flattened(), u.as_flattened());
    Ok(work / (TRACTION * area()) / timoshenko(nu))
}

fn frequency(beam: &Beam, kind: Kind, nu: f64) -> Result<f64, LabError> {
    let model = beam.model(kind, nu)?;
    let stiffness = YOUNGS_MODULUS * second_moment();
    let beams = 1.8751_f64.powi(2) * (stiffness / (DENSITY * area())).sqrt() / LENGTH.powi(2);
    Ok(lowest_omega_lumped(&model)? / beams)
}

/// The twist of a beam between two sections under a torque on its tip, over that of Saint-Venant's bar.
fn twist(thick: usize, split: Split, kind: Kind, nu: f64) -> Result<f64, LabError> {
    let mesh = Beam::of_cells(thick, 10 * thick, split)?.mesh;
    let mut problem = body(YOUNGS_MODULUS, nu, kind.element(None));
    problem.fixed = vec![held("bottom", [true; 3])];
    let model = Model::build(&mesh, &problem)?;
    let points = &model.mesh().points;
    let arm = |node: u32| {
        let [x, y, _] = points[node as usize];
        [x - THICKNESS / 2.0, y - THICKNESS / 2.0]
    };
    let section = |height: f64| nodes_where(model.mesh(), |[.., z]| (z - height).abs() < 1e-9);
    let mut force = vec![0.0; model.dofs()];
    let mut torque = 0.0;
    for node in section(LENGTH) {
        let [x, y] = arm(node);
        // Half on edges, a quarter at corners, as of a traction.
        let is_end = |place: f64| (place.abs() - THICKNESS / 2.0).abs() < 1e-9;
        let share = [x, y].map(|place| if is_end(place) { 0.5 } else { 1.0 });
        let weight = share[0] * share[1] * TRACTION;
        if let Some(cell) = model.cell_of_node(node) {
            force[3 * cell as usize] -= weight * y;
            force[3 * cell as usize + 1] += weight * x;
            torque += weight * (x * x + y * y);
        }
    }
    let u = static_solution(&model, &force)?;
    let mut moved = vec![[0.0; 3]; points.len()];
    model.displacements_at(0.0, &u, &mut moved)?;
    let angle = |height: f64| {
        let (mut turned, mut all) = (0.0, 0.0);
        for node in section(height) {
            let ([x, y], [across, along, _]) = (arm(node), moved[node as usize]);
            turned += x * along - y * across;
            all += x * x + y * y;
        }
        turned / all
    };
    let shear_modulus = YOUNGS_MODULUS / (2.0 * (1.0 + nu));
    let stiffness = shear_modulus * 0.140_577 * THICKNESS.powi(4);
    Ok((angle(0.7 * LENGTH) - angle(0.3 * LENGTH)) / (torque * 0.4 * LENGTH / stiffness))
}
