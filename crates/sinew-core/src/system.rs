//! The equation of motion as integrators see it.

use std::sync::atomic::{AtomicU64, Ordering};

use sinew_sparse::Layers;

use crate::{LinearSystem, LoadTime, State};

/// Identity of a system's matrices and laws, unique in the process.
///
/// Integrators keep factors and buffers while it stays the same; a system takes a new one
/// whenever it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Revision(u64);

impl Revision {
    /// A revision no other system has.
    #[must_use]
    #[expect(clippy::new_without_default, reason = "each call gives another value")]
    pub fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// A point at which a system is evaluated without being changed.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// When loads are taken.
    pub load: LoadTime,
    /// Step that led here (s); laws with memory need it.
    pub dt: f64,
    /// Displacement (m).
    pub u: &'a [f64],
    /// Velocity (m/s).
    pub v: &'a [f64],
}

/// Energies of a state (J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Half v' M v.
    pub kinetic: f64,
    /// Stored in deformation.
    pub elastic: f64,
}

impl Energy {
    /// Kinetic and elastic together (J).
    #[must_use]
    pub fn total(self) -> f64 {
        self.kinetic + self.elastic
    }
}

/// Sizes by which a guard cuts steps where a method knows no stable one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales<'a> {
    /// Shortest distance from each cell to a neighbour (m), one entry a cell.
    pub cell_size: &'a [f64],
}

/// A law was asked outside its domain.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("element {element}: {reason}")]
pub struct EvaluationError {
    /// Tag of the element in its mesh.
    pub element: u64,
    /// What went wrong, with the numbers.
    pub reason: String,
}

/// `M a + f_int(u, v) = f_ext(t)` with lumped M.
///
/// Evaluation changes nothing; a step that is accepted is announced once through
/// [`System::accept`].
pub trait System: Send + Sync {
    /// Length of the displacement vector.
    fn dofs(&self) -> usize;

    /// Lumped mass of each degree of freedom (kg), all positive.
    fn mass(&self) -> &[f64];

    /// Identity of the matrices and laws.
    fn revision(&self) -> Revision;

    /// `out = f_ext(t) - f_int(u, v)` (N): one sweep over all cells.
    ///
    /// # Errors
    /// [`EvaluationError`] when a law is outside its domain; `out` is then unspecified.
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError>;

    /// `out = f_ext` (N) as a step takes it.
    fn external_force(&self, when: LoadTime, out: &mut [f64]);

    /// The rate alpha (1/s) of that part of `f_int` which is `alpha M v`; central difference
    /// treats it implicitly at no cost.
    fn mass_damping(&self) -> f64 {
        0.0
    }

    /// Tells that a step was accepted and the state is its result. Called once per step; laws
    /// with memory update the state's internal variables here.
    fn accept(&self, _state: &mut State) {}

    /// Energies, where the system knows them.
    fn energy(&self, _u: &[f64], _v: &[f64]) -> Option<Energy> {
        None
    }

    /// Elements turned inside out by `u`, where the system has elements.
    fn inverted_elements(&self, _u: &[f64]) -> Option<usize> {
        None
    }

    /// Size of the body (m), where it has one: the longest edge of its bounding box.
    fn extent(&self) -> Option<f64> {
        None
    }

    /// Sizes by which a guard cuts steps, where the system has cells in space.
    fn scales(&self) -> Option<Scales<'_>> {
        None
    }

    /// Degrees of freedom of a cell: the components that turn together with the axes. A nonlinear
    /// system in space says so itself.
    fn layers(&self) -> Layers {
        self.as_linear().map_or(Layers::One, |linear| {
            linear.operators().stiffness().layers()
        })
    }

    /// Name of the cell of a degree of freedom in the user's terms, for messages.
    fn cell_name(&self, dof: usize) -> String {
        format!("degree of freedom {dof}")
    }

    /// The matrices, where the system is linear.
    fn as_linear(&self) -> Option<&dyn LinearSystem> {
        None
    }
}
