//! The mesh of a scene and the matrices on it.

use sinew_fem::{Cause, FemError, Item, Model};
use sinew_mesh::{UnknownGroup, structured};

use super::{BodyModel, MeshAndWarnings};
use crate::error::{Fault, SceneError};
use crate::scene::{Body, GRAVITY, MeshSource, Places};

pub(super) fn build(
    body: &Body,
    (mesh, mesh_warnings): MeshAndWarnings,
    places: &Places,
) -> Result<BodyModel, SceneError> {
    let model = Model::build(&mesh, &body.problem).map_err(|error| refused(error, places))?;
    Ok(BodyModel {
        mesh,
        mesh_warnings,
        model,
    })
}

/// Makes or reads the mesh that `[mesh]` names.
pub(super) fn mesh(body: &Body, places: &Places) -> Result<MeshAndWarnings, SceneError> {
    let place = places.mesh.as_ref().unwrap_or(&places.document);
    match &body.mesh {
        MeshSource::Cube { cells, edge, split } => {
            let cube = structured::cube(*cells, *edge, *split);
            let mesh = cube.map_err(|error| place.value_fault("cube", error.into()))?;
            Ok((mesh, Vec::new()))
        }
        MeshSource::File(written) => {
            let fault = |fault| place.value_fault("file", fault);
            let path = place.scene().resolve(written);
            let mesh = sinew_mesh::read_msh_file(path).map_err(|error| fault(error.into()))?;
            let warnings = mesh.warnings.iter().map(ToString::to_string).collect();
            let tets = mesh.to_tet_mesh().map_err(|error| fault(error.into()))?;
            Ok((tets, warnings))
        }
    }
}

/// Points at what the model was refused for.
fn refused(error: FemError, places: &Places) -> SceneError {
    let whole = &places.document;
    let place = match error.item() {
        Item::Mesh => places.mesh.as_ref().unwrap_or(whole),
        Item::Damping => places.damping.as_ref().unwrap_or(whole),
        Item::Region(index) => places.of(&places.regions, index),
        Item::Fixed(index) => places.of(&places.fixed, index),
        Item::Load(index) => places.of(&places.loads, index),
        Item::Gravity => whole,
    };
    let key = match (error.item(), error.cause()) {
        (Item::Gravity, _) => GRAVITY,
        (Item::Mesh, Cause::Inverted { .. } | Cause::Flat { .. }) => "file",
        _ => "group",
    };
    place.value_fault(key, Fault::Model(error))
}

/// The cells of a group's nodes, those of the whole body where no group is named, and the number
/// of nodes there are, the held ones included.
pub(crate) fn cells_of(
    group: Option<&str>,
    body: &BodyModel,
) -> Result<(Vec<u32>, usize), UnknownGroup> {
    let Some(name) = group else {
        let cells = (0..).take(body.model.nodes().len()).collect();
        return Ok((cells, body.mesh.points.len()));
    };
    let nodes = body.mesh.group_nodes(body.mesh.group(name)?);
    let cells = nodes
        .iter()
        .filter_map(|node| body.model.cell_of_node(*node));
    Ok((cells.collect(), nodes.len()))
}
