//! The tables of a scene in the user's text, checked one by one.

mod cutting;
mod damping;
mod document;
mod field;
mod fixed;
mod from_mesh;
mod from_value;
mod group_name;
mod initial;
mod load;
mod mesh;
mod model;
mod motion;
mod oscillator;
mod output;
mod place;
mod place_data;
mod probe;
mod ramp;
mod region;
mod run;
mod selected;
mod solid;
mod tissue;
mod tool;
mod tool_body;
mod tool_shape;

use std::borrow::Cow;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sinew_core::Ramp;
use sinew_fem::Problem;
use toml::de::DeTable;

use crate::keys::GRAVITY;
pub use cutting::{Blade, Cutting, Lips, LoosePieces};
pub(crate) use document::DOCUMENT;
use document::{
    CUTTING_TABLE, DAMPING_TABLE, GRAVITY_VECTOR, INITIAL_STATES, LOADS, MESH_TABLE, MOTIONS,
    OSCILLATOR_TABLE, OUTPUT_TABLE, PROBES, REGIONS, RUN_TABLE, SUPPORTS, TITLE, TOOLS,
};
pub use initial::Initial;
pub use mesh::{MeshChanges, MeshSource, Rotation};
pub use motion::{Motion, Way};
pub use oscillator::Oscillator;
pub use output::{Instants, OutputSettings};
pub use probe::{ProbeAt, ProbePoint, Quantity};
pub(crate) use run::{INTEGRATOR, RUN};
pub use run::{RunSettings, TimeStep};
use selected::Selections;
pub use selected::{Choice, Members, Selected};
pub(crate) use tool::ToolPlace;
pub use tool::{Grasp, StartsInside, Tool, ToolBody, ToolPath, ToolStart};
pub(crate) use tool_shape::FARTHEST;
pub use tool_shape::{ToolPart, ToolShape};

use crate::decode::{Place, Table};
use crate::error::{Fault, SceneError};
use crate::source::{SceneSource, text_of};

/// The scene in the user's text, with every key checked.
#[derive(Debug, Clone)]
pub struct Scene {
    title: String,
    subject: Subject,
    settings: RunSettings,
    output: OutputSettings,
    places: Places,
}

/// The moving subject of a scene.
#[derive(Debug, Clone, PartialEq)]
pub enum Subject {
    /// A body of tetrahedra.
    Body(Box<Body>),
    /// One mass on a spring.
    Oscillator(Oscillator),
}

/// A body of tetrahedra with its supports, motions, loads and initial state.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The source of its shape.
    pub mesh: MeshSource,
    /// Changes of size, orientation and order between the source and the body.
    pub mesh_changes: MeshChanges,
    /// Materials, damping, supports and loads. Prescribed motions, which may be in files, are added when the scene is
    /// built: see [`crate::BodyModel::problem`].
    pub problem: Problem,
    /// Parts that are moved.
    pub motions: Vec<Motion>,
    /// Rigid tools that press on it.
    pub tools: Vec<Tool>,
    /// Cutting of the body; `None` if it stays whole.
    pub cutting: Option<Cutting>,
    /// The CSV file of the factor of each load of `problem`, as written, if it is in one. `problem` has the factor
    /// after the scene is built.
    pub load_files: Vec<Option<PathBuf>>,
    /// The name of each load of `problem`, if it has one.
    pub load_names: Vec<Option<String>>,
    /// Its state at t = 0.
    pub initial: Vec<Initial>,
    /// Points whose motion is written down.
    pub probes: Vec<ProbePoint>,
    /// Parts chosen by position. They become groups of the mesh, whose names the lists above use.
    pub selected: Vec<Selected>,
}

/// The places of the tables of a scene, in the order of the lists they were read into.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    pub(crate) document: Place,
    pub(crate) mesh: Option<Place>,
    pub(crate) oscillator: Option<Place>,
    pub(crate) regions: Vec<Place>,
    pub(crate) damping: Option<Place>,
    pub(crate) fixed: Vec<Place>,
    pub(crate) motions: Vec<Place>,
    pub(crate) tools: Vec<ToolPlace>,
    pub(crate) cutting: Option<Place>,
    pub(crate) loads: Vec<Place>,
    pub(crate) initial: Vec<Place>,
    pub(crate) probes: Vec<Place>,
    pub(crate) selected: Vec<Place>,
    pub(crate) run: Place,
}

impl Places {
    /// The place of a list's item, or of the whole document if the list has no such item.
    pub(crate) fn of<'a>(&'a self, list: &'a [Place], index: usize) -> &'a Place {
        list.get(index).unwrap_or(&self.document)
    }

    /// The place of a tool, or of the whole document if there is no such tool.
    pub(crate) fn of_tool(&self, index: usize) -> &Place {
        self.tools
            .get(index)
            .map_or(&self.document, |place| &place.table)
    }
}

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] when the file cannot be read, and the errors of [`Scene::parse`].
    pub fn load(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        Self::load_with::<&str>(path, &[])
    }

    /// Reads a scene file with other values; see [`SceneSource::with_values`].
    ///
    /// # Errors
    /// Same as [`Scene::load`], and an error if a value cannot be set.
    pub fn load_with<T: AsRef<str>>(
        path: impl AsRef<Path>,
        values: &[T],
    ) -> Result<Self, SceneError> {
        let path = path.as_ref();
        match text_of(path) {
            Ok(text) => Self::parse_with(&SceneSource::new(path, text), values),
            Err(error) => {
                let nothing = Arc::new(SceneSource::new(path, ""));
                Err(SceneError::new(&nothing, Fault::Unreadable(error)))
            }
        }
    }

    /// Reads a scene with other values, as [`Scene::load_with`] does; opens no file.
    ///
    /// # Errors
    /// Same as [`Scene::load_with`].
    pub fn parse_with<T: AsRef<str>>(
        source: &SceneSource,
        values: &[T],
    ) -> Result<Self, SceneError> {
        match source.with_values(values) {
            Ok(source) => Self::parse(source),
            Err(error) => {
                let source = Arc::new(source.clone());
                Err(SceneError::new(&source, Fault::Override(error)))
            }
        }
    }

    /// Reads a scene; opens no file.
    ///
    /// # Errors
    /// [`SceneError`] for the first mistake found.
    pub fn parse(source: SceneSource) -> Result<Self, SceneError> {
        let source = Arc::new(source);
        let document = DeTable::parse(source.text()).map_err(|error| {
            let message = error.message().to_owned();
            let fault = SceneError::new(&source, Fault::Syntax { message });
            let fault = match has_unit(source.text(), error.span()) {
                true => fault.with_help(WITHOUT_UNITS),
                false => fault,
            };
            match error.span() {
                Some(span) => fault.at(span),
                None => fault,
            }
        })?;
        Self::read(&Table::document(&source, document.get_ref(), &DOCUMENT)?)
    }

    /// The title; empty if the scene has none.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The title; the path of the file if the scene has none.
    #[must_use]
    pub fn title_or_path(&self) -> Cow<'_, str> {
        match self.title.as_str() {
            "" => self.source().path().to_string_lossy(),
            title => title.into(),
        }
    }

    /// The moving subject.
    #[must_use]
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// True if a tool (0-based) cuts its body or removes parts of it, so that it touches nothing.
    pub(crate) fn is_cut_by(&self, tool: usize) -> bool {
        match &self.subject {
            Subject::Body(body) => body.is_cut_by(tool),
            Subject::Oscillator(_) => false,
        }
    }

    /// Duration, integrator and steps.
    #[must_use]
    pub fn settings(&self) -> &RunSettings {
        &self.settings
    }

    /// The outputs of a run of this scene.
    #[must_use]
    pub fn output(&self) -> &OutputSettings {
        &self.output
    }

    /// The scene with the factors of loads and motions that are in files, each read by `read`.
    pub(crate) fn with_factors(
        mut self,
        read: impl Fn(&SceneSource, &Path) -> Result<Ramp, Fault>,
    ) -> Result<Self, SceneError> {
        let Self {
            subject, places, ..
        } = &mut self;
        let Subject::Body(body) = subject else {
            return Ok(self);
        };
        let read_at = |place: &Place, key: &str, written: &Path| {
            read(place.scene(), written).map_err(|fault| place.value_fault(key, fault))
        };
        let loads = body.problem.loads.iter_mut().zip(&body.load_files);
        for (index, (load, file)) in loads.enumerate() {
            if let Some(written) = file {
                let place = places.of(&places.loads, index);
                load.ramp = read_at(place, load::RAMP_OF_LOAD.name, written)?;
            }
        }
        for (index, motion) in body.motions.iter_mut().enumerate() {
            if let (Some(written), Way::Displacement(_, ramp)) =
                (&motion.ramp_file, &mut motion.way)
            {
                let place = places.of(&places.motions, index);
                *ramp = read_at(place, motion::RAMP_OF_MOTION.name, written)?;
            }
        }
        Ok(self)
    }

    pub(crate) fn places(&self) -> &Places {
        &self.places
    }

    /// The text from which the scene was read.
    #[must_use]
    pub fn source(&self) -> &SceneSource {
        self.places.document.scene()
    }

    /// The files that the scene is read from: its own, and the mesh and the tables it names. No output of a run
    /// may replace one of them.
    #[must_use]
    pub fn input_files(&self) -> Vec<PathBuf> {
        let source = self.source();
        let mut files = vec![source.path().to_owned()];
        if let Subject::Body(body) = &self.subject {
            let Body {
                mesh,
                motions,
                tools,
                cutting,
                load_files,
                ..
            } = &**body;
            if let MeshSource::File(written) = mesh {
                files.push(source.resolve(written));
            }
            files.extend(motions.iter().filter_map(|motion| match &motion.way {
                Way::Table(written) => Some(source.resolve(written)),
                Way::Displacement(..) | Way::Velocity(_) => None,
            }));
            files.extend(tools.iter().filter_map(|tool| match &tool.path {
                ToolPath::Table(written) => Some(source.resolve(written)),
                ToolPath::Hold(_) | ToolPath::Velocity(..) => None,
            }));
            if let Some(Blade::Table(written)) = cutting.as_ref().map(|cutting| &cutting.blade) {
                files.push(source.resolve(written));
            }
            let factors = motions.iter().map(|motion| &motion.ramp_file);
            let factors = load_files.iter().chain(factors).flatten();
            files.extend(factors.map(|written| source.resolve(written)));
        }
        files
    }

    /// The files that a scene is read from, as [`Scene::input_files`], also for a scene with mistakes, as
    /// far as they can be found.
    #[must_use]
    pub fn input_files_of(path: &Path) -> Vec<PathBuf> {
        let text = text_of(path).unwrap_or_default();
        let (document, _) = DeTable::parse_recoverable(&text);
        let of_table = |table: &str, key: &str| -> Option<&str> {
            let table = document.get_ref().get(table)?.get_ref().as_table()?;
            table.get(key)?.get_ref().as_str()
        };
        let file = of_table(MESH_TABLE.name, mesh::FILE.name);
        let strokes = of_table(CUTTING_TABLE.name, cutting::TABLE.name);
        // The value at these keys, each in the table of the one before, of all tables of a list.
        let of_list = |list: &str, keys: &[&str]| -> Vec<&str> {
            let tables = document.get_ref().get(list);
            let tables = tables.and_then(|tables| tables.get_ref().as_array());
            let tables = tables.into_iter().flat_map(|tables| tables.iter());
            let named = tables.filter_map(|table| {
                let value = keys.iter().try_fold(table.get_ref(), |value, key| {
                    Some(value.as_table()?.get(*key)?.get_ref())
                });
                value?.as_str()
            });
            named.collect()
        };
        let motions = of_list(MOTIONS.name, &[motion::TABLE.name]);
        let tools = of_list(TOOLS.name, &[tool::TABLE.name]);
        let factors = [
            (LOADS.name, load::RAMP_OF_LOAD.name),
            (MOTIONS.name, motion::RAMP_OF_MOTION.name),
        ];
        let factors = factors.map(|(list, ramp)| of_list(list, &[ramp, ramp::FILE.name]));
        let source = SceneSource::new(path, "");
        let named = file.into_iter().chain(motions).chain(tools).chain(strokes);
        let named = named.chain(factors.into_iter().flatten());
        let named = named.map(|written| source.resolve(Path::new(written)));
        std::iter::once(path.to_owned()).chain(named).collect()
    }

    fn read(document: &Table<'_>) -> Result<Self, SceneError> {
        let title = document.read(&TITLE)?.unwrap_or_default();
        let mut places = Places {
            document: document.place().clone(),
            mesh: None,
            oscillator: None,
            regions: Vec::new(),
            damping: None,
            fixed: Vec::new(),
            motions: Vec::new(),
            tools: Vec::new(),
            cutting: None,
            loads: Vec::new(),
            initial: Vec::new(),
            probes: Vec::new(),
            selected: Vec::new(),
            run: document.place().clone(),
        };
        let subject = match document.exactly_one()? {
            key if key == OSCILLATOR_TABLE.name => {
                let table = document.table(&OSCILLATOR_TABLE)?;
                document.check_conditions()?;
                let oscillator = Oscillator::read(&table)?;
                places.oscillator = Some(table.into_place());
                Subject::Oscillator(oscillator)
            }
            _ => Subject::Body(Box::new(Body::read(document, &mut places)?)),
        };
        let run = document.open_table(&RUN_TABLE)?;
        let settings = RunSettings::read(&run)?;
        places.run = run.into_place();
        let output = document.table(&OUTPUT_TABLE)?;
        let output = output.as_ref().map(OutputSettings::read).transpose()?;
        Ok(Self {
            title,
            subject,
            settings,
            output: output.unwrap_or_default(),
            places,
        })
    }
}

impl Body {
    /// A load (0-based) in the terms of the scene.
    pub(crate) fn load_in_words(&self, index: usize) -> String {
        match (self.problem.loads.get(index), self.load_names.get(index)) {
            (_, Some(Some(name))) => format!("[[load]] \"{name}\""),
            (Some(load), _) => format!("[[load]] {} on {}", index + 1, load.on),
            (None, _) => format!("[[load]] {}", index + 1),
        }
    }

    /// A motion (0-based) in the terms of the scene.
    pub(crate) fn motion_in_words(&self, index: usize) -> String {
        match self.motions.get(index) {
            Some(motion) => format!("[[move]] {} of `{}`", index + 1, motion.group),
            None => format!("[[move]] {}", index + 1),
        }
    }

    /// True if a tool (0-based) cuts the body or removes parts of it, so that it touches nothing.
    #[must_use]
    pub fn is_cut_by(&self, tool: usize) -> bool {
        let is_scissors = self.tools.get(tool).is_some_and(Tool::is_scissors);
        let cutting = self.cutting.as_ref();
        cutting.is_some_and(|cutting| is_scissors || cutting.is_by(tool))
    }

    fn read(document: &Table<'_>, places: &mut Places) -> Result<Self, SceneError> {
        let mesh_table = document.table(&MESH_TABLE)?;
        let mesh = MeshSource::read(&mesh_table)?;
        let mesh_changes = MeshChanges::read(&mesh_table)?;
        let mut selections = Selections::default();
        let (regions, region_places) =
            region::read_all(document.tables(&REGIONS)?, &mut selections)?;
        let damping_table = document.table(&DAMPING_TABLE)?;
        let damping = damping_table.as_ref().map(damping::read).transpose()?;
        let (fixed, fixed_places) = fixed::read_all(document.tables(&SUPPORTS)?, &mut selections)?;
        let (motions, motion_places) =
            motion::read_all(document.tables(&MOTIONS)?, &mut selections)?;
        let (tools, tool_places) = tool::read_all(document.tables(&TOOLS)?)?;
        let cutting_table = document.table(&CUTTING_TABLE)?;
        let cutting = cutting_table.as_ref();
        let cutting = cutting
            .map(|table| cutting::read(table, &tools))
            .transpose()?;
        cutting::check_tools(&tools, cutting.as_ref(), &tool_places)?;
        let is_large = regions.iter().any(|region| region.law.is_hyperelastic());
        let loads = load::read_all(document.tables(&LOADS)?, is_large, &mut selections)?;
        let gravity = document.read(&GRAVITY_VECTOR)?;
        let mut names: Vec<String> = loads.names.iter().flatten().cloned().collect();
        names.extend(gravity.map(|_| GRAVITY.to_owned()));
        let initial = document.tables(&INITIAL_STATES)?;
        let (initial, initial_places) = initial::read_all(initial, &names, &mut selections)?;
        let (probes, probe_places) = probe::read_all(document.tables(&PROBES)?, &mut selections)?;
        places.mesh = Some(mesh_table.into_place());
        places.regions = region_places;
        places.damping = damping_table.map(Table::into_place);
        places.fixed = fixed_places;
        places.motions = motion_places;
        places.tools = tool_places;
        places.cutting = cutting_table.map(Table::into_place);
        places.loads = loads.places;
        places.initial = initial_places;
        places.probes = probe_places;
        places.selected = selections.places;
        Ok(Self {
            mesh,
            mesh_changes,
            problem: Problem {
                regions,
                damping: damping.unwrap_or_default(),
                fixed,
                moves: Vec::new(),
                loads: loads.specs,
                gravity,
            },
            motions,
            tools,
            cutting,
            load_files: loads.files,
            load_names: loads.names,
            initial,
            probes,
            selected: selections.parts,
        })
    }
}

/// Help for a number with a unit.
const WITHOUT_UNITS: &str =
    "numbers have no units: they are in m, kg, s, N and Pa, so 6 kPa is 6000.0";

/// True if the line of an error has a number that is followed by a unit.
fn has_unit(text: &str, span: Option<Range<usize>>) -> bool {
    let line = span.and_then(|span| {
        let before = text.get(..span.start)?;
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        text[start..].lines().next()
    });
    let Some((_, value)) = line.and_then(|line| line.split_once('=')) else {
        return false;
    };
    let value = value.trim_start();
    let unit = value.trim_start_matches(|c: char| c.is_ascii_digit() || "+-._".contains(c));
    let is_number = value.len() > unit.len();
    is_number
        && unit
            .trim_start()
            .starts_with(|c: char| c.is_alphabetic() || c == '%')
}
