//! Sections about the body: mesh, materials, supports, loads, initial state and probes.

use sinew_core::Ramp;
use sinew_fem::hyperelastic::Orthotropic;
use sinew_fem::{
    Course, FibreFamily, FromMesh, Law, LoadFacts, LoadKind, LoadSpec, ModelReport, Region,
    RegionFacts,
};
use sinew_mesh::GroupMembers;
use sinew_mesh::structured::Split;

use super::section::PlanSection;
use super::{cutting, tools};
use crate::formula::Formula;
use crate::number::{count, length, short, vector};
use crate::scene::{
    Body, Cutting, Initial, Lips, LoosePieces, MeshChanges, MeshSource, Quantity, Rotation, Way,
};
use crate::simulation::{BodyModel, Probe, SelectedPart};

/// The sections about a body and its probes.
pub(super) fn sections(body: &Body, built: &BodyModel, probes: &[Probe]) -> Vec<PlanSection> {
    let report = built.model.report();
    let (_, parts) = built.mesh.part_of_nodes();
    let regions = body.problem.regions.iter().zip(&report.regions);
    let regions = regions.flat_map(|(region, facts)| material(region, facts));
    let initial = body.initial.iter().map(|initial| start(initial, built));
    vec![
        PlanSection::new("mesh", mesh(body, built, (report, parts))),
        PlanSection::new("where", built.selected.iter().map(selected).collect()),
        PlanSection::new("regions", regions.collect()),
        PlanSection::new("damping", vec![damping(body, report)]),
        PlanSection::new("fixed", supports(body, built, report)),
        PlanSection::new("moves", moves(body, built)),
        PlanSection::new("tools", tools::lines(body, built)),
        PlanSection::new("cutting", cutting::lines(body, built)),
        PlanSection::new("apart", apart(body, parts)),
        PlanSection::new("loads", loads(body, report)),
        PlanSection::new("initial", initial.collect()),
        PlanSection::new("probes", probes.iter().map(probe).collect()),
    ]
}

/// Parts without contact between them: parts of the mesh, and pieces that cuts may separate.
fn apart(body: &Body, parts: usize) -> Vec<String> {
    const TOLD: &str = "where they are in each other a run warns";
    let falls = |cutting: &Cutting| cutting.pieces == LoosePieces::Fall;
    let cutting = body.cutting.as_ref().filter(|cutting| falls(cutting));
    let of_parts = (parts > 1).then(|| format!("{parts} parts: nothing keeps them apart; {TOLD}"));
    let of_pieces = cutting.map(|cutting| match cutting.lips {
        Lips::Contact => format!(
            "pieces that cuts take off: only the faces of their cut keep them apart, while these face each other; {TOLD}"
        ),
        Lips::Free => format!("pieces that cuts take off: nothing keeps them apart; {TOLD}"),
    });
    of_parts.into_iter().chain(of_pieces).collect()
}

fn mesh(body: &Body, built: &BodyModel, (report, parts): (&ModelReport, usize)) -> Vec<String> {
    let mut lines = vec![source(&body.mesh, &body.mesh_changes)];
    lines.extend(changes(&body.mesh_changes));
    lines.push(format!(
        "{} nodes, {} tetrahedra, {} edges, in {}; {} m3, {} kg",
        report.nodes,
        report.tets,
        report.edges,
        count(parts, "part"),
        short(report.volume),
        short(report.mass)
    ));
    lines.push(groups(built));
    lines
}

fn source(mesh: &MeshSource, changes: &MeshChanges) -> String {
    // A scale is there because these lengths are not in metres.
    let unit = if changes.scale.is_some() { "" } else { " m" };
    let name = |split: &Split| match split {
        Split::Kuhn => "kuhn",
        Split::Mirrored => "mirrored",
    };
    match mesh {
        MeshSource::File(path) => path.display().to_string(),
        MeshSource::Cube { cells, edge, split } => {
            let split = name(split);
            format!(
                "cube of {cells} x {cells} x {cells} cells, edge {edge}{unit}, split \"{split}\""
            )
        }
        MeshSource::Block { cells, size, split } => {
            let ([i, j, k], [x, y, z], split) = (cells, size, name(split));
            format!("block of {i} x {j} x {k} cells, {x} x {y} x {z}{unit}, split \"{split}\"")
        }
    }
}

/// The changes of size and orientation; those of linearising are a note of the mesh.
fn changes(changes: &MeshChanges) -> Option<String> {
    let mut parts = Vec::new();
    parts.extend(changes.scale.map(|scale| format!("scaled by {scale}")));
    parts.extend(changes.rotation.map(|Rotation { axis, degrees }| {
        format!(
            "turned by {degrees} degrees about {} through the origin",
            vector(axis)
        )
    }));
    (!parts.is_empty()).then(|| parts.join(", then "))
}

fn groups(built: &BodyModel) -> String {
    let selected = |name: &str| built.selected.iter().any(|part| part.name == name);
    let of_file = built.mesh.groups.iter();
    let of_file = of_file.filter(|group| !selected(&group.name));
    let described = of_file.map(|group| {
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

/// Nodes and size of a part that was selected by its position.
fn selected(part: &SelectedPart) -> String {
    let size = match part.tets {
        Some((tets, volume)) => {
            format!("{}, {} m3", count_tets(tets), short(volume))
        }
        None => format!("{} m2 of the surface", short(part.area)),
    };
    let nodes = count(part.nodes, "node");
    format!("{}: `{}`: {nodes}, {size}", part.by, part.name)
}

fn count_tets(tets: usize) -> String {
    match tets {
        1 => "1 tetrahedron".to_owned(),
        _ => format!("{tets} tetrahedra"),
    }
}

fn material(region: &Region, facts: &RegionFacts) -> Vec<String> {
    let group = match &region.group {
        Some(name) => format!("`{name}`"),
        None => "whole mesh".to_owned(),
    };
    let density = span(facts.density);
    let head = format!("{group}: {} tetrahedra, {density} kg/m3", facts.tets);
    let law = region.law.with_modulus(&span(facts.youngs_modulus));
    let mut lines = vec![format!("{head}, {law}")];
    let FromMesh {
        youngs_modulus,
        density,
    } = &region.from_mesh;
    let by_data = [("E", youngs_modulus), ("density", density)];
    let by_data = by_data.into_iter().filter_map(|(what, name)| {
        let name = name.as_ref()?;
        Some(format!(
            "{what} of each tetrahedron by the mesh's data `{name}`"
        ))
    });
    lines.extend(by_data);
    if region.element.has_patches() {
        lines.push(format!(
            "element {}, in {} patches",
            region.element, facts.patches
        ));
    }
    lines.extend(material_axes(region));
    lines.extend(region.tissue.fibres.iter().map(FibreFamily::to_string));
    lines.extend(memory(region, facts));
    lines.extend(facts.network.map(|network| {
        let share = |modulus: f64| short(modulus / facts.mean_youngs_modulus);
        format!(
            "its springs average to {} E (Voigt), {} to {} E by direction",
            share(network.voigt),
            share(network.softest),
            share(network.stiffest)
        )
    }));
    lines
}

/// The axes of a law that has some, and its constants along them.
fn material_axes(region: &Region) -> Vec<String> {
    let Some(constants) = region.law.orthotropic() else {
        return Vec::new();
    };
    let first = match &region.tissue.axes {
        Some([first, second]) => format!("axes by {first} and {second}"),
        None => "axes of coordinates".to_owned(),
    };
    let three = |numbers: [f64; 3]| numbers.map(short).join(", ");
    let Orthotropic {
        youngs_moduli,
        shear_moduli,
        poissons_ratios,
    } = constants;
    vec![
        first,
        format!(
            "at rest along them: E = {} Pa, G12, G23, G31 = {} Pa, nu12, nu23, nu31 = {}",
            three(youngs_moduli),
            three(shear_moduli),
            three(poissons_ratios)
        ),
    ]
}

/// The least and the largest value of a quantity that may differ between tetrahedra.
fn span(values: [f64; 2]) -> String {
    between(values.map(|value| value.to_string()))
}

fn between([least, largest]: [String; 2]) -> String {
    if least == largest {
        least
    } else {
        format!("{least} to {largest}")
    }
}

/// Relaxation of a region, and the moduli before and after.
fn memory(region: &Region, facts: &RegionFacts) -> Vec<String> {
    let Some(memory) = &region.tissue.memory else {
        return Vec::new();
    };
    let [least, largest] = facts.youngs_modulus.map(|youngs_modulus| {
        let mut law = region.law.clone();
        law.set_youngs_modulus(youngs_modulus);
        region.tissue.moduli(&law)
    });
    let words = |when: usize| {
        let modulus = [&least[when], &largest[when]].map(Law::youngs_modulus);
        let (modulus, ratio) = (
            between(modulus.map(short)),
            short(least[when].poissons_ratio().unwrap_or(f64::NAN)),
        );
        format!("E = {modulus} Pa, nu = {ratio}")
    };
    let [at_once, later] = [0, 1].map(words);
    vec![
        memory.to_string(),
        format!("at small strain {at_once} at once, {later} in the long term"),
    ]
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
    if body.problem.fixed.is_empty() && body.motions.is_empty() {
        return vec![format!(
            "nothing: all {} degrees of freedom move",
            report.mesh_dofs
        )];
    }
    let fixed = body.problem.fixed.iter();
    let fixed = fixed.map(|fixed| format!("{} in {}", fixed.on, axes(fixed.axes)));
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
            "{pinned} fixed components belong to nodes that move in other directions"
        ));
    }
    lines
}

/// The letters of some axes.
fn axes(named: [bool; 3]) -> String {
    let letters = ["x", "y", "z"].into_iter().zip(named);
    let letters: Vec<&str> = letters
        .filter_map(|(axis, named)| named.then_some(axis))
        .collect();
    letters.join(", ")
}

fn moves(body: &Body, built: &BodyModel) -> Vec<String> {
    let facts = built.model.report().moves.iter();
    let moves = body.motions.iter().zip(&built.problem.moves).zip(facts);
    let lines = moves.map(|((motion, moving), facts)| {
        let way = match &motion.way {
            Way::Displacement(displacement, ramp) => {
                format!("to {} m {}", vector(*displacement), ramp.describe())
            }
            Way::Velocity(velocity) => format!("at {} m/s from t = 0", vector(*velocity)),
            Way::Table(path) => format!("by {}{}", path.display(), rows(&moving.courses)),
        };
        format!(
            "`{}` in {}, {}: {way}",
            motion.group,
            axes(motion.axes),
            count(facts.nodes, "node")
        )
    });
    lines.collect()
}

/// The rows of a table and the time they cover.
fn rows(courses: &[Course]) -> String {
    let times = courses.iter().find_map(|course| match &course.ramp {
        Ramp::Table { times, .. } => Some((times.len(), times.first()?, times.last()?)),
        _ => None,
    });
    match times {
        Some((rows, from, to)) => format!(", {} from {from} s to {to} s", count(rows, "row")),
        None => ", which stays at rest".to_owned(),
    }
}

fn loads(body: &Body, report: &ModelReport) -> Vec<String> {
    let supports = match body.motions.is_empty() {
        true => "fixed nodes",
        false => "fixed or moved nodes",
    };
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
            format!("{name}{}: {}", described(load), resultant(facts, supports))
        })
        .collect();
    if let (Some(gravity), Some(facts)) = (body.problem.gravity, &report.gravity) {
        lines.push(format!(
            "gravity {} m/s2: {}",
            vector(gravity),
            resultant(facts, supports)
        ));
    }
    lines
}

fn described(load: &LoadSpec) -> String {
    let kind = match load.kind {
        LoadKind::Traction(traction) => format!("traction {} Pa", vector(traction)),
        LoadKind::Pressure(pressure) => format!("pressure {pressure} Pa"),
        LoadKind::FollowingPressure(pressure) => {
            format!("pressure {pressure} Pa, following the surface,")
        }
        LoadKind::Force(force) => format!("force {} N", vector(force)),
    };
    let ramp = load.ramp.describe();
    format!("{kind} on {} {ramp}", load.on)
}

/// Resultants of a load, with the name of the nodes that are not free.
fn resultant(facts: &LoadFacts, supports: &str) -> String {
    let lost: [f64; 3] = std::array::from_fn(|i| facts.asked[i] - facts.acting[i]);
    let (asked, acting, lost) = (length(facts.asked), length(facts.acting), length(lost));
    if lost <= 1e-9 * asked.max(acting) {
        return format!("{} N act", short(acting));
    }
    format!(
        "{} N asked, {} N act, {} N fall on {}",
        short(asked),
        short(acting),
        short(lost),
        supports
    )
}

fn start(initial: &Initial, built: &BodyModel) -> String {
    let (what, group) = match initial {
        Initial::Displacement { group, value } => {
            (format!("displacement {} m", formulas(value)), group)
        }
        Initial::Velocity { group, value } => (format!("velocity {} m/s", formulas(value)), group),
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
    match built.cells_of(group.as_deref()) {
        Ok((cells, nodes)) => format!("{what} of {of}: {} of {nodes} nodes move", cells.len()),
        Err(error) => error.to_string(),
    }
}

fn formulas([x, y, z]: &[Formula; 3]) -> String {
    format!("({x}, {y}, {z})")
}

fn probe(probe: &Probe) -> String {
    let held = match &probe.nodes[..] {
        [node] => match node.dofs.iter().filter(|dof| dof.is_none()).count() {
            0 => "",
            _ if node.courses.iter().any(|courses| !courses.is_empty()) => ", moved",
            3 => ", fixed in x, y and z",
            _ => ", fixed in some directions",
        },
        _ => "",
    };
    let quantity = match probe.quantity {
        Quantity::Displacement => "",
        Quantity::Velocity => "velocity, ",
        Quantity::Stress => "stress, ",
    };
    format!("`{}`: {quantity}{}{held}", probe.name, probe.place)
}
