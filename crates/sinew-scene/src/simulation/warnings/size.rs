//! Bodies of an unlikely size or weight.

use super::{Warning, WarningKind};
use crate::number::short;
use crate::scene::Body;
use crate::simulation::model::BodyModel;

/// Longest edge of a bounding box (m) beyond which a body is not an organ of any animal in surgery.
const LARGEST: f64 = 5.0;

/// Densities (kg/m^3) between which materials of bodies and tools lie: inflated lungs have some 250, gold 19,300.
const DENSITIES: [f64; 2] = [50.0, 25_000.0];

pub(super) fn warnings(body: &Body, built: &BodyModel) -> Vec<Warning> {
    let (low, high) = built.mesh.bounding_box();
    let extent = (0..3)
        .map(|axis| high[axis] - low[axis])
        .fold(0.0, f64::max);
    let report = built.model.report();
    let density = report.mass / report.volume;
    let mut warnings = Vec::new();
    if extent > LARGEST {
        let what = format!(
            "the body is {} m long and weighs {} kg",
            short(extent),
            short(report.mass)
        );
        let mend = match body.mesh_changes.scale {
            None => "for a mesh in millimetres write scale = 0.001 in [mesh]".to_owned(),
            Some(scale) => format!(
                "with scale = {scale} in [mesh], which is the length of the file\'s unit in m: 0.001 for millimetres"
            ),
        };
        let numbers = [("extent_m", extent), ("mass_kg", report.mass)];
        warnings.push(Warning::new(WarningKind::LargeBody, what, mend).with(&numbers));
    }
    if !(DENSITIES[0]..=DENSITIES[1]).contains(&density) {
        let what = format!(
            "the body weighs {} kg, which is {} kg/m3 in the mean: {} than any tissue",
            short(report.mass),
            short(density),
            match density < DENSITIES[0] {
                true => "lighter",
                false => "heavier",
            }
        );
        let mend = "densities are in kg/m3, and water has 1000";
        let numbers = [("mass_kg", report.mass), ("density_kg_m3", density)];
        warnings.push(Warning::new(WarningKind::OddDensity, what, mend).with(&numbers));
    }
    warnings
}
