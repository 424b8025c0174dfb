//! Differences between results are found at their positions.

use std::fs;

use sinew_mesh::vtu::read_vtu;
use sinew_record::compare;

use crate::common::{build, cube, run, table};

fn scene(dt: &str, pressure: &str) -> String {
    format!(
        "[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\npressure = {pressure}\n[run]\nduration = 0.2\n\
         integrator = \"newmark\"\ndt = {dt}\n[[probe]]\nname = \"p\"\npoint = [0.05, 0.05, 0.1]\n[output]\n\
         fields = {{ frames = 4 }}\n"
    )
}

#[test]
fn a_run_differs_from_itself_by_nothing_and_from_twice_the_load_by_all() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    for (name, dt, pressure) in [
        ("one", "0.005", "50.0"),
        ("same", "0.005", "50.0"),
        ("twice", "0.005", "100.0"),
        ("fine", "0.0025", "50.0"),
    ] {
        run(&path(name), &cube(&scene(dt, pressure)), &mut ());
    }
    let same = compare(&path("one"), &path("same")).unwrap();
    assert_eq!(same.largest_relative(), 0.0);
    assert!(same.left_out.is_empty(), "{:?}", same.left_out);
    let quantities: Vec<(&str, &str)> = same
        .differences
        .iter()
        .map(|difference| (difference.of, difference.what.as_str()))
        .collect();
    for quantity in [
        ("probes.csv", "p_u"),
        ("energy.csv", "kinetic"),
        ("reactions.csv", "fixed_1_bottom_f"),
        ("fields", "displacement"),
        ("fields", "velocity"),
    ] {
        assert!(
            quantities.contains(&quantity),
            "{quantity:?} in {quantities:?}"
        );
    }
    // A linear body moves twice as far under twice the load, and stores four times the energy.
    let energy = table(&path("one").join("energy.csv"));
    let largest = |name: &str| {
        energy[name]
            .iter()
            .fold(0.0_f64, |most, value| value.max(most))
    };
    let twice = compare(&path("one"), &path("twice")).unwrap();
    for difference in &twice.differences {
        let name = difference.what.as_str();
        match name {
            "p_u" | "displacement" | "velocity" => {
                assert!((difference.relative - 1.0).abs() < 1e-5, "{difference:?}");
            }
            "kinetic" | "elastic" => {
                let share = difference.largest / largest(&format!("{name}_J"));
                assert!((share - 3.0).abs() < 1e-9, "{difference:?}");
            }
            _ => {}
        }
    }
    // The largest is where the probe is farthest out.
    let probes = table(&path("one").join("probes.csv"));
    let size = |row: usize| -> f64 {
        let axes = ["p_u_x_m", "p_u_y_m", "p_u_z_m"].iter();
        axes.map(|axis| probes[*axis][row].powi(2))
            .sum::<f64>()
            .sqrt()
    };
    let farthest = (0..probes["t_s"].len())
        .max_by(|a, b| size(*a).total_cmp(&size(*b)))
        .unwrap();
    let found = twice
        .differences
        .iter()
        .find(|difference| difference.what == "p_u")
        .unwrap();
    assert_eq!(found.t, probes["t_s"][farthest]);
    assert!((found.largest - size(farthest)).abs() < 1e-12);
    // Half the step: a quarter of an error of second order is left, and every other row has a counterpart.
    let fine = compare(&path("one"), &path("fine")).unwrap();
    let relative = fine.largest_relative();
    assert!(
        relative > 1e-4 && fine.left_out.is_empty(),
        "{relative} {:?}",
        fine.left_out
    );
}

#[test]
fn what_cannot_be_compared_is_said() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    run(&path("one"), &cube(&scene("0.005", "50.0")), &mut ());
    let longer = scene("0.005", "50.0")
        .replace("0.2", "0.4")
        .replace("name = \"p\"", "name = \"q\"");
    run(&path("other"), &cube(&longer), &mut ());
    let comparison = compare(&path("other"), &path("one")).unwrap();
    let said = comparison.left_out.join("; ");
    assert!(said.contains("6 columns are in one of them only"), "{said}");
    assert!(
        said.contains("energy.csv: 40 rows of the first are beyond"),
        "{said}"
    );
    assert!(said.contains("2 frames of the first have none"), "{said}");

    let refused = compare(place.path(), &path("one")).unwrap_err().to_string();
    assert!(
        refused.contains("the folder has no completed run"),
        "{refused}"
    );
    let frame = path("one").join("fields/frame-00001.vtu");
    fs::write(&frame, "no frame").unwrap();
    let refused = compare(&path("one"), &path("one")).unwrap_err().to_string();
    assert!(
        refused.contains("frame-00001.vtu: it does not end as a frame does"),
        "{refused}"
    );
}

#[test]
fn other_bodies_and_probes_at_other_places_are_no_match() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    // Gravity that grows as the body shrinks: both move alike but for the length of everything.
    let text = |edge: &str, point: &str| {
        format!(
            "[mesh]\ncube = {{ cells = 2, edge = {edge} }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
             youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[move]]\ngroup = \"tissue\"\nvelocity = [0.0, 0.0, 0.1]\n\
             axes = \"z\"\n[[fixed]]\ngroup = \"bottom\"\naxes = \"xy\"\n[run]\nduration = 0.1\nintegrator = \"newmark\"\n\
             dt = 0.01\n[[probe]]\nname = \"p\"\npoint = {point}\n[output]\nfields = {{ frames = 2 }}\n"
        )
    };
    for (name, edge, point) in [
        ("one", "0.1", "[0.1, 0.1, 0.1]"),
        ("larger", "0.2", "[0.2, 0.2, 0.2]"),
        ("elsewhere", "0.1", "[0.0, 0.1, 0.1]"),
    ] {
        run(&path(name), &build(&text(edge, point)), &mut ());
    }
    // All of them are carried alike, so that only the places tell.
    let places = |other: &str| -> Vec<(String, f64)> {
        let found = compare(&path("one"), &path(other)).unwrap();
        let places = found
            .differences
            .into_iter()
            .filter(|found| found.unit == "m" && found.relative > 1e-6);
        places.map(|found| (found.what, found.largest)).collect()
    };
    let larger = places("larger");
    let corner = 0.03_f64.sqrt();
    assert_eq!(larger.len(), 2, "{larger:?}");
    for (what, distance) in &larger {
        assert!(what == "place of p" || what == "points at rest", "{what}");
        assert!((distance - corner).abs() < 1e-7, "{what} {distance}");
    }
    let elsewhere = places("elsewhere");
    assert_eq!(elsewhere, [("place of p".to_owned(), 0.1)]);
    assert_eq!(places("one"), []);
}

/// Velocities are vectors, stresses tensors: a component that is 0 except for rounding is compared with the size of the
/// whole.
#[test]
fn velocities_and_stresses_are_compared_as_a_whole() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    for (name, pressure) in [("one", 100.0), ("other", 110.0)] {
        let simulation = cube(&format!(
            "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = {pressure:?}\n[run]\nduration = 0.1\n\
             integrator = \"newmark\"\ndt = 0.005\n[[probe]]\nname = \"p\"\ngroup = \"top\"\nquantity = \"velocity\"\n\
             [[probe]]\nname = \"q\"\npoint = [0.05, 0.05, 0.05]\nquantity = \"stress\"\n"
        ));
        run(&path(name), &simulation, &mut ());
    }
    let comparison = compare(&path("one"), &path("other")).unwrap();
    for (what, unit) in [("p_v", "m/s"), ("q_s", "Pa"), ("q_s_von_mises", "Pa")] {
        let found = comparison
            .differences
            .iter()
            .find(|found| found.what == what);
        let found = found.unwrap();
        assert_eq!(found.unit, unit);
        // A tenth more load is a tenth more of everything.
        assert!(
            (found.relative - 0.1).abs() < 1e-9,
            "{what}: {}",
            found.relative
        );
    }
}

/// Every array, the points and the cells are read: a flipped bit anywhere in a frame is a difference, a damaged file or
/// an array that has no counterpart.
#[test]
fn no_bit_of_a_frame_falls_over_unseen() {
    let place = tempfile::tempdir().unwrap();
    let path = |name: &str| place.path().join(name);
    for (name, output) in [("plain", ""), ("packed", "compress = true\n")] {
        let (one, other) = (path(name), path("other"));
        let text = scene("0.005", "50.0") + &format!("step_limit = true\n{output}");
        run(&one, &cube(&text), &mut ());
        run(&other, &cube(&text), &mut ());
        let frame = other.join("fields/frame-00001.vtu");
        let whole = fs::read(&frame).unwrap();
        let seen = |bytes: &[u8]| {
            fs::write(&frame, bytes).unwrap();
            match compare(&one, &other) {
                Ok(found) => found.largest_relative() > 0.0 || !found.left_out.is_empty(),
                Err(_) => true,
            }
        };
        assert!(!seen(&whole));
        let read = read_vtu(&whole).unwrap();
        assert!(compare(&one, &other).is_ok());
        for length in [whole.len() / 2, whole.len() - 2, whole.len() - 20] {
            fs::write(&frame, &whole[..length]).unwrap();
            assert!(compare(&one, &other).is_err(), "{length}");
        }
        // Positions without a pattern (Park and Miller, Comm. ACM 31, 1988).
        let mut seed = 7_u64;
        let mut unseen = Vec::new();
        for _ in 0..400 {
            seed = seed * 48_271 % 0x7fff_ffff;
            let (byte, bit) = (seed as usize / 8 % whole.len(), seed % 8);
            let mut bytes = whole.clone();
            bytes[byte] ^= 1 << bit;
            // Text that says the same, such as another name of an attribute that nobody needs, is none of its content.
            if !seen(&bytes) && read_vtu(&bytes).unwrap() != read {
                let from = byte.saturating_sub(20);
                unseen.push(String::from_utf8_lossy(&bytes[from..byte + 1]).into_owned());
            }
        }
        assert!(unseen.is_empty(), "{name}: {unseen:#?}");
        fs::remove_dir_all(other).unwrap();
    }
}
