//! Contents of plans.

use std::fs;

use crate::common::build;
use sinew_core::StableStep;
use sinew_mesh::structured::{self, Split};
use sinew_scene::{Plan, Scene, WarningKind};

const PAPERS_CUBE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/paper-cube.toml");

fn plan(text: &str) -> Plan {
    build(text).plan()
}

/// A plan's text with the same instruction set on every computer.
fn anywhere(plan: &Plan) -> String {
    let mut plan = plan.clone();
    // Before the text is broken into lines.
    for line in plan
        .sections
        .iter_mut()
        .flat_map(|section| &mut section.lines)
    {
        for set in ["portable", "avx2", "avx512"] {
            *line = line.replace(&format!(" by {set}"), " by SIMD");
        }
    }
    plan.to_string()
}

/// The paper's cube from the generator, which makes the same mesh as that in the file.
fn papers_cube() -> Plan {
    let scene = fs::read_to_string(PAPERS_CUBE).unwrap();
    let file = "file = \"../meshes/paper-cube.msh\"";
    assert!(scene.contains(file));
    plan(&scene.replace(file, "cube = { cells = 10, edge = 0.2, split = \"kuhn\" }"))
}

#[test]
fn the_papers_cube() {
    insta::assert_snapshot!(anywhere(&papers_cube()), @r#"
    The paper's cube, reproduction scene
    mesh        cube of 10 x 10 x 10 cells, edge 0.2 m, split "kuhn"
                1331 nodes, 6000 tetrahedra, 7930 edges, in 1 part; 0.008 m3, 8.48 kg
                groups `tissue` (6000 tetrahedra), `sides` (800 triangles), `top` (200 triangles),
                  `bottom` (200 triangles)
    regions     `tissue`: 6000 tetrahedra, 1060 kg/m3, springs "lloyd" not calibrated, E = 3500 Pa, nu =
                  1/4 (a property of spring networks)
                its springs average to 1.27 E (Voigt), 0.3904 to 2.857 E by direction
    damping     80 1/s times M, no matrix
    fixed       `sides` in x, y, z
                3993 -> 2673 degrees of freedom; 891 of 1331 nodes move, the others are removed
    loads       traction [0, 0, -500] Pa on `top` from t = 0: 20 N asked, 16.2 N act, 3.8 N fall on
                  fixed nodes
    probes      `top-centre`: node 1271, 0 m from the point
    matrices    linear: assembled once, no loop over elements afterwards
                K with 11247 blocks of 3 x 3, lumped M: 883.3 kB
                2/omega_max = 0.007915 s
    run         `cnn`, dt = 0.02 s, saturation = 4
                50 steps for 1 s, error taken at 51 instants
                `cnn` is stable up to dt = 0.001253 s
                no element sets the step alone: all allow about the same
                computed by 3 templates in the place of 891 rows (3028 bytes for 854 kB) in f64 by SIMD
    warning     dt = 0.02 s is 15.96 times the stable step of `cnn`, 0.001253 s
                only its clamp keeps `cnn` bounded at this step, and that makes no motion right: on the
                  paper's cube, in steps of 16 times the stable one, its error is 2520 %;
                  `cnn-stabilised` takes such a step; saturation = "auto" cuts it into stable ones
    "#);
}

#[test]
fn the_papers_cube_from_a_mesh_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::create_dir(file("meshes")).unwrap();
    fs::create_dir(file("scenes")).unwrap();
    let cube = structured::cube(10, 0.2, Split::Kuhn).unwrap();
    let mut mesh = fs::File::create(file("meshes/paper-cube.msh")).unwrap();
    sinew_mesh::write_msh41_ascii(&cube.to_mesh(), &mut mesh).unwrap();
    fs::copy(PAPERS_CUBE, file("scenes/paper-cube.toml")).unwrap();

    let scene = Scene::load(file("scenes/paper-cube.toml")).unwrap();
    let from_file = scene.build().unwrap().plan();
    let generated = papers_cube();
    assert_eq!(from_file.sections[0].heading, "mesh");
    assert_eq!(from_file.sections[0].lines[0], "../meshes/paper-cube.msh");
    assert_eq!(
        from_file.sections[0].lines[1..],
        generated.sections[0].lines[1..]
    );
    assert_eq!(from_file.sections[1..], generated.sections[1..]);
    assert_eq!(from_file.warnings, generated.warnings);
}

#[test]
fn the_numbers_of_the_papers_cube() {
    let plan = papers_cube();
    assert!((plan.critical_step - 7.9e-3).abs() < 0.05e-3);
    let StableStep::UpTo(limit) = plan.stable_step else {
        panic!("{:?}", plan.stable_step);
    };
    // Forward Euler under mass damping: alpha/omega_max^2 where the fastest mode swings.
    let expected = 80.0 * (plan.critical_step / 2.0).powi(2);
    assert!(
        (limit / expected - 1.0).abs() < 1e-9,
        "{limit} s, {expected} s"
    );
    let [warning, clamped] = &plan.warnings[..] else {
        panic!("{:?}", plan.warnings);
    };
    assert!(warning.what.starts_with("dt = 0.02 s is "), "{warning}");
    assert_eq!(clamped.kind, WarningKind::ClampedNetwork);
}

/// The lines about the mesh in the plan of a body with this mesh.
fn mesh_lines(mesh: &str) -> Vec<String> {
    let scene = format!(
        "mesh = {{ {mesh} }}
region = [{{ density = 1000.0, model = \"linear\", youngs_modulus = 1e4, poissons_ratio = 0.3 }}]
fixed = [{{ group = \"bottom\" }}]
run = {{ duration = 1.0, integrator = \"newmark\", dt = 0.1 }}
"
    );
    plan(&scene).sections[0].lines.clone()
}

#[test]
fn a_block_with_the_cells_of_a_cube_is_the_cube() {
    let cube = mesh_lines("cube = { cells = 3, edge = 0.3, split = \"mirrored\" }");
    let block =
        mesh_lines("block = { cells = [3, 3, 3], size = [0.3, 0.3, 0.3], split = \"mirrored\" }");
    assert_eq!(
        block[0],
        "block of 3 x 3 x 3 cells, 0.3 x 0.3 x 0.3 m, split \"mirrored\""
    );
    assert_eq!(cube[1..], block[1..]);
}

#[test]
fn a_block_scaled_and_turned() {
    let block = "block = { cells = [24, 4, 4], size = [300, 50, 50], split = \"kuhn\" }";
    let changed = format!("{block}, scale = 0.001, rotate = {{ axis = [0, 0, 2], degrees = 90 }}");
    insta::assert_snapshot!(mesh_lines(&changed).join("\n"), @r#"
    block of 24 x 4 x 4 cells, 300 x 50 x 50, split "kuhn"
    scaled by 0.001, then turned by 90 degrees about [0, 0, 2] through the origin
    625 nodes, 2304 tetrahedra, 3344 edges, in 1 part; 0.00075 m3, 0.75 kg
    groups `tissue` (2304 tetrahedra), `sides` (448 triangles), `top` (192 triangles), `bottom` (192 triangles)
    "#);
    let simulation = build(&format!(
        "mesh = {{ {changed} }}
region = [{{ density = 1000.0, model = \"linear\", youngs_modulus = 1e4, poissons_ratio = 0.3 }}]
run = {{ duration = 1.0, integrator = \"newmark\", dt = 0.1 }}
"
    ));
    let mesh = &simulation.model().body().unwrap().mesh;
    assert_eq!(mesh.bounding_box(), ([-0.05, 0.0, 0.0], [0.0, 0.3, 0.05]));
}

#[test]
fn the_papers_oscillator() {
    insta::assert_snapshot!(plan(include_str!("../../../../scenes/paper-oscillator.toml")), @r#"
    The paper's oscillator
    oscillator  0.1 kg on 100 N/m and 1 N s/m: one cell, one layer
    initial     u = 0 m, v = -5 m/s
    matrices    linear: assembled once, no loop over elements afterwards
                K with 1 block of 1 x 1, lumped M: 36 B
                2/omega_max = 0.06325 s
    run         `cnn`, dt = 0.02 s, saturation = 4
                50 steps for 1 s, error taken at 51 instants
                `cnn` is stable up to dt = 0.01 s
                computed by plain loops in f64
    warning     dt = 0.02 s is 2 times the stable step of `cnn`, 0.01 s
                only its clamp keeps `cnn` bounded at this step, and that makes no motion right: on the
                  paper's cube, in steps of 16 times the stable one, its error is 2520 %;
                  `cnn-stabilised` takes such a step; saturation = "auto" cuts it into stable ones
    "#);
}

/// Gravity, damping of several materials, partial supports, an initial state and probes at fixed nodes.
#[test]
fn a_scene_with_everything() {
    let text = r#"
gravity = [0, 0, -9.81]
[mesh]
cube = { cells = 2, edge = 0.1, split = "mirrored" }
[[region]]
density = 1000
model = "springs"
youngs_modulus = 1e4
springs = { rule = "van-gelder", calibrate = true, damping_ratio = 0.1 }
[damping]
mass = 1
stiffness = 1e-4
[[fixed]]
group = "bottom"
axes = "zy"
[[fixed]]
group = "sides"
axes = "x"
[[load]]
name = "press"
group = "top"
pressure = 100
ramp = { kind = "sin2", rise = 0.1 }
[[initial]]
static = ["press", "gravity"]
[[initial]]
group = "top"
stretch = [0.1, 0, 0]
[run]
duration = 0.01
integrator = "newmark"
dt = 0.02
[[probe]]
name = "edge"
point = [0, 0, 0]
[[probe]]
name = "centre"
point = [0.05, 0.05, 0.06]
"#;
    insta::assert_snapshot!(plan(text), @r#"
    mesh        cube of 2 x 2 x 2 cells, edge 0.1 m, split "mirrored"
                27 nodes, 48 tetrahedra, 98 edges, in 1 part; 0.001 m3, 1 kg
                groups `tissue` (48 tetrahedra), `sides` (32 triangles), `top` (8 triangles), `bottom`
                  (8 triangles)
    regions     whole mesh: 48 tetrahedra, 1000 kg/m3, springs "van-gelder" calibrated, E = 10000 Pa, nu
                  = 1/4 (a property of spring networks)
                its springs average to 1 E (Voigt), 0.7317 to 1.355 E by direction
    damping     1 1/s times M, no matrix; 0.0001 s times K, in the product with K; dashpots along
                  springs, a matrix of their own
    fixed       `bottom` in y, z
                `sides` in x
                81 -> 39 degrees of freedom; 19 of 27 nodes move, the others are removed
                18 fixed components belong to nodes that move in other directions
    loads       "press", pressure 100 Pa on `top` rising for 0.1 s: 1 N act
                gravity [0, 0, -9.81] m/s2: 9.81 N asked, 7.358 N act, 2.453 N fall on fixed nodes
    initial     at rest under press, gravity, solved once
                stretch [0.1, 0, 0] about [0, 0, 0] m of `top`: 9 of 9 nodes move
    probes      `edge`: node 1, 0 m from the point, fixed in x, y and z
                `centre`: node 14, 0.01 m from the point
    matrices    linear: assembled once, no loop over elements afterwards
                K and D with 135 blocks of 3 x 3, lumped M: 20.6 kB
                2/omega_max = 0.01273 s
    run         `newmark`, dt = 0.02 s
                1 step for 0.01 s, error taken at 51 instants
                `newmark` is stable at any step
    warning     [[initial]] 2 displaces 5 nodes that are held or moved there: they stay, and the body is
                  torn from them at t = 0; displace other nodes, or by a stretch whose origin is at the
                  support
                dt = 0.02 s is longer than the duration, 0.01 s; `sinew run` takes one step that ends
                  with it
    "#);
}

#[test]
fn an_undamped_scene_says_so() {
    let text = r#"
[mesh]
cube = { cells = 2, edge = 0.1 }
[[region]]
density = 1000
model = "linear"
youngs_modulus = 1e4
poissons_ratio = 0.3
[run]
duration = 1
integrator = "forward-euler"
dt = 0.001
"#;
    let plan = plan(text).to_string();
    for line in [
        "damping     none, left out of every step",
        "fixed       nothing: all 81 degrees of freedom move",
        "warning     the body has no support: 48 tetrahedra with 0.001 m3 at [0, 0, 0] m",
        "            `forward-euler` is unstable on this scene at any dt",
    ] {
        assert!(plan.contains(line), "{plan}");
    }
    assert!(!plan.contains("probes"), "{plan}");
}

/// Plain loops for bodies that fast machines do not support, and the plan for a precision that no fast machine offers.
#[test]
fn plain_loops_are_named_with_their_reason() {
    let tissue = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
                  youngs_modulus = 5000.0\npoissons_ratio = 0.4\nprony = [[0.3, 0.05]]\n[[fixed]]\ngroup = \"bottom\"\n\
                  [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = 0.001\n";
    let said = |text: &str| {
        plan(text)
            .to_string()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let in_f64 = said(tissue);
    let named = "computed by plain loops in f64 by one thread, as no other machine takes stiffness damping of a law, or memory";
    assert!(in_f64.contains(named), "{in_f64}");
    let in_f32 = said(&format!("{tissue}precision = \"f32\"\n"));
    let refused = "it is refused: `central-difference`: precision = \"f32\" is for matrices, and for hyperelastic bodies without";
    assert!(in_f32.contains(refused), "{in_f32}");
}
