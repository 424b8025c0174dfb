//! Data that a simulation publishes for the loop of a device after each step.

/// A tool after a step, and the resistance of the tissue at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// The time (s) of the simulation at which these data are valid.
    pub t: f64,
    /// The length (s) of the step that ended at this time.
    pub dt: f64,
    /// Number of steps so far.
    pub steps: u64,
    /// Position (m) of the tool's origin.
    pub position: [f64; 3],
    /// Rotation vector (rad) of the tool.
    pub rotation_vector: [f64; 3],
    /// Velocity (m/s) of the tool's origin.
    pub velocity: [f64; 3],
    /// Spin (rad/s) of the tool.
    pub spin: [f64; 3],
    /// The force (N) of the tissue on the tool.
    pub force: [f64; 3],
    /// Its torque (N m) about the tool's origin.
    pub torque: [f64; 3],
    /// The force (N) by which the tissue resists a slow displacement of the tool, over that displacement (m):
    /// symmetric, without negative eigenvalues.
    pub stiffness: [[f64; 3]; 3],
    /// True if the tissue may also pull, for example because a tool grasps it.
    pub may_pull: bool,
}

impl Published {
    /// A tool at a position (m) that touches nothing, before the first step.
    #[must_use]
    pub fn free_at(position: [f64; 3]) -> Self {
        Self {
            t: 0.0,
            dt: 0.0,
            steps: 0,
            position,
            rotation_vector: [0.0; 3],
            velocity: [0.0; 3],
            spin: [0.0; 3],
            force: [0.0; 3],
            torque: [0.0; 3],
            stiffness: [[0.0; 3]; 3],
            may_pull: false,
        }
    }
}

/// The motion of a device, for the simulation at the beginning of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceMotion {
    /// Position (m).
    pub position: [f64; 3],
    /// Rotation vector (rad).
    pub rotation_vector: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
}

impl DeviceMotion {
    /// A device at rest.
    #[must_use]
    pub fn at(position: [f64; 3]) -> Self {
        Self {
            position,
            rotation_vector: [0.0; 3],
            velocity: [0.0; 3],
        }
    }
}

/// A simulation with a tool that a device moves.
pub trait Simulated {
    /// A step that cannot be taken.
    type Error;

    /// The length (s) of each step.
    fn dt(&self) -> f64;

    /// Takes one step with the current motion of the device, and returns the tool at its end.
    ///
    /// # Errors
    /// If the step cannot be taken.
    fn step(&mut self, device: &DeviceMotion) -> Result<Published, Self::Error>;
}
