//! Results about tools.

use std::fs;
use std::path::Path;

use sinew_core::simulate;
use sinew_record::{EnergyGrowth, FolderSize};
use sinew_scene::{Scene, Simulation};

use crate::common::{run, table};
use crate::tables_and_fields::singles;

/// Young's modulus times area over length (N/m) of the bar.
const STIFFNESS: f64 = 3000.0 * 0.1 * 0.1 / 0.1;

/// The height (m) of the plate: down by 5 mm within 0.1 s, with a smooth beginning and end, so that little energy is
/// lost when nodes come into contact with it.
fn height(t: f64) -> f64 {
    let share = (t / 0.1).min(1.0);
    0.1 - 0.005 * (std::f64::consts::FRAC_PI_2 * share).sin().powi(2)
}

/// A bar that is fixed at its bottom and does not widen, and a plate that comes down on it, moved by a table in
/// `folder`.
fn pressed(folder: &Path, duration: f64, more: &str) -> Simulation {
    let pi = std::f64::consts::PI;
    let mut rows = "t_s,x_m,y_m,z_m,rx_rad,ry_rad,rz_rad\n".to_owned();
    for row in 0..=100 {
        let t = f64::from(row) / 1000.0;
        rows.push_str(&format!("{t},0.05,0.05,{},{pi},0,0\n", height(t)));
    }
    fs::write(folder.join("plate.csv"), rows).unwrap();
    let text = format!(
        "[mesh]\ncube = {{ cells = 3, edge = 0.1 }}\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\nyoungs_modulus = 3000.0\n\
         poissons_ratio = 0.0\n[damping]\nmass = 38.0\n[[fixed]]\ngroup = \"bottom\"\n\
         [[tool]]\nname = \"plate\"\nshape = {{ plane = {{}} }}\ntable = \"plate.csv\"\n\
         [run]\nduration = {duration}\nintegrator = \"symplectic-euler\"\ndt = 0.0005\n{more}"
    );
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    let mut simulation = Scene::load(&path).unwrap().build().unwrap();
    simulation.end_at_duration();
    simulation
}

/// A row at t = 0 and one for each step; at rest the force is E A d/L, and no node is inside the plate at any time.
#[test]
fn a_plate_feels_hookes_law() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    run(&out, &pressed(place.path(), 2.0, ""), &mut ());
    let text = fs::read_to_string(out.join("tools.csv")).unwrap();
    let head = text.lines().find(|line| !line.starts_with('#')).unwrap();
    let expected = "t_s,plate_x_m,plate_y_m,plate_z_m,plate_rx_rad,plate_ry_rad,plate_rz_rad,plate_force_x_N,plate_force_y_N,\
                    plate_force_z_N,plate_torque_x_Nm,plate_torque_y_Nm,plate_torque_z_Nm,plate_work_J,plate_contacts,plate_gap_m,plate_passes,plate_residual";
    assert_eq!(head, expected);
    let rows = table(&out.join("tools.csv"));
    let t = &rows["t_s"];
    assert_eq!((t.len(), t[0], t[4000]), (4001, 0.0, 2.0));
    for (name, column) in &rows {
        let are_not_zero = ["t_s", "_x_m", "_y_m", "_z_m", "_rad", "_gap_m"];
        if !are_not_zero.iter().any(|end| name.ends_with(end)) {
            assert_eq!(column[0].abs(), 0.0, "{name}");
        }
    }
    for (t, z) in t.iter().zip(&rows["plate_z_m"]) {
        // Rows lie on the way every 1 ms, steps half way between.
        assert!((z - height(*t)).abs() < 1e-6, "{t} {z}");
    }
    let last = |name: &str| *rows[name].last().unwrap();
    let force = STIFFNESS * 0.005;
    assert!((last("plate_force_z_N") / force - 1.0).abs() < 1e-9);
    assert_eq!(last("plate_contacts"), 16.0);
    assert!(rows["plate_gap_m"].iter().all(|gap| *gap > -1e-15));
    // The plate's own origin is above the middle of the bar.
    assert!(last("plate_torque_x_Nm").abs() < 1e-9 * force);
}

/// Energy supplied is the work of the plate: it is stored in the bar, was damped, or was lost when nodes came into
/// contact with the plate.
#[test]
fn the_work_of_tools_is_part_of_the_balance() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    run(&out, &pressed(place.path(), 0.5, ""), &mut ());
    let (energy, rows) = (
        table(&out.join("energy.csv")),
        table(&out.join("tools.csv")),
    );
    assert_eq!(energy["work_of_tools_J"], rows["plate_work_J"]);
    let work = energy["work_of_tools_J"].last().unwrap();
    assert!(*work > 0.5 * STIFFNESS * 0.005 * 0.005);
    let remainder = &energy["remainder_J"];
    let most = remainder.iter().copied().fold(0.0, f64::max);
    let least = remainder.iter().copied().fold(0.0, f64::min);
    assert!(
        most < 0.01 * work && least > -0.01 * work,
        "{least:e} to {most:e} of {work:e}"
    );
}

/// The pressure under the plate is E d/L at all points of contact, including edges and corners, and its forces sum up
/// to the force on the plate.
#[test]
fn fields_have_forces_and_pressures_of_contact() {
    let place = tempfile::tempdir().unwrap();
    for (name, more) in [("body", ""), ("surface", "surface_only = true\n")] {
        let out = place.path().join(name);
        let more = format!("[output]\nfields = {{ frames = 1 }}\n{more}");
        let simulation = pressed(place.path(), 2.0, &more);
        run(&out, &simulation, &mut ());
        let last = out.join("fields/frame-00001.vtu");
        let of = |name: &str| -> Vec<f64> {
            let numbers = singles(&last, name).into_iter();
            numbers.map(f64::from).collect()
        };
        let (forces, pressures) = (of("contact_force"), of("contact_pressure"));
        assert_eq!(forces.len(), 3 * pressures.len());
        let sum: f64 = forces.as_chunks::<3>().0.iter().map(|force| force[2]).sum();
        assert!((sum / (-STIFFNESS * 0.005) - 1.0).abs() < 1e-6);
        let pressed = pressures.iter().filter(|pressure| **pressure > 0.0);
        assert_eq!(pressed.clone().count(), 16);
        for pressure in pressed {
            assert!(
                (pressure / (3000.0 * 0.05) - 1.0).abs() < 1e-6,
                "{pressure}"
            );
        }
        let first = singles(&out.join("fields/frame-00000.vtu"), "contact_pressure");
        assert!(first.iter().all(|pressure| *pressure == 0.0));
    }
}

#[test]
fn rows_come_as_often_as_those_of_probes_and_their_size_is_told_before() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    let simulation = pressed(
        place.path(),
        0.1,
        "[output]\nprobes = { frames = 40 }\nfields = { frames = 2 }\n",
    );
    let size = FolderSize::of(&simulation);
    run(&out, &simulation, &mut ());
    let rows = table(&out.join("tools.csv"));
    assert_eq!(rows["t_s"].len(), 41);
    assert_eq!(table(&out.join("probes.csv"))["t_s"], rows["t_s"]);
    let bytes = |name: &str| fs::metadata(out.join(name)).unwrap().len() as f64;
    let tables = ["probes.csv", "energy.csv", "reactions.csv", "tools.csv"];
    let tables: f64 = tables.into_iter().map(bytes).sum();
    let ratio = tables / size.table_bytes as f64;
    assert!((0.5..2.0).contains(&ratio), "{ratio}");
    let text = bytes("fields/frame-00001.vtu") - size.frame_bytes as f64;
    assert!((500.0..3000.0).contains(&text), "{text}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("Forces on tools"));
    let pictures: Vec<&str> = page.split("src=\"data:image/png;base64,").skip(1).collect();
    assert_eq!(
        pictures.len(),
        9,
        "the start, and two colours from four sides"
    );
    for (at, picture) in pictures.iter().enumerate() {
        let png = data_encoding::BASE64.decode(picture.split('"').next().unwrap().as_bytes());
        let png = png.unwrap();
        // Width and height are in the header.
        assert_eq!(
            png[16..24],
            [480_u32.to_be_bytes(), 270_u32.to_be_bytes()].concat(),
            "{at}"
        );
        assert!(pictures[..at].iter().all(|other| other != picture), "{at}");
    }
}

/// Only a plate supplies energy to this body, many times its initial energy.
#[test]
fn the_work_of_tools_is_no_energy_from_nothing() {
    let place = tempfile::tempdir().unwrap();
    pressed(place.path(), 0.5, "");
    let path = place.path().join("scene.toml");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("\"linear\"", "\"neo-hookean\"")).unwrap();
    let simulation = Scene::load(&path).unwrap().build().unwrap();
    let mut growth = EnergyGrowth::new(&simulation);
    let mut state = simulation.initial_state().clone();
    let mut integrator = simulation.integrator().unwrap();
    let system = simulation.system();
    simulate(
        system,
        &mut *integrator,
        &mut state,
        &simulation.run(),
        &mut growth,
    )
    .unwrap();
    assert!(system.energy(&state.u, &state.v).unwrap().total() > 1e-3);
    assert_eq!(growth.in_words(), None);
}

/// A plate on a spring with the stiffness of the bar goes half as deep, and its table contains the work that drives its
/// path.
#[test]
fn a_plate_on_a_coupling_shares_the_way_with_the_tissue() {
    let place = tempfile::tempdir().unwrap();
    let out = place.path().join("out");
    pressed(place.path(), 2.0, "");
    let path = place.path().join("scene.toml");
    let body = format!(
        "table = \"plate.csv\"\nbody = {{ mass = 0.05, inertia = [1e3, 1e3, 1e3], coupling = {STIFFNESS}, rotational_coupling = 1e6 }}\n"
    );
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("table = \"plate.csv\"\n", &body)).unwrap();
    let mut simulation = Scene::load(&path).unwrap().build().unwrap();
    simulation.end_at_duration();
    run(&out, &simulation, &mut ());
    let rows = table(&out.join("tools.csv"));
    let last = |name: &str| *rows[name].last().unwrap();
    assert_eq!(rows["plate_hand_work_J"][0], 0.0);
    // It begins with the velocity of its path.
    let speed = (height(1e-3) - height(0.0)) / 1e-3;
    let kinetic = 0.5 * 0.05 * speed * speed;
    assert!(kinetic > 0.0);
    assert!((rows["plate_energy_J"][0] / kinetic - 1.0).abs() < 1e-9);
    assert!((last("plate_z_m") - 0.0975).abs() < 1e-9);
    assert!((last("plate_force_z_N") / (0.0025 * STIFFNESS) - 1.0).abs() < 1e-6);
    assert!(last("plate_residual") < 1e-9);
    let spring = 0.5 * STIFFNESS * 0.0025 * 0.0025;
    assert!((last("plate_energy_J") / spring - 1.0).abs() < 1e-6);
    // The path pushes with at most the last force.
    let hand = last("plate_hand_work_J");
    assert!(
        hand > 2.0 * spring && hand < 0.005 * 0.0025 * STIFFNESS,
        "{hand}"
    );
}

/// A step has substeps, each with its own contact force, and rows may be several steps apart.
#[test]
fn forces_of_rows_add_up_to_the_momentum_of_a_body_whose_steps_are_taken_again() {
    for rows in ["", "probes = { every = 0.01 }\n"] {
        let text = format!(
            "[mesh]\nblock = {{ cells = [3, 3, 3], size = [0.05, 0.05, 0.05], split = \"mirrored\" }}\n[[region]]\ndensity = 1060.0\n\
             model = \"neo-hookean\"\nyoungs_modulus = 4000.0\npoissons_ratio = 0.45\nelement = \"fbar-edge\"\n[[tool]]\nname = \"plate\"\n\
             shape = {{ plane = {{}} }}\nrotation = [{}, 0.0, 0.0]\nstart = [0.025, 0.025, 0.0505]\nvelocity = [0.0, 0.0, -0.5]\n\
             [[probe]]\nname = \"body\"\ngroup = \"tissue\"\nquantity = \"velocity\"\n\
             [run]\nduration = 0.2\nintegrator = \"central-difference\"\ndt = \"auto\"\nfree_flight = true\n[output]\n{rows}",
            std::f64::consts::PI
        );
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("out");
        let end = run(&path, &crate::common::build(&text), &mut ());
        assert!(end.retaken > 0, "steps are taken again");
        let (tools, probes) = (
            table(&path.join("tools.csv")),
            table(&path.join("probes.csv")),
        );
        let spans = tools["t_s"].windows(2).map(|t| t[1] - t[0]);
        let forces = spans.zip(&tools["plate_force_z_N"][1..]);
        let impulse: f64 = forces.map(|(span, force)| span * force).sum();
        let mass = 1060.0 * 0.05_f64.powi(3);
        let momentum = mass * probes["body_v_z_m_per_s"].last().unwrap();
        assert!(momentum < -0.1);
        assert!(
            (impulse / -momentum - 1.0).abs() < 1e-9,
            "{rows} {impulse} {momentum}"
        );
    }
}
