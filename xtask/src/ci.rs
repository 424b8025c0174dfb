//! `cargo xtask ci`.

use std::ffi::OsStr;
use std::process::Command;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

use sinew_bench::output::say;

use crate::failure::Failure;
use crate::{root, rules};

/// Name of the step that packs each crate and builds it from its package.
const PACKAGES: &str = "packages";

/// Arguments of cargo and what they check.
const STEPS: &[(&str, &[&str])] = &[
    ("formatting", &["fmt", "--all", "--check"]),
    (
        "lints",
        &[
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "-D",
            "warnings",
        ],
    ),
    (
        "lints without default features",
        &[
            "clippy",
            "--no-default-features",
            "-psinew-sparse",
            "-psinew-core",
            "-psinew-fem",
            "-psinew-cnn",
            "-psinew-integrators",
            "--",
            "-D",
            "warnings",
        ],
    ),
    ("tests", &["test", "--workspace"]),
    ("documentation", &["doc", "--workspace", "--no-deps"]),
    (
        "one crate used alone",
        &[
            "run",
            "--quiet",
            "--manifest-path",
            "examples/mesh-alone/Cargo.toml",
            "--target-dir",
            "target/mesh-alone",
        ],
    ),
    (
        PACKAGES,
        &[
            "package",
            "--workspace",
            "--exclude",
            "xtask",
            "--exclude",
            "sinew-mesh-tests",
            "--allow-dirty",
            "--quiet",
        ],
    ),
    (
        "quick bench",
        &["xtask", "bench", "--quick", "--out", "target/ci-bench"],
    ),
    (
        "quick hard cases",
        &[
            "xtask",
            "bench",
            "--hard",
            "--quick",
            "--out",
            "target/ci-hard",
        ],
    ),
];

pub(crate) fn run() -> Result<(), Failure> {
    let start = Instant::now();
    rules::check().map_err(Failure::chore)?;
    say("rules: kept")?;
    for (name, arguments) in STEPS {
        say(&format!("\n== {name}: cargo {}", arguments.join(" ")))?;
        let step = Instant::now();
        let packaging = *name == PACKAGES;
        // cargo unpacks each package once for a path and version, and would compile an older one
        // that was packed at the same path before.
        let own_target = packaging.then(|| {
            let now = SystemTime::now().duration_since(UNIX_EPOCH);
            let stamp = now.map_or(0, |now| now.as_millis());
            root().join("target").join(format!("packages-{stamp}"))
        });
        let target = own_target.iter().flat_map(|target| {
            let flag: [&OsStr; 2] = [OsStr::new("--target-dir"), target.as_os_str()];
            flag
        });
        let status = Command::new(env!("CARGO"))
            .args(*arguments)
            .args(target)
            .current_dir(root())
            .env("RUSTDOCFLAGS", "-D warnings")
            // Packages are built once more, only to see that they build.
            .env(
                "CARGO_PROFILE_DEV_OPT_LEVEL",
                if packaging { "0" } else { "2" },
            )
            .status()
            .map_err(Failure::chore)?;
        if let Some(target) = &own_target {
            // What is left behind costs space and nothing else.
            let _ = std::fs::remove_dir_all(target);
        }
        if !status.success() {
            return Err(Failure::Chore(format!("{name}: {status}")));
        }
        say(&format!(
            "== {name}: fine after {} s",
            step.elapsed().as_secs()
        ))?;
    }
    let seconds = start.elapsed().as_secs();
    Ok(say(&format!("\nall fine after {seconds} s"))?)
}
