//! A time integrator written outside sinew's crates.
//!
//! A method is a struct that implements [`Integrator`](sinew_core::Integrator): what it declares about
//! itself, its set-up, its largest stable step, and the steps of a [`Batch`](sinew_core::Batch). The batch
//! checks sizes, keeps the clock, tells the system of each step and finds divergence; the method moves `u`
//! and `v`. It takes loads by a [`LoadTime`](sinew_core::LoadTime) that fits its formula, here by
//! `within(t, dt, share)` for stages inside the step, never by the value of a ramp, so that a load that jumps
//! inside a step arrives with its whole impulse. `src/ssp_rk3.rs` is the whole method.
//!
//! The conformance suite of `sinew-core` is one line in the method's tests and holds it to all that it
//! declares: order with and without damping, order while loads change, energy, stable step, checkpoints,
//! refusals.
//!
//! ```sh
//! cargo test              # the laws
//! cargo run --release     # error and cost beside three methods of sinew
//! ```
//!
//! The example ends with an error unless the method has order 3 on a block of tissue as well.

mod ssp_rk3;

use std::error::Error;

use sinew_measure::{Case, Effort, MethodChoice, Row, measure, measure_with};
use sinew_scene::{Scene, SceneSource};
use ssp_rk3::SspRk3;

const SCENE: &str = r#"
[mesh]
cube = { cells = 4, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 10.0
[[fixed]]
group = "bottom"
[[load]]
group = "top"
traction = [0.0, 0.0, -50.0]
ramp = { kind = "sin2", rise = 0.2 }
[run]
duration = 0.4
samples = 20
integrator = "rk4"
dt = 0.0025
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::parse(SceneSource::new("block.toml", SCENE))?;
    let mut case = Case::new("block", scene.build()?)?;
    println!("method                  dt [ms]   sweeps   error [%]   step [us]");
    let mut own = Vec::new();
    for dt in [0.0025, 0.00125] {
        let row = measure_with(
            &mut case,
            "ssp-rk3",
            &mut SspRk3::default(),
            dt,
            Effort::QUICK,
        )?;
        print(&row);
        own.push(row.error.unwrap_or(f64::NAN));
        for method in ["symplectic-euler", "central-difference", "rk4"] {
            print(&measure(
                &mut case,
                &MethodChoice::new(method),
                dt,
                Effort::QUICK,
            )?);
        }
    }
    let order = (own[0] / own[1]).log2();
    println!("halving the step divides the error of ssp-rk3 by 2^{order:.2}");
    if (order - 3.0).abs() > 0.1 {
        return Err("expected order 3".into());
    }
    Ok(())
}

fn print(row: &Row) {
    let (name, dt, sweeps) = (&row.integrator, 1e3 * row.dt, row.work.sweeps);
    let (error, cost) = (100.0 * row.error.unwrap_or(f64::NAN), row.us_per_step);
    println!("{name:20} {dt:10} {sweeps:8} {error:11.2e} {cost:11.1}");
}
