//! Time that a moving blade adds to a run: the cost of steps without a cut, and the cost of a cut.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a measurement ends in a panic and prints"
)]

use std::fs;
use std::path::Path;
use std::time::Instant;

use sinew_scene::{Scene, Simulation};
use sinew_world::World;

/// Steps of a run.
const STEPS: usize = 500;

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let mut numbers = std::env::args().filter_map(|argument| argument.parse::<usize>().ok());
    let (laps, only) = (numbers.next().unwrap_or(5), numbers.next());
    println!(
        "us a step: no blade | blade | of these, steps that cut nothing, by number | steps that cut, each"
    );
    for (cells, dt) in [(10, 4e-4), (20, 2e-4)] {
        for model in ["linear", "neo-hookean"] {
            if only.is_some_and(|only| only != cells) {
                continue;
            }
            let scenes = [false, true].map(|cuts| scene(folder.path(), (cells, dt), model, cuts));
            let mut runs = [Vec::new(), Vec::new()];
            for _ in 0..laps {
                for ((scene, cuts), runs) in scenes.iter().zip([false, true]).zip(&mut runs) {
                    runs.push(Lap::of((scene.clone(), cuts)));
                }
            }
            let [plain, cut] = runs.map(|mut runs| {
                runs.sort_by(|a, b| a.all.total_cmp(&b.all));
                runs.swap_remove(runs.len() / 2)
            });
            println!(
                "{cells:3} cells {model:<12} {:8.1} | {:8.1} ({:+.0} %) | {:8.1} ({:+.0} %) {} | {:8.1} {} | after {:8.1}",
                plain.all,
                cut.all,
                100.0 * (cut.all / plain.all - 1.0),
                cut.idle.0,
                100.0 * (cut.idle.0 / plain.all - 1.0),
                cut.idle.1,
                cut.busy.0,
                cut.busy.1,
                cut.after,
            );
        }
    }
}

/// Times of a run (us).
#[derive(Default)]
struct Lap {
    /// Time of a step.
    all: f64,
    /// Median time of steps that cut nothing and of steps that cut, and their number.
    idle: (f64, usize),
    busy: (f64, usize),
    /// Time of a step after the blade has left the body.
    after: f64,
}

impl Lap {
    fn of((scene, is_cut): (Simulation, bool)) -> Self {
        let integrator = scene.integrator().unwrap();
        let mut world = World::following(scene, integrator).unwrap();
        world.step().unwrap();
        let begin = time();
        if !is_cut {
            world.advance(STEPS, &mut ()).unwrap();
            return Self {
                all: (time() - begin) / STEPS as f64,
                ..Self::default()
            };
        }
        let (mut idle, mut busy) = (Vec::new(), Vec::new());
        for _ in 0..STEPS {
            let (before, epoch) = (Instant::now(), world.topology_epoch());
            world.advance(1, &mut ()).unwrap();
            let took = 1e6 * before.elapsed().as_secs_f64();
            match world.topology_epoch() == epoch {
                true => idle.push(took),
                false => busy.push(took),
            }
        }
        let all = (time() - begin) / STEPS as f64;
        world.advance(STEPS / 10, &mut ()).unwrap();
        let begin = time();
        world.advance(STEPS / 2, &mut ()).unwrap();
        Self {
            all,
            idle: (median(&mut idle), idle.len()),
            busy: (median(&mut busy), busy.len()),
            after: (time() - begin) / (STEPS / 2) as f64,
        }
    }
}

fn median(of: &mut [f64]) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

/// Time that this thread has run (us).
fn time() -> f64 {
    let read = fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    read.split(' ').next().unwrap().parse::<f64>().unwrap() / 1e3
}

fn scene(folder: &Path, (cells, dt): (usize, f64), model: &str, cuts: bool) -> Simulation {
    let end = STEPS as f64 * dt;
    let (begin, end) = match cuts {
        true => (0.0, end),
        false => (10.0, 11.0),
    };
    fs::write(
        folder.join("strokes.csv"),
        format!(
            "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,{begin},0.047,-0.01,0.105,0.051,0.11,0.106\n1,{end},0.052,-0.01,0.02,0.056,0.11,0.021\n"
        ),
    )
    .unwrap();
    let text = format!(
        "gravity = [0.0, 0.0, -9.81]\n[mesh]\ncube = {{ cells = {cells}, edge = 0.1, split = \"kuhn\" }}\n[[region]]\ndensity = 1060.0\n\
         model = \"{model}\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.3\n[damping]\nmass = 10.0\n[[fixed]]\ngroup = \"bottom\"\n[cutting]\n\
         table = \"strokes.csv\"\nsnap = 0.25\n[run]\nduration = 1.0\nintegrator = \"central-difference\"\ndt = {dt}\nthreads = 1\n"
    );
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    Scene::load(path).and_then(Scene::build).unwrap()
}
