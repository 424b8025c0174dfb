//! A manufactured solution: a volume-preserving displacement and a pressure.

use std::f64::consts::PI;

use sinew_core::System;
use sinew_core::vectors::norm;
use sinew_fem::tetra::lame;
use sinew_fem::{Model, On, Problem};
use sinew_integrators::static_solution;
use sinew_mesh::TetMesh;
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{body, held};
use crate::check::{Asked, Check};
use crate::error::LabError;
use crate::inputs::Inputs;
use crate::kinds::Kind;
use crate::places::on_surface;
use crate::quadrature::rule;
use crate::sources::{PROTOTYPE, SECOND};
use crate::subject::{Quoted, Subject};

pub(super) const SUBJECT: Subject = Subject {
    id: "pressure",
    title: "Pressure of a nearly incompressible body",
    says: "Manufactured solution (Roache, J. Fluids Eng. 124, 2002) on the unit cube, held on its surface, E = 1, nu = .4999: u = (psi_y, -psi_x, \
           0) with psi = sin^2 pi x sin^2 pi y sin^2 pi z, which changes no volume, and p = 10 cos pi x cos pi y cos pi z. Errors \
           relative to the exact solution: of displacements over all nodes, of the pressure -lambda div u at the centroids of \
           tetrahedra by volume.",
    checks,
    quoted: &[
        Quoted::new(
            "average nodal pressure",
            "Kuhn u, p; gmsh u, p",
            ".065, 1.57; .184, 9.2",
        ),
        Quoted::new(
            "uniform strain by nodes, 5 % of the isochoric part local",
            "Kuhn u, p; gmsh u, p",
            ".142, .33; .180, 4.5",
        ),
        Quoted::new(
            "shear by edges, volume by nodes",
            "Kuhn u, p; gmsh u, p",
            ".060, 1.06; .122, 6.9",
        ),
        Quoted::new("MINI", "Kuhn u, p; gmsh u, p", ".050, .35; .065, .67"),
    ],
};

const POISSONS_RATIO: f64 = 0.4999;
const PRESSURE: f64 = 10.0;
const CELLS: usize = 12;

/// Errors on Kuhn cells, to the last digit printed.
const ON_GRID: &[(Kind, [f64; 2], [f64; 2])] = &[
    (Kind::P1, [0.98, 8.4], [0.02, 0.2]),
    (Kind::Fbar, [0.041, 0.097], [0.002; 2]),
    (Kind::Edge(1.0), [0.056, 0.099], [0.002; 2]),
    (Kind::Edge(0.9), [0.045, 0.097], [0.002; 2]),
];

/// Errors on cube-12.msh by size of patches (tetrahedra), to the last digit printed.
const ON_GMSH: &[(Kind, u32, [f64; 2], &str)] = &[
    (Kind::P1, 12, [0.9831, 7.9755], ""),
    (
        Kind::Fbar,
        8,
        [0.0909, 0.9710],
        "the prototype printed .073, .87: its patches grew in another way",
    ),
    (
        Kind::Edge(1.0),
        8,
        [0.0727, 0.5357],
        "the prototype printed .065, .45: its patches grew in another way",
    ),
    (Kind::Edge(0.9), 8, [0.0665, 0.5865], ""),
    (Kind::Fbar, 12, [0.0632, 0.5012], ""),
    (
        Kind::Edge(1.0),
        12,
        [0.0697, 0.3227],
        "the prototype printed .065, .254: its patches grew in another way",
    ),
    (
        Kind::Edge(0.9),
        12,
        [0.0604, 0.3404],
        "the prototype printed .056, .268: its patches grew in another way",
    ),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for &(kind, [u, p], [of_u, of_p]) in ON_GRID {
        let case = format!("{kind}, Kuhn, {CELLS} cells a side");
        let figures = [
            ("error of u", Asked::value(u, of_u)),
            ("error of p", Asked::value(p, of_p)),
        ];
        checks.push(Check::several(case, figures, PROTOTYPE, move |_| {
            errors(&cube(CELLS, 1.0, Split::Kuhn)?, kind, None)
        }));
    }
    for &(kind, patch, [u, p], note) in ON_GMSH {
        let case = format!("{kind}, gmsh, cube-12.msh, patches of {patch}");
        let figures = [
            ("error of u", Asked::relative(u, 2e-3)),
            ("error of p", Asked::relative(p, 2e-3)),
        ];
        let errors = move |inputs: &Inputs| errors(&inputs.mesh("cube-12")?, kind, Some(patch));
        checks.push(Check::several(case, figures, SECOND, errors).noted(note));
    }
    checks
}

/// sin^2 pi t and its derivatives.
fn hump(t: f64) -> [f64; 3] {
    let turn = 2.0 * PI * t;
    [
        (PI * t).sin().powi(2),
        PI * turn.sin(),
        2.0 * PI * PI * turn.cos(),
    ]
}

/// The third derivative of sin^2 pi t.
fn hump_third(t: f64) -> f64 {
    -4.0 * PI.powi(3) * (2.0 * PI * t).sin()
}

fn displacement([x, y, z]: [f64; 3]) -> [f64; 3] {
    let [[a, a_1, _], [b, b_1, _], [c, ..]] = [x, y, z].map(hump);
    [a * b_1 * c, -a_1 * b * c, 0.0]
}

fn pressure(place: [f64; 3]) -> f64 {
    PRESSURE * place.map(|t| (PI * t).cos()).iter().product::<f64>()
}

/// -mu div grad u + grad p, the force that keeps u and p in equilibrium for a volume-preserving u.
fn body_force(place: [f64; 3], mu: f64) -> [f64; 3] {
    let [x, y, z] = place;
    let [[a, a_1, a_2], [b, b_1, b_2], [c, _, c_2]] = place.map(hump);
    let laplacian = [
        a_2 * b_1 * c + a * hump_third(y) * c + a * b_1 * c_2,
        -(hump_third(x) * b * c + a_1 * b_2 * c + a_1 * b * c_2),
        0.0,
    ];
    let [sines, cosines] = [f64::sin, f64::cos].map(|of| [x, y, z].map(|t| of(PI * t)));
    [0, 1, 2].map(|axis| {
        let others: f64 = (0..3)
            .filter(|other| *other != axis)
            .map(|other| cosines[other])
            .product();
        -mu * laplacian[axis] - PRESSURE * PI * sines[axis] * others
    })
}

/// The errors of displacement and pressure.
fn errors(mesh: &TetMesh, kind: Kind, patch: Option<u32>) -> Result<Vec<f64>, LabError> {
    let mut problem = body(1.0, POISSONS_RATIO, kind.element(patch));
    let surface = on_surface(mesh);
    let held_nodes = (0..)
        .zip(&surface)
        .filter_map(|(node, outer)| outer.then_some(node));
    problem.fixed = vec![held(On::Nodes(held_nodes.collect()), [true; 3])];
    let model = Model::build(mesh, &problem)?;
    let (lambda, mu) = lame(1.0, POISSONS_RATIO);
    let mut force = vec![0.0; model.dofs()];
    model.to_dofs(&consistent_load(mesh, mu), &mut force)?;
    let u = static_solution(&model, &force)?;

    let mut exact = vec![0.0; model.dofs()];
    let field: Vec<[f64; 3]> = mesh
        .points
        .iter()
        .map(|point| displacement(*point))
        .collect();
    model.to_dofs(&field, &mut exact)?;
    let difference: Vec<f64> = u.iter().zip(&exact).map(|(u, exact)| u - exact).collect();

    let (mut off, mut all) = (0.0, 0.0);
    for (tet, dilation) in dilations(&model, &problem, &u)?.into_iter().enumerate() {
        let exact = pressure(centroid(mesh, tet));
        off += mesh.volume(tet) * (-lambda * dilation - exact).powi(2);
        all += mesh.volume(tet) * exact.powi(2);
    }
    Ok(vec![norm(&difference) / norm(&exact), f64::sqrt(off / all)])
}

/// The change of volume from which each tetrahedron's pressure follows: the mean stress of a law without other
/// resistance.
fn dilations(model: &Model, problem: &Problem, u: &[f64]) -> Result<Vec<f64>, LabError> {
    let (youngs_modulus, poissons_ratio) = (1.0, 0.5 - 1e-12);
    let element = problem.regions[0].element;
    let mut fluid = body(youngs_modulus, poissons_ratio, element);
    fluid.fixed.clone_from(&problem.fixed);
    let fluid = model.with_problem(&fluid)?;
    let mut stress = vec![[0.0; 6]; model.mesh().tets.len()];
    fluid.stress(0.0, u, &mut stress)?;
    let (lambda, _) = lame(youngs_modulus, poissons_ratio);
    Ok(stress
        .iter()
        .map(|[xx, yy, zz, ..]| (xx + yy + zz) / (3.0 * lambda))
        .collect())
}

fn centroid(mesh: &TetMesh, tet: usize) -> [f64; 3] {
    place(mesh, tet, [0.25; 4])
}

/// A point of a tetrahedron, by its barycentric coordinates.
fn place(mesh: &TetMesh, tet: usize, shares: [f64; 4]) -> [f64; 3] {
    let mut place = [0.0; 3];
    for (node, share) in mesh.tets[tet].iter().zip(shares) {
        for (sum, x) in place.iter_mut().zip(mesh.points[*node as usize]) {
            *sum += share * x;
        }
    }
    place
}

/// The integral of the body force times each shape function (N).
fn consistent_load(mesh: &TetMesh, mu: f64) -> Vec<[f64; 3]> {
    let rule = rule(2);
    let mut load = vec![[0.0; 3]; mesh.points.len()];
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let volume = mesh.volume(tet);
        for (shares, weight) in &rule {
            let force = body_force(place(mesh, tet, *shares), mu);
            for (node, share) in nodes.iter().zip(shares) {
                for (sum, force) in load[*node as usize].iter_mut().zip(force) {
                    *sum += weight * volume * share * force;
                }
            }
        }
    }
    load
}
