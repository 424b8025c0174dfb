//! Damaged files: for any change of the bytes, reading ends with a mesh or an error, never with a panic.

use std::sync::LazyLock;

use crate::common::damage::{apply, assert_consistent, damage};
use crate::common::encode::{ALL, encoded};
use crate::common::{TWICE_22, TWO_REGIONS_41, full_mesh, read};
use proptest::prelude::*;
use proptest::sample::Index;
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{MshEncoding, MshVersion, read_msh, write_msh, write_msh41_ascii};

/// Files of every version and encoding, with every section.
static VALID: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    let mut files: Vec<Vec<u8>> = vec![TWICE_22.into(), TWO_REGIONS_41.into(), PARTITIONED.into()];
    let two_regions = read(TWO_REGIONS_41);
    files.extend(ALL.map(|layout| encoded(&two_regions, layout)));
    let full_mesh = full_mesh();
    let small_cube = cube(1, 0.1, Split::Kuhn).expect("valid").to_mesh();
    for version in [MshVersion::V22, MshVersion::V41] {
        for encoding in [MshEncoding::Text, MshEncoding::Binary] {
            for mesh in [&small_cube, &full_mesh] {
                let mut written = Vec::new();
                write_msh(mesh, version, encoding, &mut written).expect("memory does not fail");
                files.push(written);
            }
        }
    }
    files
});

const PARTITIONED: &str = "\
$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 3 0\n$EndEntities
$PartitionedEntities\n2\n1\n9 1\n0 0 0 2\n2 3 1 1 1 0 0 0 1 1 1 1 3 0\n3 3 1 2 1 2 0 0 0 1 1 1 1 3 0\n$EndPartitionedEntities
$Nodes\n1 5 1 5\n3 2 1 5\n1\n2\n3\n4\n5\n0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n0 0 1 0 0 0\n1 1 1 0 0 0\n$EndNodes
$Elements\n2 2 1 2\n3 2 4 1\n1 1 2 3 4\n3 3 4 1\n2 2 3 4 5\n$EndElements
$GhostElements\n1\n2 1 1 2\n$EndGhostElements
";

fn valid_files() -> &'static [Vec<u8>] {
    &VALID
}

/// Checks the guarantees of the reader for any bytes.
fn assert_survives(bytes: &[u8]) {
    let mesh = match read_msh(bytes) {
        Err(error) => {
            assert!(error.position().byte <= bytes.len() as u64);
            assert!(!error.to_string().contains('\n'), "{error}");
            return;
        }
        Ok(mesh) => mesh,
    };
    assert_consistent(&mesh);
    let check = mesh.check();
    assert!(check.to_string().ends_with('\n'));
    let _ = sinew_mesh::info::MeshInfo::of(&mesh).to_json();
    let mut fixed = mesh.clone();
    fixed.orient();
    fixed.merge_duplicates();
    fixed.drop_orphans();
    assert_consistent(&fixed);
    let again = fixed.check();
    assert!(again.duplicates.is_empty() && again.orphans.is_empty());
    if let Ok(tissue) = mesh.to_tet_mesh() {
        assert!(!tissue.edges().is_empty() || tissue.signed_volumes().iter().all(|&v| v == 0.0));
        let mut rewritten = Vec::new();
        let mut without_data = mesh.clone();
        without_data.point_data.clear();
        without_data.cell_data.clear();
        without_data.cell_node_data.clear();
        write_msh41_ascii(&without_data, &mut rewritten).unwrap_or_else(|error| panic!("{error}"));
        let back = read_msh(&rewritten);
        assert!(back.is_ok(), "{back:?}");
        for version in [MshVersion::V22, MshVersion::V41] {
            let mut rewritten = Vec::new();
            // Damaged names and tags may not be writable.
            if write_msh(&mesh, version, MshEncoding::Binary, &mut rewritten).is_ok() {
                let back = read_msh(&rewritten);
                assert!(back.is_ok(), "{back:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_file_is_read_or_refused(
        file in any::<Index>(),
        damages in proptest::collection::vec(damage(), 1..5),
    ) {
        let files = valid_files();
        let mut bytes = files[file.index(files.len())].clone();
        for damage in &damages {
            apply(damage, &mut bytes);
        }
        assert_survives(&bytes);
    }
}

/// Every byte of every file, one at a time, replaced by its opposite.
#[test]
fn every_single_byte_may_be_wrong() {
    for file in valid_files() {
        for at in 0..file.len() {
            let mut bytes = file.clone();
            bytes[at] ^= 0xff;
            let _ = read_msh(&bytes).map(|mesh| assert_consistent(&mesh));
        }
    }
}

/// Every prefix is refused or gives a warning, except those that lack only optional sections, or a part of the last
/// line break.
#[test]
fn no_cut_file_passes_unnoticed() {
    for file in valid_files() {
        let whole = read_msh(file).expect("valid");
        for length in 0..file.len() {
            let Ok(mesh) = read_msh(&file[..length]) else {
                continue;
            };
            // From here on only whole, optional sections are missing.
            let at_line_end = file[length..].starts_with(b"\n") || file[..length].ends_with(b"\n");
            let lines = file[..length].trim_ascii_end();
            let last_line = lines
                .rsplit(|&byte| byte == b'\n')
                .next()
                .unwrap_or_default();
            if at_line_end && last_line.starts_with(b"$End") && mesh.cells == whole.cells {
                continue;
            }
            let is_reported = mesh.warnings.iter().any(|w| {
                [
                    "the file ends without",
                    "no $Elements section",
                    "no $ELM section",
                ]
                .iter()
                .any(|part| w.message.contains(part))
            });
            assert!(
                is_reported || length + 1 == file.len(),
                "cut at {length} of {}",
                file.len()
            );
            let lost_cells = mesh.cells != whole.cells;
            assert!(
                !lost_cells || mesh.cells.is_empty(),
                "cut at {length} of {}",
                file.len()
            );
        }
    }
}
