//! Damaged files: whatever happens to the bytes, reading ends with a mesh or an error, never with a panic.

#![cfg(test)]
#![allow(
    clippy::expect_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

mod common;

use common::{TWICE_22, TWO_REGIONS_41};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{Mesh, read_msh, write_msh41_ascii};

fn valid_files() -> Vec<Vec<u8>> {
    let mut written = Vec::new();
    let mesh = cube(1, 0.1, Split::Kuhn).expect("valid").to_mesh();
    write_msh41_ascii(&mesh, &mut written).expect("memory does not fail");
    vec![TWICE_22.into(), TWO_REGIONS_41.into(), written]
}

#[derive(Debug, Clone)]
enum Damage {
    Truncate(Index),
    FlipBits(Index, u8),
    Overwrite(Index, Vec<u8>),
    /// Copies a piece of the file over another place.
    Splice(Index, usize, Index),
    RemoveLine(Index),
    SwapLines(Index, Index),
    /// Replaces a number by a hostile one.
    Number(Index, &'static str),
}

const HOSTILE: [&str; 14] = [
    "0",
    "-1",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "1000000000000",
    "-2147483648",
    "1e308",
    "nan",
    "1D5",
    "$End",
    "",
];

fn damage() -> impl Strategy<Value = Damage> {
    let at = any::<Index>;
    prop_oneof![
        at().prop_map(Damage::Truncate),
        (at(), 1..=u8::MAX).prop_map(|(i, bits)| Damage::FlipBits(i, bits)),
        (at(), proptest::collection::vec(any::<u8>(), 1..20))
            .prop_map(|(i, b)| Damage::Overwrite(i, b)),
        (at(), 1..200usize, at()).prop_map(|(from, len, to)| Damage::Splice(from, len, to)),
        at().prop_map(Damage::RemoveLine),
        (at(), at()).prop_map(|(a, b)| Damage::SwapLines(a, b)),
        (at(), select(&HOSTILE[..])).prop_map(|(i, number)| Damage::Number(i, number)),
    ]
}

fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
    if bytes.is_empty() {
        return;
    }
    match damage {
        Damage::Truncate(at) => bytes.truncate(at.index(bytes.len())),
        Damage::FlipBits(at, bits) => {
            let at = at.index(bytes.len());
            bytes[at] ^= bits;
        }
        Damage::Overwrite(at, new) => {
            let at = at.index(bytes.len());
            let end = bytes.len().min(at + new.len());
            bytes.splice(at..end, new.iter().copied());
        }
        Damage::Splice(from, length, to) => {
            let from = from.index(bytes.len());
            let piece = bytes[from..bytes.len().min(from + length)].to_vec();
            let to = to.index(bytes.len());
            bytes.splice(to..to, piece);
        }
        Damage::RemoveLine(at) => {
            let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
            lines.remove(at.index(lines.len()));
            *bytes = lines.concat();
        }
        Damage::SwapLines(a, b) => {
            let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&byte| byte == b'\n').collect();
            let (a, b) = (a.index(lines.len()), b.index(lines.len()));
            lines.swap(a, b);
            *bytes = lines.concat();
        }
        Damage::Number(at, number) => {
            let words: Vec<&[u8]> = bytes.split_inclusive(u8::is_ascii_whitespace).collect();
            let chosen = at.index(words.len());
            let mut changed = Vec::new();
            for (i, word) in words.into_iter().enumerate() {
                let (text, blank) = word.split_at(word.len().saturating_sub(1));
                changed.extend_from_slice(if i == chosen { number.as_bytes() } else { text });
                changed.extend_from_slice(blank);
            }
            *bytes = changed;
        }
    }
}

/// What holds for every mesh that was read, however odd the file.
fn assert_consistent(mesh: &Mesh) {
    assert_eq!(mesh.node_tags.len(), mesh.points.len());
    assert!(mesh.points.iter().flatten().all(|x| x.is_finite()));
    assert!(mesh.node_entities.is_empty() || mesh.node_entities.len() == mesh.points.len());
    for block in &mesh.cells {
        assert_eq!(
            block.connectivity.len(),
            block.len() * block.kind.node_count()
        );
        assert_eq!(block.element_tags.len(), block.len());
        assert_eq!(block.physical.len(), block.len());
        assert_eq!(block.geometrical.len(), block.len());
        assert!(
            block
                .connectivity
                .iter()
                .all(|&node| (node as usize) < mesh.points.len())
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_file_is_read_or_refused(
        file in any::<Index>(),
        damages in proptest::collection::vec(damage(), 1..5),
    ) {
        let mut files = valid_files();
        let mut bytes = files.swap_remove(file.index(files.len()));
        for damage in &damages {
            apply(damage, &mut bytes);
        }
        match read_msh(&bytes) {
            Err(error) => {
                prop_assert!(error.position().byte <= bytes.len() as u64);
                prop_assert!(!error.to_string().contains('\n'));
            }
            Ok(mesh) => {
                assert_consistent(&mesh);
                if let Ok(tissue) = mesh.to_tet_mesh() {
                    prop_assert!(!tissue.edges().is_empty() || tissue.signed_volumes().iter().all(|&v| v == 0.0));
                    let mut rewritten = Vec::new();
                    prop_assert!(write_msh41_ascii(&mesh, &mut rewritten).is_ok());
                    let back = read_msh(&rewritten);
                    prop_assert!(back.is_ok(), "{:?}", back);
                }
            }
        }
    }
}

/// Every prefix is refused, except those that only lack the last end line or a part of the last line break.
#[test]
fn no_cut_file_passes_unnoticed() {
    for file in valid_files() {
        let whole = read_msh(&file).expect("valid");
        for length in 0..file.len() {
            let Ok(mesh) = read_msh(&file[..length]) else {
                continue;
            };
            let lost_cells = mesh.cells != whole.cells;
            let is_reported =
                mesh.warnings.len() > whole.warnings.len() || length + 1 == file.len();
            assert!(is_reported, "cut at {length} of {}", file.len());
            assert!(
                !lost_cells || mesh.cells.is_empty(),
                "cut at {length} of {}",
                file.len()
            );
        }
    }
}
