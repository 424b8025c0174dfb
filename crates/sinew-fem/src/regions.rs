//! The region of each tetrahedron.

use sinew_mesh::{Group, GroupMembers, TetMesh};

use crate::Problem;
use crate::error::{Cause, FemError, Item};
use crate::places::dimension;

/// The region (0-based place in the problem) of each tetrahedron.
pub(crate) fn regions(mesh: &TetMesh, problem: &Problem) -> Result<Vec<u32>, FemError> {
    // No region is given this number.
    const NONE: u32 = u32::MAX;
    let mut region_of = vec![NONE; mesh.tets.len()];
    for (index, region) in problem.regions.iter().enumerate() {
        let item = Item::Region(index);
        let members = match &region.group {
            None => None,
            Some(name) => match mesh.group_for(name, 3).map_err(FemError::at(item))? {
                Group {
                    members: GroupMembers::Tets(tets),
                    ..
                } => Some(tets.as_slice()),
                other => {
                    let cause = dimension(other, "a group of tetrahedra");
                    return Err(FemError::new(item, cause));
                }
            },
        };
        let mut add = |tet: usize| {
            let first = std::mem::replace(&mut region_of[tet], index as u32);
            if first == NONE {
                return Ok(());
            }
            let cause = Cause::RegionsOverlap {
                tag: mesh.tet_tags[tet],
                first: first as usize + 1,
            };
            Err(FemError::new(item, cause))
        };
        match members {
            None => (0..mesh.tets.len()).try_for_each(add)?,
            Some(members) => members.iter().try_for_each(|tet| add(*tet as usize))?,
        }
    }
    if let Some(first) = region_of.iter().position(|region| *region == NONE) {
        let tag = mesh.tet_tags[first];
        let count = region_of.iter().filter(|region| **region == NONE).count();
        return Err(FemError::new(Item::Mesh, Cause::NoRegion { count, tag }));
    }
    Ok(region_of)
}
