//! The body: mesh, materials, supports, loads, start and probes.

use sinew_fem::{Law, LoadFacts, LoadKind, LoadSpec, ModelReport, Region, RegionFacts, SpringRule};
use sinew_mesh::structured::Split;
use sinew_mesh::{GroupMembers, TetMesh};

use super::Plan;
use super::number::{length, short, vector};
use crate::scene::{Body, Initial, MeshSource};
use crate::simulation::{BodyModel, Probe, cells_of};

pub(super) fn describe(body: &Body, built: &BodyModel, probes: &[Probe], plan: &mut Plan) {
    let report = built.model.report();
    plan.add("mesh", mesh(body, built, report));
    let regions = body.problem.regions.iter().zip(&report.regions);
    plan.add(
        "regions",
        regions
            .flat_map(|(region, facts)| material(region, facts))
            .collect(),
    );
    plan.add("damping", vec![damping(body, report)]);
    plan.add("fixed", supports(body, built, report));
    plan.add("loads", loads(body, report));
    plan.add(
        "initial",
        body.initial
            .iter()
            .map(|initial| start(initial, built))
            .collect(),
    );
    plan.add("probes", probes.iter().map(probe).collect());
    plan.warnings
        .extend(built.mesh_warnings.iter().chain(&report.notes).cloned());
}

fn mesh(body: &Body, built: &BodyModel, report: &ModelReport) -> Vec<String> {
    let source = match &body.mesh {
        MeshSource::File(path) => path.display().to_string(),
        MeshSource::Cube { cells, edge, split } => {
            let split = match split {
                Split::Kuhn => "kuhn",
                Split::Mirrored => "mirrored",
            };
            format!("cube of {cells} x {cells} x {cells} cells, edge {edge} m, split \"{split}\"")
        }
    };
    vec![
        source,
        format!(
            "{} nodes, {} tetrahedra, {} edges; {} m3, {} kg",
            report.nodes,
            report.tets,
            report.edges,
            short(report.volume),
            short(report.mass)
        ),
        groups(&built.mesh),
    ]
}

fn groups(mesh: &TetMesh) -> String {
    let described = mesh.groups.iter().map(|group| {
        let members = match group.members {
            GroupMembers::Tets(_) => "tetrahedra",
            GroupMembers::Triangles(_) => "triangles",
            GroupMembers::Lines(_) => "lines",
            GroupMembers::Nodes(_) => "nodes",
        };
        format!("`{}` ({} {members})", group.name, group.members.len())
    });
    let described: Vec<String> = described.collect();
    match described.len() {
        0 => "no groups".to_owned(),
        _ => format!("groups {}", described.join(", ")),
    }
}

fn material(region: &Region, facts: &RegionFacts) -> Vec<String> {
    let group = match &region.group {
        Some(name) => format!("`{name}`"),
        None => "whole mesh".to_owned(),
    };
    let head = format!(
        "{group}: {} tetrahedra, {} kg/m3",
        facts.tets, region.density
    );
    match region.law {
        Law::Linear {
            youngs_modulus,
            poissons_ratio,
        } => vec![format!(
            "{head}, linear elastic, E = {youngs_modulus} Pa, nu = {poissons_ratio}"
        )],
        Law::Springs {
            youngs_modulus,
            rule,
            calibrate,
            ..
        } => {
            let rule = match rule {
                SpringRule::Lloyd => "lloyd",
                SpringRule::VanGelder => "van-gelder",
            };
            let scaled = if calibrate {
                "calibrated"
            } else {
                "not calibrated"
            };
            let mut lines = vec![format!(
                "{head}, springs \"{rule}\" {scaled}, E = {youngs_modulus} Pa, nu = 1/4 by nature"
            )];
            lines.extend(facts.network.map(|network| {
                let share = |modulus: f64| short(modulus / youngs_modulus);
                format!(
                    "its springs average to {} E (Voigt), {} to {} E by direction",
                    share(network.voigt),
                    share(network.softest),
                    share(network.stiffest)
                )
            }));
            lines
        }
    }
}

fn damping(body: &Body, report: &ModelReport) -> String {
    let rayleigh = body.problem.damping;
    let mut parts = Vec::new();
    if rayleigh.mass > 0.0 {
        parts.push(format!("{} 1/s times M, no matrix", rayleigh.mass));
    }
    if rayleigh.stiffness > 0.0 {
        parts.push(format!(
            "{} s times K, in the product with K",
            rayleigh.stiffness
        ));
    }
    if report.damping_matrix {
        parts.push("dashpots along springs, a matrix of their own".to_owned());
    }
    match parts.len() {
        0 => "none, left out of every step".to_owned(),
        _ => parts.join("; "),
    }
}

fn supports(body: &Body, built: &BodyModel, report: &ModelReport) -> Vec<String> {
    if body.problem.fixed.is_empty() {
        return vec![format!(
            "nothing: all {} degrees of freedom move",
            report.mesh_dofs
        )];
    }
    let fixed = body.problem.fixed.iter().map(|fixed| {
        let axes = ["x", "y", "z"]
            .iter()
            .zip(fixed.axes)
            .filter(|(_, held)| *held);
        let axes: Vec<&str> = axes.map(|(axis, _)| *axis).collect();
        format!("`{}` in {}", fixed.group, axes.join(", "))
    });
    let mut lines: Vec<String> = fixed.collect();
    let cells = built.model.nodes().len();
    lines.push(format!(
        "{} -> {} degrees of freedom; {} of {} nodes move, the others are removed",
        report.mesh_dofs, report.free_dofs, cells, report.nodes
    ));
    let pinned = built
        .model
        .pinned()
        .iter()
        .filter(|pinned| **pinned)
        .count();
    if pinned > 0 {
        lines.push(format!(
            "{pinned} held components stay beside moving ones of their node"
        ));
    }
    lines
}

fn loads(body: &Body, report: &ModelReport) -> Vec<String> {
    let named = body
        .problem
        .loads
        .iter()
        .zip(&body.load_names)
        .zip(&report.loads);
    let mut lines: Vec<String> = named
        .map(|((load, name), facts)| {
            let name = name
                .as_ref()
                .map_or_else(String::new, |name| format!("\"{name}\", "));
            format!("{name}{}: {}", described(load), resultant(facts))
        })
        .collect();
    if let (Some(gravity), Some(facts)) = (body.problem.gravity, &report.gravity) {
        lines.push(format!(
            "gravity {} m/s2: {}",
            vector(gravity),
            resultant(facts)
        ));
    }
    lines
}

fn described(load: &LoadSpec) -> String {
    use sinew_core::Ramp;
    let kind = match load.kind {
        LoadKind::Traction(traction) => format!("traction {} Pa", vector(traction)),
        LoadKind::Pressure(pressure) => format!("pressure {pressure} Pa"),
        LoadKind::Force(force) => format!("force {} N", vector(force)),
    };
    let ramp = match &load.ramp {
        Ramp::Step => "from t = 0".to_owned(),
        Ramp::Sin2 { rise } => format!("rising for {rise} s"),
        Ramp::Pulse { from, to } => format!("from {from} s to {to} s"),
        Ramp::Table { times, .. } => format!("by a table of {} points", times.len()),
    };
    format!("{kind} on `{}` {ramp}", load.group)
}

fn resultant(facts: &LoadFacts) -> String {
    let lost: [f64; 3] = std::array::from_fn(|i| facts.asked[i] - facts.acting[i]);
    let (asked, acting, lost) = (length(facts.asked), length(facts.acting), length(lost));
    if lost <= 1e-9 * asked.max(acting) {
        return format!("{} N act", short(acting));
    }
    format!(
        "{} N asked, {} N act, {} N fall on fixed nodes",
        short(asked),
        short(acting),
        short(lost)
    )
}

fn start(initial: &Initial, built: &BodyModel) -> String {
    let (what, group) = match initial {
        Initial::Displacement { group, value } => {
            (format!("displacement {} m", vector(*value)), group)
        }
        Initial::Velocity { group, value } => (format!("velocity {} m/s", vector(*value)), group),
        Initial::Stretch {
            group,
            strain,
            origin,
        } => (
            format!("stretch {} about {} m", vector(*strain), vector(*origin)),
            group,
        ),
        Initial::Static { loads } => {
            return format!("at rest under {}, solved once", loads.join(", "));
        }
    };
    let of = group
        .as_ref()
        .map_or_else(|| "the whole body".to_owned(), |name| format!("`{name}`"));
    match cells_of(group.as_deref(), built) {
        Ok((cells, nodes)) => format!("{what} of {of}: {} of {nodes} nodes move", cells.len()),
        Err(error) => error.to_string(),
    }
}

fn probe(probe: &Probe) -> String {
    let held = match probe.dofs.iter().filter(|dof| dof.is_none()).count() {
        0 => "",
        3 => ", held in x, y and z",
        _ => ", held in some directions",
    };
    match &probe.node {
        Some(node) => format!(
            "`{}`: node {}, {} m from the point{held}",
            probe.name,
            node.tag,
            short(node.distance)
        ),
        None => format!("`{}`", probe.name),
    }
}
