//! Loads that the scene's method cannot take, or cannot follow, in the scene's steps.

use sinew_core::{Load, LoadOverStep, Ramp, step_that_meets};

use super::{SceneModel, Simulation};
use crate::scene::{GRAVITY, Subject};

impl Simulation {
    /// Why the scene's method will refuse a load of the scene, and what to do; `None` where it takes
    /// them all.
    #[must_use]
    pub fn refused_load(&self) -> Option<String> {
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
                format!("dt = {shorter} s would do")
            }
            _ if ramps().all(|ramp| is_smooth(ramp, dt)) => {
                "kind = \"chebyshev\" takes loads that are smooth over each step".to_owned()
            }
            Some(shorter) if ramps().all(|ramp| is_smooth(ramp, shorter)) => {
                format!("kind = \"chebyshev\" with dt = {shorter} s would do")
            }
            _ => "no step of use would do; `modal` takes loads that jump anywhere".to_owned(),
        };
        Some(format!(
            "`{}` takes loads that are {}, and {} changes at t = {instant} s, in steps of {dt} s; {remedy}",
            integrator.id(),
            needed.describe(),
            self.load_in_words(index),
        ))
    }

    /// A load that comes and goes within a step of the scene's method, which feels its impulse but
    /// not its course; `None` where there is none.
    #[must_use]
    pub fn unresolved_load(&self) -> Option<String> {
        let integrator = self.integrator().ok()?;
        if integrator.properties().changing_loads.is_exact() {
            return None;
        }
        let (dt, until) = (self.dt(), self.run().steps as f64 * self.dt());
        let shortest = |ramp: &Ramp| {
            let points = ramp.breakpoints();
            let within = points
                .windows(2)
                .filter(|pair| pair[0] < until && pair[1] > 0.0);
            let lengths = within.map(|pair| (pair[1] - pair[0], pair[0]));
            lengths.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let found = self.loads().iter().enumerate().find_map(|(index, load)| {
            let (length, from) = shortest(&load.ramp)?;
            (length < (1.0 - 1e-9) * dt).then_some((index, length, from))
        });
        let (index, length, from) = found?;
        Some(format!(
            "{} changes twice within {length:.3e} s at t = {from} s, less than dt = {dt} s: its impulse \
             arrives, its course does not; dt = {length:.3e} s would follow it",
            self.load_in_words(index)
        ))
    }

    fn loads(&self) -> &[Load] {
        let linear = self.system().as_linear();
        linear.map_or(&[], |linear| linear.operators().loads())
    }

    /// A load of the system as the scene calls it.
    fn load_in_words(&self, index: usize) -> String {
        let (Subject::Body(body), SceneModel::Body(_)) = (self.scene().subject(), self.model())
        else {
            return "the force".to_owned();
        };
        // The model's loads are those of the problem, then gravity.
        match (body.problem.loads.get(index), body.load_names.get(index)) {
            (Some(_), Some(Some(name))) => format!("[[load]] \"{name}\""),
            (Some(load), _) => format!("[[load]] {} on `{}`", index + 1, load.group),
            (None, _) => GRAVITY.to_owned(),
        }
    }
}
