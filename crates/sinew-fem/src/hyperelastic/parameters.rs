//! Parameters of laws: the description of each, and values as a user states them.

use std::collections::BTreeMap;
use std::ops::{Bound, RangeBounds};

use crate::tetra::lame;

/// Unit of moduli; a body that is `k` times as stiff has all of them multiplied by `k`.
const PASCAL: &str = "Pa";

/// The description of a parameter: a key of scenes, with the data for reading, checking and explaining it.
#[derive(Clone, Copy, Debug)]
pub struct LawParameter {
    /// Name, which is its key in scenes.
    pub name: &'static str,
    /// Symbol in one-line descriptions of materials.
    pub symbol: &'static str,
    /// Unit; empty for a plain number. Moduli are in "Pa", and scale with the stiffness of a body.
    pub unit: &'static str,
    /// Meaning in sentences, for the reference of scenes.
    pub meaning: &'static str,
    /// Range of its number, or of each number of its list.
    pub range: Range,
    /// The least and the largest length of a list; `None` for a single number.
    pub list: Option<(usize, usize)>,
    /// Numbers of each entry of a list of tuples, such as the pairs of an Ogden law; empty for plain numbers. The
    /// values of all entries follow one another, in `example` and in [`Parameters`] too.
    pub columns: &'static [Column],
    /// Rule for a parameter that is left out.
    pub presence: Presence,
    /// A typical value, with which tests and the reference make the law.
    pub example: &'static [f64],
}

/// A number of each entry of a list of tuples.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// Name in messages, with the unit: "mu in Pa".
    pub name: &'static str,
    /// True for a modulus, which scales with the stiffness of a body.
    pub is_modulus: bool,
    /// Range.
    pub range: Range,
}

/// A range of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// Description that follows "expected".
    pub expected: &'static str,
    /// Lower bound.
    pub low: Bound<f64>,
    /// Upper bound.
    pub high: Bound<f64>,
}

impl Range {
    /// All finite numbers.
    #[must_use]
    pub const fn finite(expected: &'static str) -> Self {
        Self::between(expected, Bound::Unbounded, Bound::Unbounded)
    }

    /// Finite numbers above 0.
    #[must_use]
    pub const fn above_zero(expected: &'static str) -> Self {
        Self::between(expected, Bound::Excluded(0.0), Bound::Unbounded)
    }

    /// Finite numbers between two bounds.
    #[must_use]
    pub const fn between(expected: &'static str, low: Bound<f64>, high: Bound<f64>) -> Self {
        Self {
            expected,
            low,
            high,
        }
    }

    /// True for a finite number within the bounds.
    #[must_use]
    pub fn contains(&self, number: f64) -> bool {
        number.is_finite() && (self.low, self.high).contains(&number)
    }
}

/// A rule for a parameter that is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    /// An error.
    Required,
    /// Exactly one of these parameters is given.
    OneOf(&'static [&'static str]),
    /// A number, or several as a list.
    Default(&'static [f64]),
}

impl LawParameter {
    /// Young's modulus at small strain (Pa).
    pub const YOUNGS_MODULUS: Self = Self::number(
        "youngs_modulus",
        "E",
        "Young's modulus: the stress for each unit of strain when a bar of the material is pulled.",
        Range::above_zero("a finite modulus above 0 Pa"),
        &[3500.0],
    )
    .unit(PASCAL);

    /// Poisson's ratio at small strain. Below 0 Lame's first constant is negative, and the volumetric energy has no
    /// minimum.
    pub const POISSONS_RATIO: Self = Self::number(
        "poissons_ratio",
        "nu",
        "Poisson's ratio: the strain across over the strain along when a bar of the material is pulled.",
        Range::between(
            "a number above -1 and below 0.5, from 0 on for laws of large deformation",
            Bound::Included(0.0),
            Bound::Excluded(0.5),
        ),
        &[0.45],
    );

    /// [`Self::YOUNGS_MODULUS`] and [`Self::POISSONS_RATIO`]: all parameters of most laws.
    pub const MODULI: &'static [Self] = &[Self::YOUNGS_MODULUS, Self::POISSONS_RATIO];

    /// [`Self::POISSONS_RATIO`] or [`Self::BULK_MODULUS`], for laws with their own shear constants
    /// ([`LawValues::lambda`]) or with Young's modulus ([`LawValues::lame_by_volume`]).
    pub const VOLUME: [Self; 2] = {
        const NAMES: &[&str] = &["poissons_ratio", "bulk_modulus"];
        [
            Self::POISSONS_RATIO.one_of(NAMES),
            Self::BULK_MODULUS.one_of(NAMES),
        ]
    };

    /// Bulk modulus at small strain (Pa).
    pub const BULK_MODULUS: Self = Self::number(
        "bulk_modulus",
        "kappa",
        "Bulk modulus: the pressure for each unit of relative loss of volume.",
        Range::above_zero("a finite modulus above 0 Pa"),
        &[35000.0],
    )
    .unit(PASCAL);

    /// A required parameter of one number without a unit.
    #[must_use]
    pub const fn number(
        name: &'static str,
        symbol: &'static str,
        meaning: &'static str,
        range: Range,
        example: &'static [f64],
    ) -> Self {
        Self {
            name,
            symbol,
            unit: "",
            meaning,
            range,
            list: None,
            columns: &[],
            presence: Presence::Required,
            example,
        }
    }

    /// The parameter with a unit.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// The parameter as a list of `least` to `most` numbers.
    #[must_use]
    pub const fn list(self, least: usize, most: usize) -> Self {
        Self {
            list: Some((least, most)),
            ..self
        }
    }

    /// The parameter as a list of `least` to `most` tuples of these numbers.
    #[must_use]
    pub const fn tuples(self, columns: &'static [Column], least: usize, most: usize) -> Self {
        Self {
            columns,
            ..self.list(least, most)
        }
    }

    /// The parameter with a default.
    #[must_use]
    pub const fn or(self, default: &'static [f64]) -> Self {
        Self {
            presence: Presence::Default(default),
            ..self
        }
    }

    /// The parameter as one of several, of which exactly one is given.
    #[must_use]
    pub const fn one_of(self, names: &'static [&'static str]) -> Self {
        Self {
            presence: Presence::OneOf(names),
            ..self
        }
    }

    /// True for a modulus, which scales with the stiffness; in a list of tuples some numbers may be moduli.
    #[must_use]
    pub fn is_modulus(&self) -> bool {
        self.unit == PASCAL || self.columns.iter().any(|column| column.is_modulus)
    }

    /// Numbers of an entry of its list.
    #[must_use]
    pub fn width(&self) -> usize {
        self.columns.len().max(1)
    }

    /// The range of the number at this place among its values.
    #[must_use]
    pub fn range_at(&self, place: usize) -> Range {
        let column = self.columns.get(place % self.width());
        column.map_or(self.range, |column| column.range)
    }

    /// Text of values: a number, a list, or a list of lists.
    #[must_use]
    pub fn written(&self, values: &[f64]) -> String {
        match (self.list, values) {
            (None, [value, ..]) => format!("{value:?}"),
            _ if self.columns.is_empty() => format!("{values:?}"),
            _ => format!("{:?}", values.chunks(self.width()).collect::<Vec<_>>()),
        }
    }

    fn scale(&self, values: &mut [f64], factor: f64) {
        for (place, value) in values.iter_mut().enumerate() {
            let column = self.columns.get(place % self.width());
            if column.is_none_or(|column| column.is_modulus) {
                *value *= factor;
            }
        }
    }

    /// Values that fit, as a description that follows "expected".
    #[must_use]
    pub fn expected(&self) -> String {
        if let (Some((least, most)), [_, ..]) = (self.list, self.columns) {
            let names: Vec<&str> = self.columns.iter().map(|column| column.name).collect();
            let ranges = self.columns.iter().map(|column| column.range.expected);
            let ranges: Vec<&str> = ranges.collect();
            let (names, ranges) = (names.join(", "), ranges.join(" and "));
            return format!("a list of {least} to {most} of [{names}], each of {ranges}");
        }
        match self.list {
            None => self.range.expected.to_owned(),
            Some((least, most)) if least == most => {
                format!("a list of {least}, each {}", self.range.expected)
            }
            Some((least, most)) => {
                format!("a list of {least} to {most}, each {}", self.range.expected)
            }
        }
    }

    /// Checks values.
    fn check(&self, values: &[f64]) -> Result<(), ParameterError> {
        let quantity = self.name;
        let (least, most) = self.list.unwrap_or((1, 1));
        let width = self.width();
        if !(least..=most).contains(&(values.len() / width)) || !values.len().is_multiple_of(width)
        {
            let (found, expected) = (values.len(), [least * width, most * width]);
            return Err(ParameterError::Length {
                quantity,
                found,
                expected,
            });
        }
        for (place, found) in values.iter().enumerate() {
            let range = self.range_at(place);
            if !range.contains(*found) {
                return Err(self.refused(*found, range.expected));
            }
        }
        Ok(())
    }

    /// The error for a value that does not fit the others; `expected` follows "expected".
    #[must_use]
    pub fn refused(&self, found: f64, expected: &'static str) -> ParameterError {
        ParameterError::Value {
            quantity: self.name,
            found,
            expected,
        }
    }
}

/// The parameters of a law as a user states them, by their names; moduli are those at small strain (Pa).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters {
    values: BTreeMap<&'static str, Vec<f64>>,
}

impl Parameters {
    /// Young's modulus (Pa) and Poisson's ratio at small strain: the parameters of most laws.
    #[must_use]
    pub fn new(youngs_modulus: f64, poissons_ratio: f64) -> Self {
        Self::default()
            .with(LawParameter::YOUNGS_MODULUS.name, &[youngs_modulus])
            .with(LawParameter::POISSONS_RATIO.name, &[poissons_ratio])
    }

    /// These parameters with another value: one number, or those of a list.
    #[must_use]
    pub fn with(mut self, name: &'static str, value: &[f64]) -> Self {
        self.set(name, value);
        self
    }

    /// Sets a value: one number, or those of a list.
    pub fn set(&mut self, name: &'static str, value: &[f64]) {
        self.values.insert(name, value.to_vec());
    }

    /// The numbers of a parameter; `None` if it is not given.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&[f64]> {
        self.values.get(name).map(Vec::as_slice)
    }

    /// The first number of a parameter; `None` if it is not given.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        self.get(name)?.first().copied()
    }

    /// Removes a parameter.
    pub fn remove(&mut self, name: &str) {
        self.values.remove(name);
    }

    /// Names and numbers of all that are given.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &[f64])> {
        let values = self.values.iter();
        values.map(|(name, value)| (*name, value.as_slice()))
    }

    /// Young's modulus (Pa) and Poisson's ratio as stated; `None` for one that is not.
    pub(crate) fn stated(&self) -> [Option<f64>; 2] {
        let names = [LawParameter::YOUNGS_MODULUS, LawParameter::POISSONS_RATIO];
        names.map(|parameter| self.number(parameter.name))
    }

    /// Multiplies the moduli among them; if `is_of_shear`, not the bulk modulus.
    pub(crate) fn scale(&mut self, described: &[LawParameter], factor: f64, is_of_shear: bool) {
        let kept = |name: &str| is_of_shear && name == LawParameter::BULK_MODULUS.name;
        for parameter in described.iter().filter(|parameter| parameter.is_modulus()) {
            let values = self.values.get_mut(parameter.name);
            if let Some(values) = values.filter(|_| !kept(parameter.name)) {
                parameter.scale(values, factor);
            }
        }
    }

    /// Parameters that state each quantity once, at its example value.
    pub(crate) fn examples(described: &[LawParameter]) -> Self {
        let mut parameters = Self::default();
        for parameter in described {
            let is_given = match parameter.presence {
                Presence::Required | Presence::Default(_) => true,
                Presence::OneOf(names) => names.first() == Some(&parameter.name),
            };
            if is_given {
                parameters.set(parameter.name, parameter.example);
            }
        }
        parameters
    }

    /// The values of the law with this id and these parameters, defaults included.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a parameter that is missing, outside its range or another law's.
    pub fn checked(
        &self,
        law: &'static str,
        described: &'static [LawParameter],
    ) -> Result<LawValues<'_>, ParameterError> {
        for quantity in self.values.keys().copied() {
            if described.iter().all(|known| known.name != quantity) {
                return Err(ParameterError::Foreign { law, quantity });
            }
        }
        for parameter in described {
            let quantity = parameter.name;
            match (self.get(quantity), parameter.presence) {
                (Some(values), _) => parameter.check(values)?,
                (None, Presence::Required) => {
                    return Err(ParameterError::Missing { law, quantity });
                }
                (None, Presence::Default(_) | Presence::OneOf(_)) => {}
            }
            if let Presence::OneOf(of) = parameter.presence
                && of.iter().filter(|name| self.get(name).is_some()).count() != 1
            {
                return Err(ParameterError::NotOneOf { law, of });
            }
        }
        Ok(LawValues {
            given: self,
            described,
        })
    }
}

/// The values of a law's parameters, checked against their descriptions.
#[derive(Clone, Copy, Debug)]
pub struct LawValues<'a> {
    given: &'a Parameters,
    described: &'static [LawParameter],
}

impl<'a> LawValues<'a> {
    /// The numbers of a parameter, its default if it is left out; none for one of several that is left out.
    #[must_use]
    pub fn numbers(&self, parameter: &LawParameter) -> &'a [f64] {
        let default = || {
            let mut described = self.described.iter();
            let own = described.find(|known| known.name == parameter.name)?;
            match own.presence {
                Presence::Default(default) => Some(default),
                Presence::Required | Presence::OneOf(_) => None,
            }
        };
        let given = self.given.get(parameter.name);
        given.or_else(default).unwrap_or_default()
    }

    /// The number of a parameter; `None` for one of several that is left out.
    #[must_use]
    pub fn given(&self, parameter: &LawParameter) -> Option<f64> {
        self.numbers(parameter).first().copied()
    }

    /// The number of a parameter that is required or has a default.
    #[must_use]
    pub fn number(&self, parameter: &LawParameter) -> f64 {
        self.given(parameter).unwrap_or(f64::NAN)
    }

    /// Lame's constants (lambda, mu) (Pa) of [`LawParameter::YOUNGS_MODULUS`] and [`LawParameter::POISSONS_RATIO`].
    #[must_use]
    pub fn lame(&self) -> (f64, f64) {
        let modulus = self.number(&LawParameter::YOUNGS_MODULUS);
        lame(modulus, self.number(&LawParameter::POISSONS_RATIO))
    }

    /// Lame's constants (lambda, mu) (Pa) of [`LawParameter::YOUNGS_MODULUS`] and one of [`LawParameter::VOLUME`].
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a bulk modulus below 1/3 of Young's modulus, with which Poisson's ratio would be below 0.
    pub fn lame_by_volume(&self) -> Result<(f64, f64), ParameterError> {
        let Some(bulk) = self.given(&LawParameter::BULK_MODULUS) else {
            return Ok(self.lame());
        };
        let modulus = self.number(&LawParameter::YOUNGS_MODULUS);
        let triple = 3.0 * bulk;
        let expected = "at least 1/3 of Young's modulus: Poisson's ratio is 0 or above for laws of large deformation";
        if triple < modulus {
            return Err(LawParameter::BULK_MODULUS.refused(bulk, expected));
        }
        let over = 1.0 / (9.0 * bulk - modulus);
        let mu = triple * modulus * over;
        Ok((triple * (triple - modulus) * over, mu))
    }

    /// Lame's first constant (Pa) for a shear modulus (Pa), from [`LawParameter::POISSONS_RATIO`] or
    /// [`LawParameter::BULK_MODULUS`], whichever is given.
    ///
    /// # Errors
    ///
    /// [`ParameterError`] for a bulk modulus below 2/3 of the shear modulus, with which Poisson's ratio would be below
    /// 0.
    pub fn lambda(&self, mu: f64) -> Result<f64, ParameterError> {
        if let Some(bulk) = self.given(&LawParameter::BULK_MODULUS) {
            let lambda = bulk - 2.0 / 3.0 * mu;
            let expected = "at least 2/3 of the shear modulus: Poisson's ratio is 0 or above for laws of large deformation";
            return match lambda >= 0.0 {
                true => Ok(lambda),
                false => Err(LawParameter::BULK_MODULUS.refused(bulk, expected)),
            };
        }
        let nu = self.number(&LawParameter::POISSONS_RATIO);
        Ok(2.0 * mu * nu / (1.0 - 2.0 * nu))
    }
}

/// A number of numbers, or the least and the largest.
fn count([least, most]: [usize; 2]) -> String {
    match least == most {
        true => least.to_string(),
        false => format!("{least} to {most}"),
    }
}

/// A parameter that a law does not allow.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// A number outside its range.
    #[error("{quantity} = {found}: expected {expected}")]
    Value {
        /// The parameter.
        quantity: &'static str,
        /// Its value.
        found: f64,
        /// The range.
        expected: &'static str,
    },
    /// A list that is too short or too long.
    #[error("{quantity} has {found} numbers: expected {}", count(*expected))]
    Length {
        /// The parameter.
        quantity: &'static str,
        /// The length of the list.
        found: usize,
        /// The least and the largest.
        expected: [usize; 2],
    },
    /// A parameter that is needed and was not given.
    #[error("the law `{law}` needs {quantity}")]
    Missing {
        /// The law's id.
        law: &'static str,
        /// The parameter.
        quantity: &'static str,
    },
    /// None or several of parameters of which exactly one is given.
    #[error("the law `{law}` needs exactly one of {}", of.join(", "))]
    NotOneOf {
        /// The law's id.
        law: &'static str,
        /// The parameters.
        of: &'static [&'static str],
    },
    /// A parameter of another law.
    #[error("the law `{law}` has no {quantity}")]
    Foreign {
        /// The law's id.
        law: &'static str,
        /// The parameter.
        quantity: &'static str,
    },
    /// A law that is not made from parameters.
    #[error("the law `{law}` is not made from parameters")]
    NotStated {
        /// The law's id.
        law: &'static str,
    },
}

/// Young's modulus (Pa) and Poisson's ratio of Lame's constants (Pa).
pub(crate) fn engineering((lambda, mu): (f64, f64)) -> [f64; 2] {
    let sum = lambda + mu;
    [mu * (3.0 * lambda + 2.0 * mu) / sum, 0.5 * lambda / sum]
}

/// Refuses a number that is not finite or does not fit.
pub(super) fn within(
    quantity: &'static str,
    found: f64,
    expected: &'static str,
    fits: bool,
) -> Result<(), ParameterError> {
    if found.is_finite() && fits {
        return Ok(());
    }
    Err(ParameterError::Value {
        quantity,
        found,
        expected,
    })
}
