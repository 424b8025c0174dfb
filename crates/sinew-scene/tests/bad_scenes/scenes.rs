//! Good scenes to be spoilt.

pub(crate) const BODY: &str = r#"title = "a cube"
[mesh]
cube = { cells = 2, edge = 0.2 }
[[region]]
density = 1060.0
model = "springs"
youngs_modulus = 3500.0
springs = { rule = "lloyd" }
[damping]
mass = 80.0
[[fixed]]
group = "sides"
[[load]]
name = "push"
group = "top"
traction = [0.0, 0.0, -500.0]
ramp = { kind = "step" }
[[initial]]
velocity = [0.0, 0.0, 1.0]
[run]
duration = 1.0
integrator = "newmark"
dt = 0.02
[[probe]]
name = "centre"
point = [0.1, 0.1, 0.1]
"#;

pub(crate) const OSCILLATOR: &str = r#"[oscillator]
mass = 0.1
stiffness = 100.0
damping = 1.0
velocity = -5.0
[run]
duration = 1.0
integrator = "newmark"
dt = 0.02
"#;
