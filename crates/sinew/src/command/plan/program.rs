//! The program of a scene's integrator as text.

use sinew_cnn::Program;
use sinew_core::{Batch, BlockMatrix, Inputs, LinearSystem, SimulateError};
use sinew_scene::Simulation;
use sinew_scene::output::say;

use super::program_json;
use crate::command::Failure;

/// Prints the program, as text or as JSON.
pub(super) fn print(simulation: &Simulation, as_json: bool) -> Result<(), Failure> {
    let mut integrator = simulation.integrator()?;
    simulation.set_up(&mut *integrator)?;
    // The limits of a guard follow from the motion's start, which a batch of no steps shows it.
    let mut start = simulation.initial_state().clone();
    let mut no_steps = Batch::new(simulation.system(), Inputs::none(), simulation.dt(), 0);
    let shown = integrator.run(&mut no_steps, &mut start);
    shown.map_err(SimulateError::Step)?;
    let (id, program) = (integrator.id(), integrator.program());
    let because = integrator.without_program();
    let operators = simulation.system().as_linear().map(LinearSystem::operators);
    let stiffness = operators.map(|operators| &**operators.stiffness());
    if as_json {
        let object = program_json::object(id, simulation.dt(), program.as_ref(), because);
        say(&object.to_string())?;
        return Ok(());
    }
    match program {
        None => say(&format!("\n`{id}` has no program: {because}"))?,
        Some(program) => {
            say(&format!(
                "\nprogram of `{id}`, dt = {} s",
                simulation.dt() / f64::from(program.repeats)
            ))?;
            say(program.to_string().trim_end())?;
            if let Some(stiffness) = stiffness {
                say(&moved(&program, stiffness))?;
            }
        }
    }
    Ok(())
}

/// The memory that a step moves.
fn moved(program: &Program, stiffness: &BlockMatrix) -> String {
    let (traffic, layers) = (program.traffic(), stiffness.layers());
    let cells = stiffness.pattern().cells().max(1);
    let blocks_a_row = stiffness.pattern().blocks() as f64 / cells as f64;
    let vectors = traffic.vector_bytes(layers);
    let blocks = traffic.block_bytes(layers, blocks_a_row);
    format!(
        "memory a cell and step: {:.0} bytes = {vectors:.0} of vectors ({} x {} values of 8 bytes) + {blocks:.0} of \
         blocks ({} x {blocks_a_row:.1} blocks of {} bytes{})\n  \
         counted for a pass that reads each vector and block once and keeps the rest in cache",
        vectors + blocks,
        traffic.read + traffic.written,
        layers.count(),
        traffic.products,
        8 * layers.count() * layers.count() + 4,
        match traffic.own_blocks {
            0 => String::new(),
            own => format!(
                ", {own} of {} bytes of P^-1",
                8 * layers.count() * layers.count()
            ),
        },
    )
}
