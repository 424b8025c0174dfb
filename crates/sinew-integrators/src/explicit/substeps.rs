//! `substeps`: division of a step into equal substeps.

use super::known_step::{KEPT, Known, followed, wave_at_rest};
use super::relative_motion::RelativeMotion;
use sinew_cnn::Program;
use sinew_core::spectrum::{PRODUCTS_OF_ESTIMATE, Spectrum, follow_largest_eigenvalue};
use sinew_core::{
    Batch, CostClock, Damping, ElasticLaw, Fact, Integrator, LoadTime, OptionError, Options,
    Prepared, Properties, Revision, SetupError, StableStep, State, StepCut, StepError, StepReport,
    System, Trial,
};

use crate::stiffening::stiffened_element;
use crate::{OptionDefault, OptionHelp, OptionKind, Stepper};

/// Share of the stable step that automatic substeps stay below.
const MARGIN: f64 = 0.9;

/// Largest number of substeps that can be requested: a run can be interrupted between steps, never within one.
const MOST_FIXED: u32 = 10_000;

/// Number of substeps of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Substeps {
    /// A fixed number of substeps.
    Fixed(u32),
    /// The fewest substeps that are no longer than nine tenths of the stable step: that of the matrices, or of a law's
    /// current stiffness, which is checked repeatedly.
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

    /// The fewest equal substeps (from 1 on) of a step of `dt` (s) that are no longer than nine tenths of `limit` (s),
    /// which is above 0; at most `u32::MAX`.
    #[must_use]
    pub fn parts_of(dt: f64, limit: f64) -> u32 {
        Self::parts(dt, limit).min(f64::from(u32::MAX)) as u32
    }

    /// The same for a method, provided that the substeps are stable.
    ///
    /// # Errors
    /// [`SetupError::Unresolved`] if they are not, naming the option that requested them.
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

    /// Length (s) of the longest equal substeps of a time of `length` (s) that are no longer than nine tenths of
    /// `limit` (s), which is above 0, for any number of substeps.
    #[must_use]
    pub fn longest_part(length: f64, limit: f64) -> f64 {
        length / Self::parts(length, limit)
    }

    fn parts(dt: f64, limit: f64) -> f64 {
        // The subtrahend keeps a quotient like 3.0000000000000004 from costing one part more.
        (dt / (MARGIN * limit) - 1e-9).ceil().max(1.0)
    }

    /// Removes the option from the others and returns it; `None` if it is absent.
    ///
    /// # Errors
    /// [`OptionError::Value`] for anything but a whole number from 1 to 10000 or "auto".
    pub(crate) fn take_from(
        options: &mut Options,
        integrator: &str,
    ) -> Result<Option<Self>, OptionError> {
        let substeps = Self::HELP.read(options, integrator, |value| match value.word() {
            Some(_) => Some(Self::Auto),
            None => value.count(MOST_FIXED).map(Self::Fixed),
        })?;
        options.remove(Self::KEY);
        Ok(substeps)
    }
}

/// The next whole number of substeps, from 1 on.
pub(super) fn whole(parts: f64) -> u32 {
    parts.ceil().clamp(1.0, f64::from(u32::MAX)) as u32
}

/// Number of substeps after which two things are computed again: damping that is not only mass-proportional, and the
/// stable step of a law without tangent. Until then damping is assumed to grow with the stiffness.
const PARTS_BETWEEN_LOOKS: u32 = 40;

/// Largest number of substeps between two checks, by the fastest motion, of a shrinking stable step.
const PARTS_BETWEEN_GLANCES: u32 = 4;

/// The same for a law that stiffens gently, while the step stays stable although the wave's square grows by [`SPARE`];
/// twice as many if it may grow by that twice.
const PARTS_BETWEEN_GLANCES_WITH_SPARE: u32 = 8;

/// Growth of the fastest wave's square, as a factor, that leaves time until the next check.
const SPARE: f64 = 1.15;

/// Growth of the fastest wave's square up to which the stable step is updated from it; beyond it a full check is made.
const MOST_FOLLOWED: f64 = 1.5;

/// Number of substeps after which a full check is made again, if the wave alone, by its value at rest, would allow
/// longer substeps than the current ones.
const PARTS_BETWEEN_DOUBTS: u32 = 24;

/// The same while that wave is as it was at the last full check, up to [`SAME`].
const PARTS_BETWEEN_DOUBTS_AT_REST: u32 = 5 * PARTS_BETWEEN_DOUBTS;

/// Change of the fastest wave's square that gives no new information, as a factor.
const SAME: f64 = 1.1;

/// Number of steps after which fewer substeps are taken, as many as these steps needed at most: each change of the step
/// excites the fastest motions a little.
const STEPS_UNTIL_FEWER: u32 = 24;

/// Number of products of a full check after the first one, until their estimate settles.
const PRODUCTS_OF_LOOK: u64 = 6;

/// Largest factor by which the stable step is expected to shrink until the next quick check.
const MOST_SHRINKING: f64 = 2.0;

/// Largest motion of a cell relative to a neighbour in a substep, as a share of its size: beyond it strains change too
/// much within a substep, and energy is created although each substep is stable.
const MOST_MOTION: f64 = 0.1;

/// Largest number of substeps for a step that takes two at rest, by the current stiffness: if it needs more, something
/// is wrong, and a run would not end.
const MOST_PARTS: u32 = 1000;

/// An integrator that takes several equal steps for each requested step.
pub struct Substepped {
    inner: Box<dyn Stepper>,
    substeps: Substeps,
    /// Number of equal substeps into which each substep is divided further.
    finer: u32,
    parts: Option<(Revision, f64, u32)>,
    /// The stable step at rest and the fastest wave there, if the law provides it.
    rest: Option<(Revision, Known)>,
    /// A force (N).
    room: Vec<f64>,
    /// The state before the step in progress.
    kept: State,
    motion: RelativeMotion,
}

impl Substepped {
    /// Divides the steps of `inner`.
    #[must_use]
    pub fn new(inner: Box<dyn Stepper>, substeps: Substeps) -> Self {
        Self {
            inner,
            substeps,
            finer: 1,
            parts: None,
            rest: None,
            room: Vec::new(),
            kept: State::at_rest(0),
            motion: RelativeMotion::default(),
        }
    }

    /// Number of substeps at rest of a step that is divided by a law's current stiffness: with one, tissue that is a
    /// little stiffer would take twice as many.
    pub const PARTS_AT_REST: f64 = 2.0;

    /// The stable length of a divided step, from that of its substeps.
    fn of_whole(&self, of_part: StableStep) -> StableStep {
        match (of_part, self.substeps) {
            (StableStep::UpTo(limit), Substeps::Fixed(parts)) => {
                StableStep::UpTo(limit * f64::from(parts))
            }
            (StableStep::UpTo(limit), Substeps::Auto) if limit > 0.0 => StableStep::Any,
            (other, _) => other,
        }
    }

    /// The stable step at rest.
    fn stable_at_rest(&mut self, system: &dyn System) -> Result<StableStep, SetupError> {
        let revision = system.revision();
        if let Some((known, rest)) = self.rest
            && known == revision
        {
            return Ok(StableStep::UpTo(rest.limit));
        }
        let stable = self.inner.stable_step(system)?;
        self.rest = match stable {
            StableStep::UpTo(limit) => Some((
                revision,
                Known {
                    limit,
                    wave: wave_at_rest(system),
                },
            )),
            _ => None,
        };
        Ok(stable)
    }

    fn parts(&mut self, system: &dyn System, dt: f64) -> Result<u32, SetupError> {
        if let Some((revision, step, parts)) = self.parts
            && revision == system.revision()
            && step == dt
        {
            return Ok(parts);
        }
        match self.substeps {
            Substeps::Fixed(parts) => Ok(parts),
            Substeps::Auto => match self.stable_at_rest(system)? {
                StableStep::Any => Ok(self.finer),
                StableStep::UpTo(limit) if limit > 0.0 && dt.is_finite() => {
                    let id = self.inner.id();
                    match system.as_linear() {
                        Some(_) => Substeps::stable_parts_of(id, dt, limit, "substeps")
                            .map(|parts| parts.saturating_mul(self.finer)),
                        // By a law's current stiffness each of them is cut again.
                        None => Substeps::stable_parts_of(
                            id,
                            dt,
                            Self::PARTS_AT_REST * limit,
                            "substeps",
                        ),
                    }
                }
                StableStep::UpTo(_) | StableStep::Unknown => Err(SetupError::Lacks {
                    integrator: self.inner.id(),
                    needs: "a stable step above 0 to choose sub-steps by",
                }),
            },
        }
    }
}

/// Number of substeps by the current stiffness of a law, for a step that takes two at rest. It is a function of the
/// state alone, in which it is stored. After each step, and after four substeps of a longer one, the fastest wave shows
/// whether the stable step may have shrunk ([`ElasticLaw::fastest_wave`]); more seldom for a law that stiffens gently. If so, or for laws without this information,
/// products of the tangent update the estimate of the fastest motion ([`follow_largest_eigenvalue`]), about two forces
/// each. A step that is too long for the stiffness at its end, or that the law refuses, is taken again in shorter
/// substeps from the state before it: contact, history variables and its effects on the energy are undone.
impl Substepped {
    fn goes_by_current_stiffness(&self, system: &dyn System) -> bool {
        self.substeps == Substeps::Auto && system.as_linear().is_none()
    }

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

    /// The division of the first step.
    fn first_cut(
        &mut self,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<StepCut, StepError> {
        let mut cut = StepCut {
            parts: 1,
            taken: PARTS_BETWEEN_LOOKS,
            stable_step: f64::INFINITY,
            wave: 0.0,
            seen: 0.0,
            damping: 0.0,
            needed: 1,
            steps: 0,
        };
        state.fastest.clear();
        let stable = match (self.rest, self.wave(batch, state)?) {
            (Some((_, rest)), Some(wave)) if wave <= MOST_FOLLOWED * rest.wave => {
                (cut.stable_step, cut.wave, cut.taken) = (rest.limit, rest.wave, 0);
                cut.seen = wave;
                rest.limit_at(wave)
            }
            (_, wave) => {
                cut.wave = wave.unwrap_or(0.0);
                self.look(&mut cut, batch, state)?;
                (cut.seen, cut.taken) = (cut.wave, 0);
                cut.stable_step
            }
        };
        cut.parts = Substeps::parts_of(batch.dt(), stable);
        if cut.parts <= MOST_PARTS {
            return Ok(cut);
        }
        Err(self.too_stiff(batch, state))
    }

    /// Takes the next step, and repeats it in more substeps as long as it is too long.
    fn take_one(
        &mut self,
        batch: &mut Batch<'_>,
        state: &mut State,
        mut cut: StepCut,
    ) -> Result<(), StepError> {
        keep(&mut self.kept, state);
        loop {
            let parts = cut.parts.saturating_mul(self.finer);
            self.inner
                .prepare(batch.system(), batch.dt() / f64::from(parts))?;
            let tried = batch.try_in_parts(parts, |batch| self.try_in(cut, batch, state));
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
            keep(state, &mut self.kept);
            batch.discard_trial();
        }
    }

    /// Ends a motion for which the largest number of substeps is not enough.
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
            _ => self.too_stiff(batch, state),
        })
    }

    fn too_stiff(&self, batch: &Batch<'_>, state: &State) -> StepError {
        let cause = match stiffened_element(batch.system(), batch.inputs(), state) {
            Some(element) => element.to_string(),
            None => "elements are squeezed flat, fibres or a law that stiffens are stretched too far, or the displacement is \
                     not finite"
                .to_owned(),
        };
        let dt = batch.dt();
        StepError::Inaccurate {
            integrator: self.id(),
            t: state.t(),
            reason: format!(
                "the current stiffness takes more than {MOST_PARTS} parts of {dt} s, which takes two at rest: {cause}. Reduce the \
                 loads or motions, or give dt in seconds, which has no such bound"
            ),
        }
    }

    /// Takes a step with this division, and divides the one after it; returns the number of substeps that the step
    /// itself needed.
    fn try_in(
        &mut self,
        mut cut: StepCut,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<u32, StepError> {
        let parts = cut.parts;
        let stretch = parts.div_ceil(parts.div_ceil(PARTS_BETWEEN_GLANCES));
        let law = followed(batch.system());
        let is_gentle = law.is_some_and(ElasticLaw::stiffens_gently);
        while batch.goes_on() {
            let left = batch.parts_left() as u32 / self.finer;
            let stretch = stretch.min(left);
            batch.next_parts(stretch * self.finer, |batch| self.inner.run(batch, state))?;
            if batch.diverged().is_some() {
                return Ok(u32::MAX);
            }
            cut.taken = cut.taken.saturating_add(stretch);
            if is_gentle && !self.is_glance_due(&cut, stretch, batch.dt()) {
                continue;
            }
            let needed = self.parts_needed(&mut cut, parts, (batch, state))?;
            if needed > parts {
                return Ok(needed);
            }
        }
        let fewest = self.fewest_parts(&cut, parts, batch.dt());
        let most = MOST_MOTION * f64::from(fewest);
        let motion = self
            .motion
            .over_size(batch.system(), [&self.kept.u, &state.u], most);
        let needed = match motion > most {
            true => whole(motion / MOST_MOTION),
            false => fewest,
        };
        if needed > parts {
            return Ok(needed);
        }
        note(&mut cut, parts, needed);
        state.cut = Some(cut);
        Ok(parts)
    }

    /// True if the fastest wave of a law that stiffens gently is to be looked at after `stretch` substeps, each of which the
    /// method takes in parts of this length (s): seldom while it may grow a good deal before it matters.
    fn is_glance_due(&self, cut: &StepCut, stretch: u32, part: f64) -> bool {
        let part = part * f64::from(self.finer);
        let may_grow = |by: f64| Known::of(cut).allows(by * cut.seen, part);
        let interval = match may_grow(SPARE) {
            false => return true,
            true if may_grow(SPARE * SPARE) => 2 * PARTS_BETWEEN_GLANCES_WITH_SPARE,
            true => PARTS_BETWEEN_GLANCES_WITH_SPARE,
        };
        cut.taken / interval != cut.taken.saturating_sub(stretch) / interval
    }

    /// The fewest substeps of a step, up to `parts` substeps of this length (s), that are stable by current knowledge.
    fn fewest_parts(&self, cut: &StepCut, parts: u32, part: f64) -> u32 {
        let by_look = Known::of(cut).limit_at(cut.seen);
        let by_rest = self.rest.map(|(_, rest)| rest.limit_at(cut.seen));
        let limit = match cut.seen > 0.0 {
            true => by_look.max(by_rest.unwrap_or(0.0)),
            false => cut.stable_step,
        };
        let step = part * f64::from(self.finer) * f64::from(parts);
        Substeps::parts_of(step, limit).min(parts)
    }

    /// Checks the stiffness after some of `parts` substeps, and updates the division; returns the number of substeps
    /// that the step needed.
    fn parts_needed(
        &mut self,
        cut: &mut StepCut,
        parts: u32,
        (batch, state): (&mut Batch<'_>, &mut State),
    ) -> Result<u32, StepError> {
        let part = batch.dt() * f64::from(self.finer);
        let wave = self.wave(batch, state)?;
        if let Some(wave) = wave
            && self.is_followed(cut, wave, part)
        {
            cut.seen = wave;
            return Ok(parts);
        }
        let before = cut.stable_step;
        if !self.look(cut, batch, state)? {
            return Ok(parts);
        }
        let mut shrinking = (before / cut.stable_step).clamp(1.0, MOST_SHRINKING);
        let mut kept = KEPT;
        if let Some(wave) = wave {
            // It tells when to look again, which should not be soon.
            shrinking = (wave / cut.seen).clamp(1.0, MOST_SHRINKING.powi(2)).sqrt();
            kept = MARGIN;
            (cut.wave, cut.seen, cut.taken) = (wave, wave, 0);
        }
        let expected = cut.stable_step / shrinking;
        let enough = || Substeps::parts_of(part * f64::from(parts), expected);
        if part > cut.stable_step {
            return Ok(enough());
        }
        if part > kept * expected {
            cut.parts = cut.parts.max(enough().min(MOST_PARTS));
        }
        Ok(parts)
    }

    /// The fastest wave in a state, if it determines stable steps until the next full check.
    fn wave(&self, batch: &Batch<'_>, state: &State) -> Result<Option<f64>, StepError> {
        let Some(law) = followed(batch.system()) else {
            return Ok(None);
        };
        let trial = Trial::of(state, LoadTime::at(state.t()).under(batch.inputs()));
        law.fastest_wave(&trial)
            .map_err(|source| StepError::Refused {
                t: state.t(),
                source,
            })
    }

    /// True if substeps of this length (s) stay stable according to the last full check and the fastest wave.
    fn is_followed(&self, cut: &StepCut, wave: f64, part: f64) -> bool {
        let rest = self.rest.map(|(_, rest)| rest);
        let by_rest = || rest.is_some_and(|rest| rest.allows(wave, part));
        let is_same = wave <= SAME * cut.wave && cut.wave <= SAME * wave;
        // The farther from the limit, the later: what grows fourfold in its square is seen by then.
        let spare = (Known::of(cut).limit_at(wave) / part).min(2.0);
        let until_doubt = match is_same {
            true => PARTS_BETWEEN_DOUBTS_AT_REST,
            false => whole(f64::from(PARTS_BETWEEN_DOUBTS) * spare.powi(4)),
        };
        wave <= MOST_FOLLOWED * cut.wave
            && Known::of(cut).allows(wave, part)
            && (cut.taken < until_doubt || by_rest())
    }

    /// Updates the stable step from a state; returns false if it is left unchanged.
    fn look(
        &mut self,
        cut: &mut StepCut,
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<bool, StepError> {
        let system = batch.system();
        let elastic = system.as_elastic();
        let is_damped = |damping: &Damping| damping.stiffness != 0.0 || damping.extra.is_some();
        let needs_all = elastic.is_none_or(|law| is_damped(law.damping()));
        let found = if needs_all && cut.taken >= PARTS_BETWEEN_LOOKS {
            cut.taken = 0;
            batch.count(sweeps(PRODUCTS_OF_ESTIMATE * (1 + viscous_sweeps(system))));
            system.spectrum(Some(state))
        } else if elastic.is_some() {
            None
        } else {
            return Ok(false);
        };
        if let Some(found) = found {
            let squared = found.omega_max.powi(2);
            let has_both = squared > 0.0 && found.damping_max > 0.0;
            cut.damping = if has_both {
                found.damping_max / squared
            } else {
                0.0
            };
        }
        let spectrum = match elastic {
            Some(law) => {
                let eigenvalue = self.fastest((law, cut.wave > 0.0), batch, state)?;
                let damping = law.damping();
                Some(Spectrum {
                    omega_max: eigenvalue.sqrt(),
                    damping_max: cut.damping * eigenvalue,
                    mass_damping: damping.mass,
                    stiffness_damping: damping.stiffness,
                    proportional: damping.extra.is_none() && damping.stiffness == 0.0,
                })
            }
            None => found,
        };
        let stable_step = spectrum.map(|spectrum| self.inner.stable_step_of(&spectrum));
        cut.stable_step = match stable_step {
            Some(StableStep::Any) => f64::INFINITY,
            Some(StableStep::UpTo(limit)) => limit,
            Some(StableStep::Unknown) | None => 0.0,
        };
        Ok(true)
    }

    /// The largest eigenvalue (1/s^2) of a law's tangent in a state, relative to the masses.
    fn fastest(
        &mut self,
        (law, waves): (&dyn ElasticLaw, bool),
        batch: &mut Batch<'_>,
        state: &mut State,
    ) -> Result<f64, StepError> {
        let mass = batch.system().mass();
        let mut fields = std::mem::take(&mut state.fastest);
        self.room.resize(mass.len(), 0.0);
        let trial = Trial::of(state, LoadTime::at(state.t()).under(batch.inputs()));
        // A law whose waves tell is asked rarely.
        let most = if waves { PRODUCTS_OF_LOOK } else { 1 };
        let mut products = 0;
        let found = follow_largest_eigenvalue(&mut fields, mass, &mut self.room, most, |x, out| {
            products += 1;
            law.stiffest_product(&trial, x, out)
        });
        batch.count(sweeps(products));
        state.fastest = fields;
        found.map_err(|source| StepError::Refused {
            t: state.t(),
            source,
        })
    }
}

/// Copies a state without the fields of the fastest motion, which only full checks change: a repeated step keeps its
/// information on that motion.
fn keep(to: &mut State, from: &mut State) {
    let fields = [&mut *to, &mut *from].map(|state| std::mem::take(&mut state.fastest));
    to.clone_from(from);
    [to.fastest, from.fastest] = fields;
}

/// Records the number of substeps that a step of `parts` substeps needed, and takes the largest number that the last
/// steps needed.
fn note(cut: &mut StepCut, parts: u32, needed: u32) {
    if cut.parts > parts {
        (cut.needed, cut.steps) = (1, 0);
        return;
    }
    (cut.needed, cut.steps) = (cut.needed.max(needed), cut.steps + 1);
    if cut.steps >= STEPS_UNTIL_FEWER {
        cut.parts = cut.needed;
        (cut.needed, cut.steps) = (1, 0);
    }
}

/// The work of this number of sweeps.
fn sweeps(sweeps: u64) -> StepReport {
    StepReport {
        sweeps,
        ..StepReport::default()
    }
}

/// Sweeps that stiffness damping takes where the tangent takes one.
fn viscous_sweeps(system: &dyn System) -> u64 {
    let elastic = system.as_elastic();
    elastic.map_or(0, |law| u64::from(law.damping().stiffness != 0.0))
}

impl Stepper for Substepped {
    fn program(&self) -> Option<Program> {
        let (_, _, parts) = self.parts?;
        Some(self.inner.program()?.repeated(parts))
    }

    fn stable_step_of(&self, spectrum: &Spectrum) -> StableStep {
        self.of_whole(self.inner.stable_step_of(spectrum))
    }

    fn refine(&mut self, times: u32) -> bool {
        if self.substeps != Substeps::Auto {
            return self.inner.refine(times);
        }
        (self.finer, self.parts) = (times.max(1), None);
        true
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
        let set_up = Some((system.revision(), dt, parts));
        let before = std::mem::replace(&mut self.parts, set_up);
        if before == set_up && self.goes_by_current_stiffness(system) {
            // Each step sets up for the parts that it takes.
            return Ok(StepReport::default());
        }
        self.inner
            .prepare(system, dt / f64::from(parts))
            .inspect_err(|_| self.parts = None)
    }

    fn stable_step_about(
        &self,
        system: &dyn System,
        state: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        Ok(self.of_whole(self.inner.stable_step_about(system, state)?))
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        let parts = self.parts(batch.system(), batch.dt())?;
        batch.in_parts(parts, |batch| {
            if self.goes_by_current_stiffness(batch.system()) {
                self.run_by_current_stiffness(batch, state)
            } else {
                self.inner.run(batch, state)
            }
        })
    }

    fn kernel(&self) -> Option<String> {
        self.inner.kernel()
    }

    fn cost_clock(&self) -> CostClock {
        self.inner.cost_clock()
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
