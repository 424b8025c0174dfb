//! The region of each tetrahedron.

use sinew_mesh::{Group, GroupMembers, TetMesh};

use crate::Problem;
use crate::error::{Cause, FemError, Item};
use crate::places::dimension;

/// The region (0-based place in the problem) of each tetrahedron.
pub(crate) fn regions(mesh: &TetMesh, problem: &Problem) -> Result<Vec<u32>, FemError> {
    let mut region_of = vec![None; mesh.tets.len()];
    for (index, region) in problem.regions.iter().enumerate() {
        let item = Item::Region(index);
        let all: Vec<u32>;
        let members = match &region.group {
            None => {
                all = (0..mesh.tets.len() as u32).collect();
                &all
            }
            Some(name) => match mesh.group(name).map_err(FemError::at(item))? {
                Group {
                    members: GroupMembers::Tets(tets),
                    ..
                } => tets,
                other => {
                    let cause = dimension(other, "a group of tetrahedra");
                    return Err(FemError::new(item, cause));
                }
            },
        };
        for &tet in members {
            let slot: &mut Option<u32> = &mut region_of[tet as usize];
            if let Some(first) = slot.replace(index as u32) {
                let cause = Cause::RegionsOverlap {
                    tag: mesh.tet_tags[tet as usize],
                    first: first as usize + 1,
                };
                return Err(FemError::new(item, cause));
            }
        }
    }
    let count = region_of.iter().filter(|region| region.is_none()).count();
    if let Some(first) = region_of.iter().position(Option::is_none) {
        let tag = mesh.tet_tags[first];
        return Err(FemError::new(Item::Mesh, Cause::NoRegion { count, tag }));
    }
    Ok(region_of.into_iter().flatten().collect())
}
