//! Options of integrators that can be set while they run.

use std::collections::BTreeMap;
use std::ops::Bound;

use sinew_core::{OptionValue, Options};
use sinew_integrators::{Entry, MACHINE_OPTIONS, OptionDefault, OptionHelp, OptionKind};

use crate::protocol::{NumberFacts, OptionFacts};

/// Largest count that a user is offered: larger ones do not help any method.
const LARGEST_COUNT: u32 = 64;

/// Limits of the offered values for a number above 0 without limits, such as a speed (m/s).
const ABOVE_ZERO: [f64; 2] = [1e-3, 1e2];

/// Smallest part of 1 that a user is offered.
const SMALLEST_PART: f64 = 1e-8;

/// The options of an integrator that have a value by default, with their current values. Options of machines do not
/// change the motion and are left out.
pub(super) fn facts(id: &str, options: &Options) -> Vec<OptionFacts> {
    let Some(entry) = sinew_integrators::entry(id) else {
        return Vec::new();
    };
    let facts = known(&entry).into_iter().filter_map(|help| {
        let OptionDefault::Value(default) = help.default else {
            return None;
        };
        let mut choices = Choices::default();
        choices.add(&help.kind);
        let (word, number) = match options.get(help.key) {
            Some(value) => parts_of(value),
            None => parts_of_text(default, &choices.words),
        };
        Some(OptionFacts {
            key: help.key,
            help: help.help,
            words: choices.words,
            number: choices.number,
            has_both: matches!(help.kind, OptionKind::Table(_)),
            word,
            value: number,
        })
    });
    facts.collect()
}

/// The value of an option from a word, a number, or both.
pub(super) fn value_of(
    (id, options): (&str, &Options),
    key: &str,
    word: Option<String>,
    number: Option<f64>,
) -> Result<OptionValue, String> {
    let entry = sinew_integrators::entry(id);
    let help = entry.and_then(|entry| known(&entry).into_iter().find(|help| help.key == key));
    let help = help.ok_or_else(|| format!("`{id}` has no option `{key}` that can be set here"))?;
    let value = match (&help.kind, word, number) {
        (OptionKind::Table(keys), Some(word), number) => {
            let mut table = BTreeMap::new();
            let mut keys = keys.iter().map(|(key, _)| (*key).to_owned());
            table.extend(keys.next().map(|first| (first, OptionValue::Text(word))));
            let alone = OptionValue::Table(table.clone());
            let second = keys.next().zip(number.map(OptionValue::Number));
            table.extend(second);
            let both = OptionValue::Table(table);
            // Some words need no number, and then take none.
            let fits = |value: &OptionValue| {
                let options = options.clone().with(key, value.clone());
                sinew_integrators::build(id, &options).is_ok()
            };
            if fits(&both) { both } else { alone }
        }
        (_, Some(word), _) => OptionValue::Text(word),
        (_, None, Some(number)) => OptionValue::Number(number),
        (_, None, None) => return Err(format!("{key}: expected {}", help.expected)),
    };
    Ok(value)
}

/// Alternative options for a method that does not support tools with the given ones: each word of each option.
pub(super) fn alternatives(entry: &Entry, options: &Options) -> Vec<Options> {
    let known = entry.options.iter();
    let with_words = known.flat_map(|help| match help.kind {
        OptionKind::Words(words) => words
            .iter()
            .map(|word| options.clone().with_text(help.key, *word))
            .collect(),
        _ => Vec::new(),
    });
    with_words.collect()
}

fn known(entry: &Entry) -> Vec<OptionHelp> {
    let mut options = entry.all_options();
    options.retain(|help| MACHINE_OPTIONS.iter().all(|other| other.key != help.key));
    options
}

/// Values that can be chosen.
#[derive(Default)]
struct Choices {
    words: Vec<&'static str>,
    number: Option<NumberFacts>,
}

impl Choices {
    fn add(&mut self, kind: &OptionKind) {
        let number = |low, high, is_whole, is_logarithmic| NumberFacts {
            low,
            high,
            is_whole,
            is_logarithmic,
        };
        match kind {
            OptionKind::Words(words) => self.words.extend(*words),
            OptionKind::Count(most) => {
                let most = f64::from((*most).min(LARGEST_COUNT));
                self.number = Some(number(1.0, most, true, true));
            }
            OptionKind::Number(low, high) => {
                let ends = (end(low), end(high));
                self.number = Some(match (*low, ends) {
                    // Parts of 1 are tolerances, of any size.
                    (Bound::Excluded(_), (Some(0.0), Some(high))) => {
                        number(SMALLEST_PART, 0.1 * high, false, true)
                    }
                    (_, (Some(low), Some(high))) => number(low, high, false, false),
                    _ => number(ABOVE_ZERO[0], ABOVE_ZERO[1], false, true),
                });
            }
            OptionKind::Either(kinds) => kinds.iter().for_each(|kind| self.add(kind)),
            OptionKind::Table(keys) => keys.iter().for_each(|(_, kind)| self.add(kind)),
        }
    }
}

fn end(bound: &Bound<f64>) -> Option<f64> {
    match bound {
        Bound::Included(end) | Bound::Excluded(end) => Some(*end),
        Bound::Unbounded => None,
    }
}

fn parts_of(value: &OptionValue) -> (Option<String>, Option<f64>) {
    let word = |value: &OptionValue| value.word().map(str::to_owned);
    match value {
        OptionValue::Table(table) => (
            table.values().find_map(word),
            table.values().find_map(OptionValue::number),
        ),
        other => (word(other), other.number()),
    }
}

/// The parts of a value in the form of scenes.
fn parts_of_text(text: &str, words: &[&'static str]) -> (Option<String>, Option<f64>) {
    let is_in = |word: &&&str| text.contains(&format!("\"{word}\""));
    let word = words.iter().find(is_in).map(|word| (*word).to_owned());
    (word, text.parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fact(id: &str, options: &Options, key: &str) -> OptionFacts {
        let mut all = facts(id, options).into_iter();
        all.find(|fact| fact.key == key).unwrap()
    }

    #[test]
    fn every_option_that_is_offered_takes_its_own_ends_and_words() {
        for id in sinew_integrators::ids() {
            let plain = Options::new();
            for fact in facts(id, &plain) {
                assert!(
                    fact.word.is_some() || fact.value.is_some(),
                    "{id} {}",
                    fact.key
                );
                let numbers = fact
                    .number
                    .iter()
                    .flat_map(|number| [number.low, number.high]);
                let numbers: Vec<Option<f64>> = match fact.has_both {
                    true => Vec::new(),
                    false => numbers.map(Some).collect(),
                };
                let words = fact
                    .words
                    .iter()
                    .map(|word| (Some((*word).to_owned()), Some(4.0)));
                let numbers = numbers.into_iter().map(|number| (None, number));
                for (word, number) in words.chain(numbers) {
                    let given = (word.clone(), number);
                    let value = value_of((id, &plain), fact.key, word, number).unwrap();
                    let options = plain.clone().with(fact.key, value);
                    let built = sinew_integrators::build(id, &options);
                    assert!(
                        built.is_ok(),
                        "{id} {} {given:?}: {:?}",
                        fact.key,
                        built.err()
                    );
                }
            }
        }
    }

    #[test]
    fn values_are_those_that_hold() {
        let plain = Options::new();
        assert_eq!(fact("cnn", &plain, "saturation").value, Some(4.0));
        assert_eq!(fact("cnn-energy", &plain, "sweeps").value, Some(4.0));
        let inner = fact("cnn-stabilised", &plain, "inner");
        assert_eq!((inner.word.as_deref(), inner.value), (Some("block"), None));
        let word = Some("chebyshev".to_owned());
        let value = value_of(("cnn-stabilised", &plain), "inner", word, Some(6.0)).unwrap();
        let options = plain.with("inner", value);
        let inner = fact("cnn-stabilised", &options, "inner");
        assert_eq!(
            (inner.word.as_deref(), inner.value),
            (Some("chebyshev"), Some(6.0))
        );
    }

    #[test]
    fn what_changes_no_motion_is_not_offered() {
        let keys: Vec<&str> = facts("cnn-stabilised", &Options::new())
            .iter()
            .map(|fact| fact.key)
            .collect();
        assert!(!keys.contains(&"threads"), "{keys:?}");
        assert!(value_of(("cnn", &Options::new()), "threads", None, Some(2.0)).is_err());
    }
}
