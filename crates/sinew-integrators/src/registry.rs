//! Integrators by name.

use sinew_core::{Fact, OptionError, OptionValue, Options};
use sinew_machines::Settings;

use crate::explicit::{GuardOption, Guarded, Substepped, Substeps};
use crate::machine_options::{MACHINE_OPTIONS, take_settings};
use crate::{ConservedEnergy, Method, OptionHelp, OptionLabel, Stepper};

/// Calls `$then! { name: Type, .. }` with every integrator: the one list for the registry and the conformance tests. A
/// new integrator is one line here.
#[macro_export]
macro_rules! for_each_integrator {
    ($then:ident) => {
        $then! {
            forward_euler: $crate::explicit::ForwardEuler,
            symplectic_euler: $crate::explicit::SymplecticEuler,
            #[cfg(feature = "implicit")]
            central_difference: $crate::explicit::PatchedCentralDifference,
            #[cfg(not(feature = "implicit"))]
            central_difference: $crate::explicit::CentralDifference,
            rk4: $crate::explicit::Rk4,
            modified_leapfrog: $crate::explicit::ModifiedLeapfrog,
            propagator: $crate::propagator::Propagator,
            #[cfg(feature = "implicit")]
            implicit_euler: $crate::implicit::ImplicitEuler,
            #[cfg(feature = "implicit")]
            newmark: $crate::implicit::Newmark,
            #[cfg(feature = "implicit")]
            modal: $crate::implicit::Modal,
            #[cfg(feature = "implicit")]
            generalized_alpha: $crate::implicit::GeneralizedAlpha,
            cnn: $crate::cnn::Cnn,
            cnn_symplectic: $crate::cnn::CnnSymplectic,
            cnn_stabilised: $crate::cnn::CnnStabilised,
            cnn_energy: $crate::cnn::CnnEnergy,
        }
    };
}

/// Builds an integrator from its options, on a machine with these settings.
type Build = fn(&Options, Settings) -> Result<Box<dyn Stepper>, OptionError>;

/// An integrator that can be built by name.
#[derive(Clone, Copy)]
pub struct Entry {
    /// The name that users type.
    pub id: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// The options it takes, `substeps` and the guard's apart.
    pub options: &'static [OptionHelp],
    /// True if the method takes `substeps`.
    pub substeps: bool,
    /// Meaning of `saturation` for it.
    pub guard: GuardOption,
    /// True if its steps are programs, which take the options of machines.
    pub programs: bool,
    /// True if its set-up factorises a matrix of the whole body.
    pub factorises: bool,
    /// Options of the variants that comparisons show besides the plain method.
    pub variants: fn() -> Vec<Options>,
    /// Option sets worth trying for a relative error of a run (fraction).
    pub options_for_error: fn(f64) -> Vec<Options>,
    /// The energy that it conserves, from the facts of its set-up.
    pub conserved_energy: fn(&[Fact]) -> ConservedEnergy,
    labels: &'static [(&'static str, OptionLabel)],
    build: Build,
}

impl std::fmt::Debug for Entry {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Entry")
            .field("id", &self.id)
            .finish_non_exhaustive()
    }
}

impl Entry {
    fn of<M: Method>() -> Self {
        Self {
            id: M::ID,
            summary: M::SUMMARY,
            options: M::OPTIONS,
            substeps: M::SUBSTEPS,
            guard: M::GUARD,
            programs: M::PROGRAMS,
            factorises: M::FACTORISES,
            variants: M::variants,
            options_for_error: M::options_for_error,
            conserved_energy: M::conserved_energy,
            labels: M::LABELS,
            build: |options, machine| Ok(M::from_options(options)?.on_machine(machine)),
        }
    }

    /// Form of one of its options in the label of a run.
    #[must_use]
    pub fn option_label(&self, key: &str) -> OptionLabel {
        let own = self.labels.iter().find(|(labelled, _)| *labelled == key);
        match own {
            Some((_, label)) => *label,
            None if key == GuardOption::KEY => OptionLabel::Symbol("Q"),
            None => OptionLabel::default(),
        }
    }

    /// Every option it takes: its own, the guard's, `substeps` and those of machines.
    #[must_use]
    pub fn all_options(&self) -> Vec<OptionHelp> {
        let mut options = self.options.to_vec();
        options.extend(self.guard.help());
        if self.substeps {
            options.push(Substeps::HELP);
        }
        if self.programs {
            options.extend(MACHINE_OPTIONS);
        }
        options
    }

    /// Builds the integrator.
    ///
    /// # Errors
    /// [`OptionError`] for an option it does not take or a value that does not fit.
    pub fn build(&self, options: &Options) -> Result<Box<dyn Stepper>, OptionError> {
        let known: Vec<&'static str> = self.all_options().iter().map(|help| help.key).collect();
        options.only(self.id, &known)?;
        let mut options = options.clone();
        let machine = take_settings(&mut options, self.id)?;
        let substeps = Substeps::take_from(&mut options, self.id)?;
        let guard = self.guard.take_from(&mut options, self.id)?;
        let mut integrator = (self.build)(&options, machine)?;
        // Within the parts, so that each of them is guarded.
        if let Some(guard) = guard {
            integrator = Box::new(Guarded::new(integrator, guard));
        }
        if let Some(substeps) = substeps {
            integrator = Box::new(Substepped::new(integrator, substeps));
        }
        Ok(integrator)
    }
}

/// Options with the given largest number of threads, if any, otherwise with the options' own number, otherwise with the
/// best number. Methods without steps for machines have one thread: they accept one thread, and "auto", as a request,
/// and refuse more.
#[must_use]
pub fn with_threads(id: &str, options: &Options, threads: Option<&OptionValue>) -> Options {
    const KEY: &str = "threads";
    let mut options = options.clone();
    let has_threads = entry(id).is_none_or(|entry| entry.programs);
    let is_one = |threads: &OptionValue| match threads {
        OptionValue::Number(count) => *count == 1.0,
        OptionValue::Text(text) => text == "auto",
        _ => false,
    };
    match threads {
        Some(threads) if !has_threads && is_one(threads) => {}
        Some(threads) => options.insert(KEY, threads.clone()),
        None if options.get(KEY).is_none() && has_threads => {
            options.insert(KEY, OptionValue::Text("auto".to_owned()));
        }
        None => {}
    }
    options
}

/// Every integrator, explicit ones first.
#[must_use]
pub fn entries() -> Vec<Entry> {
    macro_rules! list {
        ($($(#[$attribute:meta])* $name:ident: $method:ty,)*) => {
            vec![$($(#[$attribute])* Entry::of::<$method>()),*]
        };
    }
    for_each_integrator!(list)
}

/// The integrator of this name.
#[must_use]
pub fn entry(id: &str) -> Option<Entry> {
    entries().into_iter().find(|entry| entry.id == id)
}

/// The names of all integrators.
#[must_use]
pub fn ids() -> Vec<&'static str> {
    entries().iter().map(|entry| entry.id).collect()
}

/// Builds an integrator by name.
///
/// # Errors
/// [`OptionError`] for an unknown name or option, or a value that does not fit.
pub fn build(id: &str, options: &Options) -> Result<Box<dyn Stepper>, OptionError> {
    match entry(id) {
        Some(entry) => entry.build(options),
        None => Err(OptionError::UnknownIntegrator {
            id: id.into(),
            known: ids(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(id: &str, options: Options) -> String {
        build(id, &options)
            .err()
            .map_or_else(String::new, |error| error.to_string())
    }

    #[test]
    fn names_are_unique_and_each_builds_what_it_names() {
        let ids = ids();
        for (index, id) in ids.iter().enumerate() {
            assert!(!ids[..index].contains(id), "{id} twice");
            assert_eq!(build(id, &Options::new()).unwrap().id(), *id);
        }
    }

    #[test]
    fn what_is_not_known_is_refused_by_name() {
        assert!(refusal("euler", Options::new()).starts_with("unknown integrator `euler`"));
        assert_eq!(
            refusal("rk4", Options::new().with_number("gamma", 4.0)),
            "`rk4` has no option `gamma`; it takes `saturation`, `substeps`, `machine`, `precision`, `threads`"
        );
        let cases = [
            ("cnn", "saturation", OptionValue::Number(-4.0)),
            ("cnn", "saturation", OptionValue::Number(f64::NAN)),
            ("cnn", "saturation", OptionValue::Text("of".into())),
            ("rk4", "substeps", OptionValue::Number(0.0)),
            ("rk4", "substeps", OptionValue::Number(1.5)),
            #[cfg(feature = "implicit")]
            ("newmark", "beta", OptionValue::Number(1.5)),
        ];
        for (id, key, value) in cases {
            let message = refusal(id, Options::new().with(key, value.clone()));
            assert!(message.starts_with(&format!("`{id}`: {key} = {value}: expected")));
        }
    }
}
