//! The equation of motion as integrators see it.

use sinew_sparse::Layers;

use crate::contact::Contact;
use crate::elastic_law::ElasticLaw;
use crate::element_forces::ElementForces;
use crate::elements::Elements;
use crate::energy::Energy;
use crate::evaluation_error::EvaluationError;
use crate::free_part::FreePart;
use crate::input::Inputs;
use crate::load_time::LoadTime;
use crate::operators::LinearOperators;
use crate::revision::Revision;
use crate::spectrum::Spectrum;
use crate::state::State;
use crate::trial::Trial;

/// Sizes by which a guard divides steps if a method knows no stable one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales<'a> {
    /// Shortest distance from each cell to a neighbour (m), one entry a cell.
    pub cell_size: &'a [f64],
}

/// `M a + f_int(u, v) = f_ext(t)` with lumped M.
///
/// Evaluation changes nothing; a step that is accepted is announced once through
/// [`System::accept`]. [`System::equations`] gives the source of the forces: a system is either its
/// matrices and loads or its own force law, never both, so that all methods see the same forces.
/// Forces from outside enter through [`crate::Inputs`].
pub trait System: Send + Sync {
    /// Length of the displacement vector.
    fn dofs(&self) -> usize;

    /// Degrees of freedom of a cell: the components that turn together with the axes.
    fn layers(&self) -> Layers;

    /// Lumped mass of each degree of freedom (kg), all positive.
    fn mass(&self) -> &[f64];

    /// Identity of the matrices and laws. Other loads or inputs do not change it.
    fn revision(&self) -> Revision;

    /// The forces.
    fn equations(&self) -> Equations<'_>;

    /// Number of internal variables, such as the viscous stresses of laws with memory; they are stored in
    /// [`State::internal`].
    fn internal_variables(&self) -> usize {
        0
    }

    /// Notifies the system that a step was accepted; the state is its result, `dt` (s) after the last accepted one.
    /// Called once per step, or per substep of a divided step; laws with memory update the state's internal variables
    /// here. To call it by hand, pass `dt = 0` for an instantaneous change and infinity for full relaxation.
    ///
    /// # Errors
    /// [`EvaluationError`] for a state outside the domain of a law with memory; the internal variables are then unspecified.
    fn accept(
        &self,
        _state: &mut State,
        _inputs: &Inputs,
        _dt: f64,
    ) -> Result<(), EvaluationError> {
        Ok(())
    }

    /// True if [`System::accept`] reads the state. If it does not, machines that store u and v in a format of their
    /// own need not write them out after each step.
    fn looks_at_steps(&self) -> bool {
        true
    }

    /// Positions of the cells at rest (m), if the system has them: machines search for rows that repeat.
    fn cell_positions(&self) -> Option<Vec<[f64; 3]>> {
        None
    }

    /// Connected parts that can still move rigidly with their supports, if the system knows them. Such motions cause no
    /// strain, so only inertia may resist them.
    fn free_parts(&self) -> Vec<FreePart> {
        Vec::new()
    }

    /// The largest stiffness of any material in compression, `lambda + 2 mu`, over the smallest of any material in
    /// shear, mu, if the system knows them: the error of rounded stiffness grows with it.
    fn stiffness_contrast(&self) -> Option<f64> {
        None
    }

    /// Contact of the system, if it has any; its cells have three layers then.
    fn contact(&self) -> Option<&dyn Contact> {
        None
    }

    /// True if the system has contact that a method must support: see [`Contact::may_be_left_out`].
    fn needs_contact(&self) -> bool {
        let contact = self.contact();
        contact.is_some_and(|contact| !contact.may_be_left_out())
    }

    /// Energies, if the system knows them.
    fn energy(&self, _u: &[f64], _v: &[f64]) -> Option<Energy> {
        None
    }

    /// Number of elements that are inside out at a time, with the displacement `u` then; `None` if the system has no
    /// elements, or follows inputs that are missing from the time.
    fn inverted_elements(&self, _when: LoadTime<'_>, _u: &[f64]) -> Option<usize> {
        None
    }

    /// Size of the body (m), if it has one: the longest edge of its bounding box.
    fn extent(&self) -> Option<f64> {
        None
    }

    /// Sizes by which a guard cuts steps, if the system has cells in space.
    fn scales(&self) -> Option<Scales<'_>> {
        None
    }

    /// Name of the cell of a degree of freedom in the user's terms, for messages.
    fn cell_name(&self, dof: usize) -> String {
        format!("degree of freedom {dof}")
    }
}

/// A [`System`] that shows its matrices.
pub trait LinearSystem: System {
    /// M, D, K and the loads.
    fn operators(&self) -> &LinearOperators;

    /// The elements that K is a sum of, if the system knows them.
    fn elements(&self) -> Option<&dyn Elements> {
        None
    }
}

/// Source of the forces of a system.
#[derive(Clone, Copy)]
pub enum Equations<'a> {
    /// Matrices and loads.
    Linear(&'a dyn LinearSystem),
    /// A law that is evaluated.
    Forces(&'a dyn ForceLaw),
}

/// Forces of a system that shows no matrices.
pub trait ForceLaw: Send + Sync {
    /// `out = f_ext(t) - f_int(u, v)` (N), with the loads at `trial.load`: one sweep over all
    /// cells.
    ///
    /// # Errors
    /// [`EvaluationError`] when the law is outside its domain; `out` is then unspecified.
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError>;

    /// `out = f_ext` (N) as a step takes it, with the displacement `u` (m): loads may follow the surface.
    fn external_force(&self, when: LoadTime<'_>, u: &[f64], out: &mut [f64]);

    /// The rate alpha (1/s) of that part of `f_int` which is `alpha M v`; central difference
    /// treats it implicitly at no cost.
    fn mass_damping(&self) -> f64 {
        0.0
    }

    /// Fingerprint that distinguishes this law from others on the same masses, such as a hash of its parameters: the
    /// same in every process.
    fn fingerprint(&self) -> u64 {
        0
    }

    /// The energy behind the forces and its tangent, if the law has one.
    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        None
    }

    /// Its forces as sums over elements, if machines with threads and vectors can compute them.
    fn element_forces(&self) -> Option<&dyn ElementForces> {
        None
    }

    /// Bounds of the fastest motions about a state, or about rest, from which stable steps follow;
    /// `None` if they are unknown. About rest to some digits; about a state, which is requested during runs, an
    /// estimate to a few per cent will do.
    fn spectrum(&self, _about: Option<&State>) -> Option<Spectrum> {
        None
    }
}

impl<'s> dyn System + 's {
    /// The matrices, if the system is linear.
    #[must_use]
    pub fn as_linear(&self) -> Option<&dyn LinearSystem> {
        match self.equations() {
            Equations::Linear(linear) => Some(linear),
            Equations::Forces(_) => None,
        }
    }

    /// The elastic law, if the system has one; matrices are one.
    #[must_use]
    pub fn as_elastic(&self) -> Option<&dyn ElasticLaw> {
        match self.equations() {
            Equations::Linear(linear) => Some(linear.operators()),
            Equations::Forces(law) => law.elastic(),
        }
    }

    /// `out = f_ext(t) - f_int(u, v)` (N): one sweep over all cells.
    ///
    /// # Errors
    /// [`EvaluationError`] when a law is outside its domain; `out` is then unspecified.
    pub fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        match self.equations() {
            Equations::Linear(linear) => {
                linear
                    .operators()
                    .net_force(trial.load, trial.u, trial.v, out);
                Ok(())
            }
            Equations::Forces(law) => law.net_force(trial, out),
        }
    }

    /// `out = f_ext` (N) as a step takes it, with the displacement `u` (m), which has no effect in linear systems.
    pub fn external_force(&self, when: LoadTime<'_>, u: &[f64], out: &mut [f64]) {
        match self.equations() {
            Equations::Linear(linear) => linear.operators().external_force(when, out),
            Equations::Forces(law) => law.external_force(when, u, out),
        }
    }

    /// The rate alpha (1/s) of damping that is `alpha M v`.
    #[must_use]
    pub fn mass_damping(&self) -> f64 {
        match self.equations() {
            Equations::Linear(linear) => linear.operators().damping().mass,
            Equations::Forces(law) => law.mass_damping(),
        }
    }

    /// The fastest motions about a state, or about rest; `None` if they are unknown.
    #[must_use]
    pub fn spectrum(&self, about: Option<&State>) -> Option<Spectrum> {
        match self.equations() {
            Equations::Linear(linear) => Some(Spectrum::of(linear.operators())),
            Equations::Forces(law) => law.spectrum(about),
        }
    }
}

/// Identity of the matrices and of the loads of a linear system.
pub(crate) fn loads_revision(system: &dyn System) -> Option<[Revision; 2]> {
    let operators = system.as_linear()?.operators();
    Some([operators.revision(), operators.loads_revision()])
}
