//! Natural frequencies and mode shapes of a scene.

mod lobpcg;

use std::path::{Path, PathBuf};

use sinew_core::LinearOperators;
use sinew_core::vectors::norm;
use sinew_fem::Model;
use sinew_mesh::vtu::{Array, Grid, VtuEncoding};
use sinew_scene::Simulation;
use sinew_scene::output::{OwnedFolder, Tenant};

use crate::error::RecordRunError;
use crate::frames;
pub use lobpcg::ModesError;
use lobpcg::lowest;

/// The kind of result, in manifests and messages.
const KIND: &str = "modes";

/// The table of frequencies.
const TABLE: &str = "modes.csv";

/// Largest displacement of a drawn mode shape as a share of the body's size.
const DRAWN: f64 = 0.1;

/// A natural mode of an undamped body.
#[derive(Debug, Clone, PartialEq)]
pub struct NaturalMode {
    /// Angular frequency (rad/s); 0 for a rigid motion.
    pub omega: f64,
    /// Share of the moving mass that takes part in motions along x, y and z: `(phi' M e)^2 / (e' M e)` with the shape
    /// phi of modal mass 1 and e the translation of all nodes (Bathe, Finite Element Procedures, section 9.3).
    pub effective_mass: [f64; 3],
    /// Share of the elastic energy under all loads at their full value, at rest: `(phi' F)^2 / omega^2` over the sum of
    /// all modes found; NaN if the scene has no loads or the motion is rigid.
    pub of_loads: f64,
    /// Its shape (kg^-1/2) over the degrees of freedom.
    shape: Vec<f64>,
}

impl NaturalMode {
    /// Frequency (Hz).
    #[must_use]
    pub fn frequency(&self) -> f64 {
        self.omega / std::f64::consts::TAU
    }
}

/// The modes of the lowest frequencies of a simulation, including multiple ones and those that no load excites. For a
/// body in large deformation they are the modes of small motions about rest, so fast that no stress relaxes.
///
/// # Errors
/// [`ModesError`] for a system without matrices, a matrix without a factor and an iteration that does not converge.
pub fn natural_modes(
    simulation: &Simulation,
    count: usize,
) -> Result<Vec<NaturalMode>, ModesError> {
    let operators = &simulation.operators_at_rest()?;
    let force = full_load(operators);
    let mut modes = Vec::new();
    for (eigenvalue, shape) in lowest(operators, count)? {
        let effective_mass = [0, 1, 2].map(|axis| effective_mass(operators, &shape, axis));
        let along: f64 = shape
            .iter()
            .zip(&force)
            .map(|(shape, force)| shape * force)
            .sum();
        modes.push(NaturalMode {
            omega: eigenvalue.sqrt(),
            effective_mass,
            of_loads: match eigenvalue > 0.0 {
                true => along * along / eigenvalue,
                false => f64::NAN,
            },
            shape,
        });
    }
    let shares = modes.iter().map(|mode| mode.of_loads);
    let whole: f64 = shares.filter(|share| share.is_finite()).sum();
    for mode in &mut modes {
        mode.of_loads /= whole;
    }
    Ok(modes)
}

/// All loads (N) at their full value.
fn full_load(operators: &LinearOperators) -> Vec<f64> {
    let mut force = vec![0.0; operators.dofs()];
    for load in operators.loads() {
        for (dof, value) in &load.entries {
            force[*dof as usize] += value;
        }
    }
    force
}

fn effective_mass(operators: &LinearOperators, shape: &[f64], axis: usize) -> f64 {
    let layers = operators.stiffness().layers().count();
    if axis >= layers {
        return 0.0;
    }
    let masses = operators.mass().iter().skip(axis).step_by(layers);
    let shape = shape.iter().skip(axis).step_by(layers);
    let (mut along, mut whole) = (0.0, 0.0);
    for (mass, shape) in masses.zip(shape) {
        along += mass * shape;
        whole += mass;
    }
    along * along / whole
}

/// Checks that modes may be written into a folder at `path`. Changes nothing.
///
/// # Errors
/// [`RecordRunError::Output`].
pub fn check_modes_folder(path: &Path, inputs: &[PathBuf]) -> Result<Tenant, RecordRunError> {
    Ok(OwnedFolder::check(path, KIND, inputs)?)
}

/// Writes modes into a folder: a table, and for ParaView the shapes of a body as a series with a mode at each whole
/// time.
///
/// # Errors
/// [`RecordRunError`].
pub fn write_modes(
    path: &Path,
    simulation: &Simulation,
    modes: &[NaturalMode],
) -> Result<(), RecordRunError> {
    let body = simulation.model().body();
    let mut names = vec![TABLE.to_owned()];
    if body.is_some() {
        names.push(frames::SERIES.to_owned());
        names.extend((0..modes.len()).map(frames::frame_name));
    }
    let folder = OwnedFolder::claim(path, KIND, &simulation.scene().input_files(), &names)?;
    let mut table = String::from(
        "mode,frequency_Hz,omega_rad_per_s,effective_mass_x_1,effective_mass_y_1,effective_mass_z_1,share_of_loads_1\n",
    );
    for (number, mode) in (1..).zip(modes) {
        let [x, y, z] = mode.effective_mass;
        let (frequency, omega, loads) = (mode.frequency(), mode.omega, mode.of_loads);
        table.push_str(&format!(
            "{number},{frequency:?},{omega:?},{x:?},{y:?},{z:?},{loads:?}\n"
        ));
    }
    folder.write(TABLE, table.as_bytes())?;
    if let Some(body) = body {
        for (number, mode) in modes.iter().enumerate() {
            write_shape(&folder, number, &body.model, mode)?;
        }
        let times: Vec<f64> = (1..=modes.len()).map(|number| number as f64).collect();
        frames::write_series(&folder, &times)?;
    }
    folder.finish(true)?;
    Ok(())
}

/// Writes the shape of a mode with a visible displacement.
fn write_shape(
    folder: &OwnedFolder,
    number: usize,
    model: &Model,
    mode: &NaturalMode,
) -> Result<(), RecordRunError> {
    let mut shape = vec![[0.0; 3]; model.mesh().points.len()];
    model.to_nodes(&mode.shape, &mut shape)?;
    let largest = shape.iter().map(|u| norm(u)).fold(0.0, f64::max);
    let extent = sinew_core::System::extent(model).unwrap_or(1.0);
    let factor = if largest > 0.0 {
        DRAWN * extent / largest
    } else {
        0.0
    };
    let drawn: Vec<f32> = shape
        .iter()
        .flatten()
        .map(|x| (factor * x) as f32)
        .collect();
    let grid = Grid {
        point_data: vec![Array::of_singles("displacement", 3, drawn)],
        ..Grid::of(model.mesh())
    };
    frames::write(
        folder,
        &frames::frame_name(number),
        &grid,
        VtuEncoding::RawAppended,
    )?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use sinew_scene::{Scene, SceneSource};

    use super::*;

    fn simulation(text: &str) -> Simulation {
        let scene = Scene::parse(SceneSource::new("scene.toml", text)).unwrap();
        scene.build().unwrap()
    }

    /// A bar that is fixed at one end and moves along its axis only: omega_k = (2k - 1) pi/2 sqrt(E/rho)/L for nu = 0
    /// (Rao, Vibration of Continuous Systems, section 9.2).
    #[test]
    fn a_bar_has_the_frequencies_of_the_wave_equation() {
        let simulation = simulation(
            "[mesh]\nblock = { cells = [2, 2, 24], size = [0.02, 0.02, 0.24] }\n[[region]]\ndensity = 1000.0\n\
             model = \"linear\"\nyoungs_modulus = 4000.0\npoissons_ratio = 0.0\n[[fixed]]\ngroup = \"bottom\"\n\
             axes = \"z\"\n[[fixed]]\ngroup = \"tissue\"\naxes = \"xy\"\n[run]\nduration = 1.0\n\
             integrator = \"newmark\"\ndt = 0.01\n",
        );
        let modes = natural_modes(&simulation, 3).unwrap();
        for (k, mode) in (1..).zip(&modes) {
            let odd = f64::from(2 * k - 1);
            let expected = odd * PI / 2.0 * (4000.0_f64 / 1000.0).sqrt() / 0.24;
            let error = mode.omega / expected - 1.0;
            assert!(error.abs() < 0.01, "{k}: {error}");
            // The share of mode k is 8/((2k - 1) pi)^2.
            let share = mode.effective_mass[2];
            let expected = 8.0 / (odd * PI).powi(2);
            assert!(
                (share / expected - 1.0).abs() < 0.05,
                "{k}: {share} {expected}"
            );
            assert!(mode.effective_mass[0] < 1e-12);
            assert!(mode.of_loads.is_nan(), "there is no load");
        }
    }

    /// A cube with equal x and y directions has pairs of bending modes, and a free body six rigid-body modes: its loads
    /// excite neither.
    #[test]
    fn multiple_modes_and_rigid_motions_are_found() {
        let cube = |support: &str| {
            simulation(&format!(
                "[mesh]\ncube = {{ cells = 2, edge = 0.1, split = \"mirrored\" }}\n[[region]]\ndensity = 1000.0\n\
                 model = \"linear\"\nyoungs_modulus = 4000.0\npoissons_ratio = 0.3\n{support}[[load]]\n\
                 group = \"top\"\npressure = 10.0\n[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n"
            ))
        };
        let held = natural_modes(&cube("[[fixed]]\ngroup = \"bottom\"\n"), 3).unwrap();
        assert!((held[0].omega / held[1].omega - 1.0).abs() < 1e-9, "a pair");
        assert!(held[2].omega > 1.05 * held[1].omega);
        // All 54 at once are those of the matrix: their squares add up to the trace of M^-1 K.
        let simulation = cube("[[fixed]]\ngroup = \"bottom\"\n");
        let all = natural_modes(&simulation, 54).unwrap();
        let operators = simulation.system().as_linear().unwrap().operators();
        let trace: f64 = (0..operators.dofs() / 3)
            .flat_map(|cell| {
                let block = operators.stiffness().block(cell, cell).unwrap();
                (0..3).map(move |axis| block[4 * axis] / operators.mass()[3 * cell + axis])
            })
            .sum();
        let sum: f64 = all.iter().map(|mode| mode.omega.powi(2)).sum();
        assert_eq!(all.len(), operators.dofs());
        assert!((sum / trace - 1.0).abs() < 1e-9, "{sum} {trace}");
        let free = natural_modes(&cube(""), 8).unwrap();
        assert!(free[..6].iter().all(|mode| mode.omega == 0.0));
        assert!(free[6].omega > 1.0);
    }

    #[test]
    fn shares_of_loads_add_up_to_one() {
        let simulation = simulation(
            "[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
             youngs_modulus = 4000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\n\
             pressure = 10.0\n[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n",
        );
        let modes = natural_modes(&simulation, 12).unwrap();
        let sum: f64 = modes.iter().map(|mode| mode.of_loads).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        // A pressure from above excites the first mode along z most.
        let most = modes
            .iter()
            .max_by(|a, b| a.of_loads.total_cmp(&b.of_loads))
            .unwrap();
        let along_z = most.effective_mass[2];
        assert!(
            along_z > most.effective_mass[0] && along_z > 0.5,
            "{along_z}"
        );

        let place = tempfile::tempdir().unwrap();
        let out = place.path().join("modes");
        write_modes(&out, &simulation, &modes).unwrap();
        let table = std::fs::read_to_string(out.join(TABLE)).unwrap();
        assert_eq!(table.lines().count(), 13);
        assert!(out.join("fields/frame-00011.vtu").exists());
        assert_eq!(check_modes_folder(&out, &[]).unwrap(), Tenant::Earlier);
    }

    /// All hyperelastic laws agree with the linear one about rest (Bonet and Wood, Nonlinear Continuum Mechanics,
    /// section 6.6).
    #[test]
    fn large_deformation_has_the_modes_of_the_linear_law_about_rest() {
        let modes = |model: &str| {
            let simulation = simulation(&format!(
                "[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"{model}\"\n\
                 youngs_modulus = 4000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\n\
                 pressure = 10.0\n[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n"
            ));
            natural_modes(&simulation, 6).unwrap()
        };
        let expected = modes("linear");
        for model in ["neo-hookean", "stvk", "corotational", "stable-neo-hookean"] {
            for (mode, expected) in modes(model).iter().zip(&expected) {
                let error = mode.omega / expected.omega - 1.0;
                assert!(error.abs() < 1e-9, "{model}: {error}");
                // Modes of the same frequency may be mixed otherwise.
                let along_z = mode.effective_mass[2] - expected.effective_mass[2];
                assert!(along_z.abs() < 1e-6, "{model}: {along_z}");
            }
        }
    }
}
