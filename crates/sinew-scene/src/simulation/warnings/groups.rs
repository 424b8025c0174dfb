//! Groups of a mesh file that the scene does not use, and regions without elements.

use sinew_fem::On;

use super::{Warning, WarningKind};
use crate::scene::{Body, Initial, MeshSource, ProbeAt};
use crate::simulation::model::BodyModel;

/// The groups of the structured cubes, of which few scenes need all.
const BUILT_IN: [&str; 4] = ["tissue", "sides", "top", "bottom"];

pub(super) fn warnings(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = unused(body, built).into_iter().collect();
    let facts = built.model.report().regions.iter().enumerate();
    let empty = facts.filter(|(_, facts)| facts.tets == 0);
    warnings.extend(empty.map(|(index, _)| {
        let what = format!("[[region]] {} has no tetrahedra", index + 1);
        Warning::new(
            WarningKind::EmptyRegion,
            what,
            "take it out, or mend its group",
        )
    }));
    warnings
}

fn unused(body: &Body, built: &BodyModel) -> Option<Warning> {
    let MeshSource::File(_) = &body.mesh else {
        return None;
    };
    let used = used(body);
    let of_file = built.mesh.groups.iter().map(|group| group.name.as_str());
    let unused = of_file
        .filter(|name| !used.contains(name) && !BUILT_IN.contains(name))
        .filter(|name| built.selected.iter().all(|part| part.name != *name));
    let unused: Vec<String> = unused.map(|name| format!("`{name}`")).collect();
    if unused.is_empty() {
        return None;
    }
    let what = format!(
        "groups of the mesh that the scene does not use: {}",
        unused.join(", ")
    );
    let numbers = [("groups", unused.len() as f64)];
    Some(Warning::new(WarningKind::UnusedGroups, what, "").with(&numbers))
}

/// The groups that tables of the scene name.
fn used(body: &Body) -> Vec<&str> {
    let problem = &body.problem;
    let supports = problem.fixed.iter().map(|fixed| &fixed.on);
    let loads = problem.loads.iter().map(|load| &load.on);
    let on = supports.chain(loads).filter_map(|on| match on {
        On::Group(name) => Some(name.as_str()),
        On::Nodes(_) | On::Triangles(_) => None,
    });
    let regions = problem.regions.iter();
    let regions = regions.filter_map(|region| region.group.as_deref());
    let motions = body.motions.iter().map(|motion| motion.group.as_str());
    let tools = body.tools.iter();
    let tools = tools.filter_map(|tool| tool.touches.as_deref());
    let initial = body.initial.iter().filter_map(|initial| match initial {
        Initial::Displacement { group, .. }
        | Initial::Velocity { group, .. }
        | Initial::Stretch { group, .. } => group.as_deref(),
        Initial::Static { .. } => None,
    });
    let probes = body.probes.iter().filter_map(|probe| match &probe.at {
        ProbeAt::Mean(group) => Some(group.as_str()),
        ProbeAt::Point(_) => None,
    });
    let on = on.chain(regions).chain(motions).chain(tools).chain(initial);
    on.chain(probes).collect()
}
