//! Counts and resultants of a model.

use sinew_mesh::TetMesh;

use crate::body::Body;
use crate::springs::NetworkModulus;

/// Resultants of a load at full value: of all of it, and of the part on components that move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadFacts {
    /// Resultant of the load (N).
    pub asked: [f64; 3],
    /// Resultant of the part on components that move (N); the rest goes into the supports.
    pub acting: [f64; 3],
}

/// Counts and resultants of a model, to be read before it is run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelReport {
    /// Nodes of the mesh.
    pub nodes: usize,
    /// Tetrahedra of the mesh.
    pub tets: usize,
    /// Edges of the mesh.
    pub edges: usize,
    /// Degrees of freedom of the mesh, three a node.
    pub mesh_dofs: usize,
    /// Components fixed by supports or moved from outside.
    pub held_components: usize,
    /// Free degrees of freedom.
    pub free_dofs: usize,
    /// Mass of the body (kg), fixed nodes included.
    pub mass: f64,
    /// Volume of the body (m^3).
    pub volume: f64,
    /// Facts of each region, in the order of the problem.
    pub regions: Vec<RegionFacts>,
    /// Facts of each load, in the order of the problem.
    pub loads: Vec<LoadFacts>,
    /// Facts of each prescribed motion, in the order of the problem.
    pub moves: Vec<MoveFacts>,
    /// Weight, if there is gravity.
    pub gravity: Option<LoadFacts>,
    /// Stored blocks of the stiffness matrix.
    pub blocks: usize,
    /// True if damping needs a matrix of its own.
    pub damping_matrix: bool,
    /// Changes made to the mesh when it was read, in sentences.
    pub notes: Vec<String>,
}

impl ModelReport {
    /// The part that materials and loads do not change.
    pub(crate) fn of_body(mesh: &TetMesh, body: &Body) -> Self {
        let mut report = Self {
            notes: mesh.notes.clone(),
            ..Self::default()
        };
        report.count(mesh, body);
        report
    }

    /// Counts nodes, edges, degrees of freedom and blocks.
    pub(crate) fn count(&mut self, mesh: &TetMesh, body: &Body) {
        self.nodes = mesh.points.len();
        self.tets = mesh.tets.len();
        self.edges = body.edges;
        self.mesh_dofs = 3 * self.nodes;
        self.held_components = body.cells.held_components;
        self.free_dofs = self.mesh_dofs - self.held_components;
        self.blocks = body.pattern.blocks();
    }
}

/// Facts of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionFacts {
    /// Number of tetrahedra.
    pub tets: usize,
    /// Volume (m^3).
    pub volume: f64,
    /// The least and the largest Young's modulus (Pa) that the law was given.
    pub youngs_modulus: [f64; 2],
    /// Its mean (Pa) by volume.
    pub mean_youngs_modulus: f64,
    /// The least and the largest density (kg/m^3).
    pub density: [f64; 2],
    /// Number of patches over which it averages changes of volume.
    pub patches: usize,
    /// Moduli of its springs as a material, calibration included; `None` for continua.
    pub network: Option<NetworkModulus>,
}

/// Facts of a prescribed motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MoveFacts {
    /// Number of nodes.
    pub nodes: usize,
    /// The first instant (s) at which the position jumps.
    pub jump: Option<f64>,
    /// Loads, by their places in the problem, that fall on components it moves: these only change its
    /// reaction.
    pub loads: Vec<usize>,
}
