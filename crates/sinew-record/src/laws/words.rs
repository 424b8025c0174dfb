//! Descriptions of laws and of the ranges in which they are stable.

use sinew_draw::short;
use sinew_fem::homogeneous::{Curve, Load};

use super::curves::RegionCurves;
use super::measured::{Measured, Misfit};

/// Lines on a region's law: its moduli at rest, the material and the stable range of the curves, and the misfit of
/// measured points.
#[must_use]
pub fn words_of_law(region: &RegionCurves, measured: Option<&Measured>) -> Vec<String> {
    let mut lines = vec![moduli(region)];
    lines.extend(region.notes.iter().cloned());
    lines.extend(region.curves.iter().map(stability));
    lines.extend(misfits(region, measured));
    lines
}

/// Moduli at rest.
pub(super) fn moduli(region: &RegionCurves) -> String {
    let (lambda, mu) = region.lame;
    let kappa = lambda + 2.0 / 3.0 * mu;
    let e = 9.0 * kappa * mu / (3.0 * kappa + mu);
    let nu = lambda / (2.0 * (lambda + mu));
    let nu = match short(nu).as_str() {
        // Which nobody may state.
        "0.5" => format!("0.5 - {}", short(mu / (2.0 * (lambda + mu)))),
        other => other.to_owned(),
    };
    let [e, mu, kappa] = [e, mu, kappa].map(short);
    let without = if region.has_fibres {
        ", without fibres"
    } else {
        ""
    };
    format!("at rest{without}: E = {e} Pa, nu = {nu}, mu = {mu} Pa, kappa = {kappa} Pa")
}

/// The range in which a load is stable.
pub(super) fn stability(curve: &Curve) -> String {
    let [low, high] = curve.stable().map(short);
    let mut parts = vec![format!("{}: stable from {low} to {high}", curve.load)];
    for (side, end) in ["below", "beyond"].into_iter().zip(curve.ends) {
        let said = [
            end.limit
                .map(|at| format!("not stable {side} {}", short(at))),
            end.falls_from
                .map(|from| format!("the nominal stress falls {side} {}", short(from))),
            end.lost
                .map(|at| format!("no equilibrium was found {side} {}", short(at))),
        ];
        parts.extend(said.into_iter().flatten());
    }
    if parts.len() == 1 {
        parts.push("the whole curve".to_owned());
    }
    parts.join("; ")
}

/// A misfit as a share of the largest stress measured; `None` if that is 0.
fn of_largest(misfit: &Misfit) -> String {
    if misfit.largest == 0.0 {
        return String::new();
    }
    let share = short(100.0 * misfit.root_mean_square / misfit.largest);
    format!(", {share} % of the largest stress measured")
}

/// The distance of measured points from the curves of their loads.
pub(super) fn misfits(region: &RegionCurves, measured: Option<&Measured>) -> Vec<String> {
    let Some(measured) = measured else {
        return Vec::new();
    };
    let of = |load: Load| {
        let misfit = measured.misfit(region.of(load)?)?;
        let mut line = match misfit.points {
            0 => format!("measured, {load}: no points on the curve"),
            points => format!(
                "measured, {load}: {points} {}, root mean square difference {} Pa{}",
                if points == 1 { "point" } else { "points" },
                short(misfit.root_mean_square),
                of_largest(&misfit)
            ),
        };
        if misfit.beyond > 0 {
            line.push_str(&format!("; {} beyond the curve", misfit.beyond));
        }
        Some(line)
    };
    Load::ALL.into_iter().filter_map(of).collect()
}
