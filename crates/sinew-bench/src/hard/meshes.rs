//! Meshes of the hard cases.

use sinew_mesh::structured::{Split, StructuredError, cube};
use sinew_mesh::{Group, GroupMembers, TetMesh};

/// A structured cube in which one tetrahedron in the middle is `thinness` times flatter than the
/// others: a node is put over the middle of a face, at that share of the height, and divides the
/// tetrahedron into the flat one on the face and three others.
///
/// # Errors
/// [`StructuredError`] for an impossible cube.
pub fn sliver_cube(cells: usize, edge: f64, thinness: f64) -> Result<TetMesh, StructuredError> {
    let mut mesh = cube(cells, edge, Split::Kuhn)?;
    let middle = cells / 2;
    let hexahedron = middle + cells * (middle + cells * middle);
    flatten(&mut mesh, 6 * hexahedron, thinness);
    Ok(mesh)
}

fn flatten(mesh: &mut TetMesh, tet: usize, thinness: f64) {
    let [a, b, c, d] = mesh.tets[tet];
    let corner = |node: u32, axis: usize| mesh.points[node as usize][axis];
    let point = std::array::from_fn(|axis| {
        let foot = (corner(a, axis) + corner(b, axis) + corner(c, axis)) / 3.0;
        foot + (corner(d, axis) - foot) / thinness
    });
    let node = mesh.points.len() as u32;
    mesh.points.push(point);
    mesh.node_tags.push(u64::from(node) + 1);
    let first = mesh.tets.len() as u32;
    mesh.tets[tet] = [a, b, c, node];
    mesh.tets
        .extend([[a, b, node, d], [b, c, node, d], [c, a, node, d]]);
    mesh.tet_tags.extend((u64::from(first) + 1..).take(3));
    for group in &mut mesh.groups {
        if let GroupMembers::Tets(members) = &mut group.members
            && members.contains(&(tet as u32))
        {
            members.extend(first..first + 3);
        }
    }
}

/// A structured cube whose middle, `core` cells wide, is the group `inclusion`; the rest is
/// `tissue`.
///
/// # Errors
/// [`StructuredError`] for an impossible cube.
pub fn inclusion_cube(cells: usize, core: usize, edge: f64) -> Result<TetMesh, StructuredError> {
    let mut mesh = cube(cells, edge, Split::Mirrored)?;
    let from = cells.saturating_sub(core) / 2;
    let inside = |position: usize| (from..from + core).contains(&position);
    let in_core = |tet: u32| {
        // Six tetrahedra a cell, cells x fastest.
        let cell = tet as usize / 6;
        inside(cell % cells) && inside(cell / cells % cells) && inside(cell / (cells * cells))
    };
    let (inner, outer) = (0..mesh.tets.len() as u32).partition(|tet| in_core(*tet));
    for group in &mut mesh.groups {
        if group.dim == 3 {
            group.members = GroupMembers::Tets(outer);
            break;
        }
    }
    let inclusion = Group {
        name: "inclusion".into(),
        dim: 3,
        tag: 5,
        members: GroupMembers::Tets(inner),
    };
    mesh.groups.insert(1, inclusion);
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_tetrahedron_is_thinner_by_the_factor_and_nothing_is_lost() {
        let plain = cube(3, 0.3, Split::Kuhn).unwrap();
        let mesh = sliver_cube(3, 0.3, 50.0).unwrap();
        let regular = plain.volume(0);
        let volumes = mesh.signed_volumes();
        assert!((volumes.iter().sum::<f64>() - 0.027).abs() < 1e-15);
        let thin: Vec<&f64> = volumes.iter().filter(|v| **v < 0.3 * regular).collect();
        assert_eq!(thin.len(), 1);
        assert!((thin[0] * 50.0 / regular - 1.0).abs() < 1e-10);
        assert!(volumes.iter().all(|volume| *volume > 0.0));
        assert_eq!(mesh.group("tissue").unwrap().members.len(), mesh.tets.len());
        assert_eq!(mesh.points.len(), plain.points.len() + 1);
    }

    #[test]
    fn the_inclusion_is_the_middle() {
        let mesh = inclusion_cube(6, 2, 0.6).unwrap();
        let volume = |name: &str| -> f64 {
            let GroupMembers::Tets(tets) = &mesh.group(name).unwrap().members else {
                panic!("{name}");
            };
            tets.iter().map(|tet| mesh.volume(*tet as usize)).sum()
        };
        assert!((volume("inclusion") - 0.008).abs() < 1e-15);
        assert!((volume("tissue") - (0.216 - 0.008)).abs() < 1e-13);
        let nodes = mesh.group_nodes(mesh.group("inclusion").unwrap());
        let inside = |x: f64| (0.2 - 1e-12..0.4 + 1e-12).contains(&x);
        assert_eq!(nodes.len(), 27);
        assert!(
            nodes
                .iter()
                .all(|n| mesh.points[*n as usize].iter().all(|x| inside(*x)))
        );
    }
}
