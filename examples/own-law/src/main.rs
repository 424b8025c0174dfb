//! A law of large deformation written outside sinew's crates.
//!
//! A law is a struct that implements [`HyperelasticLaw`](sinew_fem::hyperelastic::HyperelasticLaw): its energy, stress
//! and tangent, and its parameters, from which keys of scenes, their checks and their help follow. `src/demiray.rs` is
//! the whole law, with a parameter that no other law has. [`register`] adds it to
//! the models that scenes know; its loops are compiled for its own type.
//!
//! ```sh
//! cargo test              # the suite that every law passes
//! cargo run --release     # a scene with the law, against its closed form
//! ```
//!
//! The example ends with an error unless a cube that is pressed between its sides comes to rest at the stretch of the
//! closed form.

mod demiray;

use std::error::Error;

use demiray::Demiray;
use sinew_fem::hyperelastic::register;
use sinew_scene::{Scene, SceneSource};

/// Pressure on the top (Pa).
const PRESSURE: f64 = 2000.0;

const SCENE: &str = r#"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1060.0
model = "demiray"
youngs_modulus = 3500.0
poissons_ratio = 0.3
stiffening = 0.5
[damping]
mass = 80.0
[[fixed]]
group = "bottom"
[[fixed]]
group = "sides"
axes = "xy"
[[load]]
group = "top"
traction = [0.0, 0.0, -2000.0]
ramp = { kind = "sin2", rise = 0.2 }
[run]
duration = 1.0
integrator = "central-difference"
dt = "auto"
"#;

/// Nominal stress (Pa) of the law along the only stretch: `mu (l exp(b (l^2 - 1)) - 1/l) + (lambda - 2 b mu) (l - 1)`.
fn closed_form(stretch: f64) -> f64 {
    let (modulus, nu, b) = (3500.0, 0.3, 0.5);
    let mu = modulus / (2.0 * (1.0 + nu));
    let lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu);
    let grown = (b * (stretch * stretch - 1.0_f64)).exp();
    mu * (stretch * grown - 1.0 / stretch) + (lambda - 2.0 * b * mu) * (stretch - 1.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    register::<Demiray>()?;
    let simulation = Scene::parse(SceneSource::new("pressed.toml", SCENE))?.build()?;
    let mut integrator = simulation.integrator()?;
    let mut state = simulation.initial_state().clone();
    let (system, run) = (simulation.system(), simulation.run());
    sinew_core::simulate(system, &mut *integrator, &mut state, &run, &mut ())?;
    let lowest = state.u.iter().copied().fold(0.0, f64::min);
    let stretch = 1.0 + lowest / 0.1;
    let stress = closed_form(stretch);
    println!(
        "pressed to {stretch:.6} of its height: {stress:.4} Pa by the closed form, {:.1} Pa on the top",
        -PRESSURE
    );
    if (stress / -PRESSURE - 1.0).abs() > 1e-6 {
        return Err("expected the stress of the closed form".into());
    }
    Ok(())
}
