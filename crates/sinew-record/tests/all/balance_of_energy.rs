//! The energy balance is closed to the accuracy of each method.

use sinew_core::simulate;
use sinew_record::EnergyLoss;

use crate::common::{cube, run, table};

/// The largest remainder over the largest supplied energy, and the last remainder over it.
fn remainder(more: &str) -> [f64; 2] {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    run(&path, &cube(more), &mut ());
    let energy = table(&path.join("energy.csv"));
    let size = [
        "kinetic_J",
        "elastic_J",
        "work_of_loads_J",
        "work_of_supports_J",
        "damped_J",
    ]
    .iter()
    .flat_map(|name| &energy[*name])
    .fold(0.0_f64, |largest, value| largest.max(value.abs()));
    assert!(size > 0.0);
    let remainder = &energy["remainder_J"];
    let largest = remainder
        .iter()
        .fold(0.0_f64, |largest, value| largest.max(value.abs()));
    [largest, *remainder.last().unwrap()].map(|value| value / size)
}

const PRESSED: &str = "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n";

fn with(supports: &str, method: &str, dt: &str) -> String {
    format!("{supports}[run]\nduration = 0.5\nintegrator = \"{method}\"\ndt = {dt}\n")
}

/// The mean acceleration method conserves energy exactly in linear systems (Hughes, The Finite Element Method, 9.2).
#[test]
fn the_mean_acceleration_method_leaves_rounding() {
    let damped = format!("{PRESSED}[damping]\nmass = 5.0\nstiffness = 0.002\n");
    // A jump and kinks between steps: the impulse counts.
    let pulse = PRESSED.to_owned() + "ramp = { kind = \"pulse\", from = 0.0813, to = 0.2071 }\n";
    let table = PRESSED.to_owned()
        + "ramp = { kind = \"table\", times = [0.0, 0.0113, 0.21, 0.3], values = [0.0, 2.0, -1.0, 0.5] }\n";
    for supports in [PRESSED, &damped, &pulse, &table] {
        let [largest, _] = remainder(&with(supports, "newmark", "0.005"));
        assert!(largest < 1e-10, "{supports}: {largest:e}");
    }
}

#[test]
fn gravity_and_springs_with_dashpots_are_in_it() {
    let text = "gravity = [0.0, 0.0, -9.81]\n[mesh]\ncube = { cells = 3, edge = 0.1 }\n[[region]]\ndensity = 1000.0\n\
                model = \"springs\"\nyoungs_modulus = 3000.0\nsprings = { rule = \"lloyd\", damping_ratio = 0.1 }\n[[fixed]]\n\
                group = \"bottom\"\n[run]\nduration = 0.5\nintegrator = \"newmark\"\ndt = 0.005\n";
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    run(&path, &crate::common::build(text), &mut ());
    let energy = table(&path.join("energy.csv"));
    let damped = energy["damped_J"].last().unwrap();
    assert!(*damped > 1e-3 * energy["work_of_loads_J"].last().unwrap().abs());
    let worst = energy["remainder_J"]
        .iter()
        .fold(0.0_f64, |worst, value| worst.max(value.abs()));
    assert!(worst < 1e-10 * damped, "{worst:e} {damped:e}");
}

/// Dissipative methods: the energy that they dissipate is known and never falls while none is supplied, and only
/// rounding remains. It is also known after an interruption, and is not reported if rows are several steps apart.
#[test]
fn methods_that_take_energy_say_how_much() {
    let damped = format!("{PRESSED}[damping]\nmass = 5.0\nstiffness = 0.002\n");
    let rows_apart = "[output]\nenergy = { every = 0.01 }\n";
    for (method, options) in [
        ("implicit-euler", ""),
        ("generalized-alpha", "rho_inf = 0.5\n"),
        ("newmark", "beta = 0.3025\ngamma = 0.6\n"),
    ] {
        let growing = PRESSED.to_owned()
            + "ramp = { kind = \"table\", times = [0.0, 0.5], values = [0.5, 1.0] }\n";
        for supports in [PRESSED, &damped, &growing] {
            let text = format!("{}{options}", with(supports, method, "0.005"));
            let [largest, _] = remainder(&text);
            assert!(largest < 1e-10, "{method}: {largest:e}");
        }
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        run(
            &path,
            &cube(&format!("{}{options}", with(PRESSED, method, "0.005"))),
            &mut (),
        );
        let taken = &table(&path.join("energy.csv"))["method_J"];
        assert!(
            taken
                .windows(2)
                .all(|rows| rows[1] >= rows[0] - 1e-12 * taken[100]),
            "{method}"
        );
        assert!(taken[100] > 1e-3 * taken[1].abs() && taken[0] == 0.0);
        let text = format!("{}{options}{rows_apart}", with(PRESSED, method, "0.005"));
        run(&place.path().join("apart"), &cube(&text), &mut ());
        let apart = table(&place.path().join("apart/energy.csv"));
        assert!(!apart.contains_key("method_J"));
        // There the remainder is what it took.
        let (lost, taken) = (apart["remainder_J"].last().unwrap(), taken[100]);
        assert!(
            (lost + taken).abs() < 0.5 * taken,
            "{method}: {lost} {taken}"
        );
    }
}

/// A symplectic method conserves an energy close to the true one: the remainder shrinks as the square of the step and
/// does not grow with time.
#[test]
fn central_differences_swing_about_it() {
    let [coarse, _] = remainder(&with(PRESSED, "central-difference", "0.002"));
    let [fine, _] = remainder(&with(PRESSED, "central-difference", "0.001"));
    assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
    assert!(fine < 0.02, "{fine}");
}

/// The work of a moved support is the work of its reaction, including jumps of its velocity.
#[test]
fn supports_in_motion_do_work() {
    let moved = "[[fixed]]\ngroup = \"bottom\"\n[[move]]\ngroup = \"top\"\n";
    let table = "ramp = { kind = \"table\", times = [0.0, 0.0113, 0.21, 0.3], values = [0.0, 0.2, 1.0, 0.5] }\n";
    let ways = [
        "displacement = [0.0, 0.0, 0.01]\nramp = { kind = \"sin2\", rise = 0.3 }\n[damping]\nmass = 5.0\n".to_owned(),
        format!("displacement = [0.01, 0.0, 0.01]\n{table}[damping]\nmass = 5.0\nstiffness = 0.002\n"),
        "velocity = [0.01, 0.0, 0.02]\n[damping]\nmass = 5.0\nstiffness = 0.002\n".to_owned(),
    ];
    for way in ways {
        let [largest, _] = remainder(&with(&format!("{moved}{way}"), "newmark", "0.005"));
        assert!(largest < 1e-10, "{way}: {largest:e}");
    }
}

/// A body that its base accelerates uniformly: the force on the base is that of the whole mass, including the base's
/// own nodes, for a smooth motion and for a table, and for any spacing of the rows.
#[test]
fn a_base_pushes_with_the_whole_mass_whatever_its_way() {
    let (acceleration, end) = (4.0, 0.4);
    let way = |t: f64| 0.5 * acceleration * t * t;
    // Rows on steps, finer, coarser, and between steps.
    for spacing in [0.002, 0.0005, 0.01, 0.0033] {
        let times: Vec<f64> = (0..)
            .map(|row| f64::from(row) * spacing)
            .take_while(|t| *t < end + 0.02)
            .collect();
        let values: Vec<f64> = times.iter().map(|t| way(*t)).collect();
        for rows in ["", "[output]\nenergy = { every = 0.01 }\n"] {
            let text = format!(
                "[mesh]\ncube = {{ cells = 2, edge = 0.1, split = \"kuhn\" }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                 youngs_modulus = 50000.0\npoissons_ratio = 0.3\n[[move]]\ngroup = \"bottom\"\n\
                 displacement = [1.0, 0.0, 0.0]\nramp = {{ kind = \"table\", times = {times:?}, values = {values:?} }}\n\
                 [run]\nduration = {end}\nintegrator = \"newmark\"\ndt = 0.002\n{rows}"
            );
            let place = tempfile::tempdir().unwrap();
            let path = place.path().join("out");
            run(&path, &crate::common::build(&text), &mut ());
            let reactions = table(&path.join("reactions.csv"));
            let push = &reactions["move_1_bottom_f_x_N"];
            let mean = push[1..].iter().sum::<f64>() / (push.len() - 1) as f64;
            assert!(
                (mean / acceleration - 1.0).abs() < 0.04,
                "{spacing} {rows}: {mean} N"
            );
        }
    }
}

/// A body that its base moves without strain has no damping force, and neither has the base, for all times at which
/// methods evaluate the velocities of cells and of supports.
#[test]
fn damping_adds_nothing_to_the_push_of_a_base() {
    let (acceleration, edge, end) = (4.0, 0.02, 0.08_f64);
    let expected = 1000.0 * edge * edge * edge * acceleration;
    let way = |t: f64| 0.5 * acceleration * t * t;
    let times: Vec<f64> = (0..43).map(|row| f64::from(row) * 0.002).collect();
    let values: Vec<f64> = times.iter().map(|t| way(*t)).collect();
    for model in ["linear", "neo-hookean"] {
        for method in [
            "\"implicit-euler\"",
            "\"cnn-energy\"\nkind = \"ie\"\nsweeps = 60",
        ] {
            for rows in ["", "[output]\nenergy = { every = 0.01 }\n"] {
                let text = format!(
                    "[mesh]\ncube = {{ cells = 2, edge = {edge}, split = \"kuhn\" }}\n[[region]]\ndensity = 1000.0\nmodel = \"{model}\"\n\
                     youngs_modulus = 2e5\npoissons_ratio = 0.3\n[damping]\nstiffness = 0.002\n[[move]]\ngroup = \"bottom\"\n\
                     displacement = [1.0, 0.0, 0.0]\nramp = {{ kind = \"table\", times = {times:?}, values = {values:?} }}\n\
                     [run]\nduration = {end}\nintegrator = {method}\ndt = 0.002\n{rows}"
                );
                let place = tempfile::tempdir().unwrap();
                let path = place.path().join("out");
                run(&path, &crate::common::build(&text), &mut ());
                let reactions = table(&path.join("reactions.csv"));
                let push = &reactions["move_1_bottom_f_x_N"];
                // It is jerked at first.
                for push in &push[push.len() / 2..] {
                    let off = push / expected - 1.0;
                    assert!(off.abs() < 0.02, "{model}, {method}, {rows}: {push} N");
                }
            }
        }
    }
}

/// Dashpots between a moved part and the rest dissipate energy too.
#[test]
fn dashpots_at_moved_supports_are_in_it() {
    let text = |dt: &str| {
        format!(
            "[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"springs\"\n\
             youngs_modulus = 3000.0\nsprings = {{ rule = \"lloyd\", damping_ratio = 0.2 }}\n[[fixed]]\n\
             group = \"bottom\"\n[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, -0.01]\n\
             ramp = {{ kind = \"sin2\", rise = 0.2 }}\n[run]\nduration = 0.3\nintegrator = \"newmark\"\ndt = {dt}\n"
        )
    };
    let remainder = |dt: &str| -> f64 {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        run(&path, &crate::common::build(&text(dt)), &mut ());
        let energy = table(&path.join("energy.csv"));
        let most = |name: &str| {
            energy[name]
                .iter()
                .fold(0.0_f64, |most, x| x.abs().max(most))
        };
        assert!(most("damped_J") > 0.05 * most("work_of_supports_J"));
        most("remainder_J") / most("work_of_supports_J")
    };
    let (coarse, fine) = (remainder("0.002"), remainder("0.001"));
    assert!(fine < 2e-3 && coarse > 3.0 * fine, "{coarse} {fine}");
}

/// Stiffness damping of tissue in large deformation, between a moved part and the rest: the dissipated energy never
/// falls, and with it the balance closes.
#[test]
fn stiffness_damping_at_moved_supports_of_soft_tissue_is_in_it() {
    let text = |law: &str, dt: &str| {
        format!(
            "[mesh]\nblock = {{ cells = [4, 1, 1], size = [0.1, 0.03, 0.03], split = \"mirrored\" }}\n[[region]]\n\
             density = 1000.0\nmodel = \"{law}\"\nyoungs_modulus = 20000.0\npoissons_ratio = 0.3\n[[fixed]]\n\
             where = {{ below = {{ x = 0.001 }} }}\n[[move]]\nwhere = {{ above = {{ x = 0.099 }} }}\n\
             displacement = [-0.02, 0.0, 0.0]\nramp = {{ kind = \"sin2\", rise = 0.1 }}\n[damping]\nstiffness = 0.005\n\
             [run]\nduration = 0.15\nintegrator = \"newmark\"\ndt = {dt}\n"
        )
    };
    for law in ["stvk", "neo-hookean", "corotational"] {
        let remainder = |dt: &str| -> f64 {
            let place = tempfile::tempdir().unwrap();
            let path = place.path().join("out");
            let end = run(&path, &crate::common::build(&text(law, dt)), &mut ());
            assert!(
                !end.warnings
                    .iter()
                    .any(|said| said.contains("damping gave"))
            );
            let energy = table(&path.join("energy.csv"));
            let most = |name: &str| {
                energy[name]
                    .iter()
                    .fold(0.0_f64, |most, x| x.abs().max(most))
            };
            let damped = &energy["damped_J"];
            assert!(damped.windows(2).all(|rows| rows[1] >= rows[0]), "{law}");
            assert!(
                most("damped_J") > 0.05 * most("work_of_supports_J"),
                "{law}"
            );
            most("remainder_J") / most("work_of_supports_J")
        };
        let (coarse, fine) = (remainder("0.004"), remainder("0.002"));
        assert!(fine < 5e-3 && coarse > 3.0 * fine, "{law}: {coarse} {fine}");
    }
}

/// The warning of a run about energy that a method took.
fn told(simulation: &sinew_scene::Simulation) -> Option<String> {
    let place = tempfile::tempdir().unwrap();
    let end = run(&place.path().join("out"), simulation, &mut ());
    let told = end
        .warnings
        .into_iter()
        .find(|warning| warning.contains("that were put in"));
    // The same is said where no table is written.
    let mut integrator = simulation.integrator().unwrap();
    simulation.set_up(&mut *integrator).unwrap();
    let mut loss = EnergyLoss::new(&std::sync::Arc::new(simulation.clone()), &*integrator);
    let mut state = simulation.initial_state().clone();
    let run = simulation.run();
    simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &run,
        &mut loss,
    )
    .unwrap();
    assert_eq!(loss.in_words(), told);
    told
}

/// The share (%) in such a warning.
fn share(told: Option<String>) -> f64 {
    let told = told.expect("a warning");
    let words: Vec<&str> = told.split_whitespace().collect();
    let place = words.iter().position(|word| *word == "%:").unwrap();
    words[place - 1].parse().unwrap()
}

/// Implicit Euler leaves `(1 + w^2 dt^2)^-n` of the energy after n steps of an oscillator.
#[test]
fn what_implicit_euler_takes_from_an_oscillator_is_told_with_its_share() {
    for (steps, dt) in [(20, 0.001), (100, 0.002), (400, 0.0005)] {
        let text = format!(
            "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = 2.0\n[run]\nduration = {}\n\
             integrator = \"implicit-euler\"\ndt = {dt}\n",
            f64::from(steps) * dt
        );
        let left = (1.0 + 1000.0 * dt * dt).powi(-steps);
        let told = told(&crate::common::build(&text));
        match 1.0 - left > 0.1 {
            true => assert!((share(told) - 100.0 * (1.0 - left)).abs() < 0.51),
            false => assert_eq!(told, None),
        }
    }
}

/// Warnings are given with rows for every step or only some, on linear bodies and others, for any source of energy; and
/// the method that they name conserves it.
#[test]
fn methods_that_take_much_energy_are_told_with_one_that_keeps_it() {
    let body = |model: &str, more: &str, run: &str| {
        crate::common::build(&format!(
            "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"{model}\"\nyoungs_modulus = 5000.0\n\
             poissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n{more}[run]\nduration = 0.5\n{run}\n"
        ))
    };
    let pushed = "[[load]]\ngroup = \"top\"\nforce = [0.3, 0.0, 0.0]\n";
    let moved = "[[move]]\ngroup = \"top\"\ndisplacement = [0.01, 0.0, 0.0]\nramp = { kind = \"sin2\", rise = 0.05 }\n";
    let rare = format!("{pushed}[output]\nenergy = {{ every = 0.1 }}\n");
    let released = "[[initial]]\ndisplacement = [\"0.2 * z\", 0.0, 0.0]\n";
    let euler = "integrator = \"implicit-euler\"\ndt = 0.01";
    for (model, more, run) in [
        ("linear", pushed, euler),
        ("linear", &rare, euler),
        ("linear", moved, euler),
        ("neo-hookean", released, euler),
        (
            "neo-hookean",
            pushed,
            "integrator = \"newmark\"\ndt = 0.01\ngamma = 0.9\nbeta = 0.49",
        ),
        (
            "neo-hookean",
            &rare,
            "integrator = \"cnn-energy\"\nkind = \"ie\"\ndt = 0.005",
        ),
        (
            "linear",
            pushed,
            "integrator = \"generalized-alpha\"\ndt = 0.03\nrho_inf = 0.0",
        ),
    ] {
        let simulation = body(model, more, run);
        let told = told(&simulation);
        let words = told.clone().unwrap_or_default();
        assert!(told.is_some(), "{model} {more}{run}");
        assert!(share(told) > 10.0);
        let keeper = match model {
            "linear" => "integrator = \"newmark\"",
            _ => "integrator = \"central-difference\"",
        };
        assert!(words.contains(keeper), "{words}");
        let dt = if model == "linear" {
            "dt = 0.01"
        } else {
            "dt = \"auto\""
        };
        let kept = body(model, more, &format!("{keeper}\n{dt}"));
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        crate::common::run(&path, &kept, &mut ());
        if !more.contains("every") && !more.contains("move") {
            let energy = table(&path.join("energy.csv"));
            let [kinetic, elastic, loads] =
                ["kinetic_J", "elastic_J", "work_of_loads_J"].map(|name| &energy[name]);
            let given =
                kinetic[0] + elastic[0] + loads.iter().fold(0.0_f64, |most, work| most.max(*work));
            let left = energy["remainder_J"].last().unwrap() / given;
            assert!(left.abs() < 0.1, "{model} {run}: {left}");
        }
    }
}

/// Energy taken by damping or memory, and a motion that is slow relative to the steps, are not reported as a loss by
/// the method.
#[test]
fn energy_that_tissue_takes_is_not_told_as_the_methods() {
    let body = |region: &str, more: &str, run: &str| {
        crate::common::build(&format!(
            "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nyoungs_modulus = 5000.0\n\
             poissons_ratio = 0.3\n{region}[[fixed]]\ngroup = \"bottom\"\n{more}[run]\nduration = 0.5\n{run}\n"
        ))
    };
    let pushed = "[[load]]\ngroup = \"top\"\nforce = [0.3, 0.0, 0.0]\n";
    let slowly = format!("{pushed}ramp = {{ kind = \"sin2\", rise = 0.4 }}\n");
    let damped = format!("{pushed}[damping]\nmass = 40.0\nstiffness = 0.02\n");
    let euler = "integrator = \"implicit-euler\"\ndt = 0.0005";
    let elastic = "model = \"linear\"\n";
    let relaxing = "model = \"neo-hookean\"\nprony = [[0.5, 0.05]]\n";
    for (region, more, run) in [
        (elastic, &*damped, euler),
        (
            elastic,
            &slowly,
            "integrator = \"implicit-euler\"\ndt = 0.005",
        ),
        (
            relaxing,
            &slowly,
            "integrator = \"implicit-euler\"\ndt = 0.01",
        ),
        (elastic, pushed, "integrator = \"newmark\"\ndt = 0.01"),
        (
            elastic,
            pushed,
            "integrator = \"central-difference\"\ndt = \"auto\"",
        ),
    ] {
        assert_eq!(told(&body(region, more, run)), None, "{region}{more}{run}");
    }
}

/// A row after several substeps includes the motion between them: the balance closes as well as with a fixed step of
/// the length of substeps at rest.
#[test]
fn steps_that_are_taken_again_leave_what_a_fixed_step_leaves_of_the_work_of_supports() {
    for (ratio, rise) in [(0.45, 0.05), (0.3, 0.06)] {
        let largest = |dt: &str| {
            let text = format!(
                "[mesh]\nblock = {{ cells = [3, 3, 5], size = [0.06, 0.06, 0.1], split = \"mirrored\" }}\n[[region]]\ndensity = 1060.0\n\
                 model = \"neo-hookean\"\nyoungs_modulus = 4000.0\npoissons_ratio = {ratio}\nelement = \"fbar-edge\"\n[[fixed]]\n\
                 group = \"bottom\"\n[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, -0.03]\n\
                 ramp = {{ kind = \"sin2\", rise = {rise} }}\n[run]\nduration = 0.6\nintegrator = \"central-difference\"\ndt = {dt}\n"
            );
            let place = tempfile::tempdir().unwrap();
            let path = place.path().join("out");
            let end = run(&path, &crate::common::build(&text), &mut ());
            let energy = table(&path.join("energy.csv"));
            let most = |name: &str| {
                energy[name]
                    .iter()
                    .fold(0.0_f64, |most, x| x.abs().max(most))
            };
            let remainder = most("remainder_J") / most("work_of_supports_J");
            (remainder, end.retaken)
        };
        let ((of_parts, retaken), (fixed, none)) = (largest("\"auto\""), largest("0.003"));
        assert!(retaken > 0 && none == 0, "steps are taken again");
        assert!(of_parts < fixed && fixed < 0.01, "{of_parts} {fixed}");
    }
}

/// Damping over a step with several substeps is that of the motion within it.
#[test]
fn steps_of_several_parts_leave_little_of_what_damping_takes() {
    let last = |dt: &str| {
        let text = format!(
            "gravity = [0.0, 0.0, -4.0]\n[mesh]\nblock = {{ cells = [2, 2, 5], size = [0.04, 0.04, 0.1], split = \"mirrored\" }}\n[[region]]\n\
             density = 1060.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 4000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n\
             [damping]\nmass = 20.0\n[run]\nduration = 0.6\nintegrator = \"central-difference\"\n{dt}\n"
        );
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        run(&path, &crate::common::build(&text), &mut ());
        let energy = table(&path.join("energy.csv"));
        let [remainder, damped] =
            ["remainder_J", "damped_J"].map(|name| *energy[name].last().unwrap());
        remainder / damped
    };
    let (of_parts, whole) = (
        last("dt = 0.012\nsubsteps = 6").abs(),
        last("dt = 0.002").abs(),
    );
    assert!(of_parts < 1e-3 + 2.0 * whole, "{of_parts} {whole}");
}

/// Messages of a run about energy, with a folder and with probes alone.
fn said_both_ways(text: &str) -> [Vec<String>; 2] {
    let simulation = crate::common::build(text);
    let place = tempfile::tempdir().unwrap();
    let end = run(&place.path().join("out"), &simulation, &mut ());
    let mut integrator = simulation.integrator().unwrap();
    simulation.set_up(&mut *integrator).unwrap();
    let mut loss = EnergyLoss::new(&std::sync::Arc::new(simulation.clone()), &*integrator);
    let mut state = simulation.initial_state().clone();
    // A run that ends early says what was seen.
    let _ = simulate(
        simulation.system(),
        &mut *integrator,
        &mut state,
        &simulation.run(),
        &mut loss,
    );
    let of_energy = |said: &String| {
        ["put in", "was given", "balance of energy"]
            .iter()
            .any(|words| said.contains(words))
    };
    let folder = end.warnings.into_iter().filter(of_energy).collect();
    [folder, loss.in_words().into_iter().collect()]
}

/// A slender block of soft tissue that is turned, or thrown around a fixed end.
fn turned(more: &str) -> String {
    format!(
        "[mesh]\nblock = {{ cells = [4, 1, 1], size = [0.1, 0.03, 0.03], split = \"mirrored\" }}\n[[region]]\n\
         density = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 20000.0\npoissons_ratio = 0.3\n{more}"
    )
}

const THROWN: &str = "[[fixed]]\nwhere = { below = { x = 0.001 } }\n[[initial]]\nvelocity = [0.0, \"60 * x\", 0.0]\n[run]\n\
                      duration = 0.5\nintegrator = \"newmark\"\n";

#[test]
fn energy_that_a_clamp_takes_is_told_with_its_share() {
    let spring = |more: &str| {
        format!(
            "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = 10.0\n[run]\nduration = 1.0\n\
             dt = 0.001\n{more}"
        )
    };
    let turning = turned(
        "[[initial]]\nvelocity = [\"-100 * y\", \"100 * x\", 0.0]\n[run]\nduration = 0.5\nfree_flight = true\n\
         integrator = \"symplectic-euler\"\ndt = 0.0005\nsaturation = 2.0\n",
    );
    for (text, least) in [
        (spring("integrator = \"cnn\"\nsaturation = 1.0\n"), 75.0),
        (
            spring("integrator = \"symplectic-euler\"\nsaturation = 1.0\n"),
            75.0,
        ),
        (turning, 95.0),
    ] {
        for said in said_both_ways(&text) {
            let said = said.into_iter().find(|said| said.contains("put in"));
            let words = said.clone().unwrap_or_default();
            assert!(
                words.contains("whose velocities were saturated"),
                "{said:?} {text}"
            );
            let found = share(said);
            assert!((least..100.0).contains(&found), "{found} {text}");
        }
    }
    // The clamp has not acted.
    for said in said_both_ways(&spring(
        "integrator = \"cnn-symplectic\"\nsaturation = 20.0\n",
    )) {
        assert_eq!(said, Vec::<String>::new());
    }
}

/// Newmark's method conserves the energy of linear tissue only. The warnings name a method that conserves it here; the
/// test checks this.
#[test]
fn energy_that_newmark_loses_or_makes_on_thrown_soft_tissue_is_told_with_a_remedy() {
    for (dt, words) in [
        ("0.005", "that were put in, 22 %"),
        ("0.01", "that it was given, 905 %"),
    ] {
        let text = turned(&format!("{THROWN}dt = {dt}\n"));
        let [in_folder, _] = said_both_ways(&text);
        let said = in_folder.iter().find(|said| said.contains(words));
        let said = said.unwrap_or_else(|| panic!("{in_folder:?}"));
        assert!(
            said.ends_with("integrator = \"central-difference\" with dt = \"auto\" keeps it"),
            "{said}"
        );
    }
    let kept = turned(&format!("{THROWN}dt = \"auto\"\n").replace("newmark", "central-difference"));
    assert_eq!(said_both_ways(&kept), [Vec::<String>::new(), Vec::new()]);
}

/// The work of a load that oscillates many times in a step cannot be summed from row to row.
#[test]
fn a_load_that_swings_within_a_step_says_that_instead_of_a_share() {
    let text = |load: &str, method: &str, more: &str| {
        format!(
            "[mesh]\ncube = {{ cells = 2, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
             youngs_modulus = 5000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\n\
             force = [0.3, 0.0, 0.0]\nramp = {{ {load} }}\n[run]\nduration = 0.2\nintegrator = \"{method}\"\n{more}"
        )
    };
    let sine = |frequency: f64| format!("sine = {{ frequency = {frequency:?} }}");
    let rare = "dt = 0.0005\n[output]\nenergy = { every = 0.025 }\n";
    for (load, method, more) in [
        (sine(1.234_567e6), "implicit-euler", "dt = 0.001\n"),
        (sine(1333.0), "generalized-alpha", "dt = 0.00033\n"),
        (sine(10.0), "central-difference", rare),
    ] {
        let [in_folder, _] = said_both_ways(&text(&load, method, more));
        assert_eq!(in_folder.len(), 1, "{in_folder:?}");
        assert!(in_folder[0].contains("turns so fast"), "{in_folder:?}");
    }
    let followed = text(&sine(2.0), "implicit-euler", "dt = 0.02\n");
    let [in_folder, alone] = said_both_ways(&followed);
    assert!(in_folder[0].contains("put in"), "{in_folder:?}");
    assert_eq!(in_folder, alone);
}
