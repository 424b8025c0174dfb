//! Cut faces, which do not pass through each other.

use std::fs;
use std::path::Path;

use sinew_world::World;

use crate::common::{advance, following};
use sinew_core::{LinearSystem, State, System};
use sinew_scene::{Overlap, OverlapWatch, Scene, Simulation};

const E: f64 = 3500.0;
const EXPLICIT: &str = "integrator = \"symplectic-euler\"\ndt = 4e-4\n";

/// A bar along z with a fixed foot, cut through between these heights (m).
fn cut_bar(folder: &Path, height: [f64; 2], more: &str, lips: &str, run: &str) -> Simulation {
    bar_of_strokes(folder, &across(height), more, lips, run)
}

/// A blade along y that moves along x before the motion begins.
fn across([low, high]: [f64; 2]) -> String {
    format!(
        "1,-2,-0.001,-0.01,{low},-0.001,0.03,{low}\n1,-1,0.021,-0.01,{high},0.021,0.03,{high}\n"
    )
}

fn bar_of_strokes(folder: &Path, strokes: &str, more: &str, lips: &str, run: &str) -> Simulation {
    let strokes = format!("stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n{strokes}");
    let text = format!(
        "{more}[mesh]\nblock = {{ cells = [2, 2, 6], size = [0.02, 0.02, 0.06], split = \"kuhn\" }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
         youngs_modulus = {E}\npoissons_ratio = 0.0\n[[fixed]]\nwhere = {{ below = {{ z = 0.0 }} }}\n{TIP}[cutting]\ntable = \"strokes.csv\"\n{lips}\n\
         [run]\nduration = 1.5\n{run}"
    );
    let path = folder.join("scene.toml");
    fs::write(folder.join("strokes.csv"), strokes).unwrap();
    fs::write(&path, text).unwrap();
    Scene::load(path).and_then(Scene::build).unwrap()
}

const DAMPED: &str = "[damping]\nmass = 40.0\nstiffness = 0.0\n";
const DOWN: &str = "gravity = [0.0, 0.0, -9.81]\n";
const TIP: &str = "[[probe]]\nname = \"tip\"\npoint = [0.02, 0.02, 0.06]\n";

/// Overlap of surfaces at the end of a run.
fn overlap(run: &World) -> Option<Overlap> {
    let mut watch = OverlapWatch::new(run.body().model().body().unwrap());
    watch.look_at_state(run.state()).unwrap();
    watch.into_deepest()
}

/// The mean displacement (m) of the top along -z at the end of a run, and the world at that time.
fn sunk(scene: Simulation) -> (f64, World) {
    let steps = scene.run().steps;
    let mut run = following(scene);
    advance(&mut run, steps);
    let body = run.body().model().body().unwrap();
    let mut u = vec![[0.0; 3]; body.mesh.points.len()];
    let (t, state) = (run.state().t(), run.state());
    body.model.displacements_at(t, &state.u, &mut u).unwrap();
    let all = body.mesh.points.iter().zip(&u);
    let top: Vec<f64> = all
        .filter(|(point, _)| point[2] > 0.0599)
        .map(|(_, u)| -u[2])
        .collect();
    (top.iter().sum::<f64>() / top.len() as f64, run)
}

#[test]
fn a_cut_bar_bears_what_rests_on_it_as_a_whole_one() {
    let folder = tempfile::tempdir().unwrap();
    let more = format!("{DOWN}{DAMPED}");
    let of = |height: f64, lips: &str| {
        let scene = cut_bar(folder.path(), [height; 2], &more, lips, EXPLICIT);
        sunk(scene)
    };
    // A blade above the bar cuts nothing.
    let (whole, run) = of(0.07, "lips = \"contact\"");
    assert_eq!(run.cutter().unwrap().pieces(), 1);
    // The tip of a column under its own weight sinks by rho g L^2 / (2 E).
    let expected = 1000.0 * 9.81 * 0.06_f64.powi(2) / (2.0 * E);
    assert!((whole / expected - 1.0).abs() < 0.02, "{whole} {expected}");
    let (met, run) = of(0.03, "lips = \"contact\"");
    assert_eq!(run.cutter().unwrap().pieces(), 2);
    // Lips slide: only what the unequal loads of corners shear across the cut is lost.
    assert!((met / whole - 1.0).abs() < 0.01, "{met} {whole}");
    let contact = run.body().model().contact().unwrap();
    let report = contact.lips_report(run.state());
    assert_eq!((contact.lip_pairs(), report.contacts), (9, 9));
    let (free, _) = of(0.03, "lips = \"free\"");
    assert!(free > 10.0 * whole, "{free} {whole}");
}

#[test]
fn a_plate_on_a_cut_bar_presses_with_e_a_d_over_l() {
    let folder = tempfile::tempdir().unwrap();
    let plate = "[damping]\nmass = 40.0\nstiffness = 0.0\n[[tool]]\nname = \"plate\"\nshape = { plane = {} }\ntable = \"plate.csv\"\n";
    let turn = std::f64::consts::PI;
    let poses = format!(
        "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n0,0,0,0.06,{turn},0,0\n0.2,0,0,0.058,{turn},0,0\n"
    );
    fs::write(folder.path().join("plate.csv"), poses).unwrap();
    let crossing =
        "2,-0.6,0.01,-0.001,-0.01,0.01,-0.001,0.07\n2,-0.5,0.01,0.021,-0.01,0.01,0.021,0.07\n";
    let pressed = |crossing: &str, lips: &str| {
        let strokes = across([0.03; 2]) + crossing;
        let scene = bar_of_strokes(folder.path(), &strokes, plate, lips, EXPLICIT);
        let (top, run) = sunk(scene);
        let contact = run.body().model().contact().unwrap();
        let force = contact.report(run.state(), 0).force[2];
        let residual = contact.lips_report(run.state()).largest_residual;
        let said = run.body().left_by_tools(run.state()).join("\n");
        let depth = overlap(&run).map(|overlap| overlap.depth);
        (
            force,
            residual,
            (run.cutter().unwrap().pieces(), top, said, depth),
        )
    };
    let expected = E * 4e-4 * 0.002 / 0.06;
    // Where cuts cross, four nodes are there for one.
    for (crossing, pieces) in [("", 2), (crossing, 4)] {
        let (met, residual, (now, _, said, depth)) = pressed(crossing, "lips = \"contact\"");
        assert!((met / expected - 1.0).abs() < 1e-9, "{met} {expected}");
        assert!(residual <= 1e-12, "{residual}");
        assert_eq!((now, said.as_str(), depth), (pieces, "", None));
    }
    // The loose half goes into the other as a rigid one, as far as the plate pushes it and a little
    // further on its own.
    let (free, _, (_, top, said, depth)) = pressed("", "lips = \"free\"");
    assert!(free < 0.01 * expected, "{free} {expected}");
    assert!((depth.unwrap() / top - 1.0).abs() < 1e-3, "{depth:?} {top}");
    let overlap: Vec<f64> = said
        .split(' ')
        .filter_map(|word| word.parse().ok())
        .collect();
    let (volume, whole) = (4e-4 * top, 4e-4 * 0.06);
    assert!(top > 0.002 && top < 0.0023, "{top}");
    for (said, expected) in overlap.iter().zip([volume, volume / whole]) {
        assert!(
            (said / expected - 1.0).abs() < 1e-3,
            "{overlap:?} {expected}"
        );
    }
    insta::assert_snapshot!(said, @"faces of the cut overlap by 8.834e-7 m3 in the end, 0.03681 of the body's volume");
}

/// Energy (J) of a body that falls freely, in the middle of the last step of symplectic Euler.
#[derive(Clone, Copy)]
struct Energy {
    sum: f64,
    /// The largest of its parts so far.
    scale: f64,
}

impl Energy {
    const NONE: Self = Self {
        sum: f64::INFINITY,
        scale: 0.0,
    };

    /// Energy after one more step of `dt` (s), which must not be higher.
    fn that_fell(self, run: &World, dt: f64) -> Self {
        let body = run.body().model().body().unwrap();
        let (model, State { u, v, .. }) = (&body.model, run.state());
        let quadratic = |x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            model.operators().stiffness().multiply(x, &mut out);
            x.iter().zip(&out).map(|(x, out)| x * out).sum::<f64>()
        };
        let mean: Vec<f64> = u.iter().zip(v).map(|(u, v)| u - 0.5 * dt * v).collect();
        let moving: f64 = v.iter().zip(model.mass()).map(|(v, m)| m * v * v).sum();
        let gravity = body.problem.gravity.unwrap_or_default()[2];
        let z = (2..u.len()).step_by(3);
        let lifted: f64 = z.map(|z| -gravity * model.mass()[z] * mean[z]).sum();
        let kinetic = 0.5 * (moving - dt * dt / 4.0 * quadratic(v));
        let sum = kinetic + 0.5 * quadratic(&mean) + lifted;
        let scale = self.scale.max(kinetic).max(lifted.abs());
        let bound = self.sum + 1e-11 * scale;
        assert!(
            sum <= bound,
            "{sum} after {} at {}",
            self.sum,
            run.state().t()
        );
        Self { sum, scale }
    }
}

#[test]
fn lips_that_bounce_on_each_other_bring_in_no_energy() {
    let folder = tempfile::tempdir().unwrap();
    for heights in [[0.03; 2], [0.022, 0.038]] {
        let scene = cut_bar(folder.path(), heights, DOWN, "snap = 0.25", EXPLICIT);
        let dt = scene.run().dt;
        let mut run = following(scene);
        advance(&mut run, 1);
        assert_eq!(run.cutter().unwrap().pieces(), 2);
        let (mut energy, mut met): (Energy, usize) = (Energy::NONE, 0);
        for step in 0..2000 {
            advance(&mut run, 1);
            energy = energy.that_fell(&run, dt);
            if heights[0] == heights[1] && step % 100 == 0 {
                assert_eq!(overlap(&run), None);
            }
            let contact = run.body().model().contact().unwrap();
            met += contact.lips_report(run.state()).contacts;
        }
        assert!(met > 1000, "{met}");
    }
}

#[test]
fn lips_that_overlap_as_a_blade_cuts_on_bring_in_no_energy() {
    let folder = tempfile::tempdir().unwrap();
    let strokes = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,0.005,-0.01,-0.01,0.005,-0.01,0.035,0.005\n1,0.015,0.06,-0.01,0.035,0.06,0.035,0.035\n\
         2,0.016,0.025,-0.01,-0.01,0.025,-0.01,0.06\n2,0.025,0.025,0.035,-0.01,0.025,0.035,0.06\n";
    fs::write(folder.path().join("strokes.csv"), strokes).unwrap();
    let text = "[mesh]\nblock = { cells = [2, 1, 2], size = [0.05, 0.025, 0.05] }\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
         youngs_modulus = 1e4\npoissons_ratio = 0.45\n[[fixed]]\ngroup = \"bottom\"\n[[initial]]\nwhere = { above = { z = 0.02 } }\n\
         velocity = [\"0.135573 - 20*(z-0.0375)\", -0.139571, \"-0.109853 + 20*(x-0.025)\"]\n\
         [cutting]\ntable = \"strokes.csv\"\nsnap = 0\n[run]\nduration = 0.2\nintegrator = \"symplectic-euler\"\ndt = 2e-4\n";
    let path = folder.path().join("scene.toml");
    fs::write(&path, text).unwrap();
    let scene = Scene::load(path).and_then(Scene::build).unwrap();
    let dt = scene.run().dt;
    let mut run = following(scene);
    let (mut energy, mut met_before_cuts) = (Energy::NONE, 0);
    for _ in 0..300 {
        let (changes, contact) = (run.cutter().unwrap().totals().changes, &run.state().contact);
        let pushed = run.body().model().contact();
        let pushed = pushed.filter(|_| !contact.is_empty());
        let met = pushed.map_or(0, |tools| tools.lips_report(run.state()).contacts);
        advance(&mut run, 1);
        // Copies lie where their originals lie: without snapping, a cut changes no energy.
        energy = energy.that_fell(&run, dt);
        if run.cutter().unwrap().totals().changes > changes {
            met_before_cuts += met;
        }
    }
    assert!(run.cutter().unwrap().totals().changes > 4);
    assert!(met_before_cuts > 0);
}

#[test]
fn a_method_that_nothing_can_push_goes_on_without_lips() {
    let folder = tempfile::tempdir().unwrap();
    let newmark = "integrator = \"newmark\"\ndt = 4e-3\n";
    let more = format!("{DOWN}{DAMPED}");
    let scene = cut_bar(folder.path(), [0.03; 2], &more, "", newmark);
    let (sunk, _) = sunk(scene);
    assert!(sunk > 0.05, "{sunk}");
}
