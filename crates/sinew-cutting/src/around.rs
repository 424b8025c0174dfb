//! Tetrahedra around the nodes near a blade.

use crate::incidence::Incidence;

/// The tetrahedra at nodes that may be near a blade, with corners as indices in one list of nodes. So for each sheet
/// the tetrahedra at nodes that are currently near, and all of their nodes, are found in passes through short lists.
#[derive(Default)]
pub(crate) struct Around {
    pub(crate) is_known: bool,
    /// True if the tetrahedra at nodes near the blade were found.
    is_found: bool,
    /// The nodes that may be near, and after them the other corners.
    nodes: Vec<u32>,
    /// Number of the nodes that may be near.
    listed: usize,
    tets: Vec<u32>,
    corners: Vec<[u32; 4]>,
    /// The number of the call of [`Around::take`] in which each tetrahedron of the body was listed, and the number of
    /// calls.
    of_tet: Vec<u32>,
    takes: u32,
    /// The index of each node of the body among the nodes; arbitrary for a node that is not among them.
    place_of: Vec<u32>,
    /// One flag per node: true if it is currently near.
    is_near: Vec<bool>,
    /// One flag per node: true if it is a corner of a tetrahedron at a node that is currently near.
    is_beside: Vec<bool>,
    /// The nodes that have this flag.
    beside: Vec<u32>,
    /// The tetrahedra at nodes that are currently near, and the nodes of each.
    at_near: Vec<(u32, [u32; 4])>,
}

impl Around {
    /// An empty list with capacity for this many nodes and tetrahedra.
    pub(crate) fn with_room(nodes: usize, tets: usize) -> Self {
        Self {
            is_known: false,
            is_found: false,
            nodes: Vec::with_capacity(nodes),
            listed: 0,
            tets: Vec::with_capacity(tets),
            corners: Vec::with_capacity(tets),
            of_tet: vec![0; tets],
            takes: 0,
            place_of: Vec::with_capacity(nodes),
            is_near: Vec::with_capacity(nodes),
            is_beside: Vec::with_capacity(nodes),
            beside: Vec::with_capacity(nodes),
            at_near: Vec::with_capacity(tets),
        }
    }

    /// Lists the tetrahedra at these nodes of a body.
    pub(crate) fn take(
        &mut self,
        listed: impl Iterator<Item = u32>,
        incidence: &Incidence,
        tets: &[[u32; 4]],
        nodes: usize,
    ) {
        self.is_known = true;
        self.is_found = false;
        self.nodes.clear();
        self.nodes.extend(listed);
        self.listed = self.nodes.len();
        self.place_of.resize(nodes, 0);
        for (place, node) in (0..).zip(&self.nodes) {
            self.place_of[*node as usize] = place;
        }
        self.tets.clear();
        self.of_tet.resize(tets.len(), 0);
        let takes = self.takes.wrapping_add(1);
        self.takes = takes;
        for node in &self.nodes {
            for tet in incidence.of(*node) {
                if std::mem::replace(&mut self.of_tet[*tet as usize], takes) != takes {
                    self.tets.push(*tet);
                }
            }
        }
        self.corners.clear();
        for tet in &self.tets {
            let places = tets[*tet as usize].map(|node| {
                let place = &mut self.place_of[node as usize];
                if self.nodes.get(*place as usize) != Some(&node) {
                    *place = self.nodes.len() as u32;
                    self.nodes.push(node);
                }
                *place
            });
            self.corners.push(places);
        }
        self.is_near.clear();
        self.is_near.resize(self.nodes.len(), false);
        self.is_beside.resize(self.nodes.len(), false);
    }

    /// Finds the tetrahedra at nodes that are currently near, and their corners.
    pub(crate) fn find(&mut self, is_near: impl Fn(u32) -> bool) {
        let mut are_same = self.is_found;
        for (flag, node) in self.is_near.iter_mut().zip(&self.nodes[..self.listed]) {
            let is_near = is_near(*node);
            are_same &= *flag == is_near;
            *flag = is_near;
        }
        // Few sheets are the first that are near to a node, or no longer.
        if std::mem::replace(&mut self.is_found, true) && are_same {
            return;
        }
        self.is_beside.fill(false);
        self.at_near.clear();
        for (tet, corners) in self.tets.iter().zip(&self.corners) {
            let is_at = corners.map(|place| self.is_near[place as usize]);
            if is_at[0] | is_at[1] | is_at[2] | is_at[3] {
                let nodes = corners.map(|place| self.nodes[place as usize]);
                self.at_near.push((*tet, nodes));
                for place in corners {
                    self.is_beside[*place as usize] = true;
                }
            }
        }
        self.beside.clear();
        let nodes = self.nodes.iter().zip(&self.is_beside);
        let beside = nodes.filter_map(|(node, is_beside)| is_beside.then_some(*node));
        self.beside.extend(beside);
    }

    /// The tetrahedra at nodes that are near, and the nodes of each.
    pub(crate) fn tets(&self) -> &[(u32, [u32; 4])] {
        &self.at_near
    }

    /// Their nodes.
    pub(crate) fn nodes_beside(&self) -> &[u32] {
        &self.beside
    }
}
