//! The springs of a region, calibrated, and the dashpots along them.

use crate::springs::{self, NetworkModulus, Spring};

/// The springs of a region.
#[derive(Clone, Debug)]
pub(crate) struct Network {
    pub(crate) springs: Vec<Spring>,
    /// Its moduli as a material.
    pub(crate) modulus: NetworkModulus,
    /// gamma: dashpots as a share of critical damping.
    pub(crate) damping_ratio: f64,
}

impl Network {
    pub(crate) fn new(
        points: &[[f64; 3]],
        springs: Vec<Spring>,
        volume: f64,
        damping_ratio: f64,
    ) -> Self {
        Self {
            modulus: springs::network_modulus(points, &springs, volume),
            springs,
            damping_ratio,
        }
    }

    /// Scales the springs until their Voigt average is `youngs_modulus` (Pa); returns the factor.
    pub(crate) fn calibrate(&mut self, youngs_modulus: f64) -> f64 {
        let modulus = self.modulus;
        let fits = modulus.voigt > 0.0;
        if !fits {
            return 1.0;
        }
        let calibration = youngs_modulus / modulus.voigt;
        for spring in &mut self.springs {
            spring.stiffness *= calibration;
        }
        self.modulus = NetworkModulus {
            voigt: modulus.voigt * calibration,
            softest: modulus.softest * calibration,
            stiffest: modulus.stiffest * calibration,
        };
        calibration
    }
}

/// A dashpot between two nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dashpot {
    pub(crate) nodes: [u32; 2],
    /// Rate d (N s/m).
    pub(crate) rate: f64,
}

/// A dashpot `d = gamma 2 sqrt(k (m_i + m_j))` along each edge of all networks; gamma =
/// 1/2 damps the relative motion of a pair of equal masses critically, and of unequal ones more. An edge that
/// networks share is one spring, whose gamma is the mean of theirs by stiffness: cutting a body into regions changes
/// nothing. Empty if no network is damped.
pub(crate) fn dashpots(networks: &[Option<Network>], masses: &[f64]) -> Vec<Dashpot> {
    let networks = || networks.iter().flatten();
    if !networks().any(|network| network.damping_ratio > 0.0) {
        return Vec::new();
    }
    let scaled = |by: fn(f64) -> f64| {
        let parts = networks().flat_map(|network| {
            let factor = by(network.damping_ratio);
            network.springs.iter().map(move |spring| Spring {
                stiffness: factor * spring.stiffness,
                ..*spring
            })
        });
        springs::summed(parts.collect())
    };
    let (springs, damped) = (scaled(|_| 1.0), scaled(|gamma| gamma));
    let pairs = springs.iter().zip(&damped);
    let dashpot = pairs.map(|(spring, damped)| {
        let [a, b] = spring.nodes.map(|node| masses[node as usize]);
        let gamma = damped.stiffness / spring.stiffness;
        Dashpot {
            nodes: spring.nodes,
            rate: gamma * 2.0 * (spring.stiffness * (a + b)).sqrt(),
        }
    });
    dashpot.collect()
}
