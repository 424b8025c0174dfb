//! Latency and rate of pictures that follow the user's tool pose.

use std::time::{Duration, Instant};

use serde_json::Value;
use sinew_scene::output::say;

use super::bench::{Bench, require};
use super::cdp::{Mouse, Tab};
use super::hand::{grip, open};
use super::served::Served;
use crate::failure::Failure;

/// A body with its marks.
struct Case {
    name: &'static str,
    cells: usize,
    method: &'static str,
    dt: f64,
    /// Minimum number of pictures per second.
    rate: f64,
    /// Maximum time (ms) from a drag to its picture, for half and for 95 % of drags.
    latency: [f64; 2],
}

const CASES: [Case; 2] = [
    Case {
        name: "1331 nodes, 1 ms",
        cells: 10,
        method: "symplectic-euler",
        dt: 0.001,
        rate: 60.0,
        latency: [20.0, 40.0],
    },
    Case {
        name: "19683 nodes, 16.6 ms",
        cells: 26,
        method: "cnn-stabilised",
        dt: 0.0166,
        rate: 40.0,
        latency: [f64::INFINITY, f64::INFINITY],
    },
];

/// Runs of each case.
const RUNS: usize = 3;

/// Share of the rate that must remain in spite of the clock of the screen.
const SHORT_OF: f64 = 0.97;

pub(super) fn measure(bench: &Bench, strict: bool) -> Result<(), Failure> {
    let mut missed = Vec::new();
    for case in &CASES {
        let scene = bench.scene(case.cells, case.method, case.dt)?;
        let served = Served::start(&bench.sinew, &[scene])?;
        let mut tab = open(bench, &served)?;
        let mut runs = Vec::new();
        let mut memory = Vec::new();
        for _ in 0..RUNS {
            runs.push(wiggle(&mut tab)?);
            memory.push(format!("{:.0}", served.memory()));
        }
        let best = |numbers: Vec<f64>, least: bool| {
            let better = |a: f64, b: f64| if least { a.min(b) } else { a.max(b) };
            numbers.into_iter().reduce(better).unwrap_or(f64::NAN)
        };
        let column = |place: usize| runs.iter().map(|run| run[place]).collect::<Vec<_>>();
        let list = |place: usize| {
            let numbers = runs.iter().map(|run| format!("{:.1}", run[place]));
            numbers.collect::<Vec<_>>().join(", ")
        };
        say(&format!(
            "{}: {} pictures/s (mark {}); drag to picture p50 {} ms, p95 {} ms (marks {}, {}); pace {}; {} MB",
            case.name,
            list(0),
            case.rate,
            list(1),
            list(2),
            case.latency[0],
            case.latency[1],
            list(3),
            memory.join(", "),
        ))?;
        let is_fast = best(column(0), false) >= SHORT_OF * case.rate;
        let follows =
            best(column(1), true) <= case.latency[0] && best(column(2), true) <= case.latency[1];
        if !(is_fast && follows) {
            missed.push(case.name);
        }
    }
    if !missed.is_empty() {
        say(&format!(
            "marks missed in all {RUNS} runs: {}",
            missed.join(", ")
        ))?;
    }
    require(!strict || missed.is_empty(), || {
        "a mark of speed is missed".to_owned()
    })
}

/// Three seconds of dragging: pictures per second, latencies (ms) of half and of 95 %, pace.
fn wiggle(tab: &mut Tab) -> Result<[f64; 4], Failure> {
    let from = grip(tab)?;
    tab.mouse(Mouse::Press, from)?;
    tab.value("window.sinew.clearLatencies()")?;
    let before = tab.number("window.sinew.pictures")?;
    let (begun, mut at) = (Instant::now(), from);
    let mut next = Duration::ZERO;
    while begun.elapsed() < Duration::from_secs(3) {
        let angle = begun.elapsed().as_secs_f64() * 4.0;
        at = [
            from[0] + 25.0 * angle.sin(),
            from[1] + 20.0 * (1.0 - angle.cos()),
        ];
        tab.mouse(Mouse::Move, at)?;
        next += Duration::from_millis(16);
        std::thread::sleep(next.saturating_sub(begun.elapsed()));
    }
    let seconds = begun.elapsed().as_secs_f64();
    let rate = (tab.number("window.sinew.pictures")? - before) / seconds;
    let latencies = tab.value("Array.from(window.sinew.latencies)")?;
    tab.mouse(Mouse::Release, at)?;
    let latencies = latencies.as_array().into_iter().flatten();
    let mut latencies: Vec<f64> = latencies.filter_map(Value::as_f64).collect();
    latencies.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| {
        let place = (share * latencies.len() as f64) as usize;
        latencies.get(place).copied().unwrap_or(f64::NAN)
    };
    let pace = tab.number("window.sinew.picture.pace")?;
    Ok([rate, at(0.5), at(0.95), pace])
}
