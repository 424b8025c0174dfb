//! Methods and lengths of the steps of a run.

use serde::Serialize;
use serde_json::Value;
use sinew_core::Options;
use sinew_scene::{Simulation, options_json};
use sinew_world::Course;

/// Text instead of the name of a method if there were several.
const SEVERAL: &str = "several";

/// Methods and lengths of the steps of a run: both may change in a session that is replayed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Stepping {
    /// Ids and options, in the order of their first steps.
    methods: Vec<(String, Options)>,
    dt: f64,
    has_one_length: bool,
}

impl Stepping {
    /// Stepping of a run, which follows its scene.
    pub(crate) fn of_scene(simulation: &Simulation) -> Self {
        Self {
            methods: vec![(
                simulation.settings().integrator.clone(),
                simulation.options(),
            )],
            dt: simulation.dt(),
            has_one_length: true,
        }
    }

    /// Stepping of a session.
    pub(crate) fn of_session(course: &Course, simulation: &Simulation) -> Self {
        let methods = course.methods.iter();
        let methods = methods.map(|(id, options)| (id.clone(), simulation.options_of(id, options)));
        Self {
            methods: methods.collect(),
            dt: course.dt,
            has_one_length: course.has_one_length,
        }
    }

    /// The mean length (s) of the steps.
    #[must_use]
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// The length of the steps, such as "0.001 s".
    #[must_use]
    pub fn length_in_words(&self) -> String {
        match self.has_one_length {
            true => format!("{} s", self.dt),
            false => format!("{:.3e} s on average", self.dt),
        }
    }

    /// Names of the methods, such as "`newmark`".
    #[must_use]
    pub fn methods_in_words(&self) -> String {
        let ids = self.ids();
        let quoted: Vec<String> = ids.iter().map(|id| format!("`{id}`")).collect();
        match quoted.len() {
            1 => quoted.concat(),
            _ => format!("{SEVERAL} methods, {}", quoted.join(" and ")),
        }
    }

    /// The name of the method, or [`SEVERAL`].
    pub(crate) fn method(&self) -> &str {
        match self.ids()[..] {
            [id] => id,
            _ => SEVERAL,
        }
    }

    /// The options of the method; null if they were not the same in all steps.
    pub(crate) fn options(&self) -> Value {
        match &self.methods[..] {
            [(_, options)] => options_json(options).into_iter().collect(),
            _ => Value::Null,
        }
    }

    /// The different names.
    fn ids(&self) -> Vec<&str> {
        let mut ids: Vec<&str> = Vec::new();
        for (id, _) in &self.methods {
            if !ids.contains(&id.as_str()) {
                ids.push(id);
            }
        }
        ids
    }
}
