//! The third-order Runge-Kutta method of Shu and Osher.

use sinew_core::{
    Batch, ChangingLoads, EnergyBehaviour, Integrator, LoadTime, Needs, Prepared, Properties,
    SetupError, StableStep, State, StepError, StepReport, Stepped, System,
};

/// Time at which each stage takes forces, as a share of the step, and the weight of its Euler step relative to the
/// state at the beginning of the step (Shu and Osher, J. Comput. Phys. 77, 1988).
const STAGES: [(f64, f64); 3] = [(0.0, 1.0), (1.0, 1.0 / 4.0), (0.5, 2.0 / 3.0)];

/// Three Euler steps, each averaged with the state at the beginning of the step.
#[derive(Default)]
pub struct SspRk3 {
    prepared: Prepared,
    u: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
}

impl Integrator for SspRk3 {
    fn id(&self) -> &'static str {
        "ssp-rk3"
    }

    fn properties(&self) -> Properties {
        // The line that takes the place of a load with a jump or kink is right to second order.
        let (smooth, broken) = (3, 2);
        Properties {
            changing_loads: ChangingLoads::Order { smooth, broken },
            ..Properties::of_order(3, Needs::Forces, EnergyBehaviour::Falls)
        }
    }

    fn prepare(&mut self, system: &dyn System, dt: f64) -> Result<StepReport, SetupError> {
        if !self.prepared.is_for(system, dt) {
            self.prepared.forget();
            Prepared::check(self.id(), system, dt)?;
            for buffer in [&mut self.u, &mut self.v, &mut self.a] {
                buffer.resize(system.dofs(), 0.0);
            }
            self.prepared.done(system, dt);
        }
        Ok(StepReport::default())
    }

    /// Stability limit: the step at which the fastest motion `exp(lambda t)` leaves the region `|R(lambda dt)| <= 1`,
    /// `sqrt 3/omega_max` without damping.
    fn stable_step_about(
        &self,
        system: &dyn System,
        about: Option<&State>,
    ) -> Result<StableStep, SetupError> {
        let Some(spectrum) = system.spectrum(about) else {
            return Ok(StableStep::Unknown);
        };
        let (w, half) = (spectrum.omega_max, spectrum.mass_damping / 2.0);
        // Other damping may make another motion than the fastest one decide.
        if spectrum.damping_max > 0.0 || half >= w {
            return Ok(StableStep::Unknown);
        }
        let lambda = [-half, (w * w - half * half).sqrt()];
        let (mut stable, mut unstable) = (0.0, 4.0 / w);
        for _ in 0..60 {
            let dt = 0.5 * (stable + unstable);
            match amplification(lambda.map(|part| part * dt)) <= 1.0 {
                true => stable = dt,
                false => unstable = dt,
            }
        }
        Ok(StableStep::UpTo(stable))
    }

    fn run(&mut self, batch: &mut Batch<'_>, state: &mut State) -> Result<(), StepError> {
        // Staggered methods leave the velocity half a step behind.
        batch.synchronise(state)?;
        batch.each(state, |step, state| {
            let (t, dt) = (state.t(), step.dt);
            // Stages are trial points: the state stays what it was until the step is whole, since a
            // system may refuse a stage.
            self.u.copy_from_slice(&state.u);
            self.v.copy_from_slice(&state.v);
            for (share, weight) in STAGES {
                let load = LoadTime::within(t, dt, share);
                let trial = [&*self.u, &*self.v, &*state.internal];
                step.net_force(load, share * dt, trial, &mut self.a)?;
                for (dof, mass) in step.system.mass().iter().enumerate() {
                    let (u, v) = (self.u[dof], self.v[dof]);
                    let euler = [u + dt * v, v + dt * self.a[dof] / mass];
                    self.u[dof] = state.u[dof] + weight * (euler[0] - state.u[dof]);
                    self.v[dof] = state.v[dof] + weight * (euler[1] - state.v[dof]);
                }
            }
            state.u.copy_from_slice(&self.u);
            state.v.copy_from_slice(&self.v);
            Ok(Stepped::at_same_time(StepReport {
                sweeps: 3,
                force_evaluations: 3,
                ..StepReport::default()
            }))
        })
    }
}

/// `|1 + z + z^2/2 + z^3/6|` at z = x + i y.
fn amplification([x, y]: [f64; 2]) -> f64 {
    let (mut re, mut im) = (1.0 / 6.0, 0.0);
    for coefficient in [0.5, 1.0, 1.0] {
        (re, im) = (coefficient + x * re - y * im, x * im + y * re);
    }
    f64::hypot(re, im)
}

#[cfg(test)]
mod tests {
    use super::SspRk3;

    sinew_core::conformance!(ssp_rk3, || Box::new(SspRk3::default()));
}
