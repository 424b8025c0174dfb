//! The dependencies that crates may have on each other.

use std::collections::BTreeMap;

use super::breach::Breach;
use super::workspace::Package;

/// The crates of the workspace on which each crate may depend. Dependencies go in one direction only.
pub(super) const ROOMS: &[(&str, &[&str])] = &[
    ("sinew-sparse", &[]),
    ("sinew-mesh", &[]),
    ("sinew-core", &["sinew-sparse"]),
    (
        "sinew-fem",
        &["sinew-core", "sinew-mesh", "sinew-sparse", "sinew-cutting"],
    ),
    ("sinew-cnn", &["sinew-core", "sinew-sparse"]),
    (
        "sinew-machines",
        &["sinew-core", "sinew-cnn", "sinew-sparse"],
    ),
    ("sinew-draw", &[]),
    ("sinew-film", &["sinew-draw", "sinew-mesh"]),
    ("sinew-tools", &["sinew-core", "sinew-sparse"]),
    ("sinew-cutting", &["sinew-mesh"]),
    (
        "sinew-haptics",
        &["sinew-core", "sinew-tools", "sinew-world"],
    ),
    ("sinew-testkit", &["sinew-core", "sinew-fem", "sinew-mesh"]),
    (
        "sinew-integrators",
        &["sinew-core", "sinew-cnn", "sinew-machines", "sinew-sparse"],
    ),
    (
        "sinew-scene",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-integrators",
            "sinew-tools",
            "sinew-cutting",
        ],
    ),
    (
        "sinew-measure",
        &["sinew-core", "sinew-integrators", "sinew-scene"],
    ),
    (
        "sinew-world",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-integrators",
            "sinew-scene",
            "sinew-tools",
        ],
    ),
    (
        "sinew-record",
        &[
            "sinew-core",
            "sinew-draw",
            "sinew-film",
            "sinew-mesh",
            "sinew-fem",
            "sinew-integrators",
            "sinew-scene",
            "sinew-world",
            "sinew-tools",
        ],
    ),
    (
        "sinew-live",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-tools",
            "sinew-integrators",
            "sinew-scene",
            "sinew-world",
        ],
    ),
    (
        "sinew-py",
        &[
            "sinew",
            "sinew-core",
            "sinew-fem",
            "sinew-integrators",
            "sinew-measure",
            "sinew-mesh",
            "sinew-record",
            "sinew-scene",
            "sinew-tools",
            "sinew-world",
        ],
    ),
    (
        "sinew-verify",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-sparse",
            "sinew-tools",
            "sinew-haptics",
            "sinew-cutting",
            "sinew-integrators",
            "sinew-scene",
            "sinew-measure",
            "sinew-world",
            "sinew-draw",
        ],
    ),
    (
        "sinew-bench",
        &[
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-cnn",
            "sinew-machines",
            "sinew-sparse",
            "sinew-haptics",
            "sinew-integrators",
            "sinew-scene",
            "sinew-measure",
            "sinew-world",
            "sinew-draw",
            "sinew-verify",
        ],
    ),
    (
        "sinew",
        &[
            "sinew-sparse",
            "sinew-core",
            "sinew-mesh",
            "sinew-fem",
            "sinew-cnn",
            "sinew-machines",
            "sinew-tools",
            "sinew-haptics",
            "sinew-cutting",
            "sinew-integrators",
            "sinew-scene",
            "sinew-measure",
            "sinew-world",
            "sinew-record",
            "sinew-live",
            "sinew-draw",
            "sinew-film",
        ],
    ),
    (
        "xtask",
        &[
            "sinew-bench",
            "sinew-core",
            "sinew-fem",
            "sinew-measure",
            "sinew-mesh",
            "sinew-record",
            "sinew-scene",
            "sinew-verify",
            "sinew-world",
        ],
    ),
];

/// The laboratory: crates that measure and verify the product, and are not part of it.
const LABORATORY: &[&str] = &["sinew-bench", "sinew-verify", "sinew-testkit", "xtask"];

/// The only crate of the laboratory that the product's tests may use.
const FOR_TESTS: &str = "sinew-testkit";

/// Libraries that only one published crate may name.
pub(super) const PRIVATE: &[(&str, &str)] = &[
    ("faer", "sinew-integrators"),
    ("nalgebra", "sinew-fem"),
    ("axum", "sinew-live"),
    ("tokio", "sinew-live"),
];

/// Checks that every crate is listed and depends only on allowed crates.
pub(super) fn check(packages: &[Package]) -> Vec<Breach> {
    let rooms: BTreeMap<&str, &[&str]> = ROOMS.iter().copied().collect();
    let mut breaches = Vec::new();
    for package in packages {
        let name = &package.name;
        let Some(allowed) = rooms.get(name.as_str()) else {
            breaches.push(Breach::NoRoom { name: name.clone() });
            continue;
        };
        breaches.extend(of_laboratory(package));
        for other in &package.needs {
            let is_ours = rooms.contains_key(other.as_str());
            if is_ours && !allowed.contains(&other.as_str()) {
                breaches.push(Breach::Dependency {
                    name: name.clone(),
                    other: other.clone(),
                });
            }
            for (library, owner) in PRIVATE {
                if other == library && name != owner && package.is_published {
                    breaches.push(Breach::PrivateLibrary {
                        library,
                        owner,
                        name: name.clone(),
                    });
                }
            }
        }
    }
    breaches
}

/// Crates of the laboratory that a crate of the product depends on, and those of the laboratory that would be
/// published.
fn of_laboratory(package: &Package) -> Vec<Breach> {
    let name = &package.name;
    if LABORATORY.contains(&name.as_str()) {
        let published = package
            .is_published
            .then(|| Breach::PublishedLaboratory { name: name.clone() });
        return published.into_iter().collect();
    }
    let of_tests = package
        .tests_need
        .iter()
        .filter(|other| *other != FOR_TESTS);
    let others = package.needs.iter().chain(of_tests);
    let others = others.filter(|other| LABORATORY.contains(&other.as_str()));
    others
        .map(|other| Breach::Laboratory {
            name: name.clone(),
            other: other.clone(),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(name: &str, needs: &[&str]) -> Vec<String> {
        let needs = needs.iter().map(ToString::to_string).collect();
        let package = Package {
            name: name.to_owned(),
            needs,
            is_published: true,
            ..Package::default()
        };
        check(&[package]).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_crate_that_keeps_to_its_room_is_fine() {
        assert!(said("sinew-fem", &["sinew-mesh", "nalgebra", "thiserror"]).is_empty());
    }

    #[test]
    fn the_product_depends_on_no_laboratory_not_even_in_its_tests() {
        let said = |package: Package| -> Vec<String> {
            let breaches = of_laboratory(&package);
            breaches.iter().map(ToString::to_string).collect()
        };
        let package = |name: &str, needs: &[&str], tests_need: &[&str]| Package {
            name: name.to_owned(),
            needs: needs.iter().map(ToString::to_string).collect(),
            tests_need: tests_need.iter().map(ToString::to_string).collect(),
            is_published: false,
        };
        for name in ["sinew-sparse", "sinew-fem", "sinew-live", "sinew"] {
            for other in LABORATORY {
                let breach = format!("`{name}` is of the product and must not depend on `{other}`");
                assert_eq!(said(package(name, &[other], &[])), [breach.as_str()]);
                let of_tests = said(package(name, &[], &[other]));
                let expected: &[&str] = if *other == FOR_TESTS { &[] } else { &[&breach] };
                assert_eq!(of_tests, expected);
            }
        }
        assert!(said(package("sinew-bench", &["sinew-verify"], &[])).is_empty());
        let published = Package {
            is_published: true,
            ..package("sinew-verify", &[], &[])
        };
        assert_eq!(
            said(published),
            ["`sinew-verify` is of the laboratory and must not be published"]
        );
    }

    #[test]
    fn a_way_back_a_foreign_library_and_a_crate_without_a_room_are_named() {
        assert_eq!(
            said("sinew-mesh", &["sinew-fem"]),
            ["`sinew-mesh` must not depend on `sinew-fem`"]
        );
        assert_eq!(
            said("sinew-core", &["faer"]),
            ["only `sinew-integrators` may depend on faer, not `sinew-core`"]
        );
        assert_eq!(
            said("sinew-new", &[]),
            ["crate `sinew-new` has no place in xtask/src/rules/rooms.rs"]
        );
    }
}
