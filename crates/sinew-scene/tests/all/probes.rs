//! Records of probes: displacements, velocities and stresses, at points, on lines and over groups.

use std::collections::BTreeMap;

use sinew_mesh::GroupMembers;
use sinew_scene::output::{Delivery, Destination};
use sinew_scene::{ProbeCsv, ProbeRows, Scene, SceneSource};

/// A bar of nu = 0 that is fixed at its bottom and pulled at its top by 30 Pa, at rest: the stress is the pull
/// everywhere, and the displacement `30/E z`.
const PULLED: &str = "[mesh]\nblock = { cells = [2, 2, 6], size = [0.02, 0.02, 0.06] }\n[[region]]\ndensity = 1000.0\n\
                      model = \"linear\"\nyoungs_modulus = 3000.0\npoissons_ratio = 0.0\n[[fixed]]\ngroup = \"bottom\"\n\
                      [[load]]\nname = \"pull\"\ngroup = \"top\"\ntraction = [0.0, 0.0, 30.0]\n[run]\nduration = 0.02\n";

/// Columns of the table of probes that a run writes.
fn run(text: &str) -> BTreeMap<String, Vec<f64>> {
    let scene = Scene::parse(SceneSource::new("scene.toml", text)).unwrap();
    let simulation = scene.build().unwrap();
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("probes.csv");
    let output = Destination::new(&path, &[]).unwrap().open().unwrap();
    let mut csv = ProbeCsv::new(
        output,
        ProbeRows::new(simulation.body()),
        sinew_scene::Schedule::at_most(usize::MAX, simulation.run().steps),
    )
    .unwrap();
    let mut method = simulation.integrator().unwrap();
    let mut state = simulation.initial_state().clone();
    let settings = simulation.run();
    sinew_core::simulate(
        simulation.system(),
        &mut *method,
        &mut state,
        &settings,
        &mut csv,
    )
    .unwrap();
    assert_eq!(csv.finish().unwrap(), Delivery::Whole);
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned);
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|value| value.parse().unwrap())
                .collect()
        })
        .collect();
    names
        .enumerate()
        .map(|(column, name)| (name, rows.iter().map(|row| row[column]).collect()))
        .collect()
}

fn refused(more: &str) -> String {
    let text = format!(
        "{PULLED}integrator = \"central-difference\"\ndt = 0.0005\n[[probe]]\nname = \"p\"\n{more}"
    );
    let scene = Scene::parse(SceneSource::new("scene.toml", text));
    scene.and_then(Scene::build).unwrap_err().to_string()
}

#[cfg(feature = "implicit")]
#[test]
fn means_and_stresses_of_a_pulled_bar_are_those_of_statics() {
    let columns = run(&format!(
        "{PULLED}integrator = \"newmark\"\ndt = 0.001\n[[initial]]\nstatic = [\"pull\"]\n\
         [[probe]]\nname = \"all\"\ngroup = \"tissue\"\n[[probe]]\nname = \"sides\"\ngroup = \"sides\"\n\
         [[probe]]\nname = \"end\"\ngroup = \"top\"\n\
         [[probe]]\nname = \"tension\"\npoint = [0.011, 0.004, 0.033]\nquantity = \"stress\"\n\
         [[probe]]\nname = \"around\"\nwhere = {{ nodes = [1] }}\nquantity = \"stress\"\n\
         [[probe]]\nname = \"skin\"\ngroup = \"sides\"\nquantity = \"stress\"\n\
         [[probe]]\nname = \"line\"\npoint = [0.0, 0.0, 0.0]\nto = [0.0, 0.0, 0.06]\ncount = 4\n"
    ));
    let last = |name: &str| *columns[name].last().unwrap();
    let stretch = 30.0 / 3000.0;
    for (name, expected) in [
        ("all_u_z_m", stretch * 0.03),
        ("sides_u_z_m", stretch * 0.03),
        ("end_u_z_m", stretch * 0.06),
        ("tension_s_zz_Pa", 30.0),
        ("tension_s_von_mises_Pa", 30.0),
        ("around_s_zz_Pa", 30.0),
        ("skin_s_zz_Pa", 30.0),
        ("line-1_u_z_m", 0.0),
        ("line-2_u_z_m", stretch * 0.02),
        ("line-4_u_z_m", stretch * 0.06),
    ] {
        let found = last(name);
        assert!(
            (found - expected).abs() < 1e-8 * (1.0 + expected.abs()),
            "{name}: {found} {expected}"
        );
    }
    assert!(last("skin_s_xx_Pa").abs() < 1e-7);
    assert!(columns["all_u_x_m"].iter().all(|u| u.abs() < 1e-12));
}

/// Central differences: the velocity at an instant is that between its neighbours (Newmark 1959; Hughes, The Finite
/// Element Method, section 9.1), at free nodes; at moved parts it is the rate of the course.
#[test]
fn velocities_are_those_between_the_instants_before_and_after() {
    let dt = 0.0005;
    let columns = run(&format!(
        "{PULLED}integrator = \"central-difference\"\ndt = {dt}\n[[move]]\nwhere = {{ below = {{ z = 0.001 }} }}\n\
         velocity = [0.003, 0.0, 0.0]\n\
         [[probe]]\nname = \"v\"\npoint = [0.01, 0.01, 0.06]\nquantity = \"velocity\"\n\
         [[probe]]\nname = \"u\"\npoint = [0.01, 0.01, 0.06]\n\
         [[probe]]\nname = \"mean\"\ngroup = \"top\"\nquantity = \"velocity\"\n\
         [[probe]]\nname = \"of\"\ngroup = \"top\"\n\
         [[probe]]\nname = \"moved\"\ngroup = \"bottom\"\nquantity = \"velocity\"\n"
    ).replace("[[fixed]]\ngroup = \"bottom\"\n", ""));
    let largest = columns["v_v_z_m_per_s"]
        .iter()
        .fold(0.0_f64, |most, v| most.max(v.abs()));
    assert!(largest > 1e-3);
    for (u, v) in [
        ("u_u_z_m", "v_v_z_m_per_s"),
        ("of_u_z_m", "mean_v_z_m_per_s"),
    ] {
        for (row, ends) in columns[u].windows(3).enumerate() {
            let expected = (ends[2] - ends[0]) / (2.0 * dt);
            let found = columns[v][row + 1];
            assert!(
                (found - expected).abs() < 1e-9 * largest,
                "{v} {row}: {found} {expected}"
            );
        }
    }
    assert!(
        columns["moved_v_x_m_per_s"]
            .iter()
            .all(|v| (v - 0.003).abs() < 1e-15)
    );
}

#[test]
fn places_that_contradict_each_other_are_refused() {
    for (more, expected) in [
        (
            "point = [0.0, 0.0, 0.0]\ngroup = \"top\"\n",
            "`point` does not go with `group`",
        ),
        (
            "point = [0.0, 0.0, 0.0]\nto = [0.0, 0.0, 0.1]\n",
            "`to` needs `count`",
        ),
        ("point = [0.0, 0.0, 0.0]\ncount = 3\n", "`count` needs `to`"),
        ("group = \"tip\"\n", "tip"),
        (
            "point = [0.0, 0.0, 0.0]\nquantity = \"speed\"\n",
            "\"displacement\", \"velocity\" or \"stress\"",
        ),
    ] {
        let said = refused(more);
        assert!(said.contains(expected), "{said}");
    }
    let springs = PULLED
        .replace("\"linear\"", "\"springs\"\nsprings = { rule = \"lloyd\" }")
        .replace("poissons_ratio = 0.0\n", "");
    let text = format!(
        "{springs}integrator = \"central-difference\"\ndt = 0.0005\n[[probe]]\nname = \"p\"\ngroup = \"top\"\nquantity = \"stress\"\n"
    );
    let scene = Scene::parse(SceneSource::new("scene.toml", text));
    let said = scene.and_then(Scene::build).unwrap_err().to_string();
    assert!(
        said.contains("not known in [[region]] 1, which is made of springs"),
        "{said}"
    );
}

/// Nodes that are chosen by position are a group of nodes: the probe is their mean with equal weights.
#[cfg(feature = "implicit")]
#[test]
fn a_probe_of_several_nodes_is_their_mean() {
    let columns = run(&format!(
        "{PULLED}integrator = \"newmark\"\ndt = 0.001\n[[initial]]\nstatic = [\"pull\"]\n\
         [[probe]]\nname = \"two\"\nwhere = {{ nodes = [1, 63] }}\n\
         [[probe]]\nname = \"one\"\nwhere = {{ nodes = [63] }}\n\
         [[probe]]\nname = \"other\"\nwhere = {{ nodes = [1] }}\n\
         [[probe]]\nname = \"upper\"\nwhere = {{ above = {{ z = 0.05 }} }}\n\
         [[probe]]\nname = \"core\"\nwhere = {{ cylinder = {{ axis_from = [0.01, 0.01, 0.0], axis_to = [0.01, 0.01, 0.04], radius = 0.001 }} }}\n\
         [[probe]]\nname = \"rate\"\nwhere = {{ above = {{ z = 0.05 }} }}\nquantity = \"velocity\"\n\
         [[probe]]\nname = \"tension\"\nwhere = {{ above = {{ z = 0.05 }} }}\nquantity = \"stress\"\n"
    ));
    let last = |name: &str| *columns[name].last().unwrap();
    let stretch = 30.0 / 3000.0;
    let mean = 0.5 * (last("one_u_z_m") + last("other_u_z_m"));
    assert!((last("two_u_z_m") - mean).abs() < 1e-15 && mean > 1e-4);
    for (name, expected) in [
        // The planes z = .05 and z = .06 have as many nodes.
        ("upper_u_z_m", stretch * 0.055),
        ("core_u_z_m", stretch * 0.02),
        ("tension_s_zz_Pa", 30.0),
        ("rate_v_z_m_per_s", 0.0),
    ] {
        let found = last(name);
        assert!(
            (found - expected).abs() < 1e-8 * (1.0 + expected.abs()),
            "{name}: {found} {expected}"
        );
    }
}

/// In a linear field the mean is the field at the centroid: of areas for triangles, of volumes for tetrahedra, whose
/// sizes differ much in a mesh of an organ.
#[test]
fn means_of_a_linear_field_are_its_values_at_the_centroid() {
    let text = "[mesh]\nfile = \"../../meshes/organ.msh\"\n[[region]]\ndensity = 1000.0\nmodel = \"linear\"\n\
                youngs_modulus = 3000.0\npoissons_ratio = 0.3\n[[initial]]\nstretch = [0.01, -0.02, 0.03]\n\
                [[probe]]\nname = \"skin\"\ngroup = \"attachment\"\n[[probe]]\nname = \"inner\"\ngroup = \"inclusion\"\n\
                [run]\nduration = 1e-5\nintegrator = \"central-difference\"\ndt = 1e-5\n";
    let scene = Scene::parse(SceneSource::new("scene.toml", text)).unwrap();
    let simulation = scene.build().unwrap();
    let mesh = &simulation.model().body().unwrap().mesh;
    let centroid = |parts: Vec<(f64, Vec<u32>)>| -> [f64; 3] {
        let whole: f64 = parts.iter().map(|(size, _)| size).sum();
        let along = |axis: usize| -> f64 {
            let moments = parts.iter().map(|(size, nodes)| {
                let sum: f64 = nodes
                    .iter()
                    .map(|node| mesh.points[*node as usize][axis])
                    .sum();
                size * sum / nodes.len() as f64
            });
            moments.sum::<f64>() / whole
        };
        [along(0), along(1), along(2)]
    };
    let parts = |name: &str| match &mesh.group(name).unwrap().members {
        GroupMembers::Triangles(triangles) => {
            let parts = triangles.iter();
            parts
                .map(|nodes| (mesh.area(*nodes), nodes.to_vec()))
                .collect()
        }
        GroupMembers::Tets(tets) => {
            let parts = tets.iter().map(|tet| *tet as usize);
            parts
                .map(|tet| (mesh.volume(tet), mesh.tets[tet].to_vec()))
                .collect()
        }
        GroupMembers::Lines(_) | GroupMembers::Nodes(_) => Vec::new(),
    };
    let u = &simulation.initial_state().u;
    for (probe, group) in simulation.probes().iter().zip(["attachment", "inclusion"]) {
        let expected = centroid(parts(group));
        let strains = [0.01, -0.02, 0.03];
        for ((u, x), strain) in probe.displacement(0.0, u).zip(expected).zip(strains) {
            assert!(
                (u - strain * x).abs() < 1e-15,
                "{group}: {u} {}",
                strain * x
            );
        }
    }
}
