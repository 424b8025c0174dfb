//! Chromium without a window.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

use crate::failure::Failure;

/// Names under which it is installed.
const NAMES: [&str; 4] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
];

/// Options for Mesa's software renderer, the fastest of Chromium without a graphics card.
const FLAGS: [&str; 10] = [
    "--headless=new",
    "--no-sandbox",
    "--use-angle=gl-egl",
    "--ignore-gpu-blocklist",
    "--remote-debugging-port=0",
    "--no-first-run",
    "--disable-extensions",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--hide-scrollbars",
];

/// A browser, which ends with this value.
pub(super) struct Chromium {
    child: Child,
    /// Address at which it listens.
    pub(super) address: String,
    /// Its profile.
    _folder: TempDir,
}

/// The program, if it is installed.
pub(super) fn find() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders = std::env::split_paths(&path);
    let mut places = folders.flat_map(|folder| NAMES.map(|name| folder.join(name)));
    places.find(|place| place.is_file())
}

impl Chromium {
    pub(super) fn start(program: PathBuf) -> Result<Self, Failure> {
        let folder = TempDir::new().map_err(Failure::chore)?;
        let mut child = Command::new(program)
            .args(FLAGS)
            .arg(format!("--user-data-dir={}", folder.path().display()))
            .arg("about:blank")
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(Failure::chore)?;
        let said = child.stderr.take().map(BufReader::new);
        let mut lines = said
            .into_iter()
            .flat_map(BufRead::lines)
            .map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.split_once("listening on ")?.1.to_owned()));
        // What it says later must not stop it.
        std::thread::spawn(move || lines.count());
        let chromium = Self {
            child,
            address: address.unwrap_or_default(),
            _folder: folder,
        };
        match chromium.address.is_empty() {
            false => Ok(chromium),
            true => Err(Failure::Chore(
                "Chromium ended before it listened".to_owned(),
            )),
        }
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        // One that has ended already needs no end.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
