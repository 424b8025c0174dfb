//! Capabilities of each integrator on a scene.

use std::io;
use std::sync::Arc;
use std::thread::{self, JoinHandle};

use sinew_core::{Options, System};
use sinew_integrators::{Entry, Stepper};
use sinew_scene::{SceneBody, Simulation};

use super::{options, stability};
use crate::protocol::{Event, IntegratorFacts, StepFacts};
use crate::server::Shared;

/// Survey of the integrators' capabilities, on a separate thread.
#[derive(Debug)]
pub(crate) struct Survey(JoinHandle<()>);

impl Survey {
    /// Begins the survey, and sends its result to all pages.
    pub(crate) fn start(
        shared: &Arc<Shared>,
        scene: &Arc<Simulation>,
        body: &Arc<SceneBody>,
    ) -> io::Result<Self> {
        let (shared, scene, body) = (Arc::clone(shared), Arc::clone(scene), Arc::clone(body));
        let thread = thread::Builder::new().name("survey".to_owned());
        let thread = thread.spawn(move || {
            let list = survey(&scene, body.system());
            shared.tell_of_integrators(Event::Integrators { list });
        });
        Ok(Self(thread?))
    }

    /// True if the survey has ended.
    pub(crate) fn is_finished(&self) -> bool {
        self.0.is_finished()
    }
}

/// An integrator, set up on a scene if it must be tried, or the reason why it cannot be set up.
fn set_up(
    entry: &Entry,
    options: &Options,
    (system, dt): (&dyn System, f64),
    is_tried: bool,
) -> Result<Box<dyn Stepper>, String> {
    let mut integrator = entry.build(options).map_err(|error| error.to_string())?;
    if is_tried {
        integrator
            .prepare(system, dt)
            .map_err(|error| error.to_string())?;
    }
    Ok(integrator)
}

/// Finds the stable step of every integrator, or its error for the scene. Integrators that factorise are not set up,
/// unless there are tools, which they refuse before they factorise.
fn survey(scene: &Simulation, system: &dyn System) -> Vec<IntegratorFacts> {
    let has_tools = system.needs_contact();
    let entries = sinew_integrators::entries().into_iter();
    let facts = entries.map(|entry| {
        let mut facts = IntegratorFacts {
            name: entry.id.to_owned(),
            summary: entry.summary.to_owned(),
            refused: None,
            step: StepFacts::default(),
        };
        let plain = Options::new();
        let mut all = vec![plain.clone()];
        if has_tools {
            all.extend(options::alternatives(&entry, &plain));
        }
        let is_tried = has_tools || !entry.factorises;
        let mut found = None;
        for options in all {
            let options = scene.options_of(entry.id, &options);
            match set_up(&entry, &options, (system, scene.dt()), is_tried) {
                Ok(integrator) => {
                    found = Some((integrator, options));
                    break;
                }
                // The value of the plain method is reported.
                Err(reason) => facts.refused = facts.refused.take().or(Some(reason)),
            }
        }
        let Some((integrator, options)) = found else {
            return facts;
        };
        facts.refused = None;
        match integrator.stable_step(system) {
            Ok(found) => facts.step = stability::facts(&*integrator, &options, system, found),
            Err(error) => facts.refused = Some(error.to_string()),
        }
        facts
    });
    facts.collect()
}
