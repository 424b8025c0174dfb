//! Parts of the body chosen by position, which become groups of its mesh.

use sinew_mesh::{GroupMembers, TetMesh};

use crate::error::{Fault, SceneError};
use crate::scene::{Body, Choice, Members, Places, Selected};

/// A part of the body that a scene chose by position.
#[derive(Debug, Clone, PartialEq)]
pub struct SelectedPart {
    /// The table of the scene that chose it, e.g. `[[fixed]] 1`.
    pub by: String,
    /// The name of its group in the mesh.
    pub name: String,
    /// Number of its nodes.
    pub nodes: usize,
    /// Area (m^2) of its part of the body's boundary: of the triangles with all nodes selected.
    pub area: f64,
    /// Number of its tetrahedra and their volume (m^3), if it is a region.
    pub tets: Option<(usize, f64)>,
}

/// Adds the selected parts to the groups of a mesh.
pub(super) fn add_to(
    mesh: &mut TetMesh,
    body: &Body,
    places: &Places,
) -> Result<Vec<SelectedPart>, SceneError> {
    let mut parts: Vec<Option<SelectedPart>> = vec![None; body.selected.len()];
    // The rest is known once all others are.
    let rests = [false, true];
    for rest_now in rests {
        for (index, selected) in body.selected.iter().enumerate() {
            if (selected.choice == Choice::Rest) != rest_now {
                continue;
            }
            let place = places.of(&places.selected, index);
            let same = |part: &&SelectedPart| part.name == selected.name;
            let mut part = match parts.iter().flatten().find(same) {
                Some(part) => part.clone(),
                None => {
                    add(mesh, body, selected).map_err(|fault| place.value_fault("where", fault))?
                }
            };
            place.name().clone_into(&mut part.by);
            parts[index] = Some(part);
        }
    }
    Ok(parts.into_iter().flatten().collect())
}

fn add(mesh: &mut TetMesh, body: &Body, selected: &Selected) -> Result<SelectedPart, Fault> {
    let boundary = |mesh: &TetMesh| match &selected.choice {
        Choice::Where(selection) => selection.triangles(mesh).unwrap_or_default(),
        Choice::Rest => Vec::new(),
    };
    let (members, triangles) = match (&selected.choice, selected.members) {
        (Choice::Rest, _) => (GroupMembers::Tets(rest(mesh, body)?), Vec::new()),
        (Choice::Where(selection), Members::Nodes) => {
            (GroupMembers::Nodes(selection.nodes(mesh)?), boundary(mesh))
        }
        (Choice::Where(selection), Members::Triangles) => {
            let triangles = selection.triangles(mesh)?;
            (GroupMembers::Triangles(triangles.clone()), triangles)
        }
        (Choice::Where(selection), Members::Tetrahedra) => {
            (GroupMembers::Tets(selection.tets(mesh)?), boundary(mesh))
        }
    };
    let tets = match &members {
        GroupMembers::Tets(tets) => {
            let volumes = tets.iter().map(|tet| mesh.volume(*tet as usize));
            Some((tets.len(), volumes.sum()))
        }
        _ => None,
    };
    let areas = triangles.iter().map(|triangle| mesh.area(*triangle));
    let area = areas.fold(0.0, |sum, area| sum + area);
    let group = mesh.add_group(&selected.name, members)?.clone();
    Ok(SelectedPart {
        by: String::new(),
        name: selected.name.clone(),
        nodes: mesh.group_nodes(&group).len(),
        area,
        tets,
    })
}

/// The tetrahedra that are in no other region. Missing groups are reported elsewhere.
fn rest(mesh: &TetMesh, body: &Body) -> Result<Vec<u32>, Fault> {
    let mut taken = vec![false; mesh.tets.len()];
    for region in &body.problem.regions {
        let group = region.group.as_deref().map(|name| mesh.group_for(name, 3));
        if let Some(Ok(group)) = group
            && let GroupMembers::Tets(tets) = &group.members
        {
            for tet in tets {
                taken[*tet as usize] = true;
            }
        }
    }
    let free = (0u32..).zip(&taken).filter(|(_, taken)| !**taken);
    let free: Vec<u32> = free.map(|(tet, _)| tet).collect();
    match free.len() {
        0 => Err(Fault::NothingLeft {
            tets: mesh.tets.len(),
        }),
        _ => Ok(free),
    }
}
