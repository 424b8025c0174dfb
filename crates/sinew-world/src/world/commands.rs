//! Commands to a world.

use std::sync::Arc;

use sinew_scene::SceneBody;

use super::{Knob, Method, World, try_step};
use crate::command::{Command, CommandError, LoadId, ToolId};
use crate::log::Entry;

/// Largest number of a pose (m or rad): far beyond any body, and far from overflow.
pub(super) const FARTHEST: f64 = 1e6;

/// Largest factor of a load.
pub(super) const STRONGEST: f64 = 1e6;

impl World {
    /// Checks a command, which takes effect with the next step, and adds it to the log.
    ///
    /// # Errors
    /// [`CommandError`] for a command that cannot be followed: the session continues as before.
    pub fn command(&mut self, command: Command) -> Result<(), CommandError> {
        if self.failure.is_some() && command != Command::Reset {
            return Err(CommandError::Failed);
        }
        self.check_words(&command)?;
        let reached = self.reached;
        match &command {
            Command::Pose {
                tool,
                position,
                rotation_vector,
            } => {
                let tool = self.tool(tool)?.place;
                self.tools[tool].target = Some((*position, *rotation_vector));
            }
            Command::Grasp { tool } | Command::Release { tool } => {
                let tool = self.tool(tool)?.place;
                let closes = matches!(command, Command::Grasp { .. });
                self.tools[tool].next_jaws = Some(closes);
            }
            Command::Forces(forces) => self.take_forces(forces)?,
            Command::LoadFactor { load, factor } => self.turn(load, *factor)?,
            Command::Integrator { id, options } => {
                let method = Method::new(&self.scene, id, options, self.method.dt)?;
                self.switch(method)?;
            }
            Command::Dt(dt) => {
                let is_parked = |parked: &mut Method| {
                    parked.dt.to_bits() == dt.to_bits() && parked.asked == self.method.asked
                };
                match self.parked.take_if(is_parked) {
                    Some(parked) => {
                        self.parked = Some(std::mem::replace(&mut self.method, parked));
                    }
                    None => {
                        let (id, options) = &self.method.asked;
                        let method = Method::new(&self.scene, id, options, *dt)?;
                        self.parked = Some(self.switch(method)?);
                    }
                }
            }
            Command::Reset => {
                self.cutter = self.scene.cutter()?;
                self.sheets.clear();
                (self.blade, self.change) = (None, None);
                self.body = Arc::clone(self.scene.body());
                self.undriven = Arc::clone(self.scene.body());
                self.topology_epoch += 1;
                self.method = Method::of_scene(&self.scene)?;
                self.parked = None;
                self.inputs.clone_from(&self.fresh);
                self.forces.is_new = false;
                for load in &mut self.loads {
                    load.next = None;
                }
                for tool in &mut self.tools {
                    (tool.target, tool.is_steered, tool.next_jaws) = (None, false, None);
                }
                self.state.clone_from(self.scene.initial_state());
                self.reached = self.state.t();
                self.failure = None;
            }
            Command::Cut { from, to } => self.sheets.push([*from, *to]),
        }
        self.log.add(self.steps, reached, command);
        Ok(())
    }

    /// Begins in the state after the last of these commands, which is a reset: the motion before it is only in the log.
    pub(crate) fn begin_at_reset(&mut self, commands: &[Entry]) -> Result<(), CommandError> {
        self.command(Command::Reset)?;
        self.log.begin_with(commands);
        self.steps = self.log.steps();
        Ok(())
    }

    /// Checks a command as far as possible before it is given: its names, its numbers and, for the first factor of a
    /// load and the first forces on nodes, support of the method for loads that are not known in advance. A failure of
    /// another method to take a step is found only when the command is given.
    ///
    /// # Errors
    /// [`CommandError`] for a command that [`World::command`] refuses as well.
    pub fn check(&self, command: &Command) -> Result<(), CommandError> {
        self.check_words(command)?;
        if matches!(command, Command::LoadFactor { .. }) && !self.drives_loads() {
            self.driven_method()?;
        }
        match command {
            Command::Forces(forces) if self.inputs.forces().next().is_none() => {
                self.try_forces(forces)
            }
            _ => Ok(()),
        }
    }

    /// Tries a step with forces (N) on nodes.
    fn try_forces(&self, forces: &[(u32, [f64; 3])]) -> Result<(), CommandError> {
        self.trial()?.next(self, forces).map(drop)
    }

    /// Checks names and numbers of a command.
    fn check_words(&self, command: &Command) -> Result<(), CommandError> {
        if self.follows {
            return Err(CommandError::Follows);
        }
        match command {
            Command::Pose {
                tool,
                position,
                rotation_vector,
            } => {
                self.tool(tool)?;
                let numbers = position.iter().chain(rotation_vector);
                // What is not a number is not within the range either.
                let beyond = |value: &&f64| !(-FARTHEST..=FARTHEST).contains(*value);
                numbers.into_iter().find(beyond).map_or(Ok(()), |value| {
                    Err(CommandError::Pose {
                        tool: tool.clone(),
                        value: *value,
                        most: FARTHEST,
                    })
                })
            }
            Command::LoadFactor { load, factor } => {
                self.load(load)?;
                match (-STRONGEST..=STRONGEST).contains(factor) {
                    true => Ok(()),
                    false => Err(CommandError::Factor {
                        load: load.clone(),
                        factor: *factor,
                        most: STRONGEST,
                    }),
                }
            }
            Command::Grasp { tool } | Command::Release { tool } => self.tool(tool).map(drop),
            Command::Dt(dt) => {
                let t = self.t();
                match dt.is_finite() && *dt > 0.0 && t + dt > t {
                    true => Ok(()),
                    false => Err(CommandError::Dt { dt: *dt, t }),
                }
            }
            Command::Cut { .. } if self.cutter.is_none() => Err(CommandError::Whole),
            Command::Cut { from, to } => {
                let numbers = from.as_flattened().iter().chain(to.as_flattened());
                let beyond = |value: &&f64| !(-FARTHEST..=FARTHEST).contains(*value);
                numbers.into_iter().find(beyond).map_or(Ok(()), |value| {
                    Err(CommandError::Cut {
                        value: *value,
                        most: FARTHEST,
                    })
                })
            }
            Command::Forces(_) | Command::Integrator { .. } | Command::Reset => Ok(()),
        }
    }

    /// Moves a tool to a pose at the end of the next step: see [`Command::Pose`]. It allocates only the entry of the
    /// log.
    ///
    /// # Errors
    /// [`CommandError`]; the session continues as before.
    pub fn steer(
        &mut self,
        tool: ToolId,
        position: [f64; 3],
        rotation_vector: [f64; 3],
    ) -> Result<(), CommandError> {
        let own = (tool.scene == self.identity.key).then(|| self.tools.get(tool.place));
        let tool = own.flatten().map(|tool| Arc::clone(&tool.name));
        self.command(Command::Pose {
            tool: tool.ok_or_else(|| self.foreign_id())?,
            position,
            rotation_vector,
        })
    }

    /// Multiplies a load by a factor from the next step on: see [`Command::LoadFactor`].
    ///
    /// # Errors
    /// [`CommandError`]; the session continues as before.
    pub fn scale_load(&mut self, load: LoadId, factor: f64) -> Result<(), CommandError> {
        let own = (load.scene == self.identity.key).then(|| self.loads.get(load.place));
        let load = own.flatten().map(|load| Arc::clone(&load.name));
        self.command(Command::LoadFactor {
            load: load.ok_or_else(|| self.foreign_id())?,
            factor,
        })
    }

    /// The factor that multiplies a load with the next step, in addition to its own course over time; `None` for the id
    /// of a world of another scene.
    #[must_use]
    pub fn load_factor(&self, load: LoadId) -> Option<f64> {
        let own = (load.scene == self.identity.key).then(|| self.loads.get(load.place));
        let Knob { channel, next, .. } = own.flatten()?;
        let given = || self.inputs.course(*channel).1.last().copied();
        Some(next.or_else(given).unwrap_or(1.0))
    }

    fn foreign_id(&self) -> CommandError {
        match self.follows {
            true => CommandError::Follows,
            false => CommandError::ForeignId,
        }
    }

    /// The tool with a name.
    ///
    /// # Errors
    /// [`CommandError::NoTool`].
    pub fn tool(&self, name: &str) -> Result<ToolId, CommandError> {
        let tools = self.body.model().tools();
        let names = || {
            tools
                .iter()
                .flat_map(|tools| tools.tools())
                .map(|tool| &tool.name)
        };
        let place = names().position(|known| known == name);
        let scene = self.identity.key;
        let id = place.map(|place| ToolId { scene, place });
        id.ok_or_else(|| CommandError::NoTool {
            name: name.to_owned(),
            known: names().cloned().collect(),
        })
    }

    /// The load with a name: that of the scene, `load 2` for the second if it has none, or `gravity`.
    ///
    /// # Errors
    /// [`CommandError::NoLoad`].
    pub fn load(&self, name: &str) -> Result<LoadId, CommandError> {
        let place = self.loads.iter().position(|load| &*load.name == name);
        let scene = self.identity.key;
        let id = place.map(|place| LoadId { scene, place });
        id.ok_or_else(|| CommandError::NoLoad {
            name: name.to_owned(),
            known: (self.loads.iter().map(|load| load.name.to_string())).collect(),
        })
    }

    fn turn(&mut self, name: &str, factor: f64) -> Result<(), CommandError> {
        let place = self.load(name)?.place;
        if !self.drives_loads() {
            (self.body, self.method) = self.driven_method()?;
            self.parked = None;
            // These loads give the forces that led to the state.
            self.state.loads = None;
        }
        self.loads[place].next = Some(factor);
        Ok(())
    }

    /// True if loads follow inputs.
    pub(super) fn drives_loads(&self) -> bool {
        !Arc::ptr_eq(&self.body, &self.undriven)
    }

    /// The body with loads that follow inputs, and the method, after a check that it can take a step.
    fn driven_method(&self) -> Result<(Arc<SceneBody>, Method), CommandError> {
        let driven = self.driven(&self.undriven)?;
        let (id, options) = &self.method.asked;
        let mut method = Method::new(&self.scene, id, options, self.method.dt)?;
        let mut state = self.state.clone();
        state.loads = None;
        let mut trial = state.clone();
        try_step(
            driven.system(),
            &self.inputs,
            &state,
            &mut trial,
            &mut method,
        )?;
        Ok((driven, method))
    }

    /// Continues with another method, if a step can be taken with it; returns the one before.
    fn switch(&mut self, mut method: Method) -> Result<Method, CommandError> {
        let Self {
            body,
            inputs,
            state,
            trial,
            ..
        } = self;
        try_step(body.system(), inputs, state, trial, &mut method)?;
        Ok(std::mem::replace(&mut self.method, method))
    }
}
