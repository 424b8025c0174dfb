//! Promises of a batch to a machine with its own memory: the parts that the host reads and changes, stated in advance.

use std::cell::RefCell;

use sinew_core::{
    AllShown, Batch, Contact, EnergyBehaviour, Equations, EvaluationError, ForceLaw, ForceModel,
    Inertia, Inputs, Integrator, Layers, LoadTime, Meeting, Moment, Needs, Prepared, Properties,
    RecordError, Recorder, Revision, Run, SetupError, ShowCells, StableStep, State, StepError,
    StepReport, Stepped, System, Trial, Verdict, Watch, simulate, worst_beyond,
};

const STIFFNESS: [f64; 3] = [1.0, 2.0, 0.5];

/// Masses of 1 kg, each on a spring of its own.
struct Springs;

impl ForceLaw for Springs {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        for ((out, u), k) in out.iter_mut().zip(trial.u).zip(STIFFNESS) {
            *out = -k * u;
        }
        Ok(())
    }
    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }
}

/// A stop at 0.1 m for cell 1.
#[derive(Debug)]
struct Stop;

impl Contact for Stop {
    fn cells(&self) -> &[u32] {
        &[1]
    }
    fn rest(&self) -> &[[f64; 3]] {
        &[[0.0; 3]]
    }
    fn kept(&self) -> usize {
        0
    }
    fn meet(
        &self,
        _: &Meeting<'_>,
        _: &mut dyn ShowCells,
        state: &mut State,
        pushed: &mut Vec<u32>,
    ) {
        assert!(state.u[1].is_finite() && state.v[1].is_finite());
        if state.u[1] > 0.1 {
            (state.u[1], state.v[1]) = (0.1, 0.0);
            pushed.push(1);
        }
    }
    fn impulses(&self, _: &State) -> Vec<[f64; 3]> {
        Vec::new()
    }
    fn work(&self, _: &State) -> f64 {
        0.0
    }
    fn add_forces(&self, _: &State, _: bool, _: &mut [f64]) {}
}

/// The springs, with or without a stop; the system reads each step or not.
struct Body {
    springs: ForceModel<Springs>,
    stop: Option<Stop>,
    looks: bool,
}

impl System for Body {
    fn dofs(&self) -> usize {
        self.springs.dofs()
    }
    fn layers(&self) -> Layers {
        self.springs.layers()
    }
    fn mass(&self) -> &[f64] {
        self.springs.mass()
    }
    fn revision(&self) -> Revision {
        self.springs.revision()
    }
    fn equations(&self) -> Equations<'_> {
        self.springs.equations()
    }
    fn contact(&self) -> Option<&dyn Contact> {
        self.stop.as_ref().map(|stop| stop as &dyn Contact)
    }
    fn looks_at_steps(&self) -> bool {
        self.looks
    }
    fn accept(&self, state: &mut State, _: &Inputs, _: f64) -> Result<(), EvaluationError> {
        assert!(!self.looks || state.u.iter().all(|u| u.is_finite()));
        Ok(())
    }
}

/// Symplectic Euler with its own memory. A sparing one shows the host only what the batch requested.
struct Device {
    spares: bool,
    a: Vec<f64>,
    /// Steps at which it showed all cells, some, and none.
    shown: [usize; 3],
}

impl Integrator for Device {
    fn id(&self) -> &'static str {
        "device"
    }
    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
    }
    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check(self.id(), system, dt)?;
        self.a.resize(system.dofs(), 0.0);
        Ok(StepReport::default())
    }
    fn stable_step_about(
        &self,
        _: &dyn System,
        _: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        Ok(StableStep::Unknown)
    }
    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let (mut u, mut v) = (state.u.clone(), state.v.clone());
        let told = |batch: &Batch<'_>, ahead| {
            let needs = batch.host_needs(ahead);
            (needs.all, needs.watched.to_vec(), needs.contact.to_vec())
        };
        let beforehand: Vec<_> = (0..batch.parts_left())
            .map(|ahead| told(batch, ahead))
            .collect();
        let alone = batch.steps_alone();
        for (number, expected) in beforehand.iter().enumerate() {
            if !batch.goes_on() {
                break;
            }
            assert_eq!(told(batch, 0), *expected, "step {number} of a batch");
            let needs = batch.host_needs(0);
            assert_eq!(batch.steps_alone() == 0, !needs.is_empty());
            assert!(number >= alone || needs.is_empty());
            assert!(number != alone || !needs.is_empty());
            let (watched, contact) = (needs.watched.to_vec(), needs.contact.to_vec());
            let (step, all) = (batch.step(), needs.all || !self.spares);
            let place = if all {
                0
            } else {
                1 + usize::from(needs.is_empty())
            };
            self.shown[place] += 1;

            let own = State {
                u: std::mem::take(&mut u),
                v: std::mem::take(&mut v),
                ..state.clone()
            };
            step.acceleration(LoadTime::start_of(own.t(), step.dt), &own, &mut self.a)?;
            (u, v) = (own.u, own.v);
            for ((u, v), a) in u.iter_mut().zip(&mut v).zip(&self.a) {
                *v += step.dt * a;
                *u += step.dt * *v;
            }
            state.u.fill(f64::NAN);
            state.v.fill(f64::NAN);
            let exceeded = worst_beyond(&u, batch.divergence_limit()).is_some();
            let mut show = |dof: usize| (state.u[dof], state.v[dof]) = (u[dof], v[dof]);
            match all || exceeded {
                true => (0..u.len()).for_each(show),
                false => contact
                    .iter()
                    .chain(&watched)
                    .for_each(|dof| show(*dof as usize)),
            }
            let mut pushed = Vec::new();
            let inertia = (Inertia::Mass(1.0), f64::INFINITY);
            batch.meet((state, &mut AllShown), inertia, None, &mut pushed);
            for cell in pushed {
                assert!(contact.contains(&cell));
                (u[cell as usize], v[cell as usize]) =
                    (state.u[cell as usize], state.v[cell as usize]);
            }
            let stepped = Stepped::at_same_time(StepReport::ONE_FORCE);
            match exceeded {
                true => batch.end_step(state, stepped)?,
                false => batch.end_step_within_limit(state, stepped)?,
            }
        }
        Ok(())
    }
}

/// Records every `every`th state and samples some degrees of freedom.
struct Seen {
    every: usize,
    dofs: Vec<u32>,
    told: RefCell<Vec<(f64, Vec<f64>)>>,
}

impl Recorder for Seen {
    fn next(&mut self, step: usize) -> Option<usize> {
        (self.every > 0).then(|| step.next_multiple_of(self.every))
    }
    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let values = moment.state.u.iter().chain(&moment.state.v).copied();
        self.told
            .borrow_mut()
            .push((moment.state.t(), values.collect()));
        Ok(Verdict::Continue)
    }
    fn watches(&self) -> Vec<u32> {
        self.dofs.clone()
    }
    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        self.told.borrow_mut().push((t, u.to_vec()));
        Ok(Verdict::Continue)
    }
}

fn body(has_stop: bool, looks: bool) -> Body {
    Body {
        springs: ForceModel::new(Springs, &[1.0; 3], Layers::One),
        stop: has_stop.then_some(Stop),
        looks,
    }
}

fn start() -> State {
    State::new(vec![0.1, 0.05, -0.2], vec![0.05, 0.3, 0.1])
}

#[test]
fn a_machine_that_shows_what_is_asked_for_alone_gives_what_one_that_shows_all_gives() {
    for (has_stop, looks) in [(false, false), (true, false), (false, true)] {
        for (every, dofs) in [
            (1, vec![]),
            (7, vec![]),
            (7, vec![2, 0]),
            (0, vec![1]),
            (0, vec![]),
        ] {
            let run = |spares| {
                let body = body(has_stop, looks);
                let mut device = Device {
                    spares,
                    a: Vec::new(),
                    shown: [0; 3],
                };
                let mut seen = Seen {
                    every,
                    dofs: dofs.clone(),
                    told: RefCell::default(),
                };
                let mut state = start();
                let run = Run {
                    dt: 0.5,
                    steps: 40,
                    divergence_limit: f64::INFINITY,
                };
                simulate(&body, &mut device, &mut state, &run, &mut seen).unwrap();
                (state, seen.told.into_inner(), device.shown)
            };
            let (state, told, shown) = run(true);
            let (expected, expected_told, _) = run(false);
            let case = format!("stop {has_stop}, looks {looks}, every {every}, {dofs:?}");
            assert_eq!((&state, &told), (&expected, &expected_told), "{case}");
            // All cells cross where a row is written, at the end, and where the system looks.
            let rows = match every {
                0 => 1,
                every => 40_usize.div_ceil(every),
            };
            let all = if looks { 40 } else { rows };
            let some = has_stop || !dofs.is_empty();
            let expected = match some {
                true => [all, 40 - all, 0],
                false => [all, 0, 40 - all],
            };
            assert_eq!(shown, expected, "{case}");
        }
    }
}

#[test]
fn substeps_are_sampled_at_the_ends_of_steps_alone() {
    let body = body(false, false);
    let mut watch = Watch::new(vec![1], 6);
    let mut device = Device {
        spares: true,
        a: vec![0.0; 3],
        shown: [0; 3],
    };
    let mut state = start();
    let mut batch = Batch::new(&body, Inputs::none(), 0.5, 6).with_watch(&mut watch);
    assert_eq!(batch.steps_alone(), 0);
    batch
        .in_parts(4, |batch| {
            assert_eq!(batch.steps_alone(), 3);
            device.run(batch, &mut state)
        })
        .unwrap();
    assert_eq!(device.shown, [1, 5, 18]);
    assert_eq!(watch.samples().count(), 6);
    assert!(watch.samples().all(|(_, u)| u[0].is_finite()));
    assert!(state.u.iter().all(|u| u.is_finite()));
    // Without a watch all but the last substep are alone.
    let mut batch = Batch::new(&body, Inputs::none(), 0.5, 6);
    batch.in_parts(4, |batch| assert_eq!(batch.steps_alone(), 23));
}
