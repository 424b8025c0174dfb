//! A summary of a mesh in a few numbers, for users and programs.

use std::collections::BTreeMap;
use std::fmt::Write as _;

pub use crate::data_range::DataRange;
use crate::mesh::Mesh;
use crate::tet_shape::{TetShape, tet_corners};

/// Summary of a mesh. [`MeshInfo::to_json`] gives the fields under their names.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct MeshInfo {
    /// Number of points, including those that no cell uses.
    pub num_points: usize,
    /// The least and the greatest coordinates of all points; zeros for a mesh without any.
    pub bbox: [[f64; 3]; 2],
    /// Number of cells of each type, under meshio's names.
    pub cells: BTreeMap<&'static str, usize>,
    /// The physical groups, by dimension and tag.
    pub physical: Vec<GroupInfo>,
    /// Sum of the volumes of all tetrahedra of any order, computed from their corners and counted as positive.
    pub tet_volume: f64,
    /// The first row of each block with cells.
    pub first_cells: Vec<Vec<u32>>,
    /// Number of points that no volume cell uses.
    pub points_not_in_3d_cells: usize,
    /// Number of volume cells that have the same nodes as an earlier one.
    pub duplicate_3d_cells: usize,
    /// Number of tetrahedra with a negative volume, not counting flat ones.
    pub tets_inverted: usize,
    /// Number of flat tetrahedra, whose volume is at most 1e-9 of the cube of the longest edge.
    pub tets_degenerate: usize,
    /// The data, in the order of points, cells and nodes of cells.
    pub data: Vec<DataInfo>,
    /// Warnings of the reader.
    pub warnings: Vec<String>,
}

/// Data of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct DataInfo {
    /// Holder of the values: `points`, `cells` or `nodes of cells`.
    pub of: &'static str,
    /// Name.
    pub name: String,
    /// Number of the time step.
    pub step: i32,
    /// Numbers for each holder.
    pub components: usize,
    /// The values, of all components.
    pub range: DataRange,
}

/// A physical group.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroupInfo {
    /// Dimension.
    pub dim: u8,
    /// Tag, positive.
    pub tag: i32,
    /// Name; empty if it has none.
    pub name: String,
    /// Number of cells of each type.
    pub cells: BTreeMap<&'static str, usize>,
}

impl MeshInfo {
    /// Counts and measures a mesh.
    #[must_use]
    pub fn of(mesh: &Mesh) -> MeshInfo {
        const FLAT: f64 = 1e-9;
        let mut info = MeshInfo {
            num_points: mesh.points.len(),
            bbox: bounding_box(&mesh.points),
            cells: BTreeMap::new(),
            physical: groups(mesh),
            tet_volume: 0.0,
            first_cells: Vec::new(),
            points_not_in_3d_cells: 0,
            duplicate_3d_cells: mesh.duplicate_cells(3).iter().map(|d| d.pairs.len()).sum(),
            tets_inverted: 0,
            tets_degenerate: 0,
            data: data(mesh),
            warnings: mesh.warnings.iter().map(ToString::to_string).collect(),
        };
        let mut is_in_3d_cell = vec![false; mesh.points.len()];
        for block in mesh.cells.iter().filter(|block| !block.is_empty()) {
            *info.cells.entry(block.kind.name()).or_default() += block.len();
            info.first_cells
                .extend(block.cells().next().map(<[u32]>::to_vec));
            for row in block.cells() {
                if block.kind.dim() == 3 {
                    for &node in row {
                        if let Some(is_in) = is_in_3d_cell.get_mut(node as usize) {
                            *is_in = true;
                        }
                    }
                }
                let Some(corners) = tet_corners(mesh, block.kind, row) else {
                    continue;
                };
                let shape = TetShape::of(corners);
                info.tet_volume += shape.volume.abs();
                if shape.is_flat(FLAT) {
                    info.tets_degenerate += 1;
                } else if shape.volume < 0.0 {
                    info.tets_inverted += 1;
                }
            }
        }
        info.points_not_in_3d_cells = is_in_3d_cell.iter().filter(|&&is_in| !is_in).count();
        info
    }

    /// The fields as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut json = String::from("{");
        field(&mut json, "num_points", self.num_points);
        let points = self
            .bbox
            .map(|point| list(point.iter().map(|x| number(*x))));
        field(&mut json, "bbox", list(points.into_iter()));
        field(&mut json, "cells", counts(&self.cells));
        let groups = self.physical.iter().map(|group| {
            let GroupInfo {
                dim,
                tag,
                name,
                cells,
            } = group;
            let (name, cells) = (text(name), counts(cells));
            format!("{{\"dim\":{dim},\"tag\":{tag},\"name\":{name},\"cells\":{cells}}}")
        });
        field(&mut json, "physical", list(groups));
        field(&mut json, "tet_volume", number(self.tet_volume));
        let rows = self
            .first_cells
            .iter()
            .map(|row| list(row.iter().map(u32::to_string)));
        field(&mut json, "first_cells", list(rows));
        field(
            &mut json,
            "points_not_in_3d_cells",
            self.points_not_in_3d_cells,
        );
        field(&mut json, "duplicate_3d_cells", self.duplicate_3d_cells);
        field(&mut json, "tets_inverted", self.tets_inverted);
        field(&mut json, "tets_degenerate", self.tets_degenerate);
        let data = self.data.iter().map(|data| {
            let DataInfo { of, name, step, components, range } = data;
            let (name, least, greatest) = (text(name), number(range.least), number(range.greatest));
            let different = range.different.map_or_else(|| "null".to_owned(), |count| count.to_string());
            format!(
                "{{\"of\":\"{of}\",\"name\":{name},\"step\":{step},\"components\":{components},\"least\":{least},\"greatest\":{greatest},\
                 \"is_whole\":{},\"different\":{different},\"missing\":{}}}",
                range.is_whole, range.missing
            )
        });
        field(&mut json, "data", list(data));
        field(
            &mut json,
            "warnings",
            list(self.warnings.iter().map(|warning| text(warning))),
        );
        json.push('}');
        json
    }
}

fn bounding_box(points: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let Some(&first) = points.first() else {
        return [[0.0; 3]; 2];
    };
    let mut bbox = [first; 2];
    for point in points {
        for axis in 0..3 {
            bbox[0][axis] = bbox[0][axis].min(point[axis]);
            bbox[1][axis] = bbox[1][axis].max(point[axis]);
        }
    }
    bbox
}

fn data(mesh: &Mesh) -> Vec<DataInfo> {
    let points = mesh.point_data.iter().map(|data| DataInfo {
        of: "points",
        name: data.name.clone(),
        step: data.step,
        components: data.components,
        range: DataRange::of(data.values.iter().copied()),
    });
    let cells = mesh.cell_data.iter().map(|data| DataInfo {
        of: "cells",
        name: data.name.clone(),
        step: data.step,
        components: data.components,
        range: DataRange::of(data.blocks.iter().flatten().copied()),
    });
    let nodes = mesh.cell_node_data.iter().map(|data| DataInfo {
        of: "nodes of cells",
        name: data.name.clone(),
        step: data.step,
        components: data.components,
        range: DataRange::of(data.blocks.iter().flatten().copied()),
    });
    points.chain(cells).chain(nodes).collect()
}

fn groups(mesh: &Mesh) -> Vec<GroupInfo> {
    let mut groups: BTreeMap<(u8, i32), GroupInfo> = BTreeMap::new();
    for (dim, tag) in mesh.physical_groups() {
        let tag = tag.saturating_abs();
        let name = mesh
            .physical_names
            .get(&(dim, tag))
            .cloned()
            .unwrap_or_default();
        let cells = BTreeMap::new();
        groups.insert(
            (dim, tag),
            GroupInfo {
                dim,
                tag,
                name,
                cells,
            },
        );
    }
    for block in &mesh.cells {
        for cell in 0..block.len() {
            for (i, tag) in block.physical.of(cell).iter().enumerate() {
                let tag = tag.saturating_abs();
                let earlier = &block.physical.of(cell)[..i];
                if earlier.iter().any(|other| other.saturating_abs() == tag) {
                    continue;
                }
                if let Some(group) = groups.get_mut(&(block.kind.dim(), tag)) {
                    *group.cells.entry(block.kind.name()).or_default() += 1;
                }
            }
        }
    }
    groups.into_values().collect()
}

fn field(json: &mut String, name: &str, value: impl std::fmt::Display) {
    let comma = if json.len() > 1 { "," } else { "" };
    // Writing to a string does not fail.
    let _ = write!(json, "{comma}\"{name}\":{value}");
}

fn list(items: impl Iterator<Item = String>) -> String {
    let items: Vec<String> = items.collect();
    format!("[{}]", items.join(","))
}

fn counts(counts: &BTreeMap<&'static str, usize>) -> String {
    let entries: Vec<String> = counts
        .iter()
        .map(|(name, count)| format!("\"{name}\":{count}"))
        .collect();
    format!("{{{}}}", entries.join(","))
}

/// A number as JSON, which has neither infinities nor NaN.
fn number(x: f64) -> String {
    if x.is_finite() {
        format!("{x:?}")
    } else {
        "null".to_owned()
    }
}

fn text(text: &str) -> String {
    let mut json = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => json.push_str("\\\""),
            '\\' => json.push_str("\\\\"),
            c if c < ' ' => {
                let _ = write!(json, "\\u{:04x}", u32::from(c));
            }
            c => json.push(c),
        }
    }
    json.push('"');
    json
}
