//! Comparison of the help of integrators' options with their behaviour.

use sinew_core::{Run, State, simulate};
use sinew_integrators::{OptionDefault, OptionKind};
use toml::{Table, Value};

use super::{Schema, misfits, spots};
use crate::reference::options;
use crate::{Scene, SceneSource};

/// An oscillator that an integrator moves, with lines of `[run]`.
fn scene(integrator: &str, lines: &str) -> Table {
    let text = format!(
        "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = -5.0\n\
         [run]\nduration = 0.1\ndt = 0.001\nintegrator = \"{integrator}\"\n{lines}\n"
    );
    text.parse().unwrap()
}

fn with(integrator: &str, key: &str, value: Value) -> Table {
    let mut scene = scene(integrator, "");
    let run = scene["run"].as_table_mut().unwrap();
    run.insert(key.to_owned(), value);
    scene
}

/// The state after twenty steps.
fn after_steps(scene: &Table) -> State {
    let source = SceneSource::new("scene.toml", toml::to_string(scene).unwrap());
    let simulation = Scene::parse(source).unwrap().build().unwrap();
    let mut integrator = simulation.integrator().unwrap();
    let mut state = simulation.initial_state().clone();
    let run = Run::covering(0.02, 0.001);
    simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &run,
        &mut (),
    )
    .unwrap();
    state
}

#[test]
fn every_example_of_an_option_is_taken_by_registry_and_schema() {
    let schema = Schema::new();
    for known in options::shared() {
        assert!(known.option.example.contains(known.option.key));
        for integrator in known.integrators {
            let scene = scene(integrator, known.option.example);
            super::decoded(&scene).unwrap();
            assert!(
                schema.takes(&scene),
                "{integrator} {}",
                known.option.example
            );
        }
    }
}

#[test]
fn a_default_moves_a_system_as_if_it_were_not_written() {
    let mut compared = 0;
    for known in options::shared() {
        let OptionDefault::Value(default) = known.option.default else {
            continue;
        };
        for integrator in known.integrators {
            let explicit = with(integrator, known.option.key, spots::value(default));
            let absent = after_steps(&scene(integrator, ""));
            let explicit = after_steps(&explicit);
            let said = format!("{integrator} {} = {default}", known.option.key);
            assert_eq!(explicit.u, absent.u, "{said}");
            assert_eq!(explicit.v, absent.v, "{said}");
            compared += 1;
        }
    }
    assert!(compared > 20);
}

fn misfits(kind: &OptionKind) -> Vec<Value> {
    match options::shape(kind) {
        Ok(shape) => misfits::of(&shape),
        Err(keys) => {
            let unknown = [("no-such-key".to_owned(), Value::Integer(1))];
            let of_first = misfits(&keys[0].1).into_iter().map(|misfit| {
                let entry = (keys[0].0.to_owned(), misfit);
                Value::Table([entry].into_iter().collect())
            });
            let others = [
                Value::Table(unknown.into_iter().collect()),
                Value::Integer(1),
            ];
            of_first.chain(others).collect()
        }
    }
}

#[test]
fn a_value_that_an_option_does_not_take_is_refused_by_registry_and_schema() {
    let schema = Schema::new();
    for known in options::shared() {
        for integrator in &known.integrators {
            for misfit in misfits(&known.option.kind) {
                schema.assert_refused(
                    &with(integrator, known.option.key, misfit),
                    known.option.key,
                );
            }
        }
    }
}

#[test]
fn an_option_of_other_integrators_is_refused_by_registry_and_schema() {
    let schema = Schema::new();
    for known in options::shared() {
        for entry in sinew_integrators::entries() {
            let takes = entry
                .all_options()
                .iter()
                .any(|own| own.key == known.option.key);
            if !takes {
                schema.assert_refused(&scene(entry.id, known.option.example), "no option");
            }
        }
    }
}
