//! `[[region]]`: materials and their regions.

use sinew_fem::{Law, Region, SpringRule};

use super::selected::{Members, Selections};
use crate::decode::value::{Misfit, above_zero, boolean, finite, zero_or_above};
use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};

const KEYS: &[&str] = &[
    "group",
    "where",
    "density",
    "model",
    "youngs_modulus",
    "poissons_ratio",
    "springs",
];

#[derive(Clone, Copy)]
enum MaterialModel {
    Springs,
    Linear,
}

const MODELS: [(&str, MaterialModel); 2] = [
    ("springs", MaterialModel::Springs),
    ("linear", MaterialModel::Linear),
];

const RULES: [(&str, SpringRule); 2] = [
    ("lloyd", SpringRule::Lloyd),
    ("van-gelder", SpringRule::VanGelder),
];

const NEARLY_INCOMPRESSIBLE: &str = "0.5 is incompressible, which a displacement alone cannot \
    describe; soft tissue is usually given 0.45 to 0.49, where 4-node tetrahedra are already \
    stiffer than the material";

pub(super) fn read_all(
    document: &Table<'_>,
    selections: &mut Selections,
) -> Result<(Vec<Region>, Vec<Place>), SceneError> {
    let tables = document.tables("region", KEYS)?;
    let regions = tables.iter().map(|table| read(table, selections));
    let regions = regions.collect::<Result<Vec<_>, _>>()?;
    for (index, (region, table)) in regions.iter().zip(&tables).enumerate() {
        let Some(group) = &region.group else {
            if regions.len() > 1 {
                let expected = "a group, or where = \"rest\", as there are several regions";
                return Err(table.missing("group", expected));
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
    let model = table.choice("model", &MODELS)?;
    let group = selections.optional(table, Members::Tetrahedra)?;
    let density = table.required("density", "a finite density above 0 kg/m3", above_zero)?;
    let modulus = "a finite Young's modulus above 0 Pa";
    let youngs_modulus = table.required("youngs_modulus", modulus, above_zero)?;
    let law = match model {
        MaterialModel::Springs => springs(table, youngs_modulus)?,
        MaterialModel::Linear => linear(table, youngs_modulus)?,
    };
    Ok(Region {
        group,
        density,
        law,
    })
}

fn springs(table: &Table<'_>, youngs_modulus: f64) -> Result<Law, SceneError> {
    table
        .refuse(
            &["poissons_ratio"],
            "does not go with springs: their Poisson's ratio is 1/4, whatever their stiffness",
        )
        .map_err(|error| error.with_help("take the key out, or use model = \"linear\""))?;
    let springs = table
        .table("springs", &["rule", "calibrate", "damping_ratio"])?
        .ok_or_else(|| table.missing("springs", "a table such as { rule = \"lloyd\" }"))?;
    let ratio = "a finite share of the critical damping, 0 or above";
    Ok(Law::Springs {
        youngs_modulus,
        rule: springs.choice("rule", &RULES)?,
        calibrate: springs
            .optional("calibrate", "true or false", boolean)?
            .unwrap_or(false),
        damping_ratio: springs
            .optional("damping_ratio", ratio, zero_or_above)?
            .unwrap_or(0.0),
    })
}

fn linear(table: &Table<'_>, youngs_modulus: f64) -> Result<Law, SceneError> {
    table.refuse(&["springs"], "does not go with model = \"linear\"")?;
    let read_ratio = |value: &toml::de::DeValue<'_>| match finite(value)? {
        ratio if ratio > -1.0 && ratio < 0.5 => Ok(ratio),
        _ => Err(Misfit::Value),
    };
    let poissons_ratio = table
        .required(
            "poissons_ratio",
            "a number above -1 and below 0.5",
            read_ratio,
        )
        .map_err(|error| match error.fault() {
            Fault::Value { found, .. } if found.parse().is_ok_and(|nu: f64| nu >= 0.5) => {
                error.with_help(NEARLY_INCOMPRESSIBLE)
            }
            _ => error,
        })?;
    Ok(Law::Linear {
        youngs_modulus,
        poissons_ratio,
    })
}
