//! Scenes.

/// A strip that begins rolled up, so that its ends overlap, and opens slowly.
pub const ROLLED: &str = r#"
[mesh]
block = { cells = [24, 1, 1], size = [0.24, 0.01, 0.01] }
[[region]]
density = 1000.0
model = "neo-hookean"
youngs_modulus = 10.0
poissons_ratio = 0.3
[[initial]]
displacement = ["(0.035 - z) * sin(x / 0.035) - x", 0.0, "0.035 - (0.035 - z) * cos(x / 0.035) - z"]
[run]
free_flight = true
duration = 0.05
integrator = "central-difference"
dt = 0.001
"#;
