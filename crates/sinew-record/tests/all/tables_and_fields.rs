//! Tables and fields agree with each other and with statics.

use std::fs;
use std::path::Path;

use sinew_mesh::vtu::read_vtu;
use sinew_record::{Ended, FolderSize, Request, RunFolder};

use crate::common::{build, cube, run, table};

/// An array of the points or cells of a frame.
fn array(frame: &[u8], name: &str) -> Vec<f64> {
    let frame = read_vtu(frame).unwrap();
    let points = frame.point_data.iter();
    let points = points.map(|data| (&data.name, data.values.clone()));
    let cells = frame.cell_data.iter();
    let cells = cells.map(|data| (&data.name, data.blocks.concat()));
    let found = points.chain(cells).find(|(known, _)| *known == name);
    found.unwrap_or_else(|| panic!("no array {name}")).1
}

pub(crate) fn singles(path: &Path, name: &str) -> Vec<f32> {
    let numbers = array(&fs::read(path).unwrap(), name);
    numbers.into_iter().map(|number| number as f32).collect()
}

/// A column under its own weight: supports carry it to 1e-8, and their moment about their middle is that of evenly
/// distributed forces.
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

/// Compression changes no number, and no tetrahedron alone swings faster than the body (Rayleigh's principle).
#[test]
fn compressed_fields_are_the_same_and_steps_of_tetrahedra_are_above_that_of_the_body() {
    let place = tempfile::tempdir().unwrap();
    let body = |output: &str| {
        cube(&format!(
            "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[run]\nduration = 0.1\n\
             integrator = \"central-difference\"\ndt = 0.0025\n[output]\nfields = {{ frames = 1 }}\nstep_limit = true\n\
             {output}"
        ))
    };
    let mut frames = Vec::new();
    for (name, output) in [("plain", ""), ("packed", "compress = true\n")] {
        let out = place.path().join(name);
        run(&out, &body(output), &mut ());
        frames.push(fs::read(out.join("fields/frame-00001.vtu")).unwrap());
    }
    assert!(frames[1].len() < frames[0].len());
    for name in [
        "displacement",
        "velocity",
        "strain",
        "stress",
        "von_mises",
        "step_limit",
    ] {
        let [plain, packed] = [0, 1].map(|frame| array(&frames[frame], name));
        let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(plain), bits(packed), "{name}");
    }
    let limits = array(&frames[0], "step_limit");
    let least = limits.iter().copied().fold(f64::INFINITY, f64::min);
    let simulation = body("");
    let of_body = 2.0 / simulation.system().spectrum(None).unwrap().omega_max;
    assert!(
        of_body <= least && least < 3.0 * of_body,
        "{least} {of_body}"
    );
}

/// Sizes of a folder that a plan predicts are those that a run writes: of frames except for their text, of tables
/// except for the length of numbers.
#[test]
fn the_size_of_a_folder_is_told_before() {
    let place = tempfile::tempdir().unwrap();
    for (name, output) in [
        ("all", "acceleration = true\nstep_limit = true\n"),
        ("surface", "surface_only = true\n"),
    ] {
        let simulation = cube(&format!(
            "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[run]\nduration = 0.1\n\
             integrator = \"newmark\"\ndt = 0.0025\n[[probe]]\nname = \"p\"\npoint = [0.0333, 0.0333, 0.1]\n\
             [output]\nfields = {{ frames = 4 }}\n{output}"
        ));
        let size = FolderSize::of(&simulation);
        let out = place.path().join(name);
        run(&out, &simulation, &mut ());
        let bytes = |path: &Path| fs::metadata(path).unwrap().len() as f64;
        let frames = fs::read_dir(out.join("fields")).unwrap();
        let frames: Vec<f64> = frames.map(|frame| bytes(&frame.unwrap().path())).collect();
        assert_eq!(frames.len(), size.frames);
        for frame in frames {
            let text = frame - size.frame_bytes as f64;
            assert!((500.0..3000.0).contains(&text), "{name}: {text}");
        }
        let tables = ["probes.csv", "energy.csv", "reactions.csv"];
        let tables: f64 = tables.iter().map(|name| bytes(&out.join(name))).sum();
        let ratio = tables / size.table_bytes as f64;
        assert!((0.5..2.0).contains(&ratio), "{name}: {ratio}");
    }
}

#[test]
fn a_frame_that_cannot_be_written_ends_the_run_with_its_reason() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = cube(
        "[[load]]\ngroup = \"top\"\npressure = 100.0\n[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.0025\n",
    );
    let folder = RunFolder::create(&out, &simulation, &Request::default()).unwrap();
    fs::write(out.join("fields"), "in the way").unwrap();
    let refused = folder.run(&mut crate::common::world(&simulation), &mut ());
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains("fields"), "{refused}");
    assert!(!out.join("summary.json").exists());
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

/// Two supports that share nodes, one along z and one across: each carries the forces in its directions, and together
/// they carry the load.
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

/// A step far too long inverts tetrahedra, for which the law has no force and so no acceleration. No row of the energy
/// is due there; such a row would be refused before.
#[test]
fn a_run_ends_by_name_where_a_frame_asks_for_an_acceleration_that_the_law_refuses() {
    let place = tempfile::tempdir().unwrap();
    for integrator in ["symplectic-euler", "rk4"] {
        let out = place.path().join(integrator);
        let simulation = build(&format!(
            "[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 3000.0\n\
             poissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[load]]\ngroup = \"top\"\ntraction = [0.0, 0.0, -3000.0]\n[run]\nduration = 1.0\n\
             integrator = \"{integrator}\"\ndt = 0.02\n[output]\nfields = {{ frames = 50 }}\nenergy = {{ frames = 1 }}\nacceleration = true\n"
        ));
        let end = run(&out, &simulation, &mut ());
        assert!(
            matches!(&end.ended, Ended::Refused { t, .. } if *t > 0.0),
            "{:?}",
            end.ended
        );
        assert!(end.frames >= 1 && out.join("summary.json").exists());
    }
}
