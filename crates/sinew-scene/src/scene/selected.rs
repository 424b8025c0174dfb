//! `group` and `where`: the part of the body that a table is about.

use sinew_mesh::{Condition, Selection};
use toml::de::DeValue;

use crate::decode::value::{Misfit, above_zero, finite, list, tags, text, vector, zero_or_above};
use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};

/// A part of the body that a scene chooses by where it lies. It becomes a group of the mesh when the scene is built.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// The name of the group.
    pub name: String,
    /// The kind of its members.
    pub members: Members,
    /// The choice.
    pub choice: Choice,
}

/// The kind of members of a selected part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Members {
    /// Nodes: for supports, motions, forces, initial states and probes.
    Nodes,
    /// Triangles of the boundary: for tractions and pressures.
    Triangles,
    /// Tetrahedra: for regions.
    Tetrahedra,
}

/// The way a part is chosen.
#[derive(Debug, Clone, PartialEq)]
pub enum Choice {
    /// By conditions on its nodes.
    Where(Selection),
    /// The tetrahedra that no other region has.
    Rest,
}

/// The selected parts of a scene, and the table of each.
#[derive(Debug, Default)]
pub(super) struct Selections {
    pub(super) parts: Vec<Selected>,
    pub(super) places: Vec<Place>,
}

pub(super) const KEYS: &[&str] = &["below", "above", "box", "sphere", "plane", "face", "nodes"];

const GROUP: &str = "the name of a group, or where = { .. } in its place";

impl Selections {
    /// The group that a table names or selects, if it does either.
    pub(super) fn optional(
        &mut self,
        table: &Table<'_>,
        members: Members,
    ) -> Result<Option<String>, SceneError> {
        if !table.has("where") {
            return table.optional("group", GROUP, text);
        }
        table.refuse(
            &["group"],
            "does not go with `where`, which stands in its place",
        )?;
        let choice = choice(table, members)?;
        let name = match (&choice, members) {
            (Choice::Rest, _) => "rest".to_owned(),
            (Choice::Where(selection), Members::Nodes) => format!("nodes {selection}"),
            (Choice::Where(selection), Members::Triangles) => format!("triangles {selection}"),
            (Choice::Where(selection), Members::Tetrahedra) => format!("tetrahedra {selection}"),
        };
        self.parts.push(Selected {
            name: name.clone(),
            members,
            choice,
        });
        self.places.push(table.place().clone());
        Ok(Some(name))
    }

    /// The group that a table must name or select.
    pub(super) fn required(
        &mut self,
        table: &Table<'_>,
        members: Members,
    ) -> Result<String, SceneError> {
        let group = self.optional(table, members)?;
        group.ok_or_else(|| table.missing("group", GROUP))
    }
}

fn choice(table: &Table<'_>, members: Members) -> Result<Choice, SceneError> {
    let (of_region, expected) = match members {
        Members::Tetrahedra => (
            true,
            "conditions such as { below = { z = 0.01 } }, or \"rest\"",
        ),
        Members::Nodes | Members::Triangles => {
            (false, "conditions such as { below = { z = 0.01 } }")
        }
    };
    let rest = table.optional("where", expected, |value| match value {
        DeValue::String(word) if of_region && word.as_ref() == "rest" => Ok(true),
        DeValue::String(_) if of_region => Err(Misfit::Value),
        DeValue::Table(entries) if entries.is_empty() => Err(Misfit::Value),
        DeValue::Table(_) => Ok(false),
        _ => Err(Misfit::Type),
    })?;
    if rest == Some(true) {
        return Ok(Choice::Rest);
    }
    let conditions = match table.table("where", KEYS)? {
        Some(place) => conditions(&place, of_region)?,
        None => Vec::new(),
    };
    Ok(Choice::Where(Selection::new(conditions)))
}

fn conditions(place: &Table<'_>, of_region: bool) -> Result<Vec<Condition>, SceneError> {
    if of_region {
        place.refuse(
            &["face"],
            "chooses triangles of the boundary, and a region is made of tetrahedra",
        )?;
    }
    let mut conditions = Vec::new();
    if let Some(bounds) = bounds(place, "below", f64::INFINITY)? {
        conditions.push(Condition::below(bounds));
    }
    if let Some(bounds) = bounds(place, "above", f64::NEG_INFINITY)? {
        conditions.push(Condition::above(bounds));
    }
    let corners = "two corners [[x, y, z], [x, y, z]] in m, the lower one first";
    if let Some([low, high]) = place.optional("box", corners, corners_of_box)? {
        conditions.push(Condition::Box { low, high });
    }
    if let Some(sphere) = place.table("sphere", &["center", "radius"])? {
        conditions.push(Condition::Sphere {
            center: sphere.required("center", "[x, y, z] in m, all finite", vector)?,
            radius: sphere.required("radius", "a finite radius above 0 m", above_zero)?,
        });
    }
    let direction = "[x, y, z], all finite and not all 0";
    if let Some(plane) = place.table("plane", &["point", "normal", "within"])? {
        let within = "a finite distance, 0 m or above";
        conditions.push(Condition::Plane {
            point: plane.required("point", "[x, y, z] in m, all finite", vector)?,
            normal: plane.required("normal", direction, nonzero)?,
            within: plane.required("within", within, zero_or_above)?,
        });
    }
    if let Some(face) = place.table("face", &["normal", "angle"])? {
        let angle = "an angle from 0 to 180 degrees";
        conditions.push(Condition::Facing {
            normal: face.required("normal", direction, nonzero)?,
            angle: face.required("angle", angle, angle_in_degrees)?,
        });
    }
    let node_tags = "a list of tags of nodes of the mesh file";
    if let Some(tags) = place.optional("nodes", node_tags, tags)? {
        conditions.push(Condition::Tags(tags));
    }
    Ok(conditions)
}

/// The bounds of `below` or `above`; `none` along axes that are not named.
fn bounds(place: &Table<'_>, key: &'static str, none: f64) -> Result<Option<[f64; 3]>, SceneError> {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let Some(table) = place.table(key, &AXES)? else {
        return Ok(None);
    };
    let mut bounds = [none; 3];
    for (bound, axis) in bounds.iter_mut().zip(AXES) {
        if let Some(given) = table.optional(axis, "a finite coordinate in m", finite)? {
            *bound = given;
        }
    }
    if bounds == [none; 3] {
        let expected = "a coordinate along x, y or z such as { z = 0.01 }".to_owned();
        let found = "{}".to_owned();
        let key = key.to_owned();
        let fault = Fault::Value {
            key: key.clone(),
            found,
            expected,
        };
        return Err(place.place().value_fault(&key, fault));
    }
    Ok(Some(bounds))
}

fn corners_of_box(value: &DeValue<'_>) -> Result<[[f64; 3]; 2], Misfit> {
    let corners = <[[f64; 3]; 2]>::try_from(list(value, vector)?).map_err(|_| Misfit::Value)?;
    let [low, high] = corners;
    match (0..3).all(|axis| low[axis] <= high[axis]) {
        true => Ok(corners),
        false => Err(Misfit::Value),
    }
}

fn nonzero(value: &DeValue<'_>) -> Result<[f64; 3], Misfit> {
    let vector = vector(value)?;
    // Of components so small or large that a length is 0 or infinite, no direction can be made.
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    match length > 0.0 && length.is_finite() {
        true => Ok(vector),
        false => Err(Misfit::Value),
    }
}

fn angle_in_degrees(value: &DeValue<'_>) -> Result<f64, Misfit> {
    match zero_or_above(value)? {
        angle if angle <= 180.0 => Ok(angle),
        _ => Err(Misfit::Value),
    }
}
