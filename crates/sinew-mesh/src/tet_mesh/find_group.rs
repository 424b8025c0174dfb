//! Finding groups by name, and their nodes.

use super::{Group, GroupMembers, TetMesh};

/// No group has the name that was asked for.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no group{} is named \"{name}\"{}; {}", of_dim(*dim), hint(nearest.as_deref()), listed(known))]
pub struct UnknownGroup {
    /// The name that was asked for.
    pub name: String,
    /// The dimension that was asked for, if one was.
    pub dim: Option<u8>,
    /// Name and dimension of each existing group.
    pub known: Vec<(String, u8)>,
    /// The most similar name, if one is similar enough for a suggestion.
    pub nearest: Option<String>,
}

impl TetMesh {
    /// The group with this name; if several dimensions have one, the one of the highest dimension.
    ///
    /// # Errors
    ///
    /// If there is none; the error lists the names and suggests the nearest.
    pub fn group(&self, name: &str) -> Result<&Group, UnknownGroup> {
        self.groups
            .iter()
            .filter(|group| group.name == name)
            .max_by_key(|group| group.dim)
            .ok_or_else(|| self.unknown_group(name, None))
    }

    /// The group with this name and dimension.
    ///
    /// # Errors
    ///
    /// If there is none; the error lists the names and suggests the nearest.
    pub fn group_of_dim(&self, name: &str, dim: u8) -> Result<&Group, UnknownGroup> {
        self.groups
            .iter()
            .find(|group| group.name == name && group.dim == dim)
            .ok_or_else(|| self.unknown_group(name, Some(dim)))
    }

    /// The nodes of a group's members, each once, ascending.
    #[must_use]
    pub fn group_nodes(&self, group: &Group) -> Vec<u32> {
        let mut nodes: Vec<u32> = match &group.members {
            GroupMembers::Tets(tets) => tets.iter().flat_map(|&t| self.tets[t as usize]).collect(),
            GroupMembers::Triangles(triangles) => triangles.iter().flatten().copied().collect(),
            GroupMembers::Lines(lines) => lines.iter().flatten().copied().collect(),
            GroupMembers::Nodes(nodes) => nodes.clone(),
        };
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    fn unknown_group(&self, name: &str, dim: Option<u8>) -> UnknownGroup {
        let lower = name.to_lowercase();
        let nearest = self
            .groups
            .iter()
            .filter(|group| group.name != name && dim.is_none_or(|d| d == group.dim))
            .map(|group| {
                (
                    strsim::jaro_winkler(&lower, &group.name.to_lowercase()),
                    group,
                )
            })
            .filter(|(similarity, _)| *similarity > 0.75)
            .max_by(|(a, _), (b, _)| a.total_cmp(b))
            .map(|(_, group)| group.name.clone());
        UnknownGroup {
            name: name.to_owned(),
            dim,
            known: self
                .groups
                .iter()
                .map(|g| (g.name.clone(), g.dim))
                .collect(),
            nearest,
        }
    }
}

fn of_dim(dim: Option<u8>) -> String {
    dim.map_or_else(String::new, |dim| format!(" of dimension {dim}"))
}

fn hint(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!(", did you mean \"{name}\"?"))
}

fn listed(known: &[(String, u8)]) -> String {
    const SHOWN: usize = 20;
    if known.is_empty() {
        return "the mesh has no groups".to_owned();
    }
    let mut names: Vec<String> = known
        .iter()
        .take(SHOWN)
        .map(|(name, dim)| format!("\"{name}\" (dimension {dim})"))
        .collect();
    if known.len() > SHOWN {
        names.push(format!("and {} more", known.len() - SHOWN));
    }
    format!("the groups are {}", names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> TetMesh {
        let mut mesh =
            TetMesh::new(vec![[0.0; 3]; 4], vec![[0, 1, 2, 3]]).expect("indices are in range");
        let group = |name: &str, dim, members| Group {
            name: name.to_owned(),
            dim,
            tag: 1,
            members,
        };
        mesh.groups = vec![
            group("liver", 3, GroupMembers::Tets(vec![0])),
            group(
                "liver",
                2,
                GroupMembers::Triangles(vec![[3, 1, 0], [1, 0, 2]]),
            ),
            group("clamp", 0, GroupMembers::Nodes(vec![2])),
        ];
        mesh
    }

    #[test]
    fn the_highest_dimension_wins_unless_one_is_named() {
        let mesh = mesh();
        assert_eq!(mesh.group("liver").map(|g| g.dim), Ok(3));
        assert_eq!(mesh.group_of_dim("liver", 2).map(|g| g.dim), Ok(2));
    }

    #[test]
    fn nodes_of_a_group_are_sorted_and_unique() {
        let mesh = mesh();
        let surface = mesh.group_of_dim("liver", 2).expect("it is there");
        assert_eq!(mesh.group_nodes(surface), [0, 1, 2, 3]);
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_known_ones() {
        let mesh = mesh();
        assert_eq!(
            mesh.group("Livr").expect_err("a typo").to_string(),
            r#"no group is named "Livr", did you mean "liver"?; the groups are "liver" (dimension 3), "liver" (dimension 2), "clamp" (dimension 0)"#
        );
        assert_eq!(
            mesh.group_of_dim("clamp", 2)
                .expect_err("wrong dimension")
                .to_string(),
            r#"no group of dimension 2 is named "clamp"; the groups are "liver" (dimension 3), "liver" (dimension 2), "clamp" (dimension 0)"#
        );
    }
}
