//! Loads on nodes that a split touches.

use nalgebra::Vector3;
use sinew_core::LinearOperators;
use sinew_mesh::{CutMesh, TetMesh};

use super::touched::Touched;
use crate::cells::Cells;
use crate::error::Item;
use crate::loads::{Spread, share_of_corner};
use crate::supports::HeldLoad;
use crate::{LoadKind, Problem};

/// Loads with the nodes, triangles or tetrahedra that they act on, so that their shares at a few nodes can be
/// recomputed.
#[derive(Debug)]
pub(super) struct LoadsInPlace {
    /// Triangles of each load, in the order of the problem; `None` for forces, which stay with their nodes.
    spread: Vec<Option<Faces>>,
    gravity: Option<[f64; 3]>,
    /// Sums at the touched nodes.
    sums: Vec<Vector3<f64>>,
}

/// The triangles that a load is spread over.
#[derive(Debug)]
struct Faces {
    spread: Spread,
    /// Tetrahedron of each, and its vertices at the corners.
    faces: Vec<(u32, [u8; 3])>,
}

impl LoadsInPlace {
    /// The loads of a problem on the mesh of a body, before and after cuts, with space for `nodes` touched nodes;
    /// `None` if one of them cannot be updated after a split.
    pub(super) fn new(
        problem: &Problem,
        uncut: &TetMesh,
        cut: &CutMesh,
        nodes: usize,
    ) -> Option<Self> {
        let after = problem.after_cuts(uncut, cut).ok()?;
        let mut spread = Vec::new();
        for (load, as_given) in after.loads.iter().zip(&problem.loads) {
            let (kind, is_outward) = match load.kind {
                LoadKind::Force(_) => {
                    spread.push(None);
                    continue;
                }
                LoadKind::Traction(traction) => (Spread::Traction(traction), false),
                LoadKind::Pressure(pressure) | LoadKind::FollowingPressure(pressure) => {
                    (Spread::Pressure(pressure), true)
                }
            };
            let triangles = load.on.triangles(&cut.mesh).ok()?;
            // A triangle that is named twice, or that no tetrahedron has, does not outlive a cut.
            if triangles.len() != as_given.on.triangles(uncut).ok()?.len() {
                return None;
            }
            let owned: Vec<([u32; 3], u32)> = if is_outward {
                let outward = cut.mesh.outward_faces(&triangles).ok()?;
                outward
                    .into_iter()
                    .map(|(nodes, tet)| (nodes, tet as u32))
                    .collect()
            } else {
                let owners = cut.mesh.first_tets_of(&triangles)?;
                triangles.iter().copied().zip(owners).collect()
            };
            let corners = |(nodes, tet): ([u32; 3], u32)| {
                let vertices = cut.mesh.tets[tet as usize];
                let mut corners = [0; 3];
                for (corner, node) in corners.iter_mut().zip(nodes) {
                    *corner = vertices.iter().position(|vertex| *vertex == node)? as u8;
                }
                Some((tet, corners))
            };
            spread.push(Some(Faces {
                spread: kind,
                faces: owned.into_iter().map(corners).collect::<Option<_>>()?,
            }));
        }
        (spread.len() == problem.loads.len()).then(|| Self {
            spread,
            gravity: problem.gravity,
            sums: Vec::with_capacity(nodes),
        })
    }

    /// Sums up the loads again at touched nodes.
    pub(super) fn follow(
        &mut self,
        (mesh, cells): (&TetMesh, &Cells),
        masses: &[f64],
        touched: &Touched,
        operators: &mut LinearOperators,
        held: &mut [HeldLoad],
    ) {
        let Self {
            spread,
            gravity,
            sums,
        } = self;
        operators.change_loads(|number, entries| {
            let item = match spread.get(number) {
                Some(None) => return,
                Some(Some(faces)) => {
                    faces.sum_up(mesh, touched, sums);
                    Item::Load(number)
                }
                None => {
                    let gravity = Vector3::from(gravity.unwrap_or_default());
                    sums.clear();
                    let weight = |node: &u32| gravity * masses[*node as usize];
                    sums.extend(touched.nodes().iter().map(weight));
                    Item::Gravity
                }
            };
            // A load of zero has one entry, wherever it is.
            if matches!(entries[..], [(_, 0.0)]) {
                return;
            }
            let mut of_held = held.iter_mut().find(|load| load.item == item);
            for node in touched.made_anew() {
                let sum = sums[touched.place(node)];
                let mut is_held = false;
                for axis in 0..3 {
                    match cells.free_dof(node, axis) {
                        Some(dof) => set(entries, dof, sum[axis], sum[axis] != 0.0),
                        None => is_held = true,
                    }
                }
                if let (true, Some(load)) = (is_held, &mut of_held) {
                    let force = [0, 1, 2].map(|axis| match cells.free_dof(node, axis) {
                        Some(_) => 0.0,
                        None => sum[axis],
                    });
                    set(&mut load.forces, node, force, force != [0.0; 3]);
                }
            }
        });
    }
}

impl Faces {
    /// Sums up shares at the touched nodes whose sums are recomputed, in the order of the faces.
    fn sum_up(&self, mesh: &TetMesh, touched: &Touched, sums: &mut Vec<Vector3<f64>>) {
        sums.clear();
        sums.resize(touched.nodes().len(), Vector3::zeros());
        for (tet, corners) in &self.faces {
            let vertices = mesh.tets[*tet as usize];
            let nodes = corners.map(|corner| vertices[usize::from(corner)]);
            if nodes.iter().any(|node| touched.is_made_anew(*node)) {
                let share = share_of_corner(mesh, &nodes, self.spread);
                for node in nodes.into_iter().filter(|node| touched.is_made_anew(*node)) {
                    sums[touched.place(node)] += share;
                }
            }
        }
    }
}

/// Sets the value of a key in a list by increasing keys, or removes it.
fn set<T>(list: &mut Vec<(u32, T)>, key: u32, value: T, is_there: bool) {
    match (
        list.binary_search_by_key(&key, |(other, _)| *other),
        is_there,
    ) {
        (Ok(at), true) => list[at].1 = value,
        (Ok(at), false) => {
            list.remove(at);
        }
        (Err(at), true) => list.insert(at, (key, value)),
        (Err(_), false) => {}
    }
}
