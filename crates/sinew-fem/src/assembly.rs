//! Sums over elements.

use sinew_core::BlockMatrix;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::springs::{self, NetworkModulus, Spring};
use crate::{Problem, SpringRule, tetra};

/// Tetrahedra whose matrices are held in memory at a time.
const BATCH: usize = 4096;

/// A quarter of each tetrahedron's mass on each of its nodes (kg).
pub(crate) fn lumped_masses(
    mesh: &TetMesh,
    problem: &Problem,
    region_of: &[usize],
    volumes: &[f64],
) -> Vec<f64> {
    let mut masses = vec![0.0; mesh.points.len()];
    for ((tet, region), volume) in mesh.tets.iter().zip(region_of).zip(volumes) {
        for &node in tet {
            masses[node as usize] += problem.regions[*region].density * volume / 4.0;
        }
    }
    masses
}

/// Adds the stiffness of some tetrahedra. Element matrices may be made by many threads; they are
/// added in order by one, so the sums do not depend on how many.
pub(crate) fn add_tetrahedra(
    stiffness: &mut BlockMatrix,
    mesh: &TetMesh,
    cells: &Cells,
    members: &[usize],
    (lambda, mu): (f64, f64),
) -> Result<(), FemError> {
    let element = |tet: &usize| {
        let vertices = mesh.tets[*tet].map(|node| mesh.points[node as usize]);
        tetra::stiffness(&vertices, lambda, mu)
    };
    for batch in members.chunks(BATCH) {
        #[cfg(feature = "rayon")]
        let matrices: Vec<Option<[f64; 144]>> = {
            use rayon::prelude::*;
            batch.par_iter().map(element).collect()
        };
        #[cfg(not(feature = "rayon"))]
        let matrices: Vec<Option<[f64; 144]>> = batch.iter().map(element).collect();
        for (tet, matrix) in batch.iter().zip(matrices) {
            let Some(matrix) = matrix else {
                let cause = Cause::Flat {
                    tag: mesh.tet_tags[*tet],
                    volume: mesh.volume(*tet),
                    edge: 0.0,
                };
                return Err(FemError::new(Item::Mesh, cause));
            };
            add_moving_part(stiffness, cells, &mesh.tets[*tet], &matrix)?;
        }
    }
    Ok(())
}

/// Adds the rows and columns of those nodes that are cells.
fn add_moving_part(
    stiffness: &mut BlockMatrix,
    cells: &Cells,
    tet: &[u32; 4],
    matrix: &[f64; 144],
) -> Result<(), FemError> {
    for (a, node) in tet.iter().enumerate() {
        let Some(row) = cells.of_node(*node) else {
            continue;
        };
        for (b, node) in tet.iter().enumerate() {
            let Some(column) = cells.of_node(*node) else {
                continue;
            };
            let entry = |k: usize| matrix[(3 * a + k / 3) * 12 + 3 * b + k % 3];
            let block: [f64; 9] = std::array::from_fn(entry);
            add_block(stiffness, row, column, &block)?;
        }
    }
    Ok(())
}

/// The springs of a region.
pub(crate) struct RegionSprings {
    pub(crate) springs: Vec<Spring>,
    /// What they are as a material.
    pub(crate) modulus: NetworkModulus,
    /// What calibration multiplied them by.
    pub(crate) calibration: f64,
}

/// The springs of a region, calibrated if asked.
pub(crate) fn region_springs<'a>(
    points: &[[f64; 3]],
    tets: impl Iterator<Item = &'a [u32; 4]>,
    volume: f64,
    youngs_modulus: f64,
    rule: SpringRule,
    calibrate: bool,
) -> RegionSprings {
    let mut springs = springs::springs(points, tets, youngs_modulus, rule);
    let mut modulus = springs::network_modulus(points, &springs, volume);
    let mut calibration = 1.0;
    if calibrate && modulus.voigt > 0.0 {
        calibration = youngs_modulus / modulus.voigt;
        for spring in &mut springs {
            spring.stiffness *= calibration;
        }
        modulus = NetworkModulus {
            voigt: modulus.voigt * calibration,
            softest: modulus.softest * calibration,
            stiffest: modulus.stiffest * calibration,
        };
    }
    RegionSprings {
        springs,
        modulus,
        calibration,
    }
}

/// The edges of all networks, each given with its gamma, and d = gamma 2 sqrt(k (m_i + m_j)) (N s/m)
/// of each; gamma = 1 damps the pair critically. An edge that networks share is one spring, whose
/// gamma is the mean of theirs by stiffness: cutting a body into regions changes nothing.
pub(crate) fn dashpots(networks: &[(f64, Vec<Spring>)], masses: &[f64]) -> (Vec<Spring>, Vec<f64>) {
    let scaled = |by: fn(f64) -> f64| {
        let parts = networks.iter().flat_map(|(gamma, springs)| {
            let factor = by(*gamma);
            springs.iter().map(move |spring| Spring {
                stiffness: factor * spring.stiffness,
                ..*spring
            })
        });
        springs::summed(parts.collect())
    };
    let (springs, damped) = (scaled(|_| 1.0), scaled(|gamma| gamma));
    let rates = springs.iter().zip(&damped).map(|(spring, damped)| {
        let [a, b] = spring.nodes.map(|node| masses[node as usize]);
        let gamma = damped.stiffness / spring.stiffness;
        gamma * 2.0 * (spring.stiffness * (a + b)).sqrt()
    });
    let rates = rates.collect();
    (springs, rates)
}

/// Adds `rate n n'` to the diagonal blocks of each edge's nodes and subtracts it between them.
pub(crate) fn add_edges(
    matrix: &mut BlockMatrix,
    mesh: &TetMesh,
    cells: &Cells,
    springs: &[Spring],
    rates: impl IntoIterator<Item = f64>,
) -> Result<(), FemError> {
    for (spring, rate) in springs.iter().zip(rates) {
        let (n, _) = springs::direction(&mesh.points, spring.nodes);
        let block: [f64; 9] = std::array::from_fn(|k| rate * n[k / 3] * n[k % 3]);
        let ends = spring.nodes.map(|node| cells.of_node(node));
        for cell in ends.into_iter().flatten() {
            add_block(matrix, cell, cell, &block)?;
        }
        if let [Some(a), Some(b)] = ends {
            let coupling = block.map(|entry| -entry);
            add_block(matrix, a, b, &coupling)?;
            add_block(matrix, b, a, &coupling)?;
        }
    }
    Ok(())
}

fn add_block(
    matrix: &mut BlockMatrix,
    row: u32,
    column: u32,
    block: &[f64; 9],
) -> Result<(), FemError> {
    matrix
        .add_block(row, column, block)
        .map_err(|error| FemError::new(Item::Mesh, Cause::Operators(error.into())))
}
