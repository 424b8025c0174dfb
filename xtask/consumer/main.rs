//! A program that uses the library from its packages: a scene, an equilibrium by factorisation, and a run that stays in
//! it.

use sinew::prelude::*;
use sinew::scene::SceneSource;

/// Without lateral contraction a compressed cube becomes shorter by `p L / E` (m).
const SHORTER: f64 = 10.0 * 0.1 / 3500.0;

const PRESSED: &str = r#"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.0
[[fixed]]
group = "bottom"
[[load]]
name = "press"
group = "top"
traction = [0.0, 0.0, -10.0]
[[initial]]
static = ["press"]
[run]
duration = 0.1
integrator = "newmark"
dt = 0.01
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::parse(SceneSource::new("pressed.toml", PRESSED.to_owned()))?;
    let simulation = scene.build()?;
    let mut state = simulation.initial_state().clone();
    let mut method = simulation.integrator()?;
    let (system, run) = (simulation.system(), simulation.run());
    let report = simulate(system, &mut *method, &mut state, &run, &mut ())?;
    assert_eq!(report.outcome, Outcome::Finished);
    let lowest = state.u.iter().copied().fold(0.0, f64::min);
    assert!((lowest / -SHORTER - 1.0).abs() < 1e-9, "{lowest} m, not -{SHORTER}");
    println!("packed crates: a pressed cube is shorter by {:.6} mm", -1e3 * lowest);
    Ok(())
}
