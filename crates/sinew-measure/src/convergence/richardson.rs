//! Richardson's extrapolation over meshes, each with edges of half the length of the previous one.

use serde::{Deserialize, Serialize};

/// The order, in the length of edges, of linear elements on smooth solutions: of displacements in the mean square, and
/// of energies (Strang and Fix, An Analysis of the Finite Element Method, 1973, chapters 3 and 8). At the edges of
/// supports and at re-entrant corners stresses are singular as `r^(a-1)`, `a` between 1/2 and 1, and both have order
/// `2 a` on uniformly refined meshes (Szabo and Babuska, Finite Element Analysis, 1991, chapter 10).
const SMOOTH: f64 = 2.0;

/// The order below which differences give no estimate: their sum would diverge.
const LEAST: f64 = 0.25;

/// Differences (fraction) up to which solutions are the same: their own errors may be as large.
const SAME: f64 = 1e-6;

/// Error estimate for a quantity from its values on several meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The differences between neighbouring meshes, the scene's first, over the size of the quantity (fraction).
    pub differences: Vec<f64>,
    /// The order of the last two differences; `None` for two meshes, or if no difference is above 1e-6.
    pub observed_order: Option<f64>,
    /// The order used for the errors: the observed one, but at most that of smooth solutions; without an observed one,
    /// that of smooth solutions.
    pub order: f64,
    /// The error on the scene's mesh (fraction); `None` if differences do not fall.
    pub error: Option<f64>,
    /// The error on the finest mesh (fraction); `None` if differences do not fall.
    pub error_of_finest: Option<f64>,
}

/// Extrapolates the differences between neighbouring meshes (fractions, coarse ones first) as a geometric series: with
/// order `p` each is `2^-p` times the previous one, so that with a last difference `d` the error of the finest mesh is
/// `d / (2^p - 1)` (Richardson, Phil. Trans. R. Soc. A 210, 1911; Roache, J. Fluids Eng. 116, 1994). An observed order
/// above that of smooth solutions is a coincidence and is not used (Oberkampf and Roy, Verification and Validation in
/// Scientific Computing, 2010, section 8.6).
///
/// ```
/// use sinew_measure::convergence::richardson;
///
/// let two = richardson(&[0.03]);
/// assert!((two.error.unwrap() - 0.04).abs() < 1e-15 && two.observed_order.is_none());
/// let three = richardson(&[0.02, 0.01]);
/// assert_eq!((three.observed_order, three.error), (Some(1.0), Some(0.04)));
/// assert_eq!(richardson(&[0.01, 0.02]).error, None, "these go apart");
/// ```
#[must_use]
pub fn richardson(differences: &[f64]) -> Estimate {
    let nothing_differs = differences.iter().all(|difference| *difference <= SAME);
    let observed_order = match differences {
        _ if nothing_differs => None,
        [.., before, last] => Some((before / last).log2()),
        _ => None,
    };
    let order = observed_order.map_or(SMOOTH, |order| order.min(SMOOTH));
    // False for what is not a number.
    let continues = order >= LEAST && differences.iter().all(|difference| difference.is_finite());
    let error_of_finest = match differences.last() {
        Some(last) if continues => Some(last / (order.exp2() - 1.0)),
        _ => None,
    };
    Estimate {
        differences: differences.to_vec(),
        observed_order,
        order,
        error: error_of_finest.map(|error| differences.iter().sum::<f64>() + error),
        error_of_finest,
    }
}
