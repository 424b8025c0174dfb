//! Fields of a run, and their quantities that a colour shows.

use crate::FilmError;

/// The name of the colouring without a field.
const TISSUE: &str = "tissue";

/// Components of vectors.
const OF_VECTORS: [&str; 3] = ["x", "y", "z"];

/// Components of symmetric tensors, in the order of a run's arrays.
const OF_TENSORS: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "zx"];

/// Arrays that are not quantities. Their content is shown in other ways.
const NO_FIELDS: [&str; 1] = ["region"];

/// Units of arrays, and their names on bars; others are plain numbers with their own names.
const KNOWN: [(&str, &str, &str); 10] = [
    ("displacement", "m", "displacement"),
    ("velocity", "m/s", "velocity"),
    ("acceleration", "m/s²", "acceleration"),
    ("contact_force", "N", "contact force"),
    ("contact_pressure", "Pa", "contact pressure"),
    ("von_mises", "Pa", "von Mises stress"),
    ("stress", "Pa", "stress"),
    ("strain", "", "strain"),
    ("step_limit", "s", "step limit"),
    ("inverted", "", "inverted"),
];

/// An array of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Numbers at each point or cell: 1, 3 for a vector, 6 for a symmetric tensor.
    pub components: usize,
    /// True if its numbers are those of cells.
    pub of_cells: bool,
}

/// The scalar that is computed from a field's components.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Measure {
    Component(usize),
    Length,
    VonMises,
    LargestPrincipal,
}

/// A field and the scalar that is shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Shown {
    pub(crate) field: Field,
    measure: Measure,
}

/// The meaning of a body's colour: tissue, or a quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Colouring {
    shown: Option<Shown>,
    title: String,
    unit: &'static str,
}

impl Colouring {
    /// Bodies as tissue: no field.
    #[must_use]
    pub fn tissue() -> Self {
        Self {
            shown: None,
            title: TISSUE.to_owned(),
            unit: "",
        }
    }

    /// A quantity of the caller: the values of frames, with title and unit for the bar.
    #[must_use]
    pub fn of_values(title: &str, unit: &'static str) -> Self {
        let name = title.to_owned();
        let field = Field {
            name,
            components: 1,
            of_cells: false,
        };
        Self {
            shown: Some(Shown {
                field,
                measure: Measure::Component(0),
            }),
            title: title.to_owned(),
            unit,
        }
    }

    /// The colouring of this name among the fields of a run.
    pub(crate) fn find(asked: &str, fields: &[Field]) -> Result<Self, FilmError> {
        let asked = asked.trim();
        if asked == TISSUE {
            return Ok(Self::tissue());
        }
        let (name, component) = match asked.split_once('.') {
            Some((name, component)) => (name, Some(component)),
            None => (asked, None),
        };
        let unknown = || FilmError::Colour {
            asked: asked.to_owned(),
            known: in_words(fields),
        };
        let field = fields
            .iter()
            .find(|field| field.name == name && is_shown(field));
        let field = field.ok_or_else(unknown)?;
        let measure = measure(field, component).ok_or_else(unknown)?;
        let known = KNOWN.iter().find(|known| known.0 == name);
        let own_name = name.replace('_', " ");
        let (unit, words) = known.map_or(("", own_name.as_str()), |known| (known.1, known.2));
        let title = match (measure, component) {
            (Measure::VonMises, _) => "von Mises stress".to_owned(),
            (Measure::LargestPrincipal, _) => "largest strain".to_owned(),
            (_, Some(component)) => format!("{words} {component}"),
            (_, None) => words.to_owned(),
        };
        Ok(Self {
            shown: Some(Shown {
                field: field.clone(),
                measure,
            }),
            title,
            unit,
        })
    }

    /// The field; `None` for tissue.
    pub(crate) fn field(&self) -> Option<&Shown> {
        self.shown.as_ref()
    }

    /// True if single values may be far beyond all others, for example those of cells at a corner.
    pub(crate) fn has_peaks(&self) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|shown| shown.field.of_cells)
    }

    /// Its name on the bar.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The unit of its values; empty for plain numbers.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.unit
    }
}

impl Shown {
    /// The scalar that is shown for a row of components.
    pub(crate) fn of(&self, row: &[f64]) -> f64 {
        match (self.measure, row) {
            (Measure::Component(index), row) => row.get(index).copied().unwrap_or(0.0),
            (Measure::Length, row) => row.iter().map(|x| x * x).sum::<f64>().sqrt(),
            (Measure::VonMises, &[xx, yy, zz, xy, yz, zx]) => {
                let differences = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
                (differences / 2.0 + 3.0 * (xy * xy + yz * yz + zx * zx)).sqrt()
            }
            (Measure::LargestPrincipal, &[xx, yy, zz, xy, yz, zx]) => {
                largest_principal([xx, yy, zz], [xy, yz, zx])
            }
            _ => 0.0,
        }
    }
}

/// The largest eigenvalue of a symmetric matrix with this diagonal and the other entries xy, yz, zx (O. K. Smith, 1961).
fn largest_principal(diagonal: [f64; 3], [xy, yz, zx]: [f64; 3]) -> f64 {
    let mean = diagonal.iter().sum::<f64>() / 3.0;
    let [x, y, z] = diagonal.map(|entry| entry - mean);
    let beside = xy * xy + yz * yz + zx * zx;
    let size = ((x * x + y * y + z * z + 2.0 * beside) / 6.0).sqrt();
    if size == 0.0 {
        return mean;
    }
    let determinant = x * (y * z - yz * yz) - xy * (xy * z - yz * zx) + zx * (xy * yz - y * zx);
    let half = (determinant / (2.0 * size.powi(3))).clamp(-1.0, 1.0);
    mean + 2.0 * size * (half.acos() / 3.0).cos()
}

/// The scalar of a field for its name alone, or for its name with a component. `None` if the field has no such
/// component.
fn measure(field: &Field, component: Option<&str>) -> Option<Measure> {
    let place = |names: &[&str], asked: &str| names.iter().position(|name| *name == asked);
    match (field.components, component) {
        (1, None) => Some(Measure::Component(0)),
        (3, None) => Some(Measure::Length),
        (6, None) if field.name == "stress" => Some(Measure::VonMises),
        (6, None) if field.name == "strain" => Some(Measure::LargestPrincipal),
        (3, Some(asked)) => place(&OF_VECTORS, asked).map(Measure::Component),
        (6, Some(asked)) => place(&OF_TENSORS, asked).map(Measure::Component),
        _ => None,
    }
}

fn is_shown(field: &Field) -> bool {
    !NO_FIELDS.contains(&field.name.as_str())
}

/// List of the colourings of a run, for an error message.
fn in_words(fields: &[Field]) -> String {
    let mut words = vec![TISSUE.to_owned()];
    for field in fields.iter().filter(|field| is_shown(field)) {
        let components: &[&str] = match field.components {
            3 => &OF_VECTORS,
            6 => &OF_TENSORS,
            _ => &[],
        };
        let name = &field.name;
        let alone = measure(field, None).map(|_| name.clone());
        let first = components.first().zip(components.last());
        let parts = first.map(|(first, last)| format!("{name}.{first} to .{last}"));
        words.extend(alone.into_iter().chain(parts));
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields() -> Vec<Field> {
        let field = |name: &str, components| Field {
            name: name.to_owned(),
            components,
            of_cells: components == 6,
        };
        vec![
            field("displacement", 3),
            field("region", 1),
            field("stress", 6),
            field("strain", 6),
        ]
    }

    fn value(name: &str, row: &[f64]) -> Option<f64> {
        let found = Colouring::find(name, &fields()).ok()?;
        Some(found.field()?.of(row))
    }

    #[test]
    fn vectors_show_their_length_and_tensors_what_their_name_asks() {
        assert_eq!(value("displacement", &[2.0, 3.0, 6.0]), Some(7.0));
        assert_eq!(value("displacement.z", &[2.0, 3.0, 6.0]), Some(6.0));
        // Uniaxial tension and pure shear.
        assert_eq!(value("stress", &[5.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Some(5.0));
        let shear = value("stress", &[0.0, 0.0, 0.0, 2.0, 0.0, 0.0]).unwrap_or(0.0);
        assert!((shear - 2.0 * 3.0_f64.sqrt()).abs() < 1e-12, "{shear}");
        let principal = value("strain", &[0.0, 0.0, 0.0, 0.0, 0.3, 0.0]).unwrap_or(0.0);
        assert!((principal - 0.3).abs() < 1e-12, "{principal}");
        let turned = value("strain", &[1.0, 1.0, -0.5, 1.0, 0.0, 0.0]).unwrap_or(0.0);
        assert!((turned - 2.0).abs() < 1e-12, "{turned}");
    }

    #[test]
    fn an_unknown_colour_is_answered_by_those_that_there_are() {
        for name in ["temperature", "region", "displacement.xx", "stress.x", ""] {
            let said = Colouring::find(name, &fields()).map_err(|error| error.to_string());
            let said = said.expect_err(name);
            let known =
                "it has tissue, displacement, displacement.x to .z, stress, stress.xx to .zx";
            assert!(said.contains(known), "{said}");
        }
    }
}
