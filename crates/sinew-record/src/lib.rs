//! Results of a run of a scene: fields, tables, summary, report, and a checkpoint from which it can be continued.
//!
//! A run writes into its own folder ([`RunFolder`]). Everything in it is a function of the scene and the number of
//! steps taken, except for one object in `summary.json` about the computer; so a run that was killed and continued
//! leaves the same bytes as an uninterrupted one.
//!
//! | file | content |
//! | --- | --- |
//! | `fields.pvd`, `fields/` | displacement, velocity, strain, stress, tool forces and pressures, as `[output]` asks |
//! | `surface.vtu` | the boundary at rest, with the groups of triangles on it |
//! | `probes.csv` | displacements (m) of the probes |
//! | `energy.csv` | the balance of energy (J) |
//! | `reactions.csv` | forces (N) and moments (N m) of supports and moved parts |
//! | `tools.csv` | positions of tools, forces (N) and torques (N m) on them, their work (J) and contacts |
//! | `summary.json` | outcome, extremes, work, warnings, and all that is needed to repeat it |
//! | `report.html` | warnings, pictures of the body, curves |
//! | `run.json`, `scene.toml` | the request and the scene of the run |
//! | `checkpoint.bin` | the state of an unfinished run |
//!
//! `docs/run-folder.md` in the repository names every column, array and key.
//!
//! ```
//! use sinew_record::{Ended, Request, RunFolder};
//! use sinew_scene::{Scene, SceneSource};
//! use sinew_world::World;
//!
//! let text = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.1\nvelocity = 1.0\n[run]\nduration = 1.0\n\
//!             integrator = \"newmark\"\ndt = 0.01\n";
//! let simulation = Scene::parse(SceneSource::new("spring.toml", text))?.build()?;
//! let place = tempfile::tempdir()?;
//! let folder = RunFolder::create(&place.path().join("spring"), &simulation, &Request::default())?;
//! let integrator = simulation.integrator()?;
//! let end = folder.run(&mut World::following(simulation, integrator)?, &mut ())?;
//! assert_eq!(end.ended, Ended::Finished);
//! assert!(place.path().join("spring/energy.csv").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod balance;
mod checkpoint;
mod companion;
mod compare;
mod contact_fields;
mod csv;
mod cut_words;
mod energy_loss;
mod error;
mod fast_loads;
mod fields;
mod folder_size;
mod frame_looks;
mod frame_writer;
mod frames;
mod growth;
mod instruments;
mod laws;
mod made_energy;
#[cfg(feature = "implicit")]
mod modes;
mod pace;
mod progress;
mod recorder;
mod replay;
mod report;
mod request;
mod run_end;
mod run_folder;
mod seal;
mod stepping;
mod summary;
mod surface;
mod tables;
mod taken_energy;
mod tool_rows;

pub use companion::Companion;
pub use compare::{CompareError, Comparison, Difference, compare};
pub use cut_words::words_of_cuts;
pub use energy_loss::EnergyLoss;
pub use error::RecordRunError;
pub use folder_size::FolderSize;
pub use frame_looks::{FrameLooks, Looked};
pub use growth::EnergyGrowth;
pub use instruments::Instruments;
pub use laws::{
    AskedCurves, LawCurvesError, Measured, MeasuredError, MeasuredFault, RegionCurves,
    check_curves_folder, curves_of_laws, is_curves_file, picture_of_law, table_of_laws,
    words_of_law, write_curves,
};
#[cfg(feature = "implicit")]
pub use modes::{ModesError, NaturalMode, check_modes_folder, natural_modes, write_modes};
pub use pace::Pace;
pub use request::Request;
pub use run_end::{Ended, RunEnd};
pub use run_folder::{MOST_NUMBERS, RunFolder};
pub use stepping::Stepping;
pub use tables::column_name;
