//! Scenes on which nothing acts, and loads that are far too large.

use sinew_core::Ramp;
use sinew_core::vectors::norm;
use sinew_fem::LoadKind;

use super::{Warning, WarningKind};
use crate::number::short;
use crate::scene::{Blade, Body, Subject};
use crate::simulation::Simulation;
use crate::simulation::model::BodyModel;

/// Stress of a load over the stiffness of the tissue under it, beyond which no tissue withstands it.
const BEARS: f64 = 10.0;

pub(super) fn warnings(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let mut warnings: Vec<Warning> = idle(body).into_iter().collect();
    warnings.extend(uncut(body));
    warnings.extend(out_of_proportion(body, built));
    warnings
}

/// A warning if nothing moves the body.
fn idle(body: &Body) -> Option<Warning> {
    let problem = &body.problem;
    let has_weight = problem.gravity.is_some_and(|gravity| norm(&gravity) > 0.0);
    let acts = |kind: &LoadKind| match kind {
        LoadKind::Traction(vector) | LoadKind::Force(vector) => norm(vector) > 0.0,
        LoadKind::Pressure(pressure) | LoadKind::FollowingPressure(pressure) => *pressure != 0.0,
    };
    let is_idle = !problem.loads.iter().any(|load| acts(&load.kind))
        && !has_weight
        && body.motions.is_empty()
        && body.tools.is_empty()
        && body.initial.is_empty();
    is_idle.then(|| {
        Warning::new(
            WarningKind::NothingActs,
            "nothing acts on the body: without loads, gravity, motions, tools and an initial state it stays at rest",
            "a [[load]], or gravity at the top of the scene, moves it",
        )
    })
}

/// A warning if the body may be cut but nothing cuts it.
fn uncut(body: &Body) -> Option<Warning> {
    let cutting = body.cutting.as_ref()?;
    let is_uncut = cutting.blade == Blade::None && cutting.remove.is_none();
    is_uncut.then(|| {
        Warning::new(
            WarningKind::NothingCuts,
            "[cutting] names nothing that cuts: only commands of a session do",
            "`table` or `tool` in it names a blade",
        )
    })
}

/// A warning of the largest load relative to the stiffness of the body, if no tissue withstands it.
pub(super) fn out_of_proportion(body: &Body, built: &BodyModel) -> Option<Warning> {
    let problem = &body.problem;
    let moduli = problem.regions.iter().map(|region| {
        let factors = region.from_mesh.youngs_modulus.as_ref();
        let factors = factors.and_then(|name| built.mesh.data(name).ok());
        let largest = factors.map(|data| data.values.iter().copied().fold(0.0, f64::max));
        region.law.youngs_modulus() * largest.unwrap_or(1.0)
    });
    let stiffest = moduli.fold(0.0, f64::max);
    let report = built.model.report();
    let section = report.volume.powf(2.0 / 3.0);
    let loads = problem.loads.iter().enumerate().map(|(index, load)| {
        let stress = match load.kind {
            LoadKind::Traction(traction) => norm(&traction),
            LoadKind::Pressure(pressure) | LoadKind::FollowingPressure(pressure) => pressure.abs(),
            LoadKind::Force(force) => norm(&force) / section,
        };
        (body.load_in_words(index), stress * largest(&load.ramp))
    });
    let weight = problem.gravity.map(|gravity| {
        let stress = norm(&gravity) * report.mass / section;
        ("gravity".to_owned(), stress)
    });
    let (load, stress) = loads
        .chain(weight)
        .max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    let times = stress / stiffest;
    (stiffest > 0.0 && times > BEARS).then(|| {
        let what = format!(
            "{load} is out of proportion: its stress of {} Pa is {} times the Young's modulus of the stiffest region, {} Pa",
            short(stress),
            short(times),
            short(stiffest)
        );
        let numbers = [("stress_Pa", stress), ("youngs_modulus_Pa", stiffest)];
        let mend = "pressures and moduli are in Pa, forces in N, lengths in m";
        Warning::new(WarningKind::LargeLoad, what, mend).with(&numbers)
    })
}

/// The largest factor of a ramp, without its sign; that of an input is unknown, and assumed to be 1.
fn largest(ramp: &Ramp) -> f64 {
    match ramp {
        Ramp::Table { values, .. } | Ramp::Hold { values, .. } => {
            values.iter().fold(0.0, |most, value| most.max(value.abs()))
        }
        _ => 1.0,
    }
}

impl Simulation {
    /// Advice, after a semicolon, to find the cause of a divergence.
    #[must_use]
    pub fn after_divergence(&self) -> String {
        let large = match (self.scene().subject(), self.model().body()) {
            (Subject::Body(body), Some(built)) => out_of_proportion(body, built),
            _ => None,
        };
        if let Some(Warning { what, .. }) = large {
            return format!("; {what}");
        }
        let is_stable = self
            .stable_step()
            .ok()
            .and_then(|step| step.allows(self.dt()))
            == Some(true);
        match is_stable {
            true => "; the step is stable about rest, so that the loads and motions, or what the body became under them, ask for more than the method bears: \
                     smaller loads, a shorter step or an implicit method"
                .to_owned(),
            false => "; `sinew plan` names the stable step".to_owned(),
        }
    }
}
