//! Properties of tissue that an isotropic law does not have, in `[[region]]`.

use std::ops::Bound;

use sinew_fem::are_parallel;
use sinew_fem::hyperelastic::KnownLaw;
use sinew_fem::hyperelastic::fibres::{Fibres, Stiffening};
use sinew_fem::hyperelastic::prony::Term;
use sinew_fem::{Direction, FibreFamily, Memory, Moduli, Tissue, ViscousPart};

use toml::de::DeValue;

use super::from_mesh::{self, Given, OrData};
use super::model::{MODEL, alternatives, isochoric, laws, with_axes};
use crate::decode::value::{Misfit, list};
use crate::decode::{
    Condition, Flag, Inner, Key, Kind, Needs, Number, Optional, Or, Pairs, Shape, Table,
    TableDescription, Values, Vector, Words,
};
use crate::error::{Fault, SceneError};

pub(super) const FIBRES_OF_REGION: Key<Inner, Optional> = Key::optional(
    "fibres",
    "Fibres that stiffen the tissue where they are stretched: a family, or a list of up to four. Young's modulus and Poisson's ratio are then those \
     of the tissue without them, as it is across a family.",
    Inner::one_or_list(
        "a table such as { direction = [0.0, 0.0, 1.0], eta = 2000.0 }, or a list of up to four",
        &FIBRES,
    ),
    "the same in all directions",
)
.only(&[of_large_deformation(
    "goes with laws of large deformation only, such as model = \"neo-hookean\"",
)]);

/// Condition that the model is a law of large deformation.
const fn of_large_deformation(reason: &'static str) -> Condition {
    Condition::among(MODEL.name, laws, reason)
}

pub(super) const AXES: Key<TwoDirections> = Key::required(
    "axes",
    "The first two axes of the material at rest: two directions, whose lengths do not matter. The second is made perpendicular to the first, and the \
     third is their cross product. Data have three numbers for each tetrahedron, as the direction of fibres.",
    TwoDirections,
)
.only(&[Condition::among(
    MODEL.name,
    with_axes,
    "goes with laws that have axes only; this one is alike in all directions",
)]);

/// Two directions, each the same for all tetrahedra of a region or the name of data.
#[derive(Debug, Clone, Copy)]
pub(super) struct TwoDirections;

impl Kind for TwoDirections {
    fn expected(&self) -> String {
        "two directions that are not parallel, [[x, y, z], [x, y, z]], or [{ data = \"name\" }, { data = \"name\" }]".to_owned()
    }

    fn shape(&self) -> Shape {
        Shape::List {
            of: Box::new(DIRECTION.values.shape()),
            least: 2,
            most: Some(2),
        }
    }
}

impl Values for TwoDirections {
    /// `None` for two tables.
    type Read = Option<[[f64; 3]; 2]>;

    fn read(&self, value: &DeValue<'_>) -> Result<Self::Read, Misfit> {
        let DeValue::Array(items) = value else {
            return Err(Misfit::Type);
        };
        if items.len() == 2
            && items
                .iter()
                .all(|item| matches!(item.get_ref(), DeValue::Table(_)))
        {
            return Ok(None);
        }
        let vectors = list(value, |item| DIRECTION.values.0.read(item))?;
        let [first, second] = vectors[..] else {
            return Err(Misfit::Value);
        };
        match are_parallel(first, second) {
            true => Err(Misfit::Value),
            false => Ok(Some([first, second])),
        }
    }
}

fn axes(region: &Table<'_>) -> Result<[Direction; 2], SceneError> {
    if let Some(vectors) = region.read(&AXES)? {
        return Ok(vectors.map(Direction::Everywhere));
    }
    let names = from_mesh::names(region, AXES.name)?;
    let names: Result<[String; 2], _> = names.try_into();
    let names = names.map_err(|_| region.value_misfit(AXES.name, &AXES.values.expected()))?;
    Ok(names.map(Direction::Data))
}

const FIBRES: TableDescription = TableDescription {
    name: "fibres",
    meaning: "A family of fibres. They pull and never push: where they are shorter than at rest, the tissue is as without them. With F the deformation \
              gradient and a0 the direction at rest, I4 = |F a0|^2 is the square of their stretch.",
    keys: &[&DIRECTION, &ETA, &K1, &K2, &DISPERSION, &SPLIT],
    needs: Needs::OneOf(&[ETA.name, K1.name]),
    examples: &[
        "{ direction = [0.0, 0.0, 1.0], eta = 2000.0 }",
        "{ direction = [1.0, 1.0, 0.0], k1 = 1000.0, k2 = 2.0, dispersion = 0.1 }",
        "{ direction = [1.0, 0.0, 0.0], eta = 2000.0, split = true }",
        "{ direction = { data = \"along\" }, eta = 2000.0 }",
        "{ direction = [1.0, 1.0, 0.0], k1 = 1000.0, k2 = 2.0, split = true }",
    ],
};

const DIRECTION: Key<OrData<Vector>> = Key::required(
    "direction",
    "The direction of the fibres at rest; its length does not matter. Data have three numbers for each tetrahedron, in the axes of the mesh \
     file: they turn with the mesh.",
    OrData(Vector {
        fits: |direction| *direction != [0.0; 3],
        ..Vector::finite("a vector [x, y, z], all finite, that is not 0")
    }),
);

const ETA: Key<Number, Optional> = Key::optional(
    "eta",
    "Modulus of fibres that store eta/2 (I4 - 1)^2: stretched a little they add four times as much to the stiffness along them.",
    Number::above_zero("a finite modulus above 0 Pa"),
    "k1 and k2",
)
.unit("Pa");

const K1: Key<Number, Optional> = Key::optional(
    "k1",
    "Modulus of fibres that store k1/(2 k2) (exp(k2 X^2) - 1), with X = d (I1 - 3) + (1 - 3 d) (I4 - 1) and d the dispersion \
     (Gasser, Ogden and Holzapfel 2006): the more they are stretched the stiffer they are.",
    Number::above_zero("a finite modulus above 0 Pa"),
    "eta",
)
.unit("Pa");

const K2: Key<Number> = Key::required(
    "k2",
    "How soon the fibres stiffen.",
    Number::above_zero("a finite number above 0"),
)
.only(&[Condition::with(K1.name, "goes with `k1` only")]);

const DISPERSION: Key<Number, Or<f64>> = Key::or(
    "dispersion",
    "How far single fibres stray from the direction: 0 where all are parallel, 1/3 where all directions are as frequent.",
    Number::between(
        "a number from 0 to 1/3",
        Bound::Included(0.0),
        Bound::Included(1.0 / 3.0),
    ),
    0.0,
)
.only(&[Condition::with(K1.name, "goes with `k1` only")]);

const SPLIT: Key<Flag, Or<bool>> = Key::or(
    "split",
    "Whether the fibres feel J^(-2/3) I4, J being the ratio of volumes, and not I4 itself, and J^(-2/3) I1 likewise. Then a body that grows alike in all directions \
     does not stretch them; for comparison with programs that do so.",
    Flag,
    false,
);

pub(super) const PRONY: Key<Pairs, Optional> = Key::optional(
    "prony",
    "Shares g of the stress that relax, each with the time tau in which it falls to 1/e: a stress that is held falls as \
     1 - sum g (1 - exp(-t/tau)). What is left, 1 - sum g, stays.",
    Pairs {
        expected: "a list of 1 to 8 pairs [share, time in s], all above 0, with shares that together are below 1",
        of: Number::above_zero("a finite number above 0"),
        fits: |pairs| {
            let sum: f64 = pairs.iter().map(|[share, _]| share).sum();
            (1..=Memory::MOST_TERMS).contains(&pairs.len()) && sum < 1.0
        },
    },
    "no stress relaxes",
)
.only(&[of_large_deformation(
    "goes with laws of large deformation only, such as model = \"neo-hookean\"",
)]);

pub(super) const VISCOUS_PART: Key<Words<ViscousPart>, Or<ViscousPart>> = Key::or(
    "viscous_part",
    "The stress that relaxes. `\"all\"`: all of it, that of fibres too. `\"deviatoric\"`: that of the isochoric part of the law alone; pressure and \
     fibres stay elastic.",
    Words(&[
        ("all", ViscousPart::All),
        (DEVIATORIC, ViscousPart::Deviatoric),
    ]),
    ViscousPart::All,
)
.only(&[Condition::with(PRONY.name, "goes with `prony` only")]);

const DEVIATORIC: &str = "deviatoric";

pub(super) const MODULI: Key<Words<Moduli>, Or<Moduli>> = Key::or(
    "moduli",
    "What the moduli of the region are, those of fibres that relax included. `\"instantaneous\"`: those of a deformation that takes no time. \
     `\"longterm\"`: those of one that is held until all has relaxed.",
    Words(&[
        ("instantaneous", Moduli::Instantaneous),
        ("longterm", Moduli::LongTerm),
    ]),
    Moduli::Instantaneous,
)
.only(&[Condition::with(PRONY.name, "goes with `prony` only")]);

/// Reads the tissue in the table of a region with this law of large deformation.
pub(super) fn read(region: &Table<'_>, law: &KnownLaw) -> Result<Tissue, SceneError> {
    let tables = region.table_or_list(&FIBRES_OF_REGION)?;
    if region.has(FIBRES_OF_REGION.name) && !(1..=Tissue::MOST_FAMILIES).contains(&tables.len()) {
        let expected = "one to four families";
        return Err(region.value_misfit(FIBRES_OF_REGION.name, expected));
    }
    Ok(Tissue {
        fibres: tables.iter().map(fibre_family).collect::<Result<_, _>>()?,
        axes: law.has_axes().then(|| axes(region)).transpose()?,
        memory: memory(region, law)?,
    })
}

fn memory(region: &Table<'_>, law: &KnownLaw) -> Result<Option<Memory>, SceneError> {
    let Some(pairs) = region.read(&PRONY)? else {
        return Ok(None);
    };
    let part = region.read(&VISCOUS_PART)?;
    if part == ViscousPart::Deviatoric && !law.has_isochoric_part() {
        let fault = Fault::Misplaced {
            key: VISCOUS_PART.name,
            reason: format!(
                "= \"{DEVIATORIC}\" goes with model = {} only, which have a part that keeps the volume",
                alternatives(isochoric())
            ),
        };
        return Err(region.place().value_fault(VISCOUS_PART.name, fault));
    }
    let term = |[share, time]: [f64; 2]| Term { share, time };
    Ok(Some(Memory {
        terms: pairs.into_iter().map(term).collect(),
        part,
        moduli: region.read(&MODULI)?,
    }))
}

fn fibre_family(table: &Table<'_>) -> Result<FibreFamily, SceneError> {
    table.check_conditions()?;
    let direction = match from_mesh::read(table, &DIRECTION)? {
        Given::Everywhere(vector) => Direction::Everywhere(vector),
        Given::Data(name) => Direction::Data(name),
    };
    let key = table.exactly_one()?;
    let stiffening = match table.read(&ETA)? {
        Some(eta) => Stiffening::Quadratic { eta },
        None => Stiffening::Exponential {
            k1: table.read(&K1)?.unwrap_or_default(),
            k2: table.read(&K2)?,
            dispersion: table.read(&DISPERSION)?,
        },
    };
    let fibres = Fibres::new(stiffening);
    let fibres = fibres.map_err(|error| table.place().value_fault(key, error.into()))?;
    let is_split = table.read(&SPLIT)?;
    Ok(FibreFamily {
        fibres: if is_split { fibres.split() } else { fibres },
        direction,
    })
}
