//! The reference machine: it defines the meaning of a program.

use std::sync::Arc;

use sinew_core::{
    Acceleration, AllShown, Batch, BlockMatrix, Equations, State, Step, StepError, StepReport,
    Stepped, System, VelocityTime,
};

use super::Machine;
use super::cells::{Cells, Registers};
use super::host::{FollowedLoad, StepTime};
use crate::program::{Forces, LoadAt, Loads, Program, Sweep};

/// Plain loops in f64 over all cells, in the order of the degrees of freedom: the reference for every
/// other machine.
#[derive(Debug, Default)]
pub struct ReferenceMachine {
    program: Option<Arc<Program>>,
    /// All registers except those of the state.
    registers: Vec<Vec<f64>>,
    /// rho, then q.
    q: Vec<f64>,
    followed: FollowedLoad,
    /// Cells that were pushed in the last step.
    pushed: Vec<u32>,
}

impl Machine for ReferenceMachine {
    fn name(&self) -> &'static str {
        "reference"
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        let dofs = system.dofs();
        self.q.resize(dofs, 0.0);
        let own = program.registers().len().saturating_sub(3);
        self.registers.resize_with(own, Vec::new);
        for register in &mut self.registers {
            register.clear();
            register.resize(dofs, 0.0);
        }
        self.followed = FollowedLoad::of(&program);
        self.pushed
            .reserve(system.contact().map_or(0, |contact| contact.cells().len()));
        self.program = Some(program);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let Some(program) = self.program.clone() else {
            return Err(StepError::NotPrepared);
        };
        if program.acceleration != Acceleration::None {
            state.a.resize(state.u.len(), 0.0);
        }
        batch.in_parts(program.repeats, |batch| self.steps(&program, batch, state))
    }
}

impl ReferenceMachine {
    /// Takes all steps, or substeps, of a batch.
    fn steps(
        &mut self,
        program: &Program,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<(), StepError> {
        let running = program.velocity != VelocityTime::Same && state.is_staggered_by(batch.dt());
        let mut starts = !program.start.is_empty() && !running;
        self.followed.forget();
        self.cells(program, batch.system(), state)
            .enter(&program.entry);
        while batch.goes_on() {
            let sweeps = if starts {
                &program.start
            } else {
                &program.step
            };
            let kick = program.kick(batch.dt(), starts);
            starts = false;
            let (step, is_last) = (batch.step(), batch.is_last());
            let mut work = StepReport::default();
            for sweep in sweeps {
                work += self.sweep(program, sweep, &step, is_last, state)?;
            }
            let acceleration = if is_last {
                program.acceleration
            } else {
                Acceleration::None
            };
            if let Some(inertia) = program.inertia() {
                let kick = kick.filter(|_| is_last);
                let shown = (&mut *state, &mut AllShown as _);
                let step = (inertia, program.saturation());
                batch.meet(shown, step, kick, &mut self.pushed);
                if !self.pushed.is_empty() {
                    self.cells(program, batch.system(), state)
                        .enter(&program.entry);
                }
            }
            let stepped = Stepped {
                work,
                velocity: program.velocity,
                damped: program.damped,
                acceleration,
            };
            batch.end_step(state, stepped)?;
        }
        Ok(())
    }

    /// Executes one sweep.
    fn sweep(
        &mut self,
        program: &Program,
        sweep: &Sweep,
        step: &Step<'_>,
        is_last: bool,
        state: &mut State,
    ) -> Result<StepReport, StepError> {
        let when = StepTime::new(step, state.t());
        let operators = match step.system.equations() {
            Equations::Linear(linear) => Some(linear.operators()),
            Equations::Forces(_) => None,
        };
        if !when.needs(sweep.when, operators) {
            return Ok(StepReport::default());
        }
        let (q, registers) = (
            &mut self.q,
            Registers {
                state,
                own: &mut self.registers,
            },
        );
        match sweep.forces {
            Forces::Products {
                stiffness,
                dashpots,
            } => {
                q.fill(0.0);
                if let Some(operators) = operators {
                    when.for_each_load(sweep.loads, operators, |load, factor| {
                        for &(dof, force) in &load.entries {
                            if let Some(out) = q.get_mut(dof as usize) {
                                *out += factor * force;
                            }
                        }
                    });
                    if let Some(product) = stiffness {
                        let source = registers.get(product.source);
                        subtract(operators.stiffness(), product.factor, source, q);
                    }
                    if let (Some(product), Some(extra)) = (dashpots, &operators.damping().extra) {
                        let source = registers.get(product.source);
                        subtract(extra, product.factor, source, q);
                    }
                }
            }
            Forces::Internal { u, v } => {
                let at = match sweep.loads {
                    Loads::All { at, .. } => at,
                    _ => LoadAt::StartOf,
                };
                let share = match at {
                    LoadAt::Within(share) => share,
                    _ => 0.0,
                };
                let internal = &registers.state.internal;
                let trial = [registers.get(u), registers.get(v), internal];
                step.net_force(when.load_time(at), share * step.dt, trial, q)?;
            }
        }
        self.followed.follow(sweep, operators, when);
        let mut cells = self.cells(program, step.system, state);
        Ok(StepReport {
            saturated: cells.finish(sweep, is_last),
            ..sweep.work()
        })
    }

    /// The cells of a sweep, after the neighbours' forces are in q.
    fn cells<'a>(
        &'a mut self,
        program: &'a Program,
        system: &'a dyn System,
        state: &'a mut State,
    ) -> Cells<'a> {
        Cells {
            program,
            registers: Registers {
                state,
                own: &mut self.registers,
            },
            q: &mut self.q,
            mass: system.mass(),
            layers: system.layers().count(),
            followed: &self.followed,
        }
    }
}

/// `out -= factor A x`.
fn subtract(matrix: &BlockMatrix, factor: f64, x: &[f64], out: &mut [f64]) {
    if factor == 1.0 {
        matrix.subtract_product(x, out);
    } else {
        matrix.subtract_scaled_product(factor, x, out);
    }
}
