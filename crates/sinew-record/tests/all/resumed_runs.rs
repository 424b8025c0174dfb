//! A run that was interrupted and continued leaves the same bytes as an uninterrupted one.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::{build, cube, run};
use sinew_record::{Companion, Ended, RecordRunError, RunFolder};

/// An observer that interrupts a run at the first check at or after a step.
struct InterruptAt {
    step: usize,
    reached: usize,
}

impl Companion for InterruptAt {
    fn is_interrupted(&self) -> bool {
        self.reached >= self.step
    }

    fn progress(&mut self, steps: usize, _t: f64) {
        self.reached = steps;
    }
}

/// Contents by names, without the facts about the computer.
fn contents(path: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for folder in [path.to_owned(), path.join("fields")] {
        for entry in fs::read_dir(&folder).unwrap() {
            let entry = entry.unwrap();
            if entry.file_type().unwrap().is_dir() {
                continue;
            }
            let content = fs::read(entry.path()).unwrap();
            let name = entry.file_name().into_string().unwrap();
            let content = match name.as_str() {
                "summary.json" => {
                    let mut json: serde_json::Value = serde_json::from_slice(&content).unwrap();
                    json.as_object_mut().unwrap().remove("computer").unwrap();
                    json.to_string().into_bytes()
                }
                _ => content,
            };
            found.insert(name, content);
        }
    }
    found
}

const SCENES: [&str; 7] = [
    "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[damping]\nmass = 2.0\n[run]\n\
     duration = 0.3\nintegrator = \"central-difference\"\ndt = 0.001\n[output]\nfields = { frames = 7 }\n",
    "gravity = [0.0, 0.0, -9.81]\n[[fixed]]\ngroup = \"bottom\"\n[[move]]\ngroup = \"top\"\ndisplacement = [0.0, 0.0, 0.01]\n\
     ramp = { kind = \"sin2\", rise = 0.2 }\n[run]\nduration = 0.3\nintegrator = \"newmark\"\ndt = 0.002\n[[probe]]\n\
     name = \"middle\"\npoint = [0.05, 0.05, 0.05]\n[output]\nenergy = { every = 0.013 }\nacceleration = true\n",
    "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 100.0\n[run]\nduration = 0.3\n\
     integrator = \"propagator\"\nkind = \"two-step\"\ndt = 0.003\n[output]\nprobes = { frames = 11 }\nsurface_only = true\n",
    "[[fixed]]\ngroup = \"sides\"\n[[load]]\ngroup = \"top\"\npressure = 300.0\n[run]\nduration = 0.3\n\
     integrator = \"cnn\"\nsaturation = 0.4\ndt = 0.002\nprecision = \"f32\"\n",
    "[[fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"probe\"\nshape = { sphere = { radius = 0.05 } }\nstart = [0.05, 0.05, 0.151]\n\
     velocity = [0.05, 0.0, -0.2]\nfriction = 0.3\ngrasp = { from = 0.05, to = 0.11 }\n[[tool]]\nname = \"wall\"\nshape = { plane = {} }\n\
     start = [0.099, 0.0, 0.0]\nrotation = [0.0, -1.5707963267948966, 0.0]\nhold = true\nstarts_inside = \"push\"\n[run]\nduration = 0.15\n\
     integrator = \"central-difference\"\ndt = 0.001\n",
    "gravity = [0.0, 0.0, 9.81]\n[[fixed]]\ngroup = \"bottom\"\n[[tool]]\nname = \"blade\"\nshape = { blade = { length = 0.3 } }\n\
     start = [-0.005, 0.05, 0.051]\nrotation = [1.5707963267948966, 0.0, 0.0]\nvelocity = [1.0, 0.0, 0.3]\n[[tool]]\nname = \"jaw\"\n\
     shape = { sphere = { radius = 0.03 } }\nstart = [0.05, 0.05, 0.131]\nvelocity = [0.0, 0.0, -0.03]\ngrasp = { from = 0.01, to = 1.0 }\n\
     [cutting]\nsnap = 0.25\ntool = \"blade\"\ntoughness = 10.0\n[run]\nduration = 0.15\nintegrator = \"central-difference\"\ndt = 0.001\n",
    "[[fixed]]\ngroup = \"bottom\"\n[[move]]\ngroup = \"top\"\naxes = \"x\"\ndisplacement = [0.01, 0.0, 0.0]\n\
     ramp = { kind = \"sin2\", rise = 0.1 }\n[[tool]]\nname = \"burner\"\nshape = { sphere = { radius = 0.03 } }\n\
     start = [-0.05, 0.05, 0.05]\nvelocity = [0.8, 0.0, 0.0]\n[cutting]\nremove = { tool = \"burner\" }\npieces = \"freeze\"\n[run]\n\
     duration = 0.3\nintegrator = \"newmark\"\ndt = 0.002\n[output]\nenergy = { every = 0.013 }\n",
];

#[test]
fn the_bytes_do_not_depend_on_interruptions() {
    for scene in SCENES {
        let place = tempfile::tempdir().unwrap();
        let simulation = cube(scene);
        let whole = place.path().join("whole");
        assert_eq!(run(&whole, &simulation, &mut ()).ended, Ended::Finished);
        let expected = contents(&whole);
        let summary = str::from_utf8(&expected["summary.json"]).unwrap();
        assert!(summary.contains("\"overlap\":null"), "{summary}");
        for steps in [&[1][..], &[2, 3, 4], &[40], &[17, 60, 61]] {
            let cut = place.path().join(format!("cut-{}", steps.len()));
            let _ = fs::remove_dir_all(&cut);
            for step in steps {
                let mut companion = InterruptAt {
                    step: *step,
                    reached: 0,
                };
                let end = run(&cut, &simulation, &mut companion);
                assert!(matches!(end.ended, Ended::Interrupted { .. }), "{step}");
            }
            let end = run(&cut, &simulation, &mut ());
            assert_eq!(end.ended, Ended::Finished);
            let found = contents(&cut);
            assert_eq!(
                found.keys().collect::<Vec<_>>(),
                expected.keys().collect::<Vec<_>>()
            );
            for (name, content) in &expected {
                assert!(&found[name] == content, "{name} after {steps:?} of {scene}");
            }
        }
    }
}

#[test]
fn another_mesh_and_a_damaged_checkpoint_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../meshes");
    let mesh = place.path().join("body.msh");
    fs::copy(meshes.join("sliver-20.msh"), &mesh).unwrap();
    let text = "[mesh]\nfile = \"body.msh\"\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\n\
                poissons_ratio = 0.3\n[[initial]]\nvelocity = [0.0, 0.0, 1.0]\n[run]\nduration = 0.2\n\
                integrator = \"newmark\"\ndt = 0.001\n";
    fs::write(place.path().join("scene.toml"), text).unwrap();
    let scene = sinew_scene::Scene::load(place.path().join("scene.toml")).unwrap();
    let simulation = scene.build().unwrap();
    let out = place.path().join("out");
    run(
        &out,
        &simulation,
        &mut InterruptAt {
            step: 50,
            reached: 0,
        },
    );

    let checkpoint = out.join("checkpoint.bin");
    let whole = fs::read(&checkpoint).unwrap();
    for damaged in [
        &whole[..whole.len() - 1],
        &whole[..100],
        b"",
        &[&whole[..], b"x"].concat(),
    ] {
        fs::write(&checkpoint, damaged).unwrap();
        let (folder, _) = RunFolder::reopen(&out).unwrap();
        let refused = folder.run(&mut crate::common::world(&simulation), &mut ());
        assert!(matches!(
            refused.unwrap_err(),
            RecordRunError::Unusable { .. } | RecordRunError::Checkpoint { .. }
        ));
    }
    // Any byte, and the scene with which it was begun.
    for at in [20, whole.len() / 3, whole.len() - 40, whole.len() - 1] {
        let mut flipped = whole.clone();
        flipped[at] ^= 1;
        fs::write(&checkpoint, flipped).unwrap();
        let (folder, _) = RunFolder::reopen(&out).unwrap();
        let refused = folder.run(&mut crate::common::world(&simulation), &mut ());
        assert!(
            matches!(refused.unwrap_err(), RecordRunError::Unusable { .. }),
            "{at}"
        );
    }
    fs::write(&checkpoint, whole).unwrap();
    let scene = fs::read_to_string(out.join("scene.toml")).unwrap();
    fs::write(out.join("scene.toml"), scene.replace("1.0]", "2.0]")).unwrap();
    let (folder, _) = RunFolder::reopen(&out).unwrap();
    let refused = folder.run(&mut crate::common::world(&simulation), &mut ());
    assert!(matches!(
        refused.unwrap_err(),
        RecordRunError::Unusable { .. }
    ));
    drop(folder);
    fs::write(out.join("scene.toml"), scene).unwrap();

    let longer = fs::read_to_string(&mesh).unwrap() + "\n";
    fs::write(&mesh, longer).unwrap();
    let refused = RunFolder::reopen(&out).unwrap_err().to_string();
    assert!(
        refused.contains("body.msh is not the file with which the run began"),
        "{refused}"
    );
}

/// A thrown cube that fibres stop, with a method and further tables.
fn caught(run: &str) -> String {
    format!(
        "[mesh]\ncube = {{ cells = 3, edge = 0.04 }}\n[[region]]\ndensity = 1000.0\nmodel = \"neo-hookean\"\n\
         youngs_modulus = 5000.0\npoissons_ratio = 0.4\nfibres = {{ direction = [0, 0, 1], k1 = 2000.0, k2 = 50.0 }}\n\
         [[fixed]]\ngroup = \"bottom\"\n[[initial]]\nvelocity = [0, 0, \"40*z\"]\n[run]\nduration = 0.1\n{run}\n"
    )
}

#[test]
fn steps_that_are_taken_again_are_counted_across_interruptions() {
    let place = tempfile::tempdir().unwrap();
    let simulation = build(&caught(
        "integrator = \"central-difference\"\ndt = \"auto\"",
    ));
    let whole = place.path().join("whole");
    let end = run(&whole, &simulation, &mut ());
    assert_eq!(end.ended, Ended::Finished);
    assert!(end.retaken > 0);
    let cut = place.path().join("cut");
    for step in [3, 20] {
        let mut companion = InterruptAt { step, reached: 0 };
        run(&cut, &simulation, &mut companion);
    }
    assert_eq!(run(&cut, &simulation, &mut ()).retaken, end.retaken);
    assert!(contents(&cut) == contents(&whole));
}

#[test]
fn a_certificate_says_what_it_has_not_seen() {
    let place = tempfile::tempdir().unwrap();
    let simulation = build(&caught("integrator = \"cnn-energy\"\ndt = 0.001"));
    let cut = place.path().join("cut");
    let mut companion = InterruptAt {
        step: 60,
        reached: 0,
    };
    let first = run(&cut, &simulation, &mut companion).remarks.concat();
    assert!(first.starts_with("certificate: "), "{first}");
    let end = run(&cut, &simulation, &mut ());
    let steps = end.own.0;
    assert!(steps <= 40, "{steps}");
    let said = end.remarks.concat();
    let since = format!(
        "since the checkpoint at t = {} s: certificate: ",
        (100 - steps) as f64 * 1e-3
    );
    assert!(said.starts_with(&since), "{said}");
    assert!(said.contains(&format!("in {steps} steps")), "{said}");
}
