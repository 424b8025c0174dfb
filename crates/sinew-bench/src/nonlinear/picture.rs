//! A picture of a large deformation with its error.

use sinew_verify::LabError;
use std::path::Path;

use sinew_core::vectors::norm;
use sinew_core::{Moment, Recorder, Verdict, simulate};
use sinew_draw::Surface;
use sinew_measure::{Case, CaseError, Effort, MeasureError, measure};
use sinew_mesh::GroupMembers;
use sinew_scene::Scene;

use crate::planned::yardstick;
use crate::report::{number, percent};

/// The scene, from the folder of scenes, and the step (s) of central difference.
const SCENE: &str = "nonlinear/twist.toml";
const STEP: f64 = 5e-3;

/// The column of the twist when it stores the largest energy, coloured by displacement, with the error of the run in
/// its title.
///
/// # Errors
/// [`LabError`].
pub fn picture(scenes: &Path) -> Result<String, LabError> {
    let simulation = Scene::load(scenes.join(SCENE)).and_then(Scene::build);
    let mut case = Case::new("twist", simulation.map_err(CaseError::from)?)?;
    let method = yardstick();
    let row = measure(&mut case, &method, STEP, Effort::UNTIMED)?;

    let simulation = case.simulation();
    let body = simulation
        .model()
        .body()
        .ok_or_else(|| LabError::new("the scene has no body that moves"))?;
    let mut tightest: Option<(f64, f64, Vec<f64>)> = None;
    let mut look = |moment: &Moment<'_>| {
        let (t, u) = (moment.state.t(), &moment.state.u);
        let energy = moment.system.energy(u, &moment.state.v);
        let stored = energy.map_or(0.0, |energy| energy.elastic);
        if tightest.as_ref().is_none_or(|(most, ..)| stored > *most) {
            tightest = Some((stored, t, u.clone()));
        }
        Ok(Verdict::Continue)
    };
    let mut integrator = method.build().map_err(MeasureError::from)?;
    let mut state = simulation.initial_state().clone();
    let recorder: &mut dyn Recorder = &mut look;
    simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &case.run(STEP),
        recorder,
    )
    .map_err(MeasureError::from)?;
    let (_, t, u) = tightest.ok_or_else(|| LabError::new("the scene has no body that moves"))?;

    let mesh = &body.mesh;
    let mut points = mesh.points.clone();
    body.model.positions(t, &u, &mut points)?;
    let moved = points.iter().zip(&mesh.points);
    let values: Vec<f64> = moved
        .map(|(point, rest)| 1e3 * norm(&[0, 1, 2].map(|axis| point[axis] - rest[axis])))
        .collect();
    let surfaces = mesh.groups.iter().filter_map(|group| match &group.members {
        GroupMembers::Triangles(triangles) => Some(triangles),
        GroupMembers::Tets(_) | GroupMembers::Lines(_) | GroupMembers::Nodes(_) => None,
    });
    let triangles: Vec<[u32; 3]> = surfaces.flatten().copied().collect();
    let error = row.error.map_or_else(|| "none".to_owned(), percent);
    let surface = Surface {
        outline: Some(mesh.bounding_box().into()),
        size: (420.0, 430.0),
        ..Surface::new(
            format!(
                "Twisted tissue at {} s: error over the run {error} %",
                number::short(t)
            ),
            &points,
            &triangles,
            &values,
            "|u| [mm]",
        )
    };
    Ok(surface.svg())
}
