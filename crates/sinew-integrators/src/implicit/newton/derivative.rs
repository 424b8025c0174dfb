//! The derivative of a step's equations by products.

use sinew_core::vectors::{add_scaled, scale};
use sinew_core::{ElasticLaw, EvaluationError, LoadTime, System, TangentKind, Trial, Velocities};

use super::by_products::Products;

/// `M + d D + k K` at a point.
pub(super) struct Derivative<'s> {
    pub(super) law: &'s dyn ElasticLaw,
    pub(super) mass: &'s [f64],
    /// d and k.
    pub(super) coefficients: [f64; 2],
    /// The point.
    pub(super) at: Trial<'s>,
    /// The point at which stiffness damping acts.
    pub(super) viscous_at: Trial<'s>,
}

impl Derivative<'_> {
    /// `out`: product of the derivative of a kind, without its unsymmetric part; needs scratch space of the same
    /// length.
    pub(super) fn product(
        &self,
        kind: TangentKind,
        change: &[f64],
        beside: &mut [f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let [d, k] = self.coefficients;
        self.law.tangent_product(&self.at, kind, change, out)?;
        if kind == TangentKind::Exact && self.law.loads_follow() {
            self.law.add_load_product(&self.at, 1.0, change, out);
        }
        let of_mass = self.of_mass();
        for (out, (mass, change)) in out.iter_mut().zip(self.mass.iter().zip(change)) {
            *out = k * *out + of_mass * mass * change;
        }
        let damping = self.law.damping();
        if let Some(extra) = &damping.extra {
            extra.subtract_scaled_product(-d, change, out);
        }
        if damping.stiffness != 0.0 {
            let cells = Velocities::Cells(change);
            self.law.viscous_force(&self.viscous_at, cells, beside)?;
            add_scaled(d, beside, out);
        }
        Ok(())
    }

    /// `out`: diagonal blocks of the cells without inertia, or larger blocks.
    pub(super) fn blocks(&self, out: &mut [f64]) -> Result<(), EvaluationError> {
        let [d, k] = self.coefficients;
        self.law.node_blocks(&self.at, out)?;
        scale(out, k);
        self.law.add_viscous_blocks(&self.viscous_at, d, out)?;
        if let Some(extra) = &self.law.damping().extra {
            let entries = out.len() / extra.pattern().cells();
            for (cell, out) in out.chunks_exact_mut(entries).enumerate() {
                if let Some(block) = extra.block(cell, cell) {
                    add_scaled(d, block, out);
                }
            }
        }
        Ok(())
    }

    /// Contribution of inertia to the diagonal of the blocks.
    pub(super) fn inertia(&self, dof: usize) -> f64 {
        self.of_mass() * self.mass[dof]
    }

    /// Sweeps that a product takes.
    pub(super) fn sweeps(law: &dyn ElasticLaw) -> u64 {
        2 + u64::from(law.damping().stiffness != 0.0)
    }

    fn of_mass(&self) -> f64 {
        1.0 + self.coefficients[0] * self.law.damping().mass
    }
}

/// The derivative at rest, which is the same for all steps.
pub(super) struct AtRest<'s> {
    law: &'s dyn ElasticLaw,
    mass: &'s [f64],
    coefficients: [f64; 2],
    dt: f64,
    zeros: Vec<f64>,
    internal: Vec<f64>,
    beside: Vec<f64>,
}

impl<'s> AtRest<'s> {
    /// The derivative for steps of `dt` (s) with these coefficients d and k.
    pub(super) fn new(
        system: &'s dyn System,
        law: &'s dyn ElasticLaw,
        dt: f64,
        coefficients: [f64; 2],
    ) -> Self {
        let zeros = vec![0.0; system.dofs()];
        Self {
            law,
            mass: system.mass(),
            coefficients,
            dt,
            internal: vec![0.0; system.internal_variables()],
            beside: zeros.clone(),
            zeros,
        }
    }

    fn derivative(&self) -> Derivative<'_> {
        let at = Trial {
            load: LoadTime::at(0.0),
            dt: self.dt,
            u: &self.zeros,
            v: &self.zeros,
            internal: &self.internal,
        };
        Derivative {
            law: self.law,
            mass: self.mass,
            coefficients: self.coefficients,
            at,
            viscous_at: at,
        }
    }
}

impl Products for AtRest<'_> {
    fn product(
        &mut self,
        kind: TangentKind,
        change: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let mut beside = std::mem::take(&mut self.beside);
        let found = self.derivative().product(kind, change, &mut beside, out);
        self.beside = beside;
        found
    }

    fn sweeps(&self) -> u64 {
        Derivative::sweeps(self.law)
    }

    fn blocks(&mut self, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.derivative().blocks(out)
    }

    fn inertia(&self, dof: usize) -> f64 {
        self.derivative().inertia(dof)
    }
}
