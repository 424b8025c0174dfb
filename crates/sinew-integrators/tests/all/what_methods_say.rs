//! Statements of methods about themselves, for programs that choose between methods.

use crate::common::cube::paper_cube;
use sinew_core::Options;
use sinew_integrators::{OptionLabel, entries, entry};

#[test]
fn methods_that_say_they_factorise_do_so_in_their_set_up_and_no_others() {
    let model = paper_cube();
    for entry in entries() {
        let mut integrator = entry.build(&Options::new()).unwrap();
        let work = integrator.prepare(model, 1e-3).unwrap();
        assert_eq!(work.factorizations > 0, entry.factorises, "{}", entry.id);
    }
}

#[test]
fn every_variant_and_every_option_set_for_an_error_can_be_built() {
    for entry in entries() {
        let mut variants = (entry.variants)();
        variants.extend((entry.options_for_error)(1e-3));
        for options in variants {
            assert!(entry.build(&options).is_ok(), "{} {options:?}", entry.id);
        }
        assert!(!(entry.options_for_error)(1e-3).is_empty(), "{}", entry.id);
    }
}

#[test]
fn a_saturation_is_called_q_whether_it_is_the_methods_own_or_a_guards() {
    for entry in entries() {
        assert_eq!(entry.option_label("gamma"), OptionLabel::KeyAndValue);
    }
    for id in ["cnn", "central-difference"] {
        let label = entry(id).unwrap().option_label("saturation");
        assert_eq!(label, OptionLabel::Symbol("Q"));
    }
    assert!(entry("euler").is_none());
}
