//! The bodies of a bench of kernels.

use sinew_verify::LabError;
use std::path::Path;

use sinew_fem::{Model, Problem, Rayleigh};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{GroupMembers, TetMesh, read_msh_file};

use crate::pressed;

/// A body with its model.
pub(super) struct Body {
    pub(super) name: String,
    pub(super) nodes: usize,
    pub(super) tets: usize,
    pub(super) model: Model,
}

/// The peers' cube at several sizes, a body without a lattice, an organ and, if any, a larger mesh of a mesh generator.
pub(super) fn bodies(
    meshes: &Path,
    generated: Option<&Path>,
    quick: bool,
) -> Result<Vec<Body>, LabError> {
    let sizes: &[usize] = if quick { &[6] } else { &[10, 20, 40] };
    let mut bodies = Vec::new();
    for cells in sizes {
        bodies.push(cube_body(*cells)?);
    }
    if !quick {
        let mut mesh = cube(20, 0.1, Split::Kuhn)?;
        scatter(&mut mesh);
        bodies.push(body("scattered 21^3".into(), &mesh, "sides", "top")?);
        let organ = read_msh_file(meshes.join("organ.msh"))?.to_tet_mesh()?;
        bodies.push(body("organ.msh".into(), &organ, "attachment", "capsule")?);
    }
    if let Some(path) = generated {
        let mesh = read_msh_file(path)?.to_tet_mesh()?;
        bodies.push(body("gmsh block".into(), &mesh, "bottom", "top")?);
    }
    Ok(bodies)
}

/// The peers' cube with `cells` cells along an edge.
pub(super) fn cube_body(cells: usize) -> Result<Body, LabError> {
    let mesh = cube(cells, 0.1, Split::Kuhn)?;
    body(format!("cube {}^3", cells + 1), &mesh, "sides", "top")
}

/// A cube without loads, with this mass damping (1/s).
pub(super) fn damped_cube(cells: usize, mass: f64) -> Result<Model, LabError> {
    let mesh = cube(cells, 0.1, Split::Kuhn)?;
    let mut problem = problem("sides", "top");
    problem.loads.clear();
    problem.damping.mass = mass;
    Ok(Model::build(&mesh, &problem)?)
}

/// Moves nodes by up to a tenth of a cell and numbers them irregularly, as mesh generators do.
fn scatter(mesh: &mut TetMesh) {
    let count = mesh.points.len();
    let shift = |node: usize, axis: usize| 5e-4 * ((12.9898 * (3 * node + axis) as f64).sin());
    let points = mesh.points.iter().enumerate();
    let moved: Vec<[f64; 3]> = points
        .map(|(node, point)| std::array::from_fn(|axis| point[axis] + shift(node, axis)))
        .collect();
    // Prime to the number of nodes of a cube of 20 cells, 21^3.
    let leap = 5003;
    let number = |node: u32| (node as usize * leap % count) as u32;
    for (node, point) in moved.into_iter().enumerate() {
        mesh.points[number(node as u32) as usize] = point;
    }
    for tet in &mut mesh.tets {
        *tet = tet.map(number);
    }
    for group in &mut mesh.groups {
        if let GroupMembers::Triangles(triangles) = &mut group.members {
            for triangle in triangles {
                *triangle = triangle.map(number);
            }
        }
    }
}

fn body(name: String, mesh: &TetMesh, held: &str, pressed: &str) -> Result<Body, LabError> {
    Ok(Body {
        name,
        nodes: mesh.points.len(),
        tets: mesh.tets.len(),
        model: Model::build(mesh, &problem(held, pressed))?,
    })
}

/// The peers' tissue with mass damping.
fn problem(held: &str, pressed: &str) -> Problem {
    Problem {
        damping: Rayleigh {
            mass: 20.0,
            ..Rayleigh::default()
        },
        ..pressed::problem(held, pressed)
    }
}
