//! Methods whose programs test machines.

use sinew_cnn::Program;
use sinew_cnn::conformance::Method;
use sinew_core::{EnergyBehaviour, Needs, OptionValue, Options, Properties, System};

use super::{inner, plain, saturation};

/// The programs that an integrator makes.
fn method(id: &'static str, options: Options) -> Method {
    let integrator = sinew_integrators::build(id, &options).unwrap();
    let name = format!("`{id}` with {options:?}");
    Method::new(name, integrator.properties(), move |system, dt| {
        let mut integrator = sinew_integrators::build(id, &options).ok()?;
        integrator.prepare(system, dt).ok()?;
        integrator.program()
    })
}

/// A program without a motion: its steps are compared with their definition only.
fn power_iteration() -> Method {
    let properties = Properties::of_order(1, Needs::Matrices, EnergyBehaviour::Falls);
    let program = |system: &dyn System, _: f64| {
        let fastest = system.spectrum(None)?.omega_max;
        system.as_linear()?;
        Some(Program::power_iteration(fastest * fastest))
    };
    Method::new("power iteration", properties, program).bounded()
}

/// Methods with programs, in variants that make every kind of instruction.
pub(crate) fn methods() -> Vec<Method> {
    let text = |word: &str| OptionValue::Text(word.into());
    let substeps = || plain().with_number("substeps", 3.0);
    let mut methods = Vec::new();
    for id in [
        "forward-euler",
        "symplectic-euler",
        "central-difference",
        "rk4",
        "modified-leapfrog",
    ] {
        methods.push(method(id, plain()));
        methods.push(method(id, substeps()).in_steps_of(1.0));
        methods.push(method(id, saturation(1e300)));
        methods.push(method(id, saturation(0.02)).bounded());
        let both = substeps().with_number("saturation", 0.02);
        methods.push(method(id, both).in_steps_of(1.0).bounded());
    }
    for id in ["cnn", "cnn-symplectic"] {
        methods.push(method(id, plain().with("saturation", text("off"))));
        methods.push(method(id, saturation(0.05)).bounded());
        let both = substeps().with_number("saturation", 0.05);
        methods.push(method(id, both).in_steps_of(1.0).bounded());
    }
    // Long steps, to which the matrix P owes its name; s = 1 keeps it in short ones.
    for options in [plain(), plain().with_number("s", 1.0)] {
        for kind in ["block", "jacobi", "chebyshev"] {
            let sweeps = (kind != "block").then_some(3.0);
            let options = options.clone().with("inner", inner(kind, sweeps));
            methods.push(method("cnn-stabilised", options.clone()).in_steps_of(3.0));
            let guarded = options.with_number("saturation", 0.02);
            methods.push(method("cnn-stabilised", guarded).in_steps_of(3.0).bounded());
        }
    }
    let exact = plain().with_number("tolerance", 1e-12);
    let two_step = exact.clone().with("kind", text("two-step"));
    methods.push(method("propagator", exact).in_steps_of(3.0));
    methods.push(method("propagator", two_step).in_steps_of(3.0));
    methods.push(power_iteration());
    methods
}
