//! A part as in the file: nodes, elements, sets and surfaces under their labels and names.

use crate::cell_type::CellType;

/// A part, or the whole model of a file without parts.
#[derive(Default)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) node_labels: Vec<u64>,
    pub(super) points: Vec<[f64; 3]>,
    /// The place of each node in the file.
    pub(super) node_offsets: Vec<usize>,
    pub(super) blocks: Vec<Elements>,
    pub(super) element_sets: Vec<Set>,
    pub(super) node_sets: Vec<Set>,
    pub(super) surfaces: Vec<Surface>,
}

/// The elements after one keyword.
pub(super) struct Elements {
    pub(super) kind: CellType,
    pub(super) labels: Vec<u64>,
    /// The nodes of each element in turn, by their labels.
    pub(super) nodes: Vec<u64>,
    /// The place of each element in the file.
    pub(super) offsets: Vec<usize>,
}

/// A set of nodes or of elements.
#[derive(Default)]
pub(super) struct Set {
    pub(super) name: String,
    /// True if the set only serves a surface: every keyword with its name marks it as internal.
    pub(super) is_internal: bool,
    pub(super) members: Vec<Member>,
}

/// Some members of a set.
#[derive(Debug, Clone)]
pub(super) enum Member {
    /// The labels from the first to the second, in steps.
    Labels([u64; 3]),
    /// All members of another set.
    Set { name: String, offset: usize },
    /// The nodes of the elements of a set.
    NodesOfElements { name: String, offset: usize },
}

/// A surface.
pub(super) struct Surface {
    pub(super) name: String,
    pub(super) offset: usize,
    pub(super) is_of_nodes: bool,
    pub(super) rows: Vec<SurfaceRow>,
}

/// Faces or nodes of a surface.
pub(super) struct SurfaceRow {
    pub(super) member: Member,
    /// The name of the face, in capitals; empty if absent.
    pub(super) face: String,
}

impl Part {
    /// Adds members to the set of elements with this name, which is created if absent.
    pub(super) fn add_to_element_set(
        &mut self,
        name: &str,
        is_internal: bool,
        members: Vec<Member>,
    ) {
        add(&mut self.element_sets, name, is_internal, members);
    }

    /// Adds members to the set of nodes with this name, which is created if absent.
    pub(super) fn add_to_node_set(&mut self, name: &str, is_internal: bool, members: Vec<Member>) {
        add(&mut self.node_sets, name, is_internal, members);
    }

    /// True if there are nodes or elements.
    pub(super) fn has_mesh(&self) -> bool {
        !self.points.is_empty() || !self.blocks.is_empty()
    }
}

/// The index of the set with a name, which is created if absent.
fn place_of(sets: &mut Vec<Set>, name: &str) -> usize {
    // Successive lines often continue the same set.
    let last = sets.len().saturating_sub(1);
    let is_named = |set: &Set| set.name.eq_ignore_ascii_case(name);
    if sets.last().is_some_and(is_named) {
        return last;
    }
    sets.iter().position(is_named).unwrap_or_else(|| {
        sets.push(Set {
            name: name.to_owned(),
            is_internal: true,
            members: Vec::new(),
        });
        sets.len() - 1
    })
}

fn add(sets: &mut Vec<Set>, name: &str, is_internal: bool, members: Vec<Member>) {
    let place = place_of(sets, name);
    if let Some(set) = sets.get_mut(place) {
        set.is_internal &= is_internal;
        for member in members {
            set.add(member);
        }
    }
}

impl Set {
    /// Adds a member; it extends the last range if it continues it.
    fn add(&mut self, member: Member) {
        match (self.members.last_mut(), member) {
            (Some(Member::Labels([_, last, 1])), Member::Labels([first, next, 1]))
                if last.checked_add(1) == Some(first) && first == next =>
            {
                *last = next;
            }
            (_, member) => self.members.push(member),
        }
    }
}
