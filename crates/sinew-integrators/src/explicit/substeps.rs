//! `substeps`: a step cut into equal parts.

use sinew_cnn::Program;
use sinew_core::spectrum::PRODUCTS_OF_ESTIMATE;
use sinew_core::{
    Batch, Fact, Integrator, LoadTime, OptionError, Options, Prepared, Properties, SetupError,
    StableStep, State, StepCut, StepError, StepReport, System, Trial,
};

use crate::{OptionDefault, OptionHelp, OptionKind, Stepper};

/// Share of the stable step that automatic sub-steps stay below.
const MARGIN: f64 = 0.9;

/// Most parts that can be asked for: a run is interrupted between steps, never in the midst of one.
const MOST_FIXED: u32 = 10_000;

/// Number of parts into which a step is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// This many parts, always.
    Fixed(u32),
    /// The fewest parts that are no longer than nine tenths of the stable step: that of the matrices, or of a law's current stiffness,
    /// which is looked at again and again.
    Auto,
}

impl Substeps {
    /// The option's key.
    pub const KEY: &'static str = "substeps";

    /// The option.
    pub(crate) const HELP: OptionHelp = OptionHelp {
        key: Self::KEY,
        help: "equal parts into which each step is cut; \"auto\" for as many as keep them stable, by the current stiffness where that changes",
        expected: "a whole number from 1 to 10000, or \"auto\"",
        kind: OptionKind::Either(&[OptionKind::Count(MOST_FIXED), OptionKind::Words(&["auto"])]),
        default: OptionDefault::Value("1"),
        example: "substeps = 4",
        shown_default: None,
    };

    /// The fewest equal parts (from 1 on) of a step of `dt` (s) that are no longer than nine tenths
    /// of `limit` (s), which is above 0; at most `u32::MAX`.
    #[must_use]
    pub fn parts_of(dt: f64, limit: f64) -> u32 {
        Self::parts(dt, limit).min(f64::from(u32::MAX)) as u32
    }

    /// The same for a method, where there are so many that parts stay stable.
    ///
    /// # Errors
    /// [`SetupError::Unresolved`] where there are not, by the option that asked for them.
    pub(super) fn stable_parts_of(
        integrator: &'static str,
        dt: f64,
        limit: f64,
        option: &str,
    ) -> Result<u32, SetupError> {
        let parts = Self::parts_of(dt, limit);
        if dt / f64::from(parts) <= limit {
            return Ok(parts);
        }
        let times = dt / limit;
        Err(SetupError::Unresolved {
            integrator,
            reason: format!(
                "dt = {dt} s is {times:.1e} times the stable step, too many for {option} = \"auto\"; take a shorter dt"
            ),
        })
    }

    /// Length (s) of the longest equal parts of a time of `length` (s) that are no longer than nine
    /// tenths of `limit` (s), which is above 0, in any number.
    #[must_use]
    pub fn longest_part(length: f64, limit: f64) -> f64 {
        length / Self::parts(length, limit)
    }

    fn parts(dt: f64, limit: f64) -> f64 {
        // The subtrahend keeps a quotient like 3.0000000000000004 from costing one part more.
        (dt / (MARGIN * limit) - 1e-9).ceil().max(1.0)
    }

    /// Takes the option out of the others; `None` where it is absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] for anything but a whole number from 1 to 10000 or "auto".
    pub fn take_from(options: &mut Options, integrator: &str) -> Result<Option<Self>, OptionError> {
        let substeps = Self::HELP.read(options, integrator, |value| match value.word() {
            Some(_) => Some(Self::Auto),
            None => value.count(MOST_FIXED).map(Self::Fixed),
        })?;
        options.remove(Self::KEY);
        Ok(substeps)
    }
}

/// The next whole number of parts, from 1 on.
pub(super) fn whole(parts: f64) -> u32 {
    parts.ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// Parts after which the stable step of a law's current stiffness is found anew.
const PARTS_BETWEEN_LOOKS: u32 = 40;

/// Parts after which the cells' own stiffness tells at the latest whether the stable step has shrunk.
const PARTS_BETWEEN_GLANCES: u32 = 4;

/// Growth of the stiffest cell beyond which its stiffness no longer tells the stable step well enough.
const MUCH_STIFFER: f64 = 4.0;

/// Change of a cell's velocity in a step, as the share of its size that it moves by in that time, or motion against a neighbour in it, from which on
/// the stiffness is looked at at once.
const MUCH_MOTION: f64 = 0.05;

/// Most motion of a cell against a neighbour in a part, as a share of its size: with more, strains pass by within a part, and energy comes from
/// nothing although each part is stable.
const MOST_MOTION: f64 = 0.15;

/// Largest number of parts into which the current stiffness may cut what takes two parts at rest: where it takes more, something is wrong, and a
/// run would not end.
const MOST_PARTS: u32 = 1000;

/// An integrator that takes several equal steps for each one asked of it.
pub struct Substepped {
    inner: Box<dyn Stepper>,
    substeps: Substeps,
    parts: Option<(sinew_core::Revision, f64, u32)>,
    /// Own blocks of all cells (N/m).
    blocks: Vec<f64>,
    /// The state before the step under way.
    kept: State,
}

impl Substepped {
    /// Cuts the steps of `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Stepper>, substeps: Substeps) -> Self {
        Self {
            inner,
            substeps,
            parts: None,
            blocks: Vec::new(),
            kept: State::at_rest(0),
        }
    }

    /// Parts, at rest, of what is cut by a law's current stiffness: with one, tissue that is a little stiffer would take twice as many.
    pub const PARTS_AT_REST: f64 = 2.0;

    fn parts(&self, system: &dyn System, dt: f64) -> Result<u32, SetupError> {
        if let Some((revision, step, parts)) = self.parts
            && revision == system.revision()
            && step == dt
        {
            return Ok(parts);
        }
        match self.substeps {
            Substeps::Fixed(parts) => Ok(parts),
            Substeps::Auto => match self.inner.stable_step(system)? {
                StableStep::Any => Ok(1),
                StableStep::UpTo(limit) if limit > 0.0 && dt.is_finite() => {
                    // By a law's current stiffness each of them is cut again.
                    let parts = match system.as_linear() {
                        Some(_) => 1.0,
                        None => Self::PARTS_AT_REST,
                    };
                    Substeps::stable_parts_of(self.inner.id(), dt, parts * limit, "substeps")
                }
                StableStep::UpTo(_) | StableStep::Unknown => Err(SetupError::Lacks {
                    integrator: self.inner.id(),
                    needs: "a stable step above 0 to choose sub-steps by",
                }),
            },
        }
    }
}

/// Parts by the current stiffness of a law, of what would take two at rest. They are a function of the state alone, in which they
/// stand: the stable step is found from a fixed vector, after fixed numbers of parts. In between it is taken to shrink as the stiffest cell's own stiffness grows, of which a step has
/// the square root: what is left is room until the next look. That costs about a force. A step that turns out to be too long for the
/// stiffness that it led to, or that the law refuses, is taken again in shorter parts.
impl Substepped {
    fn run_by_current_stiffness(
        &mut self,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<(), StepError> {
        while batch.goes_on() {
            let cut = match state.cut {
                Some(cut) => cut,
                None => self.first_cut(batch, state)?,
            };
            self.take_one(batch, state, cut)?;
            batch.keep_trial(state);
        }
        Ok(())
    }

    /// The cut of the first step.
    fn first_cut(&mut self, batch: &mut Batch<'_>, state: &State) -> Result<StepCut, StepError> {
        let cut = self.look(batch, state)?;
        let parts = Substeps::parts_of(batch.dt(), cut.stable_step);
        if parts <= MOST_PARTS {
            return Ok(StepCut { parts, ..cut });
        }
        Err(self.too_stiff(batch.dt(), state))
    }

    /// Takes the next step, and again in more parts as long as it turns out to be too long.
    fn take_one(
        &mut self,
        batch: &mut Batch<'_>,
        state: &mut State,
        mut cut: StepCut,
    ) -> Result<(), StepError> {
        self.kept.clone_from(state);
        loop {
            let part = batch.dt() / f64::from(cut.parts);
            self.inner.prepare(batch.system(), part)?;
            let tried = batch.try_in_parts(cut.parts, |batch| self.try_in(cut, batch, state));
            let needed = match &tried {
                Ok(needed) => *needed,
                Err(StepError::Refused { .. }) => u32::MAX,
                Err(_) => return tried.map(drop),
            };
            if needed <= cut.parts {
                return Ok(());
            }
            // What is left of a motion that was torn apart would need too many.
            let more = needed.min(cut.parts.saturating_mul(2));
            if more > MOST_PARTS {
                return self.end(batch, state, tried.err());
            }
            cut.parts = more;
            state.clone_from(&self.kept);
            batch.discard_trial();
        }
    }

    /// The end of a motion for which the largest number of parts is not enough.
    fn end(
        &mut self,
        batch: &Batch<'_>,
        state: &State,
        refused: Option<StepError>,
    ) -> Result<(), StepError> {
        let dt = batch.dt();
        // As it was set up, for the next motion.
        self.inner.prepare(batch.system(), dt)?;
        Err(match refused {
            Some(StepError::Refused { t, mut source }) => {
                let too_few = format!(
                    "; {MOST_PARTS} parts of {dt} s, which takes two at rest, lead there too"
                );
                source.reason.push_str(&too_few);
                StepError::Refused { t, source }
            }
            _ if batch.diverged().is_some() => return Ok(()),
            _ => self.too_stiff(dt, state),
        })
    }

    fn too_stiff(&self, dt: f64, state: &State) -> StepError {
        StepError::Inaccurate {
            integrator: self.id(),
            t: state.t(),
            reason: format!(
                "the current stiffness takes more than {MOST_PARTS} parts of {dt} s, which takes two at rest: elements are squeezed flat, \
                 fibres are stretched too far, or the displacement is not finite. A dt in seconds has no such bound"
            ),
        }
    }

    /// Takes a step in this cut, and cuts the one after it; the parts that the step itself needed.
    fn try_in(
        &mut self,
        mut cut: StepCut,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<u32, StepError> {
        let parts = cut.parts;
        let stretches = parts.div_ceil(PARTS_BETWEEN_GLANCES);
        let mut motion = 0.0;
        while batch.goes_on() {
            let stretch = parts.div_ceil(stretches).min(batch.parts_left() as u32);
            batch.next_parts(stretch, |batch| self.inner.run(batch, state))?;
            if batch.diverged().is_some() {
                return Ok(u32::MAX);
            }
            cut.taken = cut.taken.saturating_add(stretch);
            motion = if batch.goes_on() {
                0.0
            } else {
                self.motion(batch.system(), state)
            };
            let needed = self.parts_needed(&mut cut, parts, motion, (batch, state))?;
            if needed > parts {
                return Ok(needed);
            }
        }
        if motion > MOST_MOTION * f64::from(parts) {
            return Ok(whole(motion / MOST_MOTION));
        }
        state.cut = Some(cut);
        Ok(parts)
    }

    /// Looks at the stiffness after some of `parts` parts, where it is time to or the motion of cells against their neighbours was large, and brings the
    /// cut up to date; the parts that the step needed.
    fn parts_needed(
        &mut self,
        cut: &mut StepCut,
        parts: u32,
        motion: f64,
        (batch, state): (&mut Batch<'_>, &State),
    ) -> Result<u32, StepError> {
        let (part, dt) = (batch.dt(), batch.dt() * f64::from(parts));
        let growth = if cut.taken >= PARTS_BETWEEN_LOOKS {
            f64::INFINITY
        } else if parts > 2
            || cut.taken % PARTS_BETWEEN_GLANCES < parts
            || motion > MUCH_MOTION
            || self.is_accelerated(dt, batch.system(), state)
        {
            // Not a number where the law has no such blocks.
            self.stiffest_cell(batch, state, cut.stable_step)? / cut.stiffest_cell
        } else {
            1.0
        };
        if growth.is_nan() || growth <= 1.0 {
            return Ok(parts);
        }
        // A step that damping limits goes with the stiffness itself.
        let is_viscous = viscous_sweeps(batch.system()) > 0;
        let shorter = |growth: f64| if is_viscous { growth } else { growth.sqrt() };
        let (stable_step, room) = if growth <= MUCH_STIFFER {
            (cut.stable_step / shorter(growth), shorter(growth))
        } else {
            let before = cut.parts;
            *cut = self.look(batch, state)?;
            cut.parts = before;
            // What grew so much may grow on.
            let grew = growth.is_finite();
            (
                cut.stable_step,
                if grew { shorter(MUCH_STIFFER) } else { 1.0 },
            )
        };
        let parts_by = |room: f64| Substeps::parts_of(dt, stable_step / room);
        if part > stable_step {
            return Ok(parts_by(room));
        }
        cut.parts = cut.parts.max(parts_by(room).min(MOST_PARTS));
        Ok(parts)
    }

    /// Whether some cell was accelerated so much since the step of `dt` (s) began that strains, and with them the stiffness, may have changed.
    fn is_accelerated(&self, dt: f64, system: &dyn System, state: &State) -> bool {
        let Some(scales) = system.scales() else {
            return false;
        };
        let layers = system.layers().count();
        let velocities = [&*state.v, &*self.kept.v];
        largest_share(velocities, scales.cell_size, layers) * dt > MUCH_MOTION
    }

    /// The largest motion of a cell against a neighbour since the step began, over its size; 0 where none moved by more than [`MUCH_MOTION`] of
    /// its size at all, as in most steps.
    fn motion(&self, system: &dyn System, state: &State) -> f64 {
        let (Some(scales), Some(elastic)) = (system.scales(), system.as_elastic()) else {
            return 0.0;
        };
        let layers = system.layers().count();
        let sizes = scales.cell_size;
        if largest_share([&*state.u, &*self.kept.u], sizes, layers) <= MUCH_MOTION {
            return 0.0;
        }
        let pattern = elastic.pattern();
        let moved = |dof: usize| state.u[dof] - self.kept.u[dof];
        let of_cell = |cell: usize| {
            let neighbours = pattern.neighbours(cell).iter();
            let squares = neighbours.map(|other| {
                let [own, other] = [cell, *other as usize].map(|cell| layers * cell);
                let apart = (0..layers).map(|layer| moved(own + layer) - moved(other + layer));
                apart.map(|apart| apart.powi(2)).sum::<f64>()
            });
            squares.fold(0.0, f64::max).sqrt() / sizes[cell]
        };
        (0..pattern.cells()).map(of_cell).fold(0.0, f64::max)
    }

    /// A cut by the stable step about a state.
    fn look(&mut self, batch: &mut Batch<'_>, state: &State) -> Result<StepCut, StepError> {
        batch.count(StepReport {
            sweeps: PRODUCTS_OF_ESTIMATE * (1 + viscous_sweeps(batch.system())),
            ..StepReport::default()
        });
        let stable_step = match self.inner.stable_step_about(batch.system(), Some(state))? {
            StableStep::Any => f64::INFINITY,
            StableStep::UpTo(limit) => limit,
            StableStep::Unknown => 0.0,
        };
        Ok(StepCut {
            parts: 1,
            taken: 0,
            stable_step,
            stiffest_cell: self.stiffest_cell(batch, state, stable_step)?,
        })
    }

    /// The largest trace of a cell's own block over its mass (1/s^2), that of stiffness damping included as it counts in steps of `h` (s), for which
    /// `h^2 K + 2 h V` is bounded; 0 where the law has no such blocks.
    fn stiffest_cell(
        &mut self,
        batch: &mut Batch<'_>,
        state: &State,
        h: f64,
    ) -> Result<f64, StepError> {
        let system = batch.system();
        let Some(elastic) = system.as_elastic() else {
            return Ok(0.0);
        };
        let viscous_sweeps = viscous_sweeps(system);
        batch.count(StepReport {
            sweeps: 1 + viscous_sweeps,
            ..StepReport::default()
        });
        let layers = system.layers().count();
        self.blocks.resize(layers * system.dofs(), 0.0);
        let trial = Trial::of(state, LoadTime::at(state.t()).under(batch.inputs()));
        let refused = |source| StepError::Refused {
            t: state.t(),
            source,
        };
        elastic
            .node_blocks(&trial, &mut self.blocks)
            .map_err(refused)?;
        if viscous_sweeps > 0 && h > 0.0 {
            elastic
                .add_viscous_blocks(&trial, 2.0 / h, &mut self.blocks)
                .map_err(refused)?;
        }
        let blocks = self.blocks.chunks_exact(layers * layers);
        let cells = blocks.zip(system.mass().chunks_exact(layers));
        let stiffness = cells.map(|(block, mass)| {
            let trace: f64 = block.iter().step_by(layers + 1).sum();
            trace / mass[0]
        });
        Ok(stiffness.fold(0.0, f64::max))
    }
}

/// Sweeps that stiffness damping takes where the tangent takes one.
fn viscous_sweeps(system: &dyn System) -> u64 {
    let elastic = system.as_elastic();
    elastic.map_or(0, |law| u64::from(law.damping().stiffness != 0.0))
}

/// The largest difference of two vectors in a cell over its size.
fn largest_share([now, before]: [&[f64]; 2], sizes: &[f64], layers: usize) -> f64 {
    let cells = now.chunks_exact(layers).zip(before.chunks_exact(layers));
    let shares = cells.zip(sizes).map(|((now, before), size)| {
        let change = now.iter().zip(before).map(|(now, before)| now - before);
        change.map(|change| change.powi(2)).sum::<f64>() / (size * size)
    });
    shares.fold(0.0, f64::max).sqrt()
}

impl Stepper for Substepped {
    fn program(&self) -> Option<Program> {
        let (_, _, parts) = self.parts?;
        Some(self.inner.program()?.repeated(parts))
    }

    fn computed_by(&self) -> Vec<String> {
        self.inner.computed_by()
    }

    fn without_program(&self) -> &'static str {
        self.inner.without_program()
    }
}

impl Integrator for Substepped {
    fn id(&self) -> &'static str {
        self.inner.id()
    }

    fn properties(&self) -> Properties {
        let inner = self.inner.properties();
        Properties {
            refuses_long_steps: inner.refuses_long_steps || self.substeps == Substeps::Auto,
            ..inner
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        Prepared::check(self.id(), system, dt)?;
        let parts = self.parts(system, dt)?;
        self.parts = Some((system.revision(), dt, parts));
        self.inner.prepare(system, dt / f64::from(parts))
    }

    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        match (self.inner.stable_step_about(system, state)?, self.substeps) {
            (StableStep::UpTo(limit), Substeps::Fixed(parts)) => {
                Ok(StableStep::UpTo(limit * f64::from(parts)))
            }
            (StableStep::UpTo(limit), Substeps::Auto) if limit > 0.0 => Ok(StableStep::Any),
            (other, _) => Ok(other),
        }
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let parts = self.parts(batch.system(), batch.dt())?;
        batch.in_parts(parts, |batch| {
            if self.substeps == Substeps::Auto && batch.system().as_linear().is_none() {
                self.run_by_current_stiffness(batch, state)
            } else {
                self.inner.run(batch, state)
            }
        })
    }

    fn kernel(&self) -> Option<String> {
        self.inner.kernel()
    }

    fn facts(&self) -> Vec<Fact> {
        let mut facts = self.inner.facts();
        if let Some((_, _, parts)) = self.parts {
            facts.push(Fact {
                name: "substeps",
                value: f64::from(parts),
            });
        }
        facts
    }

    fn remarks(&self) -> Vec<String> {
        self.inner.remarks()
    }
}
