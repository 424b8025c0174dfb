//! The nodes, triangles and tetrahedra of a selection.

use std::collections::{HashMap, HashSet};

use super::data::{self, First, Met};
use super::{Condition, Selection, SelectionError};
use crate::TetMesh;
use crate::tet_mesh::OUTWARD_FACES;
use crate::vector::{cross, dot, length, sub};

/// Share of the longest edge of the bounding box by which bounds are moved outward.
const ROUNDING: f64 = 1e-9;

impl Selection {
    /// The nodes that meet all conditions, ascending.
    ///
    /// # Errors
    ///
    /// [`SelectionError`] when no node meets them, or a tag is unknown.
    pub fn nodes(&self, mesh: &TetMesh) -> Result<Vec<u32>, SelectionError> {
        let boundary = self.boundary_if_it_matters(mesh);
        let mut met = self.met_by(mesh, &boundary, First::Nodes)?;
        if let Some(of_tets) = self.met_tets(mesh, First::Nodes)? {
            let mut is_corner = vec![false; met.len()];
            let tets = mesh.tets.iter().zip(of_tets).filter(|(_, met)| *met);
            for node in tets.flat_map(|(tet, _)| tet) {
                is_corner[*node as usize] = true;
            }
            met.iter_mut()
                .zip(is_corner)
                .for_each(|(met, is_corner)| *met &= is_corner);
        }
        let nodes = (0u32..).zip(met).filter(|(_, met)| *met);
        let nodes: Vec<u32> = nodes.map(|(node, _)| node).collect();
        if nodes.is_empty() {
            return Err(self.nothing(mesh, "node"));
        }
        Ok(nodes)
    }

    /// The triangles of the mesh's boundary, turned outward, whose nodes all meet all conditions.
    ///
    /// # Errors
    ///
    /// [`SelectionError`] when no triangle meets them, or a tag is unknown.
    pub fn triangles(&self, mesh: &TetMesh) -> Result<Vec<[u32; 3]>, SelectionError> {
        let boundary = mesh.boundary(None);
        let met = self.met_by(mesh, &boundary, First::Tets)?;
        let of_tets = self.met_tets(mesh, First::Tets)?;
        let faces_of_tets: Option<HashSet<[u32; 3]>> = of_tets.map(|of_tets| {
            let tets = mesh.tets.iter().zip(of_tets).filter(|(_, met)| *met);
            tets.flat_map(|(tet, _)| OUTWARD_FACES.map(|face| sorted(face.map(|i| tet[i]))))
                .collect()
        });
        let faces = self.facings().collect::<Vec<_>>();
        let selected = boundary.into_iter().filter(|triangle| {
            let looks = faces
                .iter()
                .all(|(normal, angle)| looks_along(mesh, triangle, *normal, *angle));
            let is_face = faces_of_tets
                .as_ref()
                .is_none_or(|faces| faces.contains(&sorted(*triangle)));
            looks && is_face && triangle.iter().all(|node| met[*node as usize])
        });
        let triangles: Vec<[u32; 3]> = selected.collect();
        if triangles.is_empty() {
            return Err(self.no_cell(mesh, &met, "boundary triangle"));
        }
        Ok(triangles)
    }

    /// The tetrahedra (0-based) whose nodes all meet all conditions, ascending.
    ///
    /// # Errors
    ///
    /// [`SelectionError`] when no tetrahedron meets them, or a tag is unknown.
    pub fn tets(&self, mesh: &TetMesh) -> Result<Vec<u32>, SelectionError> {
        let met = self.met_by(mesh, &self.boundary_if_it_matters(mesh), First::Tets)?;
        let of_tets = self.met_tets(mesh, First::Tets)?;
        let tets = (0u32..).zip(&mesh.tets);
        let inside = tets.filter(|(number, tet)| {
            let has_value = of_tets
                .as_ref()
                .is_none_or(|of_tets| of_tets[*number as usize]);
            has_value && tet.iter().all(|node| met[*node as usize])
        });
        let tets: Vec<u32> = inside.map(|(tet, _)| tet).collect();
        if tets.is_empty() {
            return Err(self.no_cell(mesh, &met, "tetrahedron"));
        }
        Ok(tets)
    }

    fn facings(&self) -> impl Iterator<Item = ([f64; 3], f64)> {
        self.conditions()
            .iter()
            .filter_map(|condition| match condition {
                Condition::Facing { normal, angle } => Some((*normal, *angle)),
                _ => None,
            })
    }

    fn boundary_if_it_matters(&self, mesh: &TetMesh) -> Vec<[u32; 3]> {
        match self.facings().next() {
            Some(_) => mesh.boundary(None),
            None => Vec::new(),
        }
    }

    /// One flag per node: true if it meets all conditions except those on data of tetrahedra.
    fn met_by(
        &self,
        mesh: &TetMesh,
        boundary: &[[u32; 3]],
        first: First,
    ) -> Result<Vec<bool>, SelectionError> {
        let (low, high) = mesh.bounding_box();
        let extent = (0..3)
            .map(|axis| high[axis] - low[axis])
            .fold(0.0, f64::max);
        let slack = ROUNDING * extent;
        let mut met = vec![true; mesh.points.len()];
        for condition in self.conditions() {
            let holds = match condition {
                Condition::Data { name, values } => match data::met(mesh, (name, values), first)? {
                    Met::Nodes(met) => met,
                    Met::Tets(_) => continue,
                },
                _ => holds_at(condition, mesh, boundary, slack)?,
            };
            for (met, holds) in met.iter_mut().zip(holds) {
                *met &= holds;
            }
        }
        Ok(met)
    }

    /// One flag per tetrahedron: true if it meets all conditions on data of tetrahedra; `None` if there are no such
    /// conditions.
    fn met_tets(&self, mesh: &TetMesh, first: First) -> Result<Option<Vec<bool>>, SelectionError> {
        let mut all: Option<Vec<bool>> = None;
        for condition in self.conditions() {
            let Condition::Data { name, values } = condition else {
                continue;
            };
            if let Met::Tets(met) = data::met(mesh, (name, values), first)? {
                all = Some(match all {
                    None => met,
                    Some(all) => all.into_iter().zip(met).map(|(a, b)| a && b).collect(),
                });
            }
        }
        Ok(all)
    }

    fn nothing(&self, mesh: &TetMesh, wanted: &'static str) -> SelectionError {
        let (low, high) = mesh.bounding_box();
        SelectionError::Nothing {
            wanted,
            selection: self.to_string(),
            low,
            high,
        }
    }

    fn no_cell(&self, mesh: &TetMesh, met: &[bool], wanted: &'static str) -> SelectionError {
        match met.iter().filter(|met| **met).count() {
            0 => self.nothing(mesh, wanted),
            nodes => SelectionError::NoCell {
                wanted,
                selection: self.to_string(),
                nodes,
            },
        }
    }
}

/// One flag per node: true if the node meets a condition.
fn holds_at(
    condition: &Condition,
    mesh: &TetMesh,
    boundary: &[[u32; 3]],
    slack: f64,
) -> Result<Vec<bool>, SelectionError> {
    let of_points = |holds: &dyn Fn(&[f64; 3]) -> bool| mesh.points.iter().map(holds).collect();
    let mut holds = vec![false; mesh.points.len()];
    match condition {
        Condition::Box { low, high } => {
            let bounded = |x: f64, axis: usize| low[axis] - slack <= x && x <= high[axis] + slack;
            return Ok(of_points(&|point| {
                point.iter().enumerate().all(|(axis, x)| bounded(*x, axis))
            }));
        }
        Condition::Sphere { center, radius } => {
            let distance = |point: &[f64; 3]| length(sub(*point, *center));
            return Ok(of_points(&|point| distance(point) <= radius + slack));
        }
        Condition::Cylinder {
            axis: [from, to],
            radius,
        } => {
            let axis = sub(*to, *from);
            let whole = length(axis);
            let direction = axis.map(|x| x / whole);
            return Ok(of_points(&|point| {
                let at = sub(*point, *from);
                let along = dot(at, direction);
                let is_between = -slack <= along && along <= whole + slack;
                is_between && length(cross(at, direction)) <= radius + slack
            }));
        }
        Condition::Plane {
            point,
            normal,
            within,
        } => {
            let distance = |at: &[f64; 3]| (dot(sub(*at, *point), *normal) / length(*normal)).abs();
            return Ok(of_points(&|at| distance(at) <= within + slack));
        }
        Condition::Facing { normal, angle } => {
            let facing = boundary
                .iter()
                .filter(|triangle| looks_along(mesh, triangle, *normal, *angle));
            for node in facing.flatten() {
                holds[*node as usize] = true;
            }
        }
        Condition::Tags(tags) => {
            let node_of: HashMap<u64, usize> = mesh.node_tags.iter().copied().zip(0..).collect();
            for &tag in tags {
                let node = node_of.get(&tag);
                let node = node.ok_or(SelectionError::UnknownTag { tag })?;
                holds[*node] = true;
            }
        }
        // Asked for beforehand.
        Condition::Data { .. } => {}
    }
    Ok(holds)
}

fn sorted(mut triangle: [u32; 3]) -> [u32; 3] {
    triangle.sort_unstable();
    triangle
}

/// True if the outward normal of a triangle is within an angle (degrees) of a direction.
fn looks_along(mesh: &TetMesh, triangle: &[u32; 3], direction: [f64; 3], angle: f64) -> bool {
    let [a, b, c] = triangle.map(|node| mesh.points[node as usize]);
    let normal = cross(sub(b, a), sub(c, a));
    let lengths = length(normal) * length(direction);
    // The angle by its tangent, since a cosine cannot tell small angles apart.
    let (along, across) = (dot(normal, direction), length(cross(normal, direction)));
    lengths > 0.0 && across.atan2(along).to_degrees() <= angle + 1e-9
}
