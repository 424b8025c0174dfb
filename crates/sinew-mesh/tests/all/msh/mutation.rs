//! Damaged files: whatever happens to the bytes, reading ends with a mesh or an error, never with a panic.

use std::sync::LazyLock;

use crate::common::encode::{ALL, encoded};
use crate::common::{TWICE_22, TWO_REGIONS_41, full_mesh, read};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{Mesh, MshEncoding, MshVersion, read_msh, write_msh, write_msh41_ascii};

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
    /// Writes a hostile number of so many bytes over another.
    Bytes(Index, u64, usize),
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

const HOSTILE_BYTES: [u64; 9] = [
    0,
    1,
    u64::MAX,
    1 << 63,
    1 << 31,
    1 << 32,
    (1 << 31) - 1,
    1_000_000_000_000,
    0x7ff8_0000_0000_0000,
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
        (at(), select(&HOSTILE_BYTES[..]), select(&[4usize, 8][..]))
            .prop_map(|(i, number, width)| Damage::Bytes(i, number, width)),
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
        Damage::Bytes(at, number, width) => {
            let at = at.index(bytes.len());
            let end = bytes.len().min(at + width);
            bytes.splice(at..end, number.to_le_bytes()[..end - at].iter().copied());
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

/// Checks what holds for every mesh that was read, however odd the file.
fn assert_consistent(mesh: &Mesh) {
    assert_eq!(mesh.node_tags.len(), mesh.points.len());
    assert!(mesh.points.iter().flatten().all(|x| x.is_finite()));
    let points = mesh.points.len();
    for data in &mesh.point_data {
        assert_eq!(data.values.len(), points * data.components);
    }
    for data in &mesh.cell_data {
        for (values, block) in data.blocks.iter().zip(&mesh.cells) {
            assert_eq!(values.len(), block.len() * data.components);
        }
        assert_eq!(data.blocks.len(), mesh.cells.len());
    }
    for data in &mesh.cell_node_data {
        for (values, block) in data.blocks.iter().zip(&mesh.cells) {
            assert_eq!(values.len(), block.connectivity.len() * data.components);
        }
        assert_eq!(data.blocks.len(), mesh.cells.len());
    }
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

/// Checks what the reader promises for any bytes.
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

/// Every prefix is refused or warned about, except those that lack nothing but optional sections, or a part of the last
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
