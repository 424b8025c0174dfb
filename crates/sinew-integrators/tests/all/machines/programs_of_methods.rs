//! The machines, with the programs of all methods.

use std::sync::LazyLock;

use crate::common::methods::methods;
use sinew_cnn::conformance::Method;
use sinew_cnn::{Machine, ReferenceMachine};
use sinew_machines::{Chosen, Kind, Settings};
use sinew_sparse::simd::InstructionSet;

/// One list for all machines: the definition is interpreted once.
static METHODS: LazyLock<Vec<Method>> = LazyLock::new(methods);

sinew_cnn::machine_conformance!(reference, METHODS, || Box::new(ReferenceMachine::default()));

/// The kernels for any matrix, with these instructions if the machine has them.
fn general(set: InstructionSet) -> Box<dyn Machine> {
    Box::new(Chosen::new(Settings {
        kind: Kind::GENERAL,
        instructions: Some(set),
        ..Settings::default()
    }))
}

sinew_cnn::machine_conformance!(portable, METHODS, || general(InstructionSet::Portable));
sinew_cnn::machine_conformance!(avx2, METHODS, || general(InstructionSet::Avx2));
sinew_cnn::machine_conformance!(avx512, METHODS, || general(InstructionSet::Avx512));

/// The suite runs the programs of the methods: no entry of the list is refused for all systems.
#[test]
fn every_method_has_a_program_for_some_system() {
    use sinew_core::{LinearModel, LinearOperators};
    let system = LinearModel::new(LinearOperators::oscillator(0.1, 100.0, 1.0).unwrap());
    for method in METHODS.iter() {
        let dt = method.omega_dt / 1000.0_f64.sqrt();
        assert!((method.program)(&system, dt).is_some(), "{}", method.name);
    }
}
