//! `[[region]]`: materials and their regions.

use std::ops::Bound;

use sinew_fem::hyperelastic::{KnownLaw, LawParameter, ParameterError, Parameters};
use sinew_fem::{Element, FromMesh, Law, Region, SpringRule, Tissue};

use super::from_mesh::{self, OrData};
use super::group_name::GroupName;
use super::model::{self, LawKeys, MODEL, MaterialModel, SPRINGS_MODEL};
use super::selected::{Members, NOT_WHERE, OPTIONAL_GROUP, Selections, WHERE_OF_TETRAHEDRA};
use super::tissue::{self, AXES, FIBRES_OF_REGION, MODULI, PRONY, VISCOUS_PART};
use crate::decode::{
    Condition, Count, Flag, Inner, Key, Needs, Number, Optional, Or, Place, Table,
    TableDescription, Words,
};
use crate::error::{Fault, SceneError};

pub(super) const REGION: TableDescription = TableDescription {
    name: "region",
    meaning: "A part of the body and the material that it is made of. Every tetrahedron must be in one region.",
    keys: &[
        &GROUP,
        &WHERE_OF_TETRAHEDRA,
        &DENSITY,
        &MODEL,
        &YOUNGS_MODULUS,
        &POISSONS_RATIO,
        &SPRINGS_OF_REGION,
        &LawKeys,
        &ELEMENT,
        &EDGE_SHARE,
        &PATCH,
        &AXES,
        &FIBRES_OF_REGION,
        &PRONY,
        &VISCOUS_PART,
        &MODULI,
    ],
    needs: Needs::Any,
    examples: &[
        "[[region]]\ngroup = \"tissue\"\ndensity = 1060.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n",
        "[[region]]\nwhere = { box = [[0.0, 0.0, 0.1], [0.2, 0.2, 0.2]] }\ndensity = 1060.0\nmodel = \"springs\"\n\
         youngs_modulus = 3500.0\nsprings = { rule = \"lloyd\" }\n",
        "[[region]]\ndensity = 1060.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.49\n\
         element = \"fbar-edge\"\nedge_share = 0.9\npatch = 12\n",
        "[[region]]\ndensity = 1060.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n\
         fibres = { direction = [0.0, 0.0, 1.0], eta = 2000.0 }\n",
        "[[region]]\ndensity = 1060.0\nmodel = \"mooney-rivlin\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\nc1_over_c2 = 4.0\n\
         prony = [[0.3, 0.05], [0.2, 0.5]]\nviscous_part = \"deviatoric\"\nmoduli = \"longterm\"\n",
        "[[region]]\ndensity = 1060.0\nmodel = \"neo-hookean\"\nyoungs_modulus = { data = \"stiffness\" }\npoissons_ratio = 0.45\n\
         fibres = { direction = { data = \"along\" }, eta = 2000.0 }\n",
        "[[region]]\ndensity = 1060.0\nmodel = \"neo-hookean-iso\"\nyoungs_modulus = 9000.0\npoissons_ratio = 0.49\n\
         fibres = [{ direction = [0.0, 0.875, 0.485], k1 = 2363.2, k2 = 0.8393 }, { direction = [0.0, 0.875, -0.485], k1 = 2363.2, k2 = 0.8393 }]\n",
    ],
};

const GROUP: Key<GroupName, Optional> = OPTIONAL_GROUP.only(&[NOT_WHERE]);

const DENSITY: Key<OrData<Number>> = Key::required(
    "density",
    "Mass of each cubic metre.",
    OrData(Number::above_zero("a finite density above 0 kg/m3")),
)
.unit("kg/m3");

const YOUNGS_MODULUS: Key<OrData<Number>> = Key::required(
    "youngs_modulus",
    "Young's modulus: the stress for each unit of strain when a bar of the material is pulled. By data, edges and patches over which an \
     element averages have the mean of their tetrahedra by volume, so a jump that is known beforehand is sharper between two regions.",
    OrData(Number::above_zero("a finite Young's modulus above 0 Pa")),
)
.unit("Pa")
.only(&[Condition::among(
    MODEL.name,
    model::by_modulus,
    "does not go with this model, whose stiffness is given by its own parameters",
)]);

const POISSONS_RATIO: Key<Number> = Key::required(
    "poissons_ratio",
    "Poisson's ratio: the strain across over the strain along when a bar of the material is pulled. Plain tetrahedra are too \
     stiff from 0.4 on; `element = \"fbar-edge\"` mends that.",
    Number::between(
        "a number above -1 and below 0.5, from 0 on for laws of large deformation",
        Bound::Excluded(-1.0),
        Bound::Excluded(0.5),
    ),
)
.only(&[
    Condition::among(
        MODEL.name,
        model::solids,
        "does not go with springs: their Poisson's ratio is 1/4, whatever their stiffness",
    )
    .help("take the key out, or use model = \"linear\""),
    Condition::among(
        MODEL.name,
        model::by_ratio,
        "does not go with this model, which has none among its parameters",
    )
    .required_with(MODEL.name, model::always_by_ratio),
]);

const SPRINGS_OF_REGION: Key<Inner> = Key::required(
    "springs",
    "The stiffness of the springs.",
    Inner::one("a table such as { rule = \"lloyd\" }", &SPRINGS),
)
.only(&[Condition::where_is(
    MODEL.name,
    &[SPRINGS_MODEL],
    "goes with model = \"springs\" only",
)]);

/// Elements without their numbers.
#[derive(Clone, Copy, PartialEq)]
enum ElementName {
    P1,
    Fbar,
    FbarEdge,
}

const ELEMENT: Key<Words<ElementName>, Or<ElementName>> = Key::or(
    "element",
    "The strain that tetrahedra resist. `\"p1\"`: their own, which is constant; they are too stiff in bending, and locked near \
     incompressibility. `\"fbar\"`: changes of volume are averaged over patches of tetrahedra, which takes the locking away. \
     `\"fbar-edge\"`: shear is averaged over edges as well, for bending; three to four times the blocks of the matrix, and the same error with far fewer tetrahedra. \
     A beam four cells thick bends by .98 (`split = \"kuhn\"`) or .95 (`\"mirrored\"`) of what it should at Poisson's ratios up to .499, and twists by .95 or .87: a bar that is twisted \
     takes about six cells for .98 or .94.",
    Words(&[
        ("p1", ElementName::P1),
        (FBAR, ElementName::Fbar),
        (FBAR_EDGE, ElementName::FbarEdge),
    ]),
    ElementName::P1,
)
.only(&[Condition::among(
    MODEL.name,
    model::solids,
    "does not go with springs, which are no elements",
)]);

const FBAR: &str = "fbar";
const FBAR_EDGE: &str = "fbar-edge";

const EDGE_SHARE: Key<Number, Or<f64>> = Key::or(
    "edge_share",
    "Share of the shear energy that is averaged over edges. The rest keeps single tetrahedra from folding.",
    Number::between(
        "a number from 0 to 1",
        Bound::Included(0.0),
        Bound::Included(1.0),
    ),
    Element::EDGE_SHARE,
)
.only(&[Condition::where_is(
    ELEMENT.name,
    &[FBAR_EDGE],
    "goes with element = \"fbar-edge\" only",
)]);

const PATCH: Key<Count, Optional> = Key::optional(
    "patch",
    "Tetrahedra of a patch. Patches grow from the first tetrahedron that is in none, by the neighbour with most nodes in common; \
     what is left over joins a neighbour. Small ones lock, and their pressures oscillate.",
    Count {
        least: Element::SMALLEST_PATCH as usize,
        most: 1000,
    },
    "12, or on a grid the six of each hexahedron",
)
.only(&[Condition::where_is(
    ELEMENT.name,
    &[FBAR, FBAR_EDGE],
    "goes with element = \"fbar\" or \"fbar-edge\" only",
)]);

const SPRINGS: TableDescription = TableDescription {
    name: "springs",
    meaning: "Springs along the edges of tetrahedra, with a stiffness that follows from Young's modulus.",
    keys: &[&RULE, &CALIBRATE, &DAMPING_RATIO],
    needs: Needs::Any,
    examples: &[
        "{ rule = \"lloyd\" }",
        "{ rule = \"van-gelder\", calibrate = true, damping_ratio = 0.05 }",
    ],
};

const RULE: Key<Words<SpringRule>> = Key::required(
    "rule",
    "`\"lloyd\"`: the six edges of a tetrahedron are equally stiff (Lloyd, Szekely and Harders 2007). `\"van-gelder\"`: an \
     edge is the stiffer the larger the volume around it and the shorter it is (Van Gelder 1998).",
    Words(&[
        ("lloyd", SpringRule::Lloyd),
        ("van-gelder", SpringRule::VanGelder),
    ]),
);

const CALIBRATE: Key<Flag, Or<bool>> = Key::or(
    "calibrate",
    "Whether all stiffnesses of the region are scaled so that the springs' average modulus (after Voigt) is Young's modulus.",
    Flag,
    false,
);

const DAMPING_RATIO: Key<Number, Or<f64>> = Key::or(
    "damping_ratio",
    "Dashpots beside the springs: the damping of each over the least at which its two masses, by themselves, no longer swing.",
    Number::zero_or_above("a finite share of the critical damping, 0 or above"),
    0.0,
);

const NEARLY_INCOMPRESSIBLE: &str = "0.5 is incompressible, which a displacement alone cannot \
    describe; soft tissue is usually given 0.45 to 0.499, with element = \"fbar-edge\"";

pub(super) fn read_all(
    tables: Vec<Table<'_>>,
    selections: &mut Selections,
) -> Result<(Vec<Region>, Vec<Place>), SceneError> {
    let regions = tables.iter().map(|table| read(table, selections));
    let regions = regions.collect::<Result<Vec<_>, _>>()?;
    for (index, (region, table)) in regions.iter().zip(&tables).enumerate() {
        let Some(group) = &region.group else {
            if regions.len() > 1 {
                let expected = "a group, or where = \"rest\", as there are several regions";
                return Err(table.missing(GROUP.name, expected.to_owned()));
            }
            continue;
        };
        let same = regions[..index]
            .iter()
            .position(|other| other.group == region.group);
        if let Some(first) = same {
            let key = table.place().part_key();
            return Err(taken(table.place(), key, group, tables[first].place()));
        }
    }
    Ok((regions, tables.into_iter().map(Table::into_place).collect()))
}

/// The error for a name that is given a second time.
pub(super) fn taken(place: &Place, key: &'static str, name: &str, owner: &Place) -> SceneError {
    let line = owner
        .line(key)
        .map_or_else(String::new, |line| format!(" on line {line}"));
    let fault = Fault::Taken {
        key,
        name: name.to_owned(),
        by: format!("{}{line}", owner.name()),
    };
    place.value_fault(key, fault)
}

fn read(table: &Table<'_>, selections: &mut Selections) -> Result<Region, SceneError> {
    let model = table.read(&MODEL)?;
    table.check_conditions()?;
    let group =
        selections.at_most_one_of(table, (&GROUP, &WHERE_OF_TETRAHEDRA), Members::Tetrahedra)?;
    // Data give the multiples of 1 kg/m^3 and 1 Pa.
    let (density, density_data) = from_mesh::read(table, &DENSITY)?.or(1.0);
    let (youngs_modulus, modulus_data) = match model.has_youngs_modulus() {
        true => from_mesh::read(table, &YOUNGS_MODULUS)?.or(1.0),
        false => (1.0, None),
    };
    if modulus_data.is_some() && table.has(LawParameter::BULK_MODULUS.name) {
        let reason = "does not go with Young's modulus by data, of which Poisson's ratio makes a bulk modulus for each tetrahedron";
        let key = LawParameter::BULK_MODULUS.name;
        let reason = reason.to_owned();
        return Err(table
            .place()
            .key_fault(key, Fault::Misplaced { key, reason }));
    }
    let law = match model {
        MaterialModel::Springs => springs(&table.table(&SPRINGS_OF_REGION)?, youngs_modulus)?,
        MaterialModel::Linear => Law::Linear {
            youngs_modulus,
            poissons_ratio: poissons_ratio(table)?,
        },
        MaterialModel::Hyperelastic(law) => Law::Hyperelastic {
            id: law.id(),
            parameters: parameters(table, law, youngs_modulus)?,
        },
    };
    let element = match model {
        MaterialModel::Springs => Element::P1,
        MaterialModel::Linear | MaterialModel::Hyperelastic(_) => element(table)?,
    };
    let tissue = match model {
        MaterialModel::Springs | MaterialModel::Linear => Tissue::default(),
        MaterialModel::Hyperelastic(law) => tissue::read(table, law)?,
    };
    Ok(Region {
        group,
        density,
        law,
        element,
        tissue,
        from_mesh: FromMesh {
            youngs_modulus: modulus_data,
            density: density_data,
        },
    })
}

/// The parameters of a law of large deformation, read with the law's own descriptions.
fn parameters(
    table: &Table<'_>,
    law: &'static KnownLaw,
    youngs_modulus: f64,
) -> Result<Parameters, SceneError> {
    let mut parameters = Parameters::default();
    for parameter in law.parameters() {
        if parameter.name == LawParameter::YOUNGS_MODULUS.name {
            parameters.set(parameter.name, &[youngs_modulus]);
        } else if parameter.name == LawParameter::POISSONS_RATIO.name {
            if table.has(POISSONS_RATIO.name) {
                parameters.set(parameter.name, &[poissons_ratio(table)?]);
            }
            model::require(table, parameter)?;
        } else if let Some(values) = model::read(table, parameter)? {
            parameters.set(parameter.name, &values);
        }
    }
    match law.make(&parameters) {
        // Young's modulus is checked when the body is built, where the data of a mesh are known.
        Err(ParameterError::Value {
            quantity, expected, ..
        }) if quantity != LawParameter::YOUNGS_MODULUS.name => {
            Err(table.value_misfit(quantity, expected))
        }
        _ => Ok(parameters),
    }
}

fn element(table: &Table<'_>) -> Result<Element, SceneError> {
    let patch = || Ok(table.read(&PATCH)?.map(|patch| patch as u32));
    match table.read(&ELEMENT)? {
        ElementName::P1 => Ok(Element::P1),
        ElementName::Fbar => Ok(Element::Fbar { patch: patch()? }),
        ElementName::FbarEdge => Ok(Element::FbarEdge {
            edge_share: table.read(&EDGE_SHARE)?,
            patch: patch()?,
        }),
    }
}

fn springs(table: &Table<'_>, youngs_modulus: f64) -> Result<Law, SceneError> {
    Ok(Law::Springs {
        youngs_modulus,
        rule: table.read(&RULE)?,
        calibrate: table.read(&CALIBRATE)?,
        damping_ratio: table.read(&DAMPING_RATIO)?,
    })
}

fn poissons_ratio(table: &Table<'_>) -> Result<f64, SceneError> {
    let read = table.read(&POISSONS_RATIO);
    read.map_err(|error| match error.fault() {
        Fault::Value { found, .. } if found.parse().is_ok_and(|nu: f64| nu >= 0.5) => {
            error.with_help(NEARLY_INCOMPRESSIBLE)
        }
        _ => error,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sinew_fem::hyperelastic::KEYS_OF_REGIONS;

    /// The registry of laws refuses these names, but has no access to the keys here.
    #[test]
    fn laws_leave_the_keys_of_regions_alone() {
        let keys = REGION.keys.iter().filter(|key| key.parts().is_none());
        let names = keys.map(|key| key.name());
        let shared = [YOUNGS_MODULUS.name, POISSONS_RATIO.name];
        let own: Vec<&str> = names.filter(|name| !shared.contains(name)).collect();
        assert_eq!(own, KEYS_OF_REGIONS);
    }
}
