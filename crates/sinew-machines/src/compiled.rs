//! Programs as sweeps of kernels.

use sinew_cnn::{Clamp, Forces, Product, Program, Quotient, Register, Sweep, Update, Weight};
use sinew_sparse::sweep::{self as kernel, CellMap, Field, Precision};

/// Number of the matrix K among a sweep's matrices.
const STIFFNESS: usize = 0;
/// Number of the dashpots.
const DASHPOTS: usize = 1;

/// Number of the forces of elements among the constants.
pub(crate) const ELEMENTS: usize = 5;

/// Matrices and damping in addition to the elements of a force law.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BesideElements {
    /// True if K is not 0.
    pub(crate) stiffness: bool,
    pub(crate) dashpots: bool,
    /// alpha (1/s) of damping alpha M.
    pub(crate) mass_damping: f64,
}

/// Vectors that a program needs besides its registers, in the order of their codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Constant {
    Forces,
    InverseMass,
    Mass,
    Live,
    Limits,
    /// Forces of elements.
    Elements,
    /// A row of the blocks P^-1.
    Row(usize),
}

/// A program whose vectors are codes: twice the number of a register, and one more if a register that
/// neighbours read is written to its second vector; then the constants.
#[derive(Debug)]
pub(crate) struct Compiled<T> {
    pub(crate) registers: Vec<bool>,
    /// Registers with a second vector.
    pub(crate) doubled: Vec<bool>,
    /// The constants, each with a flag: true if it is used.
    pub(crate) constants: Vec<(Constant, bool)>,
    pub(crate) entry: CompiledSweep<T>,
    /// One for each sweep of the program.
    pub(crate) start: Vec<CompiledSweep<T>>,
    pub(crate) step: Vec<CompiledSweep<T>>,
}

/// A sweep, for steps that are not the last of a batch and for those that are.
#[derive(Debug)]
pub(crate) struct CompiledSweep<T> {
    pub(crate) variants: [Variant<T>; 2],
}

/// A sweep with its updates.
#[derive(Debug)]
pub(crate) struct Variant<T> {
    codes: CellMap<T>,
    /// The same with the vectors of the present step.
    map: CellMap<T>,
    /// Registers whose two vectors are exchanged afterwards.
    pub(crate) swapped: Vec<usize>,
    /// Weights that differ from step to step: update, term, weight.
    followed: Vec<(usize, usize, Weight)>,
}

impl<T> Variant<T> {
    /// The sweep with the vectors of the present step.
    pub(crate) fn map(&self) -> &CellMap<T> {
        &self.map
    }
}

impl<T: Precision> Variant<T> {
    /// Takes the vectors that the codes name, and the weights of the present step.
    pub(crate) fn resolve(&mut self, table: &[Field], weight: impl Fn(Weight) -> f64) {
        let of = |code: Field| table[code as usize];
        let (codes, map) = (&self.codes, &mut self.map);
        map.forces = codes.forces.map(of);
        for (product, code) in map.products.iter_mut().zip(&codes.products) {
            product.source = of(code.source);
        }
        for (own, code) in map.own.iter_mut().zip(&codes.own) {
            own.field = of(code.field);
        }
        map.quotient = match codes.quotient {
            kernel::Quotient::Plain { mass, live } => kernel::Quotient::Plain {
                mass: of(mass),
                live: of(live),
            },
            kernel::Quotient::Mass { inverse } => kernel::Quotient::Mass {
                inverse: of(inverse),
            },
            kernel::Quotient::Blocks { mass, rows } => kernel::Quotient::Blocks {
                mass: of(mass),
                rows: of(rows),
            },
        };
        for (update, code) in map.updates.iter_mut().zip(&codes.updates) {
            update.target = of(code.target);
            for (term, code) in update.terms.iter_mut().zip(&code.terms) {
                term.1 = of(code.1);
            }
            if let (
                Some(kernel::Clamp::Vector { from, limits, .. }),
                Some(kernel::Clamp::Vector {
                    from: from_code,
                    limits: limits_code,
                    ..
                }),
            ) = (&mut update.clamp, &code.clamp)
            {
                *from = from_code.map(of);
                *limits = of(*limits_code);
            }
        }
        for (update, term, followed) in &self.followed {
            map.updates[*update].terms[*term].0 = T::of(weight(*followed));
        }
    }
}

impl<T: Precision> Compiled<T> {
    pub(crate) fn new(program: &Program, layers: usize, beside: Option<BesideElements>) -> Self {
        let mut constants = vec![
            Constant::Forces,
            Constant::InverseMass,
            Constant::Mass,
            Constant::Live,
            Constant::Limits,
            Constant::Elements,
        ];
        constants.extend((0..layers).map(Constant::Row));
        let count = program.registers().len();
        let mut maker = Maker {
            program,
            beside,
            constants: 2 * count as Field,
            registers: vec![false; count],
            doubled: vec![false; count],
            used: vec![false; constants.len()],
        };
        for register in [Register::U, Register::V] {
            maker.registers[register.index()] = true;
        }
        let entry = Sweep {
            updates: program.entry.clone(),
            ..Sweep::local()
        };
        let entry = maker.sweep(&entry, None);
        let mut sweeps = |sweeps: &[Sweep]| -> Vec<CompiledSweep<T>> {
            let watched = last_write(sweeps, Register::U);
            let sweeps = sweeps.iter().enumerate();
            sweeps
                .map(|(number, sweep)| {
                    let watched = watched.filter(|(of, _)| *of == number);
                    maker.sweep(sweep, watched.map(|(_, update)| update))
                })
                .collect()
        };
        let (start, step) = (sweeps(&program.start), sweeps(&program.step));
        Self {
            entry,
            start,
            step,
            registers: maker.registers,
            doubled: maker.doubled,
            constants: constants.into_iter().zip(maker.used).collect(),
        }
    }
}

/// The last update of a step that writes a register: sweep and update.
fn last_write(sweeps: &[Sweep], register: Register) -> Option<(usize, usize)> {
    let of_sweep = |sweep: &Sweep| {
        let mut updates = sweep.updates.iter();
        updates.rposition(|update| update.target == register && !update.last_only)
    };
    let mut sweeps = sweeps.iter().enumerate().rev();
    sweeps.find_map(|(number, sweep)| Some((number, of_sweep(sweep)?)))
}

struct Maker<'a> {
    program: &'a Program,
    beside: Option<BesideElements>,
    /// Code of the first constant.
    constants: Field,
    registers: Vec<bool>,
    doubled: Vec<bool>,
    used: Vec<bool>,
}

impl Maker<'_> {
    fn sweep<T: Precision>(&mut self, sweep: &Sweep, watched: Option<usize>) -> CompiledSweep<T> {
        CompiledSweep {
            variants: [false, true].map(|is_last| self.variant(sweep, is_last, watched)),
        }
    }

    fn variant<T: Precision>(
        &mut self,
        sweep: &Sweep,
        is_last: bool,
        watched: Option<usize>,
    ) -> Variant<T> {
        let mut own = Vec::new();
        let mut all: Vec<(usize, Product)> = Vec::new();
        let plain = |source| Product {
            factor: 1.0,
            source,
        };
        match (sweep.forces, self.beside) {
            (
                Forces::Products {
                    stiffness,
                    dashpots,
                },
                _,
            ) => {
                all.extend(stiffness.map(|product| (STIFFNESS, product)));
                all.extend(dashpots.map(|product| (DASHPOTS, product)));
            }
            (Forces::Internal { u, v }, Some(beside)) => {
                all.extend(beside.stiffness.then(|| (STIFFNESS, plain(u))));
                all.extend(beside.dashpots.then(|| (DASHPOTS, plain(v))));
                own.push(kernel::Own {
                    field: self.constant(Constant::Elements),
                    plain: T::of(-1.0),
                    per_mass: T::of(0.0),
                });
                if beside.mass_damping != 0.0 {
                    own.push(kernel::Own {
                        field: self.register(v, false),
                        plain: T::of(0.0),
                        per_mass: T::of(-beside.mass_damping),
                    });
                }
            }
            (Forces::Internal { .. }, None) => {}
        }
        let sources: Vec<Register> = all.iter().map(|(_, product)| product.source).collect();
        let products = all.into_iter().map(|(matrix, product)| kernel::Product {
            matrix,
            factor: T::of(product.factor),
            source: self.register(product.source, false),
        });
        let products = products.collect();
        let of_sweep = sweep.own.iter().map(|term| kernel::Own {
            field: self.register(term.register, false),
            plain: T::of(term.plain),
            per_mass: T::of(term.per_mass),
        });
        own.extend(of_sweep);
        let quotient = self.quotient(sweep.quotient);
        let forces =
            (sweep.loads != sinew_cnn::Loads::None).then(|| self.constant(Constant::Forces));
        let mut written: Vec<Register> = Vec::new();
        let (mut updates, mut followed) = (Vec::new(), Vec::new());
        let made = sweep.updates.iter().enumerate();
        for (number, update) in made.filter(|(_, update)| is_last || !update.last_only) {
            for (term, of_term) in update.terms.iter().enumerate() {
                if matches!(of_term.weight, Weight::OfLoad { .. }) {
                    followed.push((updates.len(), term, of_term.weight));
                }
            }
            let is_watched = watched == Some(number);
            updates.push(self.update(update, is_watched, &sources, &mut written));
        }
        let mut swapped: Vec<usize> = Vec::new();
        for source in sources.iter().filter(|source| written.contains(source)) {
            if !swapped.contains(&source.index()) {
                swapped.push(source.index());
            }
        }
        let codes = CellMap {
            forces,
            products,
            own,
            quotient,
            updates,
        };
        Variant {
            map: codes.clone(),
            codes,
            swapped,
            followed,
        }
    }

    fn update<T: Precision>(
        &mut self,
        update: &Update,
        watched: bool,
        sources: &[Register],
        written: &mut Vec<Register>,
    ) -> kernel::Update<T> {
        let is_fresh = |register: Register, written: &[Register]| {
            sources.contains(&register) && written.contains(&register)
        };
        let terms = update.terms.iter().map(|term| {
            let weight = match term.weight {
                Weight::Number(number) => number,
                Weight::OfLoad { .. } => 0.0,
            };
            let fresh = is_fresh(term.register, written);
            (T::of(weight), self.register(term.register, fresh))
        });
        let terms = terms.collect();
        let clamp = match update.clamp {
            Some(Clamp::Component(limit)) => Some(kernel::Clamp::Component(T::of(limit))),
            Some(Clamp::Vector { from, factor }) if self.program.limits.is_some() => {
                let from = from.map(|from| self.register(from, is_fresh(from, written)));
                Some(kernel::Clamp::Vector {
                    from,
                    factor: T::of(factor),
                    limits: self.constant(Constant::Limits),
                })
            }
            _ => None,
        };
        written.push(update.target);
        let fresh = sources.contains(&update.target);
        self.doubled[update.target.index()] |= fresh;
        kernel::Update {
            target: self.register(update.target, fresh),
            terms,
            of_q: T::of(update.of_q),
            clamp,
            watched,
        }
    }

    fn register(&mut self, register: Register, fresh: bool) -> Field {
        self.registers[register.index()] = true;
        2 * register.index() as Field + Field::from(fresh)
    }

    fn constant(&mut self, constant: Constant) -> Field {
        let index = match constant {
            Constant::Forces => 0,
            Constant::InverseMass => 1,
            Constant::Mass => 2,
            Constant::Live => 3,
            Constant::Limits => 4,
            Constant::Elements => ELEMENTS,
            Constant::Row(row) => ELEMENTS + 1 + row,
        };
        self.used[index] = true;
        self.constants + index as Field
    }

    /// The first row of the blocks; the others follow.
    fn rows(&mut self) -> Field {
        self.used[ELEMENTS + 1..].fill(true);
        self.constant(Constant::Row(0))
    }

    fn quotient(&mut self, quotient: Quotient) -> kernel::Quotient {
        match quotient {
            Quotient::Mass => kernel::Quotient::Mass {
                inverse: self.constant(Constant::InverseMass),
            },
            Quotient::Blocks if self.program.blocks.is_some() => kernel::Quotient::Blocks {
                mass: self.constant(Constant::Mass),
                rows: self.rows(),
            },
            Quotient::Plain | Quotient::Blocks => kernel::Quotient::Plain {
                mass: self.constant(Constant::Mass),
                live: self.constant(Constant::Live),
            },
        }
    }
}
