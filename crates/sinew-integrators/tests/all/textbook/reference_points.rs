//! Cost and error of each method, on the paper's scene and on a lightly damped cube of half its size, to 3 %.

use std::sync::OnceLock;

use crate::common::cube::{mass_damping, paper_cube, run, scene, springs};
use crate::common::{build, inner, plain, relative_error, saturation, taylor};
use sinew_core::spectrum::Spectrum;
use sinew_core::{LinearSystem, OptionValue, Options, StepReport};
use sinew_fem::Model;

/// A scene and its motion.
struct Scene {
    model: &'static Model,
    reference: Vec<Vec<f64>>,
}

impl Scene {
    fn of(model: &'static Model) -> Self {
        let reference = taylor::from_rest(model, 0.02, 50);
        Self { model, reference }
    }

    /// Error and work of a second in steps of 20 ms over `parts`.
    fn measure(&self, id: &str, options: &Options, parts: usize) -> (f64, StepReport) {
        let (instants, _, report) = run(self.model, &mut *build(id, options), parts);
        (relative_error(&instants, &self.reference), report.work)
    }

    #[track_caller]
    fn check(&self, id: &str, options: &Options, parts: usize, expected: f64, sweeps: u64) {
        let (error, work) = self.measure(id, options, parts);
        let what = format!("`{id}` with {options:?}, {parts} steps per 20 ms");
        assert!((error / expected - 1.0).abs() <= 0.03, "{what}: {error:e}");
        assert_eq!(work.sweeps, sweeps, "{what}");
    }

    #[track_caller]
    fn check_within(
        &self,
        id: &str,
        options: &Options,
        parts: usize,
        within: [f64; 2],
        sweeps: u64,
    ) {
        let (error, work) = self.measure(id, options, parts);
        let what = format!("`{id}` with {options:?}, {parts} steps per 20 ms");
        assert!(
            within[0] <= error && error <= within[1],
            "{what}: {error:e}"
        );
        assert_eq!(work.sweeps, sweeps, "{what}");
    }
}

/// The reproduction scene.
fn paper() -> &'static Scene {
    static SCENE: OnceLock<Scene> = OnceLock::new();
    SCENE.get_or_init(|| Scene::of(paper_cube()))
}

/// The cube of edge 0.1 m, damped by 10/s.
fn light() -> &'static Scene {
    static MODEL: OnceLock<Model> = OnceLock::new();
    static SCENE: OnceLock<Scene> = OnceLock::new();
    let model = MODEL.get_or_init(|| scene(10, 0.1, springs(0.0), mass_damping(10.0)));
    SCENE.get_or_init(|| Scene::of(model))
}

fn chebyshev(sweeps: u32) -> Options {
    plain().with("inner", inner("chebyshev", Some(f64::from(sweeps))))
}

fn degree(degree: u32) -> Options {
    plain().with_number("degree", f64::from(degree))
}

/// The Taylor series is the motion of a method that knows nothing of it.
#[test]
fn the_references_are_what_rk4_tends_to() {
    let (error, _) = paper().measure("rk4", &plain(), 20);
    assert!(error <= 1e-6, "{error:e}");
    let (error, _) = light().measure("rk4", &plain(), 40);
    assert!(error <= 1e-5, "{error:e}");
}

#[test]
fn the_light_scene_is_the_one_described() {
    let critical = Spectrum::of(light().model.operators()).critical_step();
    assert!((critical / 3.957e-3 - 1.0).abs() <= 1e-3, "{critical}");
}

#[test]
fn the_paper_s_network_and_the_stabilised_one_on_the_paper_s_scene() {
    let scene = paper();
    scene.check("cnn", &saturation(4.0), 1, 25.2, 50);
    scene.check("cnn-stabilised", &plain(), 1, 0.0592, 50);
    scene.check("cnn-stabilised", &plain(), 2, 0.0081, 100);
    scene.check("cnn-stabilised", &chebyshev(4), 1, 0.0125, 200);
    scene.check("cnn-stabilised", &chebyshev(8), 1, 0.00783, 400);
}

/// The start of the modified leapfrog takes three sweeps instead of two.
#[test]
fn the_other_explicit_methods_on_the_paper_s_scene() {
    let scene = paper();
    let three = plain().with_number("substeps", 3.0);
    scene.check("central-difference", &three, 1, 0.00123, 150);
    scene.check_within("modified-leapfrog", &three, 1, [3.5e-4, 5.0e-4], 301);
    // Two sweeps a degree and one for the residual.
    scene.check_within("propagator", &degree(8), 1, [0.0, 1e-8], 850);
}

#[cfg(feature = "implicit")]
#[test]
fn newmark_on_the_paper_s_scene() {
    let (error, work) = paper().measure("newmark", &plain(), 1);
    assert!((error / 0.00924 - 1.0).abs() <= 0.03, "{error:e}");
    assert_eq!((work.solves, work.factorizations), (50, 1));
}

#[test]
fn explicit_methods_on_the_light_scene() {
    let scene = light();
    scene.check("central-difference", &plain(), 20, 0.0028, 1000);
    scene.check("central-difference", &plain(), 6, 0.0148, 300);
    scene.check("modified-leapfrog", &plain(), 3, 0.0104, 301);
    scene.check("modified-leapfrog", &plain(), 4, 0.0072, 401);
    scene.check("modified-leapfrog", &plain(), 8, 8.9e-4, 801);
    scene.check("rk4", &plain(), 20, 1.1e-4, 4000);
}

#[test]
fn networks_on_the_light_scene() {
    let scene = light();
    scene.check("cnn-stabilised", &plain(), 1, 0.597, 50);
    scene.check("cnn-stabilised", &plain(), 4, 0.189, 200);
    scene.check("cnn-stabilised", &chebyshev(8), 1, 0.170, 400);
    scene.check("cnn-stabilised", &chebyshev(8), 4, 0.0071, 1600);
    scene.check("cnn", &saturation(4.0), 20, 18.0, 1000);
    scene.check("cnn", &saturation(4.0), 4, 41.0, 200);
    scene.check("cnn", &saturation(4.0), 1, 81.0, 50);
}

#[test]
fn propagators_on_the_light_scene() {
    let scene = light();
    scene.check_within("propagator", &degree(12), 1, [0.0, 4e-8], 1250);
    scene.check_within("propagator", &degree(10), 1, [0.0, 1e-5], 1050);
    let of_kind = |kind: &str| plain().with("kind", OptionValue::Text(kind.into()));
    let krylov = of_kind("krylov").with_number("degree", 20.0);
    // Twenty for the space and one for the residual.
    scene.check_within("propagator", &krylov, 1, [0.0, 4e-6], 1050);
    // No figure of others: half its tolerance, at what the two-step form takes.
    let two_step = of_kind("two-step").with_number("tolerance", 1e-6);
    scene.check_within("propagator", &two_step, 1, [0.0, 5e-7], 765);
}

#[cfg(feature = "implicit")]
#[test]
fn implicit_methods_on_the_light_scene() {
    for (id, parts, expected) in [
        ("newmark", 1, 0.141),
        ("newmark", 4, 0.036),
        ("newmark", 20, 0.0049),
        ("implicit-euler", 1, 0.156),
        ("implicit-euler", 20, 0.038),
    ] {
        let (error, work) = light().measure(id, &plain(), parts);
        assert!((error / expected - 1.0).abs() <= 0.03, "`{id}`: {error:e}");
        assert_eq!((work.solves, work.factorizations), (50 * parts as u64, 1));
    }
}
