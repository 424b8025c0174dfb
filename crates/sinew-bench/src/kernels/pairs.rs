//! Runs of scenes in pairs: with a piece of work and without it, or by two ways to the same motion.

use serde::Serialize;
use sinew_scene::{Scene, SceneSource};
use sinew_verify::LabError;
use sinew_world::World;

use super::elements::ElementMark;
use crate::median::median;
use crate::timed::time;

/// A run of a scene beside another one that differs by one thing.
#[derive(Clone, Debug, Serialize)]
pub struct PairRow {
    /// The body.
    pub mesh: String,
    /// Subject of the run.
    pub run: &'static str,
    /// Subject of the other one.
    pub beside: &'static str,
    /// CPU time (s) of a simulated second of the run, on this computer, on one thread: steps alone, without outputs.
    pub cpu_s_per_s: f64,
    /// CPU time of the run over that of the other one, median of laps in turn.
    pub ratio: f64,
    /// Relative difference of the displacements at the end, where both compute the same motion.
    pub off: Option<f64>,
    /// The largest ratio that is fine.
    pub mark: f64,
}

/// Two scenes that differ by one thing.
struct Pair {
    mesh: String,
    run: &'static str,
    beside: &'static str,
    scenes: [String; 2],
    steps: usize,
    /// True if both compute the same motion.
    is_same: bool,
    mark: f64,
}

impl Pair {
    /// Runs of a cube that compute different motions.
    fn of(cells: usize, run: &'static str, scenes: [String; 2], steps: usize) -> Self {
        Self {
            mesh: format!("cube {}^3", cells + 1),
            run,
            beside: "",
            scenes,
            steps,
            is_same: false,
            mark: f64::INFINITY,
        }
    }
}

/// Tissue on a fixed base.
fn tissue(cells: usize, law: &str, more: &str, run: &str) -> String {
    format!(
        "[mesh]\nblock = {{ cells = [{cells}, {cells}, {cells}], size = [0.1, 0.1, 0.1], split = \"kuhn\" }}\n\
         [[region]]\ndensity = 1060.0\nmodel = \"{law}\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n\
         [[fixed]]\ngroup = \"bottom\"\n{more}[run]\n{run}"
    )
}

const EXPLICIT: &str = "duration = 10.0\nintegrator = \"central-difference\"\n";

/// Newmark's steps of 2.5 ms with and without a factor of the tangent, on a cube pulled by a sudden traction.
fn without_factor(cells: usize, steps: usize, mark: f64) -> Pair {
    let pull = "[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, 600.0]\n";
    let scene = |factor: &str| {
        let run = format!(
            "duration = 10.0\nintegrator = \"newmark\"\ndt = 0.0025\nfactor = \"{factor}\"\n"
        );
        tissue(cells, "neo-hookean", pull, &run)
    };
    let run = "newmark, 2.5 ms, as it chooses";
    Pair {
        beside: "the same by a factor",
        is_same: true,
        mark,
        ..Pair::of(cells, run, ["auto", "always"].map(scene), steps)
    }
}

/// Three balls with friction that press into a linear cube and are drawn over it, by a machine.
fn with_tools(cells: usize, machine: &str, run: &'static str, steps: usize) -> Pair {
    let balls = [
        ("one", 0.025, 0.025),
        ("two", 0.075, 0.03),
        ("three", 0.05, 0.075),
    ];
    let tools: String = balls
        .iter()
        .map(|(name, x, y)| {
            format!(
                "[[tool]]\nname = \"{name}\"\nshape = {{ sphere = {{ radius = 0.03 }} }}\nstart = [{x}, {y}, 0.131]\n\
                 velocity = [0.002, 0.0, -0.001]\nfriction = 0.4\n"
            )
        })
        .collect();
    let scene = |tools: &str| {
        let damping = "[damping]\nmass = 20.0\n";
        let run = format!("{EXPLICIT}dt = 0.001\nmachine = \"{machine}\"\n");
        tissue(cells, "linear", &format!("{damping}{tools}"), &run)
    };
    Pair {
        beside: "the same without tools",
        mark: 1.05,
        ..Pair::of(cells, run, [&tools, ""].map(scene), steps)
    }
}

/// A blade that goes down through nine tenths of a cube.
fn with_a_blade(cells: usize, law: &str, run: &'static str, steps: usize) -> Pair {
    let way = 0.092;
    let speed = 1000.0 * way / steps as f64;
    let blade = format!(
        "[[tool]]\nname = \"scalpel\"\nshape = {{ blade = {{ length = 0.14 }} }}\nstart = [0.05, 0.05, 0.102]\n\
         rotation = [{}, 0.0, 0.0]\nvelocity = [0.0, 0.0, -{speed}]\n[cutting]\ntool = \"scalpel\"\n",
        std::f64::consts::FRAC_PI_2
    );
    let scene = |blade: &str| tissue(cells, law, blade, &format!("{EXPLICIT}dt = 0.001\n"));
    Pair {
        beside: "the same without a blade",
        mark: 1.25,
        ..Pair::of(cells, run, [&blade, ""].map(scene), steps)
    }
}

fn pairs(quick: bool) -> Vec<Pair> {
    let cells = if quick { 4 } else { 10 };
    let of = |whole: usize| if quick { whole / 50 } else { whole };
    let mut pairs = vec![
        without_factor(cells, of(100).max(2), 1.0 / 6.0),
        with_tools(
            cells,
            "repeated",
            "three tools with friction, templates",
            of(5000),
        ),
        with_tools(
            cells,
            "general",
            "three tools with friction, general",
            of(5000),
        ),
        with_a_blade(cells, "linear", "a blade through a linear body", of(1000)),
        with_a_blade(
            cells,
            "neo-hookean",
            "a blade through neo-hookean tissue",
            of(1000),
        ),
    ];
    if !quick {
        pairs.insert(1, without_factor(20, 4, 1.0 / 15.0));
    }
    pairs
}

/// Measures all pairs.
pub(super) fn rows(quick: bool) -> Result<Vec<PairRow>, LabError> {
    pairs(quick).iter().map(|pair| row(pair, quick)).collect()
}

fn row(pair: &Pair, quick: bool) -> Result<PairRow, LabError> {
    // A long run is as good as several short ones.
    let laps = if quick || pair.steps < 10 { 1 } else { 3 };
    let mut times = [Vec::new(), Vec::new()];
    let mut ends = [Vec::new(), Vec::new()];
    let mut simulated = 0.0;
    for _ in 0..laps {
        for ((scene, times), end) in pair.scenes.iter().zip(&mut times).zip(&mut ends) {
            let simulation = Scene::parse(SceneSource::new("pair.toml", scene.clone()))?.build()?;
            let integrator = simulation.integrator()?;
            let mut world = World::following(simulation, integrator)?;
            // The first step sets up the method.
            world.advance(1, &mut ())?;
            let (done, spent) = time(|| world.advance(pair.steps, &mut ()));
            done?;
            times.push(spent.cpu);
            simulated = world.dt() * pair.steps as f64;
            end.clone_from(&world.state().u);
        }
    }
    let [own, others] = &times;
    let mut ratios: Vec<f64> = own
        .iter()
        .zip(others)
        .map(|(own, other)| own / other)
        .collect();
    let mut own = own.clone();
    let [end, other_end] = ends;
    Ok(PairRow {
        mesh: pair.mesh.clone(),
        run: pair.run,
        beside: pair.beside,
        cpu_s_per_s: median(&mut own) / simulated,
        ratio: median(&mut ratios),
        off: pair.is_same.then(|| super::pulled::apart(&end, &other_end)),
        mark: pair.mark,
    })
}

/// The ratios beside their marks.
pub(super) fn marks(rows: &[PairRow]) -> Vec<ElementMark> {
    let mark = |row: &PairRow| ElementMark {
        row: format!("{}, {}", row.mesh, row.run),
        what: "time over the other",
        value: row.ratio,
        mark: row.mark,
        reached: row.ratio <= row.mark,
    };
    rows.iter().map(mark).collect()
}
