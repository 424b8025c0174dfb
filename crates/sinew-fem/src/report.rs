//! What a model turned out to be.

use crate::loads::LoadFacts;
use crate::springs::NetworkModulus;

/// What a model turned out to be, for people who ask what they are about to run.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelReport {
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Tetrahedra of the mesh.
    pub tets: usize,
    /// Edges of the mesh.
    pub edges: usize,
    /// Degrees of freedom of the mesh, three a node.
    pub mesh_dofs: usize,
    /// Components held by supports.
    pub held_components: usize,
    /// Degrees of freedom that move.
    pub free_dofs: usize,
    /// Mass of the body (kg), held nodes included.
    pub mass: f64,
    /// Volume of the body (m^3).
    pub volume: f64,
    /// Facts of each region, in the order of the problem.
    pub regions: Vec<RegionFacts>,
    /// Facts of each load, in the order of the problem.
    pub loads: Vec<LoadFacts>,
    /// Weight, where there is gravity.
    pub gravity: Option<LoadFacts>,
    /// Stored blocks of the stiffness matrix.
    pub blocks: usize,
    /// Whether damping needs a matrix of its own.
    pub damping_matrix: bool,
    /// What happened to the mesh on the way.
    pub notes: Vec<String>,
}

/// Facts of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionFacts {
    /// Tetrahedra.
    pub tets: usize,
    /// Volume (m^3).
    pub volume: f64,
    /// What its springs are as a material, calibration included; `None` for continua.
    pub network: Option<NetworkModulus>,
}
