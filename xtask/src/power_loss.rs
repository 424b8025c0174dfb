//! `cargo xtask power-loss`: continuation of a run after a loss of power.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use sinew_scene::output::say;
use tempfile::TempDir;

use crate::failure::Failure;
use crate::program;

/// The command to try.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// A sinew that is built already, instead of a release build of this one
    #[arg(long, value_name = "PROGRAM")]
    sinew: Option<PathBuf>,
}

/// Number of power losses while a run writes.
const LOSSES: u64 = 8;

/// A run of some seconds that writes a checkpoint as often as possible.
const SCENE: &str = "[mesh]\ncube = { cells = 6, edge = 0.1 }\n[[region]]\ndensity = 1060.0\nmodel = \"linear\"\n\
                     youngs_modulus = 3500.0\npoissons_ratio = 0.3\n[damping]\nmass = 1.0\n[[fixed]]\n\
                     group = \"bottom\"\n[[load]]\ngroup = \"top\"\npressure = 60.0\n[run]\nduration = 120.0\n\
                     integrator = \"central-difference\"\ndt = 0.001\n[[probe]]\nname = \"top\"\n\
                     point = [0.05, 0.05, 0.1]\n[output]\ncheckpoint = { every = 0.05 }\nfields = { frames = 400 }\n";

/// Stops the file system of a folder like a loss of power: data not yet on the disk are lost (`EXT4_IOC_SHUTDOWN`
/// without flushing the log, include/uapi/linux/ext4.h).
const SHUTDOWN: &str = "open(my $f, '<', $ARGV[0]) or die $!; my $flags = pack('L', 2); ioctl($f, 0x8004587d, $flags) or die $!";

/// A separate file system, in a file.
struct Disk {
    image: PathBuf,
    place: PathBuf,
}

impl Disk {
    /// Creates one, or returns the reason why this computer cannot.
    fn new(folder: &Path) -> Result<Self, String> {
        let (image, place) = (folder.join("disk.img"), folder.join("disk"));
        fs::create_dir(&place).map_err(|error| error.to_string())?;
        let file = fs::File::create(&image).and_then(|file| file.set_len(256 << 20));
        file.map_err(|error| error.to_string())?;
        let image_name = image.display().to_string();
        quietly("mkfs.ext4", &["-q", "-F", &image_name])?;
        let disk = Self { image, place };
        disk.mount()?;
        // Whoever may mount may still not be let to do this.
        disk.lose_power()?;
        disk.unmount()?;
        disk.mount()?;
        Ok(disk)
    }

    fn mount(&self) -> Result<(), String> {
        let (image, place) = (self.image.display(), self.place.display());
        quietly(
            "mount",
            &["-o", "loop", &image.to_string(), &place.to_string()],
        )
    }

    fn unmount(&self) -> Result<(), String> {
        quietly("umount", &[&self.place.display().to_string()])
    }

    fn lose_power(&self) -> Result<(), String> {
        quietly("perl", &["-e", SHUTDOWN, &self.place.display().to_string()])
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        // A failure cannot be reported here.
        let _ = self.unmount();
    }
}

/// Runs a program whose output matters only if it fails.
fn quietly(program: &str, arguments: &[&str]) -> Result<(), String> {
    let output = Command::new(program).args(arguments).output();
    let output = output.map_err(|error| format!("{program}: {error}"))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(format!(
            "{program}: {}",
            String::from_utf8_lossy(&output.stderr).trim()
        )),
    }
}

/// The command, and the folder of a scene.
struct Bench {
    sinew: PathBuf,
    folder: PathBuf,
}

impl Bench {
    fn start(&self, arguments: &[&str], out: &Path) -> Result<Child, Failure> {
        Command::new(&self.sinew)
            .args(arguments)
            .arg(out)
            .current_dir(&self.folder)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(Failure::chore)
    }

    fn run(&self, arguments: &[&str], out: &Path) -> Result<(ExitStatus, String), Failure> {
        let ended = self.start(arguments, out)?.wait_with_output();
        let ended = ended.map_err(Failure::chore)?;
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        Ok((ended.status, said))
    }
}

/// Cuts the power while a run writes and when a run has just ended. In every case, the continued run must give the
/// files of an undisturbed run.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let place = TempDir::new().map_err(Failure::chore)?;
    let disk = match Disk::new(place.path()) {
        Ok(disk) => disk,
        Err(reason) => return Ok(say(&format!("power-loss: SKIPPED: {reason}"))?),
    };
    let bench = Bench {
        sinew: match &arguments.sinew {
            Some(sinew) => sinew.clone(),
            None => program::build()?,
        },
        folder: place.path().to_owned(),
    };
    fs::write(place.path().join("scene.toml"), SCENE).map_err(Failure::chore)?;
    let whole = place.path().join("whole");
    let begun = Instant::now();
    expect(bench.run(&["run", "scene.toml", "--out"], &whole)?)?;
    let took = begun.elapsed();
    let whole = contents(&whole)?;
    let mut went_on = 0;
    for loss in 1..=LOSSES {
        let out = disk.place.join(format!("out-{loss}"));
        let mut child = bench.start(&["run", "scene.toml", "--out"], &out)?;
        let since = Instant::now();
        while !out.join("checkpoint.bin").exists() && since.elapsed() < Duration::from_secs(60) {
            sleep(Duration::from_millis(1));
        }
        sleep(took.mul_f64(0.8 * loss as f64 / LOSSES as f64));
        lose_power(&disk, &mut child)?;
        let has_checkpoint = out.join("checkpoint.bin").exists();
        let arguments: &[&str] = match has_checkpoint {
            true => &["resume"],
            false => return Err(Failure::chore("the checkpoint is gone, or never came")),
        };
        expect(bench.run(arguments, &out)?)?;
        went_on += 1;
        compare(&whole, &contents(&out)?)?;
        fs::remove_dir_all(&out).map_err(Failure::chore)?;
    }
    let out = disk.place.join("ended");
    let mut child = bench.start(&["run", "scene.toml", "--out"], &out)?;
    let ended = child.wait().map_err(Failure::chore)?;
    if !ended.success() {
        return Err(Failure::Chore(format!("the run: {ended}")));
    }
    lose_power(&disk, &mut child)?;
    compare(&whole, &contents(&out)?)?;
    Ok(say(&format!(
        "power-loss: {went_on} of {LOSSES} runs went on to the same files, and the one that had ended lost nothing"
    ))?)
}

/// Cuts the power during a run, and restores it.
fn lose_power(disk: &Disk, run: &mut Child) -> Result<(), Failure> {
    disk.lose_power().map_err(Failure::chore)?;
    // One that notices ends by itself.
    let _ = run.kill();
    run.wait().map_err(Failure::chore)?;
    disk.unmount().map_err(Failure::chore)?;
    disk.mount().map_err(Failure::chore)
}

fn expect((status, said): (ExitStatus, String)) -> Result<(), Failure> {
    match status.success() {
        true => Ok(()),
        false => Err(Failure::Chore(format!("{status}: {said}"))),
    }
}

/// Contents of all files of a result by their names, without facts about the computer.
fn contents(folder: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>, Failure> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(path) = waiting.pop() {
        for entry in fs::read_dir(&path).map_err(Failure::chore)? {
            let path = entry.map_err(Failure::chore)?.path();
            if path.is_dir() {
                waiting.push(path);
            } else if !path.ends_with("summary.json") {
                let content = fs::read(&path).map_err(Failure::chore)?;
                let name = path.strip_prefix(folder).map_err(Failure::chore)?;
                found.insert(name.to_owned(), content);
            }
        }
    }
    Ok(found)
}

fn compare(
    whole: &BTreeMap<PathBuf, Vec<u8>>,
    found: &BTreeMap<PathBuf, Vec<u8>>,
) -> Result<(), Failure> {
    let mut others: Vec<String> = Vec::new();
    for name in whole.keys().chain(found.keys()) {
        let (expected, content) = (whole.get(name), found.get(name));
        if expected != content && !others.iter().any(|known| Path::new(known) == name) {
            others.push(name.display().to_string());
        }
    }
    match others.is_empty() {
        true => Ok(()),
        false => Err(Failure::Chore(format!(
            "{} files differ from those of a run without a loss: {}",
            others.len(),
            others[..others.len().min(5)].join(", ")
        ))),
    }
}
