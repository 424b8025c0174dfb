//! The description of a key, used to read, check and explain it.

use super::condition::Condition;
use super::description::{Described, KeyDescription, Stated};
use super::presence::{Optional, Or, Required, Usual};
use super::values::{Kind, Written};

/// A key: its name, its meaning, the values `V` that fit, and the rule `P` for its absence.
///
/// Tables are read by these constants, and the reference and the schema of scenes are written from them, so that both
/// agree with the reader.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Key<V, P = Required> {
    pub(crate) name: &'static str,
    pub(crate) values: V,
    pub(super) presence: P,
    meaning: &'static str,
    unit: &'static str,
    conditions: &'static [Condition],
}

impl<V: Copy> Key<V, Required> {
    /// A key that must be given.
    pub(crate) const fn required(name: &'static str, meaning: &'static str, values: V) -> Self {
        Self::new(name, meaning, values, Required)
    }
}

impl<V: Copy> Key<V, Optional> {
    /// A key that may be left out; `otherwise` describes the behaviour in this case.
    pub(crate) const fn optional(
        name: &'static str,
        meaning: &'static str,
        values: V,
        otherwise: &'static str,
    ) -> Self {
        Self::new(name, meaning, values, Optional(otherwise))
    }
}

impl<V: Copy> Key<V, Optional> {
    /// The key with a description of its absence.
    pub(crate) const fn otherwise(self, otherwise: &'static str) -> Self {
        let presence = Optional(otherwise);
        Self { presence, ..self }
    }
}

impl<V: Written> Key<V, Or<V::Read>>
where
    V::Read: Copy,
{
    /// A key with a default.
    pub(crate) const fn or(
        name: &'static str,
        meaning: &'static str,
        values: V,
        default: V::Read,
    ) -> Self {
        Self::new(name, meaning, values, Or(default))
    }
}

impl<V: Copy> Key<V, Usual> {
    /// A key of a table whose reader has a default, here in TOML.
    pub(crate) const fn usual(
        name: &'static str,
        meaning: &'static str,
        values: V,
        default: &'static str,
    ) -> Self {
        Self::new(name, meaning, values, Usual(default))
    }
}

impl<V: Copy, P: Copy> Key<V, P> {
    const fn new(name: &'static str, meaning: &'static str, values: V, presence: P) -> Self {
        Self {
            name,
            values,
            presence,
            meaning,
            unit: "",
            conditions: &[],
        }
    }

    /// The key with a unit.
    pub(crate) const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The key under these conditions.
    pub(crate) const fn only(self, conditions: &'static [Condition]) -> Self {
        Self { conditions, ..self }
    }
}

impl<V: Kind, P> Key<V, P> {
    fn describe_with(&self, otherwise: Stated) -> KeyDescription {
        KeyDescription {
            name: self.name,
            meaning: format!("{}{}", self.meaning, self.values.details()),
            unit: self.unit,
            expected: self.values.expected(),
            shape: self.values.shape(),
            otherwise: self.conditions.iter().fold(otherwise, narrowed),
            conditions: self.conditions,
        }
    }
}

/// The rule for a key that is left out, narrowed by one of its conditions.
fn narrowed(otherwise: Stated, condition: &Condition) -> Stated {
    match (otherwise, condition.required) {
        (Stated::Required, Some((key, words))) => Stated::RequiredWith(key, words().to_vec()),
        (otherwise, _) => otherwise,
    }
}

/// Describes a key whose value is a `V`, by the rule for its absence.
macro_rules! described {
    ([$($generics:tt)*] $presence:ty, $key:ident => $stated:expr) => {
        impl<$($generics)*> Described for Key<V, $presence> {
            fn name(&self) -> &'static str {
                self.name
            }

            fn conditions(&self) -> &'static [Condition] {
                self.conditions
            }

            fn describe(&self) -> KeyDescription {
                let $key = self;
                self.describe_with($stated)
            }
        }
    };
}

described!([V: Kind] Required, _key => Stated::Required);
described!([V: Kind] Optional, key => Stated::InWords(key.presence.0));
described!([V: Kind] Usual, key => Stated::Default(key.presence.0.to_owned()));
described!([V: Written<Read = T>, T: Sync] Or<T>, key => Stated::Default(key.values.written(&key.presence.0)));
