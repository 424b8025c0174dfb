//! Damaged files of every format: reading ends with a mesh or an error, never with a panic.

use std::sync::LazyLock;

use proptest::prelude::*;
use proptest::sample::Index;
use sinew_mesh::{MeshFormat, read_mesh};

use super::path;
use crate::common::damage::{apply, assert_consistent, damage};

static VALID: LazyLock<Vec<(MeshFormat, Vec<u8>)>> = LazyLock::new(|| {
    let folder = std::fs::read_dir(path("")).expect("the files are there");
    let mut paths: Vec<_> = folder
        .map(|entry| entry.expect("it is there").path())
        .collect();
    paths.sort();
    paths
        .iter()
        .map(|path| {
            let format = MeshFormat::of_path(path).expect("its name tells");
            (format, std::fs::read(path).expect("it is there"))
        })
        .collect()
});

fn assert_survives(bytes: &[u8], format: MeshFormat) {
    match read_mesh(bytes, format) {
        Err(error) => {
            assert!(error.position().byte <= bytes.len() as u64);
            assert!(!error.to_string().contains('\n'), "{error}");
        }
        Ok(mut mesh) => {
            assert_consistent(&mesh);
            let _ = sinew_mesh::info::MeshInfo::of(&mesh).to_json();
            let names: Vec<String> = mesh
                .cell_data
                .iter()
                .map(|data| data.name.clone())
                .collect();
            for name in names {
                let _ = mesh.groups_from_data(&name);
            }
            let _ = mesh.to_tet_mesh();
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_file_of_any_format_is_read_or_refused(
        file in any::<Index>(),
        damages in proptest::collection::vec(damage(), 1..5),
    ) {
        let (format, bytes) = &VALID[file.index(VALID.len())];
        let mut bytes = bytes.clone();
        for damage in &damages {
            apply(damage, &mut bytes);
        }
        assert_survives(&bytes, *format);
    }
}

#[test]
fn every_single_byte_of_any_format_may_be_wrong() {
    for (format, file) in VALID.iter() {
        for at in 0..file.len() {
            let mut bytes = file.clone();
            bytes[at] ^= 0xff;
            assert_survives(&bytes, *format);
        }
    }
}

#[test]
fn a_file_that_ends_early_is_read_or_refused() {
    for (format, file) in VALID.iter() {
        for length in 0..file.len() {
            assert_survives(&file[..length], *format);
        }
    }
}
