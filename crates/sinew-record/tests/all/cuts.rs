//! Runs whose body is cut.

use std::fs;
use std::path::Path;

use serde_json::Value;
use sinew_record::{Ended, Request, RunFolder};
use sinew_scene::{Scene, SceneSource};
use sinew_world::{Command, Replay, World};

use crate::common::{build, run, table};

fn scene(tables: &str) -> String {
    format!(
        "gravity = [3.0, 0.0, -5.0]\n[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
         youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[[probe]]\nname = \"top\"\npoint = [0.0, 0.0, 0.1]\n\
         {tables}"
    )
}

/// A blade through the middle, which has passed through after .025 s.
const BLADE: &str = "[[tool]]\nname = \"blade\"\nshape = { blade = { length = 0.3 } }\nstart = [-0.02, 0.05, 0.05]\n\
    rotation = [1.5707963267948966, 0.0, 0.0]\nvelocity = [6.0, 0.0, 0.0]\n[cutting]\ntool = \"blade\"\n";

const NEWMARK: &str = "[run]\nduration = 0.1\nintegrator = \"newmark\"\ndt = 0.002\n[output]\nfields = { frames = 10 }\n";

fn summary(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("summary.json")).unwrap()).unwrap()
}

/// Number of nodes and of tetrahedra in a frame.
fn sizes(folder: &Path, frame: usize) -> [usize; 2] {
    let bytes = fs::read(folder.join(format!("fields/frame-{frame:05}.vtu"))).unwrap();
    let text = String::from_utf8_lossy(&bytes).into_owned();
    ["NumberOfPoints=\"", "NumberOfCells=\""].map(|name| {
        let (_, rest) = text.split_once(name).unwrap();
        rest.split('"').next().unwrap().parse().unwrap()
    })
}

#[test]
fn the_energy_of_a_split_body_adds_up_and_its_frames_have_the_nodes_that_it_had() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("cut");
    let simulation = build(&scene(&format!("{BLADE}{NEWMARK}")));
    let end = run(&path, &simulation, &mut ());
    assert_eq!((end.ended, end.steps), (Ended::Finished, 50));
    let energy = table(&path.join("energy.csv"));
    let most = energy["kinetic_J"].iter().zip(&energy["elastic_J"]);
    let most = most.map(|(a, b)| a + b).fold(0.0, f64::max);
    assert_eq!(energy["t_s"].len(), 51);
    for column in ["remainder_J", "of_cuts_J"] {
        let largest = energy[column]
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(largest < 1e-12 * most, "{column}: {largest} of {most}");
    }
    assert_eq!(table(&path.join("probes.csv"))["t_s"].len(), 51);
    let first = sizes(&path, 0);
    assert_eq!(first, [64, 162]);
    let last = sizes(&path, 10);
    let cuts = &summary(&path)["cuts"];
    let new_nodes = cuts["new_nodes"].as_u64().unwrap() as usize;
    assert!(new_nodes >= 16);
    assert_eq!(last, [64 + new_nodes, 162]);
    assert_eq!(cuts["pieces_at_the_end"], 2);
    let mass = &summary(&path)["mass_kg"];
    let [start, end] = ["start", "end"].map(|key| mass[key].as_f64().unwrap());
    assert!((start - 1.0).abs() < 1e-12 && (end - start).abs() < 1e-14);
}

#[test]
fn a_run_whose_body_is_taken_away_whole_ends_with_the_state_before() {
    let place = tempfile::tempdir().unwrap();
    for pieces in ["remove", "freeze"] {
        let text = format!(
            "[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1060.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 3500.0\n\
             poissons_ratio = 0.3\n[cutting]\nremove = {{ tool = \"burner\" }}\npieces = \"{pieces}\"\n[[tool]]\nname = \"burner\"\n\
             shape = {{ sphere = {{ radius = 0.08 }} }}\nstart = [0.1, 0.1, 0.13]\nvelocity = [0.0, 0.0, -0.5]\n\
             [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = \"auto\"\n"
        );
        let simulation = build(&text);
        let path = place.path().join(pieces);
        let end = run(&path, &simulation, &mut ());
        assert!(
            matches!(&end.ended, Ended::Refused { t, .. } if *t == 0.0),
            "{:?}",
            end.ended
        );
        assert!(path.join("summary.json").exists());
    }
}

#[test]
fn the_page_of_a_body_that_was_cut_at_rest_says_that_it_did_not_move() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("cut");
    let text = scene(&format!("{BLADE}{NEWMARK}")).replace("gravity = [3.0, 0.0, -5.0]\n", "");
    let end = run(&path, &build(&text), &mut ());
    assert_eq!(
        (end.largest.0, end.cuts.unwrap().0.changes > 0),
        (0.0, true)
    );
    let page = fs::read_to_string(path.join("report.html")).unwrap();
    assert!(page.contains("It did not move at any instant of the fields."));
    assert!(!page.contains("NaN") && !page.contains("inf times"));
}

/// The cut exposes edges of 43 mm, in addition to those of 35 mm of the surface, under a ball of 40 mm.
#[test]
fn a_tool_meets_what_a_cut_lays_open_under_it_as_it_met_the_surface_before() {
    let place = tempfile::tempdir().unwrap();
    let strokes = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,0.03,-0.01,-0.01,0.055,-0.01,0.11,0.055\n1,0.05,0.11,-0.01,0.095,0.11,0.11,0.095\n";
    fs::write(place.path().join("strokes.csv"), strokes).unwrap();
    let text = "[mesh]\ncube = { cells = 4, edge = 0.1 }\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\nyoungs_modulus = 3500.0\n\
         poissons_ratio = 0.3\n[[fixed]]\ngroup = \"bottom\"\n[cutting]\ntable = \"strokes.csv\"\n[[tool]]\nname = \"probe\"\n\
         shape = { sphere = { radius = 0.04 } }\nstart = [0.05, 0.05, 0.141]\nvelocity = [0.0, 0.0, -0.2]\n\
         [run]\nduration = 0.06\nintegrator = \"central-difference\"\ndt = 1e-4\n";
    let scene = place.path().join("scene.toml");
    fs::write(&scene, text).unwrap();
    let simulation = Scene::load(scene).and_then(Scene::build).unwrap();
    let path = place.path().join("cut");
    let end = run(&path, &simulation, &mut ());
    assert_eq!(end.ended, Ended::Finished);
    let rows = table(&path.join("tools.csv"));
    assert_eq!(rows["t_s"].len(), 601);
    assert!(rows["probe_residual"].iter().all(|left| *left < 1e-9));
    let energy = table(&path.join("energy.csv"));
    let energy = energy["kinetic_J"].iter().zip(&energy["elastic_J"]);
    let work = rows["probe_work_J"].last().unwrap();
    let most = energy.map(|(a, b)| a + b).fold(0.0, f64::max);
    assert!(most < 1.05 * work, "{most} of {work}");
}

#[test]
fn what_is_taken_away_takes_its_energy_along() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("cut");
    let cutting = format!("{BLADE}pieces = \"remove\"\n{NEWMARK}");
    let simulation = build(&scene(&cutting));
    run(&path, &simulation, &mut ());
    let energy = table(&path.join("energy.csv"));
    let most = energy["kinetic_J"].iter().zip(&energy["elastic_J"]);
    let most = most.map(|(a, b)| a + b).fold(0.0, f64::max);
    let taken = *energy["of_cuts_J"].last().unwrap();
    assert!(taken < -0.01 * most, "{taken} of {most}");
    let remainder = energy["remainder_J"].iter();
    let largest = remainder.fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(largest < 1e-12 * most, "{largest} of {most}");
    let removed = summary(&path)["cuts"]["removed_mass_kg"].as_f64().unwrap();
    assert!(removed > 0.3);
    let mass = summary(&path)["mass_kg"]["end"].as_f64().unwrap();
    assert!((mass + removed - 1.0).abs() < 1e-12);
    // The probe was on what is gone.
    assert!(
        table(&path.join("probes.csv"))["top_u_x_m"]
            .last()
            .unwrap()
            .is_nan()
    );
}

#[test]
fn what_is_frozen_takes_its_energy_along_and_stays_in_the_frames() {
    let place = tempfile::tempdir().unwrap();
    let [removed, frozen] = ["remove", "freeze"].map(|pieces| {
        let path = place.path().join(pieces);
        let cutting = format!("{BLADE}pieces = \"{pieces}\"\n{NEWMARK}");
        run(&path, &build(&scene(&cutting)), &mut ());
        path
    });
    let [of_removed, of_frozen] = [&removed, &frozen].map(|path| table(&path.join("energy.csv")));
    for column in ["kinetic_J", "elastic_J", "of_cuts_J"] {
        assert_eq!(of_removed[column], of_frozen[column], "{column}");
    }
    let cuts = &summary(&frozen)["cuts"];
    assert_eq!(cuts["removed_tetrahedra"], 0);
    assert!(cuts["frozen_tetrahedra"].as_u64().unwrap() > 50);
    assert_eq!(sizes(&frozen, 10)[1], 162);
    let mass = summary(&frozen)["mass_kg"]["end"].as_f64().unwrap();
    assert!((mass - 1.0).abs() < 1e-12);
    let top = &table(&frozen.join("probes.csv"))["top_u_x_m"];
    let [.., before, last] = top[..] else {
        panic!("two rows at least");
    };
    assert!(last.abs() > 1e-5, "{last}");
    assert_eq!(last, before);
}

fn read(text: &str) -> Scene {
    Scene::parse(SceneSource::new("scene.toml", text)).unwrap()
}

#[test]
fn a_session_that_only_waits_leaves_what_a_run_leaves() {
    let place = tempfile::tempdir().unwrap();
    let (ran, again) = (place.path().join("ran"), place.path().join("again"));
    let text = scene(&format!("{BLADE}{NEWMARK}"));
    run(&ran, &build(&text), &mut ());
    let mut session = World::new(read(&text)).unwrap();
    for _ in 0..50 {
        session.step().unwrap();
    }
    let mut replay = Replay::new(read(&text), session.log().clone()).unwrap();
    let end = RunFolder::replay(&again, &mut replay, &Request::default(), &mut ()).unwrap();
    assert_eq!(
        (end.ended, end.steps, end.frames),
        (Ended::Finished, 50, 11)
    );
    assert_eq!(replay.world().state(), session.state());
    let files = ["probes.csv", "energy.csv", "reactions.csv", "fields.pvd"];
    for file in files.into_iter().chain(["fields/frame-00010.vtu"]) {
        let [ran, again] = [&ran, &again].map(|folder| fs::read(folder.join(file)).unwrap());
        assert!(ran == again, "{file}");
    }
    assert_eq!(summary(&ran)["cuts"], summary(&again)["cuts"]);
}

#[test]
fn sheets_from_outside_are_repeated_bit_for_bit_and_recorded() {
    let place = tempfile::tempdir().unwrap();
    let text = scene(&format!(
        "[[load]]\nname = \"press\"\ngroup = \"top\"\ntraction = [0.0, 0.0, -20.0]\n[cutting]\n{NEWMARK}"
    ));
    let mut session = World::new(read(&text)).unwrap();
    let steps = |session: &mut World, count: usize| {
        for _ in 0..count {
            session.step().unwrap();
        }
    };
    let blade = |x: f64| [[x, -0.05, 0.045], [x, 0.15, 0.045]];
    let cut = |from: f64, to: f64| Command::Cut {
        from: blade(from),
        to: blade(to),
    };
    // Before a reset the body is cut as well, and then whole again.
    session.command(cut(-0.01, 0.2)).unwrap();
    steps(&mut session, 3);
    assert_eq!(session.cuts().unwrap().changes, 1);
    session.command(Command::Reset).unwrap();
    assert_eq!(session.cuts().unwrap().changes, 0);
    steps(&mut session, 5);
    session.command(cut(-0.01, 0.04)).unwrap();
    steps(&mut session, 5);
    let half = session.cuts().unwrap().report.area;
    session
        .command(Command::LoadFactor {
            load: "press".into(),
            factor: 3.0,
        })
        .unwrap();
    session.command(cut(0.04, 0.2)).unwrap();
    steps(&mut session, 20);
    let totals = *session.cuts().unwrap();
    assert!(half > 0.0 && totals.report.area > half && totals.changes == 2);
    assert_eq!(session.cutter().unwrap().pieces(), 2);
    let log = session.log().clone();
    let path = place.path().join("again");
    let mut replay = Replay::new(read(&text), log).unwrap();
    let end = RunFolder::replay(&path, &mut replay, &Request::default(), &mut ()).unwrap();
    assert_eq!((end.ended, end.steps), (Ended::Finished, 30));
    assert_eq!(replay.world().state(), session.state());
    assert_eq!(replay.world().cuts(), Some(&totals));
    let energy = table(&path.join("energy.csv"));
    assert_eq!(energy["t_s"].len(), 31);
    assert!(energy["t_s"].windows(2).all(|pair| pair[1] > pair[0]));
    let most = energy["kinetic_J"].iter().zip(&energy["elastic_J"]);
    let most = most.map(|(a, b)| a + b).fold(0.0, f64::max);
    let remainder = energy["remainder_J"].iter();
    let largest = remainder.fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(largest < 1e-12 * most, "{largest} of {most}");
    let wrong = session.command(Command::Cut {
        from: blade(f64::NAN),
        to: blade(0.0),
    });
    let said = wrong.unwrap_err().to_string();
    assert_eq!(
        said,
        "cut: NaN: expected finite numbers, at most 1e6 m in size"
    );
}

/// Elements that average strain change their energy when a stretched body is cut, with and without a moved part.
#[test]
fn energy_of_a_cut_is_known_where_supports_move() {
    let strokes = "stroke,t_s,ax_m,ay_m,az_m,bx_m,by_m,bz_m\n1,0.06,0.0103,-0.03,-0.02,0.0103,-0.03,0.04\n1,0.08,0.0103,0.05,-0.02,0.0103,0.05,0.04\n";
    let moved = "[[move]]\nwhere = { above = { x = 0.02, y = 0.02, z = 0.02 } }\naxes = \"y\"\ndisplacement = [0.0, 0.00001, 0.0]\n\
                 ramp = { kind = \"sin2\", rise = 0.05 }\n";
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("strokes.csv"), strokes).unwrap();
    let of_cuts = ["", moved].map(|moved| {
        let text = format!(
            "[mesh]\nblock = {{ cells = [4, 4, 4], size = [0.02, 0.02, 0.02], split = \"mirrored\" }}\n[[region]]\ndensity = 1060.0\n\
             model = \"neo-hookean\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\nelement = \"fbar-edge\"\n[[fixed]]\n\
             where = {{ below = {{ x = 0.0 }} }}\n{moved}[[load]]\nwhere = {{ above = {{ x = 0.02 }} }}\nforce = [0.4, 0.0, 0.0]\n\
             ramp = {{ kind = \"sin2\", rise = 0.05 }}\n[damping]\nmass = 30.0\n[cutting]\ntable = \"strokes.csv\"\nsnap = 0\n\
             [run]\nduration = 0.1\nintegrator = \"central-difference\"\ndt = 0.0002\nfree_flight = true\n"
        );
        let path = place.path().join("scene.toml");
        fs::write(&path, text).unwrap();
        let mut simulation = Scene::load(&path).unwrap().build().unwrap();
        simulation.end_at_duration();
        let out = place.path().join(format!("out{}", moved.len()));
        let end = run(&out, &simulation, &mut ());
        assert_eq!(end.ended, Ended::Finished);
        let energy = table(&out.join("energy.csv"));
        let [cuts, remainder] =
            ["of_cuts_J", "remainder_J"].map(|name| *energy[name].last().unwrap());
        assert!(cuts.abs() > 1e-5, "{cuts}");
        assert!(remainder.abs() < 0.1 * cuts.abs(), "{remainder} {cuts}");
        let gained = summary(&out)["cuts"]["elastic_energy_gained_J"].as_f64();
        assert!((gained.unwrap() / cuts - 1.0).abs() < 1e-6);
        cuts
    });
    assert!((of_cuts[1] / of_cuts[0] - 1.0).abs() < 0.2, "{of_cuts:?}");
}
