//! The mesh that `[mesh]` describes.

use sinew_mesh::{Linearised, Mesh, TetMesh, structured};

use crate::decode::Place;
use crate::error::Fault;
use crate::error::SceneError;
use crate::number::{count, short};
use crate::scene::{Body, MeshChanges, MeshSource, Places};

/// A mesh and the warnings of its reader.
pub(super) type MeshAndWarnings = (TetMesh, Vec<String>);

/// Makes or reads the mesh, and makes the changes of the scene.
pub(super) fn of_body(body: &Body, places: &Places) -> Result<MeshAndWarnings, SceneError> {
    let place = places.mesh.as_ref().unwrap_or(&places.document);
    let changes = &body.mesh_changes;
    let (mesh, warnings) = match &body.mesh {
        MeshSource::Cube { cells, edge, split } => {
            let cube = structured::cube(*cells, *edge, *split);
            let mesh = cube.map_err(|error| place.value_fault("cube", error.into()))?;
            (mesh, Vec::new())
        }
        MeshSource::Block { cells, size, split } => {
            let block = structured::block(*cells, *size, *split);
            let mesh = block.map_err(|error| place.value_fault("block", error.into()))?;
            (mesh, Vec::new())
        }
        MeshSource::File(written) => {
            let fault = |fault| place.value_fault("file", fault);
            let path = place.scene().resolve(written);
            if let Some(mesh) = place.scene().given_mesh(&path) {
                return changed(TetMesh::clone(mesh), Vec::new(), changes, place);
            }
            let mesh = match place.scene().given_file(&path) {
                Some(bytes) => sinew_mesh::read_mesh_of(&path, bytes),
                None => sinew_mesh::read_mesh_file(path),
            };
            let mut mesh = mesh.map_err(|error| fault(error.into()))?;
            let warnings = mesh.warnings.iter().map(ToString::to_string).collect();
            let note = linearised(&mut mesh, changes);
            let mut tets = mesh.to_tet_mesh().map_err(|error| fault(error.into()))?;
            tets.notes.extend(note);
            (tets, warnings)
        }
    };
    changed(mesh, warnings, changes, place)
}

/// The mesh with its size and orientation changed.
fn changed(
    mut mesh: TetMesh,
    warnings: Vec<String>,
    changes: &MeshChanges,
    place: &Place,
) -> Result<MeshAndWarnings, SceneError> {
    if let Some(scale) = changes.scale {
        mesh.scale(scale);
        if !mesh.points.iter().flatten().all(|x| x.is_finite()) {
            return Err(place.value_fault("scale", Fault::Scale { scale }));
        }
    }
    if let Some(rotation) = &changes.rotation {
        mesh.rotate(rotation.axis, rotation.degrees);
    }
    Ok((mesh, warnings))
}

/// Linearises cells if the scene requests it, and reports the change.
fn linearised(mesh: &mut Mesh, changes: &MeshChanges) -> Option<String> {
    if !changes.linear {
        return None;
    }
    let Linearised {
        cells,
        dropped_nodes,
        farthest_from_straight,
        ..
    } = mesh.linearise();
    if cells.is_empty() {
        return None;
    }
    let cells: Vec<String> = cells
        .iter()
        .map(|(kind, count)| format!("{count} {kind}"))
        .collect();
    // Differences below that are roundings of the file's coordinates.
    let shape = if farthest_from_straight <= 1e-9 * widest(&mesh.points) {
        "all edges were straight".to_owned()
    } else {
        let lost = short(farthest_from_straight * changes.scale.unwrap_or(1.0));
        format!("curved edges became straight, by up to {lost} m at their middle")
    };
    Some(format!(
        "order = \"linear\": cells taken by their corners: {}; {} between them dropped; {shape}",
        cells.join(", "),
        count(dropped_nodes, "node"),
    ))
}

/// The width of the points along the axis on which they are widest.
fn widest(points: &[[f64; 3]]) -> f64 {
    let width = |axis: usize| {
        let along = || points.iter().map(|point| point[axis]);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    width(0).max(width(1)).max(width(2))
}
