//! Sums over elements.

use std::sync::Arc;

use sinew_core::{BlockMatrix, Layers};

use crate::body::Body;
use crate::cells::Cells;
use crate::error::{Cause, FemError, Item};
use crate::material::Material;
use crate::network::{Dashpot, Network, dashpots};
use crate::report::RegionFacts;
use crate::{Problem, Region, springs};

/// Number of tetrahedra whose matrices are in memory at a time.
const BATCH: usize = 4096;

/// The matrices of a body of some materials.
pub(crate) struct Assembled {
    pub(crate) stiffness: BlockMatrix,
    /// Dashpots along springs, as a matrix; `None` where there are none.
    pub(crate) damping: Option<BlockMatrix>,
    /// The dashpots, held ends included.
    pub(crate) dashpots: Vec<Dashpot>,
    /// The material of each region.
    pub(crate) materials: Vec<Material>,
    /// Facts of each region.
    pub(crate) facts: Vec<RegionFacts>,
}

/// Sums up the matrices of a body, whose tetrahedra are in the regions `region_of` and whose nodes
/// have the lumped `masses` (kg).
pub(crate) fn assemble(
    body: &Body,
    problem: &Problem,
    region_of: &[u32],
    masses: &[f64],
) -> Result<Assembled, FemError> {
    let zero = || BlockMatrix::zeros(Arc::clone(&body.pattern), Layers::Three);
    let mut stiffness = zero();
    let mut networks = Vec::new();
    let (mut materials, mut facts) = (Vec::new(), Vec::new());
    for (members, region) in members(problem.regions.len(), region_of)
        .iter()
        .zip(&problem.regions)
    {
        let (material, network) = add_region(&mut stiffness, body, members, region, &mut facts)?;
        materials.push(material);
        networks.extend(network);
    }
    let dashpots = dashpots(&networks, masses);
    let mut damping = None;
    if !dashpots.is_empty() {
        let matrix = damping.insert(zero());
        for Dashpot { nodes, rate } in &dashpots {
            add_edge(matrix, body, *nodes, *rate)?;
        }
    }
    if body.cells.partly_held() {
        stiffness.clear_pinned(&body.cells.pinned);
        if let Some(damping) = &mut damping {
            damping.clear_pinned(&body.cells.pinned);
        }
    }
    Ok(Assembled {
        stiffness,
        damping,
        dashpots,
        materials,
        facts,
    })
}

/// The tetrahedra of each region.
fn members(regions: usize, region_of: &[u32]) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); regions];
    for (tet, region) in (0..).zip(region_of) {
        members[*region as usize].push(tet);
    }
    members
}

fn add_region(
    stiffness: &mut BlockMatrix,
    body: &Body,
    members: &[u32],
    region: &Region,
    facts: &mut Vec<RegionFacts>,
) -> Result<(Material, Option<Network>), FemError> {
    let volume = members.iter().map(|tet| body.volumes[*tet as usize]).sum();
    let (material, network) = Material::new(&region.law, &body.mesh, members, volume);
    match &network {
        Some(network) => {
            for spring in &network.springs {
                add_edge(stiffness, body, spring.nodes, spring.stiffness)?;
            }
        }
        None => add_tetrahedra(stiffness, body, members, &material)?,
    }
    facts.push(RegionFacts {
        tets: members.len(),
        volume,
        network: network.as_ref().map(|network| network.modulus),
    });
    Ok((material, network))
}

/// A quarter of each tetrahedron's mass on each of its nodes (kg).
pub(crate) fn lumped_masses(body: &Body, problem: &Problem, region_of: &[u32]) -> Vec<f64> {
    let mut masses = vec![0.0; body.mesh.points.len()];
    for ((tet, region), volume) in body.mesh.tets.iter().zip(region_of).zip(&body.volumes) {
        for &node in tet {
            let density = problem.regions[*region as usize].density;
            masses[node as usize] += density * volume / 4.0;
        }
    }
    masses
}

/// Adds the stiffness of some tetrahedra. Many threads may compute the element matrices; one adds
/// them in order, so the sums do not depend on the number of threads.
fn add_tetrahedra(
    stiffness: &mut BlockMatrix,
    body: &Body,
    members: &[u32],
    material: &Material,
) -> Result<(), FemError> {
    let mesh = &body.mesh;
    let element = |tet: &u32| material.stiffness(&mesh.points, &mesh.tets[*tet as usize]);
    for batch in members.chunks(BATCH) {
        #[cfg(feature = "rayon")]
        let matrices: Vec<Option<[f64; 144]>> = {
            use rayon::prelude::*;
            batch.par_iter().map(element).collect()
        };
        #[cfg(not(feature = "rayon"))]
        let matrices: Vec<Option<[f64; 144]>> = batch.iter().map(element).collect();
        for (tet, matrix) in batch.iter().map(|tet| *tet as usize).zip(matrices) {
            let Some(matrix) = matrix else {
                let cause = Cause::Flat {
                    tag: mesh.tet_tags[tet],
                    volume: body.volumes[tet],
                    edge: 0.0,
                };
                return Err(FemError::new(Item::Mesh, cause));
            };
            add_moving_part(stiffness, &body.cells, &mesh.tets[tet], &matrix)?;
        }
    }
    Ok(())
}

/// Adds the rows and columns of the nodes that are cells.
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

/// Adds `rate n n'` to the diagonal blocks of an edge's nodes and subtracts it between them.
fn add_edge(
    matrix: &mut BlockMatrix,
    body: &Body,
    nodes: [u32; 2],
    rate: f64,
) -> Result<(), FemError> {
    let block = springs::edge_block(&body.mesh.points, nodes, rate);
    let ends = nodes.map(|node| body.cells.of_node(node));
    for cell in ends.into_iter().flatten() {
        add_block(matrix, cell, cell, &block)?;
    }
    if let [Some(a), Some(b)] = ends {
        let coupling = block.map(|entry| -entry);
        add_block(matrix, a, b, &coupling)?;
        add_block(matrix, b, a, &coupling)?;
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
