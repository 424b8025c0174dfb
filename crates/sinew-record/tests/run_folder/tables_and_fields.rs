//! Tables and fields say the same, and what statics says.

use std::fs;
use std::path::Path;

use crate::common::{cube, run, table};

/// An array of single-precision numbers of a .vtu file with appended data.
fn singles(path: &Path, name: &str) -> Vec<f32> {
    let bytes = fs::read(path).unwrap();
    let begin = bytes.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
    let text = String::from_utf8_lossy(&bytes[..begin]).into_owned();
    let array = text
        .split("<DataArray")
        .find(|array| array.contains(&format!("Name=\"{name}\"")));
    let array = array.unwrap();
    assert!(array.contains("type=\"Float32\""), "{array}");
    let offset = array
        .split("offset=\"")
        .nth(1)
        .unwrap()
        .split('"')
        .next()
        .unwrap();
    let data = &bytes[begin + offset.parse::<usize>().unwrap()..];
    let length = u64::from_le_bytes(*data.first_chunk().unwrap()) as usize;
    let numbers = data[8..8 + length].as_chunks::<4>().0.iter();
    numbers.map(|number| f32::from_le_bytes(*number)).collect()
}

/// A column under its own weight: supports carry it to 1e-8, and their moment about their middle is that of forces that
/// lie evenly about it.
#[test]
fn reactions_carry_the_weight() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = cube(
        "gravity = [0.0, 0.0, -9.81]\n[[fixed]]\ngroup = \"bottom\"\n[[initial]]\nstatic = [\"gravity\"]\n[run]\n\
         duration = 0.01\nintegrator = \"newmark\"\ndt = 0.001\n",
    );
    run(&out, &simulation, &mut ());
    let reactions = table(&out.join("reactions.csv"));
    let weight = 1000.0 * 0.001 * 9.81;
    for force in &reactions["fixed_1_bottom_f_z_N"] {
        assert!((force / weight - 1.0).abs() < 1e-8, "{force}");
    }
    for name in ["f_x_N", "f_y_N"] {
        let column = &reactions[&format!("fixed_1_bottom_{name}")];
        assert!(column.iter().all(|force| force.abs() < 1e-8 * weight));
    }
}

#[test]
fn fields_are_those_of_the_probes() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = cube(
        "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[run]\nduration = 0.1\n\
         integrator = \"central-difference\"\ndt = 0.0025\n[[probe]]\nname = \"p\"\npoint = [0.0333, 0.0333, 0.1]\n\
         [output]\nfields = { frames = 4 }\n",
    );
    run(&out, &simulation, &mut ());
    let probes = table(&out.join("probes.csv"));
    assert_eq!(probes["t_s"].len(), 41);
    assert_eq!(*probes["t_s"].last().unwrap(), 0.1);
    let node = simulation.probes()[0].node.unwrap().index as usize;
    let series = fs::read_to_string(out.join("fields.pvd")).unwrap();
    for frame in 0..5 {
        let row = 10 * frame;
        let time = format!("timestep=\"{:?}\"", probes["t_s"][row]);
        assert!(series.contains(&time), "{time}: {series}");
        let path = out.join(format!("fields/frame-{frame:05}.vtu"));
        let u = singles(&path, "displacement");
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let expected = probes[&format!("p_u_{name}_m")][row];
            assert_eq!(u[3 * node + axis], expected as f32);
        }
    }
    assert!(!out.join("fields/frame-00005.vtu").exists());
}

/// Uniaxial stress: a bar that is pulled has the same stress everywhere, and von Mises' is the pull.
#[test]
fn the_stress_of_a_bar_that_is_pulled_is_the_pull() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = cube(
        "[[fixed]]\ngroup = \"bottom\"\naxes = \"z\"\n[[load]]\ngroup = \"top\"\n\
         traction = [0.0, 0.0, 30.0]\n[[initial]]\nstretch = [-0.003, -0.003, 0.01]\norigin = [0.0, 0.0, 0.0]\n[run]\nduration = 0.002\n\
         integrator = \"newmark\"\ndt = 0.001\n",
    );
    run(&out, &simulation, &mut ());
    let last = out.join("fields/frame-00002.vtu");
    for stress in singles(&last, "von_mises") {
        assert!((stress / 30.0 - 1.0).abs() < 1e-5, "{stress}");
    }
    let strain = singles(&last, "strain");
    for strain in strain.as_chunks::<6>().0 {
        assert!((strain[2] / 0.01 - 1.0).abs() < 1e-5 && (strain[0] / -0.003 - 1.0).abs() < 1e-5);
    }
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    let largest = summary["extremes"]["principal_strain"]["1"]
        .as_f64()
        .unwrap();
    assert!((largest - 0.01).abs() < 1e-9, "{largest}");
    assert_eq!(summary["outcome"], "finished");
}

/// Two supports that share nodes, one along z and one across: each carries what it holds, and together the load.
#[test]
fn supports_that_share_nodes_share_no_force() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = cube(
        "gravity = [1.0, 0.0, -9.81]\n[[fixed]]\ngroup = \"bottom\"\naxes = \"z\"\n[[fixed]]\ngroup = \"bottom\"\n\
         axes = \"xy\"\n[[initial]]\nstatic = [\"gravity\"]\n[run]\nduration = 0.01\nintegrator = \"newmark\"\n\
         dt = 0.001\n",
    );
    run(&out, &simulation, &mut ());
    let reactions = table(&out.join("reactions.csv"));
    let of = |name: &str| reactions[name][5];
    let mass = 1.0;
    assert!((of("fixed_1_bottom_f_z_N") / (9.81 * mass) - 1.0).abs() < 1e-8);
    assert!((of("fixed_2_bottom_f_x_N") / -mass - 1.0).abs() < 1e-8);
    for name in ["fixed_1_bottom_f_x_N", "fixed_2_bottom_f_z_N"] {
        assert_eq!(of(name), 0.0, "{name}");
    }
}
