//! Meshes in formats other than .msh.
//!
//! The files under `data/formats` are one small mesh, written by VTK 9.7 and meshio 5.3.5 in each encoding.

mod abaqus;
mod by_hand;
mod grids;
mod labels;
mod medit;
mod mutation;
mod vtk;
mod vtu;

use std::path::PathBuf;

use sinew_mesh::{Mesh, MeshError, MeshFormat, read_mesh, read_mesh_file};

/// The path of a file under `data/formats`.
fn path(name: &str) -> PathBuf {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/formats");
    PathBuf::from(folder).join(name)
}

fn fixture(name: &str) -> Mesh {
    read_mesh_file(path(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn read(text: &str, format: MeshFormat) -> Mesh {
    read_mesh(text.as_bytes(), format).unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str, format: MeshFormat) -> String {
    refused(text.as_bytes(), format).to_string()
}

fn refused(bytes: &[u8], format: MeshFormat) -> MeshError {
    match read_mesh(bytes, format) {
        Err(error) => error,
        Ok(mesh) => panic!("accepted: {mesh:?}"),
    }
}

/// A message with the line of its place, and without the byte.
fn without_byte(message: &str) -> String {
    match (message.find(" (byte "), message.find("): ")) {
        (Some(start), Some(end)) if start < end => {
            format!("{}{}", &message[..start], &message[end + 1..])
        }
        _ => message.to_owned(),
    }
}

/// The nodes of each cell of each block.
fn rows(mesh: &Mesh) -> Vec<(&'static str, Vec<Vec<u32>>)> {
    let blocks = mesh.cells.iter();
    blocks
        .map(|block| {
            (
                block.kind.name(),
                block.cells().map(<[u32]>::to_vec).collect(),
            )
        })
        .collect()
}

/// Name and values of the data of cells, block by block.
fn cell_data(mesh: &Mesh) -> Vec<(&str, Vec<Vec<f64>>)> {
    let data = mesh.cell_data.iter();
    data.map(|data| (data.name.as_str(), data.blocks.clone()))
        .collect()
}

fn point_data(mesh: &Mesh) -> Vec<(&str, Vec<f64>)> {
    let data = mesh.point_data.iter();
    data.map(|data| (data.name.as_str(), data.values.clone()))
        .collect()
}
