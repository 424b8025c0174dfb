//! Positions of the values that tasks exchange.

use std::collections::HashMap;

use super::chunks::{LANES, tet_at};
use super::gather::{CornerPlaces, Gather};
use super::region::HyperelasticRegion;
use super::when::{AllChunks, FIRST, When};

/// Places in the arrays of an evaluation.
#[derive(Clone, Debug)]
pub(super) struct Rooms {
    pub(super) regions: Vec<RegionRooms>,
    pub(super) corners: CornerPlaces,
    /// Rows for gradients, edges and corners.
    pub(super) gradients_count: usize,
    pub(super) edges_count: usize,
    pub(super) corners_count: usize,
}

/// Places of a region.
#[derive(Clone, Debug, Default)]
pub(super) struct RegionRooms {
    /// The first gradient of each chunk; empty if edges take no means.
    pub(super) gradients: Vec<u32>,
    /// The first corner of each chunk.
    pub(super) corners: Vec<u32>,
    /// The first edge of each vector of edges.
    pub(super) edges: Vec<u32>,
    /// Start of the gradients at each edge in `gradients_at`, and the end of the last, repeated to fill a vector.
    pub(super) starts_at: Vec<u32>,
    /// The gradient of each tetrahedron at each edge, in the order of the edges' sets.
    pub(super) gradients_at: Vec<u32>,
    /// The six edges of each tetrahedron.
    pub(super) edges_of: Vec<[u32; 6]>,
}

/// Allocator of blocks of one size: a released block is reused, the last one first.
struct Blocks {
    size: usize,
    /// Number of rows allocated in total.
    count: usize,
    free: Vec<u32>,
}

impl Blocks {
    fn of(size: usize) -> Self {
        Self {
            size,
            count: 0,
            free: Vec::new(),
        }
    }

    fn take(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            let first = self.count;
            self.count += self.size;
            first as u32
        })
    }
}

/// Blocks released at the end of each stage of the first pass.
#[derive(Default)]
struct Freed(HashMap<usize, Vec<u32>>);

impl Freed {
    /// Records that a block is read at these times: it is released after the last one, and never if one is in a later
    /// pass.
    fn after(&mut self, block: u32, reads: impl Iterator<Item = When>) {
        let mut last = None;
        for when in reads {
            if when.pass != FIRST {
                return;
            }
            last = last.max(Some(when.stage));
        }
        if let Some(stage) = last {
            self.0.entry(stage).or_default().push(block);
        }
    }

    fn give_back(&mut self, stage: usize, blocks: &mut Blocks) {
        blocks
            .free
            .extend(self.0.remove(&stage).unwrap_or_default());
    }
}

impl Rooms {
    /// Assigns blocks for tasks at these times: vectors of edges of each region, forces of all chunks, and nodes.
    pub(super) fn new(
        (regions, gather): (&[HyperelasticRegion], &Gather),
        all: &AllChunks,
        (at_edges, forces, nodes): (&[Vec<When>], &[When], &[When]),
    ) -> Self {
        let read_gradients = readers_of_gradients(regions, all, at_edges);
        let read_edges = readers_of_edges(regions, all, forces);
        let read_corners = readers_of_corners(gather, all, nodes);
        let largest = regions.iter().flat_map(|region| &region.chunks);
        let largest = largest.map(|chunk| chunk.slots.len()).max().unwrap_or(0);
        let mut gradients = Blocks::of(largest);
        let mut edges = Blocks::of(LANES);
        let mut corners = Blocks::of(4 * largest);
        let mut rooms: Vec<RegionRooms> = regions
            .iter()
            .zip(at_edges)
            .map(|(region, at_edges)| RegionRooms {
                corners: vec![0; region.chunks.len()],
                gradients: vec![0; region.chunks.len()],
                edges: vec![0; at_edges.len()],
                ..RegionRooms::default()
            })
            .collect();
        // Of vectors of edges and of chunks whose forces are computed, by stage of the first pass, and all others.
        let mut edges_of_stage: Vec<Vec<(usize, usize)>> = vec![Vec::new(); all.chunks.len()];
        let mut forces_of_stage: Vec<Vec<usize>> = vec![Vec::new(); all.chunks.len()];
        let (mut other_edges, mut other_forces) = (Vec::new(), Vec::new());
        for (region, vectors) in at_edges.iter().enumerate() {
            for (vector, when) in vectors.iter().enumerate() {
                match when.pass {
                    FIRST => edges_of_stage[when.stage].push((region, vector)),
                    _ => other_edges.push((region, vector)),
                }
            }
        }
        for (chunk, when) in forces.iter().enumerate() {
            match when.pass {
                FIRST => forces_of_stage[when.stage].push(chunk),
                _ => other_forces.push(chunk),
            }
        }
        let mut part = 0;
        let (mut free_gradients, mut free_edges, mut free_corners) =
            (Freed::default(), Freed::default(), Freed::default());
        for (stage, (region, chunk)) in all.chunks.iter().enumerate() {
            // What one part gives back another may still need.
            if part != all.part[stage] {
                part = all.part[stage];
                for blocks in [&mut gradients, &mut edges, &mut corners] {
                    blocks.free.clear();
                }
            }
            if !regions[*region].edges_of.is_empty() {
                let block = gradients.take();
                rooms[*region].gradients[*chunk] = block;
                free_gradients.after(block, read_gradients[stage].iter().copied());
            }
            for (region, vector) in &edges_of_stage[stage] {
                let block = edges.take();
                rooms[*region].edges[*vector] = block;
                free_edges.after(block, read_edges[*region][*vector].iter().copied());
            }
            free_gradients.give_back(stage, &mut gradients);
            for chunk in &forces_of_stage[stage] {
                let block = corners.take();
                let (region, own) = all.chunks[*chunk];
                rooms[region].corners[own] = block;
                free_corners.after(block, read_corners[*chunk].iter().copied());
            }
            free_edges.give_back(stage, &mut edges);
            free_corners.give_back(stage, &mut corners);
        }
        for blocks in [&mut gradients, &mut edges, &mut corners] {
            blocks.free.clear();
        }
        for (region, vector) in other_edges {
            rooms[region].edges[vector] = edges.take();
        }
        for chunk in other_forces {
            let (region, own) = all.chunks[chunk];
            rooms[region].corners[own] = corners.take();
        }
        for (region, rooms) in regions.iter().zip(&mut rooms) {
            rooms.find(region, all);
        }
        let corner = |corner: &u32| {
            let place = tet_at(*corner as usize);
            let (region, own) = all.chunks[all.of_place[place] as usize];
            // Chunks are whole blocks.
            let first = regions[region].first + regions[region].chunks[own].slots.start;
            rooms[region].corners[own] + corner - 4 * first as u32
        };
        Self {
            corners: CornerPlaces::new(gather.corners().iter().map(corner).collect()),
            regions: rooms,
            gradients_count: gradients.count,
            edges_count: edges.count,
            corners_count: corners.count,
        }
    }
}

impl RegionRooms {
    /// Finds the values that tasks read.
    fn find(&mut self, region: &HyperelasticRegion, all: &AllChunks) {
        let gradient = |tet: u32| {
            let (_, chunk) = all.chunks[all.of_place[region.first + tet as usize] as usize];
            self.gradients[chunk] + tet - region.chunks[chunk].slots.start as u32
        };
        let edge = |edge: u32| self.edges[edge as usize / LANES] + edge % LANES as u32;
        let sets = (0..region.edges.count()).flat_map(|edge| region.edges.of(edge));
        let gradients_at = sets.map(|tet| gradient(*tet)).collect();
        let edges_of = region.edges_of.iter().map(|edges| edges.map(edge));
        (self.edges_of, self.gradients_at) = (edges_of.collect(), gradients_at);
        let vectors = region.edges.count().next_multiple_of(LANES);
        self.starts_at = region.edges.starts().to_vec();
        self.starts_at
            .resize(vectors + 1, self.gradients_at.len() as u32);
    }
}

/// Times at which the gradients of each chunk are read.
fn readers_of_gradients(
    regions: &[HyperelasticRegion],
    all: &AllChunks,
    at_edges: &[Vec<When>],
) -> Vec<Vec<When>> {
    let mut readers = vec![Vec::new(); all.chunks.len()];
    for (region, vectors) in regions.iter().zip(at_edges) {
        for edge in 0..region.edges.count() {
            let when = vectors[edge / LANES];
            for tet in region.edges.of(edge) {
                let chunk = all.of_place[region.first + *tet as usize];
                note(&mut readers[chunk as usize], when);
            }
        }
    }
    readers
}

/// Times at which each vector of edges of each region is read.
fn readers_of_edges(
    regions: &[HyperelasticRegion],
    all: &AllChunks,
    forces: &[When],
) -> Vec<Vec<Vec<When>>> {
    let of = |region: &HyperelasticRegion| {
        let mut readers = vec![Vec::new(); region.edges.count().div_ceil(LANES)];
        for (place, edges) in region.edges_of.iter().enumerate() {
            let when = forces[all.of_place[region.first + place] as usize];
            for edge in edges {
                note(&mut readers[*edge as usize / LANES], when);
            }
        }
        readers
    };
    regions.iter().map(of).collect()
}

/// Times at which the forces of each chunk are read.
fn readers_of_corners(gather: &Gather, all: &AllChunks, nodes: &[When]) -> Vec<Vec<When>> {
    let mut readers = vec![Vec::new(); all.chunks.len()];
    for (index, when) in nodes.iter().enumerate() {
        for place in gather.tets_at(index) {
            note(&mut readers[all.of_place[place] as usize], *when);
        }
    }
    readers
}

/// Records a time, which is often the same as the one before.
fn note(readers: &mut Vec<When>, when: When) {
    if readers.last() != Some(&when) {
        readers.push(when);
    }
}
