//! Recorders of a world: the states that each receives, and the batches of steps between them.

use sinew_core::{Moment, RecordError, Recorder as _, Verdict};
use sinew_scene::{Scene, SceneSource};
use sinew_world::{BodyChange, Ended, Recorder, Recorders, World};

use crate::common::{build, following};

const SPRING: &str = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 1.0\nvelocity = -5.0\n\
                      [run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = 0.01\n";

/// A recorder that requests every nth step, and watches degrees of freedom.
#[derive(Default)]
struct Wishes {
    every: usize,
    watches: Vec<u32>,
    stop_at: Option<usize>,
    steps: Vec<usize>,
    rows: Vec<(f64, Vec<f64>)>,
    changes: Vec<(usize, usize)>,
}

impl Wishes {
    fn new(every: usize, watches: &[u32]) -> Self {
        Self {
            every,
            watches: watches.to_vec(),
            ..Self::default()
        }
    }
}

impl sinew_core::Recorder for Wishes {
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(step.next_multiple_of(self.every))
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self.steps.push(moment.step);
        Ok(match self.stop_at == Some(moment.step) {
            true => Verdict::Stop,
            false => Verdict::Continue,
        })
    }

    fn watches(&self) -> Vec<u32> {
        self.watches.clone()
    }

    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        self.rows.push((t, u.to_vec()));
        Ok(Verdict::Continue)
    }
}

impl Recorder for Wishes {
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        let dofs = change.body.system().dofs();
        self.watches
            .iter_mut()
            .for_each(|dof| *dof = dofs as u32 - 1);
        self.changes.push((change.steps, dofs));
        Ok(())
    }
}

fn spring() -> World {
    let scene = Scene::parse(SceneSource::new("spring.toml", SPRING));
    following(scene.and_then(Scene::build).unwrap())
}

#[test]
fn each_of_several_recorders_sees_what_it_wants_and_one_stops_all() {
    let [mut thirds, mut fifths] = [Wishes::new(3, &[0]), Wishes::new(5, &[])];
    let mut stops = Wishes {
        stop_at: Some(17),
        ..Wishes::new(17, &[0])
    };
    let mut all = Vec::new();
    let mut every_state = |moment: &Moment<'_>| {
        all.push((moment.state.t(), vec![moment.state.u[0]]));
        Ok(Verdict::Continue)
    };
    let mut recorders = Recorders::new()
        .with(&mut thirds)
        .with(&mut fifths)
        .with(&mut stops)
        .with(&mut every_state);
    let mut world = spring();
    let ended = world.advance(40, &mut recorders).unwrap();
    assert_eq!((ended, world.steps()), (Ended::Stopped, 17));
    assert_eq!(thirds.steps, [0, 3, 6, 9, 12, 15]);
    assert_eq!(fifths.steps, [0, 5, 10, 15]);
    assert_eq!(stops.steps, [0, 17]);
    assert_eq!((thirds.rows, fifths.rows), (all.clone(), Vec::new()));
    assert_eq!(stops.rows, all);
}

#[test]
fn recorders_that_want_little_do_not_cut_batches() {
    let [mut one, mut other] = [Wishes::new(100, &[]), Wishes::new(70, &[])];
    let mut recorders = Recorders::new().with(&mut one).with(&mut other);
    assert_eq!(recorders.next(1), Some(70));
    assert_eq!(recorders.next(71), Some(100));
    assert_eq!(recorders.next(101), Some(140));
    assert_eq!(Recorders::new().next(0), None);
}

/// A motion taken in steps, in parts or at once has the same states, and each is received once.
#[test]
fn a_motion_in_parts_is_one_motion() {
    let (mut at_once, mut in_parts, mut by_steps) = (spring(), spring(), spring());
    let [mut whole, mut parts] = [(); 2].map(|()| Wishes::new(4, &[0]));
    at_once.advance_to(0.4, &mut whole).unwrap();
    let mut shown = in_parts.show(&mut parts);
    for steps in [1, 0, 10, 7, 22] {
        let ended = in_parts.advance_shown(steps, &mut shown).unwrap();
        assert_eq!(ended, Ended::Finished);
    }
    assert_eq!(shown.steps(), 40);
    for _ in 0..40 {
        by_steps.step().unwrap();
    }
    assert_eq!(at_once.state(), in_parts.state());
    assert_eq!(at_once.state(), by_steps.state());
    assert_eq!((whole.rows, whole.steps), (parts.rows, parts.steps));
}

#[test]
fn a_recorder_ends_a_motion_of_any_number_of_steps() {
    let mut world = spring();
    let mut stops = StopsAt(5);
    let mut shown = world.show(&mut stops);
    world.advance_shown(2, &mut shown).unwrap();
    let ended = world.advance_shown(usize::MAX, &mut shown).unwrap();
    assert_eq!((ended, shown.steps()), (Ended::Stopped, 5));
}

/// A recorder that stops a motion after this number of steps.
struct StopsAt(usize);

impl sinew_core::Recorder for StopsAt {
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(step)
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        Ok(match moment.step >= self.0 {
            true => Verdict::Stop,
            false => Verdict::Continue,
        })
    }
}

impl Recorder for StopsAt {}

/// A recorder is notified of each cut between the last step on the body before and the first on the body after, and
/// watches the new body.
#[test]
fn a_recorder_follows_the_body_through_its_cuts() {
    let text = "[mesh]\ncube = { cells = 2, edge = 0.02 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                youngs_modulus = 3500.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"knife\"\n\
                shape = { blade = { length = 0.04 } }\nstart = [-0.001, 0.01, 0.0107]\n\
                rotation = [1.5707963267948966, 0.0, 0.0]\nvelocity = [1.0, 0.0, 0.0]\n[cutting]\ntool = \"knife\"\n\
                [run]\nduration = 0.03\nintegrator = \"central-difference\"\ndt = 2e-4\n";
    let mut world = following(build(text));
    let before = world.body().system().dofs();
    let mut wishes = Wishes::new(1, &[0]);
    assert_eq!(
        world.advance_to(0.03, &mut wishes).unwrap(),
        Ended::Finished
    );
    let dofs = world.body().system().dofs();
    assert!(dofs > before);
    assert_eq!(wishes.changes.last().unwrap().1, dofs);
    assert!(
        wishes
            .changes
            .iter()
            .all(|(step, _)| (1..150).contains(step)),
        "{:?}",
        wishes.changes
    );
    assert_eq!(wishes.steps, (0..=150).collect::<Vec<_>>());
    assert_eq!(wishes.rows.len(), 151);
    assert_eq!(wishes.rows[150].1, [world.state().u[dofs - 1]]);
}
