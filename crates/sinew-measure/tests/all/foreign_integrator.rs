//! Tests that an integrator outside the list is measured like those in the list.

use std::time::Duration;

use sinew_core::{
    Batch, CostClock, EnergyBehaviour, Integrator, LoadTime, Needs, Options, Prepared, Properties,
    SetupError, StableStep, State, StepError, StepReport, Stepped, System,
};
use sinew_measure::{
    Case, Effort, MeasureError, MethodChoice, Row, RowOutcome, measure, measure_with,
};
use sinew_scene::{Scene, SceneSource};

/// Symplectic Euler as someone else would write it: `v += dt a(u, v)`, then `u += dt v`.
#[derive(Default)]
struct Foreign {
    a: Vec<f64>,
    /// Time that a device takes for a step, while this thread waits.
    waits: Duration,
    clock: CostClock,
}

impl Integrator for Foreign {
    fn id(&self) -> &'static str {
        "theirs"
    }

    fn properties(&self) -> Properties {
        Properties::of_order(1, Needs::Forces, EnergyBehaviour::Bounded)
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check("theirs", system, dt)?;
        self.a.resize(system.dofs(), 0.0);
        Ok(StepReport::default())
    }

    fn stable_step_about(
        &self,
        _system: &dyn System,
        _state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        Ok(StableStep::Unknown)
    }

    fn cost_clock(&self) -> CostClock {
        self.clock
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        batch.each(state, |step, state| {
            std::thread::sleep(self.waits);
            let load = LoadTime::start_of(state.t(), step.dt);
            step.acceleration(load, state, &mut self.a)?;
            for ((u, v), a) in state.u.iter_mut().zip(&mut state.v).zip(&self.a) {
                *v += step.dt * a;
                *u += step.dt * *v;
            }
            Ok(Stepped::at_same_time(StepReport::ONE_FORCE))
        })
    }
}

fn cube() -> Case {
    let text = "[mesh]\ncube = { cells = 3, edge = 0.1 }\n\
        [[region]]\ndensity = 1060.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\n\
        poissons_ratio = 0.3\n[damping]\nmass = 20.0\n[[fixed]]\ngroup = \"sides\"\n\
        [[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -100.0]\n\
        [run]\nduration = 0.4\nsamples = 20\nintegrator = \"rk4\"\ndt = 0.02\n";
    let scene = Scene::parse(SceneSource::new("cube.toml", text)).unwrap();
    Case::new("cube", scene.build().unwrap()).unwrap()
}

#[test]
fn its_row_is_that_of_its_built_in_twin_under_its_own_name() {
    let mut case = cube();
    // The plain loops, whose order of operations the foreign one has.
    let plain = Options::new().with_text("machine", "reference");
    let twin = MethodChoice::new("symplectic-euler").with_options(&plain);
    // A step that meets the instants of the error, one that does not, and one that diverges.
    for (dt, ends) in [
        (0.004, RowOutcome::Finished),
        (0.003, RowOutcome::Finished),
        (0.02, RowOutcome::Diverged),
    ] {
        let mut foreign = Foreign::default();
        let theirs = measure_with(&mut case, "mine", &mut foreign, dt, Effort::UNTIMED).unwrap();
        let ours = measure(&mut case, &twin, dt, Effort::UNTIMED).unwrap();
        assert_eq!(theirs.outcome, ends, "{dt} s");
        assert_eq!(theirs.error.is_some(), ends == RowOutcome::Finished);
        assert_eq!(theirs.label(), "mine");
        let renamed = Row {
            integrator: ours.integrator.clone(),
            options: ours.options.clone(),
            kernel: Some("reference".into()),
            setup_cpu_s: ours.setup_cpu_s,
            ..theirs
        };
        assert_eq!(renamed, ours, "{dt} s");
    }
}

#[test]
fn what_it_refuses_is_the_error_of_the_measurement() {
    let mut case = cube();
    let refused = measure_with(
        &mut case,
        "mine",
        &mut Foreign::default(),
        f64::NAN,
        Effort::UNTIMED,
    );
    assert!(
        matches!(refused, Err(MeasureError::Setup(_))),
        "{refused:?}"
    );
}

/// A device takes 1 ms for each of 100 steps, in which the waiting thread uses almost no CPU time.
#[test]
fn its_cost_is_told_by_the_clock_that_it_names() {
    let mut case = cube();
    let mut cost = |clock| {
        let mut device = Foreign {
            waits: Duration::from_millis(1),
            clock,
            ..Foreign::default()
        };
        let row = measure_with(&mut case, "device", &mut device, 0.004, Effort::QUICK).unwrap();
        row.cpu_s_per_s * 0.4
    };
    let wall = CostClock::Wall {
        reason: "the steps run on a device",
    };
    assert_eq!(
        wall.in_words(),
        "wall time, since the steps run on a device"
    );
    let by_wall = cost(wall);
    assert!(by_wall >= 0.1, "{by_wall} s");
    let by_thread = cost(CostClock::CallingThread);
    assert!(by_thread < 0.5 * by_wall, "{by_thread} s");
}
