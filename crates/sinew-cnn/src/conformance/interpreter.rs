//! Literal execution of a program, on matrices that are written out.

use sinew_core::{
    Acceleration, Inputs, LinearModel, LinearSystem, LoadTime, Ramp, State, StepReport,
    VelocityTime,
};

use super::dense::{Dense, dense, dot, zeros};
use crate::program::{
    Clamp, Forces, LoadAt, Loads, Moments, Program, Quotient, Register, Sweep, Update, Weight, When,
};

/// The matrices of a system and the registers of a program.
pub(super) struct Interpreter<'a> {
    program: &'a Program,
    system: &'a LinearModel,
    stiffness: Dense,
    dashpots: Dense,
    inverse: Dense,
    layers: usize,
    /// Values by register, then degree of freedom.
    registers: Vec<Vec<f64>>,
}

/// The current step.
#[derive(Clone, Copy)]
struct At {
    t: f64,
    dt: f64,
    is_last: bool,
}

impl<'a> Interpreter<'a> {
    pub(super) fn new(program: &'a Program, system: &'a LinearModel) -> Self {
        let operators = system.operators();
        let dofs = operators.dofs();
        let layers = operators.stiffness().layers().count();
        let mut inverse = zeros(dofs);
        if let Some(blocks) = &program.blocks {
            for (i, row) in inverse.iter_mut().enumerate() {
                let (cell, layer) = (i / layers, i % layers);
                for other in 0..layers {
                    row[cell * layers + other] = blocks.of_cell(cell)[layer * layers + other];
                }
            }
        }
        let extra = operators.damping().extra.as_deref();
        Self {
            program,
            system,
            stiffness: dense(operators.stiffness()),
            dashpots: extra.map_or_else(|| zeros(dofs), dense),
            inverse,
            layers,
            registers: vec![vec![0.0; dofs]; program.registers().len()],
        }
    }

    /// Takes `steps` steps of `dt` (s) of the caller.
    pub(super) fn run(&mut self, state: &mut State, dt: f64, steps: usize) -> StepReport {
        let program = self.program;
        self.registers[Register::U.index()].clone_from(&state.u);
        self.registers[Register::V.index()].clone_from(&state.v);
        for update in &program.entry {
            for dof in 0..self.registers[0].len() {
                let value = self.sum(
                    update,
                    dof,
                    0.0,
                    None,
                    At {
                        t: state.t(),
                        dt,
                        is_last: false,
                    },
                );
                self.registers[update.target.index()][dof] = value;
            }
        }
        let part = dt / f64::from(program.repeats);
        let goes_on = program.velocity == VelocityTime::MiddleOfStep && state.is_staggered_by(part);
        let mut first = !program.start.is_empty() && !goes_on;
        let parts = steps * program.repeats as usize;
        let mut work = StepReport::default();
        let mut of_step = 0;
        for number in 0..parts {
            let at = At {
                t: state.t(),
                dt: part,
                is_last: number + 1 == parts,
            };
            let sweeps = if first { &program.start } else { &program.step };
            first = false;
            let mut saturated = 0;
            for sweep in sweeps {
                if self.is_needed(sweep.when, at) {
                    let reads = sweep.forces
                        != Forces::Products {
                            stiffness: None,
                            dashpots: None,
                        };
                    work.sweeps += u64::from(reads);
                    let forced = matches!(sweep.loads, Loads::All { .. });
                    work.force_evaluations += u64::from(reads && forced);
                    saturated += self.sweep(sweep, at);
                }
            }
            of_step = saturated.max(of_step);
            if (number + 1) % program.repeats as usize == 0 {
                work.saturated += of_step;
                of_step = 0;
            }
            let keeps = if at.is_last {
                program.acceleration
            } else {
                Acceleration::None
            };
            state.end_step(part, program.velocity, keeps);
            state.damped = program.damped;
        }
        state.u.clone_from(&self.registers[Register::U.index()]);
        state.v.clone_from(&self.registers[Register::V.index()]);
        if program.acceleration != Acceleration::None {
            state.a.clone_from(&self.registers[Register::A.index()]);
        }
        work
    }

    /// Executes a sweep; returns the number of degrees of freedom at which a clamp was reached.
    fn sweep(&mut self, sweep: &Sweep, at: At) -> u64 {
        let q = self.quotient(sweep, at);
        let cells = q.len() / self.layers;
        let mut saturated = 0;
        for cell in 0..cells {
            let dofs = cell * self.layers..(cell + 1) * self.layers;
            let mut reached = vec![false; self.layers];
            for update in &sweep.updates {
                if update.last_only && !at.is_last {
                    continue;
                }
                for dof in dofs.clone() {
                    let value = self.sum(update, dof, q[dof], Some(sweep), at);
                    self.registers[update.target.index()][dof] = value;
                }
                if let Some(clamp) = update.clamp {
                    self.clamp(clamp, update.target, cell, &mut reached);
                }
            }
            saturated += reached.iter().filter(|reached| **reached).count() as u64;
        }
        saturated
    }

    /// q of a sweep.
    fn quotient(&self, sweep: &Sweep, at: At) -> Vec<f64> {
        let force = self.loads(sweep.loads, at);
        let mass = self.system.operators().mass();
        let register = |register: Register| &self.registers[register.index()];
        let mut rho = Vec::with_capacity(force.len());
        for (dof, force) in force.iter().enumerate() {
            let mut sum = *force;
            if let Forces::Products {
                stiffness,
                dashpots,
            } = sweep.forces
            {
                if let Some(product) = stiffness {
                    sum -= product.factor * dot(&self.stiffness[dof], register(product.source));
                }
                if let Some(product) = dashpots {
                    sum -= product.factor * dot(&self.dashpots[dof], register(product.source));
                }
            }
            for own in &sweep.own {
                sum += (own.plain + own.per_mass * mass[dof]) * register(own.register)[dof];
            }
            rho.push(sum);
        }
        match sweep.quotient {
            Quotient::Plain => rho,
            Quotient::Mass => rho.iter().zip(mass).map(|(rho, mass)| rho / mass).collect(),
            Quotient::Blocks => self.inverse.iter().map(|row| dot(row, &rho)).collect(),
        }
    }

    /// The sum of an update.
    fn sum(&self, update: &Update, dof: usize, q: f64, sweep: Option<&Sweep>, at: At) -> f64 {
        let terms = update.terms.iter().map(|term| {
            let weight = match term.weight {
                Weight::Number(number) => number,
                Weight::OfLoad { load, moment } => self.moment(load, moment, at),
            };
            weight * self.registers[term.register.index()][dof]
        });
        let of_q = if sweep.is_some() {
            update.of_q * q
        } else {
            0.0
        };
        terms.sum::<f64>() + of_q
    }

    /// The bound of a clamp for one cell.
    fn clamp(&mut self, clamp: Clamp, target: Register, cell: usize, reached: &mut [bool]) {
        let dofs = cell * self.layers..(cell + 1) * self.layers;
        match clamp {
            Clamp::Component(limit) => {
                for (value, reached) in self.registers[target.index()][dofs].iter_mut().zip(reached)
                {
                    *reached |= value.abs() >= limit;
                    *value = value.max(-limit).min(limit);
                }
            }
            Clamp::Vector { from, factor } => {
                let Some(limits) = &self.program.limits else {
                    return;
                };
                let limit = factor * limits[cell];
                let base: Vec<f64> = match from {
                    Some(from) => self.registers[from.index()][dofs.clone()].to_vec(),
                    None => vec![0.0; self.layers],
                };
                let vector = &mut self.registers[target.index()][dofs];
                let way = vector.iter().zip(&base).map(|(x, base)| (x - base).powi(2));
                let length = way.sum::<f64>().sqrt();
                // Rounding of the last clamp is no reason for another.
                if length > limit * (1.0 + 1e-9) {
                    reached.fill(true);
                    for (x, base) in vector.iter_mut().zip(&base) {
                        *x = base + (*x - base) * limit / length;
                    }
                }
            }
        }
    }

    fn ramp(&self, load: u32) -> Option<&Ramp> {
        let load = self.system.operators().loads().get(load as usize)?;
        Some(&load.ramp)
    }

    /// phi F of a sweep.
    fn loads(&self, loads: Loads, at: At) -> Vec<f64> {
        let At { t, dt, .. } = at;
        let mut force = vec![0.0; self.system.operators().dofs()];
        for (number, load) in self.system.operators().loads().iter().enumerate() {
            let factor = match loads {
                Loads::None => 0.0,
                Loads::All { factor, at } => factor * load.ramp.factor(taken(at, t, dt)),
                Loads::HalfJump => 0.5 * jump(&load.ramp, at),
                Loads::One(one) => f64::from(u8::from(one as usize == number)),
            };
            for (dof, value) in &load.entries {
                force[*dof as usize] += factor * value;
            }
        }
        force
    }

    fn is_needed(&self, when: When, at: At) -> bool {
        match when {
            When::Always => true,
            When::LoadChanges(load) => self.ramp(load).is_some_and(|ramp| {
                let value =
                    |share: f64| ramp.value_within(at.t, at.t + at.dt, at.t + share * at.dt);
                [0.3, 0.7, 1.0]
                    .iter()
                    .any(|share| value(*share) != value(0.0))
            }),
            When::LoadsJump => {
                let loads = self.system.operators().loads();
                loads.iter().any(|load| jump(&load.ramp, at) != 0.0)
            }
        }
    }

    /// A moment of the change of a load's factor over the step.
    fn moment(&self, load: u32, moment: u32, at: At) -> f64 {
        let (Some(ramp), Some(moments)) = (self.ramp(load), &self.program.moments) else {
            return 0.0;
        };
        let Moments { times, weights } = &**moments;
        let value = |time: f64| ramp.value_within(at.t, at.t + at.dt, at.t + time);
        let terms = times.iter().zip(&weights[moment as usize]);
        terms
            .map(|(time, weight)| weight * (value(*time) - value(0.0)))
            .sum()
    }
}

/// Jump of a factor at the beginning of a step.
fn jump(ramp: &Ramp, at: At) -> f64 {
    ramp.value_within(at.t, at.t + at.dt, at.t) - ramp.value_within(at.t - at.dt, at.t, at.t)
}

/// The window of time of a [`LoadAt`].
fn taken(at: LoadAt, t: f64, dt: f64) -> LoadTime<'static> {
    let when = match at {
        LoadAt::StartOf => LoadTime::start_of(t, dt),
        LoadAt::Within(share) => LoadTime::within(t, dt, share),
        LoadAt::Around => LoadTime::around(t, dt, dt),
        LoadAt::From => LoadTime::around(t, 0.0, dt),
        LoadAt::Smooth => LoadTime::smooth_in(t, t, dt),
    };
    when.under(Inputs::none())
}
