//! Finding groups by name, and their nodes.

use super::{Group, GroupMembers, TetMesh};

/// A name that matches no group, or several.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FindGroupError {
    /// No group has the requested name.
    #[error("no group{} is named \"{name}\"{}; {}", of_dim(*dim), hint(nearest.as_deref()), listed(known))]
    Unknown {
        /// The requested name.
        name: String,
        /// The requested dimension, if one was.
        dim: Option<u8>,
        /// Name and dimension of each existing group.
        known: Vec<(String, u8)>,
        /// The most similar name, if one is similar enough for a suggestion.
        nearest: Option<String>,
    },
    /// Groups of several dimensions have the requested name.
    #[error(
        "groups of dimensions {} are named \"{name}\"; say which, by {{ name = \"{name}\", dim = {} }} in a scene or as {name}:{} elsewhere",
        dims.iter().map(u8::to_string).collect::<Vec<_>>().join(" and "),
        dims.first().copied().unwrap_or_default(),
        dims.first().copied().unwrap_or_default()
    )]
    Ambiguous {
        /// The requested name.
        name: String,
        /// The dimensions of the groups that have it, lowest first.
        dims: Vec<u8>,
    },
}

impl TetMesh {
    /// The group with this name. If none has it, `"liver:2"` is the group of dimension 2 named `"liver"`.
    ///
    /// # Errors
    ///
    /// If absent (the error lists the names and suggests the nearest), or one in each of several dimensions.
    pub fn group(&self, name: &str) -> Result<&Group, FindGroupError> {
        let mut named: Vec<&Group> = self.named(name).collect();
        named.sort_by_key(|group| group.dim);
        match (&named[..], with_dim(name)) {
            ([group], _) => Ok(group),
            ([], Some((name, dim))) => self.group_of_dim(name, dim),
            ([], None) => Err(self.unknown_group(name, None)),
            (several, _) => Err(FindGroupError::Ambiguous {
                name: name.to_owned(),
                dims: several.iter().map(|group| group.dim).collect(),
            }),
        }
    }

    /// The group with this name and dimension.
    ///
    /// # Errors
    ///
    /// If absent; the error lists the names and suggests the nearest.
    pub fn group_of_dim(&self, name: &str, dim: u8) -> Result<&Group, FindGroupError> {
        self.named(name)
            .find(|group| group.dim == dim)
            .ok_or_else(|| self.unknown_group(name, Some(dim)))
    }

    /// The group with this name, preferably of this dimension: for functions that need groups of one dimension.
    ///
    /// # Errors
    ///
    /// Same as [`TetMesh::group`].
    pub fn group_for(&self, name: &str, dim: u8) -> Result<&Group, FindGroupError> {
        match self.named(name).find(|group| group.dim == dim) {
            Some(group) => Ok(group),
            None => self.group(name),
        }
    }

    fn named(&self, name: &str) -> impl Iterator<Item = &Group> {
        self.groups.iter().filter(move |group| group.name == name)
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

    fn unknown_group(&self, name: &str, dim: Option<u8>) -> FindGroupError {
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
        FindGroupError::Unknown {
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

/// A name with the dimension that follows a colon.
fn with_dim(name: &str) -> Option<(&str, u8)> {
    let (name, dim) = name.rsplit_once(':')?;
    let dim = dim.parse().ok().filter(|dim| *dim <= 3)?;
    (!name.is_empty()).then_some((name, dim))
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
    fn a_name_of_two_dimensions_is_told_apart_by_one() {
        let mesh = mesh();
        let dim = |group: Result<&Group, FindGroupError>| group.map(|group| group.dim);
        assert_eq!(dim(mesh.group("liver:3")), Ok(3));
        assert_eq!(dim(mesh.group("liver:2")), Ok(2));
        assert_eq!(dim(mesh.group("clamp")), Ok(0));
        assert_eq!(dim(mesh.group_of_dim("liver", 2)), Ok(2));
        assert_eq!(dim(mesh.group_for("liver", 2)), Ok(2));
        assert_eq!(dim(mesh.group_for("clamp", 2)), Ok(0));
        assert_eq!(
            mesh.group("liver").expect_err("two").to_string(),
            r#"groups of dimensions 2 and 3 are named "liver"; say which, by { name = "liver", dim = 2 } in a scene or as liver:2 elsewhere"#
        );
        for name in ["liver:1", "clamp:2", "liver:4", ":2", "liver:"] {
            assert!(
                matches!(mesh.group(name), Err(FindGroupError::Unknown { .. })),
                "{name}"
            );
        }
    }

    #[test]
    fn a_group_whose_own_name_ends_in_a_number_is_found() {
        let mut mesh = mesh();
        mesh.groups[2].name = "2:7".to_owned();
        assert_eq!(mesh.group("2:7").map(|group| group.dim), Ok(0));
        mesh.groups[2].name = "liver:2".to_owned();
        assert_eq!(mesh.group("liver:2").map(|group| group.dim), Ok(0));
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
