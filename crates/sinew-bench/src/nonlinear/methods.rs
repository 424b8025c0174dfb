//! The methods for large deformations.

use sinew_core::OptionValue;
use sinew_measure::MethodChoice;

use crate::planned::{energy, with, yardstick};

/// The methods of a quick run, and of runs that compare bodies.
pub(super) fn few() -> Vec<MethodChoice> {
    vec![yardstick(), MethodChoice::new("newmark"), energy("trap", 4)]
}

/// Methods for bodies on which an implicit step takes long.
pub(super) fn of_large_bodies() -> Vec<MethodChoice> {
    let mut methods = few();
    methods.extend(
        ["rk4", "generalized-alpha", "cnn-energy"]
            .into_iter()
            .flat_map(variants),
    );
    methods
}

/// Methods for damping that no explicit step can follow.
pub(super) fn of_sofa() -> Vec<MethodChoice> {
    let implicit = ["implicit-euler", "newmark", "generalized-alpha"].map(MethodChoice::new);
    let mut methods = vec![
        energy("ie", 5),
        energy("ie", 10),
        energy("ie", 40),
        energy("trap", 10),
        energy("trap", 40),
    ];
    methods.extend(implicit);
    methods
}

/// Every available method, with the variants that trade error for cost.
pub(super) fn all() -> Vec<MethodChoice> {
    let mut methods = vec![yardstick()];
    for id in sinew_integrators::ids() {
        methods.push(MethodChoice::new(id).showing_defaults());
        methods.extend(variants(id));
    }
    methods
}

/// Variants of a method that behave differently on tissue under large deformation.
fn variants(id: &str) -> Vec<MethodChoice> {
    match id {
        "rk4" => vec![with("rk4", "substeps", OptionValue::Text("auto".into()))],
        "generalized-alpha" => vec![with(
            "generalized-alpha",
            "rho_inf",
            OptionValue::Number(0.8),
        )],
        "cnn-energy" => vec![
            energy("trap", 1),
            energy("trap", 16),
            energy("ie", 4),
            energy("ie", 16),
        ],
        _ => Vec::new(),
    }
}
