//! Sets and surfaces as groups.

use std::collections::{BTreeMap, HashMap};

use super::elements::face;
use super::part::{Member, Part, Set, Surface};
use crate::cell_type::CellType;
use crate::mesh::{CellBlock, Mesh};
use crate::physical_tags::PhysicalTags;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;
use crate::reading::tag_index::TagIndex;

/// Groups under construction from sets.
pub(super) struct Groups<'a> {
    node_index: &'a TagIndex,
    element_index: &'a TagIndex,
    /// The parts whose sets may be named.
    parts: &'a [&'a Part],
    remarks: &'a mut Remarks,
    /// The tags of each element, by its index among all.
    of_elements: BTreeMap<u32, Vec<i32>>,
    of_nodes: BTreeMap<u32, Vec<i32>>,
    /// The faces of surfaces in the order in which they occur, and their tags.
    faces: Vec<(CellType, Vec<u32>, Vec<i32>)>,
    face_index: HashMap<Vec<u32>, usize>,
    next_tag: [i32; 4],
}

impl<'a> Groups<'a> {
    pub(super) fn new(
        node_index: &'a TagIndex,
        element_index: &'a TagIndex,
        parts: &'a [&'a Part],
        remarks: &'a mut Remarks,
    ) -> Groups<'a> {
        Groups {
            node_index,
            element_index,
            parts,
            remarks,
            of_elements: BTreeMap::new(),
            of_nodes: BTreeMap::new(),
            faces: Vec::new(),
            face_index: HashMap::new(),
            next_tag: [1; 4],
        }
    }

    /// Adds the sets and surfaces of a part.
    pub(super) fn add(&mut self, part: &Part, mesh: &mut Mesh) -> Result<(), Fault> {
        let places = Places::of(mesh);
        for set in part.element_sets.iter().filter(|set| !set.is_internal) {
            let elements = self.elements(part, mesh, &set.members)?;
            let mut tags: BTreeMap<u8, i32> = BTreeMap::new();
            for element in elements {
                let Some((block, _)) = places.cell(mesh, element) else {
                    continue;
                };
                let dim = block.kind.dim();
                let tag = match tags.get(&dim) {
                    Some(tag) => *tag,
                    None => {
                        let tag = self.tag_of(mesh, dim, &set.name);
                        tags.insert(dim, tag);
                        tag
                    }
                };
                add_tag(self.of_elements.entry(element).or_default(), tag);
            }
        }
        for set in part.node_sets.iter().filter(|set| !set.is_internal) {
            let nodes = self.nodes(part, mesh, &set.members)?;
            self.add_nodes(mesh, &set.name, nodes);
        }
        for surface in &part.surfaces {
            self.add_surface(part, surface, &places, mesh)
                .map_err(|fault| fault.inside(format!("surface \"{}\"", surface.name)))?;
        }
        Ok(())
    }

    fn add_nodes(&mut self, mesh: &mut Mesh, name: &str, nodes: Vec<u32>) {
        if nodes.is_empty() {
            return;
        }
        let tag = self.tag_of(mesh, 0, name);
        for node in nodes {
            add_tag(self.of_nodes.entry(node).or_default(), tag);
        }
    }

    fn add_surface(
        &mut self,
        part: &Part,
        surface: &Surface,
        places: &Places,
        mesh: &mut Mesh,
    ) -> Result<(), Fault> {
        if surface.is_of_nodes {
            let members: Vec<Member> = surface.rows.iter().map(|row| row.member.clone()).collect();
            let nodes = self.nodes(part, mesh, &members)?;
            self.add_nodes(mesh, &surface.name, nodes);
            return Ok(());
        }
        let mut tag = None;
        let mut left_out = 0;
        for row in &surface.rows {
            let elements = self.elements(part, mesh, std::slice::from_ref(&row.member))?;
            for element in elements {
                let Some((block, nodes)) = places.cell(mesh, element) else {
                    continue;
                };
                let is_side = matches!(row.face.as_str(), "SPOS" | "SNEG" | "");
                let number = row
                    .face
                    .strip_prefix('S')
                    .and_then(|number| number.parse::<usize>().ok());
                let number = number.and_then(|number| number.checked_sub(1));
                let of_face = number.and_then(|number| face(block.kind, number));
                match of_face {
                    Some((kind, places_of_nodes)) => {
                        let nodes = places_of_nodes.iter().filter_map(|place| nodes.get(*place));
                        let nodes: Vec<u32> = nodes.copied().collect();
                        let tag = match tag {
                            Some(tag) => tag,
                            None => *tag.insert(self.tag_of(mesh, 2, &surface.name)),
                        };
                        self.add_face(kind, nodes, tag);
                    }
                    None if is_side && block.kind.dim() == 2 => {
                        let tag = match tag {
                            Some(tag) => tag,
                            None => *tag.insert(self.tag_of(mesh, 2, &surface.name)),
                        };
                        add_tag(self.of_elements.entry(element).or_default(), tag);
                    }
                    None => left_out += 1,
                }
            }
        }
        if left_out > 0 {
            let message = format!(
                "surface \"{}\": {left_out} of its faces are left out; faces S1 to S4 of tetrahedra and whole triangles are read",
                surface.name
            );
            self.remarks.at(surface.offset, message);
        }
        Ok(())
    }

    fn add_face(&mut self, kind: CellType, nodes: Vec<u32>, tag: i32) {
        let mut sorted = nodes.clone();
        sorted.sort_unstable();
        let next = self.faces.len();
        let place = *self.face_index.entry(sorted).or_insert(next);
        if place == next {
            self.faces.push((kind, nodes, Vec::new()));
        }
        if let Some((_, _, tags)) = self.faces.get_mut(place) {
            add_tag(tags, tag);
        }
    }

    /// The tag of the group with a name and dimension, which is created if absent.
    fn tag_of(&mut self, mesh: &mut Mesh, dim: u8, name: &str) -> i32 {
        let known = mesh.physical_names.iter();
        let known =
            known.filter(|((other, _), known)| *other == dim && known.eq_ignore_ascii_case(name));
        if let Some((&(_, tag), _)) = known.into_iter().next() {
            return tag;
        }
        let Some(next) = self.next_tag.get_mut(usize::from(dim)) else {
            return i32::MAX;
        };
        let tag = *next;
        *next += 1;
        mesh.physical_names.insert((dim, tag), name.to_owned());
        tag
    }

    /// The indices of elements among all.
    fn elements(
        &mut self,
        part: &Part,
        mesh: &Mesh,
        members: &[Member],
    ) -> Result<Vec<u32>, Fault> {
        let tags = || {
            mesh.cells
                .iter()
                .flat_map(|block| &block.element_tags)
                .copied()
        };
        let mut resolver = Resolver {
            sets: sets(self.parts, part, |part| &part.element_sets),
            ..Resolver::with_room(
                mesh.cells.iter().map(CellBlock::len).sum(),
                self.element_index,
            )
        };
        resolver.add(members, &tags)?;
        self.remark_missing(resolver.missing, "elements");
        Ok(resolver.found)
    }

    /// The indices of nodes among all.
    fn nodes(&mut self, part: &Part, mesh: &Mesh, members: &[Member]) -> Result<Vec<u32>, Fault> {
        let tags = || mesh.node_tags.iter().copied();
        let mut resolver = Resolver {
            sets: sets(self.parts, part, |part| &part.node_sets),
            ..Resolver::with_room(mesh.points.len(), self.node_index)
        };
        resolver.add(members, &tags)?;
        self.remark_missing(resolver.missing, "nodes");
        let places = Places::of(mesh);
        for (name, offset) in std::mem::take(&mut resolver.of_elements) {
            let elements = self.elements(part, mesh, &[Member::Set { name, offset }])?;
            for element in elements {
                let nodes = places.cell(mesh, element).map(|(_, nodes)| nodes);
                nodes
                    .unwrap_or_default()
                    .iter()
                    .for_each(|node| resolver.take(*node));
            }
        }
        Ok(resolver.found)
    }

    fn remark_missing(&mut self, missing: usize, what: &str) {
        if missing > 0 {
            self.remarks.general(format!(
                "a set names {what} that the mesh does not have: {missing}"
            ));
        }
    }

    /// Gives the cells their tags, and adds the faces of surfaces and the nodes of sets as cells.
    pub(super) fn finish(self, mesh: &mut Mesh) {
        let mut place = 0;
        for block in &mut mesh.cells {
            let mut physical = PhysicalTags::new();
            for _ in 0..block.len() {
                let tags = self.of_elements.get(&place);
                physical.push(tags.map(Vec::as_slice).unwrap_or_default());
                place += 1;
            }
            block.physical = physical;
        }
        let tags = mesh.cells.iter().flat_map(|block| &block.element_tags);
        let mut next_tag = tags.max().copied().unwrap_or(0).saturating_add(1);
        let faces = self
            .faces
            .iter()
            .map(|(kind, nodes, tags)| (*kind, nodes.as_slice(), tags));
        let nodes = self.of_nodes.iter();
        let nodes = nodes.map(|(node, tags)| (CellType::Vertex, std::slice::from_ref(node), tags));
        for (kind, nodes, tags) in faces.chain(nodes) {
            let is_open = mesh.cells.len() > place_of_added(mesh, kind);
            if !is_open {
                mesh.cells.push(CellBlock::new(kind, Vec::new()));
            }
            if let Some(block) = mesh.cells.last_mut() {
                block.connectivity.extend_from_slice(nodes);
                block.element_tags.push(next_tag);
                block.physical.push(tags);
                next_tag = next_tag.saturating_add(1);
            }
        }
    }
}

/// The sets that a part may name: its own before those of the others.
fn sets<'s>(parts: &[&'s Part], own: &'s Part, of: impl Fn(&'s Part) -> &'s [Set]) -> Vec<&'s Set> {
    let others = parts.iter().flat_map(|part| of(part));
    of(own).iter().chain(others).collect()
}

fn place_of_added(mesh: &Mesh, kind: CellType) -> usize {
    match mesh.cells.last() {
        Some(block) if block.kind == kind => mesh.cells.len() - 1,
        _ => mesh.cells.len(),
    }
}

/// Adds a tag if it is absent.
fn add_tag(tags: &mut Vec<i32>, tag: i32) {
    if !tags.contains(&tag) {
        tags.push(tag);
    }
}

/// The number of elements before each block.
struct Places {
    starts: Vec<usize>,
}

impl Places {
    fn of(mesh: &Mesh) -> Places {
        let mut before = 0;
        let starts = mesh.cells.iter().map(|block| {
            before += block.len();
            before - block.len()
        });
        Places {
            starts: starts.collect(),
        }
    }

    /// The block and the nodes of an element, by its index among all.
    fn cell<'m>(&self, mesh: &'m Mesh, element: u32) -> Option<(&'m CellBlock, &'m [u32])> {
        let element = element as usize;
        let block = self
            .starts
            .partition_point(|&start| start <= element)
            .checked_sub(1)?;
        let cell = element - self.starts.get(block)?;
        let block = mesh.cells.get(block)?;
        let count = block.kind.node_count();
        Some((
            block,
            block.connectivity.get(cell * count..(cell + 1) * count)?,
        ))
    }
}

/// Finds the members of sets.
struct Resolver<'r> {
    index: &'r TagIndex,
    sets: Vec<&'r Set>,
    /// Sets whose members have been added.
    added: Vec<bool>,
    found: Vec<u32>,
    is_found: Vec<bool>,
    /// Sets of elements whose nodes are members.
    of_elements: Vec<(String, usize)>,
    /// Labels that the mesh does not have.
    missing: usize,
}

impl<'r> Resolver<'r> {
    /// A resolver for a mesh with `count` nodes or elements.
    fn with_room(count: usize, index: &'r TagIndex) -> Resolver<'r> {
        Resolver {
            index,
            sets: Vec::new(),
            added: Vec::new(),
            found: Vec::new(),
            is_found: vec![false; count],
            of_elements: Vec::new(),
            missing: 0,
        }
    }

    fn take(&mut self, place: u32) {
        if let Some(is_found) = self.is_found.get_mut(place as usize)
            && !std::mem::replace(is_found, true)
        {
            self.found.push(place);
        }
    }

    /// Adds members, and the members of sets that are named.
    fn add<I: Iterator<Item = u64>>(
        &mut self,
        members: &[Member],
        all: &impl Fn() -> I,
    ) -> Result<(), Fault> {
        self.added = vec![false; self.sets.len()];
        let mut waiting: Vec<&Member> = members.iter().collect();
        let sets = self.sets.clone();
        while let Some(member) = waiting.pop() {
            match member {
                Member::Labels(range) => self.add_range(*range, all),
                Member::Set { name, offset } => {
                    let short = name.rsplit('.').next().unwrap_or(name);
                    let names = [name.as_str(), short];
                    let place = names.iter().find_map(|name| {
                        sets.iter()
                            .position(|set| set.name.eq_ignore_ascii_case(name))
                    });
                    let set = place
                        .and_then(|place| Some((sets.get(place)?, self.added.get_mut(place)?)));
                    let Some((set, is_added)) = set else {
                        let problem = format!("there is no set \"{name}\"");
                        return Err(Fault::new(*offset, problem, "a label or the name of a set"));
                    };
                    if !std::mem::replace(is_added, true) {
                        waiting.extend(&set.members);
                    }
                }
                Member::NodesOfElements { name, offset } => {
                    self.of_elements.push((name.clone(), *offset));
                }
            }
        }
        Ok(())
    }

    /// Adds the labels of a range that the mesh has.
    fn add_range<I: Iterator<Item = u64>>(
        &mut self,
        [first, last, step]: [u64; 3],
        all: &impl Fn() -> I,
    ) {
        if first == last {
            match self.index.get(first) {
                Some(place) => self.take(place),
                None => self.missing += 1,
            }
            return;
        }
        let step = step.max(1);
        // Steps through a range that is larger than the mesh would take any time.
        let (least, greatest) = self.index.range();
        let last = last.min(greatest);
        if first >= least && last.saturating_sub(first) / step <= 4 * self.is_found.len() as u64 {
            let step = usize::try_from(step).unwrap_or(usize::MAX);
            for label in (first..=last).step_by(step) {
                if let Some(place) = self.index.get(label) {
                    self.take(place);
                }
            }
            return;
        }
        let is_in =
            |label: &u64| (first..=last).contains(label) && (label - first).is_multiple_of(step);
        for label in all().filter(is_in) {
            if let Some(place) = self.index.get(label) {
                self.take(place);
            }
        }
    }
}
