//! The pace of a scene on this computer.

use std::time::{Duration, Instant};

use sinew_core::Options;
use sinew_scene::Scene;
use sinew_world::{Command, World};

use super::Failure;

/// Time for which steps are measured.
const SPAN: Duration = Duration::from_secs(1);

/// Simulated time over the time that it takes: that of the scene's own motion, again and again for a second, by the
/// methods of these names in turn, or by its own one. `None` if `ends` returned true, which is asked between steps, and
/// for a motion that fails.
///
/// # Errors
/// [`Failure`] for a scene that cannot be simulated.
pub(crate) fn pace_of(
    scene: Scene,
    methods: &[&str],
    ends: &dyn Fn() -> bool,
) -> Result<Option<f64>, Failure> {
    let mut worlds = Vec::new();
    for name in methods {
        let mut world = World::new(scene.clone())?;
        let is_own = scene.settings().integrator == *name;
        let id = (*name).to_owned();
        let options = Options::new();
        if !is_own && world.command(Command::Integrator { id, options }).is_err() {
            return Ok(None);
        }
        worlds.push(world);
    }
    if worlds.is_empty() {
        worlds.push(World::new(scene)?);
    }
    let (mut simulated, mut took) = (0.0, Duration::ZERO);
    while took < SPAN {
        // The first step sets a method up.
        for world in &mut worlds {
            if ends() || world.command(Command::Reset).is_err() || world.step().is_err() {
                return Ok(None);
            }
        }
        let (first, begun) = (worlds[0].t(), Instant::now());
        let duration = worlds[0].scene().settings().duration;
        let mut is_whole = true;
        while is_whole && worlds[0].t() < duration && took + begun.elapsed() < SPAN {
            if ends() {
                return Ok(None);
            }
            is_whole = worlds.iter_mut().all(|world| world.step().is_ok());
        }
        let covered = worlds[0].t() - first;
        if covered <= 0.0 {
            return Ok(None);
        }
        simulated += covered;
        took += begun.elapsed();
    }
    Ok(Some(simulated / took.as_secs_f64()))
}

/// A pace as a mark and a factor.
pub(super) fn in_words(pace: Option<f64>) -> String {
    match pace {
        Some(pace) if pace >= 1.0 => format!("real-time here, {} x", rounded(pace)),
        Some(pace) => format!("slower than real time, {} x", rounded(pace)),
        None => "no pace: its motion fails".to_owned(),
    }
}

/// A factor with two digits, rounded down so that nothing below real time looks like it.
fn rounded(pace: f64) -> String {
    let exponent = pace.max(1e-9).log10().floor() as i32 - 1;
    let unit = 10_f64.powi(exponent);
    let digits = exponent.min(0).unsigned_abs() as usize;
    format!("{:.digits$}", (pace / unit).floor() * unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pace_below_real_time_is_never_written_as_real_time() {
        for (pace, words) in [
            (0.9999, "slower than real time, 0.99 x"),
            (0.0432, "slower than real time, 0.043 x"),
            (1.0, "real-time here, 1.0 x"),
            (3.29, "real-time here, 3.2 x"),
            (66.6, "real-time here, 66 x"),
            (1234.0, "real-time here, 1200 x"),
        ] {
            assert_eq!(in_words(Some(pace)), words);
        }
        assert_eq!(in_words(None), "no pace: its motion fails");
    }
}
