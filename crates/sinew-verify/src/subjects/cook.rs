//! Cook's membrane in plane strain.

use sinew_fem::{LoadKind, Model, On};
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, block};

use crate::bodies::{body, equilibrium, held, load};
use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::places::{node_at, nodes_where, triangles_where};
use crate::sources::PROTOTYPE;
use crate::subject::{Quoted, Subject};

pub(super) const SUBJECT: Subject = Subject {
    id: "cook",
    title: "Cook's membrane, plane strain, nearly incompressible",
    says: "A panel from (0, 0), (48, 44), (48, 60) to (0, 44), held at x = 0, under a shear traction of 6.25 at x = 48; E = 240.565, nu = \
           .4999. One layer of cells as thick as a cell is wide, with u_z = 0. The rise of the corner (48, 60), mean of the two nodes \
           there, is beside the limit of fine meshes, 8.05 (Simo and Armero, Int. J. Numer. Methods Engrg. 33, 1992, and many after \
           them).",
    checks,
    quoted: &[
        Quoted::new(
            "average nodal pressure",
            "n = 4/8/16/32",
            ".420/.657/.858/.947",
        ),
        Quoted::new(
            "uniform strain by nodes, 5 % of the isochoric part local",
            "n = 4/8/16/32",
            ".704/.887/.959/.985",
        ),
        Quoted::new(
            "shear by faces, volume by patches",
            "n = 4/8/16/32",
            ".688/.874/.955/.984",
        ),
        Quoted::new(
            "shear by edges, volume by nodes",
            "n = 4/8/16/32",
            ".548/.796/.924/.971",
        ),
        Quoted::new("MINI", "n = 4/8/16/32", ".495/.733/.891/.959"),
    ],
};

const CORNER_OF_FINE_MESHES: f64 = 8.05;

/// The corner's rise over that of fine meshes for each number of cells per side.
const TABLE: &[(Kind, [(usize, f64); 4])] = &[
    (Kind::P1, [(4, 0.267), (8, 0.270), (16, 0.277), (32, 0.300)]),
    (
        Kind::Fbar,
        [(4, 0.586), (8, 0.799), (16, 0.923), (32, 0.972)],
    ),
    (
        Kind::Edge(1.0),
        [(4, 0.918), (8, 0.986), (16, 0.997), (32, 1.000)],
    ),
    (
        Kind::Edge(0.9),
        [(4, 0.850), (8, 0.959), (16, 0.987), (32, 0.997)],
    ),
];

fn checks() -> Vec<Check> {
    let of_row = |&(kind, figures): &(Kind, [(usize, f64); 4])| {
        figures.map(|(cells, ratio)| {
            let case = format!("{kind}, {cells} cells a side");
            let asked = Asked::value(ratio, 0.002);
            Check::one(
                case,
                "rise of the corner over 8.05",
                asked,
                PROTOTYPE,
                move |_| corner(kind, cells),
            )
        })
    };
    TABLE.iter().flat_map(of_row).collect()
}

fn panel(cells: usize) -> Result<TetMesh, LabError> {
    let thickness = 48.0 / cells as f64;
    let mut mesh = block([cells, cells, 1], [48.0, 1.0, thickness], Split::Kuhn)?;
    for [x, y, _] in &mut mesh.points {
        let along = *x / 48.0;
        *y = 44.0 * along + *y * (44.0 - 28.0 * along);
    }
    Ok(mesh)
}

fn corner(kind: Kind, cells: usize) -> Result<f64, LabError> {
    let mesh = panel(cells)?;
    let mut problem = body(240.565, 0.4999, kind.element(None));
    let left = nodes_where(&mesh, |[x, ..]| x == 0.0);
    let all = nodes_where(&mesh, |_| true);
    problem.fixed = vec![
        held(On::Nodes(left), [true; 3]),
        held(On::Nodes(all), [false, false, true]),
    ];
    let right = triangles_where(&mesh, "sides", |[x, ..]| x == 48.0)?;
    problem.loads = vec![load(
        On::Triangles(right),
        LoadKind::Traction([0.0, 6.25, 0.0]),
    )];
    let model = Model::build(&mesh, &problem)?;
    let u = equilibrium(&model)?;
    let mut rise = 0.0;
    for z in [0.0, 48.0 / cells as f64] {
        let node = node_at(&mesh.points, [48.0, 60.0, z])?;
        rise += model.node_displacement(0.0, &u, node)?[1] / 2.0;
    }
    Ok(rise / CORNER_OF_FINE_MESHES)
}
