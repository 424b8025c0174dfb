//! `sinew mesh info | check | convert | refine`.

mod data;
mod labels;

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand, ValueEnum};
use serde_json::json;
use sinew_mesh::info::MeshInfo;
use sinew_mesh::vtu::{VtuEncoding, write_vtu};
use sinew_mesh::{
    Extreme, Finding, Mesh, MeshCheck, MshEncoding, MshVersion, Places, WriteMshError,
    read_mesh_file, write_msh,
};
use sinew_scene::output::{Destination, Voice, complain, say};

use super::Failure;
use super::own_file::Force;

/// Commands for mesh files.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Summarise a mesh file: .msh, .vtu, .vtk, .mesh of Medit or .inp of Abaqus.
    Info {
        /// The mesh file.
        file: PathBuf,
        /// Print one JSON object.
        #[arg(long)]
        json: bool,
    },
    /// Look for defects that make a simulation fail or mislead; exit code 1 if there are any.
    Check {
        /// The mesh file, of a format that info reads.
        file: PathBuf,
        /// Print one JSON object.
        #[arg(long)]
        json: bool,
        /// Repair before the check, and write the result to another file; may be given several times.
        #[arg(long, value_name = "WHAT")]
        fix: Vec<Fix>,
        /// The file for the repaired mesh, - for standard output [default: FILE with .fixed.msh]
        #[arg(long, value_name = "OUT", requires = "fix")]
        out: Option<PathBuf>,
        #[command(flatten)]
        force: Force,
    },
    /// Write a mesh file in another version, encoding or format. The extension of OUTPUT, .msh or
    /// .vtu, selects the format; a device, a pipe or - for standard output gets .msh.
    Convert {
        /// The mesh file: .msh, .vtu, .vtk, .mesh of Medit or .inp of Abaqus.
        input: PathBuf,
        /// The file to write.
        output: PathBuf,
        /// Make a group of each value of data that have one whole number for each cell: cells with the value 2 of `labels` become
        /// the group `labels_2`. May be given several times.
        #[arg(long, value_name = "NAME")]
        groups_from: Vec<String>,
        #[command(flatten)]
        style: Style,
        #[command(flatten)]
        force: Force,
    },
    /// Write a mesh with each tetrahedron cut into eight, all groups kept: compare the answers of both to see whether
    /// the mesh is fine enough. Formats are those of convert.
    Refine {
        /// The mesh file, of a format that convert reads.
        input: PathBuf,
        /// The file to write.
        output: PathBuf,
        #[command(flatten)]
        style: Style,
        #[command(flatten)]
        force: Force,
    },
}

/// The version and the encoding of a written mesh.
#[derive(Args, Clone, Copy)]
pub(crate) struct Style {
    /// Version of a .msh file.
    #[arg(long, default_value = "4.1")]
    version: Version,
    /// Take cells of second and higher order by their corners.
    #[arg(long)]
    order: Option<Order>,
    /// Write numbers as text.
    #[arg(long, conflicts_with = "binary")]
    ascii: bool,
    /// Write numbers as bytes [default for .vtu; .msh is text by default]
    #[arg(long)]
    binary: bool,
}

/// A repair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Fix {
    /// Turn inverted tetrahedra.
    Orient,
    /// Remove nodes that belong to no cell.
    DropOrphans,
    /// Merge cells with the same nodes.
    MergeDuplicates,
    /// Merge nodes of different parts if faces of these parts coincide; cuts, which lie within a part, stay.
    MergeNodes,
}

/// Order of the cells of a written mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Order {
    /// Straight edges, and nodes at corners only.
    Linear,
}

/// Version of a .msh file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Version {
    /// 2.2
    #[value(name = "2.2")]
    V22,
    /// 4.1
    #[value(name = "4.1")]
    V41,
}

pub(crate) fn run(command: &Command) -> Result<(), Failure> {
    match command {
        Command::Info { file, json } => info(file, *json),
        Command::Check {
            file,
            json,
            fix,
            out,
            force,
        } => check(file, *json, fix, (out.as_deref(), *force)),
        Command::Convert {
            input,
            output,
            groups_from,
            style,
            force,
        } => convert(input, (output, *force), groups_from, *style),
        Command::Refine {
            input,
            output,
            style,
            force,
        } => refine(input, (output, *force), *style),
    }
}

fn read(file: &Path) -> Result<Mesh, Failure> {
    Ok(read_mesh_file(file)?)
}

/// Reads a mesh in the requested order of cells.
fn read_in(file: &Path, style: Style) -> Result<Mesh, Failure> {
    let mut mesh = read(file)?;
    if style.order == Some(Order::Linear) {
        let _ = mesh.linearise();
    }
    Ok(mesh)
}

fn info(file: &Path, json: bool) -> Result<(), Failure> {
    let info = MeshInfo::of(&read(file)?);
    if json {
        return Ok(say(&info.to_json())?);
    }
    let [low, high] = info.bbox;
    let cells: Vec<String> = info
        .cells
        .iter()
        .map(|(kind, count)| format!("{count} {kind}"))
        .collect();
    say(&format!("{}", file.display()))?;
    say(&format!(
        "points   {}, from {low:?} to {high:?}",
        info.num_points
    ))?;
    say(&format!("cells    {}", cells.join(", ")))?;
    say(&format!("volume   {:.6e} in tetrahedra", info.tet_volume))?;
    for group in &info.physical {
        let cells: Vec<String> = group
            .cells
            .iter()
            .map(|(kind, count)| format!("{count} {kind}"))
            .collect();
        let (dim, tag) = (group.dim, group.tag);
        // Scenes call a group without a name so.
        let unnamed = format!("{dim}:{tag}");
        let name = if group.name.is_empty() {
            &unnamed
        } else {
            &group.name
        };
        say(&format!(
            "group    `{name}` (dimension {dim}, tag {tag}): {}",
            cells.join(", ")
        ))?;
    }
    for line in data::lines(&info.data) {
        say(&line)?;
    }
    for (count, what) in [
        (
            info.points_not_in_3d_cells,
            "points in no cell of three dimensions",
        ),
        (
            info.duplicate_3d_cells,
            "cells with the nodes of an earlier one",
        ),
        (info.tets_inverted, "inverted tetrahedra"),
        (info.tets_degenerate, "flat tetrahedra"),
    ] {
        if count > 0 {
            say(&format!(
                "note     {count} {what}; `sinew mesh check` names them"
            ))?;
        }
    }
    for warning in &info.warnings {
        say(&format!("warning  {warning}"))?;
    }
    Ok(())
}

fn check(
    file: &Path,
    json: bool,
    fixes: &[Fix],
    (out, force): (Option<&Path>, Force),
) -> Result<(), Failure> {
    let default = file.with_extension("fixed.msh");
    let path = out.unwrap_or(&default);
    let destination = match fixes {
        [] => None,
        _ => Some(Destination::new(path, &[file.to_owned()])?),
    };
    let voice = destination
        .as_ref()
        .map_or(Voice::StandardOutput, Voice::apart_from);
    if json && voice == Voice::StandardError {
        return Err(Failure::SharedOutput {
            out: path.to_owned(),
        });
    }
    let mut mesh = read(file)?;
    let mut fixed = Vec::new();
    for fix in fixes {
        let (count, what) = match fix {
            Fix::Orient => (mesh.orient(), "tetrahedra turned"),
            Fix::DropOrphans => (mesh.drop_orphans(), "nodes dropped"),
            Fix::MergeDuplicates => (mesh.merge_duplicates(), "cells merged into others"),
            Fix::MergeNodes => (
                mesh.merge_nodes(),
                "nodes of parts that touch merged into others",
            ),
        };
        fixed.push((count, what));
    }
    let written = destination.is_some().then_some(path);
    if let Some(destination) = destination {
        let mut bytes = Vec::new();
        write_msh(&mesh, MshVersion::V41, MshEncoding::Text, &mut bytes)
            .map_err(|source| cannot_write_msh(path, source))?;
        // A reader that closed its pipe is no error, and the findings are still reported.
        let _ = force.write(destination, &bytes)?;
    }
    let check = mesh.check();
    let data = MeshInfo::of(&mesh).data;
    if json {
        let mut findings = as_json(&check, &fixed, written);
        findings["data"] = data::as_json(&data);
        say(&findings.to_string())?;
    } else {
        for (count, what) in &fixed {
            voice.say(&format!("fixed    {count} {what}"))?;
        }
        if let Some(path) = written {
            voice.say(&format!("written  {}", path.display()))?;
        }
        report(&check, voice)?;
        for line in data::lines(&data) {
            voice.say(&line)?;
        }
    }
    if check.is_clean() {
        Ok(())
    } else {
        Err(Failure::Findings)
    }
}

fn report(check: &MeshCheck, voice: Voice) -> Result<(), Failure> {
    voice.say(&format!(
        "checked  {} tetrahedra in {} part(s)",
        check.tets, check.part_count
    ))?;
    if check.part_count > 1 {
        for part in &check.parts {
            voice.say(&format!("part     {part}"))?;
        }
    }
    if let Some(extreme) = &check.least_dihedral {
        let (value, tag) = (extreme.value, extreme.element_tag);
        voice.say(&format!(
            "angle    least between two faces {value:.3} degrees, in tetrahedron {tag}"
        ))?;
    }
    if let Some(extreme) = &check.least_radius_ratio {
        let (value, tag) = (extreme.value, extreme.element_tag);
        voice.say(&format!(
            "shape    least radius ratio {value:.4}, in tetrahedron {tag}"
        ))?;
    }
    if let Some(edges) = &check.edges {
        voice.say(&format!(
            "edges    from {:.4e} to {:.4e}, {:.4e} in the mean",
            edges.shortest, edges.longest, edges.mean
        ))?;
    }
    for face in &check.first_non_manifold {
        voice.say(&format!(
            "face     of nodes {:?} in tetrahedra {:?}",
            face.node_tags, face.element_tags
        ))?;
    }
    for problem in check.problems() {
        voice.say(&format!("problem  {problem}"))?;
    }
    if check.is_clean() {
        voice.say("no problem found")?;
    }
    Ok(())
}

fn as_json(
    check: &MeshCheck,
    fixed: &[(usize, &str)],
    written: Option<&Path>,
) -> serde_json::Value {
    let finding =
        |finding: &Finding| json!({ "total": finding.total, "first_tags": finding.first_tags });
    let places = |places: &Places| json!({ "total": places.total, "first": places.first });
    let extreme = |extreme: &Option<Extreme>| {
        extreme.map(|Extreme { value, element_tag }| json!({ "value": value, "tag": element_tag }))
    };
    let parts: Vec<_> = check
        .parts
        .iter()
        .map(|part| json!({ "cells": part.cells, "first_tag": part.first_tag, "size": part.size }))
        .collect();
    let faces: Vec<_> = check
        .first_non_manifold
        .iter()
        .map(|face| json!({ "nodes": face.node_tags, "tets": face.element_tags }))
        .collect();
    let empty: Vec<_> = check
        .empty_groups
        .iter()
        .map(|(dim, tag, name)| json!({ "dim": dim, "tag": tag, "name": name }))
        .collect();
    let fixed: Vec<_> = fixed
        .iter()
        .map(|(count, what)| json!({ "count": count, "what": what }))
        .collect();
    json!({
        "clean": check.is_clean(),
        "tets": check.tets,
        "inverted": finding(&check.inverted),
        "flat": finding(&check.flat),
        "slivers": finding(&check.slivers),
        "repeated_nodes": finding(&check.repeated_nodes),
        "duplicates": finding(&check.duplicates),
        "orphans": finding(&check.orphans),
        "outside_volume": finding(&check.outside_volume),
        "part_count": check.part_count,
        "parts": parts,
        "parts_apart": check.joints.parts_apart,
        "touching": places(&check.joints.touching),
        "touching_partly": places(&check.joints.touching_partly),
        "mergeable_nodes": check.joints.mergeable,
        "mismatched": places(&check.joints.mismatched),
        "hanging_nodes": places(&check.joints.hanging),
        "hinges": places(&check.joints.hinges),
        "hinged_blocks": check.joints.hinged_blocks,
        "tangled": places(&check.joints.tangled),
        "non_manifold_faces": check.non_manifold_faces,
        "first_non_manifold": faces,
        "empty_groups": empty,
        "shortest_edge": check.edges.as_ref().map(|edges| edges.shortest),
        "longest_edge": check.edges.as_ref().map(|edges| edges.longest),
        "mean_edge": check.edges.as_ref().map(|edges| edges.mean),
        "least_dihedral_deg": extreme(&check.least_dihedral),
        "least_radius_ratio": extreme(&check.least_radius_ratio),
        "unit": check.unit,
        "problems": check.problems(),
        "fixed": fixed,
        "written": written.map(|path| path.display().to_string()),
    })
}

fn convert(
    input: &Path,
    output: (&Path, Force),
    groups_from: &[String],
    style: Style,
) -> Result<(), Failure> {
    let output = MeshOutput::new(input, output, style)?;
    let mut mesh = read_in(input, style)?;
    for warning in &mesh.warnings {
        complain(&format!("warning: {}: {warning}", input.display()));
    }
    let facts = labels::into_groups(&mut mesh, input, groups_from)?;
    output.write(&mesh, &facts)
}

fn refine(input: &Path, output: (&Path, Force), style: Style) -> Result<(), Failure> {
    let output = MeshOutput::new(input, output, style)?;
    let mesh = read_in(input, style)?;
    let coarse = mesh.to_tet_mesh().map_err(|source| Failure::Tetrahedra {
        mesh: input.to_owned(),
        source,
    })?;
    let fine = coarse.refined().map_err(|source| Failure::Refine {
        path: input.to_owned(),
        source,
    })?;
    let warnings = mesh.warnings.iter().map(ToString::to_string);
    for warning in warnings.chain(fine.notes.iter().cloned()) {
        complain(&format!("warning: {}: {warning}", input.display()));
    }
    let growth = format!(
        "{} tetrahedra (before: {}), {} nodes (before: {}); ",
        fine.tets.len(),
        coarse.tets.len(),
        fine.points.len(),
        coarse.points.len()
    );
    output.write(&fine.to_mesh(), &growth)
}

/// A file for a mesh, checked before the work begins.
struct MeshOutput<'a> {
    path: &'a Path,
    destination: Destination,
    force: Force,
    is_vtu: bool,
    style: Style,
}

impl<'a> MeshOutput<'a> {
    fn new(input: &Path, (path, force): (&'a Path, Force), style: Style) -> Result<Self, Failure> {
        let destination = Destination::new(path, &[input.to_owned()])?;
        let extension = path.extension().and_then(|extension| extension.to_str());
        let is_vtu = match extension.map(str::to_ascii_lowercase).as_deref() {
            // Names of streams do not tell a format.
            None if destination.is_stream() => false,
            Some("msh") => false,
            Some("vtu") => true,
            _ => {
                return Err(Failure::MeshFormat {
                    path: path.to_owned(),
                });
            }
        };
        Ok(Self {
            path,
            destination,
            force,
            is_vtu,
            style,
        })
    }

    /// Writes a mesh and reports it after `facts` about it.
    fn write(self, mesh: &Mesh, facts: &str) -> Result<(), Failure> {
        let Self {
            path,
            destination,
            force,
            is_vtu,
            style,
        } = self;
        if !is_vtu && style.version == Version::V22 {
            warn_of_copies(path, mesh);
        }
        let mut bytes = Vec::new();
        if is_vtu {
            let encoding = if style.ascii {
                VtuEncoding::Base64
            } else {
                VtuEncoding::RawAppended
            };
            write_vtu(mesh, encoding, &mut bytes).map_err(|source| Failure::WriteVtu {
                path: path.to_owned(),
                source,
            })?;
        } else {
            let version = match style.version {
                Version::V22 => MshVersion::V22,
                Version::V41 => MshVersion::V41,
            };
            let encoding = if style.binary {
                MshEncoding::Binary
            } else {
                MshEncoding::Text
            };
            write_msh(mesh, version, encoding, &mut bytes)
                .map_err(|source| cannot_write_msh(path, source))?;
        }
        let voice = Voice::apart_from(&destination);
        // A reader that closed its pipe is no error.
        let _ = force.write(destination, &bytes)?;
        voice.say(&format!("{}: {facts}{} bytes", path.display(), bytes.len()))?;
        Ok(())
    }
}

/// Warns of cells in several groups, of which version 2.2 has a copy for each of them.
fn warn_of_copies(path: &Path, mesh: &Mesh) {
    let groups = mesh
        .cells
        .iter()
        .flat_map(|block| (0..block.len()).map(|cell| block.physical.of(cell).len()));
    let (cells, rows) = groups
        .filter(|&groups| groups > 1)
        .fold((0, 0), |(cells, rows), groups| (cells + 1, rows + groups));
    if cells > 0 {
        complain(&format!(
            "warning: {}: {cells} cells are in several groups and written {rows} times, once for each group, as version 2.2 \
             knows one group a cell; a program that does not merge them has such cells twice, and --version 4.1 writes each once",
            path.display()
        ));
    }
}

fn cannot_write_msh(path: &Path, source: WriteMshError) -> Failure {
    let path = path.to_owned();
    Failure::WriteMsh { path, source }
}
