//! The energy that central difference conserves.

use crate::common::build;
use crate::common::plain;
use proptest::prelude::*;
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearModel, LinearOperators, LinearSystem, State};
use sinew_testkit::body::bodies_up_to;

/// `1/2 v' M v + 1/2 u_n' K u_n+1`, v being the velocity between the two displacements.
fn half_step_energy(operators: &LinearOperators, before: &[f64], after: &State) -> f64 {
    let mut force = vec![0.0; before.len()];
    operators.stiffness().multiply(&after.u, &mut force);
    let elastic: f64 = before.iter().zip(&force).map(|(u, f)| u * f).sum();
    let moving = after.v.iter().zip(operators.mass());
    0.5 * (moving.map(|(v, mass)| mass * v * v).sum::<f64>() + elastic)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn half_step_energy_is_constant_at_nearly_the_critical_step(body in bodies_up_to(3)) {
        // Held, as rounding would swamp the deformation of a body that flies far away.
        let body = body.on_the_ground().conservative();
        let model = body.model();
        let operators = model.operators();
        let dt = 0.95 * Spectrum::of(operators).critical_step();
        let mut state = body.state(&model, 1e-3, 1e-3 / dt);
        let system = LinearModel::new(operators.clone());
        let mut integrator = build("central-difference", &plain());
        let mut before = vec![0.0; state.u.len()];
        let mut first = None;
        for step in 0..1000 {
            before.copy_from_slice(&state.u);
            integrator.step(&system, &mut state, dt).unwrap();
            let energy = half_step_energy(operators, &before, &state);
            let change = energy / *first.get_or_insert(energy) - 1.0;
            prop_assert!(change.abs() <= 1e-12, "step {step}: {change:e}");
        }
    }
}
