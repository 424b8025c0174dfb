//! The search on methods whose errors and costs are known in closed form.

use std::cell::RefCell;
use std::collections::BTreeMap;

use sinew_core::LoadOverStep;

use super::*;
use crate::{Row, Work};

/// `error = factor dt^order`, never below `floor` nor above `cap`; one unit of cost per step.
#[derive(Clone, Copy, Debug)]
struct Law {
    order: u8,
    factor: f64,
    floor: f64,
    cap: f64,
    setup: f64,
    step: f64,
    stable: f64,
    factorizations: u64,
}

const PLAIN: Law = Law {
    order: 2,
    factor: 100.0,
    floor: 0.0,
    cap: f64::INFINITY,
    setup: 0.0,
    step: 1e-5,
    stable: f64::INFINITY,
    factorizations: 0,
};

#[derive(Debug, Default)]
struct Laws {
    laws: BTreeMap<String, Law>,
    /// Number of parts that meets a kink: steps that do not divide it are refused.
    kink: Option<f64>,
    /// Number of parts of an interval that the loads require, if any.
    for_loads: Option<Result<u32, UnfitLoads>>,
    guarded: Vec<&'static str>,
    left: RefCell<f64>,
    least_step: f64,
    taken: Vec<(String, f64)>,
}

/// A load that changes at an instant (s) within a step (s).
fn unfit(instant: f64, dt: f64) -> UnfitLoads {
    UnfitLoads {
        instant,
        needed: LoadOverStep::Smooth,
        dt,
    }
}

impl Pilots for &mut Laws {
    fn measure(&mut self, method: &MethodChoice, dt: f64, _: Effort) -> Result<Row, PilotError> {
        let law = self.laws[&method.integrator];
        assert!(
            dt <= law.stable * (1.0 + 1e-9),
            "an unstable step was measured"
        );
        if let Some(kink) = self.kink
            && ((kink / dt).round() - kink / dt).abs() > 1e-9
        {
            return Err(unfit(kink, dt).into());
        }
        let row = law.row(&method.integrator, dt);
        *self.left.borrow_mut() -= row.setup_cpu_s + 2.0 * row.cpu_s_per_s;
        self.taken.push((method.integrator.clone(), dt));
        Ok(Row {
            guarded: self.guarded.contains(&method.integrator.as_str()),
            ..row
        })
    }

    fn parts_for_loads(&self, _: &MethodChoice, _: f64) -> Result<u32, PilotError> {
        Ok(self.for_loads.unwrap_or(Ok(1))?)
    }

    fn left(&self) -> f64 {
        *self.left.borrow()
    }

    fn least_step_cpu_s(&self) -> f64 {
        self.least_step
    }
}

impl Law {
    fn row(self, integrator: &str, dt: f64) -> Row {
        let error = self.factor * dt.powi(i32::from(self.order));
        Row {
            integrator: integrator.into(),
            dt,
            error: Some(error.max(self.floor).min(self.cap)),
            bounded: true,
            cpu_s_per_s: self.step / dt,
            sweeps_per_s: 1.0 / dt,
            setup_cpu_s: self.setup,
            work: Work {
                factorizations: self.factorizations,
                ..Work::default()
            },
            ..Row::default()
        }
    }

    fn candidate(self, integrator: &str) -> Candidate {
        Candidate {
            method: MethodChoice::new(integrator),
            stable_step: self.stable,
            stable_step_is_known: true,
            order: Some(self.order),
            factorises: false,
        }
    }
}

const SPAN: Span = Span {
    duration: 1.0,
    samples: 50,
};

fn laws(laws: &[(&str, Law)]) -> Laws {
    Laws {
        laws: laws
            .iter()
            .map(|(id, law)| ((*id).to_owned(), *law))
            .collect(),
        left: RefCell::new(f64::INFINITY),
        ..Laws::default()
    }
}

fn search(laws: &mut Laws) -> Search<&mut Laws> {
    let candidates: Vec<Candidate> = laws
        .laws
        .iter()
        .map(|(id, law)| law.candidate(id))
        .collect();
    let mut search = Search::new(laws, SPAN, SPAN.duration);
    for candidate in candidates {
        search.add(candidate);
    }
    search
}

/// Parts of the interval in the cheapest run of the whole grid up to 5000 parts.
fn exhaustive(laws: &Laws, goal: Goal) -> Option<(String, u32)> {
    let mut best: Option<(f64, String, u32)> = None;
    for (id, law) in &laws.laws {
        for parts in 1..=5000 {
            let dt = SPAN.interval() / f64::from(parts);
            let row = law.row(id, dt);
            let cost = row.total_cpu_s(SPAN.duration);
            let stable = dt <= law.stable * (1.0 + 1e-9);
            if stable
                && goal.is_met_by(&row)
                && best.as_ref().is_none_or(|(least, ..)| cost < *least)
            {
                best = Some((cost, id.clone(), parts));
            }
        }
    }
    best.map(|(_, id, parts)| (id, parts))
}

fn three_orders() -> Laws {
    laws(&[
        (
            "first",
            Law {
                order: 1,
                factor: 3.0,
                ..PLAIN
            },
        ),
        (
            "second",
            Law {
                stable: 0.0079,
                step: 1.1e-5,
                ..PLAIN
            },
        ),
        (
            "fourth",
            Law {
                order: 4,
                factor: 3e5,
                step: 4.3e-5,
                stable: 0.011,
                ..PLAIN
            },
        ),
    ])
}

#[test]
fn the_whole_grid_holds_nothing_cheaper_for_any_error() {
    for decade in 0..=40 {
        let goal = Goal::error(0.5 * 10f64.powf(-f64::from(decade) / 8.0));
        let mut laws = three_orders();
        let expected = exhaustive(&laws, goal).unwrap();
        let mut search = search(&mut laws);
        search.seek(goal);
        let best = search.cheapest(goal).unwrap();
        let least = {
            let law = three_orders().laws[&expected.0];
            let dt = SPAN.interval() / f64::from(expected.1);
            law.row(&expected.0, dt).total_cpu_s(1.0)
        };
        let cost = best.row.total_cpu_s(1.0);
        assert!(
            cost <= (1.0 + NOISE) * least,
            "{goal:?}: {best:?}, not {expected:?}"
        );
    }
}

#[test]
fn a_few_pilots_stand_for_the_grid() {
    let mut laws = three_orders();
    let mut search = search(&mut laws);
    for error in [1e-2, 1e-3, 1e-4] {
        search.seek(Goal::error(error));
    }
    assert!(search.count() <= 24, "{} pilots", search.count());
}

#[test]
fn a_smaller_error_never_costs_less() {
    let mut last = 0.0;
    for decade in 0..=60 {
        let goal = Goal::error(0.5 * 10f64.powf(-f64::from(decade) / 12.0));
        let mut laws = three_orders();
        let mut search = search(&mut laws);
        search.seek(goal);
        let cost = search.cheapest(goal).unwrap().row.total_cpu_s(1.0);
        assert!(
            cost >= last / (1.0 + WORTH_IT_MARGIN),
            "{goal:?}: {cost} after {last}"
        );
        last = cost;
    }
}

/// Savings below this share are not sought.
const WORTH_IT_MARGIN: f64 = 0.021;

#[test]
fn costly_methods_are_left_once_a_cheap_one_is_known() {
    let mut laws = laws(&[
        (
            "cheap",
            Law {
                factor: 1.0,
                ..PLAIN
            },
        ),
        (
            "slow",
            Law {
                order: 1,
                factor: 10.0,
                ..PLAIN
            },
        ),
    ]);
    search(&mut laws).seek(Goal::error(1e-5));
    let slow = laws.taken.iter().filter(|(id, _)| id == "slow");
    assert_eq!(slow.count(), 1, "{:?}", laws.taken);
}

#[test]
fn set_up_counts_once_for_the_duration() {
    let both = [
        (
            "prepared",
            Law {
                setup: 1.0,
                factor: 1.0,
                ..PLAIN
            },
        ),
        (
            "ready",
            Law {
                factor: 1.0,
                step: 4e-5,
                ..PLAIN
            },
        ),
    ];
    for (duration, expected) in [(1.0, "ready"), (1e4, "prepared")] {
        let mut laws = laws(&both);
        let mut search = Search::new(&mut laws, SPAN, duration);
        both.iter()
            .for_each(|(id, law)| search.add(law.candidate(id)));
        let goal = Goal::error(1e-3);
        search.seek(goal);
        assert_eq!(search.cheapest(goal).unwrap().row.integrator, expected);
    }
}

#[test]
fn one_factorisation_that_costs_too_much_speaks_for_all() {
    let costly = Law {
        setup: 5.0,
        factorizations: 1,
        ..PLAIN
    };
    let mut laws = laws(&[("factor", costly), ("modes", costly), ("quick", PLAIN)]);
    let mut search = Search::new(&mut laws, SPAN, 1.0);
    for id in ["factor", "modes"] {
        search.add(Candidate {
            factorises: true,
            ..costly.candidate(id)
        });
    }
    search.add(PLAIN.candidate("quick"));
    search.seek(Goal::error(1e-2));
    assert_eq!(laws.taken[0].0, "quick");
    let factorised = laws.taken.iter().filter(|(id, _)| id != "quick");
    assert_eq!(factorised.count(), 1, "{:?}", laws.taken);
}

#[test]
fn guarded_runs_never_keep_to_a_goal() {
    let mut laws = laws(&[
        (
            "clamped",
            Law {
                step: 1e-6,
                ..PLAIN
            },
        ),
        ("free", PLAIN),
    ]);
    laws.guarded = vec!["clamped"];
    let mut search = search(&mut laws);
    let goal = Goal::error(1e-2);
    search.seek(goal);
    assert!(
        search
            .by_method(goal)
            .iter()
            .all(|run| run.row.integrator == "free")
    );
    assert_eq!(search.cheapest(goal).unwrap().row.integrator, "free");
}

#[test]
fn an_exact_method_that_falls_short_by_its_own_tolerance_is_left() {
    let mut laws = laws(&[(
        "modes",
        Law {
            floor: 2e-2,
            factor: 0.0,
            ..PLAIN
        },
    )]);
    let mut search = Search::new(&mut laws, SPAN, 1.0);
    search.add(Candidate {
        order: None,
        ..PLAIN.candidate("modes")
    });
    search.seek(Goal::error(1e-2));
    assert_eq!(search.count(), 2);
    assert_eq!(search.cheapest(Goal::error(1e-2)), None);
}

#[test]
fn a_budget_bounds_the_cost_a_second() {
    // At 1e-2 the step is 10 ms: 1e-3 s/s.
    let goal = |budget| Goal {
        error: 1e-2,
        budget,
    };
    let mut enough = laws(&[("second", PLAIN)]);
    let mut search_enough = search(&mut enough);
    search_enough.seek(goal(1.01e-3));
    assert!(search_enough.cheapest(goal(1.01e-3)).is_some());
    let mut less = laws(&[("second", PLAIN)]);
    let mut search_less = search(&mut less);
    search_less.seek(goal(0.99e-3));
    assert_eq!(search_less.cheapest(goal(0.99e-3)), None);
    assert!(search_less.runs().all(|run| run.row.cpu_s_per_s <= 0.99e-3));
}

#[test]
fn a_budget_is_spent_on_the_smallest_error_it_buys() {
    let mut laws = laws(&[("second", PLAIN)]);
    let mut search = search(&mut laws);
    let budget = 0.05;
    search.seek(Goal {
        error: 1e-9,
        budget,
    });
    search.spend(budget);
    let best = search.runs().filter(|run| run.row.cpu_s_per_s <= budget);
    let best = best
        .filter_map(|run| run.row.sound_error())
        .reduce(f64::min);
    // 0.05 s/s buys steps of 0.2 ms.
    let bound = PLAIN.factor * (1e-5 / budget).powi(2);
    assert!(best.unwrap() <= 1.2 * bound, "{best:?} {bound}");
}

#[test]
fn steps_that_miss_a_kink_are_passed_over() {
    let mut laws = laws(&[(
        "exact",
        Law {
            factor: 1e-9,
            ..PLAIN
        },
    )]);
    laws.kink = Some(0.05);
    let mut search = search(&mut laws);
    let goal = Goal::error(1e-3);
    search.seek(goal);
    assert_eq!(search.cheapest(goal).unwrap().row.dt, 0.01);
}

#[test]
fn steps_meet_the_loads_on_the_way_to_a_goal() {
    for error in [1e-2, 1e-3, 3e-5] {
        let mut laws = laws(&[("exact", PLAIN)]);
        laws.for_loads = Some(Ok(7));
        let mut search = search(&mut laws);
        let goal = Goal::error(error);
        search.seek(goal);
        let found = 0.02 / search.cheapest(goal).unwrap().row.dt;
        // 100 dt^2 = error, in the next multiple of 7 parts.
        let enough = 0.02 / (error / 100.0).sqrt();
        let parts = 7.0 * (enough / 7.0 - 1e-9).ceil();
        assert!((found - parts).abs() < 1e-6, "{error}: {found}, {parts}");
        for (_, dt) in &laws.taken {
            let sevenths = 0.02 / dt / 7.0;
            assert!((sevenths - sevenths.round()).abs() < 1e-9, "{dt}");
        }
    }
}

#[test]
fn a_method_that_takes_the_loads_at_no_step_is_never_begun() {
    let mut laws = laws(&[("exact", PLAIN)]);
    laws.for_loads = Some(Err(unfit(0.3, 1.0)));
    let mut search = search(&mut laws);
    search.seek(Goal::error(1e-2));
    let refused = search.into_refused();
    let [(_, PilotError::Loads(reason))] = &refused[..] else {
        panic!("{refused:?}");
    };
    assert_eq!(*reason, unfit(0.3, 1.0));
    assert!(laws.taken.is_empty());
}

#[test]
fn a_method_that_never_runs_is_named_with_its_reason() {
    let mut laws = laws(&[("exact", PLAIN)]);
    laws.kink = Some(std::f64::consts::PI);
    let mut search = search(&mut laws);
    search.seek(Goal::error(1e-3));
    assert_eq!(search.count(), 0);
    let refused = search.into_refused();
    let [(method, PilotError::Loads(reason))] = &refused[..] else {
        panic!("{refused:?}");
    };
    assert_eq!(method.integrator, "exact");
    assert_eq!(reason.instant, std::f64::consts::PI);
}

#[test]
fn a_search_out_of_time_says_so() {
    let mut laws = three_orders();
    laws.left = RefCell::new(0.02);
    let mut search = search(&mut laws);
    search.seek(Goal::error(1e-5));
    assert!(search.cut_short());
    assert!(*laws.left.borrow() >= 0.0, "time was overdrawn");
}

#[test]
fn a_survey_takes_each_integrator_to_its_own_best() {
    let second = Law {
        step: 2e-5,
        ..PLAIN
    };
    let mut laws = laws(&[
        ("best", PLAIN),
        ("second", second),
        (
            "far",
            Law {
                step: 1e-3,
                ..PLAIN
            },
        ),
    ]);
    let mut search = search(&mut laws);
    let goal = Goal::error(1.3e-4);
    search.seek(goal);
    search.survey(goal, 4.0);
    // 100 dt^2 = 1.3e-4 at 1.14 ms: 18 parts of 20 ms.
    let found: Vec<(&str, u32)> = search
        .by_method(goal)
        .iter()
        .map(|run| {
            (
                run.row.integrator.as_str(),
                (0.02 / run.row.dt).round() as u32,
            )
        })
        .collect();
    assert_eq!(found, [("best", 18), ("second", 18)]);
}

#[test]
fn a_method_whose_first_step_is_too_short_to_win_is_never_begun() {
    let creeping = Law {
        order: 1,
        stable: 1e-6,
        ..PLAIN
    };
    let mut laws = laws(&[("creeping", creeping), ("plain", PLAIN)]);
    laws.least_step = 0.5e-5;
    search(&mut laws).seek(Goal::error(1e-2));
    assert!(
        laws.taken.iter().all(|(id, _)| id == "plain"),
        "{:?}",
        laws.taken
    );
}

#[test]
fn errors_that_begin_on_a_plateau_are_followed_to_the_same_step() {
    // Waves that are out of phase are as wrong as they can be: no order shows before 2.4 ms.
    let plateau = Law {
        factor: 1e5,
        cap: 0.6,
        ..PLAIN
    };
    // 1e5 dt^2 at 20 ms / 29 and 20 ms / 200.
    for (error, expected) in [(5e-2, 29.0), (1e-3, 200.0)] {
        let mut laws = laws(&[("waves", plateau)]);
        let mut search = search(&mut laws);
        let goal = Goal::error(error);
        search.seek(goal);
        let parts = 0.02 / search.cheapest(goal).unwrap().row.dt;
        assert!(
            (expected - 0.1..=1.021 * expected).contains(&parts),
            "{parts} parts"
        );
        assert!(search.count() <= 12, "{} pilots", search.count());
    }
}

#[test]
fn the_first_stable_step_may_cost_more_than_a_budget() {
    let small = Law {
        stable: 1e-3,
        ..PLAIN
    };
    let mut laws = laws(&[("small", small)]);
    let mut search = search(&mut laws);
    let goal = Goal {
        error: 1e-2,
        budget: 5e-3,
    };
    search.seek(goal);
    // Steps of 1 ms cost 0.01 s/s.
    assert_eq!(search.cheapest(goal), None);
    assert!(search.cheapest(Goal::error(1e-2)).is_some());
}
