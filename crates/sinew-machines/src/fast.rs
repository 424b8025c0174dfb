//! The machine whose sweeps are kernels.

use std::ops::Range;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use sinew_cnn::{
    self as program, FollowedLoad, LoadAt, Loads, Machine, Program, Register, StepTime, Sweep,
};
use sinew_core::{
    Acceleration, Batch, Contact, ElementForces, ElementPrecision, ElementSweep, Equations, Inputs,
    LinearOperators, LoadTime, Meeting, Revision, ShowCells, Shown, State, Step, StepError,
    StepReport, Stepped, SweepShape, System, VelocityTime,
};
use sinew_sparse::simd::InstructionSet;
use sinew_sparse::sweep::{self as kernel, Field, Fields, Outcome, Precision, Rows};

use crate::compiled::{BesideElements, Compiled, Constant, ELEMENTS, Variant};
use crate::crew::{Chunks, Crew, Host};
use crate::forces::Forces;
use crate::layout::Layout;
use crate::touched::Touched;

/// Limit, as a share of the size of displacements of the touched cells, up to which displacements may grow without a
/// check.
const LEAST_REACH: f64 = 1e-3;

/// Margin for the growth of displacements without a check, as a factor: if one exceeds it, the whole state is shown and
/// checked again.
const ROOM: f64 = 1.25;

/// Runs programs on the cells of a system in the order of a [`Layout`], each sweep in one pass over matrices; if forces
/// are sums over elements, after the passes over these.
#[derive(Debug)]
pub struct FastMachine<T> {
    layout: Arc<Layout<T>>,
    set: InstructionSet,
    threads: usize,
    crew: Crew,
    /// Identity of the system whose elements are loaded.
    elements_of: Option<Revision>,
    /// Locked by the host while no other thread uses it, so that the crew may read it during a sweep.
    loaded: Option<Arc<RwLock<Loaded<T>>>>,
}

/// A program with its vectors.
#[derive(Debug)]
struct Loaded<T> {
    program: Arc<Program>,
    layout: Arc<Layout<T>>,
    set: InstructionSet,
    /// Identity of the matrices.
    matrices: Revision,
    sweeps: Compiled<T>,
    fields: Fields<T>,
    /// The vector of each code.
    table: Vec<Field>,
    /// Number of the vector of forces.
    forces_field: usize,
    forces: Forces,
    followed: FollowedLoad,
    /// Forces of elements, if the system has them, and the number of their vector.
    elements: Option<(Box<dyn ElementSweep<T>>, usize)>,
    /// The current sweep.
    current: Current<T>,
    work: Work,
    /// The cells that contact reads.
    touched: Touched<T>,
    /// Cells that were pushed in the last step.
    pushed: Vec<u32>,
    /// A size (m) that no component of a displacement exceeded at the end of the last step, if contact requests the
    /// cells near its tools.
    largest: f64,
}

/// Kinds of parallel work.
#[derive(Clone, Copy, Debug)]
enum Work {
    /// Elements take the displacements of a chunk of cells, in a vector.
    Take(usize),
    /// A pass over parts of the elements.
    Elements(usize),
    /// The cells of a chunk.
    Cells,
}

impl Work {
    /// Numbers that distinguish kinds of work with different times.
    fn kind(self) -> usize {
        match self {
            Self::Cells => 0,
            Self::Take(_) => 1,
            Self::Elements(pass) => 2 + pass,
        }
    }
}

/// A sweep of a program in progress.
#[derive(Clone, Copy, Debug)]
struct Current<T> {
    part: Part,
    number: usize,
    is_last: bool,
    /// Size that displacements may have (m).
    limit: T,
}

impl<T: ElementPrecision> FastMachine<T> {
    /// A machine with the matrices of a system in this layout.
    #[must_use]
    pub fn new(layout: Arc<Layout<T>>) -> Self {
        Self {
            layout,
            set: InstructionSet::best(),
            threads: 1,
            crew: Crew::default(),
            elements_of: None,
            loaded: None,
        }
    }

    /// Uses up to `threads` threads, in batches that are long enough.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self {
            threads: threads.max(1),
            ..self
        }
    }

    /// Uses these instructions, if the machine has them.
    #[must_use]
    pub fn with_instructions(mut self, set: InstructionSet) -> Self {
        if set.is_available() {
            self.set = set;
        }
        self
    }

    /// The instructions that it uses.
    #[must_use]
    pub fn instructions(&self) -> InstructionSet {
        self.set
    }

    /// The layout of its matrices.
    #[must_use]
    pub fn layout(&self) -> &Layout<T> {
        &self.layout
    }

    /// Loads the program again if the matrices differ from those for which it was loaded.
    fn reload(&mut self, system: &dyn System) {
        let Some(loaded) = &self.loaded else {
            return;
        };
        let program = Arc::clone(&read(loaded).program);
        if let Equations::Linear(linear) = system.equations() {
            self.layout = Layout::general(linear.operators());
        }
        self.elements_of = None;
        self.load(program, system);
    }
}

impl<T: ElementPrecision> Machine for FastMachine<T> {
    fn name(&self) -> &'static str {
        match self.layout.stiffness {
            _ if self.layout.elements > 0 => "elements",
            Rows::General(_) => "general",
            Rows::Lattice(_) => "repeated",
        }
    }

    fn kernel(&self) -> String {
        format!("{} {} {}", self.name(), T::NAME, self.set.name())
    }

    fn in_words(&self) -> String {
        let (rows, set) = (self.layout.in_words(), self.set.name());
        let threads = match self.threads {
            1 => String::new(),
            most => format!(", up to {most} threads"),
        };
        format!("{rows} in {} by {set}{threads}", T::NAME)
    }

    fn load(&mut self, program: Arc<Program>, system: &dyn System) {
        let before = self.loaded.take();
        let elements_of = self.elements_of.replace(system.revision());
        let loaded = match system.equations() {
            Equations::Linear(linear) => {
                Loaded::new(program, (&self.layout, self.set), linear.operators(), None)
            }
            Equations::Forces(law) => {
                let Some(forces) = law.element_forces() else {
                    return;
                };
                let known = before.as_ref().filter(|_| elements_of == self.elements_of);
                let elements = match known.and_then(|loaded| write(loaded).elements.take()) {
                    Some((elements, _)) => elements,
                    None => {
                        self.layout = Layout::beside_elements(forces);
                        let shape = SweepShape {
                            numbering: &self.layout.numbering,
                            set: self.set,
                            parts: self.threads,
                        };
                        T::sweep_of(forces, shape)
                    }
                };
                let operators = forces.operators();
                Loaded::new(program, (&self.layout, self.set), operators, Some(elements))
            }
        };
        self.loaded = Some(match before {
            // Its crew stays with it.
            Some(before) => {
                *write(&before) = loaded;
                before
            }
            None => Arc::new(RwLock::new(loaded)),
        });
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let system = batch.system();
        let Some((operators, elements)) = matrices(system) else {
            return Err(StepError::NotPrepared);
        };
        let before = self.loaded.as_ref().map(|loaded| read(loaded).matrices);
        if before.is_some_and(|before| before != operators.revision()) {
            self.reload(system);
        }
        let Some(loaded) = &self.loaded else {
            return Err(StepError::NotPrepared);
        };
        let program = Arc::clone(&read(loaded).program);
        if program.acceleration != Acceleration::None {
            state.a.resize(state.u.len(), 0.0);
        }
        if let Some(contact) = batch.contact() {
            write(loaded).touch(&self.layout, contact);
        }
        let (layout, set) = (&*self.layout, self.set);
        let chunks = read(loaded).chunks();
        let work: Arc<dyn Chunks> = loaded.clone();
        let crew = &mut self.crew;
        batch.in_parts(program.repeats, |batch| {
            let sweeps = batch.parts_left() * program.step.len();
            let threads = match crew.patience.is_alone_for(sweeps) {
                true => 1,
                false => {
                    let pays = layout.threads_for(chunks, elements, sweeps);
                    pays.min(self.threads)
                }
            };
            let running = Running {
                loaded,
                layout,
                set,
                operators,
                host: crew.gather(threads, &work),
            };
            running.steps(&program, batch, state)
        })
    }
}

/// The matrices and loads of a system that kernels can run, and the number of its elements if forces are sums over
/// these.
fn matrices(system: &dyn System) -> Option<(&LinearOperators, usize)> {
    match system.equations() {
        Equations::Linear(linear) => Some((linear.operators(), 0)),
        Equations::Forces(law) => {
            let forces: &dyn ElementForces = law.element_forces()?;
            Some((forces.operators(), forces.elements()))
        }
    }
}

/// Matrices and damping next to elements.
fn beside(operators: &LinearOperators) -> BesideElements {
    let stiffness = operators.stiffness();
    let mut rows = 0..stiffness.pattern().cells();
    let is_some = |row| {
        let mut blocks = stiffness.row_blocks(row);
        blocks.any(|(_, block)| block.iter().any(|entry| *entry != 0.0))
    };
    let damping = operators.damping();
    BesideElements {
        stiffness: rows.any(is_some),
        dashpots: damping.extra.is_some(),
        mass_damping: damping.mass,
    }
}

impl<T: ElementPrecision> Loaded<T> {
    fn new(
        program: Arc<Program>,
        (layout, set): (&Arc<Layout<T>>, InstructionSet),
        operators: &LinearOperators,
        elements: Option<Box<dyn ElementSweep<T>>>,
    ) -> Self {
        let layers = operators.stiffness().layers().count();
        let beside = elements.is_some().then(|| beside(operators));
        let sweeps = Compiled::<T>::new(&program, layers, beside);
        let mut count = 0;
        let mut next = |used: bool| {
            let field = count;
            count += Field::from(used);
            field
        };
        let mut table = Vec::new();
        for (used, doubled) in sweeps.registers.iter().zip(&sweeps.doubled) {
            let first = next(*used);
            table.push(first);
            table.push(if *doubled { next(true) } else { first });
        }
        let registers = table.len();
        table.extend(sweeps.constants.iter().map(|(_, used)| next(*used)));
        let positions = layout.numbering.positions();
        let mut loaded = Self {
            layout: Arc::clone(layout),
            set,
            matrices: operators.revision(),
            fields: Fields::new(count as usize, layers, positions, layout.reach),
            forces_field: table[registers] as usize,
            forces: Forces::new::<T>(operators, positions),
            elements: elements.map(|elements| (elements, table[registers + ELEMENTS] as usize)),
            work: Work::Cells,
            touched: Touched::none(),
            pushed: Vec::new(),
            largest: f64::INFINITY,
            followed: FollowedLoad::of(&program),
            current: Current {
                part: Part::Entry,
                number: 0,
                is_last: true,
                limit: T::of(T::LARGEST),
            },
            program,
            sweeps,
            table,
        };
        loaded.write_constants(layout, operators.mass());
        loaded
    }

    /// Writes the data that stay the same from step to step.
    fn write_constants(&mut self, layout: &Layout<T>, mass: &[f64]) {
        let layers = self.fields.layers();
        let constants = &self.sweeps.constants;
        let registers = self.table.len() - constants.len();
        let used = constants.iter().zip(&self.table[registers..]);
        for ((constant, used), field) in used {
            // Forces are written as a sweep asks for them.
            if !used || matches!(constant, Constant::Forces | Constant::Elements) {
                continue;
            }
            for layer in 0..layers {
                let values = self.fields.layer(*field as usize, layer);
                for cell in 0..layout.numbering.cells() as u32 {
                    let position = layout.numbering.position(cell);
                    let cell = cell as usize;
                    let dof = cell * layers + layer;
                    let value = match constant {
                        Constant::Forces | Constant::Elements => continue,
                        Constant::InverseMass => 1.0 / mass[dof],
                        Constant::Mass => mass[dof],
                        Constant::Live => 1.0,
                        Constant::Limits => {
                            let limits = self.program.limits.as_ref();
                            limits.map_or(0.0, |limits| limits[cell])
                        }
                        Constant::Row(row) => {
                            let blocks = self.program.blocks.as_ref();
                            let at = (cell * layers + row) * layers + layer;
                            blocks.map_or(0.0, |blocks| blocks.entries()[at])
                        }
                    };
                    values[position] = T::of(value);
                }
            }
        }
    }

    /// The vector of a register.
    fn field(&self, register: usize) -> usize {
        self.table[2 * register] as usize
    }
}

/// A batch in progress.
struct Running<'a, T> {
    loaded: &'a RwLock<Loaded<T>>,
    layout: &'a Layout<T>,
    set: InstructionSet,
    operators: &'a LinearOperators,
    host: Host<'a>,
}

/// Groups of sweeps of a program.
#[derive(Clone, Copy, Debug)]
enum Part {
    Entry,
    Start,
    Step,
}

impl<T: ElementPrecision> Running<'_, T> {
    /// Takes all steps, or substeps, of a batch.
    ///
    /// # Errors
    /// [`StepError::Refused`] if the system refuses a motion; the state is then that before the step, unless earlier
    /// sweeps of the program have moved it.
    fn steps(
        mut self,
        program: &Program,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<(), StepError> {
        let running = program.velocity != VelocityTime::Same && state.is_staggered_by(batch.dt());
        let mut starts = !program.start.is_empty() && !running;
        let most = batch.divergence_limit().min(T::LARGEST);
        let has_contact = batch.contact().is_some() && program.inertia().is_some();
        let saturation = program.saturation();
        let entry = Current {
            part: Part::Entry,
            number: 0,
            is_last: true,
            limit: T::of(most),
        };
        write(self.loaded).begin(self.layout, state, (self.operators, batch.inputs()));
        if has_contact {
            write(self.loaded).look_at_largest(&state.u);
        }
        if !program.entry.is_empty() {
            self.make(entry);
        }
        let mut written = true;
        while batch.goes_on() {
            let (part, sweeps) = if starts {
                (Part::Start, &program.start)
            } else {
                (Part::Step, &program.step)
            };
            let kick = program.kick(batch.dt(), starts);
            starts = false;
            let (step, is_last) = (batch.step(), batch.is_last());
            let mut work = StepReport::default();
            let mut exceeded = false;
            let limit = match has_contact {
                true => T::of(read(self.loaded).largest.min(most)),
                false => T::of(most),
            };
            for (number, sweep) in sweeps.iter().enumerate() {
                let current = Current {
                    part,
                    number,
                    is_last,
                    limit,
                };
                let made = self.sweep(sweep, current, &step, state.t());
                let outcome = made.inspect_err(|_| write(self.loaded).show(self.layout, state))?;
                if let Some(outcome) = outcome {
                    exceeded |= outcome.exceeded;
                    work += StepReport {
                        saturated: outcome.saturated,
                        ..sweep.work()
                    };
                }
            }
            let acceleration = match is_last {
                true => program.acceleration,
                false => Acceleration::None,
            };
            let stepped = Stepped {
                work,
                velocity: program.velocity,
                damped: program.damped,
                acceleration,
            };
            let needs = batch.host_needs(0);
            written = needs.all || exceeded;
            if let Some(inertia) = program.inertia().filter(|_| has_contact) {
                let mut loaded = write(self.loaded);
                if written {
                    loaded.show(self.layout, state);
                }
                if exceeded {
                    loaded.look_at_largest(&state.u);
                }
                let kick = kick.filter(|_| is_last);
                let mut pushed = std::mem::take(&mut loaded.pushed);
                let mut cells = TouchedCells {
                    loaded: &mut loaded,
                    set: self.set,
                    are_shown: written,
                };
                let step = (inertia, saturation);
                batch.meet((state, &mut cells), step, kick, &mut pushed);
                loaded.pushed = pushed;
                loaded.take_pushed(self.layout, state);
                exceeded |= loaded.are_beyond(most, state);
                if !written && exceeded {
                    loaded.show(self.layout, state);
                } else if !written {
                    loaded.show_watched(self.layout, needs.watched, state);
                }
            } else if written {
                write(self.loaded).show(self.layout, state);
            } else if !needs.watched.is_empty() {
                write(self.loaded).show_watched(self.layout, needs.watched, state);
            }
            match exceeded {
                true => batch.end_step(state, stepped)?,
                false => batch.end_step_within_limit(state, stepped)?,
            }
        }
        if !written {
            write(self.loaded).show(self.layout, state);
        }
        Ok(())
    }

    /// Runs one sweep, if the step needs it.
    fn sweep(
        &mut self,
        sweep: &Sweep,
        current: Current<T>,
        step: &Step<'_>,
        t: f64,
    ) -> Result<Option<Outcome>, StepError> {
        let when = StepTime::new(step, t);
        if !when.needs(sweep.when, Some(self.operators)) {
            return Ok(None);
        }
        if let program::Forces::Internal { u, .. } = sweep.forces {
            let at = match sweep.loads {
                Loads::All { at, .. } => at,
                _ => LoadAt::StartOf,
            };
            self.elements(u, when.load_time(at).under(step.inputs))?;
        }
        let mut loaded = write(self.loaded);
        loaded.take_loads(self.layout, sweep, self.operators, when);
        drop(loaded);
        Ok(Some(self.make(current)))
    }

    fn make(&mut self, current: Current<T>) -> Outcome {
        write(self.loaded).prepare(current);
        let chunks = read(self.loaded).chunks();
        let outcome = self.sweep_over(chunks);
        write(self.loaded).swap();
        outcome
    }

    /// Does the prepared work.
    fn sweep_over(&mut self, chunks: usize) -> Outcome {
        let kind = read(self.loaded).work.kind();
        self.host.sweep(kind, chunks)
    }

    /// Computes the forces of elements at the displacement in a register.
    fn elements(&mut self, u: Register, when: LoadTime<'_>) -> Result<(), StepError> {
        let refused = |source| StepError::Refused {
            t: when.t(),
            source,
        };
        let mut loaded = write(self.loaded);
        let field = loaded.field(u.index());
        loaded.work = Work::Take(field);
        let chunks = loaded.chunks();
        let Some((elements, _)) = &mut loaded.elements else {
            return Err(StepError::NotPrepared);
        };
        elements.begin(when).map_err(refused)?;
        let passes = elements.passes();
        drop(loaded);
        self.sweep_over(chunks);
        for pass in 0..passes {
            let mut loaded = write(self.loaded);
            loaded.work = Work::Elements(pass);
            let elements = loaded.elements.as_ref();
            let parts = elements.map_or(0, |(elements, _)| elements.parts(pass));
            drop(loaded);
            if self.sweep_over(parts).exceeded {
                let mut loaded = write(self.loaded);
                let elements = loaded.elements.as_mut();
                let refusal = elements.map(|(elements, _)| refused(elements.refusal()));
                return Err(refusal.unwrap_or(StepError::NotPrepared));
            }
        }
        Ok(())
    }
}

impl<T: ElementPrecision> Loaded<T> {
    /// Number of chunks of a sweep.
    fn chunks(&self) -> usize {
        self.fields.positions().div_ceil(kernel::CHUNK * T::LANES)
    }

    /// Begins a batch.
    fn begin(
        &mut self,
        layout: &Layout<T>,
        state: &State,
        (operators, inputs): (&LinearOperators, &Inputs),
    ) {
        self.followed.forget();
        self.forces.begin(operators, inputs);
        self.take(layout, state);
    }

    /// Takes the loads of a sweep, and the weights that depend on one.
    fn take_loads(
        &mut self,
        layout: &Layout<T>,
        sweep: &Sweep,
        operators: &LinearOperators,
        when: StepTime<'_>,
    ) {
        if sweep.loads != Loads::None {
            let target = (&mut self.fields, self.forces_field);
            let loads = (sweep.loads, when);
            self.forces.set(target, &layout.numbering, operators, loads);
        }
        self.followed.follow(sweep, Some(operators), when);
    }

    /// Prepares a sweep.
    fn prepare(&mut self, current: Current<T>) {
        self.current = current;
        self.work = Work::Cells;
        let followed = &self.followed;
        let variant = current.of(&mut self.sweeps);
        variant.resolve(&self.table, |weight| followed.weight(weight));
    }

    /// Does the prepared work on a range of chunks, or of parts, that no other thread processes.
    fn make(&self, chunks: Range<usize>) -> Outcome {
        if let Some((elements, field)) = &self.elements {
            let (done, is_defined) = self.of_elements((&**elements, *field), chunks.clone());
            if done {
                return Outcome {
                    exceeded: !is_defined,
                    ..Outcome::default()
                };
            }
        }
        let (stiffness, dashpots) = (&self.layout.stiffness, self.layout.dashpots.as_ref());
        let sweep = kernel::Sweep {
            map: self.current.variant(&self.sweeps).map(),
            matrices: &[stiffness, dashpots.unwrap_or(stiffness)],
            fields: &self.fields,
            loaded: &self.forces.loaded,
            limit: self.current.limit,
        };
        run(&sweep, self.set, chunks)
    }

    /// Does the work for elements before the sweep over the cells; returns whether this was all, and whether the law is
    /// defined.
    #[allow(unsafe_code, reason = "a machine hands out each chunk once")]
    fn of_elements(
        &self,
        (elements, field): (&dyn ElementSweep<T>, usize),
        chunks: Range<usize>,
    ) -> (bool, bool) {
        let size = kernel::CHUNK * T::LANES;
        let positions = || size * chunks.start..(size * chunks.end).min(self.fields.positions());
        // SAFETY: as for `run` below; a crew ends each sweep before the next, and the vector of forces is read by the chunk that
        // writes it.
        unsafe {
            match self.work {
                Work::Take(source) => {
                    elements.take(&self.fields, source, positions());
                    (true, true)
                }
                Work::Elements(pass) => {
                    let mut parts = chunks;
                    (true, parts.all(|part| elements.make(pass, part)))
                }
                Work::Cells => {
                    elements.give(&self.fields, field, positions());
                    (false, true)
                }
            }
        }
    }

    /// Ends the prepared sweep.
    fn swap(&mut self) {
        for register in &self.current.variant(&self.sweeps).swapped {
            self.table.swap(2 * register, 2 * register + 1);
        }
    }

    /// Takes u, v and, if present, the acceleration of a state.
    fn take(&mut self, layout: &Layout<T>, state: &State) {
        for (register, values) in [&state.u, &state.v, &state.a].into_iter().enumerate() {
            if !self.sweeps.registers[register] || values.len() != state.u.len() {
                continue;
            }
            let field = self.field(register);
            let layers = self.fields.layers();
            for layer in 0..layers {
                let out = self.fields.layer(field, layer);
                let of_cells = values.chunks_exact(layers);
                for (value, position) in of_cells.zip(layout.numbering.all()) {
                    out[*position as usize] = T::of(value[layer]);
                }
            }
        }
    }

    /// Writes u, v and, if the program has one, the acceleration of a state.
    fn show(&mut self, layout: &Layout<T>, state: &mut State) {
        let values = [&mut state.u, &mut state.v, &mut state.a];
        for (register, values) in values.into_iter().enumerate() {
            if !self.sweeps.registers[register] {
                continue;
            }
            let field = self.field(register);
            let layers = self.fields.layers();
            for layer in 0..layers {
                let from = self.fields.layer(field, layer);
                let of_cells = values.chunks_exact_mut(layers);
                for (value, position) in of_cells.zip(layout.numbering.all()) {
                    value[layer] = from[*position as usize].to_f64();
                }
            }
        }
    }

    /// Finds the cells that contact reads.
    fn touch(&mut self, layout: &Layout<T>, contact: &dyn Contact) {
        let cells = contact.cells();
        self.touched.take(&layout.numbering, cells, contact.rest());
        self.pushed.reserve(cells.len());
    }

    /// Finds a size that no component of a displacement exceeds, with a margin for some more motion.
    fn look_at_largest(&mut self, u: &[f64]) {
        let largest = u.iter().fold(0.0_f64, |largest, u| largest.max(u.abs()));
        self.largest = (ROOM * largest).max(LEAST_REACH * self.touched.size());
    }

    /// True if a pushed cell exceeds the divergence limit (m), or its displacement is NaN.
    fn are_beyond(&self, limit: f64, state: &State) -> bool {
        let layers = self.fields.layers();
        let of_cell = |cell: &u32| &state.u[*cell as usize * layers..][..layers];
        let mut all = self.pushed.iter().flat_map(of_cell);
        !all.all(|u| u.abs() <= limit)
    }

    /// Takes u and v of the cells that were pushed, also rounds them in the state, and updates all values that depend
    /// on them.
    fn take_pushed(&mut self, layout: &Layout<T>, state: &mut State) {
        let layers = self.fields.layers();
        let program = Arc::clone(&self.program);
        for (register, values) in [&mut state.u, &mut state.v].into_iter().enumerate() {
            let field = self.field(register);
            for layer in 0..layers {
                let to = self.fields.layer(field, layer);
                for cell in &self.pushed {
                    let value = &mut values[*cell as usize * layers + layer];
                    let rounded = T::of(*value);
                    if register == 0 && value.abs() > self.largest {
                        self.largest = ROOM * value.abs();
                    }
                    to[layout.numbering.position(*cell)] = rounded;
                    *value = rounded.to_f64();
                }
            }
        }
        for update in &program.entry {
            for layer in 0..layers {
                for at in 0..self.pushed.len() {
                    let position = layout.numbering.position(self.pushed[at]);
                    let mut sum = T::of(0.0);
                    for term in &update.terms {
                        let field = self.field(term.register.index());
                        let value = self.fields.layer(field, layer)[position];
                        sum = sum + T::of(self.followed.weight(term.weight)) * value;
                    }
                    let field = self.field(update.target.index());
                    self.fields.layer(field, layer)[position] = sum;
                }
            }
        }
    }

    /// Writes the displacements that are watched.
    fn show_watched(&mut self, layout: &Layout<T>, watched: &[u32], state: &mut State) {
        let field = self.field(0);
        let layers = self.fields.layers();
        for dof in watched {
            let (cell, layer) = (*dof as usize / layers, *dof as usize % layers);
            let position = layout.numbering.position(cell as u32);
            state.u[*dof as usize] = self.fields.layer(field, layer)[position].to_f64();
        }
    }
}

impl<T> Current<T> {
    fn of<'s>(&self, sweeps: &'s mut Compiled<T>) -> &'s mut Variant<T> {
        let sweep = match self.part {
            Part::Entry => &mut sweeps.entry,
            Part::Start => &mut sweeps.start[self.number],
            Part::Step => &mut sweeps.step[self.number],
        };
        &mut sweep.variants[usize::from(self.is_last)]
    }

    fn variant<'s>(&self, sweeps: &'s Compiled<T>) -> &'s Variant<T> {
        let sweep = match self.part {
            Part::Entry => &sweeps.entry,
            Part::Start => &sweeps.start[self.number],
            Part::Step => &sweeps.step[self.number],
        };
        &sweep.variants[usize::from(self.is_last)]
    }
}

/// The cells that contact reads, after the sweeps of a step.
struct TouchedCells<'a, T> {
    loaded: &'a mut Loaded<T>,
    set: InstructionSet,
    /// True if the state shows all cells already.
    are_shown: bool,
}

impl<T: ElementPrecision> ShowCells for TouchedCells<'_, T> {
    fn show(
        &mut self,
        within: Option<[[f64; 3]; 2]>,
        meeting: &Meeting<'_>,
        state: &mut State,
        near: &mut Vec<u32>,
    ) -> Shown {
        let vectors = [0, 1].map(|register| self.loaded.field(register));
        let Loaded {
            touched,
            fields,
            largest,
            ..
        } = &mut *self.loaded;
        let Some(within) = within else {
            if !self.are_shown {
                touched.show_all(fields, vectors, state);
            }
            return Shown::All;
        };
        let search = (within, meeting, *largest);
        touched.list_near(self.set, (fields, vectors), search, near);
        if !self.are_shown {
            touched.show_listed(fields, vectors, near, state);
        }
        Shown::Listed
    }
}

/// Value of a lock, even if another thread panicked while holding it.
impl<T: ElementPrecision> Chunks for RwLock<Loaded<T>> {
    fn make(&self, chunks: Range<usize>) -> Outcome {
        read(self).make(chunks)
    }
}

fn read<T>(lock: &RwLock<T>) -> RwLockReadGuard<'_, T> {
    lock.read().unwrap_or_else(PoisonError::into_inner)
}

fn write<T>(lock: &RwLock<T>) -> RwLockWriteGuard<'_, T> {
    lock.write().unwrap_or_else(PoisonError::into_inner)
}

/// Runs a sweep on a range of chunks.
#[allow(unsafe_code, reason = "a machine hands out each chunk once")]
fn run<T: Precision>(
    sweep: &kernel::Sweep<'_, T>,
    set: InstructionSet,
    chunks: Range<usize>,
) -> Outcome {
    // SAFETY: the fields belong to one machine, which runs one sweep at a time: it prepares the next under
    // the lock that every thread holds while it makes chunks, and its crew hands out each chunk once.
    unsafe { sweep.run(set, chunks) }
}
