//! A body ready to be moved through time.

use std::sync::Arc;

use sinew_core::{
    BlockMatrix, Damping, ElementStiffness, Elements, Energy, EvaluationError, Layers,
    LinearOperators, LinearSystem, LoadTime, Pattern, Revision, Scales, System, Trial,
};
use sinew_mesh::TetMesh;

use crate::assembly::RegionSprings;
use crate::cells::Cells;
use crate::elements::{ElementLaw, Tetrahedra};
use crate::error::{Cause, FemError, Item};
use crate::report::{ModelReport, RegionFacts};
use crate::scales::cell_sizes;
use crate::{Law, Problem, assembly, check, loads, tetra};

/// A linear model of a body: M, D, K over its moving nodes, loads, and the geometry behind them.
#[derive(Clone, Debug)]
pub struct Model {
    operators: LinearOperators,
    cells: Cells,
    node_tags: Vec<u64>,
    tetrahedra: Tetrahedra,
    extent: f64,
    cell_size: Vec<f64>,
    report: ModelReport,
}

impl Model {
    /// Assembles a problem on a mesh.
    ///
    /// # Errors
    /// [`FemError`] with the part of the problem at fault.
    pub fn build(mesh: &TetMesh, problem: &Problem) -> Result<Self, FemError> {
        check::numbers(problem)?;
        let volumes = check::volumes(mesh)?;
        let region_of = check::regions(mesh, problem)?;
        let cells = Cells::new(mesh, &problem.fixed)?;
        let masses = assembly::lumped_masses(mesh, problem, &region_of, &volumes);

        let pattern = pattern(mesh, &cells)?;
        let mut stiffness = BlockMatrix::zeros(Arc::clone(&pattern), Layers::Three);
        let mut networks = Vec::new();
        let mut laws = Vec::with_capacity(problem.regions.len());
        let mut regions = Vec::with_capacity(problem.regions.len());
        for (index, region) in problem.regions.iter().enumerate() {
            let members = || (0..mesh.tets.len()).filter(|tet| region_of[*tet] == index);
            let volume = members().map(|tet| volumes[tet]).sum();
            let network = match region.law {
                Law::Linear {
                    youngs_modulus,
                    poissons_ratio,
                } => {
                    let lame = tetra::lame(youngs_modulus, poissons_ratio);
                    let members: Vec<usize> = members().collect();
                    assembly::add_tetrahedra(&mut stiffness, mesh, &cells, &members, lame)?;
                    laws.push(ElementLaw::Continuum { lame });
                    None
                }
                Law::Springs {
                    youngs_modulus,
                    rule,
                    calibrate,
                    damping_ratio,
                } => {
                    let tets = members().map(|tet| &mesh.tets[tet]);
                    let RegionSprings {
                        springs,
                        modulus,
                        calibration,
                    } = assembly::region_springs(
                        &mesh.points,
                        tets,
                        volume,
                        youngs_modulus,
                        rule,
                        calibrate,
                    );
                    let rates = springs.iter().map(|spring| spring.stiffness);
                    assembly::add_edges(&mut stiffness, mesh, &cells, &springs, rates)?;
                    networks.push((damping_ratio, springs));
                    laws.push(ElementLaw::Springs {
                        youngs_modulus: youngs_modulus * calibration,
                        rule,
                    });
                    Some(modulus)
                }
            };
            regions.push(RegionFacts {
                tets: members().count(),
                volume,
                network,
            });
        }
        let mut dashpots = None;
        if networks.iter().any(|(gamma, _)| *gamma > 0.0) {
            let matrix = dashpots.insert(BlockMatrix::zeros(Arc::clone(&pattern), Layers::Three));
            let (springs, rates) = assembly::dashpots(&networks, &masses);
            assembly::add_edges(matrix, mesh, &cells, &springs, rates)?;
        }
        if cells.partly_held() {
            stiffness.clear_pinned(&cells.pinned);
            if let Some(dashpots) = &mut dashpots {
                dashpots.clear_pinned(&cells.pinned);
            }
        }

        let mut core_loads = Vec::new();
        let mut load_facts = Vec::new();
        for (index, load) in problem.loads.iter().enumerate() {
            let (load, facts) = loads::assemble(mesh, &cells, load, Item::Load(index))?;
            core_loads.push(load);
            load_facts.push(facts);
        }
        let gravity = problem.gravity.map(|gravity| {
            let (load, facts) = loads::gravity(&cells, &masses, gravity);
            core_loads.push(load);
            facts
        });

        let (low, high) = mesh.bounding_box();
        let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let cell_size = cell_sizes(mesh, &cells);

        let damping = Damping {
            mass: problem.damping.mass,
            stiffness: problem.damping.stiffness,
            extra: dashpots.map(Arc::new),
        };
        let damping_matrix = damping.extra.is_some();
        let moving = cells
            .nodes
            .iter()
            .flat_map(|node| [masses[*node as usize]; 3]);
        let operators = LinearOperators::new(moving.collect(), stiffness, damping, core_loads)
            .map_err(|error| FemError::new(Item::Mesh, error.into()))?;

        let report = ModelReport {
            nodes: mesh.points.len(),
            tets: mesh.tets.len(),
            edges: mesh.edges().len(),
            mesh_dofs: 3 * mesh.points.len(),
            held_components: cells.held_components,
            free_dofs: 3 * mesh.points.len() - cells.held_components,
            mass: masses.iter().sum(),
            volume: volumes.iter().sum(),
            regions,
            loads: load_facts,
            gravity,
            blocks: pattern.blocks(),
            damping_matrix,
            notes: mesh.notes.clone(),
        };
        Ok(Self {
            operators,
            cells,
            node_tags: mesh.node_tags.clone(),
            tetrahedra: Tetrahedra::new(mesh, &region_of, laws),
            extent,
            cell_size,
            report,
        })
    }

    /// Mesh node (0-based) of each cell, increasing.
    #[must_use]
    pub fn nodes(&self) -> &[u32] {
        &self.cells.nodes
    }

    /// The cell of a mesh node (0-based); `None` where the node is held in x, y and z.
    #[must_use]
    pub fn cell_of_node(&self, node: u32) -> Option<u32> {
        self.cells.of_node(node)
    }

    /// Which components are held although their cell moves, three a cell.
    #[must_use]
    pub fn pinned(&self) -> &[bool] {
        &self.cells.pinned
    }

    /// What the model turned out to be.
    #[must_use]
    pub fn report(&self) -> &ModelReport {
        &self.report
    }

    /// Displacement of a mesh node (0-based) in a state (m); zero where it is held.
    #[must_use]
    pub fn node_displacement(&self, u: &[f64], node: u32) -> [f64; 3] {
        self.cell_of_node(node).map_or([0.0; 3], |cell| {
            std::array::from_fn(|axis| u[3 * cell as usize + axis])
        })
    }
}

/// Cells are neighbours when a tetrahedron has both.
fn pattern(mesh: &TetMesh, cells: &Cells) -> Result<Arc<Pattern>, FemError> {
    let elements = mesh.tets.iter().map(|tet| {
        let moving = tet.iter().filter_map(|node| cells.of_node(*node));
        moving.collect::<Vec<u32>>()
    });
    Pattern::from_elements(cells.nodes.len(), elements)
        .map(Arc::new)
        .map_err(|error| {
            let cause = Cause::Operators(error.into());
            FemError::new(Item::Mesh, cause)
        })
}

impl System for Model {
    fn dofs(&self) -> usize {
        self.operators.dofs()
    }

    fn mass(&self) -> &[f64] {
        self.operators.mass()
    }

    fn revision(&self) -> Revision {
        self.operators.revision()
    }

    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.operators.net_force(trial.load, trial.u, trial.v, out);
        Ok(())
    }

    fn external_force(&self, when: LoadTime, out: &mut [f64]) {
        self.operators.external_force(when, out);
    }

    fn mass_damping(&self) -> f64 {
        self.operators.damping().mass
    }

    fn energy(&self, u: &[f64], v: &[f64]) -> Option<Energy> {
        Some(self.operators.energy(u, v))
    }

    fn inverted_elements(&self, u: &[f64]) -> Option<usize> {
        let moved = |node: u32| {
            let [x, y, z] = self.tetrahedra.points[node as usize];
            let [ux, uy, uz] = self.node_displacement(u, node);
            [x + ux, y + uy, z + uz]
        };
        // Elements have positive volume at rest; one that is not a number counts as inverted.
        let upright = |tet: &&[u32; 4]| tetra::signed_volume(&tet.map(moved)) > 0.0;
        let tets = &self.tetrahedra.tets;
        Some(tets.len() - tets.iter().filter(upright).count())
    }

    fn extent(&self) -> Option<f64> {
        Some(self.extent)
    }

    fn scales(&self) -> Option<Scales<'_>> {
        Some(Scales {
            cell_size: &self.cell_size,
        })
    }

    fn cell_name(&self, dof: usize) -> String {
        let axis = ["x", "y", "z"][dof % 3];
        let node = self.cells.nodes.get(dof / 3);
        match node.and_then(|node| self.node_tags.get(*node as usize)) {
            Some(tag) => format!("node {tag} ({axis})"),
            None => format!("degree of freedom {dof}"),
        }
    }

    fn as_linear(&self) -> Option<&dyn LinearSystem> {
        Some(self)
    }
}

impl LinearSystem for Model {
    fn operators(&self) -> &LinearOperators {
        &self.operators
    }

    fn elements(&self) -> Option<&dyn Elements> {
        Some(self)
    }
}

impl Elements for Model {
    fn count(&self) -> usize {
        self.tetrahedra.tets.len()
    }

    fn name(&self, element: usize) -> String {
        self.tetrahedra.name(element)
    }

    fn stiffness(&self, element: usize, out: &mut ElementStiffness) {
        self.tetrahedra.stiffness(element, &self.cells, out);
    }
}
