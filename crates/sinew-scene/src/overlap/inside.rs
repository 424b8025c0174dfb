//! Points of the surface that are in tetrahedra.

use sinew_mesh::TetMesh;
use sinew_tools::vector::{Vector, cross, dot, sub};

use super::grid::{Bounds, Grid, bounds, include, longest, meet};

/// Tolerance for points on a face, as a share of the tetrahedron's volume: within it a point counts as inside.
const ON_FACE: f64 = 1e-9;

/// Comparisons per tetrahedron after which the search ends: far more than any but tangled bodies take.
const COMPARISONS: usize = 200;

/// A point of the surface: a node, or one between nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfacePoint {
    /// Its position (m).
    pub(super) at: Vector,
    /// The nodes between which it lies; some of them may occur twice here.
    pub(super) between: [u32; 3],
}

impl SurfacePoint {
    /// A node at its position (m).
    pub(super) fn node(node: u32, at: Vector) -> Self {
        Self {
            at,
            between: [node; 3],
        }
    }

    /// True if any of its nodes is one of these.
    pub(super) fn is_at(&self, nodes: &[u32]) -> bool {
        self.between.iter().any(|node| nodes.contains(node))
    }
}

/// Tetrahedra at their positions in a state, and a search for points in them.
pub(super) struct Placed<'a> {
    mesh: &'a TetMesh,
    places: &'a [Vector],
    /// The tetrahedra that are searched.
    tets: Vec<u32>,
    /// One flag per node: true if it has an inverted tetrahedron.
    is_crushed: Vec<bool>,
    /// Their mean size (m).
    size: f64,
}

impl<'a> Placed<'a> {
    /// These tetrahedra, with the nodes at these positions (m).
    pub(super) fn new(mesh: &'a TetMesh, places: &'a [Vector], mut tets: Vec<u32>) -> Self {
        let mut is_crushed = vec![false; places.len()];
        let mut size = 0.0;
        tets.retain(|tet| {
            let nodes = mesh.tets[*tet as usize];
            let now = nodes.map(|node| places[node as usize]);
            let stands = volume(&now) * mesh.volume(*tet as usize) > 0.0;
            if stands {
                size += longest(&bounds(&now, 0.0));
            } else {
                nodes
                    .iter()
                    .for_each(|node| is_crushed[*node as usize] = true);
            }
            stands
        });
        Self {
            size: size / tets.len().max(1) as f64,
            mesh,
            places,
            tets,
            is_crushed,
        }
    }

    /// True if any tetrahedron is inverted.
    pub(super) fn has_crushed(&self) -> bool {
        self.is_crushed.contains(&true)
    }

    /// The points, by index, that lie in tetrahedra to which they do not belong, with these tetrahedra.
    ///
    /// Points at inverted tetrahedra count in other parts only: in their own part the cause is crushing, which is
    /// reported separately.
    pub(super) fn find(
        &self,
        points: &[SurfacePoint],
        part_of: impl Fn(u32) -> u32,
    ) -> Vec<(u32, u32)> {
        let boxes: Vec<Bounds> = points.iter().map(|point| [point.at; 2]).collect();
        let mut grid = Grid::default();
        grid.fill(&boxes, self.size);
        let all = boxes.iter().fold(bounds(&[], 0.0), |mut all, [point, _]| {
            include(&mut all, point);
            all
        });
        let (mut found, mut compared) = (Vec::new(), 0);
        for tet in &self.tets {
            if compared > COMPARISONS * self.tets.len() {
                break;
            }
            let nodes = self.mesh.tets[*tet as usize];
            let corners = nodes.map(|node| self.places[node as usize]);
            let around = bounds(&corners, 0.0);
            if !meet(&around, &all) {
                continue;
            }
            compared += grid.visit(&around, &boxes, |number| {
                let point = &points[number as usize];
                let is_own = part_of(nodes[0]) == part_of(point.between[0]);
                let is_crushed = || {
                    let mut between = point.between.iter();
                    between.any(|node| self.is_crushed[*node as usize])
                };
                if !point.is_at(&nodes)
                    && is_within(&corners, point.at)
                    && !(is_own && is_crushed())
                {
                    found.push((number, *tet));
                }
            });
        }
        found
    }
}

/// Six times the volume (m^3) of a tetrahedron, negative if it is inverted.
fn volume([a, b, c, d]: &[Vector; 4]) -> f64 {
    dot(sub(*b, *a), cross(sub(*c, *a), sub(*d, *a)))
}

fn is_within(corners: &[Vector; 4], at: Vector) -> bool {
    let whole = volume(corners);
    (0..4).all(|corner| {
        let mut moved = *corners;
        moved[corner] = at;
        volume(&moved) / whole >= -ON_FACE
    })
}
