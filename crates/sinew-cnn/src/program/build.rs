//! Building programs.

use sinew_core::{Acceleration, DampedAt, VelocityTime};

use super::{
    Forces, LoadAt, Loads, Physics, Product, Program, Quotient, Register, Source, Sweep, Update,
};

impl Program {
    /// An empty program; `velocity` is the time of the velocity after a step.
    #[must_use]
    pub fn new(velocity: VelocityTime) -> Self {
        Self {
            names: vec!["u", "v", "a"],
            entry: Vec::new(),
            start: Vec::new(),
            step: Vec::new(),
            velocity,
            damped: DampedAt::default(),
            acceleration: Acceleration::None,
            blocks: None,
            inertia: None,
            limits: None,
            repeats: 1,
            moments: None,
            sources: Vec::new(),
        }
    }

    /// Adds a register.
    pub fn register(&mut self, name: &'static str) -> Register {
        self.names.push(name);
        Register(self.names.len() as u8 - 1)
    }

    /// The register of this name, created if absent.
    pub fn named(&mut self, name: &'static str) -> Register {
        match self.names.iter().position(|known| *known == name) {
            Some(index) => Register(index as u8),
            None => self.register(name),
        }
    }

    /// The sweep `q = M^-1 (F - K u - D v)` of a system's net force. With stiffness damping a register `w = u + beta v`
    /// is stored, and the neighbours read this register.
    pub fn net_force(&mut self, physics: &Physics, u: Register, v: Register, at: LoadAt) -> Sweep {
        let loads = Loads::All { factor: 1.0, at };
        if at == LoadAt::StartOf {
            // The mean over the step to come.
            self.damped = DampedAt::supports(0.5);
        }
        if !physics.matrices {
            return Sweep {
                loads,
                forces: Forces::Internal { u, v },
                quotient: Quotient::Mass,
                ..Sweep::local()
            };
        }
        let source = match physics.stiffness_damping {
            0.0 => u,
            beta => self.source(u, v, beta),
        };
        let product = |source| Product {
            factor: 1.0,
            source,
        };
        let sweep = Sweep {
            loads,
            forces: Forces::Products {
                stiffness: Some(product(source)),
                dashpots: physics.dashpots.then(|| product(v)),
            },
            quotient: Quotient::Mass,
            ..Sweep::local()
        };
        match physics.mass_damping {
            0.0 => sweep,
            alpha => sweep.with_own(v, 0.0, -alpha),
        }
    }

    /// The register with `u + beta v`.
    fn source(&mut self, u: Register, v: Register, beta: f64) -> Register {
        let known = self.sources.iter();
        let mut known = known.filter(|source| (source.u, source.v) == (u, v));
        if let Some(source) = known.next() {
            return source.register;
        }
        let register = self.register("w");
        self.sources.push(Source {
            register,
            u,
            v,
            beta,
        });
        register
    }

    /// Completes the program: for each register with a stored sum `u + beta v`, every change of the register is
    /// followed by an update of the sum.
    #[must_use]
    pub fn complete(mut self) -> Self {
        for Source {
            register,
            u,
            v,
            beta,
        } in std::mem::take(&mut self.sources)
        {
            let follow = || register.becomes([(u, 1.0), (v, beta)]);
            if [u, v].iter().all(|register| register.index() < 2) {
                self.entry.push(follow());
            }
            for sweep in self.start.iter_mut().chain(&mut self.step) {
                let writes = |update: &Update| update.target == u || update.target == v;
                if sweep.updates.iter().any(writes) {
                    sweep.updates.push(follow());
                }
            }
        }
        self
    }
}
