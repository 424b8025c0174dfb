//! Inputs from outside, known only while a simulation runs.

use crate::channel_record::{Between, InputError, Record};
use crate::force_record::{ForceInputError, ForceRecord};
use crate::load::Load;
use crate::ramp::{Channel, Ramp, RampError};

/// Inputs that a caller gives while a simulation runs: forces of a user, factors of loads, positions of supports.
///
/// The caller owns them and passes them with every step. They are a record: each value is kept
/// with its time, so that a run is a function of its inputs, and the same record played again gives the
/// same bits. A method receives a force that was given frame by frame exactly as it would receive the
/// same force known beforehand.
///
/// ```
/// use sinew_core::Inputs;
///
/// let mut inputs = Inputs::new();
/// inputs.set_forces(0.0, &[(4, 0.2)])?; // 0.2 N on degree of freedom 4 from now on
/// inputs.set_forces(0.016, &[])?; // and none from t = 16 ms on
/// assert_eq!(inputs.forces().count(), 1);
/// # Ok::<(), sinew_core::ForceInputError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    channels: Vec<Record>,
    forces: ForceRecord,
}

static NONE: Inputs = Inputs::new();
static ZERO: Ramp = Ramp::Hold {
    times: Vec::new(),
    values: Vec::new(),
};

impl Inputs {
    /// A record without channels and forces.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            channels: Vec::new(),
            forces: ForceRecord::new(),
        }
    }

    /// No inputs at all.
    #[must_use]
    pub fn none() -> &'static Self {
        &NONE
    }

    /// Adds a channel that is 0 until it is given a value.
    pub fn add_channel(&mut self, between: Between) -> Channel {
        self.push(match between {
            Between::Hold => Record::hold(),
            Between::Line => Record::line(0.0, 0.0),
        })
    }

    /// Adds a channel of lines that is 0 until it is given a value, which then applies before its time as well.
    pub fn add_open_line(&mut self) -> Channel {
        self.push(Record::open_line())
    }

    /// Adds a channel of factors of a ramp, each of which applies from its time on; 1 before the first. A load that
    /// follows the channel gets the ramp times the factor: it is scaled, in addition to its own course over time.
    ///
    /// # Errors
    /// [`RampError`] for a ramp that follows an input or has a factor already, or has an impossible parameter.
    pub fn add_factor_of(&mut self, ramp: Ramp) -> Result<Channel, RampError> {
        let record = Record::scaling(ramp);
        record.value.check()?;
        Ok(self.push(record))
    }

    /// Adds a channel of lines that begins with a value at `t` (s).
    #[cfg(feature = "serde")]
    pub(crate) fn add_line_from(&mut self, t: f64, value: f64) -> Result<Channel, InputError> {
        let channel = self.channels.len() as u32;
        crate::channel_record::check_finite(channel, t, value)?;
        Ok(self.push(Record::line(t, value)))
    }

    fn push(&mut self, record: Record) -> Channel {
        self.channels.push(record);
        Channel(self.channels.len() as u32 - 1)
    }

    /// Gives a channel its value from `t` (s) on ([`Between::Hold`]) or at `t` ([`Between::Line`]:
    /// give the position at the end of a step before the step is taken).
    ///
    /// # Errors
    /// [`InputError`] for numbers that are not finite, times that do not rise, lines too steep for a
    /// finite slope and channels of other inputs; nothing is recorded then.
    pub fn set(&mut self, channel: Channel, t: f64, value: f64) -> Result<(), InputError> {
        self.set_all(t, &[(channel, value)])
    }

    /// Gives several channels their values at the same time, all or none.
    ///
    /// # Errors
    /// Same as [`Inputs::set`].
    pub fn set_all(&mut self, t: f64, values: &[(Channel, f64)]) -> Result<(), InputError> {
        for (Channel(number), value) in values {
            let record = self.channels.get(*number as usize);
            let record = record.ok_or(InputError::NoChannel { channel: *number })?;
            record.check(*number, t, *value)?;
        }
        for (Channel(number), value) in values {
            self.channels[*number as usize].add(t, *value);
        }
        Ok(())
    }

    /// Recorded times (s) and values of a channel; empty if it has none, or if there is no such channel.
    #[must_use]
    pub fn course(&self, channel: Channel) -> (&[f64], &[f64]) {
        let record = self.channels.get(channel.0 as usize);
        record.map_or((&[], &[]), Record::course)
    }

    /// Replaces the forces that act from outside by these from `t` (s) on: (degree of freedom,
    /// force (N)). Forces given for `t` and later are replaced, so that a run that returns to a
    /// checkpoint can be given other forces from there on.
    ///
    /// # Errors
    /// [`ForceInputError`] for a time or force that is not finite; nothing is recorded then.
    pub fn set_forces(&mut self, t: f64, entries: &[(u32, f64)]) -> Result<(), ForceInputError> {
        self.forces.set(t, entries)
    }

    /// Forgets forces and values of channels that ended before `t` (s): keep two steps for methods that look back by
    /// one. Later inputs reuse the memory, so that a session that does so regularly stops allocating.
    pub fn forget_before(&mut self, t: f64) {
        self.forces.forget_before(t);
        for record in &mut self.channels {
            record.forget_before(t);
        }
    }

    /// Like [`Inputs::forget_before`], for the values of these channels only.
    pub fn forget_channels_before(&mut self, channels: &[Channel], t: f64) {
        for Channel(number) in channels {
            if let Some(record) = self.channels.get_mut(*number as usize) {
                record.forget_before(t);
            }
        }
    }

    /// The forces given so far, in the order of their times, each with the time for which it acts.
    pub fn forces(&self) -> impl ExactSizeIterator<Item = &Load> {
        self.forces.all()
    }

    /// The forces that act at some time from `from` to `to` (s), both included, found without a search through the
    /// others.
    pub(crate) fn forces_between(
        &self,
        from: f64,
        to: f64,
    ) -> impl ExactSizeIterator<Item = &Load> {
        self.forces.between(from, to)
    }

    /// The highest degree of freedom of all forces on record.
    pub(crate) fn highest_dof(&self) -> Option<u32> {
        self.forces.highest_dof()
    }

    /// Number of its channels.
    #[must_use]
    pub fn channel_count(&self) -> usize {
        self.channels.len()
    }

    /// True if the channel exists.
    #[must_use]
    pub fn has(&self, channel: Channel) -> bool {
        (channel.0 as usize) < self.channels.len()
    }

    /// The courses of all channels so far.
    #[cfg(any(test, feature = "serde"))]
    pub(crate) fn channels(&self) -> impl ExactSizeIterator<Item = &Ramp> {
        self.channels.iter().map(|record| &record.value)
    }

    pub(crate) fn value_of(&self, channel: Channel) -> &Ramp {
        self.channels
            .get(channel.0 as usize)
            .map_or(&ZERO, |record| &record.value)
    }

    pub(crate) fn rate_of(&self, channel: Channel) -> &Ramp {
        self.channels
            .get(channel.0 as usize)
            .map_or(&ZERO, |record| &record.rate)
    }
}

impl Ramp {
    /// This ramp, or the values so far of the input that it follows; 0 if inputs lack the channel.
    #[must_use]
    pub fn known<'a>(&'a self, inputs: &'a Inputs) -> &'a Self {
        match self {
            Self::Input(channel) => inputs.value_of(*channel),
            Self::InputRate(channel) => inputs.rate_of(*channel),
            Self::Position(of) => of.known(inputs),
            known => known,
        }
    }

    /// The channel that this ramp follows and that inputs do not have.
    #[must_use]
    pub fn missing_input(&self, inputs: &Inputs) -> Option<Channel> {
        match self.course() {
            Self::Input(channel) | Self::InputRate(channel) if !inputs.has(*channel) => {
                Some(*channel)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LoadTime;

    /// The force on a degree of freedom at an instant, and the number of entries that it is a sum of.
    fn force(inputs: &Inputs, dof: u32, t: f64) -> (f64, usize) {
        let acting = inputs.forces().filter(|load| load.ramp.value(t) != 0.0);
        let entries = acting.flat_map(|load| &load.entries);
        let own = entries.filter(|entry| entry.0 == dof).map(|entry| entry.1);
        own.fold((0.0, 0), |(sum, count), force| (sum + force, count + 1))
    }

    #[test]
    fn forces_given_for_an_earlier_time_replace_all_that_came_later() {
        let mut inputs = Inputs::new();
        for (t, value) in [(0.0, 1.0), (0.1, 2.0), (0.2, 3.0), (0.3, 4.0)] {
            inputs.set_forces(t, &[(0, value)]).unwrap();
        }
        inputs.set_forces(0.15, &[(0, -5.0), (1, 7.0)]).unwrap();
        for (t, expected) in [(0.05, 1.0), (0.12, 2.0), (0.15, -5.0), (0.35, -5.0)] {
            assert_eq!(force(&inputs, 0, t), (expected, 1), "at {t} s");
        }
        inputs.set_forces(0.15, &[]).unwrap();
        assert_eq!(force(&inputs, 0, 0.12), (2.0, 1));
        assert_eq!(force(&inputs, 0, 0.35), (0.0, 0));
        assert_eq!(inputs.forces().count(), 2);
    }

    #[test]
    fn forces_that_ended_are_forgotten() {
        let mut inputs = Inputs::new();
        for frame in 0..10 {
            inputs.set_forces(f64::from(frame), &[(0, 1.0)]).unwrap();
        }
        inputs.forget_before(7.0);
        assert_eq!(inputs.forces().count(), 4);
        assert_eq!(force(&inputs, 0, 6.5), (1.0, 1));
    }

    #[test]
    fn a_channel_that_forgot_goes_on_as_before() {
        let mut whole = Inputs::new();
        let channels = [Between::Hold, Between::Line].map(|between| whole.add_channel(between));
        let mut short = whole.clone();
        let ramps = channels.map(|channel| [Ramp::Input(channel), Ramp::InputRate(channel)]);
        for frame in 1..200 {
            let t = 0.016 * f64::from(frame);
            for channel in channels {
                for inputs in [&mut whole, &mut short] {
                    inputs.set(channel, t, (7.0 * t).sin()).unwrap();
                }
            }
            short.forget_before(t - 0.04);
            for ramp in ramps.as_flattened() {
                for back in [0.0, 0.01, 0.016, 0.035] {
                    let when = LoadTime::at(t - back);
                    let [expected, found] = [&whole, &short].map(|of| ramp.factor(when.under(of)));
                    assert_eq!(found, expected, "{ramp:?} at {t} s, {back} s ago");
                }
            }
            let kept = short.channels().map(|ramp| ramp.breakpoints().len());
            assert!(kept.max() <= Some(4), "frame {frame}");
        }
    }

    #[test]
    fn channels_follow_what_they_are_given() {
        let mut inputs = Inputs::new();
        let hold = inputs.add_channel(Between::Hold);
        let line = inputs.add_channel(Between::Line);
        for (t, value) in [(1.0, 4.0), (2.0, -2.0)] {
            inputs.set(hold, t, value).unwrap();
            inputs.set(line, t, value).unwrap();
        }
        let at = |ramp: &Ramp| [0.5, 1.5, 2.5].map(|t| ramp.value(t));
        assert_eq!(at(inputs.value_of(hold)), [0.0, 4.0, -2.0]);
        assert_eq!(at(inputs.value_of(line)), [2.0, 1.0, -2.0]);
        assert_eq!(at(inputs.rate_of(hold)), [0.0; 3]);
        assert_eq!(at(inputs.rate_of(line)), [4.0, -6.0, 0.0]);
        assert!(matches!(
            inputs.set(line, 2.0, 0.0),
            Err(InputError::Order { channel: 1, .. })
        ));
        assert!(matches!(
            inputs.set(hold, 3.0, f64::NAN),
            Err(InputError::NotFinite { channel: 0, .. })
        ));
        assert!(matches!(
            inputs.set(Channel(2), 3.0, 0.0),
            Err(InputError::NoChannel { channel: 2 })
        ));
    }

    #[test]
    fn a_position_given_step_by_step_is_the_table_known_beforehand() {
        let (dt, positions) = (0.05, [0.0, 0.3, 0.1, 0.1, -0.7]);
        let table = Ramp::Table {
            times: (0..5).map(|n| f64::from(n) * dt).collect(),
            values: positions.to_vec(),
        };
        let mut inputs = Inputs::new();
        let channel = inputs.add_channel(Between::Line);
        let (value, rate) = (Ramp::Input(channel), Ramp::Input(channel).rate());
        assert_eq!(rate, Ramp::InputRate(channel));
        for (n, position) in (1..5).zip(&positions[1..]) {
            let (from, to) = (f64::from(n - 1) * dt, f64::from(n) * dt);
            inputs.set(channel, to, *position).unwrap();
            for when in [
                LoadTime::start_of(from, dt),
                LoadTime::within(from, dt, 0.3),
                LoadTime::within(from, dt, 1.0),
            ] {
                let known = [table.factor(when), table.rate().factor(when)];
                let given = [&value, &rate].map(|ramp| ramp.factor(when.under(&inputs)));
                assert!(
                    (known[0] - given[0]).abs() < 1e-15,
                    "step {n}: {known:?} {given:?}"
                );
                assert!(
                    (known[1] - given[1]).abs() < 1e-13,
                    "step {n}: {known:?} {given:?}"
                );
            }
        }
        // After the last position it stays.
        let later = LoadTime::at(0.3).under(&inputs);
        assert_eq!([&value, &rate].map(|ramp| ramp.factor(later)), [-0.7, 0.0]);
    }

    #[test]
    fn times_that_do_not_rise_are_refused() {
        let mut inputs = Inputs::new();
        let channel = inputs.add_channel(Between::Line);
        assert_eq!(inputs.set(channel, 0.1, 1.0), Ok(()));
        let refused = InputError::Order {
            channel: 0,
            t: 0.1,
            last: 0.1,
        };
        assert_eq!(inputs.set(channel, 0.1, 2.0), Err(refused));
        assert!(inputs.set(channel, f64::NAN, 2.0).is_err());
    }

    #[test]
    fn an_open_line_begins_with_its_first_value() {
        let mut inputs = Inputs::new();
        let line = inputs.add_open_line();
        let at = |inputs: &Inputs, t: f64| inputs.value_of(line).value(t);
        assert_eq!(
            (at(&inputs, 1.0), inputs.course(line)),
            (0.0, (&[][..], &[][..]))
        );
        inputs.set(line, 1.0, 4.0).unwrap();
        assert_eq!([0.0, 1.0, 2.0].map(|t| at(&inputs, t)), [4.0; 3]);
        inputs.set(line, 2.0, 6.0).unwrap();
        assert_eq!([0.0, 1.5, 3.0].map(|t| at(&inputs, t)), [4.0, 5.0, 6.0]);
        assert_eq!(inputs.course(line), (&[1.0, 2.0][..], &[4.0, 6.0][..]));
    }

    #[test]
    fn several_channels_are_set_together_or_not_at_all() {
        let mut inputs = Inputs::new();
        let [a, b] = [(); 2].map(|()| inputs.add_open_line());
        inputs.set_all(0.1, &[(a, 1.0), (b, 2.0)]).unwrap();
        let before = inputs.clone();
        for wrong in [f64::NAN, 1e308] {
            assert!(inputs.set_all(0.2, &[(a, 1.0), (b, wrong)]).is_err());
        }
        assert!(inputs.set_all(0.2, &[(a, 1.0), (Channel(2), 1.0)]).is_err());
        assert_eq!(inputs, before);
    }

    #[test]
    fn what_is_refused_is_not_recorded() {
        let mut inputs = Inputs::new();
        let line = inputs.add_channel(Between::Line);
        inputs.set(line, 0.1, 1.0).unwrap();
        inputs.set_forces(0.1, &[(3, 2.0)]).unwrap();
        let before = inputs.clone();
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let refused = inputs.set_forces(wrong, &[(0, 1.0)]);
            assert!(
                matches!(refused, Err(ForceInputError::Time { .. })),
                "{refused:?}"
            );
            let refused = inputs.set_forces(0.05, &[(7, 1.0), (8, wrong)]);
            assert!(
                matches!(refused, Err(ForceInputError::Force { dof: 8, .. })),
                "{refused:?}"
            );
            assert!(inputs.set(line, wrong, 1.0).is_err());
            assert!(inputs.set(line, 0.2, wrong).is_err());
        }
        // A slope of 1e309 / s.
        let refused = inputs.set(line, 0.1 + 1e-16, 1e293);
        assert!(
            matches!(refused, Err(InputError::Slope { .. })),
            "{refused:?}"
        );
        assert_eq!(inputs, before);
        assert_eq!(inputs.highest_dof(), Some(3));
    }
}
