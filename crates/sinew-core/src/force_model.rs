//! The simplest system with a force law.

use sinew_sparse::Layers;

use crate::revision::Revision;
use crate::system::{Equations, ForceLaw, System};

/// The simplest system with a [`ForceLaw`]: masses and the law, without internal variables.
///
/// ```
/// use sinew_core::{EvaluationError, ForceLaw, ForceModel, Layers, LoadTime, Trial};
///
/// /// A pendulum of 1 m, by its angle.
/// struct Pendulum;
///
/// impl ForceLaw for Pendulum {
///     fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
///         out[0] = -9.81 * trial.u[0].sin();
///         Ok(())
///     }
///     fn external_force(&self, _: LoadTime<'_>, _: &[f64], out: &mut [f64]) {
///         out.fill(0.0);
///     }
/// }
///
/// let system = ForceModel::new(Pendulum, &[1.0], Layers::One);
/// # let _: &dyn sinew_core::System = &system;
/// ```
#[derive(Clone, Debug)]
pub struct ForceModel<L> {
    law: L,
    mass: Vec<f64>,
    layers: Layers,
    revision: Revision,
}

impl<L> ForceModel<L> {
    /// The system of cells with these masses (kg), each the same in all layers.
    #[must_use]
    pub fn new(law: L, cell_masses: &[f64], layers: Layers) -> Self {
        let mass = cell_masses.iter();
        let mass = mass.flat_map(|mass| std::iter::repeat_n(*mass, layers.count()));
        Self {
            law,
            mass: mass.collect(),
            layers,
            revision: Revision::new(),
        }
    }

    /// The system of a law with the masses and layers of another system.
    #[must_use]
    pub fn like(system: &dyn System, law: L) -> Self {
        Self {
            law,
            mass: system.mass().to_vec(),
            layers: system.layers(),
            revision: Revision::new(),
        }
    }

    /// The law.
    #[must_use]
    pub fn law(&self) -> &L {
        &self.law
    }
}

impl<L: ForceLaw> System for ForceModel<L> {
    fn dofs(&self) -> usize {
        self.mass.len()
    }

    fn layers(&self) -> Layers {
        self.layers
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn revision(&self) -> Revision {
        self.revision
    }

    fn equations(&self) -> Equations<'_> {
        Equations::Forces(&self.law)
    }
}
