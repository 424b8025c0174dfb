//! The numbers that the other programs must read, and the comparison with those that they read.

use sinew_mesh::{CellBlock, CellType, Mesh};

use super::files::{GRID, MSH, OVERLAPPING_MSH, OVERLAPPING_VTU, VTU, integers};

/// A difference between the numbers that were written and those that were read.
#[derive(Debug, PartialEq, thiserror::Error)]
pub(super) enum Difference {
    #[error("{place}: expected `{expected}`, but `{read}` was read")]
    Line {
        /// The file that the line is about.
        place: String,
        expected: String,
        read: String,
    },
    #[error("expected {expected} lines, but {read} were printed")]
    Count { expected: usize, read: usize },
}

/// The lines that `xtask/python/read_meshes.py` prints if it reads everything as it was written.
pub(super) fn of(mesh: &Mesh, overlapping: &Mesh) -> String {
    let mut lines = String::new();
    for (file, ..) in MSH {
        lines.push_str(&format!("file {file}\n{}", arrays(mesh, true)));
    }
    for (file, _) in VTU {
        let arrays = arrays(mesh, false);
        lines.push_str(&format!(
            "file {file}\n{arrays}file {file} pyvista\n{arrays}"
        ));
    }
    let sets = sets(overlapping);
    for file in OVERLAPPING_MSH.map(|(file, _)| file) {
        lines.push_str(&format!("file {file}\n{sets}"));
    }
    lines.push_str(&format!("file {OVERLAPPING_VTU}\n{sets}"));
    let tets = mesh
        .cells
        .iter()
        .filter(|block| block.kind == CellType::Tetra);
    let tets: Vec<u32> = tets.flat_map(|block| block.connectivity.clone()).collect();
    let whole = |count: usize| integers(count).into_iter().map(|i| i as f64);
    lines.push_str(&format!("file {GRID}\n"));
    lines.push_str(&line("points", mesh.points.iter().flatten().copied()));
    lines.push_str(&line("tetra", tets.iter().map(|&node| f64::from(node))));
    lines.push_str(&line("node", whole(mesh.points.len())));
    lines.push_str(&line("region", whole(tets.len() / 4)));
    lines.push_str("int64 int64\n");
    let cells: usize = mesh.cells.iter().map(CellBlock::len).sum();
    lines.push_str(&format!("times [0.0, 0.5]\ncells {cells}\n"));
    lines
}

/// The cells of each named group, counted over all blocks.
fn sets(mesh: &Mesh) -> String {
    let mut sets = mesh.cell_sets();
    sets.sort_unstable_by(|a, b| a.name.cmp(&b.name));
    let mut lines = String::new();
    for set in sets {
        let mut first = 0.0;
        let mut cells = Vec::new();
        for (block, indices) in mesh.cells.iter().zip(&set.blocks) {
            cells.extend(indices.iter().map(|&index| first + f64::from(index)));
            first += block.len() as f64;
        }
        lines.push_str(&line(&format!("set {}", set.name), cells.into_iter()));
    }
    lines
}

fn arrays(mesh: &Mesh, has_groups: bool) -> String {
    let mut lines = line("points", mesh.points.iter().flatten().copied());
    for kind in ["triangle", "tetra"] {
        let blocks = || (0..mesh.cells.len()).filter(|&b| mesh.cells[b].kind.name() == kind);
        let nodes = blocks().flat_map(|b| mesh.cells[b].connectivity.iter().map(|&n| f64::from(n)));
        lines.push_str(&line(kind, nodes));
        let groups = blocks().flat_map(|b| {
            let block = &mesh.cells[b];
            (0..block.len()).map(|cell| f64::from(block.physical.first_of(cell)))
        });
        lines.push_str(&line(&format!("{kind} gmsh:physical"), groups));
        let energies = blocks().flat_map(|b| mesh.cell_data[0].blocks[b].iter().copied());
        lines.push_str(&line(&format!("{kind} energy"), energies));
    }
    for data in &mesh.point_data {
        lines.push_str(&line(&data.name, data.values.iter().copied()));
    }
    if has_groups {
        let mut groups = mesh.field_data();
        groups.sort_unstable();
        for (name, tag, dim) in groups {
            let numbers = [f64::from(tag), f64::from(dim)];
            lines.push_str(&line(&format!("group {name}"), numbers.into_iter()));
        }
    }
    lines
}

fn line(label: &str, values: impl Iterator<Item = f64>) -> String {
    let values: String = values.map(|value| format!(" {value:?}")).collect();
    format!("{label}{values}\n")
}

/// Compares line by line, numbers to the last bit; returns the number of lines.
pub(super) fn compare(read: &str, expected: &str) -> Result<usize, Difference> {
    let mut place = "before the first file";
    for (read, expected) in read.lines().zip(expected.lines()) {
        if normalised(read) != normalised(expected) {
            return Err(Difference::Line {
                place: place.to_owned(),
                expected: expected.to_owned(),
                read: read.to_owned(),
            });
        }
        if expected.starts_with("file ") {
            place = expected;
        }
    }
    let (read, expected) = (read.lines().count(), expected.lines().count());
    if read == expected {
        Ok(expected)
    } else {
        Err(Difference::Count { expected, read })
    }
}

/// A line with its numbers as Rust prints them, since Python prints some differently.
fn normalised(line: &str) -> String {
    let word = |word: &str| match word.parse::<f64>() {
        Ok(number) => format!("{number:?}"),
        Err(_) => word.to_owned(),
    };
    line.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::files::{mesh, overlapping};

    #[test]
    fn numbers_of_python_are_the_same_numbers() {
        assert_eq!(
            compare("file a\nx 1e-07 3.0\n", "file a\nx 0.0000001 3\n"),
            Ok(2)
        );
    }

    #[test]
    fn a_last_bit_and_a_missing_line_are_differences() {
        let expected = of(&mesh().unwrap(), &overlapping().unwrap());
        assert!(compare(&expected, &expected).is_ok());
        let third = format!("{:?}", 0.1 / 3.0 - 1e-30);
        let off = format!("{:?}", (0.1f64 / 3.0).next_up());
        let read = expected.replace(&third, &off);
        let Err(Difference::Line { place, .. }) = compare(&read, &expected) else {
            panic!("a number is off by a bit");
        };
        assert_eq!(place, "file 22-text.msh");
        let (cut, _) = expected.trim_end().rsplit_once('\n').unwrap();
        let lines = expected.lines().count();
        assert_eq!(
            compare(cut, &expected),
            Err(Difference::Count {
                expected: lines,
                read: lines - 1
            })
        );
    }
}
