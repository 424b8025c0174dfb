//! Names of overlapping parts, by groups of tetrahedra.

use sinew_mesh::{GroupMembers, TetMesh};

/// The names of two tetrahedra, each with its connected part.
///
/// For one part the name is the smallest group that contains both, if there is one. For two parts each name is the
/// largest group that contains one tetrahedron but not the other.
pub(super) fn names(mesh: &TetMesh, [one, other]: [(u32, u32); 2]) -> [String; 2] {
    let groups = || {
        mesh.groups.iter().filter_map(|group| match &group.members {
            GroupMembers::Tets(tets) => {
                let has = [one.0, other.0].map(|tet| tets.contains(&tet));
                Some((has, tets.len(), &group.name))
            }
            _ => None,
        })
    };
    let common = groups().filter(|(has, ..)| *has == [true; 2]);
    let common = common
        .min_by_key(|(_, size, _)| *size)
        .map(|(.., name)| name.clone());
    if let Some(name) = common.clone().filter(|_| one.1 == other.1) {
        return [name.clone(), name];
    }
    let alone = |has: [bool; 2]| {
        let groups = groups().filter(|group| group.0 == has);
        groups
            .max_by_key(|(_, size, _)| *size)
            .map(|(.., name)| name.clone())
    };
    match [[true, false], [false, true]].map(alone) {
        [Some(one), Some(other)] => [one, other],
        [_, _] if one.1 == other.1 => ["whole body", "whole body"].map(str::to_owned),
        named => {
            let whole = common.unwrap_or_else(|| "whole body".to_owned());
            let [first, second] =
                [one.1, other.1].map(|part| format!("{whole}, part {}", part + 1));
            let [one, other] = named;
            [one.unwrap_or(first), other.unwrap_or(second)]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_mesh::Group;

    #[test]
    fn parts_have_the_names_of_their_groups_and_numbers_where_these_tell_nothing() {
        let group = |name: &str, tets: &[u32]| Group {
            name: name.to_owned(),
            dim: 3,
            tag: 1,
            members: GroupMembers::Tets(tets.to_vec()),
        };
        let with = |groups: &[Group], pair| {
            let mesh = TetMesh {
                groups: groups.to_vec(),
                ..TetMesh::default()
            };
            names(&mesh, pair)
        };
        let groups = [
            group("all", &[0, 1, 2, 3]),
            group("upper", &[0, 1]),
            group("tip", &[0]),
            group("lower", &[2, 3]),
        ];
        assert_eq!(with(&groups, [(0, 0), (3, 1)]), ["upper", "lower"]);
        assert_eq!(with(&groups, [(0, 0), (1, 0)]), ["upper", "upper"]);
        assert_eq!(with(&groups, [(0, 0), (3, 0)]), ["all", "all"]);
        assert_eq!(
            with(&groups[..1], [(0, 0), (3, 1)]),
            ["all, part 1", "all, part 2"]
        );
        assert_eq!(with(&[], [(0, 0), (3, 0)]), ["whole body", "whole body"]);
        assert_eq!(
            with(&groups[1..3], [(0, 0), (3, 1)]),
            ["upper", "whole body, part 2"]
        );
        assert_eq!(
            with(&[], [(0, 2), (3, 1)]),
            ["whole body, part 3", "whole body, part 2"]
        );
    }
}
