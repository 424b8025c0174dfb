//! Errors and costs of other systems on the peers' cube, measured by us.
//!
//! Measured once, on one machine and one thread, each program on the same mesh with the same lumped mass and load.
//! Those times are not comparable with times from other machines, so this module only provides ratios to one rival's
//! cost; `cargo xtask bench --beside scipy` runs that rival again.

/// Id of the case to which the figures belong.
pub const CASE: &str = "peers-cube";

/// The day of the measurements, and of the newest source or package of each program.
pub const MEASURED_ON: &str = "20 November 2026";

/// The machine of the measurements.
pub const MACHINE: &str = "one machine of two shared cores, one thread used";

/// The body, its load and the definition of errors.
pub const BODY: &str = "a cube of 0.1 m in 10 × 10 × 10 cells (6000 tetrahedra, 2673 free degrees of \
     freedom), 1060 kg/m³, E 3500 Pa, ν 0.45, undamped, held in all lateral faces; 0.042135 N in all on \
     the 81 free nodes of the top from t = 0 on; error against the modal solution at 10, 20, .. 1000 ms";

/// CPU seconds per simulated second of scipy's central difference at 1 ms, the unit of all ratios.
const SCIPY: f64 = 0.065;

/// A system and its cheapest run at about 5 % error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peer {
    /// System and method.
    pub who: &'static str,
    /// The release that ran, or that was built from the source of [`MEASURED_ON`].
    pub version: &'static str,
    /// Step, or number of modes and step.
    pub setting: &'static str,
    /// Error (%) with the recorded digits.
    pub error: &'static str,
    /// Cost over that of scipy's central difference at 1 ms (ratio), without set-up; none for methods that never reach
    /// about 5 %.
    pub cost: Option<f64>,
    /// A remark; may be empty.
    pub note: &'static str,
}

const fn peer(
    who: &'static str,
    version: &'static str,
    setting: &'static str,
    error: &'static str,
    cpu_s_per_s: f64,
    note: &'static str,
) -> Peer {
    Peer {
        who,
        version,
        setting,
        error,
        cost: Some(cpu_s_per_s / SCIPY),
        note,
    }
}

const SOURCE: &str = "source of that day";
const PACKAGE: &str = "package of that day";

/// The figures, cheapest first.
pub const PEERS: [Peer; 12] = [
    peer(
        "modal truncation (scipy)",
        PACKAGE,
        "100 modes ranked by |φ'F|/ω², 10 ms",
        "4.4",
        0.011,
        "the modes come on top",
    ),
    peer(
        "central difference (scipy CSR)",
        PACKAGE,
        "1 ms",
        "3.1",
        SCIPY,
        "2 ms 6.0 %, 0.5 ms 1.6 %, 0.25 ms 0.47 %, 0.1 ms 0.076 %",
    ),
    peer(
        "NiftySim, TLED, StVK, f32",
        "2.5",
        "1.5 ms",
        "4.8",
        0.23,
        "",
    ),
    peer(
        "NVIDIA Newton, SemiImplicit, neo-Hookean, f32",
        "1.8.0",
        "1 ms",
        "3.9",
        0.44,
        "",
    ),
    peer(
        "SOFA, symplectic Euler, small strain",
        SOURCE,
        "1 ms",
        "4.0",
        0.57,
        "",
    ),
    peer("MuJoCo flex, Euler, StVK", "4.0.0", "1 ms", "3.4", 0.62, ""),
    peer(
        "VegaFEM, central difference",
        SOURCE,
        "1 ms",
        "4.0",
        0.93,
        "",
    ),
    peer(
        "SOFA, symplectic Euler, corotational",
        SOURCE,
        "1 ms",
        "3.7",
        0.96,
        "",
    ),
    peer(
        "Newmark (scipy SuperLU, factored once)",
        PACKAGE,
        "1 ms",
        "4.3",
        1.06,
        "5 ms 21.2 %, 10 ms 33.9 %",
    ),
    peer("SOFA, Newmark + CG, linear", SOURCE, "1 ms", "4.3", 5.2, ""),
    peer(
        "SOFA, Newmark + CG, corotational",
        SOURCE,
        "1 ms",
        "4.6",
        7.3,
        "",
    ),
    Peer {
        who: "any backward Euler (SOFA, MuJoCo \"discrete\", VegaFEM, Newton VBD, XPBD)",
        version: "as above",
        setting: "1 ms",
        error: "27",
        cost: None,
        note: "10 ms 54 %; never near 5 %",
    },
];
