//! Random drags, which end no session.

use sinew_scene::{Scene, SceneSource};
use sinew_world::Replay;

use super::Engine;
use crate::door::Door;
use crate::inbox::Place;
use crate::live::{Live, Settings};
use crate::pane_choice::PaneChoice;
use crate::server::Shared;

/// A block of soft tissue under a ball, which drags push far in, through and aside.
const BLOCK: &str = r#"
[mesh]
block = { cells = [4, 4, 2], size = [0.1, 0.1, 0.05] }
[[region]]
density = 1060.0
model = "neo-hookean"
youngs_modulus = 3000.0
poissons_ratio = 0.45
[damping]
mass = 5.0
[[fixed]]
group = "bottom"
[[tool]]
name = "ball"
shape = { sphere = { radius = 0.012 } }
start = [0.05, 0.05, 0.065]
hold = true
friction = 0.5
[run]
duration = 1.0
integrator = "central-difference"
dt = 0.0005
"#;

/// Numbers from 0 to 1, the same in each run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Drags a tool of a scene to random places in the box around the body, twice as large as that: as many straight drags
/// with a mouse of this rate (Hz). Returns how often the motion went back.
fn drag(
    engine: &mut Engine,
    shared: &Shared,
    drags: usize,
    rate: f64,
    numbers: &mut Numbers,
) -> usize {
    let (low, high) = bounds(engine);
    let mut place = engine.panes[0].tool_pose(0);
    let mut went_back = 0;
    for drag in 0..drags {
        let to: [f64; 3] = std::array::from_fn(|axis| {
            let middle = 0.5 * (low[axis] + high[axis]);
            middle + 2.0 * (numbers.next() - 0.5) * (high[axis] - low[axis])
        });
        let from = place;
        let time = 0.1 + 0.5 * numbers.next();
        let events = (time * rate).ceil();
        let (begun, mut event) = (engine.t(), 0.0);
        let mut passed = 0.0;
        while event <= events {
            if passed >= event / rate {
                let share = event / events;
                for axis in 0..3 {
                    place[axis] = from[axis] + share * (to[axis] - from[axis]);
                }
                engine
                    .lead(
                        1,
                        drag as u32 + 1,
                        Place {
                            tool: 0,
                            pose: place,
                        },
                    )
                    .unwrap();
                event += 1.0;
            }
            let before = engine.t();
            engine.take_tick(shared, || true);
            passed += engine.tick();
            went_back += usize::from(engine.t() < before);
            let stopped = engine.panes[0].stopped.clone();
            assert_eq!(stopped, None, "{rate} Hz, drag {drag} from {begun} s");
        }
    }
    went_back
}

/// The box around the body at rest.
fn bounds(engine: &Engine) -> ([f64; 3], [f64; 3]) {
    let points = &engine.uncut.points;
    let bound = |pick: fn(f64, f64) -> f64| {
        let first = points[0];
        points.iter().fold(first, |found, point| {
            std::array::from_fn(|axis| pick(found[axis], point[axis]))
        })
    };
    (bound(f64::min), bound(f64::max))
}

fn open(text: &str, hand_speed: Option<f64>) -> (Scene, Engine, std::sync::Arc<Shared>) {
    let scene = Scene::parse(SceneSource::new("block.toml", text)).unwrap();
    let settings = Settings {
        scene: scene.clone(),
        values: Vec::new(),
        panes: vec![PaneChoice::default()],
        second: PaneChoice::default(),
        hand_speed,
        from_start: None,
    };
    let door = Door::open(0).unwrap();
    let (engine, shared) = Live::open(&door, settings).unwrap().into_engine();
    (scene, engine, shared)
}

#[test]
fn no_drag_of_any_mouse_ends_a_session_and_its_log_gives_what_was_seen() {
    for (rate, seed) in [(30.0, 1), (60.0, 2), (144.0, 3)] {
        let (scene, mut engine, shared) = open(BLOCK, None);
        drag(&mut engine, &shared, 8, rate, &mut Numbers(seed));
        let pane = engine.panes.remove(0);
        let mut replay = Replay::new(scene, pane.log().clone()).unwrap();
        while replay.step().unwrap().is_some() {}
        assert_eq!(replay.world().state().u, pane.u(), "{rate} Hz");
    }
}

#[test]
fn a_hand_that_is_too_fast_for_the_tissue_goes_back_and_goes_on() {
    // Without a limit of speed, and a law that ends at twice its length.
    let text = BLOCK.replace(
        "model = \"neo-hookean\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.45\n",
        "model = \"gent\"\nshear_modulus = 1000.0\nlimit = 0.5\nbulk_modulus = 10000.0\n",
    );
    let (scene, mut engine, shared) = open(&text, Some(50.0));
    let went_back = drag(&mut engine, &shared, 12, 60.0, &mut Numbers(7));
    assert!(went_back > 0, "nothing failed");
    let pane = engine.panes.remove(0);
    let mut replay = Replay::new(scene, pane.log().clone()).unwrap();
    while replay.step().unwrap().is_some() {}
    assert_eq!(replay.world().state().u, pane.u());
}
