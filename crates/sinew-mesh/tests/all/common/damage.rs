//! Damaged files, and checks of any mesh read from them.

use proptest::prelude::*;
use proptest::sample::{Index, select};
use sinew_mesh::Mesh;

/// A change of a file's bytes.
#[derive(Debug, Clone)]
pub(crate) enum Damage {
    Truncate(Index),
    FlipBits(Index, u8),
    Overwrite(Index, Vec<u8>),
    /// Copies a piece of the file to another position.
    Splice(Index, usize, Index),
    RemoveLine(Index),
    SwapLines(Index, Index),
    /// Replaces a number by a hostile one.
    Number(Index, &'static str),
    /// Overwrites bytes by a hostile number of this many bytes.
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

pub(crate) fn damage() -> impl Strategy<Value = Damage> {
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

pub(crate) fn apply(damage: &Damage, bytes: &mut Vec<u8>) {
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

/// Checks the properties of every mesh that was read, for any file.
pub(crate) fn assert_consistent(mesh: &Mesh) {
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
        assert!(block.geometrical.is_empty() || block.geometrical.len() == block.len());
        assert!(
            block
                .connectivity
                .iter()
                .all(|&node| (node as usize) < mesh.points.len())
        );
    }
}
