//! The parts that K is a sum of: tetrahedra, and the edges and patches over which they average strain.

use sinew_core::ElementStiffness;
use sinew_core::vectors::dot;
use sinew_mesh::TetMesh;

use crate::cells::Cells;
use crate::elements::moving_part;
use crate::material::Material;
use crate::smoothing::{Average, Smoothing, nodes_of};

/// The parts of a body: all tetrahedra of the mesh, then edges, then patches.
#[derive(Clone, Copy)]
pub(crate) struct Parts<'a> {
    pub(crate) mesh: &'a TetMesh,
    pub(crate) smoothing: &'a Smoothing,
    pub(crate) region_of: &'a [u32],
    pub(crate) materials: &'a [Material],
}

/// A part, as its number encodes it.
#[derive(Clone, Copy)]
enum Part {
    Tet(usize),
    Edge(usize),
    Patch(usize),
}

impl<'a> Parts<'a> {
    /// Number of parts.
    pub(crate) fn count(&self) -> usize {
        let Smoothing { edges, patches, .. } = self.smoothing;
        self.mesh.tets.len() + edges.tets.count() + patches.count()
    }

    /// The numbers of all edges and patches.
    pub(crate) fn averages(&self) -> std::ops::Range<usize> {
        self.mesh.tets.len()..self.count()
    }

    fn part(&self, number: usize) -> Part {
        let (tets, edges) = (self.mesh.tets.len(), self.smoothing.edges.tets.count());
        if number < tets {
            Part::Tet(number)
        } else if number < tets + edges {
            Part::Edge(number - tets)
        } else {
            Part::Patch(number - tets - edges)
        }
    }

    /// The tetrahedra of an edge or a patch.
    fn members(&self, part: Part) -> &'a [u32] {
        match part {
            Part::Tet(_) => &[],
            Part::Edge(edge) => self.smoothing.edges.tets.of(edge),
            Part::Patch(patch) => self.smoothing.patches.of(patch),
        }
    }

    /// The name of a part in the user's terms.
    pub(crate) fn name(&self, number: usize) -> String {
        let mesh = self.mesh;
        let tet_name = |tet: usize| match mesh.tet_tags.get(tet) {
            Some(tag) => format!("tetrahedron {tag}"),
            None => format!("tetrahedron number {tet}"),
        };
        let part = self.part(number);
        match (part, self.members(part)) {
            (Part::Tet(tet), _) => tet_name(tet),
            (Part::Edge(edge), _) => {
                let ends = self.smoothing.edges.nodes[edge];
                let tag = |node: u32| mesh.node_tags.get(node as usize).copied();
                let [a, b] = ends.map(|node| tag(node).unwrap_or(u64::from(node)));
                format!("the edge between nodes {a} and {b}")
            }
            (Part::Patch(_), members) => {
                let first = members.first().map_or(0, |tet| *tet as usize);
                format!(
                    "the patch of {} tetrahedra from {} on",
                    members.len(),
                    tet_name(first)
                )
            }
        }
    }

    /// True if a part belongs to a hyperelastic region, whose matrix is that at rest and is part of no sum.
    pub(crate) fn is_hyperelastic(&self, number: usize) -> bool {
        let part = self.part(number);
        let tet = match part {
            Part::Tet(tet) => Some(tet),
            Part::Edge(_) | Part::Patch(_) => self.members(part).first().map(|tet| *tet as usize),
        };
        tet.is_some_and(|tet| self.materials[self.region_of[tet] as usize].is_hyperelastic())
    }

    /// Writes the mesh nodes of a part.
    pub(crate) fn nodes(&self, number: usize, out: &mut Vec<u32>) {
        match self.part(number) {
            Part::Tet(tet) => {
                out.clear();
                out.extend(self.mesh.tets[tet]);
            }
            part => nodes_of(self.mesh, self.members(part), out),
        }
    }

    /// Writes the rows and columns of a part's stiffness of those nodes that are cells; fixed components are zero.
    pub(crate) fn moving(&self, number: usize, cells: &Cells, out: &mut ElementStiffness) {
        if let Part::Tet(tet) = self.part(number) {
            moving_part(&self.of_tet(tet), &self.mesh.tets[tet], cells, out);
            return;
        }
        let mut whole = WholePart::default();
        self.whole(number, &mut whole);
        whole.moving(cells, out);
    }

    /// The stiffness of a tetrahedron by its own strain; zero if it is flat.
    fn of_tet(&self, tet: usize) -> [f64; 144] {
        let material = &self.materials[self.region_of[tet] as usize];
        let matrix = material.stiffness(self.mesh, tet);
        matrix.unwrap_or([0.0; 144])
    }

    /// Writes the stiffness of a part between all its nodes, fixed ones included; zero if a tetrahedron is flat.
    pub(crate) fn whole(&self, number: usize, out: &mut WholePart) {
        let part = self.part(number);
        let WholePart {
            average, stiffness, ..
        } = out;
        let members = self.members(part);
        let material = |tet: usize| &self.materials[self.region_of[tet] as usize];
        let (moduli, share) = match (part, members.first()) {
            (Part::Edge(_), Some(first)) => {
                let material = material(*first as usize);
                (material.averaged_over_edge(self.mesh, members), 1.0 / 6.0)
            }
            (Part::Patch(_), Some(first)) => {
                let material = material(*first as usize);
                (material.averaged_over_patch(self.mesh, members), 1.0)
            }
            (Part::Tet(tet), _) => {
                average.nodes.clear();
                average.nodes.extend(&self.mesh.tets[tet]);
                stiffness.clear();
                stiffness.extend(self.of_tet(tet));
                return;
            }
            (Part::Edge(_) | Part::Patch(_), None) => ([0.0; 2], 0.0),
        };
        average.over(self.mesh, members);
        average.stiffness(share, moduli, stiffness);
        if let (Part::Edge(_), Some(first)) = (part, members.first()) {
            let material = material(*first as usize);
            material.add_anisotropy_of_edge(self.mesh, members, (average, share), stiffness);
        }
    }
}

/// The stiffness of a part between all its nodes, and scratch space to compute it.
#[derive(Clone, Debug, Default)]
pub(crate) struct WholePart {
    average: Average,
    /// Entries (N/m), row-major and node-major.
    stiffness: Vec<f64>,
    /// Displacements (m) of its nodes.
    u: Vec<f64>,
}

impl WholePart {
    /// Mesh nodes of the rows.
    pub(crate) fn nodes(&self) -> &[u32] {
        &self.average.nodes
    }

    /// The block between two of its nodes, by their places.
    pub(crate) fn block(&self, row: usize, column: usize) -> [f64; 9] {
        let columns = 3 * self.nodes().len();
        std::array::from_fn(|k| self.stiffness[(3 * row + k / 3) * columns + 3 * column + k % 3])
    }

    /// The elastic energy (J) with this displacement (m) of each node of the mesh.
    pub(crate) fn energy(&mut self, displacement: &[[f64; 3]]) -> f64 {
        let Self {
            average,
            stiffness,
            u,
        } = self;
        u.clear();
        u.extend(
            average
                .nodes
                .iter()
                .flat_map(|node| displacement[*node as usize]),
        );
        let rows = stiffness.chunks_exact(u.len()).zip(u.iter());
        let twice: f64 = rows.map(|(row, u_i)| u_i * dot(row, u)).sum();
        0.5 * twice
    }

    /// Writes the rows and columns of those nodes that are cells; fixed components are zero.
    pub(crate) fn moving(&self, cells: &Cells, out: &mut ElementStiffness) {
        moving_part(&self.stiffness, self.nodes(), cells, out);
    }
}
