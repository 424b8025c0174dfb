//! Facts about a scene that pages receive.

use sinew_fem::{Law, LoadKind};
use sinew_scene::{BodyModel, Simulation};

use crate::error::LiveError;
use crate::new_tool::AddedTool;
use crate::picture::Colours;
use crate::protocol::{Hertz, LoadFacts, Scenery};
use crate::tool_facts::tools_of;

/// Facts that a scene does not contain.
#[derive(Clone, Debug)]
pub(crate) struct Presented {
    pub(crate) title: String,
    /// Largest speed (m/s) of steered tools.
    pub(crate) hand_speed: f64,
    /// Advice for the user's first moves, if the scene was chosen on a start page.
    pub(crate) from_start: Option<String>,
}

/// The facts of a scene at its beginning, of which pages added the last tools.
///
/// # Errors
/// [`LiveError::NoBody`] for a scene without a body.
pub(crate) fn scenery_of(
    simulation: &Simulation,
    added: &[AddedTool],
    presented: &Presented,
) -> Result<Scenery, LiveError> {
    let body = simulation.model().body().ok_or(LiveError::NoBody)?;
    let regions = body.problem.regions.iter();
    let laws: Vec<&Law> = regions.map(|region| &region.law).collect();
    let moduli = laws.iter().map(|law| law.youngs_modulus());
    let Presented {
        title,
        hand_speed,
        from_start,
    } = presented.clone();
    Ok(Scenery {
        title,
        version: env!("CARGO_PKG_VERSION"),
        nodes: body.mesh.points.len(),
        tets: body.mesh.tets.len(),
        cuts: simulation.is_cut(),
        fields: Colours::fields_of(&body.model, &laws, body.tools.is_some()),
        youngs_modulus: moduli.fold(0.0, f64::max),
        tools: tools_of(body, simulation, added),
        hand_speed,
        loads: loads_of(simulation, body),
        hertz: hertz_of(&laws),
        from_start,
    })
}

fn loads_of(simulation: &Simulation, body: &BodyModel) -> Vec<LoadFacts> {
    let names = simulation.body().load_names().into_iter().enumerate();
    let facts = names.map(|(place, name)| {
        let what = match body.problem.loads.get(place) {
            Some(load) => format!("{}, {}", kind_of(&load.kind), load.on),
            None => name.clone(),
        };
        LoadFacts { name, what }
    });
    facts.collect()
}

/// Description of a kind of load, with its size.
fn kind_of(kind: &LoadKind) -> String {
    let length = |vector: &[f64; 3]| vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    match kind {
        LoadKind::Traction(traction) => format!("{} Pa", length(traction)),
        LoadKind::Pressure(pressure) | LoadKind::FollowingPressure(pressure) => {
            format!("pressure of {pressure} Pa")
        }
        LoadKind::Force(force) => format!("{} N", length(force)),
    }
}

/// The constants of a body of one isotropic material.
fn hertz_of(laws: &[&Law]) -> Option<Hertz> {
    let [law] = laws else { return None };
    Some(Hertz {
        youngs_modulus: law.youngs_modulus(),
        poissons_ratio: law.poissons_ratio()?,
    })
}
