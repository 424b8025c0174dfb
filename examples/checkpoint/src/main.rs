//! A run that is stopped half-way and continued by another process, to the same bits.
//!
//! A [`State`] contains all history of a method, whatever the method: a velocity half a step behind, an acceleration,
//! the energy with which a guarded motion began. [`State::to_bytes`] writes it and [`State::from_bytes`] reads it for a
//! system that is built again in the same way. The method itself is built again too; its caches follow from system and
//! step. External forces are a record, [`Inputs`], which is written and read in the same way.
//!
//! Bytes that are cut off or damaged are refused, and so is the state of another body: it carries a fingerprint of the
//! masses and matrices with which it was written. Loads are not part of that.
//!
//! ```sh
//! cargo run --release
//! ```
//!
//! The example runs each method to the end, stops another run half-way, and starts itself again with the
//! folder's name to finish that one. It ends with an error unless both ends have the same bytes.

use std::error::Error;
use std::path::Path;
use std::process::{Command, ExitCode, Output};

use sinew_core::{Inputs, Options, Ramp, Run, State, System, simulate_under};
use sinew_fem::{Fixed, Law, LoadKind, LoadSpec, Model, Problem, Rayleigh, Region};
use sinew_mesh::structured::{Split, cube};

const STEP: f64 = 0.004;
const STEPS: usize = 200;
/// Young's modulus (Pa).
const STIFFNESS: f64 = 3500.0;
/// Files of a folder.
const STATE: &str = "state";
const RECORD: &str = "inputs";

/// A method by name, with an option that it needs.
struct Method {
    id: &'static str,
    option: Option<(&'static str, &'static str)>,
    /// True if a user's force pulls; a guard of energies needs all forces in advance.
    is_pulled: bool,
    /// History of the method in the state, besides displacement and velocity at one time.
    keeps: &'static str,
}

const METHODS: [Method; 4] = [
    Method {
        id: "central-difference",
        option: Some(("substeps", "auto")),
        is_pulled: true,
        keeps: "a velocity half a step behind",
    },
    Method {
        id: "newmark",
        option: None,
        is_pulled: true,
        keeps: "the acceleration",
    },
    Method {
        id: "cnn-stabilised",
        option: None,
        is_pulled: true,
        keeps: "velocity and acceleration of the last kick",
    },
    Method {
        id: "rk4",
        option: Some(("saturation", "auto")),
        is_pulled: false,
        keeps: "the energy the motion began with",
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match &arguments[..] {
        [id, folder] => {
            let known = METHODS.iter().find(|method| method.id == id);
            known.map_or(Err("no such method".into()), |method| {
                finish(method, Path::new(folder))
            })
        }
        _ => compare(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs every method whole and in two processes.
fn compare() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let (state_file, record_file) = (folder.path().join(STATE), folder.path().join(RECORD));
    let model = block(4, STIFFNESS)?;
    for method in &METHODS {
        let Method { id, keeps, .. } = method;
        let record = match method.is_pulled {
            true => pull(&model)?,
            false => Inputs::new(),
        };
        let mut whole = State::at_rest(model.dofs());
        advance(&model, method, &record, &mut whole, STEPS)?;

        let mut half = State::at_rest(model.dofs());
        advance(&model, method, &record, &mut half, STEPS / 2)?;
        std::fs::write(&state_file, half.to_bytes(&model)?)?;
        std::fs::write(&record_file, record.to_bytes()?)?;
        let child = continue_elsewhere(id, folder.path())?;
        if !child.status.success() {
            return Err(String::from_utf8_lossy(&child.stderr).into());
        }
        if std::fs::read(&state_file)? != whole.to_bytes(&model)? {
            return Err(format!("{id}: other bits in another process").into());
        }
        println!("{id}: the same bits in another process ({keeps})");
    }

    let bytes = State::at_rest(model.dofs()).to_bytes(&model)?;
    let mut damaged = bytes.clone();
    damaged[1000] ^= 1;
    let at_rest_in = |model: Model| State::at_rest(model.dofs()).to_bytes(&model);
    for (what, bytes) in [
        ("cut off", &bytes[..bytes.len() / 2]),
        ("one bit flipped", &damaged),
        ("a coarser mesh", &at_rest_in(block(3, STIFFNESS)?)?),
        ("a softer body", &at_rest_in(block(4, 0.9 * STIFFNESS)?)?),
    ] {
        std::fs::write(&state_file, bytes)?;
        let child = continue_elsewhere("rk4", folder.path())?;
        if child.status.success() {
            return Err(format!("{what}: accepted").into());
        }
        print!("{what}: {}", String::from_utf8_lossy(&child.stderr));
    }
    Ok(())
}

/// Starts this program again, to finish the run whose state and record are in a folder.
fn continue_elsewhere(id: &str, folder: &Path) -> std::io::Result<Output> {
    Command::new(std::env::current_exe()?)
        .arg(id)
        .arg(folder)
        .output()
}

/// Finishes a run in the place of the process that began it.
fn finish(method: &Method, folder: &Path) -> Result<(), Box<dyn Error>> {
    let model = block(4, STIFFNESS)?;
    let file = folder.join(STATE);
    let mut state = State::from_bytes(&std::fs::read(&file)?, &model)?;
    let record = Inputs::from_bytes(&std::fs::read(folder.join(RECORD))?)?;
    advance(&model, method, &record, &mut state, STEPS / 2)?;
    Ok(std::fs::write(file, state.to_bytes(&model)?)?)
}

/// Force of a user on a corner of the top: another one in every tenth step.
fn pull(model: &Model) -> Result<Inputs, Box<dyn Error>> {
    let (corner, _) = model.mesh().nearest_node([0.1, 0.1, 0.1]);
    let mut record = Inputs::new();
    for step in (0..STEPS).step_by(10) {
        let t = STEP * step as f64;
        let force = [0.02 * (9.0 * t).sin(), 0.0, 0.03 * (5.0 * t).cos()]; // N
        record.set_forces(t, &model.forces(&[(corner, force)])?.entries)?;
    }
    Ok(record)
}

fn advance(
    model: &Model,
    method: &Method,
    record: &Inputs,
    state: &mut State,
    steps: usize,
) -> Result<(), Box<dyn Error>> {
    let options = match method.option {
        Some((key, word)) => Options::new().with_text(key, word),
        None => Options::new(),
    };
    let mut integrator = sinew_integrators::build(method.id, &options)?;
    let run = Run {
        dt: STEP,
        steps,
        divergence_limit: f64::INFINITY,
    };
    simulate_under(model, record, &mut *integrator, state, &run, &mut ())?;
    Ok(())
}

/// A block of tissue on a floor, pushed from above in a pulse that is half over at the checkpoint.
fn block(cells: usize, youngs_modulus: f64) -> Result<Model, Box<dyn Error>> {
    let duration = STEP * STEPS as f64;
    let pulse = Ramp::Pulse {
        from: 0.25 * duration,
        to: 0.75 * duration,
    };
    let push = LoadKind::Traction([0.0, 20.0, -50.0]); // Pa
    let density = 1060.0; // kg/m3
    let problem = Problem::of([Region::new(Law::linear(youngs_modulus, 0.4), density)])
        .with_damping(Rayleigh::new(5.0, 0.001))
        .with_fixed(Fixed::at("bottom"))
        .with_load(LoadSpec::new("top", push).with_ramp(pulse))
        .with_gravity([0.0, 0.0, -9.81]);
    Ok(Model::build(&cube(cells, 0.1, Split::Mirrored)?, &problem)?)
}
