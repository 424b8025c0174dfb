//! The meshes of the repository agree with their table.

use std::collections::HashSet;
use std::fs;

use sinew_mesh::read_msh_file;

#[test]
fn the_table_of_meshes_is_true() {
    let dir = concat!(env!("CARGO_MANIFEST_DIR"), "/../../meshes");
    let Ok(readme) = fs::read_to_string(format!("{dir}/README.md")) else {
        // The crate on its own, outside its repository.
        return;
    };
    let mut listed = HashSet::new();
    for row in readme.lines().filter(|line| line.starts_with("| `")) {
        let columns: Vec<&str> = row.split('|').map(str::trim).collect();
        let name = columns[1].trim_matches('`');
        let path = format!("{dir}/{name}");
        let mesh = read_msh_file(&path).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(mesh.warnings, [], "{name}");
        let tissue = mesh
            .to_tet_mesh()
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(tissue.points.len().to_string(), columns[2], "{name}");
        assert_eq!(tissue.tets.len().to_string(), columns[3], "{name}");
        assert!(
            fs::metadata(&path).expect("it was read").len() < 1_000_000,
            "{name}"
        );

        let check = mesh.check();
        let angle = check.least_dihedral.expect("it has tetrahedra").value;
        let told: f64 = columns[4].parse().expect("an angle in two digits");
        assert!((angle - told).abs() <= 0.05 * told, "{name}: {angle}");
        let edges = check.edges.expect("it has tetrahedra");
        let (_, told) = columns[5].split_once(':').expect("a ratio");
        let told: f64 = told.trim().parse().expect("a number");
        assert!(
            (edges.longest / edges.shortest - told).abs() <= 0.01 * told,
            "{name}"
        );

        for group in columns[6].split(", ") {
            let group = tissue.group(group.trim_matches('`'));
            assert!(
                !group
                    .unwrap_or_else(|e| panic!("{name}: {e}"))
                    .members
                    .is_empty(),
                "{name}"
            );
        }
        assert_eq!(check.part_count, 1, "{name}");
        assert!(
            check.inverted.is_empty() && check.flat.is_empty(),
            "{name}: {check}"
        );
        assert!(
            check.orphans.is_empty() && check.duplicates.is_empty(),
            "{name}: {check}"
        );
        assert_eq!(check.non_manifold_faces, 0, "{name}");
        match name {
            "slivers.msh" => assert!(angle < 0.1 && check.slivers.total >= 16, "{check}"),
            "incision.msh" => {
                let mut places = HashSet::new();
                let mut is_new = |point: &[f64; 3]| places.insert(point.map(f64::to_bits));
                let doubled = tissue.points.iter().filter(|point| !is_new(point)).count();
                assert_eq!(doubled, 73, "coincident nodes stay apart");
            }
            "needle.msh" => assert!(edges.longest / edges.shortest > 50.0),
            _ => {}
        }
        listed.insert(name.to_owned());
    }
    for entry in fs::read_dir(dir).expect("it has a table") {
        let name = entry
            .expect("it can be listed")
            .file_name()
            .to_string_lossy()
            .into_owned();
        assert!(
            !name.ends_with(".msh") || listed.contains(&name),
            "{name} is not in the table"
        );
    }
}
