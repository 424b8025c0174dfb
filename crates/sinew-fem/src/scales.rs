//! Sizes by which velocities are judged.

use sinew_core::Load;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::report::RegionFacts;
use crate::springs::{EDGES, direction};
use crate::{Law, LoadKind, LoadSpec, Problem, Region, tetra};

/// What [`sinew_core::Scales`] shows.
#[derive(Clone, Debug)]
pub(crate) struct OwnedScales {
    pub(crate) cell_size: Vec<f64>,
    pub(crate) impedance: f64,
    pub(crate) pressure: f64,
}

impl OwnedScales {
    pub(crate) fn new(
        mesh: &TetMesh,
        cells: &Cells,
        problem: &Problem,
        regions: &[RegionFacts],
        loads: &[Load],
        extent: f64,
    ) -> Self {
        let cell_size = cell_sizes(mesh, cells);
        let covered = problem.regions.iter().zip(regions);
        let covered = covered.filter(|(_, facts)| facts.tets > 0);
        let impedance = covered
            .map(|(region, facts)| impedance(region, facts))
            .fold(f64::INFINITY, f64::min);
        let acting = problem.loads.iter().zip(loads);
        let applied: f64 = acting
            .map(|(spec, load)| spec.ramp.largest() * pressure(spec, load, &cell_size))
            .sum();
        let densities = problem.regions.iter().map(|region| region.density);
        let densest = densities.fold(0.0, f64::max);
        // Gravity presses like the column of tissue above.
        let weight = problem.gravity.map_or(0.0, |g| densest * norm(g) * extent);
        Self {
            cell_size,
            impedance,
            pressure: applied + weight,
        }
    }
}

/// The shortest edge at each cell (m).
fn cell_sizes(mesh: &TetMesh, cells: &Cells) -> Vec<f64> {
    let mut sizes = vec![f64::INFINITY; cells.nodes.len()];
    let edges = mesh
        .tets
        .iter()
        .flat_map(|tet| EDGES.map(|edge| edge.map(|vertex| tet[vertex])));
    for edge in edges {
        let (_, length) = direction(&mesh.points, edge);
        for cell in edge.into_iter().filter_map(|node| cells.of_node(node)) {
            let size = &mut sizes[cell as usize];
            *size = size.min(length);
        }
    }
    sizes
}

/// `rho c`, c being the speed of pressure waves, `rho c_p^2 = lambda + 2 mu`, but at most sqrt 3 times that
/// of shear waves, `rho c_s^2 = mu`, which is their ratio at nu = 1/4. What is nearly
/// incompressible yields in shear, although its pressure waves are fast without limit.
fn impedance(region: &Region, facts: &RegionFacts) -> f64 {
    let (youngs_modulus, poissons_ratio) = match (region.law, &facts.network) {
        (
            Law::Linear {
                youngs_modulus,
                poissons_ratio,
            },
            _,
        ) => (youngs_modulus, poissons_ratio),
        (Law::Springs { .. }, Some(network)) => (network.voigt, 0.25),
        (Law::Springs { youngs_modulus, .. }, None) => (youngs_modulus, 0.25),
    };
    let (lambda, mu) = tetra::lame(youngs_modulus, poissons_ratio);
    (region.density * (lambda + 2.0 * mu).min(3.0 * mu)).sqrt()
}

/// The largest pressure of a load at full value (Pa). A force on nodes presses on a square of the
/// cell's size.
fn pressure(spec: &LoadSpec, load: &Load, cell_size: &[f64]) -> f64 {
    match spec.kind {
        LoadKind::Traction(traction) => norm(traction),
        LoadKind::Pressure(pressure) => pressure.abs(),
        LoadKind::Force(_) => {
            // The entries of a cell follow each other.
            let cells = load.entries.chunk_by(|a, b| a.0 / 3 == b.0 / 3);
            let pressures = cells.map(|entries| {
                let force = entries.iter().map(|(_, force)| force * force).sum::<f64>();
                entries.first().map_or(0.0, |(dof, _)| {
                    force.sqrt() / cell_size[*dof as usize / 3].powi(2)
                })
            });
            pressures.fold(0.0, f64::max)
        }
    }
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
