//! A case as plain arrays, for other programs.

use std::path::PathBuf;

use serde_json::json;
use sinew_core::{LinearOperators, Ramp};

use sinew_measure::Case;
use sinew_scene::output::{OutputError, OutputFolder};

/// Names of the files, the head last.
const FILES: [&str; 6] = [
    "row-starts.i32",
    "columns.i32",
    "values.f64",
    "mass.f64",
    "force.f64",
    "system.json",
];

/// Files of an exported case: little-endian arrays without headers, and `system.json` with their lengths, the duration
/// (s) and the number of samples.
///
/// | file | content |
/// | --- | --- |
/// | `row-starts.i32`, `columns.i32`, `values.f64` | K (N/m) in compressed rows, exact zeros left out |
/// | `mass.f64` | lumped mass of each degree of freedom (kg) |
/// | `force.f64` | the load, constant in time (N) |
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The directory the files are in.
    pub directory: PathBuf,
    /// Degrees of freedom.
    pub dofs: usize,
}

/// Reasons why a case cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The other program would solve a different problem.
    #[error(
        "{case}: {what}; only an undamped linear body at rest under constant loads can run beside another program"
    )]
    Unfit {
        /// Id of the case.
        case: String,
        /// The property that the format cannot represent.
        what: &'static str,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl Exported {
    /// The names of the files that [`export`] writes.
    #[must_use]
    pub fn output_files() -> Vec<String> {
        FILES.map(str::to_owned).into()
    }
}

/// Writes a case into a folder.
///
/// # Errors
/// [`ExportError`].
pub fn export(case: &Case, folder: &OutputFolder) -> Result<Exported, ExportError> {
    let simulation = case.simulation();
    let unfit = |what| ExportError::Unfit {
        case: case.id().to_owned(),
        what,
    };
    let linear = simulation.system().as_linear();
    let operators = linear.ok_or_else(|| unfit("it is not linear"))?.operators();
    let damping = operators.damping();
    if damping.mass != 0.0 || damping.stiffness != 0.0 || damping.extra.is_some() {
        return Err(unfit("it is damped"));
    }
    if operators.loads().iter().any(|load| load.ramp != Ramp::Step) {
        return Err(unfit("a load changes with time"));
    }
    let start = simulation.initial_state();
    if start.u.iter().chain(&start.v).any(|value| *value != 0.0) {
        return Err(unfit("it does not start at rest"));
    }

    let rows = CompressedRows::of(operators);
    let mut force = vec![0.0; operators.dofs()];
    operators.external_force(0.0, &mut force);
    let settings = simulation.settings();
    let head = json!({
        "case": case.id(),
        "dofs": operators.dofs(),
        "entries": rows.values.len(),
        "duration_s": settings.duration,
        "samples": settings.samples,
    });

    let contents = [
        integers(&rows.starts),
        integers(&rows.columns),
        reals(&rows.values),
        reals(operators.mass()),
        reals(&force),
        // Last, so that a head is never next to parts of another case.
        head.to_string().into_bytes(),
    ];
    for (name, content) in FILES.iter().zip(&contents) {
        folder.write(name, content)?;
    }
    Ok(Exported {
        directory: folder.path().to_owned(),
        dofs: operators.dofs(),
    })
}

/// K by scalar rows. Zeros inside blocks are left out: the other program should not do unnecessary work.
struct CompressedRows {
    starts: Vec<i32>,
    columns: Vec<i32>,
    values: Vec<f64>,
}

impl CompressedRows {
    fn of(operators: &LinearOperators) -> Self {
        let stiffness = operators.stiffness();
        let layers = stiffness.layers().count();
        let mut rows = Self {
            starts: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        };
        for row in 0..operators.dofs() {
            let (cell, layer) = (row / layers, row % layers);
            for (column, block) in stiffness.row_blocks(cell) {
                let entries = &block[layer * layers..(layer + 1) * layers];
                for (i, value) in entries.iter().enumerate().filter(|(_, k)| **k != 0.0) {
                    rows.columns.push((column * layers + i) as i32);
                    rows.values.push(*value);
                }
            }
            rows.starts.push(rows.values.len() as i32);
        }
        rows
    }
}

fn integers(values: &[i32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

fn reals(values: &[f64]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

#[cfg(test)]
mod tests {
    use sinew_scene::{Scene, SceneSource};

    use super::*;

    const CUBE: &str = "[mesh]
cube = { cells = 3, edge = 0.1, split = \"kuhn\" }
[[region]]
density = 1060.0
model = \"linear\"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = \"bottom\"
[[load]]
group = \"top\"
force = [0.0, 0.0, -10.0]
[run]
duration = 0.1
integrator = \"newmark\"
dt = 0.01
";

    fn case(text: &str) -> Case {
        let scene = Scene::parse(SceneSource::new("a.toml", text)).unwrap();
        Case::new("a", scene.build().unwrap()).unwrap()
    }

    fn numbers<const N: usize, T>(path: PathBuf, from: fn([u8; N]) -> T) -> Vec<T> {
        let bytes = std::fs::read(path).unwrap();
        let chunks = bytes.chunks_exact(N);
        chunks
            .map(|chunk| from(chunk.try_into().unwrap()))
            .collect()
    }

    #[test]
    fn the_rows_written_multiply_as_the_matrix_does() {
        let case = case(CUBE);
        let directory = tempfile::tempdir().unwrap();
        let exported = export(&case, &OutputFolder::new(directory.path(), &[])).unwrap();
        let file = |name: &str| directory.path().join(name);
        let starts = numbers(file("row-starts.i32"), i32::from_le_bytes);
        let columns = numbers(file("columns.i32"), i32::from_le_bytes);
        let values = numbers(file("values.f64"), f64::from_le_bytes);
        let x: Vec<f64> = (0..exported.dofs).map(|i| (i as f64).sin()).collect();
        let operators = case.simulation().system().as_linear().unwrap().operators();
        let mut expected = vec![0.0; exported.dofs];
        operators.stiffness().multiply(&x, &mut expected);
        assert_eq!(starts.len(), exported.dofs + 1);
        for row in 0..exported.dofs {
            let range = starts[row] as usize..starts[row + 1] as usize;
            let product: f64 = range.map(|i| values[i] * x[columns[i] as usize]).sum();
            assert!((product - expected[row]).abs() < 1e-9 * 3500.0);
        }
        let force: f64 = numbers(file("force.f64"), f64::from_le_bytes).iter().sum();
        assert!((force + 10.0).abs() < 1e-12);
        let mass = numbers(file("mass.f64"), f64::from_le_bytes);
        assert_eq!(mass, operators.mass());
    }

    #[test]
    fn what_the_format_cannot_say_is_refused_and_nothing_written() {
        let damped = CUBE.replace("[[fixed]]", "[damping]\nmass = 1.0\n[[fixed]]");
        let ramp = "force = [0.0, 0.0, -10.0]\nramp = { kind = \"sin2\", rise = 0.05 }";
        let ramped = CUBE.replace("force = [0.0, 0.0, -10.0]", ramp);
        let moving = CUBE.replace("[run]", "[[initial]]\nvelocity = [0.0, 0.0, 1.0]\n[run]");
        for (text, expected) in [
            (damped, "it is damped"),
            (ramped, "a load changes with time"),
            (moving, "it does not start at rest"),
        ] {
            let directory = tempfile::tempdir().unwrap();
            let out = directory.path().join("out");
            let folder = OutputFolder::new(&out, &[]);
            let said = export(&case(&text), &folder).unwrap_err().to_string();
            assert!(said.contains(expected), "{said}");
            assert!(!out.exists());
        }
    }
}
