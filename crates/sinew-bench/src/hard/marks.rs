//! The pass marks, in the order of the report.

use std::collections::BTreeMap;
use std::path::PathBuf;

use sinew_measure::{Case, Row};

use super::checks::{
    centre_of_mass, energy_and_work, energy_form, equilibrium, long_run, mirror, released_bar,
    rotation, slivers, units, within_work,
};
use super::large;
use super::mark::Asked;
use crate::planned::yardstick;
use crate::results::{Mark, StabilityMap};
use sinew_verify::LabError;

/// The cases and rows from which marks are computed.
pub(crate) struct Measured<'a> {
    pub(crate) cases: &'a BTreeMap<String, Case>,
    /// Ids of the cases that were to be read.
    pub(crate) planned: &'a [String],
    pub(crate) rows: &'a [Row],
    /// The folders of scenes.
    pub(crate) folders: [PathBuf; 2],
    pub(crate) quick: bool,
}

impl Measured<'_> {
    fn case(&self, id: &str) -> Result<&Case, LabError> {
        self.cases
            .get(id)
            .ok_or_else(|| LabError::new(format!("{id} was not read")))
    }

    fn rows_of(&self, id: &str) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.case == id).collect()
    }

    /// True if a mark on this case is requested. A quick run leaves out slow cases.
    fn has(&self, id: &str) -> bool {
        self.planned.iter().any(|planned| planned == id)
    }
}

fn asked(case: &'static str, asked: &'static str, limit: f64) -> Asked {
    Asked { case, asked, limit }
}

/// Every possible mark on scenes and on bodies; `begins` is notified when each one begins.
pub(crate) fn all(measured: &Measured<'_>, mut begins: impl FnMut(&str)) -> Vec<Mark> {
    let mut marks = of_scenes(measured, &mut begins);
    for tissue in large::all() {
        if !(measured.quick && tissue.slow) {
            begins(tissue.asked.case);
            marks.push(given(tissue.asked, &mut |asked| (tissue.check)(asked)));
        }
    }
    marks
}

/// The mark from a check; failed if the check is not possible.
fn given(asked: Asked, check: &mut dyn FnMut(Asked) -> Result<Mark, LabError>) -> Mark {
    check(asked).unwrap_or_else(|error| asked.not_measured(error.to_string()))
}

/// The stable step of central difference, compared with every run of the maps: bounded within it, and unbounded beyond
/// 1.1 of it.
pub(crate) fn of_maps(maps: &[StabilityMap]) -> Mark {
    let asked = asked(
        "stability maps, central difference",
        "bounded within the stable step, unbounded beyond 1.1 of it: no run against it",
        0.0,
    );
    let leapfrog = yardstick().integrator;
    let (mut within, mut beyond, mut against) = (0_u32, 0_u32, 0_u32);
    for map in maps {
        let own = map.panels.iter().filter(|panel| panel.method == leapfrog);
        for (limit, runs) in own.flat_map(|panel| panel.stable_steps.iter().zip(&panel.runs)) {
            let Some(limit) = *limit else {
                return asked.not_measured("a stable step is not known");
            };
            for (&dt, run) in map.steps.iter().zip(runs) {
                if dt <= limit {
                    within += 1;
                    against += u32::from(!run.bounded);
                } else if dt > 1.1 * limit {
                    beyond += 1;
                    against += u32::from(run.bounded);
                }
            }
        }
    }
    asked
        .measured(
            f64::from(against),
            |count| format!("{count}"),
            format!("{within} runs within it, {beyond} beyond"),
        )
        .and(within > 0 && beyond > 0)
}

/// The marks on scenes, in the order of the report.
fn of_scenes(measured: &Measured<'_>, begins: &mut dyn FnMut(&str)) -> Vec<Mark> {
    let mut marks = Vec::new();
    let steps = |full, quick| if measured.quick { quick } else { full };
    let mut give = |asked: Asked, mark: &mut dyn FnMut(Asked) -> Result<Mark, LabError>| {
        begins(asked.case);
        marks.push(given(asked, mark));
    };

    let reproduction = asked(
        "the reproduction scene at 20 ms",
        "error at most 10 % at one sweep a step",
        0.1,
    );
    give(reproduction, &mut |asked| {
        Ok(within_work::check(
            asked,
            measured.rows_of("paper-cube"),
            0.02,
            1,
        ))
    });
    // No figure is set for this one: that of the long run.
    let undamped = asked(
        "undamped network, 5 to 250 critical steps",
        "energy form invariant (to 1e-10), bounded",
        1e-10,
    );
    give(undamped, &mut |asked| {
        energy_form::check(asked, measured.case("undamped")?, steps(1000, 200))
    });
    if measured.has("critical-damping") {
        let critical = asked(
            "pairwise critical damping, 20 ms",
            "error at most 5 % at 8 sweeps a step or fewer",
            0.05,
        );
        give(critical, &mut |asked| {
            Ok(within_work::check(
                asked,
                measured.rows_of("critical-damping"),
                0.02,
                8,
            ))
        });
    }
    for (id, case) in [
        (
            "stiffness-damping-0.49",
            "stiffness-proportional damping, nu .49, 20 ms",
        ),
        (
            "stiffness-damping-0.499",
            "stiffness-proportional damping, nu .499, 20 ms",
        ),
    ] {
        if measured.has(id) {
            let damped = asked(case, "bounded, error at most 15 %", 0.15);
            give(damped, &mut |asked| {
                Ok(within_work::check(
                    asked,
                    measured.rows_of(id),
                    0.02,
                    u64::MAX,
                ))
            });
        }
    }
    for (id, case) in [
        ("sliver-20", "one sliver 20 times thinner"),
        ("sliver-100", "one sliver 100 times thinner"),
        ("sliver-1000", "one sliver 1000 times thinner"),
    ] {
        let sliver = asked(case, "error within 2 times that of the uniform mesh", 2.0);
        let (uniform, rows) = (measured.rows_of("no-sliver"), measured.rows_of(id));
        give(sliver, &mut |asked| {
            Ok(slivers::check(asked, &uniform, &rows))
        });
    }
    if measured.has("stiff-inclusion") {
        let inclusion = asked(
            "stiff inclusion, E 1:10^4, density 1:10",
            "bounded, static error at most 1e-6",
            1e-6,
        );
        give(inclusion, &mut |asked| {
            equilibrium::check(asked, measured.case("stiff-inclusion")?)
        });
    }
    let free = asked("nearly free body, pulse", "centre of mass to 1 %", 0.01);
    give(free, &mut |asked| {
        centre_of_mass::check(asked, measured.case("nearly-free")?, &[0.01, 0.02])
    });
    let tool = asked(
        "impulsive tool, 1 m/s, on/off every step",
        "energy at most E0 + work (to rounding: 1e-12)",
        1e-12,
    );
    give(tool, &mut |asked| {
        energy_and_work::check(asked, measured.case("impulsive-tool")?)
    });

    let frequency = asked(
        "sudden release of a stretched bar",
        "first frequency to 1 % of the modal solution",
        0.01,
    );
    let amplitude = asked(
        "sudden release of a stretched bar",
        "first amplitude to 1 % of the modal solution",
        0.01,
    );
    let bar = measured
        .case("released-bar")
        .and_then(|case| released_bar::check(frequency, amplitude, case, 0.005))
        .unwrap_or_else(|error| {
            [frequency, amplitude].map(|asked| asked.not_measured(error.to_string()))
        });
    for (part, mark) in [frequency, amplitude].into_iter().zip(bar) {
        give(part, &mut |_| Ok(mark.clone()));
    }

    let energy = asked(
        "1e5 steps at .95 critical steps",
        "energy drift at most 1e-10 (f64)",
        1e-10,
    );
    give(energy, &mut |asked| {
        let steps = steps(100_000, 10_000);
        long_run::check(asked, measured.case("long-run")?, steps, "f64")
    });
    let single = asked(
        "1e5 steps at .95 critical steps",
        "energy drift at most 1e-4 (f32)",
        1e-4,
    );
    give(single, &mut |asked| {
        let steps = steps(100_000, 10_000);
        long_run::check(asked, measured.case("long-run")?, steps, "f32")
    });
    let rotated = asked(
        "90 degree rotated copy of a scene",
        "difference at most 1e-10",
        1e-10,
    );
    give(rotated, &mut |asked| {
        rotation::check(asked, measured.case("impulsive-tool")?)
    });
    let dimensionless = asked(
        "every scene in m, mm, um",
        "same dimensionless result (to 1e-12)",
        1e-12,
    );
    give(dimensionless, &mut |asked| {
        units::check(asked, &measured.folders)
    });
    if measured.has("symmetric-load") {
        let symmetric = asked(
            "symmetric load on the mirrored cube",
            "lateral drift at most 1e-12",
            1e-12,
        );
        give(symmetric, &mut |asked| {
            mirror::check(asked, measured.case("symmetric-load")?)
        });
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_verify::MarkVerdict;

    #[test]
    fn a_scene_that_was_not_read_fails_its_own_marks_by_name() {
        let planned = ["nearly-free".to_owned()];
        let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        let measured = Measured {
            cases: &BTreeMap::new(),
            planned: &planned,
            rows: &[],
            folders: [scenes.clone(), scenes.join("hard")],
            quick: true,
        };
        let marks = of_scenes(&measured, &mut |_| ());
        let free = marks
            .iter()
            .find(|mark| mark.case == "nearly free body, pulse")
            .unwrap();
        assert_eq!(free.measured, "nearly-free was not read");
        assert_eq!(free.verdict, MarkVerdict::Fail);
        let units = marks
            .iter()
            .find(|mark| mark.case == "every scene in m, mm, um")
            .unwrap();
        assert_eq!(units.verdict, MarkVerdict::Pass, "{}", units.measured);
    }

    #[test]
    fn maps_without_runs_pass_nothing() {
        assert_eq!(of_maps(&[]).verdict, MarkVerdict::Fail);
    }
}
