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

/// The same tables in other spellings: dotted keys, and lists of tables on a line.
pub(crate) const DOTTED: &str = r#"mesh.cube = { cells = 2, edge = 0.2 }
region = [{ density = 1060.0, model = "linear", youngs_modulus = 3500.0, poissons_ratio = 0.3 }]
damping.mass = 80.0
fixed = [{ group = "bottom" }, { group = "sides", axes = "x" }]
run.duration = 1.0
run.integrator = "newmark"
run.dt = 0.02
"#;

/// A cube with stiffness damping whose top is moved, and its bottom sideways.
pub(crate) const MOVED: &str = r#"[mesh]
cube = { cells = 2, edge = 0.2 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
stiffness = 0.01
[[fixed]]
group = "bottom"
axes = "yz"
[[move]]
group = "top"
axes = "z"
displacement = [0.0, 0.0, -0.01]
ramp = { kind = "sin2", rise = 0.2 }
[[move]]
group = "bottom"
axes = "x"
velocity = [0.05, 0.0, 0.0]
[run]
duration = 1.0
integrator = "newmark"
dt = 0.02
"#;

/// A cube whose tables use no group.
pub(crate) const PLACED: &str = r#"[mesh]
cube = { cells = 2, edge = 0.2 }
[[region]]
where = { box = [[0.0, 0.0, 0.0], [0.1, 0.2, 0.2]] }
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[region]]
where = "rest"
density = 1000.0
model = "linear"
youngs_modulus = 35e3
poissons_ratio = 0.3
[[fixed]]
where = { below = { z = 0.0 } }
[[load]]
where = { face = { normal = [0.0, 0.0, 1.0], angle = 20.0 }, above = { x = 0.1 } }
traction = [0.0, 0.0, -500.0]
[[move]]
where = { plane = { point = [0.0, 0.0, 0.1], normal = [0.0, 0.0, 1.0], within = 0.01 }, below = { y = 0.0 } }
axes = "y"
velocity = [0.0, 0.05, 0.0]
[[initial]]
where = { sphere = { center = [0.2, 0.2, 0.2], radius = 0.12 } }
velocity = [0.0, 0.0, 1.0]
[[probe]]
name = "corner"
where = { nodes = [27] }
[run]
duration = 1.0
integrator = "newmark"
dt = 0.02
"#;

/// A cube on which a probe comes down, and which a grasper grasps from the side.
pub(crate) const TOUCHED: &str = r#"[mesh]
cube = { cells = 2, edge = 0.2 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[[tool]]
name = "probe"
shape = { sphere = { radius = 0.11 } }
start = [0.1, 0.1, 0.32]
velocity = [0.0, 0.0, -0.01]
friction = 0.2
[[tool]]
name = "jaws"
shapes = [{ capsule = { radius = 0.1, length = 0.02 } }, { box = { size = [0.2, 0.2, 0.2] }, at = [0.0, 0.0, 0.0] }]
start = [0.1, -0.2, 0.1]
hold = true
touches = "sides"
starts_inside = "push"
grasp = { from = 0.4, to = 1.2 }
[run]
duration = 1.0
integrator = "symplectic-euler"
dt = 0.001
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

/// A block in millimetres that is scaled and turned.
pub(crate) const BLOCK: &str = r#"[mesh]
block = { cells = [3, 1, 2], size = [300, 50, 100], split = "mirrored" }
scale = 0.001
rotate = { axis = [0, 0, 1], degrees = 90 }
[[region]]
density = 1000.0
model = "linear"
youngs_modulus = 1e4
poissons_ratio = 0.3
[[fixed]]
group = "bottom"
[run]
duration = 0.1
integrator = "newmark"
dt = 0.02
"#;
