//! Fuzz target: for any bytes the reader returns a mesh or an error, and every mesh can be checked, repaired and
//! written.
//!
//! ```text
//! cargo install cargo-fuzz
//! cd crates/sinew-mesh
//! cargo +nightly fuzz run read_msh fuzz/corpus fuzz/seeds -- -rss_limit_mb=1024 -timeout=10 -max_len=65536
//! ```

#![no_main]

use libfuzzer_sys::fuzz_target;
use sinew_mesh::info::MeshInfo;
use sinew_mesh::vtu::{VtuEncoding, write_vtu};
use sinew_mesh::{MshEncoding, MshVersion, read_msh, write_msh};

fuzz_target!(|bytes: &[u8]| {
    let mesh = match read_msh(bytes) {
        Err(error) => {
            assert!(!error.to_string().contains('\n'));
            return;
        }
        Ok(mesh) => mesh,
    };
    let _ = MeshInfo::of(&mesh).to_json();
    let _ = mesh.check().to_string();
    let mut fixed = mesh.clone();
    fixed.orient();
    fixed.merge_duplicates();
    fixed.drop_orphans();
    let _ = write_vtu(&fixed, VtuEncoding::Base64, &mut Vec::new());
    for version in [MshVersion::V22, MshVersion::V41] {
        for encoding in [MshEncoding::Text, MshEncoding::Binary] {
            let mut written = Vec::new();
            if write_msh(&mesh, version, encoding, &mut written).is_ok() {
                read_msh(&written).expect("what was written can be read");
            }
        }
    }
});
