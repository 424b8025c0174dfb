//! Groups of a mesh file that the scene does not use, and regions without elements.

use sinew_fem::{LoadKind, On};
use sinew_mesh::Group;

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
    let groups = &built.mesh.groups;
    let used = used(body).into_iter().filter_map(|(name, dim)| {
        let group = match dim {
            Some(dim) => built.mesh.group_for(name, dim),
            None => built.mesh.group(name),
        };
        group.ok().map(std::ptr::from_ref)
    });
    let used: Vec<*const Group> = used.collect();
    let unused = groups
        .iter()
        .filter(|group| !used.contains(&std::ptr::from_ref(*group)))
        .filter(|group| !BUILT_IN.contains(&group.name.as_str()))
        .filter(|group| built.selected.iter().all(|part| part.name != group.name));
    let unused: Vec<String> = unused
        .map(|group| {
            let same = groups.iter().filter(|other| other.name == group.name);
            match same.count() {
                1 => format!("`{}`", group.name),
                _ => format!("`{}` of dimension {}", group.name, group.dim),
            }
        })
        .collect();
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

/// The groups that tables of the scene name, each with the dimension that is used if several groups have this name.
fn used(body: &Body) -> Vec<(&str, Option<u8>)> {
    let problem = &body.problem;
    let supports = problem.fixed.iter().map(|fixed| &fixed.on);
    let on = supports.map(|on| (on, None));
    let loads = problem.loads.iter();
    let loads = loads.map(|load| match load.kind {
        LoadKind::Force(_) => (&load.on, None),
        _ => (&load.on, Some(2)),
    });
    let on = on.chain(loads).filter_map(|(on, dim)| match on {
        On::Group(name) => Some((name.as_str(), dim)),
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
    let of_regions = regions.map(|name| (name, Some(3)));
    let others = motions.chain(tools).chain(initial).chain(probes);
    let others = others.map(|name| (name, None));
    on.chain(of_regions).chain(others).collect()
}
