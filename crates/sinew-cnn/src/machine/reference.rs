//! The reference machine: the meaning of a program.

use std::sync::Arc;

use sinew_core::{
    Acceleration, Batch, BlockMatrix, Equations, Inputs, LinearOperators, Load, LoadTime, State,
    Step, StepError, StepReport, Stepped, System, VelocityTime,
};

use super::Machine;
use super::cells::{Cells, Registers, Weights};
use crate::program::{Forces, LoadAt, Loads, Program, Sweep, Weight, When};

/// Plain loops in f64 over all cells, in the order of the degrees of freedom: the reference for every
/// other machine.
#[derive(Debug, Default)]
pub struct ReferenceMachine {
    program: Option<Arc<Program>>,
    /// All registers but those of the state.
    registers: Vec<Vec<f64>>,
    /// rho, then q.
    q: Vec<f64>,
    changes: Changes,
}

/// Changes of a load's factor over the current step.
#[derive(Debug, Default)]
struct Changes {
    /// The load, by its number, and the step's beginning (s).
    of: Option<(u32, f64)>,
    /// The factor less its value at the beginning, at the times of the program's moments.
    values: Vec<f64>,
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
        let times = program
            .moments
            .as_ref()
            .map_or(0, |moments| moments.times.len());
        self.changes.values.resize(times, 0.0);
        self.program = Some(program);
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let Some(program) = self.program.clone() else {
            return Ok(());
        };
        if program.acceleration != Acceleration::None {
            state.a.resize(state.u.len(), 0.0);
        }
        batch.in_parts(program.repeats, |batch| self.steps(&program, batch, state))
    }
}

impl ReferenceMachine {
    /// Takes all steps, or parts of them, of a batch.
    fn steps(
        &mut self,
        program: &Program,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<(), StepError> {
        let running = program.velocity != VelocityTime::Same && state.is_staggered_by(batch.dt());
        let mut starts = !program.start.is_empty() && !running;
        self.changes.of = None;
        self.cells(program, batch.system(), state)
            .enter(&program.entry);
        while batch.goes_on() {
            let sweeps = if starts {
                &program.start
            } else {
                &program.step
            };
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
            let stepped = Stepped {
                work,
                velocity: program.velocity,
                acceleration,
            };
            batch.end_step(state, stepped);
        }
        Ok(())
    }

    /// Makes one sweep.
    fn sweep(
        &mut self,
        program: &Program,
        sweep: &Sweep,
        step: &Step<'_>,
        is_last: bool,
        state: &mut State,
    ) -> Result<StepReport, StepError> {
        let (t, dt) = (state.t(), step.dt);
        let operators = match step.system.equations() {
            Equations::Linear(linear) => Some(linear.operators()),
            Equations::Forces(_) => None,
        };
        if !needs(sweep.when, operators, step.inputs, t, dt) {
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
                    add_loads(sweep.loads, operators, step.inputs, t, dt, q);
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
                step.net_force(load_time(at, t, dt), share * dt, trial, q)?;
            }
        }
        self.follow_load(program, sweep, operators, step.inputs, [t, dt]);
        let mut cells = self.cells(program, step.system, state);
        Ok(StepReport {
            saturated: cells.finish(sweep, is_last),
            ..sweep.work()
        })
    }

    /// The cells of a sweep, once the neighbours' forces are in q.
    fn cells<'a>(
        &'a mut self,
        program: &'a Program,
        system: &'a dyn System,
        state: &'a mut State,
    ) -> Cells<'a> {
        let moments = program.moments.as_ref();
        Cells {
            program,
            registers: Registers {
                state,
                own: &mut self.registers,
            },
            q: &mut self.q,
            mass: system.mass(),
            layers: system.layers().count(),
            weights: Weights {
                changes: &self.changes.values,
                moments: moments.map_or(&[], |moments| &moments.weights),
            },
        }
    }

    /// Computes the change of the load that the weights of a sweep follow, in a step from `t` (s) of `dt`
    /// (s).
    fn follow_load(
        &mut self,
        program: &Program,
        sweep: &Sweep,
        operators: Option<&LinearOperators>,
        inputs: &Inputs,
        [t, dt]: [f64; 2],
    ) {
        let Some(moments) = &program.moments else {
            return;
        };
        let terms = sweep.updates.iter().flat_map(|update| &update.terms);
        let mut followed = terms.filter_map(|term| match term.weight {
            Weight::OfLoad { load, .. } => Some(load),
            Weight::Number(_) => None,
        });
        if let (Some(number), Some(operators)) = (followed.next(), operators)
            && self.changes.of != Some((number, t))
            && let Some(load) = operators.loads().get(number as usize)
        {
            let ramp = load.ramp.known(inputs);
            let start = ramp.value_within(t, t + dt, t);
            for (value, time) in self.changes.values.iter_mut().zip(&moments.times) {
                *value = ramp.value_within(t, t + dt, t + time) - start;
            }
            self.changes.of = Some((number, t));
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

/// Whether a step from `t` (s) of `dt` (s) needs a sweep.
fn needs(
    when: When,
    operators: Option<&LinearOperators>,
    inputs: &Inputs,
    t: f64,
    dt: f64,
) -> bool {
    let Some(operators) = operators else {
        return when == When::Always;
    };
    match when {
        When::Always => true,
        When::LoadChanges(load) => {
            let load = operators.loads().get(load as usize);
            load.is_some_and(|load| !load.ramp.known(inputs).is_constant_between(t, t + dt))
        }
        When::LoadsJump => {
            let mut loads = operators.loads_between(inputs, t - 0.5 * dt, t + 0.5 * dt);
            loads.any(|load| half_jump(load, inputs, t, dt) != 0.0)
        }
    }
}

/// Half the jump of a load's factor between the steps of `dt` (s) before and after `t` (s), over
/// which it is constant.
fn half_jump(load: &Load, inputs: &Inputs, t: f64, dt: f64) -> f64 {
    let ramp = load.ramp.known(inputs);
    0.5 * (ramp.value(t + 0.5 * dt) - ramp.value(t - 0.5 * dt))
}

/// Time at which a sweep of a step from `t` (s) of `dt` (s) takes its loads.
fn load_time(at: LoadAt, t: f64, dt: f64) -> LoadTime<'static> {
    match at {
        LoadAt::StartOf => LoadTime::start_of(t, dt),
        LoadAt::Within(share) => LoadTime::within(t, dt, share),
        LoadAt::Around => LoadTime::around(t, dt, dt),
        LoadAt::From => LoadTime::around(t, 0.0, dt),
        LoadAt::Smooth => LoadTime::smooth_in(t, t, dt),
    }
}

/// `out += phi F` of a sweep in a step from `t` (s) of `dt` (s).
fn add_loads(
    loads: Loads,
    operators: &LinearOperators,
    inputs: &Inputs,
    t: f64,
    dt: f64,
    out: &mut [f64],
) {
    let mut add = |load: &Load, factor: f64| {
        if factor != 0.0 {
            for &(dof, force) in &load.entries {
                if let Some(out) = out.get_mut(dof as usize) {
                    *out += factor * force;
                }
            }
        }
    };
    match loads {
        Loads::None => {}
        Loads::All { factor, at } => {
            let when = load_time(at, t, dt).under(inputs);
            let (from, to) = when.span();
            for load in operators.loads_between(inputs, from, to) {
                add(load, factor * load.ramp.factor(when));
            }
        }
        Loads::HalfJump => {
            for load in operators.loads_between(inputs, t - 0.5 * dt, t + 0.5 * dt) {
                add(load, half_jump(load, inputs, t, dt));
            }
        }
        Loads::One(number) => {
            if let Some(load) = operators.loads().get(number as usize) {
                add(load, 1.0);
            }
        }
    }
}
