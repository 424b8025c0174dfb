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
        expected: "a whole number from 1 on, or \"auto\"",
        kind: OptionKind::Either(&[OptionKind::Count(u32::MAX), OptionKind::Words(&["auto"])]),
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
    /// [`OptionError::Value`] for anything but a whole number from 1 on or "auto".
    pub fn take_from(options: &mut Options, integrator: &str) -> Result<Option<Self>, OptionError> {
        let substeps = Self::HELP.read(options, integrator, |value| match value.word() {
            Some(_) => Some(Self::Auto),
            None => value.count(u32::MAX).map(Self::Fixed),
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
/// the square root: what is left is room until the next look. That costs about a force.
impl Substepped {
    fn run_by_current_stiffness(
        &mut self,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<(), StepError> {
        while batch.goes_on() {
            let (cut, sweeps) = self.current_cut(batch, state)?;
            batch.count(StepReport {
                sweeps,
                ..StepReport::default()
            });
            let (system, part) = (batch.system(), batch.dt() / f64::from(cut.parts));
            self.inner.prepare(system, part)?;
            state.cut = Some(StepCut {
                taken: cut.taken.saturating_add(cut.parts),
                ..cut
            });
            batch.next_in_parts(cut.parts, |batch| self.inner.run(batch, state))?;
        }
        Ok(())
    }

    /// The cut of the next step, and the sweeps that it took to find it.
    fn current_cut(
        &mut self,
        batch: &Batch<'_>,
        state: &State,
    ) -> Result<(StepCut, u64), StepError> {
        let (system, dt) = (batch.system(), batch.dt());
        let before = state.cut.filter(|cut| cut.taken < PARTS_BETWEEN_LOOKS);
        if let Some(cut) = before {
            // Whether the last step passed a multiple of them.
            if cut.taken % PARTS_BETWEEN_GLANCES >= cut.parts {
                return Ok((cut, 0));
            }
            let growth = self.stiffest_cell(batch, state)? / cut.stiffest_cell;
            // Not a number where the law has no such blocks.
            if growth.is_nan() || growth <= 1.0 {
                return Ok((cut, 1));
            }
            if growth <= MUCH_STIFFER {
                let parts = self.parts_by(dt, cut.stable_step / growth, state)?;
                let parts = parts.max(cut.parts);
                return Ok((StepCut { parts, ..cut }, 1));
            }
        }
        let stable_step = match self.inner.stable_step_about(system, Some(state))? {
            StableStep::Any => f64::INFINITY,
            StableStep::UpTo(limit) => limit,
            StableStep::Unknown => 0.0,
        };
        let parts = self.parts_by(dt, stable_step, state)?;
        // Never fewer than before: a leapfrog that changes to and fro between two lengths, each of them stable, may swing up.
        let parts = parts.max(state.cut.map_or(1, |cut| cut.parts));
        let cut = StepCut {
            parts,
            taken: 0,
            stable_step,
            stiffest_cell: self.stiffest_cell(batch, state)?,
        };
        Ok((cut, PRODUCTS_OF_ESTIMATE + 1))
    }

    fn parts_by(&self, dt: f64, stable_step: f64, state: &State) -> Result<u32, StepError> {
        let parts = Substeps::parts(dt, stable_step);
        if parts <= f64::from(MOST_PARTS) {
            return Ok(parts as u32);
        }
        Err(StepError::Inaccurate {
            integrator: self.id(),
            t: state.t(),
            reason: format!(
                "the current stiffness takes more than {MOST_PARTS} parts of {dt} s, which takes two at rest: elements are squeezed flat, or the \
                 displacement is not finite"
            ),
        })
    }

    /// The largest trace of a cell's own block over its mass (1/s^2); 0 where the law has no such blocks.
    fn stiffest_cell(&mut self, batch: &Batch<'_>, state: &State) -> Result<f64, StepError> {
        let system = batch.system();
        let Some(elastic) = system.as_elastic() else {
            return Ok(0.0);
        };
        let layers = system.layers().count();
        self.blocks.resize(layers * system.dofs(), 0.0);
        let trial = Trial {
            load: LoadTime::at(state.t()).under(batch.inputs()),
            dt: 0.0,
            u: &state.u,
            v: &state.v,
            internal: &state.internal,
        };
        let refused = |source| StepError::Refused {
            t: state.t(),
            source,
        };
        elastic
            .node_blocks(&trial, &mut self.blocks)
            .map_err(refused)?;
        let blocks = self.blocks.chunks_exact(layers * layers);
        let cells = blocks.zip(system.mass().chunks_exact(layers));
        let stiffness = cells.map(|(block, mass)| {
            let trace: f64 = block.iter().step_by(layers + 1).sum();
            trace / mass[0]
        });
        Ok(stiffness.fold(0.0, f64::max))
    }
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
