//! Times at which tasks can be done.

use super::region::HyperelasticRegion;

/// The earliest time at which a task can be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct When {
    pub(super) pass: usize,
    pub(super) part: usize,
    /// The chunk, among those of all regions, after which all input of the task is available.
    pub(super) stage: usize,
}

/// The pass in which a part follows its chunks.
pub(super) const FIRST: usize = 0;

/// The chunks of all regions, one region after the other.
pub(super) struct AllChunks {
    /// Region, and number in the region.
    pub(super) chunks: Vec<(usize, usize)>,
    /// The part of each.
    pub(super) part: Vec<usize>,
    /// The chunk of each place of a tetrahedron.
    pub(super) of_place: Vec<u32>,
}

impl AllChunks {
    pub(super) fn new(regions: &[HyperelasticRegion], parts: usize) -> Self {
        let places = regions.iter().map(|region| region.rest.count()).sum();
        let (mut chunks, mut part) = (Vec::new(), Vec::new());
        let mut of_place = Vec::with_capacity(places);
        for (number, region) in regions.iter().enumerate() {
            for (index, chunk) in region.chunks.iter().enumerate() {
                part.push((of_place.len() * parts / places).min(parts - 1));
                of_place.resize(of_place.len() + chunk.slots.len(), chunks.len() as u32);
                chunks.push((number, index));
            }
        }
        Self {
            chunks,
            part,
            of_place,
        }
    }

    /// The earliest time for a task that reads results computed at the times `needed`; in pass `otherwise` if they
    /// belong to two parts.
    pub(super) fn after(&self, needed: impl Iterator<Item = When>, otherwise: usize) -> When {
        let all = needed.reduce(|a, b| When {
            pass: if a.part == b.part {
                a.pass.max(b.pass)
            } else {
                otherwise
            },
            part: a.part.max(b.part),
            stage: a.stage.max(b.stage),
        });
        let mut when = all.unwrap_or(When {
            pass: FIRST,
            part: 0,
            stage: 0,
        });
        if when.pass != FIRST {
            when.pass = otherwise;
        }
        when
    }

    /// The time at which a tetrahedron's chunk is processed.
    pub(super) fn first(&self, place: usize) -> When {
        let stage = self.of_place[place] as usize;
        When {
            pass: FIRST,
            part: self.part[stage],
            stage,
        }
    }
}
