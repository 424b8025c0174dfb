//! `substeps`: a step cut into equal parts.

use sinew_cnn::Program;
use sinew_core::{
    Batch, Fact, Integrator, OptionError, Options, Prepared, Properties, SetupError, StableStep,
    State, StepError, StepReport, System,
};

use crate::{OptionDefault, OptionHelp, OptionKind, Stepper};

/// Share of the stable step that automatic sub-steps stay below.
const MARGIN: f64 = 0.9;

/// Number of parts into which a step is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// This many parts, always.
    Fixed(u32),
    /// The fewest parts that are no longer than nine tenths of the stable step.
    Auto,
}

impl Substeps {
    /// The option's key.
    pub const KEY: &'static str = "substeps";

    /// The option.
    pub(crate) const HELP: OptionHelp = OptionHelp {
        key: Self::KEY,
        help: "equal parts into which each step is cut; \"auto\" for as many as keep them stable",
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

/// An integrator that takes several equal steps for each one asked of it.
pub struct Substepped {
    inner: Box<dyn Stepper>,
    substeps: Substeps,
    parts: Option<(sinew_core::Revision, f64, u32)>,
}

impl Substepped {
    /// Cuts the steps of `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Stepper>, substeps: Substeps) -> Self {
        Self {
            inner,
            substeps,
            parts: None,
        }
    }

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
                    Substeps::stable_parts_of(self.inner.id(), dt, limit, "substeps")
                }
                StableStep::UpTo(_) | StableStep::Unknown => Err(SetupError::Lacks {
                    integrator: self.inner.id(),
                    needs: "a stable step above 0 to choose sub-steps by",
                }),
            },
        }
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
        batch.in_parts(parts, |batch| self.inner.run(batch, state))
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
