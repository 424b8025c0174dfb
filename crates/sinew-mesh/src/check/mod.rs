//! Checks of a mesh's fitness for simulation: its cells, nodes and groups.

mod fixes;

use std::collections::{BTreeMap, HashSet};
use std::fmt;

use crate::tet_shape::{TetShape, tet_corners};

use crate::bounds::Bounds;
use crate::joints::{Joints, Sets, Surfaces};
use crate::mesh::{CellBlock, CellIndex, Mesh};

/// Number of examples that are kept of each finding.
const EXAMPLES: usize = 10;

/// Limits beyond which a tetrahedron or a mesh is reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CheckLimits {
    /// Greatest volume of a flat tetrahedron, as a share of the cube of its longest edge.
    pub flat_volume: f64,
    /// Angle between two faces (degrees) below which a tetrahedron is a sliver.
    pub sliver_dihedral: f64,
    /// Ratio of three inradii to the circumradius (1 for a regular tetrahedron) below which it is a sliver as well.
    pub sliver_radius_ratio: f64,
    /// Width, in the mesh's own unit, above which that unit is probably not the metre.
    pub widest_in_metres: f64,
}

impl Default for CheckLimits {
    fn default() -> CheckLimits {
        CheckLimits {
            flat_volume: 1e-9,
            sliver_dihedral: 5.0,
            sliver_radius_ratio: 0.02,
            widest_in_metres: 5.0,
        }
    }
}

/// Number of occurrences of a problem, and the tags of the first ten.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Finding {
    /// Number of occurrences.
    pub total: usize,
    /// The tags of the first ten elements, or nodes.
    pub first_tags: Vec<u64>,
}

impl Finding {
    fn add(&mut self, tag: impl FnOnce() -> u64) {
        self.total += 1;
        if self.first_tags.len() < EXAMPLES {
            self.first_tags.push(tag());
        }
    }

    /// True if the problem does not occur.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.total)?;
        if let [first, rest @ ..] = self.first_tags.as_slice() {
            write!(f, " (tags {first}")?;
            for tag in rest {
                write!(f, ", {tag}")?;
            }
            let more = if self.total > self.first_tags.len() {
                ", ..."
            } else {
                ""
            };
            write!(f, "{more})")?;
        }
        Ok(())
    }
}

/// A number and the element that has it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The number.
    pub value: f64,
    /// Tag of the element.
    pub element_tag: u64,
}

/// Lengths of the straight edges of the tetrahedra.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EdgeLengths {
    /// The shortest.
    pub shortest: f64,
    /// The longest.
    pub longest: f64,
    /// The mean over all edges of all tetrahedra.
    pub mean: f64,
}

/// Volume cells that are connected through shared nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Number of cells.
    pub cells: usize,
    /// Tag of the first cell.
    pub first_tag: u64,
    /// Widths along x, y and z, in the mesh's own unit.
    pub size: [f64; 3],
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Part {
            cells,
            first_tag,
            size: [x, y, z],
        } = self;
        write!(
            f,
            "{cells} cells, {x:.3e} x {y:.3e} x {z:.3e} wide, the first with tag {first_tag}"
        )
    }
}

/// A face of more than two tetrahedra.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SharedFace {
    /// The tags of its corners.
    pub node_tags: [u64; 3],
    /// The tags of the tetrahedra.
    pub element_tags: Vec<u64>,
}

/// The findings of [`Mesh::check`].
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct MeshCheck {
    /// Number of tetrahedra of any order. All shapes are measured on the corners.
    pub tets: usize,
    /// Tetrahedra of negative orientation. [`Mesh::orient`] turns them.
    pub inverted: Finding,
    /// Tetrahedra without volume.
    pub flat: Finding,
    /// Tetrahedra that are nearly flat.
    pub slivers: Finding,
    /// Cells that name a node twice.
    pub repeated_nodes: Finding,
    /// Cells that have the same nodes as an earlier one. [`Mesh::merge_duplicates`] merges them.
    pub duplicates: Finding,
    /// Nodes that no cell uses. [`Mesh::drop_orphans`] drops them.
    pub orphans: Finding,
    /// Nodes of lines or surfaces that no volume cell uses, in a mesh with volume cells. They would have no mass.
    pub outside_volume: Finding,
    /// The connected parts of the volume cells, largest first; at most ten.
    pub parts: Vec<Part>,
    /// Number of all connected parts.
    pub part_count: usize,
    /// Number of faces that more than two different tetrahedra share.
    pub non_manifold_faces: usize,
    /// The first ten of these faces.
    pub first_non_manifold: Vec<SharedFace>,
    /// Connections between the tetrahedra, real and apparent. [`Mesh::merge_nodes`] joins parts that touch.
    pub joints: Joints,
    /// Named groups without cells: dimension, tag, name.
    pub empty_groups: Vec<(u8, i32, String)>,
    /// The edges of the tetrahedra.
    pub edges: Option<EdgeLengths>,
    /// The least angle between two faces of a tetrahedron, in degrees.
    pub least_dihedral: Option<Extreme>,
    /// The least ratio of three inradii to the circumradius; 1 for a regular tetrahedron.
    pub least_radius_ratio: Option<Extreme>,
    /// A guess about the unit, when the mesh seems too large for metres.
    pub unit: Option<String>,
}

impl Mesh {
    /// Checks for problems that make a simulation fail or give wrong results. Changes nothing.
    ///
    /// Nodes at the same place within a part are not reported, because cuts and contact surfaces consist of them.
    ///
    /// ```
    /// use sinew_mesh::{TetMesh, structured};
    ///
    /// let mut mesh = structured::cube(2, 0.1, structured::Split::Kuhn)?.to_mesh();
    /// assert!(mesh.check().is_clean());
    /// let tets = mesh.cells.last_mut().ok_or("it has tetrahedra")?;
    /// tets.connectivity.swap(0, 1);
    /// assert_eq!(mesh.check().inverted.total, 1);
    /// assert_eq!(mesh.orient(), 1);
    /// assert!(mesh.check().is_clean());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn check(&self) -> MeshCheck {
        self.check_against(&CheckLimits::default())
    }

    /// Same as [`Mesh::check`], with other limits.
    #[must_use]
    pub(crate) fn check_against(&self, limits: &CheckLimits) -> MeshCheck {
        let mut check = MeshCheck::default();
        check_shapes(self, limits, &mut check);
        check_nodes_of_cells(self, &mut check);
        for dim in 0..=3 {
            for duplicates in self.duplicate_cells(dim) {
                for (_, copy) in duplicates.pairs {
                    check.duplicates.add(|| self.element_tag(copy));
                }
            }
        }
        check_parts(self, &mut check);
        check_faces(self, &mut check);
        check.empty_groups = empty_groups(self);
        check.unit = unit_guess(self, limits);
        check
    }
}

impl MeshCheck {
    /// True if nothing needs attention.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.problems().is_empty()
    }

    /// Description of the tetrahedra of negative orientation, if any.
    fn winding(&self) -> Option<String> {
        const FIX: &str = "`sinew mesh check --fix orient` turns them";
        match (self.inverted.total, self.tets) {
            (0, _) => None,
            _ if !self.joints.tangled.is_empty() => {
                Some(format!("inverted tetrahedra: {}", self.inverted))
            }
            (inverted, all) if inverted == all => Some(format!(
                "inverted tetrahedra: all {all}, the mesh is mirrored or counts corners the other way; {FIX}"
            )),
            _ => Some(format!(
                "inverted tetrahedra: {}, which count corners the other way; {FIX}",
                self.inverted
            )),
        }
    }

    /// The findings that need attention, one sentence each.
    #[must_use]
    pub fn problems(&self) -> Vec<String> {
        let mut problems = Vec::new();
        if self.tets == 0 {
            problems.push("no tetrahedra: there is nothing to simulate".to_owned());
        }
        let mut add = |finding: &Finding, what: &str| {
            if !finding.is_empty() {
                problems.push(format!("{what}: {finding}"));
            }
        };
        add(&self.flat, "flat tetrahedra");
        add(&self.slivers, "slivers");
        add(&self.repeated_nodes, "cells that name a node twice");
        add(&self.duplicates, "cells with the nodes of an earlier one");
        add(&self.orphans, "nodes that no cell has");
        add(&self.outside_volume, "nodes that no volume cell has");
        if self.non_manifold_faces > 0 {
            problems.push(format!(
                "faces of more than two tetrahedra: {}",
                self.non_manifold_faces
            ));
        }
        problems.extend(self.winding());
        problems.extend(self.joints.findings().into_iter().map(|(_, words)| words));
        // Parts of other cells than tetrahedra are none of these joints.
        let loose = match self.joints.parts == self.part_count {
            true => self.joints.parts_apart,
            false => self.part_count,
        };
        if loose > 1 {
            problems.push(format!(
                "loose parts: {loose}, which share no node and need a support each"
            ));
        }
        for (dim, tag, name) in &self.empty_groups {
            problems.push(format!(
                "group \"{name}\" (dimension {dim}, tag {tag}) has no cells"
            ));
        }
        problems.extend(self.unit.clone());
        problems
    }
}

impl fmt::Display for MeshCheck {
    /// Writes one line for each fact; lines that need attention start with `!`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "tetrahedra: {}, in parts: {}",
            self.tets, self.part_count
        )?;
        if self.part_count > 1 {
            for part in &self.parts {
                writeln!(f, "  a part of {part}")?;
            }
        }
        if let Some(edges) = self.edges {
            writeln!(
                f,
                "edge lengths: {:.4e} to {:.4e} (1 : {:.1}), mean {:.4e}",
                edges.shortest,
                edges.longest,
                edges.longest / edges.shortest,
                edges.mean
            )?;
        }
        if let Some(angle) = self.least_dihedral {
            let Extreme { value, element_tag } = angle;
            writeln!(
                f,
                "least dihedral angle: {value:.4} degrees (tag {element_tag})"
            )?;
        }
        if let Some(ratio) = self.least_radius_ratio {
            let Extreme { value, element_tag } = ratio;
            writeln!(f, "least radius ratio: {value:.4e} (tag {element_tag})")?;
        }
        for problem in self.problems() {
            writeln!(f, "! {problem}")?;
        }
        for face in &self.first_non_manifold {
            writeln!(
                f,
                "  the face of nodes {:?} belongs to tetrahedra {:?}",
                face.node_tags, face.element_tags
            )?;
        }
        Ok(())
    }
}

/// Every cell of the blocks for which `matters` is true.
fn cells_of<'m>(
    mesh: &'m Mesh,
    matters: impl Fn(&CellBlock) -> bool + 'm,
) -> impl Iterator<Item = (CellIndex, &'m [u32])> {
    let blocks = mesh.cells.iter().enumerate();
    blocks
        .filter(move |(_, block)| matters(block))
        .flat_map(|(block, cells)| {
            let rows = cells.cells().enumerate();
            rows.map(move |(cell, row)| (CellIndex { block, cell }, row))
        })
}

fn check_shapes(mesh: &Mesh, limits: &CheckLimits, check: &mut MeshCheck) {
    let mut edge_sum = 0.0;
    let mut edges: Option<(f64, f64)> = None;
    for (at, row) in cells_of(mesh, |_| true) {
        let kind = mesh.cells[at.block].kind;
        let Some(corners) = tet_corners(mesh, kind, row) else {
            continue;
        };
        check.tets += 1;
        let tag = || mesh.element_tag(at);
        let shape = TetShape::of(corners);
        edge_sum += shape.edges.iter().sum::<f64>();
        for length in shape.edges {
            let (shortest, longest) = edges.unwrap_or((length, length));
            edges = Some((shortest.min(length), longest.max(length)));
        }
        if shape.is_flat(limits.flat_volume) {
            check.flat.add(tag);
            continue;
        }
        if shape.volume < 0.0 {
            check.inverted.add(tag);
        }
        let (angle, ratio) = (shape.least_dihedral(), shape.radius_ratio());
        if angle < limits.sliver_dihedral || ratio < limits.sliver_radius_ratio {
            check.slivers.add(tag);
        }
        keep_least(&mut check.least_dihedral, angle, tag);
        keep_least(&mut check.least_radius_ratio, ratio, tag);
    }
    check.edges = edges.map(|(shortest, longest)| EdgeLengths {
        shortest,
        longest,
        mean: edge_sum / (6 * check.tets) as f64,
    });
}

fn keep_least(least: &mut Option<Extreme>, value: f64, tag: impl FnOnce() -> u64) {
    if least.is_none_or(|least| value < least.value) {
        let element_tag = tag();
        *least = Some(Extreme { value, element_tag });
    }
}

fn check_nodes_of_cells(mesh: &Mesh, check: &mut MeshCheck) {
    let mut greatest_dim = vec![None; mesh.points.len()];
    let mut sorted = Vec::new();
    for (at, row) in cells_of(mesh, |_| true) {
        let dim = mesh.cells[at.block].kind.dim();
        for &node in row {
            if let Some(greatest) = greatest_dim.get_mut(node as usize) {
                *greatest = (*greatest).max(Some(dim));
            }
        }
        sorted.clear();
        sorted.extend_from_slice(row);
        sorted.sort_unstable();
        if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
            check.repeated_nodes.add(|| mesh.element_tag(at));
        }
    }
    let has_volume = greatest_dim.contains(&Some(3));
    for (node, dim) in (0u32..).zip(greatest_dim) {
        match dim {
            None => check.orphans.add(|| mesh.node_tag(node)),
            Some(dim) if dim < 3 && has_volume => {
                check.outside_volume.add(|| mesh.node_tag(node));
            }
            Some(_) => {}
        }
    }
}

fn check_parts(mesh: &Mesh, check: &mut MeshCheck) {
    let nodes = mesh.points.len();
    let mut sets = Sets::new(nodes);
    let is_inside = |row: &[u32]| row.iter().all(|&node| (node as usize) < nodes);
    let volume_cells =
        || cells_of(mesh, |block| block.kind.dim() == 3).filter(|(_, row)| is_inside(row));
    for (_, row) in volume_cells() {
        for pair in row.windows(2) {
            sets.join(pair[0], pair[1]);
        }
    }
    let mut parts: BTreeMap<u32, (Part, Bounds)> = BTreeMap::new();
    for (at, row) in volume_cells() {
        let (part, bounds) = parts.entry(sets.root(row[0])).or_insert_with(|| {
            let part = Part {
                cells: 0,
                first_tag: mesh.element_tag(at),
                size: [0.0; 3],
            };
            (part, Bounds::default())
        });
        part.cells += 1;
        for &node in row {
            bounds.add(mesh.points[node as usize]);
        }
    }
    check.part_count = parts.len();
    let sized = |(part, bounds): (Part, Bounds)| Part {
        size: bounds.widths(),
        ..part
    };
    let mut parts: Vec<Part> = parts.into_values().map(sized).collect();
    parts.sort_by_key(|part| std::cmp::Reverse(part.cells));
    parts.truncate(EXAMPLES);
    check.parts = parts;
}

fn check_faces(mesh: &Mesh, check: &mut MeshCheck) {
    let tets = mesh.corners_of_tets();
    let rows = cells_of(mesh, |block| block.kind.is_tetrahedron());
    let cells: Vec<CellIndex> = rows.map(|(at, _)| at).collect();
    let mut surfaces = Surfaces::of(&mesh.points, &tets);
    for (nodes, owners) in std::mem::take(&mut surfaces.crowded) {
        // Copies of a cell are reported separately.
        let mut seen = HashSet::new();
        let owners = owners.into_iter().map(|tet| tet as usize);
        let different = owners.filter(|tet| {
            let mut nodes = tets[*tet];
            nodes.sort_unstable();
            seen.insert(nodes)
        });
        let different: Vec<usize> = different.collect();
        if different.len() < 3 {
            continue;
        }
        check.non_manifold_faces += 1;
        if check.first_non_manifold.len() < EXAMPLES {
            let tags = different.iter().map(|tet| mesh.element_tag(cells[*tet]));
            check.first_non_manifold.push(SharedFace {
                node_tags: nodes.map(|node| mesh.node_tag(node)),
                element_tags: tags.collect(),
            });
        }
    }
    check.joints = surfaces.joints();
}

pub(crate) fn empty_groups(mesh: &Mesh) -> Vec<(u8, i32, String)> {
    let mut used: HashSet<(u8, i32)> = HashSet::new();
    for block in &mesh.cells {
        for tag in block.physical.lists().flatten() {
            used.insert((block.kind.dim(), tag.saturating_abs()));
        }
    }
    let named = mesh.physical_names.iter();
    named
        .filter(|&(&(dim, tag), _)| !used.contains(&(dim, tag.saturating_abs())))
        .map(|(&(dim, tag), name)| (dim, tag, name.clone()))
        .collect()
}

fn unit_guess(mesh: &Mesh, limits: &CheckLimits) -> Option<String> {
    let mut bounds = Bounds::default();
    for (_, row) in cells_of(mesh, |_| true) {
        let points = row.iter().filter_map(|&n| mesh.points.get(n as usize));
        points.for_each(|&point| bounds.add(point));
    }
    let width = bounds.longest_side();
    (width > limits.widest_in_metres).then(|| {
        format!(
            "the mesh is {width:.4} wide, more than tissue is in metres: probably millimetres, which `scale = 0.001` in the \
             scene's [mesh] turns into metres (`scale = 0.01` if they are centimetres)"
        )
    })
}
