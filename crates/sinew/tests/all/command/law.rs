//! `sinew law`: curves of the laws of a scene's regions.

use std::fs;
use std::path::Path;

use crate::common::{Said, sinew};

const SCENE: &str = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ngroup = \"tissue\"\ndensity = 1000.0\n\
                     model = \"stvk\"\nyoungs_modulus = 2000.0\npoissons_ratio = 0.0\n[[region]]\ngroup = \"other\"\n\
                     density = 1000.0\nmodel = \"neo-hookean\"\nyoungs_modulus = 3500.0\npoissons_ratio = 0.45\n\
                     fibres = { direction = [0.0, 0.0, 1.0], eta = 2000.0 }\nprony = [[0.3, 0.05]]\nmoduli = \"longterm\"\n\
                     [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n";

const SPRINGS: &str = "[mesh]\ncube = { cells = 2, edge = 0.1 }\n[[region]]\ndensity = 1000.0\nmodel = \"springs\"\n\
                       youngs_modulus = 2000.0\nsprings = { rule = \"lloyd\" }\n[run]\nduration = 1.0\n\
                       integrator = \"newmark\"\ndt = 0.01\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    folder
}

fn law(folder: &Path, arguments: &[&str]) -> Said {
    sinew(folder, &[&["law", "a.toml"], arguments].concat())
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn curves_are_told_in_words() {
    let folder = folder();
    let said = law(
        folder.path(),
        &["--region", "tissue", "--stretch", "0.5", "1.5"],
    );
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    assert_eq!(
        said.out,
        "region 1, `tissue`: stvk, E = 2000 Pa, nu = 0 at small strain\n  \
         at rest: E = 2000 Pa, nu = 0, mu = 1000 Pa, kappa = 666.7 Pa\n  \
         uniaxial: stable from 0.7071 to 1.5; not stable below 0.7071; the nominal stress falls below 0.5774\n  \
         equibiaxial: stable from 0.7071 to 1.5; not stable below 0.7071; the nominal stress falls below 0.5774\n  \
         planar: stable from 0.7071 to 1.5; not stable below 0.7071; the nominal stress falls below 0.5774\n  \
         simple shear: stable from -0.5 to 0.5; the whole curve\n"
    );
    let said = law(folder.path(), &["--region", "2", "--along", "0,0,2"]);
    for line in [
        "at rest, without fibres: E = 3500 Pa, nu = 0.45, mu = 1207 Pa, kappa = 11670 Pa",
        "fibres along [0, 0, 1], eta = 2000 Pa",
        "pulled along [0, 0, 1]; the second axis of sheets and shears is [1, 0, 0]",
        "the long-term curve, when all has relaxed: of the stress 0.3 in 0.05 s relax",
    ] {
        assert!(said.out.contains(line), "{}", said.out);
    }
}

/// The last state of a load in a table, by the names of its columns.
fn last(table: &str, region: &str, load: &str) -> (f64, f64) {
    let begin = format!("{region},{load},");
    let row = table
        .lines()
        .rfind(|line| line.starts_with(&begin))
        .unwrap();
    let columns: Vec<&str> = row.split(',').collect();
    (columns[2].parse().unwrap(), columns[3].parse().unwrap())
}

#[test]
fn a_folder_has_a_table_of_all_and_a_picture_of_each() {
    let folder = folder();
    for _ in 0..2 {
        // The second time they are replaced.
        let said = law(folder.path(), &["--out", "curves", "--along", "0,0,1"]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(
            said.out
                .ends_with("curves: curves.csv, region-1.svg, region-2.svg\n")
        );
    }
    let table = fs::read_to_string(folder.path().join("curves/curves.csv")).unwrap();
    assert!(table.contains(
        "\nregion,load,stretch_or_shear_1,nominal_stress_Pa,nominal_stress_across_Pa,cauchy_stress_Pa,volume_ratio_1,stable\n"
    ));
    // E/2 (l^3 - l), and fibres along the pull: 2 eta (l^2 - 1) l.
    let (stretch, stress) = last(&table, "1", "uniaxial");
    assert!(stretch == 2.0 && (stress - 6000.0).abs() < 1e-6, "{stress}");
    let along = last(&table, "2", "uniaxial").1;
    let said = law(folder.path(), &["--out", "curves"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let table = fs::read_to_string(folder.path().join("curves/curves.csv")).unwrap();
    let across = last(&table, "2", "uniaxial").1;
    assert!((along - across - 24_000.0).abs() < 1e-6, "{along} {across}");
    let svg = fs::read_to_string(folder.path().join("curves/region-2.svg")).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("Simple shear"));

    fs::create_dir(folder.path().join("mine")).unwrap();
    fs::write(folder.path().join("mine/text"), "mine").unwrap();
    let said = law(folder.path(), &["--out", "mine"]);
    assert_eq!(said.code, Some(2), "{}", said.err);
    assert_eq!(names(&folder.path().join("mine")), ["text"]);
}

#[test]
fn a_table_has_its_picture_beside_it_and_spares_what_is_not_its_own() {
    let folder = folder();
    let path = folder.path();
    let one = ["--region", "1", "--out", "one.csv"];
    assert_eq!(law(path, &one).code, Some(0));
    assert_eq!(law(path, &["--out", "all.csv"]).code, Some(0));
    let written = [
        "a.toml",
        "all-region-1.svg",
        "all-region-2.svg",
        "all.csv",
        "one.csv",
        "one.svg",
    ];
    assert_eq!(names(path), written);
    // Own files are replaced, others are not, and nothing is half written.
    let stiffer = [&one[..], &["--set", "region.1.youngs_modulus=3e3"]].concat();
    assert_eq!(law(path, &stiffer).code, Some(0));
    let before = fs::read(path.join("one.csv")).unwrap();
    fs::write(path.join("one.svg"), "mine").unwrap();
    let said = law(path, &one);
    assert_eq!(said.code, Some(2));
    assert!(
        said.err
            .contains("one.svg exists and has other content; it was not changed"),
        "{}",
        said.err
    );
    assert_eq!(fs::read(path.join("one.csv")).unwrap(), before);
    assert_eq!(fs::read(path.join("one.svg")).unwrap(), b"mine");
    assert_eq!(law(path, &[&one[..], &["--force"]].concat()).code, Some(0));
    assert_ne!(fs::read(path.join("one.csv")).unwrap(), before);
    // To standard output goes the table alone.
    let said = law(path, &["--out", "-"]);
    assert!(said.out.starts_with("# region 1, `tissue`: stvk") && said.out.ends_with(",1\n"));
    assert!(said.err.contains("uniaxial: stable from"), "{}", said.err);
    assert_eq!(names(path), written);
}

/// A tetrahedron with a direction by data under each name.
fn tetrahedron(data: &[(&str, [f64; 3])]) -> String {
    let mut mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.1 0 0\n3 0 0.1 0\n4 0 0 0.1\n$EndNodes\n\
                    $Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n"
        .to_owned();
    for (name, [x, y, z]) in data {
        mesh.push_str(&format!(
            "$ElementData\n1\n\"{name}\"\n1\n0\n3\n0\n3\n1\n1 {x} {y} {z}\n$EndElementData\n"
        ));
    }
    mesh
}

/// The curves of a material whose axes are data of its mesh are those along its axes, however these lie in the mesh.
#[test]
fn axes_by_data_are_those_of_the_pull() {
    let folder = folder();
    let path = folder.path();
    let scene = "[mesh]\nfile = \"a.msh\"\n[[region]]\ndensity = 1000.0\nmodel = \"fung\"\nc = 1000.0\n\
                 b = [3.0, 2.0, 1.5, 0.2, 0.1, 0.1, 1.5, 1.0, 1.2]\nbulk_modulus = 1e5\n\
                 axes = [{ data = \"first\" }, { data = \"second\" }]\n\
                 [run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n";
    fs::write(path.join("a.toml"), scene).unwrap();
    let stresses = |first: [f64; 3], second: [f64; 3]| {
        let mesh = tetrahedron(&[("first", first), ("second", second)]);
        fs::write(path.join("a.msh"), mesh).unwrap();
        let said = law(path, &["--out", "c.csv", "--force"]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        let table = fs::read_to_string(path.join("c.csv")).unwrap();
        ["uniaxial", "equibiaxial", "planar"].map(|load| last(&table, "1", load).1)
    };
    let straight = stresses([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    for (first, second) in [
        ([1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
        ([1.0, 2.0, 2.0], [2.0, 1.0, -2.0]),
    ] {
        for (found, expected) in stresses(first, second).into_iter().zip(straight) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        }
    }
    // Across is another of its axes than the second.
    let said = law(path, &["--along", "1,0,0", "--across", "0,0,1"]);
    assert!(
        said.out
            .contains("the second axis of sheets and shears is [0, 0, 1]"),
        "{}",
        said.out
    );
}

#[test]
fn measured_points_are_compared_with_the_curve() {
    let folder = folder();
    let rows = "load,stretch,stress_Pa\nuniaxial,1.2,528\nuniaxial,1.4,1354\n";
    fs::write(folder.path().join("m.csv"), rows).unwrap();
    let measured = ["--region", "1", "--measured", "m.csv", "--out", "c.csv"];
    let said = law(folder.path(), &measured);
    assert_eq!(said.code, Some(0), "{}", said.err);
    // E/2 (l^3 - l) is 528 and 1344.
    assert!(
        said.out
            .contains("measured, uniaxial: 2 points, root mean square difference 7.0"),
        "{}",
        said.out
    );
    // The range is that of the points.
    assert!(
        said.out.contains("uniaxial: stable from 0.96 to 1.44"),
        "{}",
        said.out
    );
    let svg = fs::read_to_string(folder.path().join("c.svg")).unwrap();
    assert!(svg.contains("measured, uniaxial 1.4: 1354 Pa"));
    let said = law(
        folder.path(),
        &[&measured[..4], &["--stretch", "0.9", "1.3"]].concat(),
    );
    assert!(
        said.out.contains("1 point,") && said.out.contains("; 1 beyond the curve"),
        "{}",
        said.out
    );
}

#[test]
fn what_cannot_be_shown_is_refused_in_one_line_and_leaves_nothing() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("springs.toml"), SPRINGS).unwrap();
    fs::write(
        path.join("bad.csv"),
        "load,stretch,stress_Pa\nuniaxial,1.1,300\nuniaxial,-1.2,5\n",
    )
    .unwrap();
    fs::write(
        path.join("kilo.csv"),
        "load,stretch,stress_kPa\nuniaxial,1.1,3\n",
    )
    .unwrap();
    let spring = "[oscillator]\nmass = 0.1\nstiffness = 100.0\ndamping = 0.0\nvelocity = 1.0\n[run]\nduration = 1.0\nintegrator = \"newmark\"\ndt = 0.01\n";
    fs::write(path.join("spring.toml"), spring).unwrap();
    let before = names(path);
    for (arguments, said_first) in [
        (
            &["springs.toml"][..],
            "springs.toml:5: [[region]] 1: springs have no law at a point",
        ),
        (&["spring.toml"], "spring.toml: an oscillator has no law"),
        (
            &["a.toml", "--region", "liver"],
            "a.toml: no region is `liver`; there are 1 (`tissue`), 2 (`other`)",
        ),
        (&["a.toml", "--region", "3"], "a.toml: no region is `3`"),
        (
            &["a.toml", "--along", "0,0,0"],
            "the axes of the pull: expected an axis",
        ),
        (
            &["a.toml", "--across", "-2,0,0"],
            "the axes of the pull: expected a second axis [x, y, z] that is not along the first",
        ),
        (
            &["a.toml", "--across", "1"],
            "--across: expected three numbers",
        ),
        (
            &["a.toml", "--along", "0,1"],
            "--along: expected three numbers",
        ),
        (
            &["a.toml", "--stretch", "1.2", "0.8"],
            "--stretch: expected a stretch and a larger one, such as 0.8 1.5, found [1.2, 0.8]",
        ),
        (
            &["a.toml", "--measured", "bad.csv"],
            "bad.csv:3: stretch is \"-1.2\": expected a finite stretch above 0",
        ),
        (
            &["a.toml", "--measured", "kilo.csv"],
            "kilo.csv:1: the first line is \"load,stretch,stress_kPa\": expected the names",
        ),
        (
            &["a.toml", "--measured", "none.csv"],
            "none.csv: cannot be read",
        ),
        (
            &["a.toml", "--set", "region.1.youngs_modulus=-1"],
            "a.toml:7: [[region]] 1: youngs_modulus = -1: expected",
        ),
    ] {
        let said = sinew(path, &[&["law"], arguments, &["--out", "out"]].concat());
        assert_eq!(
            (said.code, said.out.as_str()),
            (Some(2), ""),
            "{arguments:?}"
        );
        let expected = format!("error: {said_first}");
        assert!(
            said.err.starts_with(&expected),
            "{arguments:?}: {}",
            said.err
        );
        assert_eq!(names(path), before, "{arguments:?}");
    }
    let said = sinew(path, &["law", "a.toml", "--stretch", "0", "2"]);
    assert!(
        said.err.contains("expected a finite stretch above 0"),
        "{}",
        said.err
    );
    let said = sinew(
        path,
        &["law", "a.toml", "--measured", "bad.csv", "--out", "bad.csv"],
    );
    assert!(said.code == Some(2), "{}", said.err);
}
