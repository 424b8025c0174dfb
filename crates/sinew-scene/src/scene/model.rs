//! `model` of `[[region]]`: the kind of material, and the keys of laws of large deformation.

use std::sync::{Mutex, PoisonError};

use sinew_fem::hyperelastic::{KnownLaw, LawParameter, Presence, Range, known_laws};
use toml::de::DeValue;

use crate::decode::value::{Misfit, finite, list, text};
use crate::decode::{
    Condition, Described, Key, KeyDescription, Kind, Optional, Parts, Shape, Stated, Table, Values,
};
use crate::error::{Fault, SceneError};

/// A kind of material.
#[derive(Clone, Copy, Debug)]
pub(super) enum MaterialModel {
    Springs,
    Linear,
    /// A law of large deformation.
    Hyperelastic(&'static KnownLaw),
}

impl MaterialModel {
    /// True if Young's modulus is a key of it.
    pub(super) fn has_youngs_modulus(self) -> bool {
        match self {
            Self::Springs | Self::Linear => true,
            Self::Hyperelastic(law) => has(law, &LawParameter::YOUNGS_MODULUS),
        }
    }
}

pub(super) const SPRINGS_MODEL: &str = "springs";
pub(super) const LINEAR_MODEL: &str = "linear";

pub(super) const MODEL: Key<ModelName> = Key::required(
    "model",
    "`\"linear\"`: an isotropic elastic solid at small strain and rotation. `\"springs\"`: springs along the edges of the mesh. \
     All others are solids at any strain and rotation, isotropic but those that have axes: ",
    ModelName,
);

/// The names of all models that are known when a scene is read.
#[derive(Clone, Copy, Debug)]
pub(super) struct ModelName;

impl ModelName {
    fn all() -> Vec<&'static str> {
        let laws = known_laws().into_iter().map(KnownLaw::id);
        [SPRINGS_MODEL, LINEAR_MODEL]
            .into_iter()
            .chain(laws)
            .collect()
    }
}

impl Kind for ModelName {
    fn expected(&self) -> String {
        alternatives(&Self::all())
    }

    fn shape(&self) -> Shape {
        Shape::Words(Self::all())
    }

    fn details(&self) -> String {
        let of = |law: &KnownLaw| format!("`\"{}\"` {}", law.id(), law.meaning());
        let laws: Vec<String> = known_laws().into_iter().map(of).collect();
        format!("{}.", laws.join("; "))
    }
}

impl Values for ModelName {
    type Read = MaterialModel;

    fn read(&self, value: &DeValue<'_>) -> Result<MaterialModel, Misfit> {
        let given = text(value)?;
        match given.as_str() {
            SPRINGS_MODEL => Ok(MaterialModel::Springs),
            LINEAR_MODEL => Ok(MaterialModel::Linear),
            id => {
                let law = known_laws().into_iter().find(|law| law.id() == id);
                law.map(MaterialModel::Hyperelastic).ok_or(Misfit::Value)
            }
        }
    }
}

/// Words in quotation marks, the last after "or".
pub(super) fn alternatives(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

fn has(law: &KnownLaw, parameter: &LawParameter) -> bool {
    law.parameters()
        .iter()
        .any(|own| own.name == parameter.name)
}

/// The models, grouped by the keys that are allowed with them, and the keys of laws.
#[derive(Debug)]
struct Models {
    laws: Vec<&'static str>,
    isochoric: Vec<&'static str>,
    with_axes: Vec<&'static str>,
    solids: Vec<&'static str>,
    by_modulus: Vec<&'static str>,
    by_ratio: Vec<&'static str>,
    always_by_ratio: Vec<&'static str>,
    keys: Vec<LawKey>,
    examples: Vec<&'static str>,
}

impl Models {
    /// The models that are known now. Each state of the registry is kept until the program ends: programs add laws
    /// once, at their beginning.
    fn known() -> &'static Self {
        static KNOWN: Mutex<Option<(usize, &'static Models)>> = Mutex::new(None);
        let laws = known_laws();
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        match *known {
            Some((count, models)) if count == laws.len() => models,
            _ => {
                let models: &'static Self = Box::leak(Box::new(Self::of(&laws)));
                *known = Some((laws.len(), models));
                models
            }
        }
    }

    fn of(known: &[&'static KnownLaw]) -> Self {
        let those = |first: &[&'static str], take: &dyn Fn(&KnownLaw) -> bool| {
            let laws = known.iter().filter(|law| take(law)).map(|law| law.id());
            first.iter().copied().chain(laws).collect::<Vec<_>>()
        };
        let requires = |law: &KnownLaw| {
            let mut own = law.parameters().iter();
            own.any(|own| {
                own.name == LawParameter::POISSONS_RATIO.name && own.presence == Presence::Required
            })
        };
        let mut keys: Vec<LawKey> = Vec::new();
        for law in known {
            for parameter in law.parameters().iter().filter(|own| !is_shared(own)) {
                match keys.iter_mut().find(|key| key.name == parameter.name) {
                    Some(key) => key.laws.push((law.id(), parameter)),
                    None => keys.push(LawKey {
                        name: parameter.name,
                        laws: vec![(law.id(), parameter)],
                        conditions: &[],
                    }),
                }
            }
        }
        for key in &mut keys {
            let ids: Vec<&'static str> = key.laws.iter().map(|(id, _)| *id).collect();
            let reason = format!("goes with model = {} only", alternatives(&ids));
            let condition = Condition::where_is(MODEL.name, ids.leak(), reason.leak());
            key.conditions = vec![condition].leak();
        }
        Self {
            laws: those(&[], &|_| true),
            isochoric: those(&[], &KnownLaw::has_isochoric_part),
            with_axes: those(&[], &KnownLaw::has_axes),
            solids: those(&[LINEAR_MODEL], &|_| true),
            by_modulus: those(&[SPRINGS_MODEL, LINEAR_MODEL], &|law| {
                has(law, &LawParameter::YOUNGS_MODULUS)
            }),
            by_ratio: those(&[LINEAR_MODEL], &|law| {
                has(law, &LawParameter::POISSONS_RATIO)
            }),
            always_by_ratio: those(&[LINEAR_MODEL], &requires),
            keys,
            examples: known.iter().flat_map(|law| examples(law)).collect(),
        }
    }
}

/// The laws of large deformation.
pub(super) fn laws() -> &'static [&'static str] {
    &Models::known().laws
}

/// The laws that have an isochoric part.
pub(super) fn isochoric() -> &'static [&'static str] {
    &Models::known().isochoric
}

/// The laws whose material has axes.
pub(super) fn with_axes() -> &'static [&'static str] {
    &Models::known().with_axes
}

/// The models that are solids.
pub(super) fn solids() -> &'static [&'static str] {
    &Models::known().solids
}

/// The models whose stiffness is stated by Young's modulus.
pub(super) fn by_modulus() -> &'static [&'static str] {
    &Models::known().by_modulus
}

/// The models for which Poisson's ratio may be given.
pub(super) fn by_ratio() -> &'static [&'static str] {
    &Models::known().by_ratio
}

/// The models for which Poisson's ratio must be given.
pub(super) fn always_by_ratio() -> &'static [&'static str] {
    &Models::known().always_by_ratio
}

/// True for a parameter whose key is that of other models too, [`super::region::YOUNGS_MODULUS`] and
/// [`super::region::POISSONS_RATIO`].
pub(super) fn is_shared(parameter: &LawParameter) -> bool {
    let shared = [LawParameter::YOUNGS_MODULUS, LawParameter::POISSONS_RATIO];
    shared.iter().any(|shared| shared.name == parameter.name)
}

/// Regions of a law with its own parameters, one for each of several parameters of which one is given.
fn examples(law: &'static KnownLaw) -> Vec<&'static str> {
    let parameters = law.parameters();
    if parameters.iter().all(is_shared) {
        return Vec::new();
    }
    let choices = parameters.iter().map(|parameter| match parameter.presence {
        Presence::OneOf(names) => names.len(),
        Presence::Required | Presence::Default(_) => 1,
    });
    let region = |choice: usize| {
        let given = parameters
            .iter()
            .filter(|parameter| match parameter.presence {
                Presence::OneOf(names) => {
                    names.get(choice).or(names.first()) == Some(&parameter.name)
                }
                Presence::Required | Presence::Default(_) => true,
            });
        let lines = given.map(|parameter| {
            let value = parameter.written(parameter.example);
            format!("{} = {value}\n", parameter.name)
        });
        let lines: String = lines.collect();
        let model = law.id();
        let axes = match law.has_axes() {
            true => "axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]\n",
            false => "",
        };
        let region = format!("[[region]]\ndensity = 1060.0\nmodel = \"{model}\"\n{lines}{axes}");
        &*region.leak()
    };
    (0..choices.max().unwrap_or(1)).map(region).collect()
}

/// The keys of laws, which replace this key.
#[derive(Clone, Copy, Debug)]
pub(super) struct LawKeys;

impl Described for LawKeys {
    fn name(&self) -> &'static str {
        "the parameters of laws"
    }

    fn conditions(&self) -> &'static [Condition] {
        &[]
    }

    fn describe(&self) -> KeyDescription {
        KeyDescription {
            name: self.name(),
            meaning: String::new(),
            unit: "",
            expected: String::new(),
            shape: Shape::Flag,
            otherwise: Stated::InWords("none"),
            conditions: &[],
        }
    }

    fn parts(&self) -> Option<Parts> {
        let models = Models::known();
        Some(Parts {
            keys: models.keys.iter().map(|key| key as _).collect(),
            examples: models.examples.clone(),
        })
    }
}

/// A key that is a parameter of some laws; its meaning may differ between them.
#[derive(Debug)]
struct LawKey {
    name: &'static str,
    /// The laws that have it, by their ids, each with its own description.
    laws: Vec<(&'static str, &'static LawParameter)>,
    conditions: &'static [Condition],
}

impl LawKey {
    /// Statements of laws about it, each once.
    fn said(&self, of: impl Fn(&LawParameter) -> String) -> Vec<String> {
        let mut all: Vec<String> = Vec::new();
        for (_, parameter) in &self.laws {
            let said = of(parameter);
            if !all.contains(&said) {
                all.push(said);
            }
        }
        all
    }
}

impl Described for LawKey {
    fn name(&self) -> &'static str {
        self.name
    }

    fn conditions(&self) -> &'static [Condition] {
        self.conditions
    }

    fn describe(&self) -> KeyDescription {
        let meanings = self.said(|parameter| parameter.meaning.to_owned());
        let meaning = match &meanings[..] {
            [one] => one.clone(),
            _ => {
                let of = |(id, own): &(&str, &LawParameter)| format!("`\"{id}\"`: {}", own.meaning);
                self.laws.iter().map(of).collect::<Vec<_>>().join(" ")
            }
        };
        let shape_of = |expected: &String| {
            let mut laws = self.laws.iter();
            let own = laws.find(|(_, own)| own.expected() == *expected);
            own.map(|(_, own)| Parameter(own).shape())
        };
        let expected = self.said(LawParameter::expected);
        let mut shapes: Vec<Shape> = expected.iter().filter_map(shape_of).collect();
        let shape = match shapes.len() {
            1 => shapes.remove(0),
            _ => Shape::Either(shapes),
        };
        let requiring = self.laws.iter();
        let requiring = requiring.filter(|(_, own)| own.presence == Presence::Required);
        let requiring: Vec<&'static str> = requiring.map(|(id, _)| *id).collect();
        let (_, first) = self.laws[0];
        let otherwise = match (requiring.len(), first.presence) {
            (count, _) if count == self.laws.len() => Stated::Required,
            (0, Presence::Default(default)) => Stated::Default(first.written(default)),
            (0, _) => Stated::InWords("one of several"),
            _ => Stated::RequiredWith(MODEL.name, requiring),
        };
        KeyDescription {
            name: self.name,
            meaning,
            unit: first.unit,
            expected: expected.join(", or "),
            shape,
            otherwise,
            conditions: self.conditions,
        }
    }
}

/// The values of a law's parameter.
#[derive(Clone, Copy, Debug)]
struct Parameter(&'static LawParameter);

impl Kind for Parameter {
    fn expected(&self) -> String {
        self.0.expected()
    }

    fn shape(&self) -> Shape {
        let of = |range: Range| Shape::Number(range.low, range.high);
        let list = |of: Shape, least, most| Shape::List {
            of: Box::new(of),
            least,
            most: Some(most),
        };
        let columns = self.0.columns;
        let entry = match columns {
            [] => of(self.0.range),
            [first, rest @ ..] => {
                let is_alike = rest.iter().all(|column| {
                    (column.range.low, column.range.high) == (first.range.low, first.range.high)
                });
                let numbers = match is_alike {
                    true => of(first.range),
                    false => Shape::Either(columns.iter().map(|column| of(column.range)).collect()),
                };
                list(numbers, columns.len(), columns.len())
            }
        };
        match self.0.list {
            None => entry,
            Some((least, most)) => list(entry, least, most),
        }
    }
}

impl Values for Parameter {
    type Read = Vec<f64>;

    fn read(&self, value: &DeValue<'_>) -> Result<Vec<f64>, Misfit> {
        let number = |value: &DeValue<'_>, range: Range| {
            let number = finite(value)?;
            match range.contains(number) {
                true => Ok(number),
                false => Err(Misfit::Value),
            }
        };
        let of_plain = |value: &DeValue<'_>| number(value, self.0.range);
        let Some((least, most)) = self.0.list else {
            return Ok(vec![of_plain(value)?]);
        };
        let entries = match self.0.columns {
            [] => list(value, |value| Ok(vec![of_plain(value)?]))?,
            columns => list(value, |value| {
                let numbers = list(value, finite)?;
                let fits = numbers.len() == columns.len()
                    && columns
                        .iter()
                        .zip(&numbers)
                        .all(|(column, number)| column.range.contains(*number));
                match fits {
                    true => Ok(numbers),
                    false => Err(Misfit::Value),
                }
            })?,
        };
        match (least..=most).contains(&entries.len()) {
            true => Ok(entries.concat()),
            false => Err(Misfit::Value),
        }
    }
}

/// The values of a law's parameter in a region; `None` if it may be left out and is.
pub(super) fn read(
    table: &Table<'_>,
    parameter: &'static LawParameter,
) -> Result<Option<Vec<f64>>, SceneError> {
    let key = Key::<Parameter, Optional>::optional(parameter.name, "", Parameter(parameter), "");
    let read = table.read(&key)?;
    require(table, parameter)?;
    Ok(read)
}

/// Refuses a region that leaves out a parameter which must be given, or gives none or several of those of which one
/// must.
pub(super) fn require(
    table: &Table<'_>,
    parameter: &'static LawParameter,
) -> Result<(), SceneError> {
    match parameter.presence {
        Presence::Required if !table.has(parameter.name) => {
            Err(table.missing(parameter.name, parameter.expected()))
        }
        Presence::OneOf(of) => {
            let found: Vec<&'static str> =
                of.iter().copied().filter(|key| table.has(key)).collect();
            match found[..] {
                [_] => Ok(()),
                [] => Err(table.place().fault(Fault::NotExactlyOne { of, found })),
                [_, second, ..] => {
                    let fault = Fault::NotExactlyOne { of, found };
                    Err(table.place().key_fault(second, fault))
                }
            }
        }
        Presence::Required | Presence::Default(_) => Ok(()),
    }
}
