//! Memory is bounded by the size of a file, not by the counts that it claims.

use crate::common::encode::{ALL, encoded};
use crate::common::{TWICE_22, TWO_REGIONS_41, read};
use sinew_core::CountingAllocator;
use sinew_mesh::structured::{Split, cube};
use sinew_mesh::{MshEncoding, MshVersion, read_msh, write_msh};

/// The largest number of bytes in use while a file is read.
fn peak(bytes: &[u8]) -> usize {
    CountingAllocator::peak(|| drop(read_msh(bytes))).1
}

/// Allowance of small files for messages and first allocations.
const START: usize = 32 << 10;

#[test]
fn huge_counts_take_no_memory() {
    let hostile = [
        "999999999",
        "4294967295",
        "1000000000000",
        "18446744073709551615",
        "9223372036854775807",
    ];
    for file in [TWICE_22, TWO_REGIONS_41] {
        let words: Vec<&str> = file.split_inclusive(char::is_whitespace).collect();
        for at in 0..words.len() {
            for number in hostile {
                let mut changed: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
                let blank = &words[at][words[at].len() - 1..];
                changed[at] = format!("{number}{blank}");
                let changed = changed.concat();
                let peak = peak(changed.as_bytes());
                assert!(
                    peak <= START + 16 * changed.len(),
                    "{peak} bytes for\n{changed}"
                );
            }
        }
    }
}

#[test]
fn huge_counts_in_binary_files_take_no_memory() {
    let mesh = read(TWO_REGIONS_41);
    for layout in ALL {
        let file = encoded(&mesh, layout);
        for at in 0..file.len() - 8 {
            for number in [
                u64::MAX,
                1 << 40,
                0x7fff_ffff,
                0x7fff_ffff << 32,
                u64::MAX >> 1,
            ] {
                for width in [4, 8] {
                    let mut changed = file.clone();
                    changed[at..at + width].copy_from_slice(&number.to_le_bytes()[..width]);
                    let peak = peak(&changed);
                    assert!(
                        peak <= START + 16 * changed.len(),
                        "{layout:?}, byte {at}: {peak} bytes"
                    );
                }
            }
        }
    }
}

#[test]
fn a_mesh_takes_little_more_than_its_arrays() {
    let mesh = cube(12, 0.1, Split::Kuhn).expect("valid").to_mesh();
    let arrays: usize = mesh
        .cells
        .iter()
        .map(|block| 4 * block.connectivity.len() + 16 * block.len())
        .sum::<usize>()
        + 40 * mesh.points.len();
    for (version, encoding, most) in [
        (MshVersion::V41, MshEncoding::Binary, 1.5),
        (MshVersion::V41, MshEncoding::Text, 1.5),
        (MshVersion::V22, MshEncoding::Binary, 2.5),
        (MshVersion::V22, MshEncoding::Text, 2.5),
    ] {
        let mut file = Vec::new();
        write_msh(&mesh, version, encoding, &mut file).expect("it can be written");
        let ratio = peak(&file) as f64 / arrays as f64;
        assert!(
            ratio < most,
            "{version:?} {encoding:?}: {ratio:.2} x the arrays, without the file"
        );
    }
}
