//! Groups of labels.

use std::path::Path;

use sinew_mesh::Mesh;

use super::Failure;

/// Makes groups of these data, and prints their names.
pub(super) fn into_groups(
    mesh: &mut Mesh,
    path: &Path,
    names: &[String],
) -> Result<String, Failure> {
    let mut facts = String::new();
    for name in names {
        let groups = mesh
            .groups_from_data(name)
            .map_err(|source| Failure::Labels {
                path: path.to_owned(),
                source,
            })?;
        let listed: Vec<String> = groups
            .iter()
            .map(|group| {
                format!(
                    "`{}` ({} cells of dimension {})",
                    group.name, group.cells, group.dim
                )
            })
            .collect();
        facts.push_str(&format!("groups of `{name}`: {}; ", listed.join(", ")));
    }
    Ok(facts)
}
