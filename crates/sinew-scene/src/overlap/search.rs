//! The search for the surface point that is deepest in the body.

use std::sync::{Arc, OnceLock};

use sinew_mesh::TetMesh;
use sinew_tools::vector::{Vector, between, length, sub};

use super::depth::{Depths, FACES, distance};
use super::grid::{Bounds, bounds, include, longest, meet};
use super::inside::{Placed, SurfacePoint};
use super::near::{NearPairs, Surface};
use super::segment::crossing;

/// Share of a body's size, or of its largest displacement if that is more, up to which surfaces count as touching:
/// single precision rounds positions by less.
const TOUCHES: f64 = 1e-6;

/// Largest number of tetrahedra that are checked to measure depths, as a multiple of their number, or of 1000.
const LOOKS: usize = 20;

/// A point of the surface that is inside a tetrahedron to which it does not belong.
#[derive(Debug, Clone, Copy)]
pub(super) struct Inside {
    /// The distance (m) from the surface around the tetrahedron.
    pub(super) depth: f64,
    pub(super) at: Vector,
    /// The node at the point, or the one next to it.
    pub(super) node: u32,
    pub(super) tet: u32,
}

/// Topology and buffers for the overlap check of a body in one state after another.
pub(super) struct OverlapSearch {
    mesh: Arc<TetMesh>,
    surface: Surface,
    near: NearPairs,
    /// The triangles with their nodes in ascending order, sorted; made when a point was first found inside.
    faces: OnceLock<Vec<[u32; 3]>>,
    nodes: Vec<u32>,
    /// The nodes that edges join to each node of the surface, one after the other, and where those of a node begin.
    joined: Vec<u32>,
    joined_from: Vec<u32>,
    /// The part of each node, and their number.
    part_of: Vec<u32>,
    parts: usize,
    /// The largest extent (m) of the body at rest.
    size: f64,
    /// Tolerance for points in tetrahedra at cut faces; `None` if cut faces are treated as any other surface.
    lips: Option<Lips>,
    /// Data for depths; made when a point was first found inside.
    depths: Option<Depths>,
}

/// Cut faces between which contact acts, node by node.
pub(super) struct Lips {
    /// One flag per node: true if cuts duplicated it, so that other nodes have the same origin.
    pub(super) is_copied: Vec<bool>,
    /// Share of an edge by which surfaces between their nodes may overlap.
    pub(super) share: f64,
}

impl OverlapSearch {
    /// A search in a mesh with this surface, whose nodes are copies of these.
    pub(super) fn new(
        mesh: Arc<TetMesh>,
        triangles: Vec<[u32; 3]>,
        origins: Vec<u32>,
        lips: Option<Lips>,
    ) -> Self {
        let surface = Surface::new(triangles, origins);
        let mut is_outer = vec![false; mesh.points.len()];
        for node in surface.triangles.as_flattened() {
            is_outer[*node as usize] = true;
        }
        let nodes = (0..).zip(&is_outer);
        let nodes = nodes.filter(|(_, is_outer)| **is_outer);
        let nodes = nodes.map(|(node, _)| node).collect();
        let (part_of, parts) = mesh.part_of_nodes();
        let (joined, joined_from) = joined(&surface.edges, mesh.points.len());
        Self {
            joined,
            joined_from,
            size: longest(&bounds(&mesh.points, 0.0)),
            mesh,
            surface,
            near: NearPairs::default(),
            faces: OnceLock::new(),
            nodes,
            part_of,
            parts,
            lips,
            depths: None,
        }
    }

    /// The deepest point for nodes at these positions (m); `None` if no surface is in a part, and for a state that is
    /// not finite.
    pub(super) fn deepest(&mut self, places: &[Vector]) -> Option<Inside> {
        self.deepest_of_nodes(places, false)
    }

    /// Same as [`OverlapSearch::deepest`]; `all` is true to look at all nodes of a part that is near anything.
    fn deepest_of_nodes(&mut self, places: &[Vector], all: bool) -> Option<Inside> {
        let points = self.mesh.points.iter();
        let moved = points.zip(places).map(|(rest, place)| {
            let way = sub(*place, *rest).map(f64::abs);
            way.into_iter().fold(0.0, |most, along| {
                if along > most || along.is_nan() {
                    along
                } else {
                    most
                }
            })
        });
        let moved = moved.fold(0.0, |most, way| {
            if way > most || way.is_nan() {
                way
            } else {
                most
            }
        });
        if !moved.is_finite() {
            return None;
        }
        let touching = TOUCHES * self.size.max(moved);
        let near = self.near.find(&self.surface, places, touching)?;
        let nested = self.nested(places);
        let mut is_concerned = nested.clone();
        for node in self.nodes_at(&near) {
            is_concerned[self.part_of[node as usize] as usize] = true;
        }
        if !is_concerned.contains(&true) {
            return None;
        }
        let part_of = |node: u32| self.part_of[node as usize];
        let tets = (0..).zip(&self.mesh.tets);
        let tets = tets.filter(|(_, nodes)| is_concerned[part_of(nodes[0]) as usize]);
        let mesh = Arc::clone(&self.mesh);
        let placed = Placed::new(&mesh, places, tets.map(|(tet, _)| tet).collect());
        // What is inside begins where surfaces meet, or is all of a part: from there on neighbours are looked at. Through
        // crushed tissue no way leads.
        let is_all = |node: u32| match all || placed.has_crushed() {
            true => is_concerned[part_of(node) as usize],
            false => nested[part_of(node) as usize],
        };
        let within = self.nodes.iter().copied();
        let within = within.filter(|node| is_all(*node));
        let mut front: Vec<u32> = self.nodes_at(&near).chain(within).collect();
        let mut is_seen = vec![false; places.len()];
        let (mut at_nodes, mut in_tets) = (Vec::new(), Vec::new());
        while !front.is_empty() {
            front.retain(|node| !std::mem::replace(&mut is_seen[*node as usize], true));
            let points = front
                .iter()
                .map(|node| SurfacePoint::node(*node, places[*node as usize]));
            let points: Vec<SurfacePoint> = points.collect();
            let found = placed.find(&points, part_of);
            front.clear();
            for (number, tet) in found {
                let point = points[number as usize];
                in_tets.push((at_nodes.len() as u32, tet));
                at_nodes.push(point);
                front.extend(self.joined_to(point.between[0]));
            }
        }
        let deepest = self.deepest_of(places, &at_nodes, in_tets, touching);
        if deepest.is_some() {
            return deepest;
        }
        let part_of = |node: u32| self.part_of[node as usize];
        let between = self.between_nodes(places, &near, touching, |node| is_seen[node as usize]);
        let found = placed.find(&between, part_of);
        self.deepest_of(places, &between, found, touching)
    }

    /// The nodes of edges and triangles that are near each other.
    fn nodes_at<'a>(&'a self, near: &'a [[u32; 2]]) -> impl Iterator<Item = u32> + 'a {
        near.iter().flat_map(|[edge, triangle]| {
            let edge = self.surface.edges[*edge as usize].into_iter();
            edge.chain(self.surface.triangles[*triangle as usize])
        })
    }

    /// The nodes that edges of the surface join to one of its nodes.
    fn joined_to(&self, node: u32) -> &[u32] {
        let from = &self.joined_from[node as usize..];
        &self.joined[from[0] as usize..from[1] as usize]
    }

    /// A tetrahedron at the node of a point inside, and the one that contains the point, each with its part.
    pub(super) fn tets_of(&self, inside: &Inside) -> [(u32, u32); 2] {
        let tets = &self.mesh.tets;
        let own = (0..)
            .zip(tets)
            .find(|(_, nodes)| nodes.contains(&inside.node));
        let own = own.map_or(inside.tet, |(tet, _)| tet);
        [own, inside.tet].map(|tet| (tet, self.part_of[tets[tet as usize][0] as usize]))
    }

    /// True if a face belongs to the surface.
    fn is_outer(&self, face: [u32; 3]) -> bool {
        let mut face = face;
        face.sort_unstable();
        let faces = self.faces.get_or_init(|| {
            let mut faces = self.surface.triangles.clone();
            faces.iter_mut().for_each(|face| face.sort_unstable());
            faces.sort_unstable();
            faces
        });
        faces.binary_search(&face).is_ok()
    }

    /// One flag per part: true if the box of the part is within that of another, or another's within its own.
    fn nested(&self, places: &[Vector]) -> Vec<bool> {
        let mut is_nested = vec![false; self.parts];
        if self.parts == 1 {
            return is_nested;
        }
        let mut boxes = vec![bounds(&[], 0.0); self.parts];
        for node in &self.nodes {
            let part = self.part_of[*node as usize];
            include(&mut boxes[part as usize], &places[*node as usize]);
        }
        let mut by_low: Vec<usize> = (0..self.parts).collect();
        by_low.sort_by(|one, other| boxes[*one][0][0].total_cmp(&boxes[*other][0][0]));
        for (number, one) in by_low.iter().enumerate() {
            let others = by_low[number + 1..].iter();
            for other in others.take_while(|other| boxes[**other][0][0] <= boxes[*one][1][0]) {
                let [a, b] = [&boxes[*one], &boxes[*other]];
                let is_in = |a: &Bounds, b: &Bounds| meet(&[a[0]; 2], b) && meet(&[a[1]; 2], b);
                if is_in(a, b) || is_in(b, a) {
                    is_nested[*one] = true;
                    is_nested[*other] = true;
                }
            }
        }
        is_nested
    }

    /// Points of triangles and edges that may be inside although no node is: centroids at nodes that were looked at, and
    /// midpoints of the part of an edge between two triangles that the edge crosses.
    fn between_nodes(
        &self,
        places: &[Vector],
        near: &[[u32; 2]],
        touching: f64,
        is_seen: impl Fn(u32) -> bool,
    ) -> Vec<SurfacePoint> {
        let at = |node: u32| places[node as usize];
        let is_met = |nodes: &&[u32; 3]| nodes.iter().any(|node| is_seen(*node));
        let triangles = self.surface.triangles.iter().filter(is_met);
        let mut points: Vec<SurfacePoint> = triangles
            .map(|nodes| SurfacePoint {
                at: [0, 1, 2]
                    .map(|axis| nodes.map(|node| at(node)[axis]).iter().sum::<f64>() / 3.0),
                between: *nodes,
            })
            .collect();
        for of_edge in near.chunk_by(|one, other| one[0] == other[0]) {
            let [Some([edge, _]), ..] = [of_edge.first()] else {
                continue;
            };
            let [from, to] = self.surface.edges[*edge as usize];
            let segment = [at(from), at(to)];
            let shares = of_edge.iter().filter_map(|[_, triangle]| {
                crossing(segment, self.surface.triangles[*triangle as usize].map(at))
            });
            let mut shares: Vec<f64> = shares.collect();
            shares.sort_by(f64::total_cmp);
            let apart = touching / length(sub(segment[1], segment[0]));
            let pairs = shares.windows(2).filter(|pair| pair[1] - pair[0] > apart);
            points.extend(pairs.map(|pair| {
                let share = 0.5 * (pair[0] + pair[1]);
                let nearest = if share > 0.5 { to } else { from };
                SurfacePoint {
                    at: between(segment[0], segment[1], share),
                    between: [nearest, from, to],
                }
            }));
        }
        points
    }

    /// The deepest of some points found in tetrahedra, if it is deeper than touching surfaces are.
    fn deepest_of(
        &mut self,
        places: &[Vector],
        points: &[SurfacePoint],
        mut found: Vec<(u32, u32)>,
        touching: f64,
    ) -> Option<Inside> {
        // What lies on the surface of the tetrahedron that it is in is no deeper than that; so do cut faces at rest.
        found.retain(|(number, tet)| {
            let nodes = self.mesh.tets[*tet as usize];
            let at = points[*number as usize].at;
            !FACES.iter().any(|face| {
                let face = face.map(|corner| nodes[corner]);
                distance(at, face.map(|node| places[node as usize])) <= touching
                    && self.is_outer(face)
            })
        });
        if found.is_empty() {
            return None;
        }
        let mesh = &*self.mesh;
        let depths = self.depths.get_or_insert_with(|| Depths::new(mesh));
        let mut looks = LOOKS * mesh.tets.len().max(1000);
        // Once the deepest is known, others are soon ruled out.
        found.sort_by_key(|(point, tet)| (std::cmp::Reverse(depths.layer(*tet)), *point, *tet));
        let mut deepest: Option<Inside> = None;
        for (number, tet) in found {
            let point = &points[number as usize];
            let unsaid = match &self.lips {
                Some(lips) if lips.are_at(point, mesh.tets[tet as usize]) => {
                    touching.max(lips.share * mesh_edge(mesh, tet))
                }
                _ => touching,
            };
            let least = deepest.map_or(unsaid, |deepest| deepest.depth.max(unsaid));
            if let Some(depth) = depths.beyond((mesh, places), (point, tet), least, &mut looks) {
                deepest = Some(Inside {
                    depth,
                    at: point.at,
                    node: point.between[0],
                    tet,
                });
            }
        }
        deepest
    }
}

impl Lips {
    fn are_at(&self, point: &SurfacePoint, tet: [u32; 4]) -> bool {
        let is_copied = |node: &u32| self.is_copied[*node as usize];
        point.between.iter().any(is_copied) && tet.iter().any(is_copied)
    }
}

/// The nodes that edges join to each of `nodes` nodes, one after the other, and where those of a node begin.
fn joined(edges: &[[u32; 2]], nodes: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; nodes + 1];
    for node in edges.as_flattened() {
        starts[*node as usize + 1] += 1;
    }
    for node in 0..nodes {
        starts[node + 1] += starts[node];
    }
    let mut next = starts.clone();
    let mut joined = vec![0; 2 * edges.len()];
    for [a, b] in edges {
        for [own, other] in [[a, b], [b, a]] {
            let place = &mut next[*own as usize];
            joined[*place as usize] = *other;
            *place += 1;
        }
    }
    (joined, starts)
}

/// The largest extent (m) of a tetrahedron at rest along the axes.
fn mesh_edge(mesh: &TetMesh, tet: u32) -> f64 {
    let nodes = mesh.tets[tet as usize];
    longest(&bounds(&nodes.map(|node| mesh.points[node as usize]), 0.0))
}

#[cfg(test)]
mod tests {
    use sinew_mesh::structured::{Split, block};

    use super::super::random;
    use super::*;

    /// Bars that are wound up, folded and pinched at random: what is found from where surfaces meet is as deep as what a
    /// look at all nodes finds.
    #[test]
    fn a_search_from_where_surfaces_meet_misses_nothing() {
        let mesh = Arc::new(block([4, 4, 24], [0.02, 0.02, 0.12], Split::Kuhn).unwrap());
        let surface = mesh.boundary_surface();
        let node = |point: u32| surface.nodes[point as usize];
        let triangles = surface.triangles.iter().map(|points| points.map(node));
        let triangles = triangles.collect();
        let mut random = random(3);
        let mut search = OverlapSearch::new(Arc::clone(&mesh), triangles, Vec::new(), None);
        let mut found = 0;
        for case in 0..150 {
            let radius = 0.011 + 0.03 * random();
            let (pitch, wave) = (0.03 * random(), 300.0 * random());
            let height = [0.0, 0.002, 0.008][case % 3] * random();
            let wound = |[x, y, z]: Vector| {
                let angle = z / radius;
                let out = radius + x - 0.01;
                [
                    out * angle.cos() + height * (wave * z).sin(),
                    y + pitch * angle,
                    out * angle.sin() + height * (wave * y).cos(),
                ]
            };
            let places: Vec<Vector> = mesh.points.iter().map(|point| wound(*point)).collect();
            let [of_some, of_all] = [false, true].map(|all| {
                let deepest = search.deepest_of_nodes(&places, all);
                deepest.map_or(0.0, |deepest| deepest.depth)
            });
            found += usize::from(of_all > 0.0);
            assert!(
                (of_some - of_all).abs() < 1e-15,
                "{case}: {of_some}, {of_all} m"
            );
        }
        assert!((20..130).contains(&found), "{found}");
    }
}
