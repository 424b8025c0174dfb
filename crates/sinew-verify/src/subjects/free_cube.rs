//! A free cube: coercivity, stable steps and sizes of templates.

use sinew_core::LinearSystem;
use sinew_core::spectrum::critical_step;
use sinew_fem::{Element, Fixed, Model, On};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{YOUNGS_MODULUS, body, held};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::inputs::Inputs;
use crate::kinds::Kind;
use crate::modes::largest_beside_stiffness;
use crate::places::on_surface;
use crate::sources::{PROTOTYPE, SECOND};
use crate::subject::{Quoted, Subject};

pub(super) const SUBJECT: Subject = Subject {
    id: "free-cube",
    title: "Free cube: softest strain, stable step, size of templates",
    says: "Coercivity: the smallest eigenvalue of K beside that of plain tetrahedra with the same mu and lambda = 0, without rigid motions. \
           It hardly falls with the mesh or with nu, so that averaging leaves no motion without energy; on meshes of gmsh, where the worst \
           tetrahedron decides, finer ones have .16 (edge_share 1) and .24 (.9). Stable steps are \
           beside those of plain tetrahedra on the same mesh. Templates: blocks in the row of a node, mean over nodes none of whose \
           tetrahedra is at the surface.",
    checks,
    quoted: &[
        Quoted::new(
            "average nodal pressure",
            "coercivity; stable step on Kuhn cells, nu .3/.45/.499; blocks on Kuhn, mirrored, gmsh",
            "1.000; 1.19/1.27/1.29; 65, 104, 75",
        ),
        Quoted::new(
            "uniform strain by nodes",
            "coercivity, n = 3, 4, 6",
            ".041, .0255, .0117: falls as h^2, spurious modes",
        ),
        Quoted::new(
            "shear by faces, volume by patches",
            "coercivity",
            ".52 to .54",
        ),
    ],
};

const EDGE: f64 = 0.1;

/// A mesh of the cube.
#[derive(Clone, Copy)]
enum CubeMesh {
    Grid(Split, usize),
    /// A file, and the size of patches.
    Gmsh(&'static str, u32),
}

const KUHN_3: CubeMesh = CubeMesh::Grid(Split::Kuhn, 3);
const KUHN_6: CubeMesh = CubeMesh::Grid(Split::Kuhn, 6);
const MIRRORED_3: CubeMesh = CubeMesh::Grid(Split::Mirrored, 3);
const MIRRORED_6: CubeMesh = CubeMesh::Grid(Split::Mirrored, 6);
/// Edges of a quarter and an eighth of the cube's edge.
const COARSE: CubeMesh = CubeMesh::Gmsh("cube-4", 8);
const FINE: CubeMesh = CubeMesh::Gmsh("cube-8", 8);
const FINE_TWELVE: CubeMesh = CubeMesh::Gmsh("cube-8", 12);

/// Coercivity at nu = .45, two digits.
const COERCIVITY: &[(CubeMesh, Kind, f64)] = &[
    (KUHN_3, Kind::Fbar, 1.00),
    (KUHN_3, Kind::Edge(1.0), 0.24),
    (KUHN_6, Kind::Edge(1.0), 0.23),
    (MIRRORED_3, Kind::Edge(1.0), 0.22),
    (MIRRORED_6, Kind::Edge(1.0), 0.20),
    (COARSE, Kind::Edge(1.0), 0.18),
    (KUHN_3, Kind::Edge(0.9), 0.32),
    (KUHN_6, Kind::Edge(0.9), 0.31),
    (MIRRORED_6, Kind::Edge(0.9), 0.28),
    (COARSE, Kind::Edge(0.9), 0.26),
];

/// Pairs of meshes, the finer one with half the edges, and the smallest allowed ratio of their coercivities.
const FALL: &[(CubeMesh, CubeMesh, f64)] = &[
    (KUHN_3, KUHN_6, 0.95),
    (MIRRORED_3, MIRRORED_6, 0.85),
    (COARSE, FINE, 0.85),
];

/// Stable step over that of plain tetrahedra at nu = .3, .45 and .499, and its tolerance.
const STEP: &[(CubeMesh, Kind, [f64; 3], f64, Source)] = &[
    (KUHN_6, Kind::Fbar, [1.19, 1.22, 1.22], 0.02, PROTOTYPE),
    (KUHN_6, Kind::Edge(1.0), [1.29, 1.24, 1.22], 0.02, PROTOTYPE),
    (
        MIRRORED_6,
        Kind::Edge(1.0),
        [1.25, 1.11, 1.08],
        0.02,
        PROTOTYPE,
    ),
    (
        FINE_TWELVE,
        Kind::Fbar,
        [1.22, 1.17, 1.17],
        0.035,
        PROTOTYPE,
    ),
    (
        FINE_TWELVE,
        Kind::Edge(1.0),
        [1.38, 1.21, 1.17],
        0.035,
        PROTOTYPE,
    ),
    (FINE, Kind::Fbar, [1.2253, 1.2025, 1.2087], 2e-4, SECOND),
    (
        FINE,
        Kind::Edge(1.0),
        [1.4189, 1.2425, 1.2095],
        2e-4,
        SECOND,
    ),
    (
        FINE,
        Kind::Edge(0.9),
        [1.3987, 1.2384, 1.2094],
        2e-4,
        SECOND,
    ),
    (
        FINE_TWELVE,
        Kind::Fbar,
        [1.2163, 1.1456, 1.1473],
        2e-4,
        SECOND,
    ),
    (
        FINE_TWELVE,
        Kind::Edge(1.0),
        [1.3657, 1.1804, 1.1480],
        2e-4,
        SECOND,
    ),
    (
        FINE_TWELVE,
        Kind::Edge(0.9),
        [1.3498, 1.1768, 1.1480],
        2e-4,
        SECOND,
    ),
];

/// Remark on rows of templates on meshes without a grid.
const REMAINDERS: &str = "the prototype has fewer (37 and 44 for fbar, 54 and 58 for fbar-edge, patches of 8 and 12, means over all nodes \
                          off the surface), as the rests of its patches did not join their neighbours; so counted, the second \
                          computation gives its digits";

/// Blocks of a row, the tolerance, and a remark.
const ROWS: &[(CubeMesh, Kind, f64, f64, Source, &str)] = &[
    (KUHN_6, Kind::P1, 15.0, 0.0, PROTOTYPE, ""),
    (KUHN_6, Kind::Fbar, 27.0, 0.0, PROTOTYPE, ""),
    (KUHN_6, Kind::Edge(1.0), 51.0, 0.0, PROTOTYPE, ""),
    (MIRRORED_6, Kind::P1, 16.3, 0.05, PROTOTYPE, ""),
    (MIRRORED_6, Kind::Fbar, 27.0, 0.5, PROTOTYPE, ""),
    (MIRRORED_6, Kind::Edge(1.0), 49.0, 0.5, PROTOTYPE, ""),
    (FINE, Kind::P1, 15.4, 0.05, PROTOTYPE, ""),
    (FINE, Kind::Fbar, 41.00, 0.005, SECOND, REMAINDERS),
    (FINE, Kind::Edge(1.0), 59.31, 0.005, SECOND, REMAINDERS),
    (FINE_TWELVE, Kind::Fbar, 46.96, 0.005, SECOND, REMAINDERS),
    (
        FINE_TWELVE,
        Kind::Edge(1.0),
        63.27,
        0.005,
        SECOND,
        REMAINDERS,
    ),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for &(mesh, kind, smallest) in COERCIVITY {
        let case = format!("{kind}, {}, nu = .45", mesh.words());
        let asked = Asked::value(smallest, 0.01);
        checks.push(Check::one(
            case,
            "smallest eigenvalue beside p1 with lambda = 0",
            asked,
            PROTOTYPE,
            move |inputs| coercivity(&mesh.read(inputs)?, kind.element(mesh.patch())),
        ));
    }
    for &(coarse, fine, left) in FALL {
        for kind in [Kind::Edge(1.0), Kind::Edge(0.9)] {
            let case = format!("{kind}, {} after {}", fine.words(), coarse.words());
            let asked = Asked::at_least(left);
            let source = Source::ClosedForm(
                "spurious modes fall as h^2, to .25 of what they were; here the worst tetrahedron decides",
            );
            checks.push(Check::one(
                case,
                "what is left of the smallest eigenvalue",
                asked,
                source,
                move |inputs| {
                    let of = |mesh: CubeMesh| {
                        coercivity(&mesh.read(inputs)?, kind.element(mesh.patch()))
                    };
                    Ok(of(fine)? / of(coarse)?)
                },
            ));
        }
    }
    for &(mesh, kind, ratios, tolerance, source) in STEP {
        for (nu, ratio) in [0.3, 0.45, 0.499].into_iter().zip(ratios) {
            let case = format!("{kind}, {}, nu = {nu}", mesh.words());
            let asked = Asked::value(ratio, tolerance);
            checks.push(Check::one(
                case,
                "stable step over p1's",
                asked,
                source,
                move |inputs| {
                    let body = mesh.read(inputs)?;
                    let of = |element| {
                        Ok::<_, LabError>(critical_step(free(&body, nu, element)?.operators()))
                    };
                    Ok(of(kind.element(mesh.patch()))? / of(Element::P1)?)
                },
            ));
        }
    }
    for &(mesh, kind, blocks, tolerance, source, note) in ROWS {
        let case = format!("{kind}, {}", mesh.words());
        let asked = Asked::value(blocks, tolerance);
        let blocks =
            move |inputs: &Inputs| inner_blocks(&mesh.read(inputs)?, kind.element(mesh.patch()));
        let check = Check::one(case, "blocks of an inner row", asked, source, blocks);
        checks.push(check.noted(note));
    }
    checks
}

impl CubeMesh {
    fn words(self) -> String {
        match self {
            Self::Grid(Split::Kuhn, cells) => format!("Kuhn, {cells} cells a side"),
            Self::Grid(Split::Mirrored, cells) => format!("mirrored, {cells} cells a side"),
            Self::Gmsh(name, patch) => format!("gmsh, {name}.msh, patches of {patch}"),
        }
    }

    fn read(self, inputs: &Inputs) -> Result<TetMesh, LabError> {
        match self {
            Self::Grid(split, cells) => Ok(cube(cells, EDGE, split)?),
            Self::Gmsh(name, _) => inputs.mesh(name),
        }
    }

    fn patch(self) -> Option<u32> {
        match self {
            Self::Grid(..) => None,
            Self::Gmsh(_, patch) => Some(patch),
        }
    }
}

fn free(mesh: &TetMesh, nu: f64, element: Element) -> Result<Model, LabError> {
    Ok(Model::build(mesh, &body(YOUNGS_MODULUS, nu, element))?)
}

/// Supports of six components that remove rigid motions and nothing else: both forms of energy vanish on these motions,
/// so that the eigenvalues between the forms are unchanged.
fn against_rigid_motions(mesh: &TetMesh) -> Vec<Fixed> {
    let (low, high) = mesh.bounding_box();
    let corner = |place| On::Nodes(vec![mesh.nearest_node(place).0]);
    vec![
        held(corner(low), [true; 3]),
        held(corner([high[0], low[1], low[2]]), [false, true, true]),
        held(corner([low[0], high[1], low[2]]), [false, false, true]),
    ]
}

/// The smallest eigenvalue of K relative to that of plain tetrahedra with lambda = 0.
fn coercivity(mesh: &TetMesh, element: Element) -> Result<f64, LabError> {
    let nu = 0.45;
    let build = |youngs_modulus, nu, element| {
        let mut problem = body(youngs_modulus, nu, element);
        problem.fixed = against_rigid_motions(mesh);
        Model::build(mesh, &problem)
    };
    let model = build(YOUNGS_MODULUS, nu, element)?;
    // E = 2 mu and nu = 0 make the same mu and lambda = 0.
    let shear = build(YOUNGS_MODULUS / (1.0 + nu), 0.0, Element::P1)?;
    let multiply = |x: &[f64], out: &mut [f64]| shear.operators().stiffness().multiply(x, out);
    Ok(largest_beside_stiffness(&model, multiply)?.recip())
}

/// The mean number of blocks in the rows of nodes without a tetrahedron at the surface.
fn inner_blocks(mesh: &TetMesh, element: Element) -> Result<f64, LabError> {
    let mut is_outer = vec![false; mesh.points.len()];
    let surface = on_surface(mesh);
    for tet in &mesh.tets {
        if tet.iter().any(|node| surface[*node as usize]) {
            tet.iter().for_each(|node| is_outer[*node as usize] = true);
        }
    }
    let model = free(mesh, 0.45, element)?;
    let pattern = model.operators().stiffness().pattern();
    let inner = (0..pattern.cells()).filter(|node| !is_outer[*node]);
    let (mut blocks, mut rows) = (0, 0);
    for node in inner {
        blocks += pattern.neighbours(node).len();
        rows += 1;
    }
    Ok(blocks as f64 / f64::from(rows))
}
