//! Chains of masses with elastic laws, and a pendulum.

use std::sync::Arc;

use sinew_core::{
    BlockMatrix, Damping, Deformed, ElasticLaw, EvaluationError, ForceLaw, ForceModel, Layers,
    LoadTime, Pattern, TangentKind, Trial,
};

/// A spring by its energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Spring {
    /// `k s^2/2`.
    Linear { k: f64 },
    /// `k s^2/2 + c s^4/4`.
    Hardening { k: f64, c: f64 },
    /// `k l^2 (s/l - ln(1 + s/l))`: refuses to be compressed by l.
    Barrier { k: f64, l: f64 },
    /// `k (s^2 - l^2)^2/(8 l^2)`: at rest at l and -l, with negative stiffness between.
    DoubleWell { k: f64, l: f64 },
}

impl Spring {
    /// Energy, force and stiffness at a stretch (J, N, N/m).
    fn at(self, s: f64) -> Result<[f64; 3], f64> {
        Ok(match self {
            Self::Linear { k } => [0.5 * k * s * s, k * s, k],
            Self::Hardening { k, c } => [
                0.5 * k * s * s + 0.25 * c * s.powi(4),
                k * s + c * s.powi(3),
                k + 3.0 * c * s * s,
            ],
            Self::Barrier { k, l } => {
                let x = s / l;
                if x <= -1.0 {
                    return Err(s);
                }
                [
                    k * l * l * (x - x.ln_1p()),
                    k * l * x / (1.0 + x),
                    k / (1.0 + x).powi(2),
                ]
            }
            Self::DoubleWell { k, l } => {
                let beyond = s * s - l * l;
                [
                    k * beyond * beyond / (8.0 * l * l),
                    0.5 * k * s * beyond / (l * l),
                    0.5 * k * (3.0 * s * s - l * l) / (l * l),
                ]
            }
        })
    }
}

/// wall - mass - .. - mass, one spring before each mass, in one layer, under a force on the last mass that is constant
/// or follows a function of time.
pub(crate) struct Chain {
    pub(crate) springs: Vec<Spring>,
    pub(crate) damping: Damping,
    pub(crate) force: fn(f64) -> f64,
    pub(crate) force_size: f64,
    pattern: Arc<Pattern>,
    masses: Vec<f64>,
}

impl Chain {
    pub(crate) fn model(
        springs: Vec<Spring>,
        masses: &[f64],
        [mass, stiffness, dashpot]: [f64; 3],
        force_size: f64,
        force: fn(f64) -> f64,
    ) -> ForceModel<Self> {
        let n = masses.len();
        let pairs = (1..n as u32).map(|i| [i - 1, i]);
        let pattern = Arc::new(Pattern::from_elements(n, pairs).unwrap());
        let extra = (dashpot > 0.0).then(|| {
            let mut extra = BlockMatrix::zeros(Arc::clone(&pattern), Layers::One);
            for i in 1..n as u32 {
                let element = [dashpot, -dashpot, -dashpot, dashpot];
                extra.add_element(&[i - 1, i], &element).unwrap();
            }
            extra.add_block(0, 0, &[dashpot]).unwrap();
            Arc::new(extra)
        });
        let damping = Damping {
            mass,
            stiffness,
            extra,
        };
        let law = Self {
            springs,
            damping,
            force,
            force_size,
            pattern,
            masses: masses.to_vec(),
        };
        ForceModel::new(law, masses, Layers::One)
    }

    fn stretches<'a>(u: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let before = std::iter::once(&0.0).chain(u);
        u.iter().zip(before).map(|(u, before)| u - before)
    }

    /// Energy, force and stiffness of each spring.
    fn each(&self, u: &[f64]) -> Result<Vec<[f64; 3]>, EvaluationError> {
        let pairs = self.springs.iter().zip(Self::stretches(u)).enumerate();
        pairs
            .map(|(at, (spring, s))| {
                spring.at(s).map_err(|s| EvaluationError {
                    element: at as u64,
                    reason: format!("compressed by {} m", -s),
                })
            })
            .collect()
    }
}

impl ForceLaw for Chain {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let (mut load, mut damped) = (vec![0.0; out.len()], vec![0.0; out.len()]);
        self.elastic_force(trial, out)?;
        self.external_force(trial.load, trial.u, &mut load);
        if self.damping.stiffness != 0.0 {
            self.tangent_product(trial, TangentKind::Frozen, trial.v, &mut damped)?;
        }
        for (dof, out) in out.iter_mut().enumerate() {
            *out = load[dof] - *out - self.damping.stiffness * damped[dof];
            *out -= self.damping.mass * self.masses[dof] * trial.v[dof];
        }
        if let Some(extra) = &self.damping.extra {
            extra.subtract_product(trial.v, out);
        }
        Ok(())
    }

    fn external_force(&self, when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        if let Some(last) = out.last_mut() {
            *last = self.force_size * (self.force)(when.t());
        }
    }

    fn mass_damping(&self) -> f64 {
        self.damping.mass
    }

    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        Some(self)
    }
}

impl ElasticLaw for Chain {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        let each = self.each(trial.u)?;
        for (at, [_, force, _]) in each.iter().enumerate() {
            out[at] = *force;
        }
        for at in 1..out.len() {
            out[at - 1] -= each[at][1];
        }
        Ok(Deformed {
            energy: each.iter().map(|[energy, ..]| energy).sum(),
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
        *out = BlockMatrix::zeros(Arc::clone(&self.pattern), Layers::One);
        for (at, k) in (0..).zip(self.stiffnesses(trial.u, kind)?) {
            let added = match at {
                0 => out.add_block(0, 0, &[k]),
                _ => out.add_element(&[at - 1, at], &[k, -k, -k, k]),
            };
            added.unwrap();
        }
        Ok(())
    }

    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let each = self.stiffnesses(trial.u, kind)?;
        let pulls: Vec<f64> = each
            .iter()
            .zip(Self::stretches(w))
            .map(|(k, s)| k * s)
            .collect();
        for at in 0..out.len() {
            out[at] = pulls[at] - pulls.get(at + 1).unwrap_or(&0.0);
        }
        Ok(())
    }

    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        let each = self.stiffnesses(trial.u, TangentKind::Projected)?;
        for at in 0..out.len() {
            out[at] = each[at] + each.get(at + 1).unwrap_or(&0.0);
        }
        Ok(())
    }

    fn damping(&self) -> &Damping {
        &self.damping
    }
}

impl Chain {
    fn stiffnesses(&self, u: &[f64], kind: TangentKind) -> Result<Vec<f64>, EvaluationError> {
        let each = self.each(u)?.into_iter().map(|[_, _, k]| match kind {
            TangentKind::Exact => k,
            TangentKind::Projected | TangentKind::Frozen => k.max(0.0),
        });
        Ok(each.collect())
    }
}

/// A mass on a spring of rest length `length` (m) about the origin, under its weight along -z: `W = k (|x| - length)^2/2`, x
/// being `(length, 0, 0) + u`.
pub(crate) struct Pendulum {
    pub(crate) stiffness: f64,
    pub(crate) length: f64,
    pub(crate) weight: f64,
    damping: Damping,
    pattern: Arc<Pattern>,
}

impl Pendulum {
    pub(crate) fn model(stiffness: f64, length: f64, mass: f64) -> ForceModel<Self> {
        let law = Self {
            stiffness,
            length,
            weight: 9.81 * mass,
            damping: Damping::default(),
            pattern: Arc::new(Pattern::from_elements(1, [[0]]).unwrap()),
        };
        ForceModel::new(law, &[mass], Layers::Three)
    }

    /// The distance (m) and the direction from the origin.
    fn along(&self, u: &[f64]) -> Result<(f64, [f64; 3]), EvaluationError> {
        let x = [self.length + u[0], u[1], u[2]];
        let distance = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        if distance > 0.0 {
            return Ok((distance, x.map(|x| x / distance)));
        }
        Err(EvaluationError {
            element: 0,
            reason: "the spring has no direction".into(),
        })
    }

    /// Stiffness along and across the spring.
    fn stiffnesses(&self, distance: f64, kind: TangentKind) -> [f64; 2] {
        let across = self.stiffness * (1.0 - self.length / distance);
        match kind {
            TangentKind::Exact => [self.stiffness, across],
            TangentKind::Projected | TangentKind::Frozen => [self.stiffness, across.max(0.0)],
        }
    }
}

impl ForceLaw for Pendulum {
    fn net_force(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.elastic_force(trial, out)?;
        out.iter_mut().for_each(|out| *out = -*out);
        out[2] -= self.weight;
        Ok(())
    }

    fn external_force(&self, _when: LoadTime<'_>, _u: &[f64], out: &mut [f64]) {
        out.copy_from_slice(&[0.0, 0.0, -self.weight]);
    }

    fn elastic(&self) -> Option<&dyn ElasticLaw> {
        Some(self)
    }
}

impl ElasticLaw for Pendulum {
    fn elastic_force(
        &self,
        trial: &Trial<'_>,
        out: &mut [f64],
    ) -> Result<Deformed, EvaluationError> {
        let (distance, direction) = self.along(trial.u)?;
        let stretch = distance - self.length;
        for (out, direction) in out.iter_mut().zip(direction) {
            *out = self.stiffness * stretch * direction;
        }
        Ok(Deformed {
            energy: 0.5 * self.stiffness * stretch * stretch,
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
        let mut block = [0.0; 9];
        self.block(trial.u, kind, &mut block)?;
        *out = BlockMatrix::zeros(Arc::clone(&self.pattern), Layers::Three);
        out.add_block(0, 0, &block).unwrap();
        Ok(())
    }

    fn tangent_product(
        &self,
        trial: &Trial<'_>,
        kind: TangentKind,
        w: &[f64],
        out: &mut [f64],
    ) -> Result<(), EvaluationError> {
        let mut block = [0.0; 9];
        self.block(trial.u, kind, &mut block)?;
        for (row, out) in block.chunks_exact(3).zip(out) {
            *out = row.iter().zip(w).map(|(entry, w)| entry * w).sum();
        }
        Ok(())
    }

    fn node_blocks(&self, trial: &Trial<'_>, out: &mut [f64]) -> Result<(), EvaluationError> {
        self.block(trial.u, TangentKind::Projected, out)
    }

    fn damping(&self) -> &Damping {
        &self.damping
    }
}

impl Pendulum {
    fn block(&self, u: &[f64], kind: TangentKind, out: &mut [f64]) -> Result<(), EvaluationError> {
        let (distance, n) = self.along(u)?;
        let [along, across] = self.stiffnesses(distance, kind);
        for (at, out) in out.iter_mut().enumerate() {
            let (row, column) = (at / 3, at % 3);
            let same = f64::from(u8::from(row == column));
            *out = across * same + (along - across) * n[row] * n[column];
        }
        Ok(())
    }
}
