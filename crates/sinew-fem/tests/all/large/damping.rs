//! Stiffness damping of hyperelastic bodies: it acts on the rate of Green's strain alone, takes energy in any state, and is that of the small-strain stiffness at rest.

use crate::common::{
    ELEMENTS, at, at_most, body, build, dot, held, linear, max_abs, relative_difference,
    stiffness_times, uneven_cube, waves,
};
use sinew_core::{BlockMatrix, ElasticLaw, ForceLaw, Layers, Ramp, System, TangentKind, Trial};
use sinew_core::{LoadTime, Velocities};
use sinew_fem::hyperelastic::Hyperelastic;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::{Course, Element, FibreFamily, Law, Model, Moving, Problem, Tissue};
use sinew_mesh::TetMesh;
use sinew_mesh::vector::cross;

const YOUNGS_MODULUS: f64 = 3500.0;
const NU: f64 = 0.45;

/// Factor of stiffness damping (s).
const BETA: f64 = 0.005;

fn of(id: &'static str, element: Element) -> Problem {
    let parameters = Hyperelastic::parameters(id, YOUNGS_MODULUS, NU).unwrap();
    let mut problem = body(Law::hyperelastic(id, parameters));
    problem.regions[0].element = element;
    problem.damping.stiffness = BETA;
    problem
}

fn fibrous(id: &'static str, element: Element) -> Problem {
    let mut problem = of(id, element);
    let stiffening = Stiffening::Exponential {
        k1: 1000.0,
        k2: 2.0,
        dispersion: 0.1,
    };
    problem.regions[0].tissue = Tissue {
        fibres: vec![FibreFamily::new(
            Fibres::new(stiffening).unwrap(),
            [3.0, -1.0, 2.0],
        )],
        ..Tissue::default()
    };
    problem
}

/// Every law and fibres, on every element.
fn all() -> impl Iterator<Item = (String, Problem)> {
    ELEMENTS.into_iter().flat_map(|element| {
        let laws = Hyperelastic::IDS.iter().map(move |id| of(id, element));
        let all = laws.chain(["neo-hookean", "corotational"].map(|id| fibrous(id, element)));
        all.zip(0..)
            .map(move |(problem, at)| (format!("{at}, {element}"), problem))
    })
}

/// A displacement (m) of all nodes with strains of some 30 %.
fn bent(mesh: &TetMesh, squeeze: f64) -> Vec<f64> {
    let of = |[x, y, z]: [f64; 3]| {
        [
            0.03 * (25.0 * z).sin() - squeeze * x + 2.0 * y * z,
            0.02 * (31.0 * x + 8.0 * y).cos() - 0.3 * z,
            -0.25 * z + 0.15 * y + 3.0 * x * x,
        ]
    };
    mesh.points.iter().flat_map(|point| of(*point)).collect()
}

/// The force (N) of damping on a free body: the change of the net force by a velocity.
fn damping(model: &Model, u: &[f64], v: &[f64]) -> Vec<f64> {
    let still = vec![0.0; u.len()];
    let net = |v: &[f64]| {
        let mut out = vec![0.0; u.len()];
        model.net_force(&at(u, v), &mut out).unwrap();
        out
    };
    let (moving, resting) = (net(v), net(&still));
    resting.iter().zip(moving).map(|(a, b)| a - b).collect()
}

/// The velocities (m/s) of a rotation of the deformed body about the origin.
fn turning(mesh: &TetMesh, u: &[f64], omega: [f64; 3]) -> Vec<f64> {
    let places = mesh.points.iter().zip(u.as_chunks::<3>().0);
    let places = places.map(|(point, u)| [0, 1, 2].map(|k| point[k] + u[k]));
    places.flat_map(|place| cross(omega, place)).collect()
}

#[test]
fn a_turn_of_a_strained_body_is_not_damped_and_damping_never_turns_it() {
    let mesh = uneven_cube();
    for (name, problem) in all() {
        let (model, u) = (build(&mesh, &problem), bent(&mesh, 0.2));
        let any = waves(u.len(), 0.7);
        let force = damping(&model, &u, &any);
        let size = max_abs(&force);
        let turning = turning(&mesh, &u, [0.5, -0.3, 0.8]);
        let scale = size * max_abs(&turning) / max_abs(&any);
        at_most(
            &name,
            max_abs(&damping(&model, &u, &turning)) / scale,
            1e-12,
        );
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        let places = mesh.points.iter().zip(u.as_chunks::<3>().0);
        for ((point, u), force) in places.zip(force.as_chunks::<3>().0) {
            let place = [0, 1, 2].map(|k| point[k] + u[k]);
            let turning = cross(place, *force);
            for k in 0..3 {
                sum[k] += force[k];
                moment[k] += turning[k];
            }
        }
        at_most("its resultant", max_abs(&sum) / size, 1e-12);
        at_most("its moment", max_abs(&moment) / (0.1 * size), 1e-12);
    }
}

/// Under pressure and in bodies pressed flat the tangent is not positive semidefinite.
#[test]
fn damping_takes_energy_in_any_state() {
    let mesh = uneven_cube();
    for (name, problem) in all() {
        let model = build(&mesh, &problem);
        for squeeze in [-0.4, 0.2, 0.6] {
            let u: Vec<f64> = bent(&mesh, squeeze).iter().map(|u| 0.7 * u).collect();
            let any = waves(u.len(), 0.7);
            let size = max_abs(&damping(&model, &u, &any)) / max_abs(&any);
            for seed in 0..6 {
                let v = match seed {
                    0 => turning(&mesh, &u, [1.0, 0.0, 0.0]),
                    1 => turning(&mesh, &u, [0.0, 1.0, 1.0]),
                    _ => waves(u.len(), 0.3 + 0.41 * f64::from(seed)),
                };
                let force = damping(&model, &u, &v);
                let (power, least) = (dot(&force, &v), -1e-11 * size * max_abs(&v).powi(2));
                assert!(power >= least, "{name}, {squeeze}, {seed}: {power}");
            }
        }
    }
}

/// Each mode at small strain decays with half of beta times the square of its frequency.
#[test]
fn at_rest_damping_is_that_of_the_linear_law_on_the_same_element() {
    let mesh = uneven_cube();
    for element in ELEMENTS {
        let mut small = body(linear(YOUNGS_MODULUS, NU));
        small.regions[0].element = element;
        let small = build(&mesh, &small);
        for id in Hyperelastic::IDS {
            let model = build(&mesh, &of(id, element));
            let (rest, v) = (vec![0.0; model.dofs()], waves(model.dofs(), 0.7));
            let expected: Vec<f64> = stiffness_times(&small, &v)
                .iter()
                .map(|force| BETA * force)
                .collect();
            let found = damping(&model, &rest, &v);
            let off = relative_difference(&found, &expected);
            at_most(&format!("{id}, {element}"), off, 1e-12);
        }
    }
}

#[test]
fn products_matrices_and_own_blocks_of_damping_are_one() {
    let mesh = uneven_cube();
    for (name, mut problem) in all() {
        problem.fixed.push(held("bottom"));
        let model = build(&mesh, &problem);
        let u = crate::common::on_cells(&model, |node| {
            let first = 3 * node;
            bent(&mesh, 0.2)[first..first + 3].try_into().unwrap()
        });
        let (w, still) = (waves(u.len(), 0.7), vec![0.0; u.len()]);
        let trial = at(&u, &still);
        let mut product = vec![0.0; u.len()];
        model
            .viscous_force(&trial, Velocities::Cells(&w), &mut product)
            .unwrap();
        let by_force = damping(&model, &u, &w);
        at_most(&name, relative_difference(&product, &by_force), 1e-10);
        let mut matrix = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
        model
            .tangent(&trial, TangentKind::Exact, &mut matrix)
            .unwrap();
        let mut before = vec![0.0; u.len()];
        matrix.multiply(&w, &mut before);
        model.add_viscosity(&trial, 3.0, &mut matrix).unwrap();
        let mut after = vec![0.0; u.len()];
        matrix.multiply(&w, &mut after);
        let by_matrix: Vec<f64> = after
            .iter()
            .zip(&before)
            .map(|(a, b)| (a - b) / 3.0)
            .collect();
        at_most(
            "as a matrix",
            relative_difference(&by_matrix, &product),
            1e-10,
        );
        let mut own = BlockMatrix::zeros(model.pattern().clone(), Layers::Three);
        model.add_viscosity(&trial, 1.0, &mut own).unwrap();
        let mut blocks = vec![0.0; 3 * u.len()];
        model.add_viscous_blocks(&trial, 1.0, &mut blocks).unwrap();
        let is_fibrous = !problem.regions[0].tissue.fibres.is_empty();
        for (cell, block) in blocks.chunks_exact(9).enumerate() {
            let own = own.block(cell, cell).unwrap();
            let off = block.iter().zip(own).map(|(a, b)| a - b);
            let off: Vec<f64> = off.collect();
            // Idle fibres count in own blocks.
            let is_more = off[0].min(off[4]).min(off[8]) >= -1e-12 * max_abs(own);
            let is_same = max_abs(&off) <= 1e-11 * max_abs(own);
            assert!(is_same || is_fibrous && is_more, "{name}: {off:?}");
        }
    }
}

/// The power of damping with moved supports, from an independent sum over tetrahedra: `2 mu E':E' + lambda (J')^2` for
/// the neo-Hookean law, with E' and J' from differences of two places.
#[test]
fn the_power_of_damping_counts_supports_in_motion() {
    let mesh = uneven_cube();
    let ramp = Ramp::Table {
        times: vec![0.0, 1.0],
        values: vec![0.0, 1.0],
    };
    let mut problem = of("neo-hookean", Element::P1);
    problem.damping.mass = 3.0;
    problem.fixed.push(held("bottom"));
    problem
        .moves
        .push(Moving::new("top", [Course::new([0.02, -0.01, 0.03], ramp)]));
    let model = build(&mesh, &problem);
    let (t, h) = (0.4, 1e-6);
    let u = crate::common::on_cells(&model, |node| {
        let first = 3 * node;
        bent(&mesh, 0.2)[first..first + 3].try_into().unwrap()
    });
    let w = waves(u.len(), 0.7);
    let places = |h: f64| {
        let moved: Vec<f64> = u.iter().zip(&w).map(|(u, w)| u + h * w).collect();
        let mut places = vec![[0.0; 3]; mesh.points.len()];
        model.displacements_at(t + h, &moved, &mut places).unwrap();
        places
    };
    let [lambda, mu] = [NU / (1.0 - 2.0 * NU), 0.5].map(|x| x * YOUNGS_MODULUS / (1.0 + NU));
    // Edges of a tetrahedron as columns; F is those now by the inverse of those at rest.
    let gradient = |nodes: [u32; 4], u: &[[f64; 3]]| {
        let edges = |of: &dyn Fn(usize) -> [f64; 3]| {
            let [a, b, c, d] = nodes.map(|node| of(node as usize));
            nalgebra::Matrix3::from_columns(
                &[b, c, d].map(|end| nalgebra::Vector3::from(end) - nalgebra::Vector3::from(a)),
            )
        };
        let rest = edges(&|node| mesh.points[node]);
        let now = edges(&|node| [0, 1, 2].map(|k| mesh.points[node][k] + u[node][k]));
        now * rest.try_inverse().unwrap()
    };
    let (before, middle, after) = (places(-h), places(0.0), places(h));
    let mut expected = 0.0;
    for (tet, nodes) in mesh.tets.iter().enumerate() {
        let [a, b] = [&before, &after].map(|u| gradient(*nodes, u));
        let strain = (b.transpose() * b - a.transpose() * a) / (4.0 * h);
        let dilation = (b.determinant() - a.determinant()) / (2.0 * h);
        let density = 2.0 * mu * strain.norm_squared() + lambda * dilation * dilation;
        expected += BETA * mesh.volume(tet) * density;
    }
    let velocities = before.iter().zip(&after);
    let velocities = velocities.map(|(a, b)| [0, 1, 2].map(|k| (b[k] - a[k]) / (2.0 * h)));
    let velocities: Vec<[f64; 3]> = velocities.collect();
    for (v, mass) in velocities.iter().zip(model.node_masses()) {
        expected += 3.0 * mass * v.iter().map(|v| v * v).sum::<f64>();
    }
    let found = model.damping_power([&middle, &velocities]).unwrap();
    at_most("power", (found / expected - 1.0).abs(), 1e-8);

    // The share of supports on cells is what the whole force has beyond that of cells alone.
    let trial = Trial {
        load: LoadTime::at(t),
        ..at(&u, &w)
    };
    let force = |of: Velocities<'_>| {
        let mut out = vec![0.0; u.len()];
        model.viscous_force(&trial, of, &mut out).unwrap();
        out
    };
    let parts = force(Velocities::Cells(&w));
    let parts = parts.iter().zip(force(Velocities::Supports));
    let parts: Vec<f64> = parts.map(|(a, b)| a + b).collect();
    let whole = force(Velocities::All(&w));
    at_most("supports", relative_difference(&parts, &whole), 1e-12);
}
