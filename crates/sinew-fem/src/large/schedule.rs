//! The order in which threads work on a body.

use std::ops::Range;

use super::chunks::LANES;
use super::gather::Gather;
use super::region::HyperelasticRegion;
use super::rooms::Rooms;
use super::when::{AllChunks, FIRST, When};

/// Kinds of work on a part of a region. Ranges of the region's own chunks and edges, and of nodes in the order of
/// [`Gather`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Task {
    /// Takes the means of a chunk's patches, and keeps its gradients.
    Means(usize),
    /// Computes the stress at some edges.
    Edges(Range<usize>),
    /// Computes the forces of a chunk's tetrahedra at their corners.
    Forces(usize),
    /// Adds up the forces at some nodes.
    Nodes(Range<usize>),
}

/// Tasks in one region, one after the other.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) region: usize,
    pub(super) tasks: Vec<Task>,
}

/// Passes that follow one another, each of parts that threads may do at the same time.
///
/// Within a part edges, forces and sums at nodes follow the chunk that completes them, so that their input is still in
/// the second-level cache. Tasks that need the chunks of two parts are done in later passes: the edges first, then the
/// forces of chunks at such edges, then the nodes. So every task reads only results of its own part or of an earlier
/// pass, and no part writes values that another part of the same pass reads.
///
/// Values that a part keeps from one task to another overwrite values that are no longer needed. So a small buffer is
/// reused repeatedly and stays in the second-level cache, instead of being written to memory and read back.
#[derive(Clone, Debug)]
pub(crate) struct Schedule {
    passes: Vec<Vec<Vec<Piece>>>,
    rooms: Rooms,
}

const EDGES: usize = 1;
const FORCES: usize = 2;
const NODES: usize = 3;
const PASSES: usize = 4;

impl Schedule {
    /// The work on these regions in `parts` parts.
    pub(super) fn new(regions: &[HyperelasticRegion], gather: &Gather, parts: usize) -> Self {
        let parts = parts.max(1);
        let all = AllChunks::new(regions, parts);
        // Edges are worked on in whole vectors.
        let at_edges: Vec<Vec<When>> = regions
            .iter()
            .map(|region| {
                let vectors = (0..region.edges.count()).step_by(LANES);
                let when = |first: usize| {
                    let edges = first..(first + LANES).min(region.edges.count());
                    let tets = edges.flat_map(|edge| region.edges.of(edge));
                    let needed = tets.map(|tet| all.first(region.first + *tet as usize));
                    all.after(needed, EDGES)
                };
                vectors.map(when).collect()
            })
            .collect();
        let mut forces = Vec::with_capacity(all.chunks.len());
        for (number, index) in &all.chunks {
            let region = &regions[*number];
            let slots = region.chunks[*index].slots.clone();
            let own = all.first(region.first + slots.start);
            let edges = region.edges_of.get(slots).unwrap_or_default();
            let vectors = edges.as_flattened().iter();
            let vectors = vectors.map(|edge| at_edges[*number][*edge as usize / LANES]);
            let when = all.after(std::iter::once(own).chain(vectors), FORCES);
            forces.push(When {
                part: own.part,
                ..when
            });
        }
        let at_node = |index: usize| {
            let chunks = gather.tets_at(index).map(|place| all.of_place[place]);
            all.after(chunks.map(|chunk| forces[chunk as usize]), NODES)
        };
        let nodes: Vec<When> = (0..gather.nodes().len()).map(at_node).collect();
        let rooms = Rooms::new((regions, gather), &all, (&at_edges, &forces, &nodes));

        let mut tasks = Tasks::default();
        for (stage, (region, chunk)) in all.chunks.iter().enumerate() {
            let own = When {
                pass: FIRST,
                part: all.part[stage],
                stage,
            };
            if regions[*region].is_smoothed() {
                tasks.add(own, *region, Task::Means(*chunk));
            }
            tasks.add(forces[stage], *region, Task::Forces(*chunk));
        }
        for (number, (region, vectors)) in regions.iter().zip(&at_edges).enumerate() {
            for (vector, when) in vectors.iter().enumerate() {
                let first = vector * LANES;
                let edges = first..(first + LANES).min(region.edges.count());
                tasks.add(*when, number, Task::Edges(edges));
            }
        }
        for (index, when) in nodes.into_iter().enumerate() {
            let region = all.chunks[when.stage].0;
            tasks.add(when, region, Task::Nodes(index..index + 1));
        }
        Self {
            passes: tasks.in_passes(parts),
            rooms,
        }
    }

    /// Positions of the values that tasks exchange.
    pub(super) fn rooms(&self) -> &Rooms {
        &self.rooms
    }

    /// The parts of each pass.
    pub(super) fn passes(&self) -> &[Vec<Vec<Piece>>] {
        &self.passes
    }
}

/// Tasks in any order.
#[derive(Default)]
struct Tasks(Vec<(When, usize, Task)>);

impl Tasks {
    fn add(&mut self, when: When, region: usize, task: Task) {
        self.0.push((when, region, task));
    }

    /// All of them in order, by pass and part; passes without any are left out.
    fn in_passes(mut self, parts: usize) -> Vec<Vec<Vec<Piece>>> {
        self.0
            .sort_by_key(|(when, _, task)| (*when, task.rank(), task.first()));
        let mut passes = vec![vec![Vec::<Piece>::new(); parts]; PASSES];
        let count = |pass: usize| self.0.iter().filter(|(when, ..)| when.pass == pass).count();
        let counts: Vec<usize> = (0..PASSES).map(count).collect();
        let mut done = [0; PASSES];
        for (when, region, task) in self.0 {
            // What follows the first pass is distributed again.
            let part = match when.pass {
                FIRST => when.part,
                pass => done[pass] * parts / counts[pass],
            };
            done[when.pass] += 1;
            let pieces = &mut passes[when.pass][part];
            match pieces.last_mut().filter(|piece| piece.region == region) {
                Some(piece) => {
                    let last = piece.tasks.last_mut();
                    if !last.is_some_and(|last| last.takes(&task)) {
                        piece.tasks.push(task);
                    }
                }
                None => pieces.push(Piece {
                    region,
                    tasks: vec![task],
                }),
            }
        }
        passes.retain(|parts| parts.iter().any(|pieces| !pieces.is_empty()));
        passes
    }
}

impl Task {
    /// Its place among tasks that can be done at the same time.
    fn rank(&self) -> u8 {
        match self {
            Self::Means(_) => 0,
            Self::Edges(_) => 1,
            Self::Forces(_) => 2,
            Self::Nodes(_) => 3,
        }
    }

    fn first(&self) -> usize {
        match self {
            Self::Means(chunk) | Self::Forces(chunk) => *chunk,
            Self::Edges(range) | Self::Nodes(range) => range.start,
        }
    }

    /// Merges this task with the next if they are neighbours.
    fn takes(&mut self, next: &Self) -> bool {
        match (self, next) {
            (Self::Edges(own), Self::Edges(next)) | (Self::Nodes(own), Self::Nodes(next))
                if own.end == next.start =>
            {
                own.end = next.end;
                true
            }
            _ => false,
        }
    }
}
