//! Loads that the scene's integrator refuses, or cannot follow, in the scene's steps.

use sinew_core::{ChangingLoads, Load, LoadOverStep, Options, Ramp, step_that_meets};

use sinew_fem::Item;

use super::Simulation;
use super::load_problems::{LoadRemedy, RefusedLoad, UnresolvedLoad};
use crate::keys::GRAVITY;
use crate::scene::Subject;

impl Simulation {
    /// The first load of the scene that its integrator will refuse; `None` if it accepts all loads.
    #[must_use]
    pub fn refused_load(&self) -> Option<RefusedLoad> {
        let integrator = self.integrator().ok()?;
        let needed = integrator.properties().changing_loads.needed();
        let (dt, until) = (self.dt(), self.run().steps as f64 * self.dt());
        let broken = |ramp: &Ramp, dt: f64| needed.first_broken(ramp, 0.0, dt, until);
        let is_smooth = |ramp: &Ramp, dt: f64| {
            let broken = LoadOverStep::Smooth.first_broken(ramp, 0.0, dt, until);
            broken.is_none()
        };
        let loads = self.loads();
        let refused = loads
            .iter()
            .enumerate()
            .find_map(|(index, load)| Some((index, broken(&load.ramp, dt)?)));
        let (index, instant) = refused?;
        let ramps = || loads.iter().map(|load| &load.ramp);
        let remedy = match step_that_meets(ramps(), dt, until) {
            Some(shorter) if ramps().all(|ramp| broken(ramp, shorter).is_none()) => {
                LoadRemedy::Step(shorter)
            }
            _ if ramps().all(|ramp| is_smooth(ramp, dt)) => LoadRemedy::Chebyshev,
            Some(shorter) if ramps().all(|ramp| is_smooth(ramp, shorter)) => {
                LoadRemedy::ChebyshevWithStep(shorter)
            }
            _ => LoadRemedy::Integrator(exact_under_any_load()),
        };
        Some(RefusedLoad {
            integrator: integrator.id(),
            needed,
            load: self.load_in_words(index),
            instant,
            dt,
            remedy,
        })
    }

    /// The first load of the scene that begins and ends within one step, or oscillates within four; `None` if there
    /// is none, or the integrator is exact.
    #[must_use]
    pub fn unresolved_load(&self) -> Option<UnresolvedLoad> {
        let integrator = self.integrator().ok()?;
        if integrator.properties().changing_loads.is_exact() {
            return None;
        }
        let (dt, until) = (self.dt(), self.run().steps as f64 * self.dt());
        let shortest = |ramp: &Ramp| {
            if let Ramp::Sine { frequency, .. } = ramp {
                return Some((0.25 / frequency, 0.0, Some(1.0 / frequency)));
            }
            let points = ramp.breakpoints();
            let within = points
                .windows(2)
                .filter(|pair| pair[0] < until && pair[1] > 0.0);
            let lengths = within.map(|pair| (pair[1] - pair[0], pair[0], None));
            lengths.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        // Loads on a body of large deformation are not among those of its matrices.
        let of_scene = match (self.scene().subject(), self.system().as_linear()) {
            (Subject::Body(body), None) => Some(body),
            _ => None,
        };
        let ramps: Vec<&Ramp> = match of_scene {
            Some(body) => body.problem.loads.iter().map(|load| &load.ramp).collect(),
            None => self.loads().iter().map(|load| &load.ramp).collect(),
        };
        ramps.into_iter().enumerate().find_map(|(index, ramp)| {
            let (length, from, period) = shortest(ramp)?;
            (length < (1.0 - 1e-9) * dt).then(|| UnresolvedLoad {
                load: match of_scene {
                    Some(body) => body.load_in_words(index),
                    None => self.load_in_words(index),
                },
                from,
                length,
                period,
                dt,
            })
        })
    }

    pub(super) fn loads(&self) -> &[Load] {
        let linear = self.system().as_linear();
        linear.map_or(&[], |linear| linear.operators().loads())
    }

    /// The name of a load of the system in the terms of the scene.
    fn load_in_words(&self, index: usize) -> String {
        let (Subject::Body(body), Some(built)) = (self.scene().subject(), self.model().body())
        else {
            return "the force".to_owned();
        };
        match built.model.item_of_load(index) {
            Some(Item::Load(load)) => body.load_in_words(load),
            Some(Item::Move(motion)) => body.motion_in_words(motion),
            _ => GRAVITY.to_owned(),
        }
    }
}

/// The id of an integrator that is exact for loads that jump at any instant, if there is one.
fn exact_under_any_load() -> Option<&'static str> {
    let exact = ChangingLoads::Exact(LoadOverStep::Any);
    let entries = sinew_integrators::entries();
    let takes_any = |entry: &&sinew_integrators::Entry| {
        let integrator = entry.build(&Options::new());
        integrator.is_ok_and(|integrator| integrator.properties().changing_loads == exact)
    };
    entries.iter().find(takes_any).map(|entry| entry.id)
}
