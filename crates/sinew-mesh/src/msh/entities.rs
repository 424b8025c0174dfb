//! `$Entities`: which physical groups each geometrical entity belongs to.

use std::collections::HashMap;

use super::fault::Fault;
use super::remarks::Remarks;
use super::source::{Record, Source};
use crate::mesh::Entity;

/// The physical tags, as signed in the file, of each entity.
pub(super) type Entities = HashMap<Entity, Vec<i32>>;

const RECORDS: [&str; 4] = ["point", "curve", "surface", "volume"];

pub(super) fn read_v41(
    source: &mut impl Source,
    entities: &mut Entities,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let mut counts = [0; 4];
    for (count, record) in counts.iter_mut().zip(RECORDS) {
        *count = source.size(&format!("the number of {record}s"))?;
    }
    for ((dim, count), record) in (0u8..).zip(counts).zip(RECORDS) {
        let least = match dim {
            0 => Record {
                ints: 1,
                sizes: 1,
                doubles: 3,
            },
            _ => Record {
                ints: 1,
                sizes: 2,
                doubles: 6,
            },
        };
        source.room_for(count, &format!("the number of {record}s"), least)?;
        for number in 1..=count {
            read_entity(source, dim, entities, remarks)
                .map_err(|fault| fault.in_record(record, number, count))?;
        }
    }
    Ok(())
}

fn read_entity(
    source: &mut impl Source,
    dim: u8,
    entities: &mut Entities,
    remarks: &mut Remarks,
) -> Result<(), Fault> {
    let offset = source.next_offset();
    let entity = Entity {
        dim,
        tag: source.int("the entity tag")?,
    };
    let bounds = if dim == 0 { 3 } else { 6 };
    for _ in 0..bounds {
        // Boxes are not used; gmsh writes 1e22 and meshio zeros for unknown ones.
        source.double("a bound of its box")?;
    }
    let physical = int_list(source, "physical tags")?;
    if dim > 0 {
        int_list(source, "bounding entities")?;
    }
    match entities.get(&entity) {
        Some(earlier) if *earlier != physical => {
            let problem = format!(
                "entity {} of dimension {dim} occurs twice, with different groups",
                entity.tag
            );
            return Err(Fault::new(offset, problem, "each entity once"));
        }
        Some(_) => {
            let message = format!(
                "$Entities: entity {} of dimension {dim} occurs twice",
                entity.tag
            );
            remarks.at(offset, message);
        }
        None => {
            entities.insert(entity, physical);
        }
    }
    Ok(())
}

fn int_list(source: &mut impl Source, what: &str) -> Result<Vec<i32>, Fault> {
    let count = source.size(&format!("the number of {what}"))?;
    let each = Record {
        ints: 1,
        ..Record::default()
    };
    let count = source.room_for(count, &format!("the number of {what}"), each)?;
    (0..count).map(|_| source.int(what)).collect()
}
