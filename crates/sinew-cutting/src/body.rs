//! A body that can be cut.

use std::collections::HashMap;

use sinew_mesh::{CutBody, CutMesh, TetMesh};

use crate::around::Around;
use crate::error::CutError;
use crate::incidence::Incidence;
use crate::marks::Marks;
use crate::near::NearNodes;
use crate::passed::Passed;
use crate::properties::TetProperties;
use crate::report::{Removal, Stroke};
use crate::seen::SeenNodes;
use crate::tet::{EDGES, FACES};

use sinew_mesh::vector::{Vector, bounds_of, length, sub};

/// Marks the absence of a tetrahedron.
pub(crate) const NONE: u32 = u32::MAX;

/// A body of tetrahedra whose faces can be split and whose tetrahedra can be removed.
///
/// Tetrahedra keep their numbers, and nodes theirs; copies of nodes are appended. Space for [`spare_nodes`] of them is
/// reserved at the beginning: until it is used up, strokes allocate nothing.
pub struct CuttableBody {
    pub(crate) properties: Box<dyn TetProperties>,
    /// Rest positions of the mesh's own nodes, as given by the mesh.
    pub(crate) first_places: Vec<Vector>,
    /// Shortest edge at each node of the mesh.
    pub(crate) edge_at: Vec<f64>,
    pub(crate) longest_edge: f64,
    /// The largest frequency of a tetrahedron of the mesh (1/s).
    pub(crate) largest_frequency: f64,
    /// Positions at rest.
    pub(crate) points: Vec<Vector>,
    /// Node of the mesh for each node: the node itself, or the original of a copy.
    pub(crate) origins: Vec<u32>,
    /// One flag per node: true if it must not be moved at rest, because it is on a cut face, at a removed tetrahedron,
    /// or was fixed on request.
    pub(crate) is_kept: Vec<bool>,
    /// Nodes, increasing, whose rest positions are temporarily fixed.
    pub(crate) held: Vec<u32>,
    /// The node that each one was copied from since this body was created or read back; itself if it is not a copy made
    /// since then.
    pub(crate) copied_from: Vec<u32>,
    pub(crate) tets: Vec<[u32; 4]>,
    pub(crate) is_removed: Vec<bool>,
    /// The tetrahedron on the other side of the face opposite each vertex.
    pub(crate) neighbours: Vec<[u32; 4]>,
    pub(crate) incidence: Incidence,
    pub(crate) marks: Marks,
    pub(crate) stroke: Stroke,
    pub(crate) removal: Removal,
    pub(crate) room: Room,
    pub(crate) near: NearNodes,
    pub(crate) around: Around,
}

/// Buffers that strokes reuse.
#[derive(Default)]
pub(crate) struct Room {
    /// The last search in which each tetrahedron was seen.
    pub(crate) seen: Vec<u32>,
    pub(crate) look: u32,
    /// Tetrahedra that are still to be checked.
    pub(crate) queue: Vec<u32>,
    pub(crate) touched: Vec<(u32, Passed)>,
    /// Nodes that the blade has passed in this search.
    pub(crate) passed: Vec<u32>,
    /// Other tetrahedra at these nodes.
    pub(crate) left: Vec<u32>,
    /// The last search in which each tetrahedron at such a node was listed.
    pub(crate) listed_in: Vec<u32>,
    pub(crate) nodes: SeenNodes,
    /// Nodes that may be moved, with their distance from the sheet relative to their shortest edge.
    pub(crate) near: Vec<(f64, u32)>,
    /// Nodes of faces that were cut, each once.
    pub(crate) corners: Vec<u32>,
    /// One flag per node: true if it is listed.
    pub(crate) is_listed: Vec<bool>,
    /// Group of each tetrahedron at the current node.
    pub(crate) group_of: Vec<u32>,
}

impl Room {
    /// Starts a search in a body of `nodes` nodes.
    pub(crate) fn start_look(&mut self, nodes: usize) {
        self.look = self.look.wrapping_add(1);
        self.touched.clear();
        self.passed.clear();
        self.queue.clear();
        self.nodes.start(nodes);
    }

    /// Queues a tetrahedron that this search has not seen yet.
    pub(crate) fn see(&mut self, tet: u32) {
        let seen = &mut self.seen[tet as usize];
        if *seen != self.look {
            *seen = self.look;
            self.queue.push(tet);
        }
    }

    /// Lists a corner of a face that was cut, unless it is listed already.
    pub(crate) fn list_corner(&mut self, node: u32) {
        if !std::mem::replace(&mut self.is_listed[node as usize], true) {
            self.corners.push(node);
        }
    }
}

/// Number of copies of nodes for which space is reserved in advance, in all arrays over the nodes of a body: a tenth of
/// the nodes, and a few for small bodies.
#[must_use]
pub fn spare_nodes(nodes: usize) -> usize {
    nodes / 10 + 16
}

impl CuttableBody {
    /// The body of a mesh, uncut.
    ///
    /// # Errors
    /// [`CutError`] if a face has more than two tetrahedra, or a tetrahedron names a node twice.
    pub fn new(mesh: &TetMesh, properties: Box<dyn TetProperties>) -> Result<Self, CutError> {
        let (nodes, tets) = (mesh.points.len(), mesh.tets.len());
        let spare = spare_nodes(nodes);
        let mut edge_at = vec![f64::INFINITY; nodes];
        let (mut longest_edge, mut largest_frequency) = (0.0_f64, 0.0_f64);
        for (tet, corners) in mesh.tets.iter().enumerate() {
            let vertices = corners.map(|node| mesh.points[node as usize]);
            for [i, j] in EDGES {
                if corners[i] == corners[j] {
                    return Err(CutError::Collapsed { tet });
                }
                let edge = length(sub(vertices[i], vertices[j]));
                longest_edge = longest_edge.max(edge);
                for end in [corners[i], corners[j]] {
                    let shortest = &mut edge_at[end as usize];
                    *shortest = shortest.min(edge);
                }
            }
            largest_frequency = largest_frequency.max(properties.frequency(tet, &vertices));
        }
        let mut points = Vec::with_capacity(nodes + spare);
        points.extend_from_slice(&mesh.points);
        let itself = || {
            let mut itself = Vec::with_capacity(nodes + spare);
            itself.extend(0..nodes as u32);
            itself
        };
        let none = || {
            let mut none = Vec::with_capacity(nodes + spare);
            none.resize(nodes, false);
            none
        };
        Ok(Self {
            properties,
            first_places: mesh.points.clone(),
            edge_at,
            longest_edge,
            largest_frequency,
            points,
            origins: itself(),
            is_kept: none(),
            held: Vec::new(),
            copied_from: itself(),
            tets: mesh.tets.clone(),
            is_removed: vec![false; tets],
            neighbours: neighbours(&mesh.tets)?,
            incidence: Incidence::new(nodes, &mesh.tets, spare),
            marks: Marks::new(nodes, tets, spare),
            stroke: Stroke::with_room(spare),
            removal: Removal::default(),
            room: Room {
                seen: vec![0; tets],
                group_of: vec![0; tets],
                queue: Vec::with_capacity(tets),
                touched: Vec::with_capacity(tets),
                passed: Vec::with_capacity(nodes + spare),
                left: Vec::with_capacity(tets),
                listed_in: vec![0; tets],
                nodes: SeenNodes::with_room(nodes + spare),
                near: Vec::with_capacity(nodes + spare),
                corners: Vec::with_capacity(nodes + spare),
                is_listed: none(),
                look: 0,
            },
            near: NearNodes::with_room(nodes + spare),
            around: Around::with_room(nodes + spare, tets),
        })
    }

    /// Fixes the rest positions of nodes, such as those of supports or between regions.
    pub fn keep(&mut self, nodes: &[u32]) {
        for node in nodes {
            self.is_kept[*node as usize] = true;
        }
    }

    /// Fixes the rest positions of these nodes, in addition to those of [`CuttableBody::keep`], until the next call:
    /// the nodes that a tool grasps.
    pub fn hold(&mut self, nodes: impl IntoIterator<Item = u32>) {
        self.held.clear();
        self.held.extend(nodes);
        self.held.sort_unstable();
    }

    /// Number of nodes, including copies and nodes without remaining tetrahedra.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.points.len()
    }

    /// Positions of the nodes at rest (m).
    #[must_use]
    pub fn points(&self) -> &[[f64; 3]] {
        &self.points
    }

    /// The nodes of each tetrahedron, removed ones included.
    #[must_use]
    pub fn tets(&self) -> &[[u32; 4]] {
        &self.tets
    }

    /// One flag per tetrahedron: true if it was removed.
    #[must_use]
    pub fn is_removed(&self) -> &[bool] {
        &self.is_removed
    }

    /// Node of the mesh for each node: the node itself, or the original of a copy.
    #[must_use]
    pub fn origins(&self) -> &[u32] {
        &self.origins
    }

    /// The original of a node; the node itself if this body has not made it as a copy.
    #[must_use]
    pub fn copied_from(&self, node: u32) -> u32 {
        self.copied_from[node as usize]
    }

    /// The tetrahedra at a node, increasing.
    #[must_use]
    pub fn tets_at(&self, node: u32) -> &[u32] {
        self.incidence.of(node)
    }

    /// The tetrahedron on the other side of the face opposite a vertex (0 to 3); `None` at the surface and across cuts.
    #[must_use]
    pub fn neighbour(&self, tet: u32, vertex: usize) -> Option<u32> {
        let neighbour = self.neighbours[tet as usize][vertex];
        (neighbour != NONE).then_some(neighbour)
    }

    /// Changes made by the last stroke, or by the last cut of faces.
    #[must_use]
    pub fn last_stroke(&self) -> &Stroke {
        &self.stroke
    }

    /// The current body, in its own numbers.
    #[must_use]
    pub fn as_cut(&self) -> CutBody<'_> {
        CutBody {
            points: &self.points,
            origins: &self.origins,
            tets: &self.tets,
            is_removed: &self.is_removed,
        }
    }

    /// The mesh of the current body, with the groups and the data of the uncut one, which must be the mesh from which
    /// the body was made.
    #[must_use]
    pub fn mesh(&self, uncut: &TetMesh) -> CutMesh {
        uncut.after_cuts(self.as_cut())
    }

    /// Mass of a tetrahedron (kg).
    #[must_use]
    pub fn mass_of(&self, tet: u32) -> f64 {
        self.properties.density(tet as usize) * crate::tet::volume(&self.vertices(tet))
    }

    /// The shortest edge (m) of the mesh.
    #[must_use]
    pub fn shortest_edge(&self) -> f64 {
        self.edge_at.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// True if the last sheet touched any tetrahedron.
    #[must_use]
    pub fn is_touched(&self) -> bool {
        !self.room.touched.is_empty()
    }

    /// True if a blade, a segment between two ends (m), is inside the body when its nodes have these positions (m).
    #[must_use]
    pub fn holds(&self, [from, to]: [[f64; 3]; 2], positions: &[[f64; 3]]) -> bool {
        self.has_among(0..positions.len() as u32, [from, to], positions)
    }

    /// True if a blade is inside the body. These nodes must include all nodes of the body near the blade.
    pub(crate) fn has_among(
        &self,
        nodes: impl Iterator<Item = u32>,
        [from, to]: [Vector; 2],
        positions: &[Vector],
    ) -> bool {
        let is_near = self.is_near(bounds_of([from, to]));
        let near = nodes.filter(|node| is_near(&positions[*node as usize]));
        let mut tets = near.flat_map(|node| self.incidence.of(node));
        tets.any(|tet| {
            let vertices = self.tets[*tet as usize].map(|node| positions[node as usize]);
            crate::tet::is_met(&vertices, [from, to])
        })
    }

    /// The upper bound of the frequency (1/s) of all tetrahedra: the largest one of the mesh.
    #[must_use]
    pub fn largest_frequency(&self) -> f64 {
        self.largest_frequency
    }

    /// The vertices of a tetrahedron at rest.
    pub(crate) fn vertices(&self, tet: u32) -> [Vector; 4] {
        self.tets[tet as usize].map(|node| self.points[node as usize])
    }

    /// Shortest edge that the mesh had at a node.
    pub(crate) fn edge_at(&self, node: u32) -> f64 {
        self.edge_at[self.origins[node as usize] as usize]
    }

    /// Separates the two tetrahedra at a face.
    pub(crate) fn open(&mut self, tet: u32, vertex: usize) {
        let other = std::mem::replace(&mut self.neighbours[tet as usize][vertex], NONE);
        if other != NONE {
            for neighbour in &mut self.neighbours[other as usize] {
                if *neighbour == tet {
                    *neighbour = NONE;
                }
            }
        }
    }

    /// The vertex of a tetrahedron opposite its face with a neighbour.
    pub(crate) fn vertex_towards(&self, tet: u32, neighbour: u32) -> Option<usize> {
        let mut neighbours = self.neighbours[tet as usize].iter();
        neighbours.position(|other| *other == neighbour)
    }

    pub(crate) fn require_positions(&self, positions: &[Vector]) -> Result<(), CutError> {
        let (found, expected) = (positions.len(), self.points.len());
        if found == expected {
            return Ok(());
        }
        Err(CutError::Positions { found, expected })
    }
}

fn neighbours(tets: &[[u32; 4]]) -> Result<Vec<[u32; 4]>, CutError> {
    let mut neighbours = vec![[NONE; 4]; tets.len()];
    // Faces that had one tetrahedron so far; those that have two stay, so that a third is found.
    let mut open: HashMap<[u32; 3], Option<(u32, usize)>> = HashMap::with_capacity(2 * tets.len());
    for (tet, corners) in (0..).zip(tets) {
        for (vertex, face) in FACES.into_iter().enumerate() {
            let mut nodes = face.map(|corner| corners[corner]);
            nodes.sort_unstable();
            match open.get_mut(&nodes) {
                None => {
                    open.insert(nodes, Some((tet, vertex)));
                }
                Some(first) => {
                    let (other, across) = first.take().ok_or(CutError::SharedFace { nodes })?;
                    neighbours[other as usize][across] = tet;
                    neighbours[tet as usize][vertex] = other;
                }
            }
        }
    }
    Ok(neighbours)
}
