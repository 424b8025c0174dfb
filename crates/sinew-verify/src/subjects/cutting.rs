//! Cut bodies, and quantities that a cut must not change.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};
use sinew_core::spectrum::{largest_eigenvalue, largest_eigenvalue_of_pencil};
use sinew_core::{ElementBounds, Inputs, LinearSystem, Options, State, System};
use sinew_cutting::Sheet;
use sinew_fem::{CutModel, Element, Model, Problem, SpringRule};
use sinew_integrators::Frame;
use sinew_integrators::cnn::CnnStabilised;
use sinew_mesh::structured::{Split, block, cube};

use super::full_strokes;
use crate::bodies::{DENSITY, YOUNGS_MODULUS, body, held, of_law, springs};
use crate::check::{Asked, Check, Source};
use crate::error::LabError;
use crate::pressed::method;
use crate::staggered_energy::staggered_energy;
use crate::subject::Subject;

pub(super) const SUBJECT: Subject = Subject {
    id: "cutting",
    title: "Cuts",
    says: "Faces are split and no tetrahedron is born: mass, momentum and energy stay what they are, and the largest frequency and the factor between \
           K and its blocks never pass the bounds of single tetrahedra. A cube of 0.1 m with 10 cells a side, held at its bottom, where not said otherwise.",
    checks,
    quoted: &[],
};

const EDGE: f64 = 0.1;

const BOUNDS: Source = Source::Independent(
    "prototype in Python of matrices before and after cuts, which shares no code with the library; its digits as it printed them",
);

const SUM: Source = Source::ClosedForm(
    "M, K and the blocks of K are sums over tetrahedra, which a cut only puts together otherwise",
);

const THROUGH: Source =
    Source::ClosedForm("a blade that comes through a body, past both sides of it, parts it in two");

fn checks() -> Vec<Check> {
    let mut checks = Vec::new();
    for (nu, omega, bound, slit, factor) in [
        (0.25, 591.3, 789.2, 592.2, 3.400),
        (0.45, 1098.2, 1644.7, 1098.3, 3.650),
        (0.49, 2378.6, 3642.4, 2378.7, 3.919),
    ] {
        checks.push(Check::several(
            format!("frequencies, nu {nu}"),
            [
                (
                    "largest of the whole body (1/s)",
                    Asked::relative(omega, 2e-4),
                ),
                ("bound by tetrahedra (1/s)", Asked::value(bound, 0.1)),
                ("bound of K by its blocks", Asked::value(factor, 6e-4)),
                ("new nodes of a slit of 140 faces", Asked::value(77.0, 0.0)),
                ("largest with that slit (1/s)", Asked::relative(slit, 2e-3)),
            ],
            BOUNDS,
            move |_| frequencies(nu),
        ));
    }
    for (nu, factor) in [(0.25, 2.120), (0.45, 2.703), (0.49, 3.212)] {
        checks.push(Check::several(
            format!("K beside its blocks, nu {nu}"),
            [
                (
                    "largest eigenvalue of the whole body",
                    Asked::value(factor, 6e-3),
                ),
                ("faces of a slit", Asked::value(140.0, 0.0)),
                (
                    "largest frequency over its bound, a quarter of all faces cut",
                    Asked::at_most(1.0),
                ),
                (
                    "largest eigenvalue over its bound, a quarter of all faces cut",
                    Asked::at_most(1.0),
                ),
                (
                    "bounds after the cuts over those before, less 1",
                    Asked::value(0.0, 0.0),
                ),
            ],
            BOUNDS,
            move |_| blocks(nu),
        ));
    }
    checks.push(Check::several(
        "Lloyd's springs",
        [
            ("bound of K by its blocks", Asked::value(2.0, 1e-9)),
            (
                "largest frequency over its bound, all faces cut",
                Asked::at_most(1.0),
            ),
        ],
        SUM,
        |_| {
            let mut cut = of_springs(3, SpringRule::Lloyd)?;
            let factor = bounds(&cut)?.block_factor;
            let mut state = State::at_rest(cut.model().dofs());
            cut.cut_faces(inner_faces(&cut), &mut state, Inputs::none())?;
            Ok(vec![factor, omega_max(cut.model()) / omega_bound(&cut)?])
        },
    ));
    checks.push(Check::several(
        "all faces within the body cut: 6000 loose tetrahedra",
        [
            (
                "largest frequency over its bound, less 1",
                Asked::value(0.0, 1e-8),
            ),
            ("mass over that before, less 1", Asked::value(0.0, 1e-12)),
            ("pieces", Asked::value(6000.0, 0.0)),
        ],
        SUM,
        |_| loose_tetrahedra(),
    ));
    checks.push(Check::one(
        "all faces within the body of 3 cells a side cut, nothing held",
        "largest eigenvalue of K beside its blocks over its bound, less 1",
        Asked::value(0.0, 1e-8),
        SUM,
        |_| {
            let mesh = cube(3, EDGE, Split::Kuhn)?;
            let free = body(YOUNGS_MODULUS, 0.45, Element::P1);
            let mut cut = CutModel::new(Arc::new(mesh), free, 0.0)?;
            let mut state = State::at_rest(cut.model().dofs());
            cut.cut_faces(inner_faces(&cut), &mut state, Inputs::none())?;
            Ok(block_factor(cut.model())? / bounds(&cut)?.block_factor - 1.0)
        },
    ));
    checks.push(Check::several(
        "slit through a body that moves",
        ["mass", "momentum", "kinetic energy", "elastic energy"].map(|of| {
            (
                format!("{of} after over that before, less 1"),
                Asked::value(0.0, 1e-13),
            )
        }),
        SUM,
        |_| kept_by_a_slit(cuttable(10, 0.45, 0.0)?),
    ));
    checks.push(Check::several(
        "slit through Van Gelder's springs that move",
        ["mass", "momentum", "kinetic energy", "elastic energy"].map(|of| {
            (
                format!("{of} after over that before, less 1"),
                Asked::value(0.0, 1e-13),
            )
        }),
        SUM,
        |_| kept_by_a_slit(of_springs(6, SpringRule::VanGelder)?),
    ));
    checks.push(Check::several(
        "bar of nu 0 that is stretched and cut in the middle",
        [
            (
                "difference of its held half from a bar of that length (m)",
                Asked::at_most(1e-13),
            ),
            (
                "stretch of its free half once it has settled (m)",
                Asked::at_most(1e-10),
            ),
        ],
        Source::ClosedForm("two bars"),
        |_| bar(),
    ));
    checks.push(Check::one(
        "central difference at .95 of the bound, cut four times, 1e5 steps",
        "energy of the staggered step over that at first, less 1",
        Asked::value(0.0, 1e-9),
        Source::ClosedForm("leapfrog keeps v'(M - dt^2/4 K)v + u'Ku"),
        |_| leapfrog_over_cuts(),
    ));
    checks.push(Check::one(
        "newmark at 5 ms, cut on the way",
        "energy after 1000 steps over that at first, less 1",
        Asked::value(0.0, 1e-9),
        Source::ClosedForm("the mean acceleration method keeps the energy of linear bodies"),
        |_| newmark_over_a_cut(),
    ));
    checks.push(Check::one(
        "cnn-stabilised at 20 ms, cut three times",
        "largest rise of the energy of the step over the largest energy, cuts included",
        Asked::at_most(1e-12),
        Source::ClosedForm("E+ - E- <= 0 for P above dt^2/4 K, and E is a sum over tetrahedra"),
        |_| stabilised_over_cuts(),
    ));
    checks.push(
        Check::several(
            "plane through the middle at 17 angles",
            [
                ("pieces", Asked::value(2.0, 0.0)),
                ("largest frequency of a tetrahedron over the mesh's", Asked::at_most(1.25)),
                ("smallest volume of a tetrahedron over that of the mesh", Asked::at_least(0.3)),
                ("mass over that before, less 1", Asked::value(0.0, 1e-13)),
                ("largest roughness, root mean square, over the grid's edge", Asked::at_most(0.55)),
                ("the same at the angle nearest to the grid's planes", Asked::at_most(0.35)),
            ],
            Source::ClosedForm("what snapping promises"),
            |_| planes(),
        )
        .noted(
            "Between the grid's planes the bound of the frequency refuses most moves, and a cut along faces stays rough by half an edge.",
        ),
    );
    checks.push(Check::several(
        "a tenth of the tetrahedra removed at random",
        [
            ("largest frequency over its bound", Asked::at_most(1.0)),
            (
                "mass left and removed over that before, less 1",
                Asked::value(0.0, 1e-13),
            ),
        ],
        SUM,
        |_| removal(),
    ));
    let through = || {
        [
            (
                "strokes that leave other than two pieces",
                Asked::value(0.0, 0.0),
            ),
            ("area told as left uncut (m^2)", Asked::value(0.0, 0.0)),
        ]
    };
    checks.push(Check::several(
        "20 sheets through a strip held at strains of 0 to 30 %, three laws, central difference at 0.5 ms",
        through(),
        THROUGH,
        |_| full_strokes::under_tension(),
    ));
    checks.push(Check::several(
        "20 sheets through a free cube, strained by 0 to 30 %, 100 random velocities, three laws",
        through(),
        THROUGH,
        |_| full_strokes::free(),
    ));
    checks.push(Check::one(
        "mirrored cube under gravity, slit in the middle",
        "lateral drift of the centre of mass over the edge",
        Asked::at_most(1e-12),
        Source::ClosedForm("symmetry"),
        |_| drift(),
    ));
    checks
}

fn held_cube(nu: f64) -> Problem {
    Problem {
        fixed: vec![held("bottom", [true; 3])],
        ..body(YOUNGS_MODULUS, nu, Element::P1)
    }
}

fn cuttable(cells: usize, nu: f64, snap: f64) -> Result<CutModel, LabError> {
    let mesh = cube(cells, EDGE, Split::Kuhn)?;
    Ok(CutModel::new(Arc::new(mesh), held_cube(nu), snap)?)
}

/// Cuts with a blade along y that comes down in the middle to a height (m).
fn slit(cut: &mut CutModel, state: &mut State, height: f64) -> Result<usize, LabError> {
    let blade = |z: f64| [[0.05, -0.05, z], [0.05, 0.15, z]];
    let sheet = Sheet::swept(blade(0.2), blade(height)).ok_or_else(LabError::no_body)?;
    Ok(cut.stroke(&sheet, state, Inputs::none())?.new_nodes)
}

fn omega_max(model: &Model) -> f64 {
    let k = model.operators().stiffness();
    largest_eigenvalue(model.mass(), |x, out| k.multiply(x, out)).sqrt()
}

fn bounds(cut: &CutModel) -> Result<ElementBounds, LabError> {
    let bounds = cut.model().operators().element_bounds();
    bounds.ok_or_else(LabError::no_body)
}

fn omega_bound(cut: &CutModel) -> Result<f64, LabError> {
    Ok(bounds(cut)?.omega_max)
}

/// A cube of springs that stands on its bottom.
fn of_springs(cells: usize, rule: SpringRule) -> Result<CutModel, LabError> {
    let mut problem = of_law(springs(rule), Element::P1);
    problem.fixed = vec![held("bottom", [true; 3])];
    let mesh = cube(cells, EDGE, Split::Kuhn)?;
    Ok(CutModel::new(Arc::new(mesh), problem, 0.0)?)
}

/// Faces between tetrahedra, each once.
fn inner_faces(cut: &CutModel) -> Vec<(u32, usize)> {
    let body = cut.body();
    let tets = 0..body.tets().len() as u32;
    let faces = tets.flat_map(|tet| (0..4).map(move |vertex| (tet, vertex)));
    let is_first = |(tet, vertex): &(u32, usize)| {
        let other = body.neighbour(*tet, *vertex);
        other.is_some_and(|other| other > *tet)
    };
    faces.filter(is_first).collect()
}

/// The largest eigenvalue of K relative to its diagonal blocks, by iteration.
fn block_factor(model: &Model) -> Result<f64, LabError> {
    let k = model.operators().stiffness();
    let mut inverse = Vec::new();
    for cell in 0..k.pattern().cells() {
        let block = k.block(cell, cell).ok_or_else(LabError::no_body)?;
        let block = Matrix3::from_row_slice(block).try_inverse();
        inverse.push(block.ok_or_else(LabError::no_body)?);
    }
    let solve = |x: &[f64], out: &mut [f64]| {
        let cells = x.chunks_exact(3).zip(out.chunks_exact_mut(3));
        for ((x, out), block) in cells.zip(&inverse) {
            out.copy_from_slice((block * Vector3::from_column_slice(x)).as_slice());
        }
    };
    let multiply = |x: &[f64], out: &mut [f64]| k.multiply(x, out);
    Ok(largest_eigenvalue_of_pencil(model.dofs(), multiply, solve))
}

fn blocks(nu: f64) -> Result<Vec<f64>, LabError> {
    let mut cut = cuttable(10, nu, 0.0)?;
    let (before, whole) = (bounds(&cut)?, block_factor(cut.model())?);
    let mut state = State::at_rest(cut.model().dofs());
    let blade = |z: f64| [[0.05, -0.01, z], [0.05, 0.11, z]];
    let sheet = Sheet::swept(blade(0.11), blade(0.0301)).ok_or_else(LabError::no_body)?;
    let faces = cut.stroke(&sheet, &mut state, Inputs::none())?.faces;
    let quarter: Vec<_> = inner_faces(&cut).into_iter().step_by(4).collect();
    cut.cut_faces(quarter, &mut state, Inputs::none())?;
    let after = bounds(&cut)?;
    let changes = [
        after.omega_max / before.omega_max,
        after.block_factor / before.block_factor,
    ];
    Ok(vec![
        whole,
        faces as f64,
        omega_max(cut.model()) / before.omega_max,
        block_factor(cut.model())? / before.block_factor,
        changes
            .map(|change| (change - 1.0).abs())
            .into_iter()
            .fold(0.0, f64::max),
    ])
}

fn frequencies(nu: f64) -> Result<Vec<f64>, LabError> {
    let mut cut = cuttable(10, nu, 0.0)?;
    let bounds = bounds(&cut)?;
    let whole = omega_max(cut.model());
    let mut state = State::at_rest(cut.model().dofs());
    let nodes = slit(&mut cut, &mut state, 0.0301)?;
    Ok(vec![
        whole,
        bounds.omega_max,
        bounds.block_factor,
        nodes as f64,
        omega_max(cut.model()),
    ])
}

fn loose_tetrahedra() -> Result<Vec<f64>, LabError> {
    let mut cut = cuttable(10, 0.45, 0.0)?;
    let mass = cut.model().report().mass;
    let mut state = State::at_rest(cut.model().dofs());
    let tets = 0..cut.body().tets().len() as u32;
    let faces: Vec<_> = tets
        .flat_map(|tet| (0..4).map(move |vertex| (tet, vertex)))
        .collect();
    cut.cut_faces(faces, &mut state, Inputs::none())?;
    Ok(vec![
        omega_max(cut.model()) / omega_bound(&cut)? - 1.0,
        cut.model().report().mass / mass - 1.0,
        cut.body().pieces().count as f64,
    ])
}

/// A state that strains and moves everything.
fn some_state(model: &Model) -> State {
    let wave = |k: usize, f: f64| 1e-3 * (f * k as f64).sin();
    let dofs = model.dofs();
    State::new(
        (0..dofs).map(|k| wave(k, 0.7)).collect(),
        (0..dofs).map(|k| 0.1 + 30.0 * wave(k, 1.3)).collect(),
    )
}

fn kept_by_a_slit(mut cut: CutModel) -> Result<Vec<f64>, LabError> {
    let mut state = some_state(cut.model());
    let figures = |model: &Model, state: &State| -> Result<[f64; 4], LabError> {
        let energy = model
            .energy(&state.u, &state.v)
            .ok_or_else(LabError::no_body)?;
        let terms = model.mass().iter().zip(&state.v).step_by(3);
        let momentum = terms.map(|(mass, v)| mass * v).sum();
        Ok([
            model.report().mass,
            momentum,
            energy.kinetic,
            energy.elastic,
        ])
    };
    let before = figures(cut.model(), &state)?;
    slit(&mut cut, &mut state, 0.0301)?;
    let after = figures(cut.model(), &state)?;
    Ok(after
        .iter()
        .zip(before)
        .map(|(after, before)| after / before - 1.0)
        .collect())
}

fn bar() -> Result<Vec<f64>, LabError> {
    let bar = |layers: usize| -> Result<CutModel, LabError> {
        let size = [0.02, 0.02, 0.02 * layers as f64];
        let mesh = block([1, 1, layers], size, Split::Kuhn)?;
        let mut problem = held_cube(0.0);
        problem.damping.mass = 6.0;
        Ok(CutModel::new(Arc::new(mesh), problem, 0.0)?)
    };
    let stretched = |model: &Model| -> Result<State, LabError> {
        let mut state = State::at_rest(model.dofs());
        let field: Vec<[f64; 3]> = model
            .mesh()
            .points
            .iter()
            .map(|p| [0.0, 0.0, 0.1 * p[2]])
            .collect();
        model.to_dofs(&field, &mut state.u)?;
        Ok(state)
    };
    let (mut whole, half) = (bar(20)?, bar(10)?);
    let (mut state, mut alone) = (stretched(whole.model())?, stretched(half.model())?);
    // In the stretched bar the middle is at 0.22 m.
    let blade = |x: f64| [[x, -0.01, 0.22], [x, 0.03, 0.22]];
    let sheet = Sheet::swept(blade(-0.01), blade(0.03)).ok_or_else(LabError::no_body)?;
    whole.stroke(&sheet, &mut state, Inputs::none())?;
    let mut methods = [
        method("central-difference", &Options::new())?,
        method("central-difference", &Options::new())?,
    ];
    let (dt, mut apart) = (1e-3, 0.0_f64);
    for _ in 0..600 {
        methods[0].step(whole.model(), &mut state, dt)?;
        methods[1].step(half.model(), &mut alone, dt)?;
        let held = state.u.iter().zip(&alone.u).take(3 * 4 * 10);
        apart = held.map(|(a, b)| (a - b).abs()).fold(apart, f64::max);
    }
    for _ in 0..12_000 {
        methods[0].step(whole.model(), &mut state, dt)?;
    }
    let mut field = vec![[0.0; 3]; whole.model().mesh().points.len()];
    whole.model().to_nodes(&state.u, &mut field)?;
    // Copies come last, and stand at the lower end of the free half; a turn as a rigid body moves both ends' means alike.
    let end = |nodes: &[[f64; 3]]| nodes.iter().map(|u| u[2]).sum::<f64>() / 4.0;
    let stretch = end(&field[80..84]) - end(&field[84..]);
    Ok(vec![apart, stretch.abs()])
}

/// A bend of the whole body, at rest.
fn bent(model: &Model) -> Result<State, LabError> {
    let bend = |p: &[f64; 3]| [2.0 * p[2] * p[2], 0.0, -0.5 * p[0] * p[2]];
    let field: Vec<[f64; 3]> = model.mesh().points.iter().map(bend).collect();
    let mut state = State::at_rest(model.dofs());
    model.to_dofs(&field, &mut state.u)?;
    Ok(state)
}

fn leapfrog_over_cuts() -> Result<f64, LabError> {
    let mut cut = cuttable(4, 0.45, 0.0)?;
    let dt = 0.95 * 2.0 / omega_bound(&cut)?;
    let mut state = bent(cut.model())?;
    let mut method = method("central-difference", &Options::new())?;
    method.step(cut.model(), &mut state, dt)?;
    let first = staggered_energy(cut.model(), &state, None, dt);
    for height in [0.08, 0.06, 0.03, -0.01] {
        for _ in 0..25_000 {
            method.step(cut.model(), &mut state, dt)?;
        }
        slit(&mut cut, &mut state, height)?;
    }
    for _ in 0..1000 {
        method.step(cut.model(), &mut state, dt)?;
    }
    Ok(staggered_energy(cut.model(), &state, None, dt) / first - 1.0)
}

fn newmark_over_a_cut() -> Result<f64, LabError> {
    let mut cut = cuttable(4, 0.45, 0.0)?;
    let mut state = bent(cut.model())?;
    let mut method = method("newmark", &Options::new())?;
    let energy = |cut: &CutModel, state: &State| {
        let energy = cut.model().energy(&state.u, &state.v);
        energy
            .map(sinew_core::Energy::total)
            .ok_or_else(LabError::no_body)
    };
    let first = energy(&cut, &state)?;
    for step in 0..1000 {
        if step == 100 {
            slit(&mut cut, &mut state, 0.03)?;
        }
        method.step(cut.model(), &mut state, 0.005)?;
    }
    Ok(energy(&cut, &state)? / first - 1.0)
}

fn stabilised_over_cuts() -> Result<f64, LabError> {
    let mut cut = cuttable(6, 0.45, 0.0)?;
    let mut state = bent(cut.model())?;
    let (dt, mut integrator) = (0.02, Frame::new(CnnStabilised::default()));
    let (mut last, mut largest, mut rise): (Option<f64>, f64, f64) = (None, 0.0, 0.0);
    for step in 0..400 {
        if let Some((_, height)) = [(50, 0.06), (150, 0.02), (250, -0.01)]
            .into_iter()
            .find(|(at, _)| *at == step)
        {
            slit(&mut cut, &mut state, height)?;
        }
        sinew_core::Integrator::step(&mut integrator, cut.model(), &mut state, dt)?;
        let blocks = integrator.scheme().stabiliser();
        let blocks = blocks.map(|stabiliser| stabiliser.majorant().inverse().entries());
        let energy = staggered_energy(cut.model(), &state, blocks, dt);
        rise = rise.max(last.map_or(0.0, |last| energy - last));
        largest = largest.max(energy);
        last = Some(energy);
    }
    Ok(rise / largest)
}

fn planes() -> Result<Vec<f64>, LabError> {
    let mesh = Arc::new(cube(10, EDGE, Split::Kuhn)?);
    let free = || body(YOUNGS_MODULUS, 0.45, Element::P1);
    let (grid, whole) = (EDGE / 10.0, DENSITY * EDGE.powi(3));
    let mut worst = [2.0, 0.0_f64, f64::INFINITY, 0.0_f64, 0.0_f64, f64::INFINITY];
    for k in (0..17).map(f64::from) {
        let (angle, tilt) = (std::f64::consts::PI * (k + 0.3) / 17.0, 0.37 * k);
        let normal = [
            angle.cos(),
            angle.sin() * tilt.cos(),
            angle.sin() * tilt.sin(),
        ];
        let sheet = plane([0.0512, 0.0493, 0.0507], normal).ok_or_else(LabError::no_body)?;
        let mut cut = CutModel::new(Arc::clone(&mesh), free(), 0.25)?;
        let mut state = State::at_rest(cut.model().dofs());
        cut.stroke(&sheet, &mut state, Inputs::none())?;
        let (points, tets) = (&cut.mesh().mesh.points, &cut.mesh().mesh.tets);
        let first_largest = cut.body().largest_frequency();
        for (tet, nodes) in tets.iter().enumerate() {
            let vertices = nodes.map(|node| points[node as usize]);
            let frequency = cut.model().tet_frequency(tet, &vertices) / first_largest;
            worst[1] = worst[1].max(frequency);
            worst[2] = worst[2].min(cut.mesh().mesh.volume(tet) * 6.0 / grid.powi(3));
        }
        let pieces = cut.body().pieces().count as f64;
        worst[0] = if pieces == 2.0 { worst[0] } else { pieces };
        worst[3] = worst[3].max((cut.model().report().mass / whole - 1.0).abs());
        let copied = cut.body().origins()[mesh.points.len()..].iter();
        let squares: Vec<f64> = copied
            .map(|node| (sheet.distance(points[*node as usize]) / grid).powi(2))
            .collect();
        let rough = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        worst[4] = worst[4].max(rough);
        worst[5] = worst[5].min(rough);
    }
    Ok(worst.to_vec())
}

/// A sheet through a point with this normal, which extends far beyond the cube on all sides.
fn plane(centre: [f64; 3], normal: [f64; 3]) -> Option<Sheet> {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let helper = if normal[0].abs() < 0.8 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let e = cross(normal, helper);
    let f = cross(normal, e);
    let corner = |s: f64, t: f64| std::array::from_fn(|i| centre[i] + 0.5 * (s * e[i] + t * f[i]));
    Sheet::swept(
        [corner(-1.0, -1.0), corner(1.0, -1.0)],
        [corner(-1.0, 1.0), corner(1.0, 1.0)],
    )
}

fn removal() -> Result<Vec<f64>, LabError> {
    let mut cut = cuttable(10, 0.45, 0.0)?;
    let mass = cut.model().report().mass;
    let mut state = State::at_rest(cut.model().dofs());
    let mut seed = 1_u64;
    let mut tenth = |_: [f64; 3]| {
        // The constants of Knuth's generator MMIX.
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 32).is_multiple_of(10)
    };
    let report = cut.remove(&mut tenth, &mut state, Inputs::none())?;
    Ok(vec![
        omega_max(cut.model()) / omega_bound(&cut)?,
        (cut.model().report().mass + report.removed_mass) / mass - 1.0,
    ])
}

fn drift() -> Result<f64, LabError> {
    let mesh = cube(10, EDGE, Split::Mirrored)?;
    let mut problem = held_cube(0.45);
    problem.gravity = Some([0.0, 0.0, -9.81]);
    problem.damping.mass = 10.0;
    let mut cut = CutModel::new(Arc::new(mesh), problem, 0.25)?;
    let mut state = State::at_rest(cut.model().dofs());
    let mut method = method("central-difference", &Options::new())?;
    for step in 0..600 {
        if step == 100 {
            slit(&mut cut, &mut state, 0.03)?;
        }
        method.step(cut.model(), &mut state, 5e-4)?;
    }
    let terms = cut.model().mass().iter().zip(&state.u).step_by(3);
    let moment: f64 = terms.map(|(mass, u)| mass * u).sum();
    Ok((moment / cut.model().report().mass).abs() / EDGE)
}
