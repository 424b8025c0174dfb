//! `$Entities` and `$PartitionedEntities`: the physical groups of each geometrical entity.

use std::collections::HashMap;

use super::header::Version;
use super::source::{Record, Source};
use crate::mesh::Entity;
use crate::reading::fault::Fault;
use crate::reading::remarks::Remarks;

/// The physical tags, as signed in the file, of each entity.
pub(super) type Entities = HashMap<Entity, Vec<i32>>;

const RECORDS: [&str; 4] = ["point", "curve", "surface", "volume"];

/// `$Entities` without its last line.
pub(super) fn read(
    source: &mut impl Source,
    version: Version,
    entities: &mut Entities,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let rows = Rows {
        version,
        are_parts: false,
    };
    let mut first_repeated = None;
    rows.read(source, |row| {
        match entities.get(&row.entity) {
            Some(earlier) if *earlier != row.physical => {
                let Entity { dim, tag } = row.entity;
                let problem =
                    format!("entity {tag} of dimension {dim} occurs twice, with different groups");
                return Err(Fault::new(row.offset, problem, "each entity once"));
            }
            Some(_) => first_repeated = first_repeated.or(Some((row.offset, row.entity))),
            None => {
                entities.insert(row.entity, row.physical);
            }
        }
        Ok(())
    })?;
    if let Some((offset, Entity { dim, tag })) = first_repeated {
        let message = format!("$Entities: entity {tag} of dimension {dim} occurs twice");
        remarks.at(offset, message);
    }
    Ok(())
}

/// `$PartitionedEntities` without its last line. The blocks of a partitioned file refer to these entities, so they take
/// the place of others with the same tags.
pub(super) fn read_partitioned(
    source: &mut impl Source,
    version: Version,
    entities: &mut Entities,
) -> Result<(), Fault> {
    source.size("the number of partitions")?;
    let what = "the number of ghost entities";
    let ghosts = source.size(what)?;
    source.room_for(ghosts, what, Record::ints(2))?;
    for number in 1..=ghosts {
        source
            .int("the entity tag")
            .and_then(|_| source.int("the partition"))
            .map_err(|fault| fault.in_record("ghost entity", number, ghosts))?;
    }
    let rows = Rows {
        version,
        are_parts: true,
    };
    rows.read(source, |row| {
        entities.insert(row.entity, row.physical);
        Ok(())
    })
}

struct Rows {
    version: Version,
    /// True if rows also give the parent and the partitions.
    are_parts: bool,
}

struct Row {
    offset: usize,
    entity: Entity,
    physical: Vec<i32>,
}

impl Rows {
    fn read(
        &self,
        source: &mut impl Source,
        mut keep: impl FnMut(Row) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut counts = [0; 4];
        for (count, record) in counts.iter_mut().zip(RECORDS) {
            *count = source.size(&format!("the number of {record}s"))?;
        }
        for ((dim, count), record) in (0u8..).zip(counts).zip(RECORDS) {
            let least = Record {
                ints: 1,
                sizes: if dim == 0 { 1 } else { 2 },
                doubles: self.bounds(dim),
            };
            source.room_for(count, &format!("the number of {record}s"), least)?;
            for number in 1..=count {
                self.read_row(source, dim)
                    .and_then(&mut keep)
                    .map_err(|fault| fault.in_record(record, number, count))?;
            }
        }
        Ok(())
    }

    /// Number of values of a bounding box: in version 4.1 a point is given once.
    fn bounds(&self, dim: u8) -> u64 {
        if dim == 0 && self.version != Version::V40 {
            3
        } else {
            6
        }
    }

    fn read_row(&self, source: &mut impl Source, dim: u8) -> Result<Row, Fault> {
        let offset = source.next_offset();
        let entity = Entity {
            dim,
            tag: source.int("the entity tag")?,
        };
        if self.are_parts {
            source.int("the dimension of the parent")?;
            source.int("the tag of the parent")?;
            source.int_list("partitions")?;
        }
        for _ in 0..self.bounds(dim) {
            // Boxes are not used: gmsh writes 1e22 and meshio zeros where it knows none.
            source.double("a bound of its box")?;
        }
        let physical = source.int_list("physical tags")?;
        if dim > 0 {
            source.int_list("bounding entities")?;
        }
        Ok(Row {
            offset,
            entity,
            physical,
        })
    }
}
