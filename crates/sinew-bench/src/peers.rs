//! What other systems reach on the peers' cube, as published figures.
//!
//! Measured once, on one machine and one thread, each on the same mesh with the same lumped mass and
//! load. Times measured elsewhere say nothing beside ours, so only ratios to one rival's cost leave
//! this module; `cargo xtask bench --beside scipy` runs that rival here.

/// Id of the case the figures belong to.
pub const CASE: &str = "peers-cube";

/// CPU seconds per simulated second of scipy's central difference at 1 ms, the unit of all ratios.
const SCIPY: f64 = 0.065;

/// A system and its cheapest run at about 5 % error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peer {
    /// System and method.
    pub who: &'static str,
    /// Step, or number of modes and step.
    pub setting: &'static str,
    /// Error (%) with the digits it was published with.
    pub error: &'static str,
    /// Cost over that of scipy's central difference at 1 ms (ratio), set-up left out; none for
    /// methods that never come near 5 %.
    pub cost: Option<f64>,
    /// What else is known; may be empty.
    pub note: &'static str,
}

const fn peer(
    who: &'static str,
    setting: &'static str,
    error: &'static str,
    cpu_s_per_s: f64,
    note: &'static str,
) -> Peer {
    Peer {
        who,
        setting,
        error,
        cost: Some(cpu_s_per_s / SCIPY),
        note,
    }
}

/// The figures, cheapest first.
pub const PEERS: [Peer; 12] = [
    peer(
        "modal truncation (scipy)",
        "100 modes ranked by |φ'F|/ω², 10 ms",
        "4.4",
        0.011,
        "the modes come on top",
    ),
    peer(
        "central difference (scipy CSR)",
        "1 ms",
        "3.1",
        SCIPY,
        "2 ms 6.0 %, 0.5 ms 1.6 %, 0.25 ms 0.47 %, 0.1 ms 0.076 %",
    ),
    peer("NiftySim 2.5, TLED, StVK, f32", "1.5 ms", "4.8", 0.23, ""),
    peer(
        "NVIDIA Newton 1.8, SemiImplicit, neo-Hookean, f32",
        "1 ms",
        "3.9",
        0.44,
        "",
    ),
    peer(
        "SOFA, symplectic Euler, small strain",
        "1 ms",
        "4.0",
        0.57,
        "",
    ),
    peer("MuJoCo 4.0 flex, Euler, StVK", "1 ms", "3.4", 0.62, ""),
    peer("VegaFEM, central difference", "1 ms", "4.0", 0.93, ""),
    peer(
        "SOFA, symplectic Euler, corotational",
        "1 ms",
        "3.7",
        0.96,
        "",
    ),
    peer(
        "Newmark (scipy SuperLU, factored once)",
        "1 ms",
        "4.3",
        1.06,
        "5 ms 21.2 %, 10 ms 33.9 %",
    ),
    peer("SOFA, Newmark + CG, linear", "1 ms", "4.3", 5.2, ""),
    peer("SOFA, Newmark + CG, corotational", "1 ms", "4.6", 7.3, ""),
    Peer {
        who: "any backward Euler (SOFA, MuJoCo \"discrete\", VegaFEM, Newton VBD, XPBD)",
        setting: "1 ms",
        error: "27",
        cost: None,
        note: "10 ms 54 %; never near 5 %",
    },
];
