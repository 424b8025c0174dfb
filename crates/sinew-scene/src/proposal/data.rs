//! Data of a mesh in a first scene.

use std::fmt::Write as _;

use sinew_mesh::TetMesh;
use sinew_mesh::info::DataRange;

use super::quoted::quoted;
use crate::number::short;

/// Names of data that are a stiffness, in lower case and without separators between words.
const STIFFNESS: [&str; 8] = [
    "e",
    "young",
    "youngs",
    "youngsmodulus",
    "youngmodulus",
    "stiffness",
    "elasticmodulus",
    "elasticity",
];

/// Data that are proposed as Young's modulus.
pub(super) struct Stiffness {
    pub(super) name: String,
    /// Description of their range, from the least to the greatest value.
    pub(super) reach: String,
}

/// The data whose name is that of a stiffness, and which have a number above 0 for each tetrahedron.
pub(super) fn stiffness(mesh: &TetMesh) -> Option<Stiffness> {
    let rank = |name: &str| {
        let letters = name.chars().filter(|c| c.is_alphanumeric());
        let plain: String = letters.flat_map(char::to_lowercase).collect();
        STIFFNESS.iter().position(|known| *known == plain)
    };
    let named = mesh
        .data
        .iter()
        .filter_map(|data| Some((rank(&data.name)?, data)));
    let fits = named.filter(|(_, data)| {
        let mut values = data.values.iter();
        data.components == 1
            && mesh.data(&data.name).is_ok()
            && values.all(|value| value.is_finite() && *value > 0.0)
    });
    let (_, data) = fits.min_by_key(|(rank, _)| *rank)?;
    let range = DataRange::of(data.values.iter().copied());
    Some(Stiffness {
        name: data.name.clone(),
        reach: format!("from {} to {}", short(range.least), short(range.greatest)),
    })
}

/// Lines of comment that list all data, and how labels choose parts.
pub(super) fn heading(mesh: &TetMesh) -> String {
    let of_tets = mesh.data.iter();
    let of_tets = of_tets.map(|data| ("tetrahedra", &data.name, data.components, &data.values));
    let at_nodes = mesh.node_data.iter();
    let at_nodes = at_nodes.map(|data| ("nodes", &data.name, data.components, &data.values));
    let mut text = String::new();
    let mut labels = None;
    for (of, name, components, values) in of_tets.chain(at_nodes) {
        if text.is_empty() {
            text.push_str("# Its data:\n");
        }
        let range = DataRange::of(values.iter().copied());
        let width = match components {
            1 => String::new(),
            components => format!(", {components} numbers each"),
        };
        // A String takes all that is written to it.
        let _ = writeln!(text, "#   {name} ({of}{width}): {range}");
        if components == 1 && range.different.is_some_and(|count| count > 1) {
            labels.get_or_insert((name, range.least));
        }
    }
    if let Some((name, value)) = labels {
        let _ = writeln!(
            text,
            "# where = {{ data = {{ name = {}, equals = {value} }} }} chooses a part by its label.",
            quoted(name)
        );
    }
    text
}
