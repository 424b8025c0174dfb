//! The files of the pages, which are parts of the program.

/// A file of a page.
pub(crate) struct Asset {
    /// Its name below the address of the page.
    name: &'static str,
    /// Its type.
    pub(crate) kind: &'static str,
    /// Its content.
    pub(crate) content: &'static [u8],
}

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JAVASCRIPT: &str = "text/javascript; charset=utf-8";

/// Name of the message by which a page finds out which of the pages is served now.
pub(crate) const STATE: &str = "state";

/// The files of a session's page, beginning with the page itself.
pub(crate) static OF_SESSION: &[Asset] = &[
    Asset {
        name: "",
        kind: HTML,
        content: include_bytes!("../../page/index.html"),
    },
    Asset {
        name: "live.css",
        kind: CSS,
        content: include_bytes!("../../page/live.css"),
    },
    Asset {
        name: "live.js",
        kind: JAVASCRIPT,
        content: include_bytes!("../../page/dist/live.js"),
    },
    Asset {
        name: STATE,
        kind: "application/json",
        content: br#"{"page":"live"}"#,
    },
];

/// The files of the start page, beginning with the page itself.
pub(crate) static OF_START: &[Asset] = &[
    Asset {
        name: "",
        kind: HTML,
        content: include_bytes!("../../page/start.html"),
    },
    Asset {
        name: "start.css",
        kind: CSS,
        content: include_bytes!("../../page/start.css"),
    },
    Asset {
        name: "start.js",
        kind: JAVASCRIPT,
        content: include_bytes!("../../page/start.js"),
    },
];

/// The file of this name.
pub(crate) fn find(assets: &'static [Asset], name: &str) -> Option<&'static Asset> {
    assets.iter().find(|asset| asset.name == name)
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use sinew_core::Hash;

    use super::*;

    #[test]
    fn the_pages_need_nothing_from_elsewhere() {
        for asset in OF_SESSION[..2].iter().chain(OF_START) {
            let text = str::from_utf8(asset.content).unwrap();
            assert!(
                !text.contains("http:") && !text.contains("https:"),
                "{}",
                asset.name
            );
        }
        for files in [&OF_SESSION[..3], OF_START] {
            let page = str::from_utf8(files[0].content).unwrap();
            for other in &files[1..] {
                assert!(
                    page.contains(&format!("\"{}\"", other.name)),
                    "{}",
                    other.name
                );
            }
        }
    }

    #[test]
    fn the_bundle_carries_the_notice_of_its_library() {
        let bundle = str::from_utf8(OF_SESSION[2].content).unwrap();
        assert!(bundle.contains(include_str!("../../page/THREE-LICENSE").trim()));
        assert!(bundle.contains("three.js authors"));
        assert!(bundle.contains("Permission is hereby granted"));
    }

    /// Compares with the hashes that `npm run build` wrote, of the sources and of the bundle made from them.
    #[test]
    fn the_bundle_is_built_from_the_sources() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("page");
        let read = |name: &str| fs::read(page.join(name)).unwrap();
        let mut scripts: Vec<String> = fs::read_dir(page.join("src"))
            .unwrap()
            .map(|entry| format!("src/{}", entry.unwrap().file_name().display()))
            .collect();
        scripts.sort();
        let others = ["THREE-LICENSE", "package-lock.json", "package.json"];
        let mut sources = Hash::new();
        for name in others.into_iter().chain(scripts.iter().map(String::as_str)) {
            sources.add(format!("{name}\n").as_bytes());
            sources.add(&read(name));
        }
        let mut bundle = Hash::new();
        bundle.add(OF_SESSION[2].content);
        let (sources, bundle) = (sources.value(), bundle.value());
        let found = format!("sources {sources:016x}\nlive.js {bundle:016x}\n");
        assert_eq!(
            String::from_utf8(read("dist/hashes.txt")).unwrap(),
            found,
            "`npm ci && npm run build` in crates/sinew-live/page rebuilds the bundle"
        );
    }
}
