//! `sinew new`.

mod ready;
mod scene_file;

use std::path::{Component, Path, PathBuf};

use sinew_mesh::read_mesh_file;
use sinew_scene::output::Destination;
use sinew_scene::propose;

use scene_file::written;

use super::Failure;
use super::own_file::Force;

/// The scene to write.
#[derive(clap::Args)]
#[command(group = clap::ArgGroup::new("what").args(["mesh", "list", "ready"]).required(true))]
pub(crate) struct Arguments {
    /// The mesh file to write a first scene for: its groups with their sizes, its data with their ranges, its unit as
    /// far as its extent shows it, and a material, a support and a load as proposals; it runs as it is
    mesh: Option<PathBuf>,
    /// List the ready scenes
    #[arg(long)]
    list: bool,
    /// With --list: measure for a second each how fast they are on this computer, and mark those in real time
    #[arg(long, requires = "list")]
    pace: bool,
    /// Write a ready scene and, next to it, its mesh
    #[arg(long, value_name = "NAME")]
    ready: Option<String>,
    /// The scene file to write, or - for standard output [default: the name of the mesh or of the ready scene with
    /// .toml, in the current folder]
    #[arg(long, value_name = "FILE", conflicts_with = "list")]
    out: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let out = |stem: &Path| match &arguments.out {
        Some(out) => out.clone(),
        None => named_after(stem),
    };
    if let Some(mesh) = &arguments.mesh {
        return first(mesh, &out(mesh), arguments.force);
    }
    if let Some(name) = &arguments.ready {
        return ready::write(name, &out(Path::new(name)), arguments.force);
    }
    match arguments.pace {
        true => ready::list_with_paces(),
        false => ready::list(),
    }
}

/// A file name ending in .toml.
fn named_after(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(".toml");
    name.into()
}

/// Writes a first scene for a mesh.
fn first(mesh: &Path, out: &Path, force: Force) -> Result<(), Failure> {
    let extension = mesh.extension().unwrap_or_default();
    if extension.eq_ignore_ascii_case("toml") {
        let path = mesh.to_owned();
        return Err(Failure::SceneForMesh { path });
    }
    let destination = Destination::new(out, &[mesh.to_owned()])?;
    let text = propose(read_mesh_file(mesh)?, &seen_from(out, mesh));
    let text = text.map_err(|source| Failure::Tetrahedra {
        mesh: mesh.to_owned(),
        source,
    })?;
    written(destination, &text, force)
}

/// The path of a mesh as seen from the folder of a scene: relative if the folder is known, else absolute.
fn seen_from(scene: &Path, mesh: &Path) -> PathBuf {
    let folder = match scene.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    match (folder.canonicalize(), mesh.canonicalize()) {
        (Ok(folder), Ok(mesh)) => relative(&folder, &mesh),
        _ => mesh.to_owned(),
    }
}

/// The relative path from an absolute folder to an absolute path.
fn relative(folder: &Path, path: &Path) -> PathBuf {
    let shared = folder.components().zip(path.components());
    let shared = shared.take_while(|(a, b)| a == b).count();
    let up = folder
        .components()
        .skip(shared)
        .map(|_| Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_goes_up_to_the_shared_folder_and_down_again() {
        let way = |folder: &str, path: &str| relative(Path::new(folder), Path::new(path));
        assert_eq!(way("/a/b", "/a/b/m.msh"), Path::new("m.msh"));
        assert_eq!(way("/a/b/c", "/a/m.msh"), Path::new("../../m.msh"));
        assert_eq!(way("/a/b", "/c/m.msh"), Path::new("../../c/m.msh"));
    }
}
