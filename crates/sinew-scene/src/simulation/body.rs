//! The matrices of a body on its mesh.

use std::sync::{Arc, OnceLock};

use sinew_fem::{
    Cause, Course, CutModel, CutModelError, FemError, Item, Model, Moving, On, Region,
};

use super::cut_plan::CutPlan;
use super::meshed::SelectedMesh;
use super::model::BodyModel;
use super::motion_table::{MotionTable, read_strokes};
use crate::error::{Fault, SceneError};
use crate::keys::GRAVITY;
use crate::scene::{Blade, Body, MeshSource, Motion, Places, Way};

/// Assembles the matrices.
pub(super) fn build(
    body: &Body,
    selected: SelectedMesh,
    places: &Places,
) -> Result<BodyModel, SceneError> {
    let mut problem = body.problem.clone();
    for (index, motion) in body.motions.iter().enumerate() {
        problem.moves.push(moving(motion, places, index)?);
    }
    let SelectedMesh {
        mut mesh,
        warnings: mesh_warnings,
        selected,
    } = selected;
    if !problem.regions.iter().any(Region::takes_data) {
        mesh.data = Vec::new();
    }
    let mesh = Arc::new(mesh);
    let model = match &body.cutting {
        None => Model::build_on(Arc::clone(&mesh), &problem)
            .map_err(|error| refused(error, body, places))?,
        Some(cutting) => {
            let cut = CutModel::new(Arc::clone(&mesh), problem.clone(), cutting.snap);
            let cut = cut.map_err(|error| match error {
                CutModelError::Model(error) => refused(error, body, places),
                error => {
                    let place = places.cutting.as_ref().unwrap_or(&places.document);
                    place.fault(Fault::Cutting(error))
                }
            })?;
            cut.model().clone()
        }
    };
    Ok(BodyModel {
        mesh,
        mesh_warnings,
        selected,
        problem,
        model,
        tools: None,
        cut: None,
        surface: OnceLock::new(),
    })
}

/// The cutting of a body, with the content of the blade's table.
pub(super) fn cut_plan(body: &Body, places: &Places) -> Result<Option<Arc<CutPlan>>, SceneError> {
    let Some(cutting) = &body.cutting else {
        return Ok(None);
    };
    let strokes = match &cutting.blade {
        Blade::Table(written) => {
            let place = places.cutting.as_ref().unwrap_or(&places.document);
            let read = read_strokes(place.scene(), written);
            Some(read.map_err(|error| place.value_fault("table", error.into()))?)
        }
        Blade::None | Blade::Tool(_) => None,
    };
    Ok(Some(Arc::new(CutPlan {
        cutting: cutting.clone(),
        strokes,
    })))
}

/// A prescribed motion, with the content of its table.
fn moving(motion: &Motion, places: &Places, index: usize) -> Result<Moving, SceneError> {
    let Motion {
        group, axes, way, ..
    } = motion;
    let courses = match way {
        Way::Displacement(displacement, ramp) => vec![Course::new(*displacement, ramp.clone())],
        Way::Velocity(velocity) => vec![Course::at_velocity(*velocity)],
        Way::Table(written) => {
            let place = places.of(&places.motions, index);
            let table = MotionTable::read(place.scene(), written, *axes)
                .map_err(|error| place.value_fault("table", error.into()))?;
            Course::along(&table.times, &table.positions)
        }
    };
    Ok(Moving::new(On::Group(group.clone()), courses).along(*axes))
}

/// The key of a motion's path.
fn way_key(body: &Body, index: usize) -> &'static str {
    let motion = body.motions.get(index);
    motion.map_or("group", |motion| motion.way.key())
}

/// The error at the key for which the model was refused.
fn refused(error: FemError, body: &Body, places: &Places) -> SceneError {
    let whole = &places.document;
    let place = match error.item() {
        Item::Mesh => places.mesh.as_ref().unwrap_or(whole),
        Item::Damping => places.damping.as_ref().unwrap_or(whole),
        Item::Region(index) => places.of(&places.regions, index),
        Item::Fixed(index) => places.of(&places.fixed, index),
        Item::Move(index) => places.of(&places.motions, index),
        Item::Load(index) => places.of(&places.loads, index),
        Item::Supports | Item::Gravity => whole,
    };
    let key = match (error.item(), error.cause()) {
        (Item::Gravity, _) => GRAVITY,
        (Item::Mesh, Cause::Inverted { .. } | Cause::Flat { .. }) => "file",
        (Item::Move(index), Cause::UnnamedAxis { .. } | Cause::Value { .. }) => {
            way_key(body, index)
        }
        (Item::Move(index), Cause::PositionJumps { .. }) => match way_key(body, index) {
            "displacement" => "ramp",
            key => key,
        },
        (Item::Region(_), Cause::Data { quantity, .. }) => match *quantity {
            "direction" => "fibres",
            quantity => quantity,
        },
        _ => place.part_key(),
    };
    let is_data = matches!(error.cause(), Cause::Data { .. });
    let error = place.value_fault(key, Fault::Model(error));
    match &body.mesh {
        _ if !is_data => error,
        MeshSource::File(path) => error.with_help(format!("the mesh file is {}", path.display())),
        MeshSource::Cube { .. } | MeshSource::Block { .. } => error.with_help(
            "meshes that the scene makes have no data: write a .msh file with an `$ElementData` section",
        ),
    }
}
