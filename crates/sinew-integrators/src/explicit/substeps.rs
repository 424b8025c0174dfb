//! `substeps`: a step cut into equal parts.

use sinew_core::{
    Fact, Integrator, OptionError, OptionValue, Options, Properties, SetupError, StableStep, State,
    StepError, StepReport, System,
};

/// Share of the stable step that automatic sub-steps stay below.
const MARGIN: f64 = 0.9;

/// Into how many parts a step is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// This many parts, always.
    Fixed(u32),
    /// As many as bring a part below nine tenths of the stable step.
    Auto,
}

impl Substeps {
    /// The option's key.
    pub const KEY: &'static str = "substeps";

    /// The fewest equal parts (from 1 on) of a step of `dt` (s) that are no longer than nine tenths
    /// of `limit` (s), which is above 0; at most `u32::MAX`.
    #[must_use]
    pub fn parts_of(dt: f64, limit: f64) -> u32 {
        Self::parts(dt, limit).min(f64::from(u32::MAX)) as u32
    }

    /// Length (s) of the longest equal parts of a time of `length` (s) that are no longer than nine
    /// tenths of `limit` (s), which is above 0, however many they are.
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
        match options.remove(Self::KEY) {
            None => Ok(None),
            Some(OptionValue::Text(word)) if word == "auto" => Ok(Some(Self::Auto)),
            Some(OptionValue::Number(count))
                if count >= 1.0 && count <= f64::from(u32::MAX) && count.fract() == 0.0 =>
            {
                Ok(Some(Self::Fixed(count as u32)))
            }
            Some(found) => Err(OptionError::Value {
                integrator: integrator.into(),
                key: Self::KEY.into(),
                found,
                expected: "a whole number from 1 on, or \"auto\"",
            }),
        }
    }
}

/// The next whole number of parts, from 1 on.
pub(super) fn whole(parts: f64) -> u32 {
    parts.ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// An integrator that takes several equal steps for each one asked of it.
pub struct Substepped {
    inner: Box<dyn Integrator>,
    substeps: Substeps,
    parts: Option<(sinew_core::Revision, f64, u32)>,
}

impl Substepped {
    /// Cuts the steps of `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Integrator>, substeps: Substeps) -> Self {
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
                    let parts = Substeps::parts_of(dt, limit);
                    if dt / f64::from(parts) <= limit {
                        return Ok(parts);
                    }
                    Err(SetupError::Unresolved {
                        integrator: self.inner.id(),
                        reason: format!(
                            "dt = {dt} s is {:.1e} times the stable step, too many for substeps = \"auto\"; take a shorter dt",
                            dt / limit
                        ),
                    })
                }
                StableStep::UpTo(_) | StableStep::Unknown => Err(SetupError::Lacks {
                    integrator: self.inner.id(),
                    needs: "a stable step above 0 to choose sub-steps by",
                }),
            },
        }
    }
}

impl Integrator for Substepped {
    fn id(&self) -> &'static str {
        self.inner.id()
    }

    fn properties(&self) -> Properties {
        self.inner.properties()
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if !(dt.is_finite() && dt > 0.0) {
            return self.inner.prepare(system, dt);
        }
        let parts = self.parts(system, dt)?;
        self.parts = Some((system.revision(), dt, parts));
        self.inner.prepare(system, dt / f64::from(parts))
    }

    fn stable_step(&self, system: &dyn System) -> Result<StableStep, SetupError> {
        match (self.inner.stable_step(system)?, self.substeps) {
            (StableStep::UpTo(limit), Substeps::Fixed(parts)) => {
                Ok(StableStep::UpTo(limit * f64::from(parts)))
            }
            (StableStep::UpTo(limit), Substeps::Auto) if limit > 0.0 => Ok(StableStep::Any),
            (other, _) => Ok(other),
        }
    }

    fn step(
        &mut self,
        system: &dyn System,
        state: &mut State,
        dt: f64,
    ) -> Result<StepReport, StepError> {
        let mut work = self.prepare(system, dt)?;
        let parts = self.parts(system, dt)?;
        for _ in 0..parts {
            work.add_part(self.inner.step(system, state, dt / f64::from(parts))?);
        }
        Ok(work)
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
