//! What a user wrote: the tables of a scene, checked one by one.

mod damping;
mod fixed;
mod initial;
mod load;
mod mesh;
mod oscillator;
mod probe;
mod ramp;
mod region;
mod run;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use sinew_fem::Problem;
use toml::de::DeTable;

pub use initial::Initial;
pub use mesh::MeshSource;
pub use oscillator::Oscillator;
pub use probe::ProbePoint;
pub use run::{RunSettings, TimeStep};

use crate::decode::value::{text, vector};
use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};
use crate::source::SceneSource;

/// A scene as its user wrote it, every key checked.
#[derive(Debug, Clone)]
pub struct Scene {
    title: String,
    subject: Subject,
    run: RunSettings,
    places: Places,
}

/// What moves in a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// A body of tetrahedra.
    Body(Body),
    /// One mass on a spring.
    Oscillator(Oscillator),
}

/// A body of tetrahedra, how it is held and what acts on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Its shape.
    pub mesh: MeshSource,
    /// Materials, damping, supports and loads.
    pub problem: Problem,
    /// The name of each load of `problem`, where it has one.
    pub load_names: Vec<Option<String>>,
    /// Its state at t = 0.
    pub initial: Vec<Initial>,
    /// Points whose motion is written down.
    pub probes: Vec<ProbePoint>,
}

/// Where the tables of a scene stand, in the order of the lists they were read into.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    pub(crate) document: Place,
    pub(crate) mesh: Option<Place>,
    pub(crate) oscillator: Option<Place>,
    pub(crate) regions: Vec<Place>,
    pub(crate) damping: Option<Place>,
    pub(crate) fixed: Vec<Place>,
    pub(crate) loads: Vec<Place>,
    pub(crate) initial: Vec<Place>,
    pub(crate) run: Place,
}

impl Places {
    /// The place of a list's item; that of the whole document where there is none.
    pub(crate) fn of<'a>(&'a self, list: &'a [Place], index: usize) -> &'a Place {
        list.get(index).unwrap_or(&self.document)
    }
}

/// The key of gravity, which is also its name among the loads.
pub(crate) const GRAVITY: &str = "gravity";

const BODY_KEYS: &[&str] = &[
    "region", "damping", "fixed", "load", GRAVITY, "initial", "probe",
];

const KEYS: &[&str] = &[
    "title",
    "mesh",
    "oscillator",
    "region",
    "damping",
    "fixed",
    "load",
    GRAVITY,
    "initial",
    "run",
    "probe",
];

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] when the file cannot be read, or as [`Scene::parse`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        match std::fs::read_to_string(path) {
            Ok(text) => Self::parse(SceneSource::new(path, text)),
            Err(error) => {
                let nothing = Arc::new(SceneSource::new(path, ""));
                Err(SceneError::new(&nothing, Fault::Unreadable(error)))
            }
        }
    }

    /// Reads a scene; opens no file.
    ///
    /// # Errors
    /// [`SceneError`] for the first thing that is not as it should be.
    pub fn parse(source: SceneSource) -> Result<Self, SceneError> {
        let source = Arc::new(source);
        let document = DeTable::parse(source.text()).map_err(|error| {
            let message = error.message().to_owned();
            let fault = SceneError::new(&source, Fault::Syntax { message });
            match error.span() {
                Some(span) => fault.at(span),
                None => fault,
            }
        })?;
        Self::read(&Table::document(&source, document.get_ref(), KEYS)?)
    }

    /// What the scene is called; empty where it has no title.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// What moves.
    #[must_use]
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// How long, by which integrator and in which steps.
    #[must_use]
    pub fn run(&self) -> &RunSettings {
        &self.run
    }

    pub(crate) fn places(&self) -> &Places {
        &self.places
    }

    /// The text the scene was read from.
    #[must_use]
    pub fn source(&self) -> &SceneSource {
        self.places.document.scene()
    }

    /// The files that the scene is made from: its own and the mesh it names. No output of a run may
    /// be one of them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        let source = self.source();
        let mut files = vec![source.path().to_owned()];
        if let Subject::Body(Body {
            mesh: MeshSource::File(written),
            ..
        }) = &self.subject
        {
            files.push(source.resolve(written));
        }
        files
    }

    /// The files that a scene file is made from, as [`Scene::input_files`], as far as they can be
    /// told of a scene with mistakes.
    #[must_use]
    pub fn input_files_of(path: &Path) -> Vec<PathBuf> {
        let text = std::fs::read(path).unwrap_or_default();
        let text = String::from_utf8_lossy(&text);
        let (document, _) = DeTable::parse_recoverable(&text);
        let mesh = document.get_ref().get("mesh");
        let file = mesh.and_then(|mesh| mesh.get_ref().as_table()?.get("file")?.get_ref().as_str());
        let source = SceneSource::new(path, "");
        let mesh = file.map(|written| source.resolve(Path::new(written)));
        std::iter::once(path.to_owned()).chain(mesh).collect()
    }

    fn read(document: &Table<'_>) -> Result<Self, SceneError> {
        let title = document
            .optional("title", "a title in quotes", text)?
            .unwrap_or_default();
        let mut places = Places {
            document: document.place().clone(),
            mesh: None,
            oscillator: None,
            regions: Vec::new(),
            damping: None,
            fixed: Vec::new(),
            loads: Vec::new(),
            initial: Vec::new(),
            run: document.place().clone(),
        };
        document.exactly_one(&["mesh", "oscillator"])?;
        let subject = match document.table("oscillator", oscillator::KEYS)? {
            Some(table) => {
                document.refuse(BODY_KEYS, "does not go with [oscillator]")?;
                let oscillator = Oscillator::read(&table)?;
                places.oscillator = Some(table.into_place());
                Subject::Oscillator(oscillator)
            }
            None => Subject::Body(Body::read(document, &mut places)?),
        };
        let run = document
            .open_table("run", run::KEYS)?
            .ok_or_else(|| document.missing("run", "a table [run]"))?;
        let settings = RunSettings::read(&run)?;
        places.run = run.into_place();
        Ok(Self {
            title,
            subject,
            run: settings,
            places,
        })
    }
}

impl Body {
    fn read(document: &Table<'_>, places: &mut Places) -> Result<Self, SceneError> {
        let mesh_table = document
            .table("mesh", mesh::KEYS)?
            .ok_or_else(|| document.missing("mesh", "a table [mesh]"))?;
        let mesh = MeshSource::read(&mesh_table)?;
        let (regions, region_places) = region::read_all(document)?;
        if regions.is_empty() {
            return Err(document.missing("region", "a table [[region]] for each material"));
        }
        let damping_table = document.table("damping", damping::KEYS)?;
        let damping = damping_table.as_ref().map(damping::read).transpose()?;
        let (fixed, fixed_places) = fixed::read_all(document)?;
        let (loads, load_names, load_places) = load::read_all(document)?;
        let gravity = document.optional(GRAVITY, "[x, y, z] in m/s2, all finite", vector)?;
        let (initial, initial_places) = initial::read_all(document, &load_names)?;
        let (probes, _) = probe::read_all(document)?;
        places.mesh = Some(mesh_table.into_place());
        places.regions = region_places;
        places.damping = damping_table.map(Table::into_place);
        places.fixed = fixed_places;
        places.loads = load_places;
        places.initial = initial_places;
        Ok(Self {
            mesh,
            problem: Problem {
                regions,
                damping: damping.unwrap_or_default(),
                fixed,
                loads,
                gravity,
            },
            load_names,
            initial,
            probes,
        })
    }
}
