//! The text of a first scene.

use std::fmt::Write as _;

use sinew_mesh::{Group, GroupMembers, TetMesh};

use super::data;
use super::file::MeshFile;
use super::force::{self, DENSITY, POISSONS_RATIO, YOUNGS_MODULUS};
use super::parts::{Part, Parts};
use super::quoted::quoted;
use crate::number::short;

/// Number of tetrahedra beyond which a factorisation takes minutes, and explicit steps are proposed.
const MANY: usize = 100_000;

/// The scene for a mesh in metres.
pub(super) fn scene(mesh: &TetMesh, file: &MeshFile<'_>, parts: &Parts) -> String {
    let title = file.path.file_stem().unwrap_or_default().to_string_lossy();
    let mut text = heading(mesh, file.unit.name);
    put(&mut text, &format!("title = {}\n", quoted(&title)));
    put(&mut text, &mesh_table(file));
    put(&mut text, &region_tables(mesh, parts));
    put(
        &mut text,
        &format!("[damping]\n{}", row("mass = 10.0", "1/s")),
    );
    let held = part(&parts.held);
    let head = row("[[fixed]]", "proposed: change it");
    put(&mut text, &format!("{head}{held}"));
    put(&mut text, &load_table(mesh, parts));
    put(&mut text, &run_table(mesh));
    let [x, y, z] = parts.highest.map(short);
    let head = row("[[probe]]", "the highest node");
    let point = row(&format!("point = [{x}, {y}, {z}]"), "m");
    put(&mut text, &format!("{head}name = \"highest\"\n{point}"));
    text.trim_end().to_owned() + "\n"
}

/// Adds a paragraph.
fn put(text: &mut String, paragraph: &str) {
    text.push_str(paragraph);
    text.push('\n');
}

fn heading(mesh: &TetMesh, unit: &str) -> String {
    let (low, high) = mesh.bounding_box();
    let [x, y, z] = std::array::from_fn(|axis| short(high[axis] - low[axis]));
    let mut text = String::from(
        "# A first scene for this mesh. It runs as it is; material, support and load are proposals.\n",
    );
    let volume: f64 = mesh.signed_volumes().iter().sum();
    // A String takes all that is written to it.
    let _ = writeln!(
        text,
        "# {} nodes, {} tetrahedra, {} m3; {x} x {y} x {z} m, if the file is in {}.",
        mesh.points.len(),
        mesh.tets.len(),
        short(volume),
        unit
    );
    match mesh.groups.is_empty() {
        true => text.push_str("# The mesh has no groups: `where` chooses parts by their place.\n"),
        false => text.push_str("# Its groups:\n"),
    }
    for group in &mesh.groups {
        let _ = writeln!(text, "#   {}: {}", group.name, size(mesh, group));
    }
    text.push_str(&data::heading(mesh));
    text
}

/// The members of a group and their length, area or volume.
fn size(mesh: &TetMesh, group: &Group) -> String {
    let count = group.members.len();
    match &group.members {
        GroupMembers::Tets(tets) => {
            let volume: f64 = tets.iter().map(|tet| mesh.volume(*tet as usize)).sum();
            format!("{count} tetrahedra, {} m3", short(volume))
        }
        GroupMembers::Triangles(triangles) => {
            let area: f64 = triangles.iter().map(|triangle| mesh.area(*triangle)).sum();
            format!("{count} triangles, {} m2", short(area))
        }
        GroupMembers::Lines(_) => format!("{count} lines"),
        GroupMembers::Nodes(_) => format!("{count} nodes"),
    }
}

fn mesh_table(file: &MeshFile<'_>) -> String {
    let unit = &file.unit;
    let path = quoted(&file.path.to_string_lossy());
    let mut table = format!("[mesh]\nfile = {path}\n");
    if !file.is_linear {
        table.push_str(&row(
            "order = \"linear\"",
            "the file's cells have more nodes than corners, which alone are used",
        ));
    }
    if unit.metres != 1.0 {
        let question = format!("guessed from the extent: is the file in {}?", unit.name);
        table.push_str(&row(&format!("scale = {:?}", unit.metres), &question));
    }
    table
}

fn region_tables(mesh: &TetMesh, parts: &Parts) -> String {
    let stiffness = match data::stiffness(mesh) {
        Some(stiffness) => row(
            &format!("youngs_modulus = {{ data = {} }}", quoted(&stiffness.name)),
            &format!("proposed by its name: are these Pa, {}?", stiffness.reach),
        ),
        None => row(&format!("youngs_modulus = {YOUNGS_MODULUS:?}"), "Pa"),
    };
    let material = [
        row(
            &format!("density = {DENSITY:?}"),
            "kg/m3; the whole material is a proposal",
        ),
        "model = \"linear\"\n".to_owned(),
        stiffness,
        format!("poissons_ratio = {POISSONS_RATIO:?}\n"),
    ];
    let material = material.concat();
    let Some(groups) = &parts.regions else {
        return format!("{}{material}", row("[[region]]", "the whole body"));
    };
    let groups = groups
        .iter()
        .map(|name| format!("group = {}\n", quoted(name)));
    let rest = parts
        .rest
        .then(|| row("where = \"rest\"", "in none of the groups"));
    let places = groups.chain(rest);
    let tables: Vec<String> = places
        .map(|place| format!("[[region]]\n{place}{material}"))
        .collect();
    tables.join("\n")
}

fn load_table(mesh: &TetMesh, parts: &Parts) -> String {
    let stiffness = data::stiffness(mesh).map(|stiffness| stiffness.name);
    let force = force::proposed(mesh, parts, stiffness.as_deref());
    let force = row(
        &format!("force = [0.0, 0.0, {:?}]", -force),
        "N in all, which moves the body by some 2 % of its length",
    );
    let head = row("[[load]]", "proposed: change it");
    let on = part(&parts.loaded);
    format!("{head}name = \"push\"\n{on}{force}ramp = {{ kind = \"sin2\", rise = 0.1 }}\n")
}

/// A line of TOML with a comment.
fn row(toml: &str, comment: &str) -> String {
    format!("{toml:<29} # {comment}\n")
}

fn run_table(mesh: &TetMesh) -> String {
    let duration = row("duration = 1.0", "s");
    let method = match mesh.tets.len() <= MANY {
        true => [
            row(
                "integrator = \"newmark\"",
                "stable at any step; `sinew plan --tolerance 1e-2` finds cheaper ones",
            ),
            row("dt = 0.01", "s"),
        ],
        false => [
            "integrator = \"central-difference\"\n".to_owned(),
            row("dt = \"auto\"", "the longest that is stable"),
        ],
    };
    format!("[run]\n{duration}{}", method.concat())
}

fn part(part: &Part) -> String {
    match part {
        Part::Group(name) => format!("group = {}\n", quoted(name)),
        Part::Below(z) => row(&format!("where = {{ below = {{ z = {z:?} }} }}"), "m"),
        Part::Above(z) => row(&format!("where = {{ above = {{ z = {z:?} }} }}"), "m"),
    }
}
