//! Sums over elements.

use std::sync::Arc;

use sinew_core::{BlockMatrix, ElementStiffness, Layers};
use sinew_mesh::TetMesh;

use crate::body::Body;
use crate::by_tet::ByTet;
use crate::elements::moving_part;
use crate::error::{Cause, FemError, Item};
use crate::graph::Graph;
use crate::large::LargeDeformation;
use crate::lumped::Lumped;
use crate::material::Material;
use crate::network::{Dashpot, Network, dashpots};
use crate::parts::{Parts, WholePart};
use crate::report::RegionFacts;
use crate::volumes::flat;
use crate::{Problem, springs};

/// The matrices of a body of some materials.
pub(crate) struct Assembled {
    pub(crate) stiffness: BlockMatrix,
    /// Dashpots along springs, as a matrix; `None` without any.
    pub(crate) damping: Option<BlockMatrix>,
    /// The dashpots, fixed ends included.
    pub(crate) dashpots: Vec<Dashpot>,
    /// The material of each region.
    pub(crate) materials: Vec<Material>,
    /// The hyperelastic regions.
    pub(crate) large: Option<LargeDeformation>,
    /// Facts of each region.
    pub(crate) facts: Vec<RegionFacts>,
}

/// Sums up the matrices of a body, whose tetrahedra are in the regions `region_of`.
///
/// The matrices are by far the largest part of a model: `graph` and all lists of springs but one are freed before
/// they are allocated.
pub(crate) fn assemble(
    mesh: &TetMesh,
    body: &Body,
    problem: &Problem,
    mut graph: Graph<'_>,
    (region_of, by_tet): (&[u32], &ByTet),
    lumped: &Lumped,
) -> Result<Assembled, FemError> {
    let members = members(problem.regions.len(), region_of);
    let (mut materials, mut networks, mut facts) = (Vec::new(), Vec::new(), Vec::new());
    for (index, region) in problem.regions.iter().enumerate() {
        let (members, volume) = (&members[index], lumped.volumes[index]);
        let own = by_tet.region(index);
        let part = (members.as_slice(), volume);
        let (material, network) = Material::new(region, own, mesh, &mut graph, part)?;
        let modulus = region.law.youngs_modulus();
        let [_, largest] = own.moduli;
        facts.push(RegionFacts {
            tets: members.len(),
            volume,
            youngs_modulus: own.moduli.map(|factor| factor * modulus),
            mean_youngs_modulus: own.shares.mean(mesh, members) * largest * modulus,
            density: own.densities.map(|factor| factor * region.density),
            patches: body.smoothing.patches_among(members),
            network: network.as_ref().map(|network| network.modulus),
        });
        materials.push(material);
        networks.push(network);
    }
    drop(graph);
    let dashpots = dashpots(&networks, &lumped.masses);
    let mut stiffness = stiffness(mesh, body, &members, &materials, networks)?;
    let parts = Parts {
        mesh,
        smoothing: &body.smoothing,
        region_of,
        materials: &materials,
    };
    add_averages(&mut stiffness, body, parts)?;
    clear_held(&mut stiffness, body);
    let hyperelastic = materials.iter().zip(&facts).zip(&members);
    let hyperelastic = hyperelastic.filter_map(|((material, facts), members)| {
        let [least, _] = facts.density;
        let (law, stated) = material.hyperelastic(least)?;
        Some((law, stated, members.as_slice()))
    });
    let large = LargeDeformation::new(mesh, &body.smoothing, hyperelastic);
    Ok(Assembled {
        stiffness,
        large,
        damping: damping(mesh, body, &dashpots)?,
        dashpots,
        materials,
        facts,
    })
}

/// The tetrahedra of each region.
fn members(regions: usize, region_of: &[u32]) -> Vec<Vec<u32>> {
    let mut counts = vec![0; regions];
    for region in region_of {
        counts[*region as usize] += 1;
    }
    let mut members: Vec<Vec<u32>> = counts.into_iter().map(Vec::with_capacity).collect();
    for (tet, region) in (0..).zip(region_of) {
        members[*region as usize].push(tet);
    }
    members
}

/// K (N/m), of springs in regions that are networks and of single tetrahedra elsewhere. They are added one after
/// another, so the sums do not depend on the number of threads.
fn stiffness(
    mesh: &TetMesh,
    body: &Body,
    members: &[Vec<u32>],
    materials: &[Material],
    networks: Vec<Option<Network>>,
) -> Result<BlockMatrix, FemError> {
    let mut stiffness = BlockMatrix::zeros(Arc::clone(&body.linear_pattern), Layers::Three);
    for ((members, material), network) in members.iter().zip(materials).zip(networks) {
        match network {
            Some(network) => {
                for spring in &network.springs {
                    add_edge(&mut stiffness, mesh, body, spring.nodes, spring.stiffness)?;
                }
            }
            None if material.is_hyperelastic() => {}
            None => add_tetrahedra(&mut stiffness, mesh, body, members, material)?,
        }
    }
    Ok(stiffness)
}

/// The dashpots as a matrix (N s/m); `None` without any.
fn damping(
    mesh: &TetMesh,
    body: &Body,
    dashpots: &[Dashpot],
) -> Result<Option<BlockMatrix>, FemError> {
    if dashpots.is_empty() {
        return Ok(None);
    }
    let mut damping = BlockMatrix::zeros(Arc::clone(&body.linear_pattern), Layers::Three);
    for Dashpot { nodes, rate } in dashpots {
        add_edge(&mut damping, mesh, body, *nodes, *rate)?;
    }
    clear_held(&mut damping, body);
    Ok(Some(damping))
}

/// Clears the rows and columns of fixed components of cells that move.
fn clear_held(matrix: &mut BlockMatrix, body: &Body) {
    if body.cells.partly_held() {
        matrix.clear_pinned(&body.cells.pinned);
    }
}

fn add_tetrahedra(
    stiffness: &mut BlockMatrix,
    mesh: &TetMesh,
    body: &Body,
    members: &[u32],
    material: &Material,
) -> Result<(), FemError> {
    let mut part = ElementStiffness::default();
    for &index in members {
        let tet = &mesh.tets[index as usize];
        let Some(matrix) = material.stiffness(mesh, index as usize) else {
            return Err(flat(mesh, index as usize, 0.0));
        };
        let added = match tet.map(|node| body.cells.of_node(node)) {
            [Some(a), Some(b), Some(c), Some(d)] => stiffness.add_element(&[a, b, c, d], &matrix),
            _ => {
                moving_part(&matrix, tet, &body.cells, &mut part);
                stiffness.add_element(&part.cells, &part.matrix)
            }
        };
        added.map_err(|error| refused(error.into()))?;
    }
    Ok(())
}

/// Adds the stiffness of edges and patches over which tetrahedra average their strain.
fn add_averages(
    stiffness: &mut BlockMatrix,
    body: &Body,
    parts: Parts<'_>,
) -> Result<(), FemError> {
    let (mut whole, mut moving) = (WholePart::default(), ElementStiffness::default());
    for part in parts
        .averages()
        .filter(|part| !parts.is_hyperelastic(*part))
    {
        parts.whole(part, &mut whole);
        whole.moving(&body.cells, &mut moving);
        let added = stiffness.add_element(&moving.cells, &moving.matrix);
        added.map_err(|error| refused(error.into()))?;
    }
    Ok(())
}

/// Adds `rate n n'` to the diagonal blocks of an edge's nodes and subtracts it between them.
fn add_edge(
    matrix: &mut BlockMatrix,
    mesh: &TetMesh,
    body: &Body,
    nodes: [u32; 2],
    rate: f64,
) -> Result<(), FemError> {
    let block = springs::edge_block(&mesh.points, nodes, rate);
    let mut add = |row, column, block: &[f64; 9]| {
        let added = matrix.add_block(row, column, block);
        added.map_err(|error| refused(error.into()))
    };
    let ends = nodes.map(|node| body.cells.of_node(node));
    for cell in ends.into_iter().flatten() {
        add(cell, cell, &block)?;
    }
    if let [Some(a), Some(b)] = ends {
        let coupling = block.map(|entry| -entry);
        add(a, b, &coupling)?;
        add(b, a, &coupling)?;
    }
    Ok(())
}

fn refused(error: sinew_core::OperatorError) -> FemError {
    FemError::new(Item::Mesh, Cause::Operators(error))
}
