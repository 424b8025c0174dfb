//! Loads and motions that vary too fast for the checks of energy.

use sinew_core::Ramp;
use sinew_scene::SceneBody;

/// Least number of checks within half a wave of a sine for which its work is known to 10 %.
const LOOKS: f64 = 5.0;

/// A sentence if checks of energy every `span` (s) are too rare to show the effect of the method, since a load or a
/// motion varies faster; `None` otherwise.
pub(crate) fn unseen(body: &SceneBody, span: f64) -> Option<String> {
    let problem = &body.model().body()?.problem;
    let loads = problem.loads.iter().map(|load| &load.ramp);
    let courses = problem.moves.iter().flat_map(|moving| &moving.courses);
    let ramps = loads.chain(courses.map(|course| &course.ramp));
    let needed = ramps.filter_map(look).reduce(f64::min)?;
    (needed < (1.0 - 1e-9) * span).then(|| {
        format!(
            "the balance of energy does not tell what the method does to it: a load or a motion turns so fast that its work is known by looks every {needed:.3e} s, \
             and they are {span:.3e} s apart; steps, and rows of energies, of {needed:.3e} s would tell"
        )
    })
}

/// The longest time (s) between two checks that resolve the reversals of a ramp; `None` if it does not reverse.
fn look(ramp: &Ramp) -> Option<f64> {
    match ramp {
        Ramp::Sine { frequency, .. } => Some(0.5 / frequency / LOOKS),
        Ramp::Pulse { from, to } => Some(to - from),
        Ramp::Table { times, values } | Ramp::Hold { times, values } => {
            let changes = times.iter().zip(values.windows(2));
            let mut turns: Vec<(f64, bool)> = changes
                .filter(|(_, pair)| pair[0] != pair[1])
                .map(|(t, pair)| (*t, pair[1] > pair[0]))
                .collect();
            turns.dedup_by_key(|(_, rises)| *rises);
            let apart = turns.windows(2).map(|pair| pair[1].0 - pair[0].0);
            apart.reduce(f64::min)
        }
        Ramp::Rate(of) | Ramp::Scaled(of, _) | Ramp::Position(of) => look(of),
        Ramp::Step | Ramp::Sin2 { .. } | Ramp::Linear | Ramp::Input(_) | Ramp::InputRate(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fastest_turn_of_a_ramp_is_found() {
        let sine = Ramp::Sine {
            frequency: 50.0,
            phase: 0.0,
        };
        let table = |values: [f64; 5]| Ramp::Table {
            times: vec![0.0, 0.1, 0.4, 0.6, 0.61],
            values: values.to_vec(),
        };
        assert_eq!(look(&Ramp::Position(Box::new(sine))), Some(0.002));
        assert_eq!(look(&table([0.0, 1.0, 2.0, 3.0, 4.0])), None);
        let turns = look(&table([0.0, 1.0, 2.0, 2.0, 1.0])).unwrap();
        assert!((turns - 0.6).abs() < 1e-12, "{turns}");
        let hit = look(&table([0.0, 1.0, 1.0, 0.0, 1.0])).unwrap();
        assert!((hit - 0.2).abs() < 1e-12, "{hit}");
    }
}
