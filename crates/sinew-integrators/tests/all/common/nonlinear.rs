//! Small systems with elastic laws whose motions and equilibria are known in closed form.

use std::sync::Arc;

use sinew_core::{
    BlockMatrix, Damping, Deformed, ElasticLaw, EvaluationError, ForceLaw, ForceModel, Layers,
    LoadTime, Pattern, TangentKind, Trial,
};

/// A stored energy with its first two derivatives.
pub(crate) trait Potential: Send + Sync {
    /// The energy (J); `out` is its gradient (N).
    fn energy(&self, u: &[f64], out: &mut [f64]) -> Result<f64, EvaluationError>;

    /// Adds the second derivative (N/m), or that without negative eigenvalues.
    fn add_tangent(&self, u: &[f64], projected: bool, out: &mut BlockMatrix);
}

/// The law of a potential under a dead load.
pub(crate) struct Law<P> {
    pub(crate) potential: P,
    load: Vec<f64>,
    pattern: Arc<Pattern>,
    damping: Damping,
}

/// Neighbours in a row, with these masses (kg).
pub(crate) fn model<P: Potential>(
    potential: P,
    masses: &[f64],
    layers: Layers,
    load: Vec<f64>,
) -> ForceModel<Law<P>> {
    damped(potential, masses, layers, load, Damping::default())
}

pub(crate) fn damped<P: Potential>(
    potential: P,
    masses: &[f64],
    layers: Layers,
    load: Vec<f64>,
    damping: Damping,
) -> ForceModel<Law<P>> {
    let cells = masses.len();
    let pairs: Vec<Vec<u32>> = (0..cells as u32)
        .map(|cell| (cell.saturating_sub(1)..=cell).collect())
        .collect();
    let pattern = Pattern::from_elements(cells, pairs.iter().map(Vec::as_slice)).unwrap();
    let law = Law {
        potential,
        load,
        pattern: Arc::new(pattern),
        damping,
    };
    ForceModel::new(law, masses, layers)
}

impl<P: Potential> Law<P> {
    fn layers(&self) -> Layers {
        match self.load.len() == self.pattern.cells() {
            true => Layers::One,
            false => Layers::Three,
        }
    }
}

impl<P: Potential> ForceLaw for Law<P> {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.potential.energy(trial.u, out)?;
        for (out, load) in out.iter_mut().zip(&self.load) {
            *out = load - *out;
        }
        if self.damping.stiffness > 0.0 {
            let mut tangent = BlockMatrix::zeros(Arc::clone(&self.pattern), self.layers());
            self.potential.add_tangent(trial.u, false, &mut tangent);
            tangent.subtract_scaled_product(self.damping.stiffness, trial.v, out);
        }
        Ok(())
    }

    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&self.load);
    }

    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        Some(self)
    }
}

impl<P: Potential> ElasticLaw for Law<P> {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        Ok(Deformed {
            energy: self.potential.energy(trial.u, out)?,
            ..Deformed::default()
        })
    }

    fn pattern(&self) -> &Arc<Pattern> {
        &self.pattern
    }

    fn tangent(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        out: &mut BlockMatrix,
    ) -> Result<(), EvaluationError> {
        const NONE: [f64; 300] = [0.0; 300];
        out.scale_rows(&NONE[..trial.u.len()]);
        self.potential
            .add_tangent(trial.u, kind != TangentKind::Exact, out);
        Ok(())
    }

    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let mut tangent = BlockMatrix::zeros(Arc::clone(&self.pattern), self.layers());
        self.tangent(trial, kind, &mut tangent)?;
        tangent.multiply(w, out);
        Ok(())
    }

    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let mut tangent = BlockMatrix::zeros(Arc::clone(&self.pattern), self.layers());
        self.tangent(trial, TangentKind::Projected, &mut tangent)?;
        let entries = self.layers().count().pow(2);
        for (cell, out) in out.chunks_exact_mut(entries).enumerate() {
            out.copy_from_slice(tangent.block(cell, cell).unwrap());
        }
        Ok(())
    }

    fn damping(&self) -> &Damping {
        &self.damping
    }
}

/// A potential in one degree of freedom: its value and its first two derivatives.
pub(crate) struct Scalar<F>(pub(crate) F);

impl<F: Fn(f64) -> [f64; 3] + Send + Sync> Potential for Scalar<F> {
    fn energy(&self, u: &[f64], out: &mut [f64]) -> Result<f64, EvaluationError> {
        let [energy, slope, _] = self.0(u[0]);
        out[0] = slope;
        Ok(energy)
    }

    fn add_tangent(&self, u: &[f64], projected: bool, out: &mut BlockMatrix) {
        let [.., curvature] = self.0(u[0]);
        let value = match projected {
            true => curvature.max(0.0),
            false => curvature,
        };
        out.add_block(0, 0, &[value]).unwrap();
    }
}

/// wall - mass - mass - .. - mass, with links that pull with `k e + c e^3` when their elongation is e, and refuse an
/// elongation beyond a limit.
pub(crate) struct Chain {
    pub(crate) stiffness: f64,
    pub(crate) cubic: f64,
    pub(crate) longest: f64,
}

impl Chain {
    fn elongations(u: &[f64]) -> impl Iterator<Item = f64> {
        (0..u.len()).map(|i| u[i] - if i > 0 { u[i - 1] } else { 0.0 })
    }
}

impl Potential for Chain {
    fn energy(&self, u: &[f64], out: &mut [f64]) -> Result<f64, EvaluationError> {
        let mut energy = 0.0;
        out.fill(0.0);
        for (i, e) in Self::elongations(u).enumerate() {
            if e.abs() > self.longest {
                return Err(EvaluationError {
                    element: i as u64,
                    reason: format!("longer by {e} m, more than {} m", self.longest),
                });
            }
            energy += 0.5 * self.stiffness * e.powi(2) + 0.25 * self.cubic * e.powi(4);
            let pull = self.stiffness * e + self.cubic * e.powi(3);
            out[i] += pull;
            if i > 0 {
                out[i - 1] -= pull;
            }
        }
        Ok(energy)
    }

    fn add_tangent(&self, u: &[f64], _projected: bool, out: &mut BlockMatrix) {
        for (i, e) in Self::elongations(u).enumerate() {
            let k = self.stiffness + 3.0 * self.cubic * e * e;
            let cell = i as u32;
            if i > 0 {
                out.add_element(&[cell - 1, cell], &[k, -k, -k, k]).unwrap();
            } else {
                out.add_block(0, 0, &[k]).unwrap();
            }
        }
    }
}

/// A mass on a spring of this stiffness (N/m) and length (m) from the origin; u = 0 is at (length, 0, 0).
pub(crate) struct Sling {
    pub(crate) stiffness: f64,
    pub(crate) length: f64,
}

impl Sling {
    fn radius(&self, u: &[f64]) -> ([f64; 3], f64) {
        let x = [self.length + u[0], u[1], u[2]];
        (x, x.iter().map(|x| x * x).sum::<f64>().sqrt())
    }
}

impl Potential for Sling {
    fn energy(&self, u: &[f64], out: &mut [f64]) -> Result<f64, EvaluationError> {
        let (x, r) = self.radius(u);
        let longer = r - self.length;
        for (out, x) in out.iter_mut().zip(x) {
            *out = self.stiffness * longer * x / r;
        }
        Ok(0.5 * self.stiffness * longer * longer)
    }

    fn add_tangent(&self, u: &[f64], projected: bool, out: &mut BlockMatrix) {
        let (x, r) = self.radius(u);
        let across = self.stiffness * (r - self.length) / r;
        let across = if projected { across.max(0.0) } else { across };
        let block: [f64; 9] = std::array::from_fn(|at| {
            let (i, j) = (at / 3, at % 3);
            let along = x[i] * x[j] / (r * r);
            let unit = f64::from(u8::from(i == j));
            self.stiffness * along + across * (unit - along)
        });
        out.add_block(0, 0, &block).unwrap();
    }
}
