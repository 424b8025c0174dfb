//! The files of the page, which are parts of the program.

/// A file of the page.
pub(crate) struct Asset {
    /// Its name below the address of the page.
    name: &'static str,
    /// Its type.
    pub(crate) kind: &'static str,
    /// Its content.
    pub(crate) content: &'static [u8],
}

static ASSETS: [Asset; 3] = [
    Asset {
        name: "",
        kind: "text/html; charset=utf-8",
        content: include_bytes!("../../page/index.html"),
    },
    Asset {
        name: "live.css",
        kind: "text/css; charset=utf-8",
        content: include_bytes!("../../page/live.css"),
    },
    Asset {
        name: "live.js",
        kind: "text/javascript; charset=utf-8",
        content: include_bytes!("../../page/dist/live.js"),
    },
];

/// The file of this name.
pub(crate) fn find(name: &str) -> Option<&'static Asset> {
    ASSETS.iter().find(|asset| asset.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_needs_nothing_from_elsewhere() {
        for asset in &ASSETS[..2] {
            let text = str::from_utf8(asset.content).unwrap();
            assert!(
                !text.contains("http:") && !text.contains("https:"),
                "{}",
                asset.name
            );
        }
        let page = str::from_utf8(ASSETS[0].content).unwrap();
        for other in &ASSETS[1..] {
            assert!(
                page.contains(&format!("\"{}\"", other.name)),
                "{}",
                other.name
            );
        }
    }

    #[test]
    fn the_bundle_carries_the_notice_of_its_library() {
        let bundle = str::from_utf8(ASSETS[2].content).unwrap();
        assert!(bundle.contains(include_str!("../../page/THREE-LICENSE").trim()));
        assert!(bundle.contains("three.js authors"));
        assert!(bundle.contains("Permission is hereby granted"));
    }
}
