//! References of bodies in contact with tools.

use sinew_measure::{Case, Effort, MethodChoice, measure};
use sinew_scene::{Scene, SceneSource};

/// A plate moves down on a bar of one cell without lateral contraction.
const PLATE: &str = r#"
title = "a plate on a bar"
[mesh]
block = { cells = [1, 1, 1], size = [0.1, 0.1, 0.2] }
[[region]]
density = 1000.0
model = "linear"
youngs_modulus = 5000.0
poissons_ratio = 0.0
[damping]
mass = 3.0
[[fixed]]
group = "bottom"
[[tool]]
name = "plate"
shape = { plane = {} }
rotation = [3.141592653589793, 0.0, 0.0]
start = [0.0, 0.0, 0.205]
velocity = [0.0, 0.0, -0.1]
[run]
duration = 0.25
samples = 5
integrator = "central-difference"
dt = 0.01
[[probe]]
name = "top"
point = [0.0, 0.0, 0.2]
"#;

fn case() -> Case {
    let scene = Scene::parse(SceneSource::new("plate.toml", PLATE)).unwrap();
    Case::new("plate", scene.build().unwrap()).unwrap()
}

/// From the contact at .05 s on, every node of the top moves with the plate: the force is that of the strain and of
/// damping, and at first contact the momentum of the lumped mass of the top is transferred at once.
#[test]
fn a_pressed_bar_follows_the_plate_and_its_impulse_is_the_closed_form() {
    let case = case();
    let track = case.samples();
    let body = case.simulation().model().body().unwrap();
    let top: f64 = (0..body.mesh.points.len())
        .filter_map(|node| body.model.cell_of_node(node as u32))
        .map(|cell| case.simulation().system().mass()[3 * cell as usize])
        .sum();
    let stiffness = 5000.0 * 0.01 / 0.2;
    let (speed, rate) = (0.1, 3.0);
    for (t, (u, impulses)) in track
        .times
        .iter()
        .zip(track.displacements.iter().zip(&track.impulses))
    {
        let pressed = (t - 0.05).max(0.0);
        for own in u.chunks_exact(3) {
            assert!((own[2] + speed * pressed).abs() < 1e-6, "{own:?} at {t} s");
            assert!(own[0].abs() < 1e-9 && own[1].abs() < 1e-9);
        }
        if pressed < 1e-9 {
            // Whether the touch is before this instant or after is a matter of rounding.
            continue;
        }
        let of_motion = top * speed * (1.0 + rate * pressed);
        let of_strain = 0.5 * stiffness * speed * pressed.powi(2);
        let expected = of_motion + of_strain;
        let found = impulses[2];
        assert!(
            (found - expected).abs() < 1e-4 * expected,
            "{found}, {expected} at {t} s"
        );
    }
    assert!(track.error < 1e-3, "{}", track.error);
}

#[test]
fn errors_of_motion_and_of_force_fall_with_the_step() {
    let mut case = case();
    let mut error = |dt: f64| {
        let method = MethodChoice::new("symplectic-euler");
        let row = measure(&mut case, &method, dt, Effort::UNTIMED).unwrap();
        (row.error.unwrap(), row.force_error.unwrap())
    };
    let (long, short) = (error(0.01), error(0.001_25));
    assert!(short.1 < 0.25 * long.1, "{long:?} {short:?}");
    assert!(long.1 < 0.3, "{long:?}");
    assert!(short.0 <= long.0 + 1e-9, "{long:?} {short:?}");
}
