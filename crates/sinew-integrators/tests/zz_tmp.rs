//! tmp
mod common;
use common::cube::*;
use common::*;
use sinew_core::System;
#[test]
fn tmp() {
    let model = paper_cube();
    for q in [4.0] {
    let (instants, _, report) = run(model, &mut *build("cnn", &saturation(q)), 1);
    let c: Vec<usize> = instants.iter().map(|u| model.inverted_elements(u).unwrap()).collect();
    println!("{q} {c:?} {}", report.work.saturated);
    }
}
