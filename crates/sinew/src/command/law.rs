//! `sinew law`.

use std::path::{Path, PathBuf};

use sinew_record::{
    AskedCurves, Measured, RegionCurves, check_curves_folder, curves_of_laws, is_curves_file,
    picture_of_law, table_of_laws, words_of_law, write_curves,
};
use sinew_scene::output::{Destination, Voice};

use super::Failure;
use super::own_file::{Force, holds};
use super::scene_with::Values;

/// A scene and the requested curves.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The scene file
    scene: PathBuf,
    /// The only region to show: its number, from 1 on, or its group
    #[arg(long, value_name = "NUMBER|GROUP")]
    region: Option<String>,
    /// The least and the largest stretch; an amount of shear goes from FROM - 1 to TO - 1 [default: those of the
    /// measured points with a margin, or 0.7 2]
    #[arg(long, num_args = 2, value_names = ["FROM", "TO"], value_parser = stretch, allow_negative_numbers = true)]
    stretch: Option<Vec<f64>>,
    /// The axis of the pull in the axes of the mesh; with fibres and axes the curves depend on it [default: 1,0,0, or
    /// between the fibres if data of the mesh give their directions]
    #[arg(
        long,
        value_name = "X,Y,Z",
        num_args = 1,
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    along: Option<Vec<f64>>,
    /// The second axis of sheets and shears, as far as it is at right angles to the first [default: the mesh's axis
    /// after the one that the first is nearest to, or the material's second one if data of the mesh give its axes]
    #[arg(
        long,
        value_name = "X,Y,Z",
        num_args = 1,
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    across: Option<Vec<f64>>,
    /// Measured points to show with the curves: a CSV file with the columns load (uniaxial, equibiaxial, planar or
    /// simple-shear), stretch_or_shear (1 and 0 at rest) and stress_Pa (nominal)
    #[arg(long, value_name = "FILE")]
    measured: Option<PathBuf>,
    /// The folder for the table and the pictures, a new one or that of earlier curves, which is replaced; or a file
    /// that ends in .csv, with the pictures next to it; or - for the table on standard output
    #[arg(long, value_name = "DIR|FILE.csv")]
    out: Option<PathBuf>,
    #[command(flatten)]
    force: Force,
    #[command(flatten)]
    values: Values,
}

pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let scene = arguments.values.load(&arguments.scene)?;
    let measured = arguments
        .measured
        .as_deref()
        .map(Measured::read)
        .transpose()?;
    let mut inputs = scene.input_files();
    inputs.extend(arguments.measured.clone());
    let table = match &arguments.out {
        Some(out) if is_table(out) => Some(Destination::new(out, &inputs)?),
        Some(out) => {
            check_curves_folder(out, &inputs)?;
            None
        }
        None => None,
    };
    let asked = AskedCurves {
        region: arguments.region.clone(),
        along: axis("--along", arguments.along.as_deref())?,
        across: axis("--across", arguments.across.as_deref())?,
        stretch: match arguments.stretch.as_deref() {
            Some(&[from, to]) if from < to => Some([from, to]),
            Some(found) => {
                let found = found.to_vec();
                return Err(Failure::Stretch { found });
            }
            None => None,
        },
    };
    let measured = measured.as_ref();
    let regions = curves_of_laws(&scene, &asked, measured)?;
    let voice = table
        .as_ref()
        .map_or(Voice::StandardOutput, Voice::apart_from);
    let mut written = Vec::new();
    match (table, &arguments.out) {
        (Some(table), _) => written = beside(table, &inputs, &regions, measured, arguments.force)?,
        (None, Some(folder)) => {
            let names = write_curves(folder, &inputs, &regions, measured)?;
            written.push(format!("{}: {}", folder.display(), names.join(", ")));
        }
        (None, None) => {}
    }
    for region in &regions {
        voice.say(&format!("{}: {}", region.name(), region.law))?;
        for line in words_of_law(region, measured) {
            voice.say(&format!("  {line}"))?;
        }
    }
    for line in written {
        voice.say(&line)?;
    }
    Ok(())
}

/// The axis that an option gives.
fn axis(option: &'static str, given: Option<&[f64]>) -> Result<Option<[f64; 3]>, Failure> {
    match given {
        None => Ok(None),
        Some(&[x, y, z]) => Ok(Some([x, y, z])),
        Some(other) => Err(Failure::Axis {
            option,
            found: other.len(),
        }),
    }
}

/// True for a path that names a table and no folder.
fn is_table(path: &Path) -> bool {
    let is_csv = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("csv"));
    let is_stream = || path.symlink_metadata().is_ok() && !path.is_dir() && !path.is_file();
    (is_csv && !path.is_dir()) || path == Path::new("-") || is_stream()
}

/// Writes a table and, if it is a file, the picture of each region next to it; all are checked before the first is
/// written.
fn beside(
    table: Destination,
    inputs: &[PathBuf],
    regions: &[RegionCurves],
    measured: Option<&Measured>,
    force: Force,
) -> Result<Vec<String>, Failure> {
    let text = table_of_laws(regions);
    let own = |path: &Path, content: &str| holds(path, content.as_bytes()) || is_curves_file(path);
    let mut pictures = Vec::new();
    if !table.is_stream() {
        let path = table.path().to_owned();
        force.check(&table, || own(&path, &text))?;
        for region in regions {
            let path = picture_beside(&path, region, regions.len());
            let picture = picture_of_law(region, measured);
            let destination = Destination::new(&path, inputs)?;
            force.check(&destination, || own(&path, &picture))?;
            pictures.push((destination, picture));
        }
    }
    let mut written = Vec::new();
    if !table.is_stream() {
        written.push(table.path().display().to_string());
    }
    let _ = table.write(text.as_bytes())?;
    for (destination, picture) in pictures {
        written.push(destination.path().display().to_string());
        let _ = destination.write(picture.as_bytes())?;
    }
    Ok(written)
}

/// The picture next to a table: by its name, with the number of the region if there are several.
fn picture_beside(table: &Path, region: &RegionCurves, regions: usize) -> PathBuf {
    if regions == 1 {
        return table.with_extension("svg");
    }
    let mut name = table.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-region-{}.svg", region.number));
    table.with_file_name(name)
}

fn stretch(text: &str) -> Result<f64, &'static str> {
    match text.parse() {
        Ok(stretch) if f64::is_finite(stretch) && stretch > 0.0 => Ok(stretch),
        _ => Err("expected a finite stretch above 0, such as 0.8; 1 is at rest"),
    }
}
