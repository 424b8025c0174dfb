//! A cube fixed at its four sides: compliance, frequencies and stable steps.

use std::f64::consts::TAU;
use std::sync::Arc;

use sinew_core::spectrum::{Spectrum, critical_step};
use sinew_core::vectors::dot;
use sinew_core::{BlockMatrix, Layers, LinearSystem};
use sinew_fem::{Element, Law, LoadKind, Model, SpringRule};
use sinew_mesh::structured::{Split, cube};

use crate::bodies::{
    DENSITY, YOUNGS_MODULUS, body, equilibrium, held, linear, load, loads, of_law, springs,
};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::kinds::Kind;
use crate::modes::{lowest_omega, lowest_omega_lumped};
use crate::places::triangles_where;
use crate::reference::tet10::{HeldTet10, Tet10, Tissue};
use crate::sources::{PROTOTYPE, TET10};
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "held-cube",
    title: "Cube held at its four sides",
    says: "A Kuhn cube of 0.1 m, E = 3500 Pa, rho = 1060 kg/m3, held at its four sides. Compliance: work of 100 Pa on the top over that of \
           10-node tetrahedra, 8 cells a side, computed here; where held and loaded faces meet stresses are singular, so that the \
           reference itself still gives way by some more on finer meshes. Frequencies with lumped and with consistent mass: on this cube lumping and not the element \
           sets the error, and the plain tetrahedron profits from two errors that cancel. Stable steps are 2/omega_max with lumped mass.",
    checks,
    quoted: &[],
};

const EDGE: f64 = 0.1;
/// Traction on the top (Pa).
const TRACTION: f64 = 100.0;
/// Cells per side of the 10-node tetrahedra for compliance and for frequencies.
const FOR_COMPLIANCE: usize = 8;
const FOR_FREQUENCIES: usize = 6;

/// Poisson's ratio, element, cells per side, and the compliance over that of 10-node tetrahedra.
const COMPLIANCE: &[(f64, Kind, usize, f64)] = &[
    (0.45, Kind::P1, 10, 0.921),
    (0.45, Kind::Edge(1.0), 5, 0.946),
    (0.45, Kind::Edge(1.0), 10, 0.996),
    (0.499, Kind::P1, 10, 0.911),
    (0.499, Kind::Fbar, 10, 0.957),
    (0.499, Kind::Edge(1.0), 5, 0.956),
    (0.499, Kind::Edge(1.0), 10, 1.003),
];

/// Element and first frequency (Hz) at nu = .45: lumped mass with 10 and 14 cells per side, consistent mass with 10.
const FREQUENCY: &[(Kind, [f64; 3])] = &[
    (Kind::P1, [7.2725, 7.2272, 7.393]),
    (Kind::Fbar, [7.1799, 7.1487, 7.304]),
    (Kind::Edge(0.5), [7.094, 7.096, 7.219]),
    (Kind::Edge(0.9), [7.0148, 7.0491, 7.141]),
    (Kind::Edge(1.0), [6.9928, 7.0364, 7.120]),
];

/// Element and stable step (ms) with 10 cells per side at nu = .45 and .49.
const STEP: &[(Kind, [f64; 2])] = &[
    (Kind::P1, [2.0209, 0.9522]),
    (Kind::Fbar, [2.8698, 1.3575]),
    (Kind::Edge(1.0), [2.9831, 1.3688]),
    (Kind::Edge(0.9), [2.9716, 1.3677]),
];

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for &(nu, kind, cells, ratio) in COMPLIANCE {
        let case = format!("{kind}, {cells} cells a side, nu = {nu}");
        let name = "compliance over that of 10-node tetrahedra";
        let compliance = move |_: &_| {
            Ok(compliance(kind, cells, nu)? / compliance_of_tet10(FOR_COMPLIANCE, nu)?)
        };
        checks.push(Check::one(
            case,
            name,
            Asked::value(ratio, 0.002),
            PROTOTYPE,
            compliance,
        ));
    }
    for &(kind, [coarse, fine, consistent]) in FREQUENCY {
        let digits = if kind == Kind::Edge(0.5) { 2e-3 } else { 2e-4 };
        let figures = [
            ("f1, lumped mass (Hz)", Asked::value(coarse, digits)),
            ("f1, consistent mass (Hz)", Asked::value(consistent, 2e-3)),
        ];
        let case = format!("{kind}, 10 cells a side, nu = .45");
        checks.push(Check::several(case, figures, PROTOTYPE, move |_| {
            let model = held_cube(kind, 10, 0.45)?;
            let lumped = lowest_omega_lumped(&model)? / TAU;
            Ok(vec![lumped, frequency_consistent(&model)?])
        }));
        let case = format!("{kind}, 14 cells a side, nu = .45");
        let asked = Asked::value(fine, digits);
        checks.push(Check::one(
            case,
            "f1, lumped mass (Hz)",
            asked,
            PROTOTYPE,
            move |_| Ok(lowest_omega_lumped(&held_cube(kind, 14, 0.45)?)? / TAU),
        ));
    }
    checks.push(Check::one(
        "10-node tetrahedra, 6 cells a side, nu = .45",
        "f1, consistent mass (Hz)",
        Asked::value(7.156, 2e-3),
        PROTOTYPE,
        |_| Ok(tet10(FOR_FREQUENCIES, 0.45)?.1.lowest_omega()? / TAU),
    ));
    for kind in [Kind::Edge(1.0), Kind::Edge(0.9)] {
        checks.push(Check::one(
            format!("{kind}, 14 cells a side, nu = .45"),
            "f1, consistent mass, over that of 10-node tetrahedra",
            Asked::value(1.0, 0.01),
            TET10,
            move |_| {
                let found = frequency_consistent(&held_cube(kind, 14, 0.45)?)?;
                Ok(found * TAU / tet10(FOR_FREQUENCIES, 0.45)?.1.lowest_omega()?)
            },
        ));
    }
    for nu in [0.45, 0.499] {
        let finer =
            Source::ClosedForm("the compliance of conforming elements grows towards its limit");
        let check = Check::several(
            format!("10-node tetrahedra, 10 cells a side beside 8, nu = {nu}"),
            [
                ("compliance", Asked::at_least(1.0)),
                ("compliance", Asked::at_most(1.01)),
            ],
            finer,
            move |_| {
                let ratio = compliance_of_tet10(10, nu)? / compliance_of_tet10(FOR_COMPLIANCE, nu)?;
                Ok(vec![ratio; 2])
            },
        );
        checks.push(
            check
                .noted("how far the reference of compliance is from its own limit")
                .long(true),
        );
    }
    for &(kind, steps) in STEP {
        for (nu, step) in [0.45, 0.49].into_iter().zip(steps) {
            let case = format!("{kind}, 10 cells a side, nu = {nu}");
            let asked = Asked::value(step, 2e-4);
            checks.push(Check::one(
                case,
                "stable step (ms)",
                asked,
                PROTOTYPE,
                move |_| Ok(1e3 * critical_step(held_cube(kind, 10, nu)?.operators())),
            ));
        }
    }
    for (name, law, [sag, lowest, highest]) in [
        (
            "Lloyd's springs",
            springs(SpringRule::Lloyd),
            [1.695, 39.0, 505.0],
        ),
        (
            "Van Gelder's springs",
            springs(SpringRule::VanGelder),
            [1.938, 33.4, 454.0],
        ),
        ("nu = .25", linear(0.25), [1.357, 47.7, 558.0]),
        ("nu = .45", linear(0.45), [0.936, 45.7, 990.0]),
        ("nu = .49", linear(0.49), [0.707, 45.9, 2100.0]),
    ] {
        let figures = [
            (
                "sag of the top's centre under 100 Pa (mm)",
                Asked::value(sag, 5e-4),
            ),
            (
                "lowest frequency, lumped mass (rad/s)",
                Asked::value(lowest, 0.05),
            ),
            ("highest frequency (rad/s)", Asked::value(highest, 1.0)),
        ];
        let case = format!("{name}, 10 cells a side");
        checks.push(Check::several(case, figures, PROTOTYPE, move |_| {
            let model = pressed_cube(&law, EDGE, TRACTION)?;
            let u = equilibrium(&model)?;
            let (centre, _) = model.mesh().nearest_node([0.5 * EDGE, 0.5 * EDGE, EDGE]);
            let sag = model.node_displacement(0.0, &u, centre)?[2];
            let highest = Spectrum::of(model.operators()).omega_max;
            Ok(vec![-1e3 * sag, lowest_omega_lumped(&model)?, highest])
        }));
    }
    checks.push(Check::several(
        "the paper's cube: Lloyd's springs, 0.2 m, 500 Pa",
        [
            ("nodes", Asked::value(1331.0, 0.0)),
            ("springs", Asked::value(7930.0, 0.0)),
            ("free degrees of freedom", Asked::value(2673.0, 0.0)),
            ("load asked for (N)", Asked::value(-20.0, 1e-12)),
            ("load on nodes that move (N)", Asked::value(-16.2, 1e-12)),
        ],
        Source::ClosedForm("11^3 nodes, of which 81 of the 121 on the top move"),
        |_| {
            let model = pressed_cube(&springs(SpringRule::Lloyd), 0.2, 500.0)?;
            let report = model.report();
            let counts = [report.nodes, report.edges, report.free_dofs].map(|count| count as f64);
            let asked = report.loads[0].asked[2];
            let acting: f64 = loads(&model).iter().sum();
            Ok([counts.as_slice(), &[asked, acting]].concat())
        },
    ));
    let figure = "stable step (ms)";
    let asked = Asked::value(3.957, 5e-4);
    checks.push(Check::one(
        "Lloyd's springs, 10 cells a side",
        figure,
        asked,
        PROTOTYPE,
        |_| {
            let model = pressed_cube(&springs(SpringRule::Lloyd), EDGE, TRACTION)?;
            Ok(1e3 * critical_step(model.operators()))
        },
    ));
    checks.push(Check::one(
        "p1, 10 cells a side, nu = .45",
        "stable step (ms)",
        Asked::value(2.0208, 5e-5),
        Source::Independent(
            "SciPy on the same mesh and mass, beside which other programs were measured",
        ),
        |_| Ok(1e3 * critical_step(held_cube(Kind::P1, 10, 0.45)?.operators())),
    ));
    checks
}

/// Plain tetrahedra under a pressure (Pa) on the top.
fn pressed_cube(law: &Law, edge: f64, pressure: f64) -> Result<Model, LabError> {
    let mut problem = of_law(law.clone(), Element::P1);
    problem.fixed = vec![held("sides", [true; 3])];
    problem.loads = vec![load("top", LoadKind::Pressure(pressure))];
    Ok(Model::build(&cube(10, edge, Split::Kuhn)?, &problem)?)
}

fn held_cube(kind: Kind, cells: usize, nu: f64) -> Result<Model, LabError> {
    let mut problem = body(YOUNGS_MODULUS, nu, kind.element(None));
    problem.fixed = vec![held("sides", [true; 3])];
    problem.loads = vec![load("top", LoadKind::Traction([0.0, 0.0, -TRACTION]))];
    Ok(Model::build(&cube(cells, EDGE, Split::Kuhn)?, &problem)?)
}

/// The work (J) of the load on the equilibrium.
fn compliance(kind: Kind, cells: usize, nu: f64) -> Result<f64, LabError> {
    let model = held_cube(kind, cells, nu)?;
    Ok(dot(&loads(&model), &equilibrium(&model)?))
}

/// 10-node tetrahedra, and their free part.
fn tet10(cells: usize, nu: f64) -> Result<(Tet10, HeldTet10), LabError> {
    let body = Tet10::new(&cube(cells, EDGE, Split::Kuhn)?);
    let tissue = Tissue {
        youngs_modulus: YOUNGS_MODULUS,
        poissons_ratio: nu,
        density: DENSITY,
    };
    let is_side = |value: f64| value.min(EDGE - value) <= 1e-9 * EDGE;
    let held = body.held(tissue, |[x, y, _]| is_side(x) || is_side(y))?;
    Ok((body, held))
}

/// The work (J) of the load on the equilibrium of 10-node tetrahedra.
fn compliance_of_tet10(cells: usize, nu: f64) -> Result<f64, LabError> {
    let (body, held) = tet10(cells, nu)?;
    let mesh = cube(cells, EDGE, Split::Kuhn)?;
    let top = triangles_where(&mesh, "top", |_| true)?;
    let force = body.traction(&top, [0.0, 0.0, -TRACTION]);
    let u = held.equilibrium(&force)?;
    Ok(dot(force.as_flattened(), u.as_flattened()))
}

/// The first frequency (Hz) with the mass of linear shape functions, V rho/20 between two nodes and twice that for a
/// node.
fn frequency_consistent(model: &Model) -> Result<f64, LabError> {
    let pattern = Arc::clone(model.operators().stiffness().pattern());
    let mut mass = BlockMatrix::zeros(pattern, Layers::Three);
    let mesh = model.mesh();
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let share = DENSITY * mesh.volume(tet) / 20.0;
        for a in nodes {
            for b in nodes {
                let share = if a == b { 2.0 * share } else { share };
                if let (Some(row), Some(column)) = (model.cell_of_node(*a), model.cell_of_node(*b))
                {
                    let block =
                        std::array::from_fn::<_, 9, _>(|k| if k % 4 == 0 { share } else { 0.0 });
                    mass.add_block(row, column, &block)?;
                }
            }
        }
    }
    Ok(lowest_omega(model, |x, out| mass.multiply(x, out))? / TAU)
}
