//! The parts of a mesh to which a first scene gives a material, supports and loads.

use sinew_mesh::{Condition, Group, GroupMembers, Selection, TetMesh};

use crate::number::short;

/// Words in names of groups that are usually fixed.
const HELD: [&str; 10] = [
    "fix", "clamp", "attach", "support", "held", "base", "bottom", "ground", "end", "root",
];

/// Words in names of groups that are usually loaded.
const LOADED: [&str; 10] = [
    "load", "press", "push", "pull", "tip", "top", "contact", "tool", "inner", "lip",
];

/// Heights of a part at the bottom or top of the body, as shares of the body's height, tried one after another.
const SHARES: [f64; 4] = [0.05, 0.1, 0.2, 0.4];

/// The fewest nodes that support a body against rotation.
const HOLDING: usize = 3;

/// A part of the body in the form of a scene's table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// A group.
    Group(String),
    /// Everything below this height (m).
    Below(f64),
    /// Everything above this height (m).
    Above(f64),
}

/// Parts of a body in a first scene.
#[derive(Debug)]
pub(super) struct Parts {
    /// The groups of the regions; `None` if the whole body is one.
    pub(super) regions: Option<Vec<String>>,
    /// True if some tetrahedra are in none of these groups.
    pub(super) rest: bool,
    /// The part with supports.
    pub(super) held: Part,
    /// The part that is loaded.
    pub(super) loaded: Part,
    /// The highest node (m), which a probe follows.
    pub(super) highest: [f64; 3],
}

impl Parts {
    pub(super) fn proposed(mesh: &TetMesh) -> Self {
        let held = named(mesh, &HELD, &[]).map_or_else(|| bottom(mesh), Part::Group);
        let held_nodes = held.nodes(mesh);
        let loaded = named(mesh, &LOADED, &held_nodes).map_or_else(|| top(mesh), Part::Group);
        let (regions, rest) = regions(mesh);
        let highest = mesh.points.iter().max_by(|a, b| a[2].total_cmp(&b[2]));
        Self {
            regions,
            rest,
            held,
            loaded,
            highest: highest.copied().unwrap_or_default(),
        }
    }
}

impl Part {
    /// Its nodes, ascending.
    pub(super) fn nodes(&self, mesh: &TetMesh) -> Vec<u32> {
        let below = |z: f64| Condition::below([f64::INFINITY, f64::INFINITY, z]);
        let above = |z: f64| Condition::above([f64::NEG_INFINITY, f64::NEG_INFINITY, z]);
        let condition = match self {
            Self::Group(name) => {
                let group = mesh.group(name);
                return group.map_or_else(|_| Vec::new(), |group| mesh.group_nodes(group));
            }
            Self::Below(z) => below(*z),
            Self::Above(z) => above(*z),
        };
        let selection = Selection::new(vec![condition]);
        selection.nodes(mesh).unwrap_or_default()
    }
}

/// The surface or group of nodes with one of these words in its name that has nodes other than `taken` and is not the
/// whole body.
fn named(mesh: &TetMesh, words: &[&str], taken: &[u32]) -> Option<String> {
    let tells = |name: &str| {
        let name = name.to_lowercase();
        words.iter().position(|word| name.contains(word))
    };
    let groups = mesh.groups.iter().filter(|group| group.dim < 3);
    let found = groups.filter_map(|group| Some((tells(&group.name)?, group)));
    let fits = found.filter(|(_, group)| {
        let nodes = mesh.group_nodes(group);
        let free = nodes
            .iter()
            .filter(|node| taken.binary_search(node).is_err());
        nodes.len() < mesh.points.len() && free.count() >= HOLDING
    });
    let best = fits.min_by_key(|(place, _)| *place)?;
    let Group { name, dim, .. } = best.1;
    Some(match mesh.group(name) {
        Ok(_) => name.clone(),
        Err(_) => format!("{name}:{dim}"),
    })
}

fn bottom(mesh: &TetMesh) -> Part {
    at_an_end(mesh, |low, height, share| Part::Below(low + share * height))
}

fn top(mesh: &TetMesh) -> Part {
    at_an_end(mesh, |low, height, share| {
        Part::Above(low + (1.0 - share) * height)
    })
}

/// The smallest part at the bottom or top that can support a body.
fn at_an_end(mesh: &TetMesh, place: impl Fn(f64, f64, f64) -> Part) -> Part {
    let (low, high) = mesh.bounding_box();
    let of_share = |share: f64| match place(low[2], high[2] - low[2], share) {
        // As few digits as a person would write.
        Part::Below(z) => Part::Below(short(z).parse().unwrap_or(z)),
        Part::Above(z) => Part::Above(short(z).parse().unwrap_or(z)),
        part @ Part::Group(_) => part,
    };
    let mut places = SHARES.into_iter().map(of_share);
    let holds = |part: &Part| part.nodes(mesh).len() >= HOLDING;
    places.find(holds).unwrap_or_else(|| of_share(0.5))
}

/// The groups of tetrahedra that can be regions, and true if some tetrahedra are in none of them; no groups if they
/// overlap.
fn regions(mesh: &TetMesh) -> (Option<Vec<String>>, bool) {
    let mut taken = vec![false; mesh.tets.len()];
    let mut names = Vec::new();
    for group in &mesh.groups {
        let GroupMembers::Tets(tets) = &group.members else {
            continue;
        };
        if tets.is_empty() {
            continue;
        }
        if tets.iter().any(|tet| taken[*tet as usize]) {
            return (None, false);
        }
        for tet in tets {
            taken[*tet as usize] = true;
        }
        names.push(group.name.clone());
    }
    match names.is_empty() {
        true => (None, false),
        false => (Some(names), taken.contains(&false)),
    }
}
