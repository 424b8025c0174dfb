//! Folders that belong to one result.

use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Seek, SeekFrom, Write};
use std::path::{Component, Path, PathBuf};

use super::error::OutputError;
use super::folder::OutputFolder;
use super::identity::Input;
use super::lock_holder::lock_holder;
use super::target::Target;
use super::whole_file::{WholeFile, is_left_behind, is_temporary};

/// The file that says whose a folder is and what was written into it.
const MANIFEST: &str = "manifest.json";

/// A folder that holds one result and nothing else, so that a later result of the same kind may replace it without
/// taking anything that is not its own. A manifest in it says what kind of result it is and which files belong to it.
///
/// While it is open no other process opens it.
#[derive(Debug)]
pub struct OwnedFolder {
    path: PathBuf,
    kind: &'static str,
    inputs: Vec<Input>,
    /// Holds the lock.
    _lock: File,
}

/// What a folder holds before a result is written into it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tenant {
    /// Nothing.
    Nobody,
    /// An earlier result of the same kind, which will be replaced.
    Earlier,
}

impl OwnedFolder {
    /// Checks, before long work, that a result of this kind may be written at `path`, by a run that reads `inputs`: the
    /// folder is new or empty, or holds an earlier result of the same kind and nothing else. Changes nothing.
    ///
    /// # Errors
    /// [`OutputError`] for a folder that holds other things, into which another process writes, or that cannot be written.
    pub fn check(
        path: &Path,
        kind: &'static str,
        inputs: &[PathBuf],
    ) -> Result<Tenant, OutputError> {
        OutputFolder::new(path, inputs).check(&[])?;
        // What another process is writing is nothing to judge.
        if path.is_dir() {
            Self::lock(path, kind, &[])?;
        }
        Self::check_content(path, kind, inputs)
    }

    /// As [`OwnedFolder::check`], also for the process that writes into the folder.
    fn check_content(
        path: &Path,
        kind: &'static str,
        inputs: &[PathBuf],
    ) -> Result<Tenant, OutputError> {
        if let Some(holder) = holder_of(path)? {
            return Err(OutputError::Within {
                path: path.to_owned(),
                holder,
            });
        }
        if let Ok(folder) = path.canonicalize() {
            let within = |input: &&PathBuf| {
                let input = input.canonicalize();
                input.is_ok_and(|input| input.starts_with(&folder))
            };
            if let Some(input) = inputs.iter().find(within) {
                return Err(OutputError::InputWithin {
                    path: path.to_owned(),
                    input: input.clone(),
                });
            }
        }
        let entries = match entries(path, "") {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Tenant::Nobody),
            entries => entries.map_err(|source| not_opened(path, source))?,
        };
        let entries: Vec<String> = entries
            .into_iter()
            .filter(|name| !is_temporary(name))
            .collect();
        if entries.is_empty() {
            return Ok(Tenant::Nobody);
        }
        let foreign = |names: Vec<String>| OutputError::Foreign {
            path: path.to_owned(),
            names,
        };
        let Some(manifest) = Manifest::read(path)? else {
            return Err(foreign(entries));
        };
        if manifest.kind != kind {
            return Err(foreign(vec![MANIFEST.to_owned()]));
        }
        let is_own = |name: &String| {
            let file = || manifest.files.contains(name) || name == MANIFEST;
            let folder = format!("{name}/");
            let holds_own = || manifest.files.iter().any(|own| own.starts_with(&folder));
            match path.join(name).symlink_metadata() {
                Ok(metadata) if metadata.is_dir() => holds_own(),
                Ok(metadata) if metadata.is_file() => file(),
                _ => false,
            }
        };
        let mut others: Vec<String> = Vec::new();
        for name in &entries {
            if !is_own(name) {
                others.push(name.clone());
            } else if path.join(name).is_dir() {
                let within = entries_of_folder(path, name)?;
                let foreign = |name: &String| !is_own(name) && !is_temporary(name);
                others.extend(within.into_iter().filter(foreign));
            }
        }
        match others.is_empty() {
            true => Ok(Tenant::Earlier),
            false => Err(foreign(others)),
        }
    }

    /// Makes the folder if need be, removes an earlier result of the same kind and writes down that files of these names
    /// (with `/` between folders) will belong to the new one.
    ///
    /// # Errors
    /// As [`OwnedFolder::check`], and [`OutputError::Busy`] while another process writes into it.
    pub fn claim(
        path: &Path,
        kind: &'static str,
        inputs: &[PathBuf],
        names: &[String],
    ) -> Result<Self, OutputError> {
        Self::check(path, kind, inputs)?;
        fs::create_dir_all(path).map_err(|source| not_opened(path, source))?;
        let folder = Self::lock(path, kind, inputs)?;
        // Once more, now that nobody else writes into it.
        Self::check_content(path, kind, inputs)?;
        if let Some(earlier) = Manifest::read(path)? {
            for name in &earlier.files {
                folder.remove(name)?;
            }
            for name in &earlier.files {
                if let Some((within, _)) = name.rsplit_once('/') {
                    // Where it holds something or is gone it stays as it is.
                    let _ = fs::remove_dir(path.join(within));
                }
            }
        }
        folder.clear_left_behind()?;
        let manifest = Manifest {
            kind: kind.to_owned(),
            files: names.to_vec(),
        };
        folder.write(MANIFEST, manifest.to_json().as_bytes())?;
        Ok(folder)
    }

    /// Opens the folder of an earlier result of this kind to go on with it.
    ///
    /// # Errors
    /// [`OutputError::NoResult`] where there is none, and [`OutputError::Busy`].
    pub fn reopen(path: &Path, kind: &'static str) -> Result<Self, OutputError> {
        let none = || OutputError::NoResult {
            path: path.to_owned(),
            kind,
        };
        let manifest = Manifest::read(path)?.ok_or_else(none)?;
        if manifest.kind != kind {
            return Err(none());
        }
        let folder = Self::lock(path, kind, &[])?;
        folder.clear_left_behind()?;
        Ok(folder)
    }

    fn lock(path: &Path, kind: &'static str, inputs: &[PathBuf]) -> Result<Self, OutputError> {
        let lock = File::open(path).map_err(|source| not_opened(path, source))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let by = lock_holder(&lock);
                let path = path.to_owned();
                return Err(OutputError::Busy { path, by });
            }
            // A file system without locks: the manifest still tells whose the folder is.
            Err(TryLockError::Error(_)) => {}
        }
        Ok(Self {
            path: path.to_owned(),
            kind,
            inputs: Input::all(inputs),
            _lock: lock,
        })
    }

    /// Its path as it was given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The kind of result that it holds.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// The content of a file; `None` where there is none.
    ///
    /// # Errors
    /// [`OutputError::NotOpened`].
    pub fn read(&self, name: &str) -> Result<Option<Vec<u8>>, OutputError> {
        let path = self.path.join(name);
        match fs::read(&path) {
            Ok(content) => Ok(Some(content)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(source) => Err(not_opened(&path, source)),
        }
    }

    /// Writes a file as a whole and makes sure that the disk has it.
    ///
    /// # Errors
    /// [`OutputError`]; a file that was there is then as it was.
    pub fn write(&self, name: &str, content: &[u8]) -> Result<(), OutputError> {
        let path = self.target(name)?;
        let write = |path: &Path| {
            let mut file = WholeFile::create(path)?;
            file.write_all(content)?;
            file.finish()
        };
        write(&path).map_err(|source| failed(&path, source))
    }

    /// Writes a file as a whole, which the disk gets when the system pleases: for many files that a checkpoint covers.
    ///
    /// # Errors
    /// [`OutputError`]; a file that was there is then as it was.
    pub fn write_lightly(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let path = self.target(name)?;
        let write = |path: &Path| {
            let mut file = WholeFile::create(path)?;
            fill(&mut file)?;
            file.finish_lightly()
        };
        write(&path).map_err(|source| failed(&path, source))
    }

    /// Opens a file that grows, cut off after its first `length` bytes; new where `length` is 0.
    ///
    /// # Errors
    /// [`OutputError`], also for a file that is shorter.
    pub fn append(&self, name: &str, length: u64) -> Result<GrowingFile, OutputError> {
        let path = self.target(name)?;
        let open = |path: &Path| {
            let mut options = File::options();
            let file = options
                .write(true)
                .create(true)
                .truncate(false)
                .open(path)?;
            let found = file.metadata()?.len();
            if found < length {
                let reason = format!("it has {found} bytes of at least {length}");
                return Err(io::Error::new(ErrorKind::UnexpectedEof, reason));
            }
            file.set_len(length)?;
            Ok(file)
        };
        let mut file = open(&path).map_err(|source| not_opened(&path, source))?;
        file.seek(SeekFrom::End(0))
            .map_err(|source| not_opened(&path, source))?;
        Ok(GrowingFile {
            path,
            length,
            file: BufWriter::new(file),
        })
    }

    /// Removes a file, if it is there.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn remove(&self, name: &str) -> Result<(), OutputError> {
        let path = self.path.join(name);
        match fs::remove_file(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(()),
            removed => removed.map_err(|source| failed(&path, source)),
        }
    }

    /// The path of a file that may be written: in a folder that exists, and no input of the run.
    fn target(&self, name: &str) -> Result<PathBuf, OutputError> {
        let path = self.path.join(name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(|source| not_opened(folder, source))?;
        }
        match Target::find(&path, &self.inputs)? {
            Target::File(path) => Ok(path),
            Target::StandardOutput | Target::Stream => Err(OutputError::Unsuitable {
                path,
                kind: "no file",
            }),
        }
    }

    /// Removes temporary files of processes that are gone.
    fn clear_left_behind(&self) -> Result<(), OutputError> {
        let entries = entries(&self.path, "").map_err(|source| not_opened(&self.path, source))?;
        let mut names = Vec::new();
        for name in entries {
            if self.path.join(&name).is_dir() {
                names.extend(entries_of_folder(&self.path, &name)?);
            } else {
                names.push(name);
            }
        }
        names
            .iter()
            .filter(|name| is_left_behind(name))
            .try_for_each(|name| self.remove(name))
    }
}

/// A file that grows line by line. What was written is there after a kill, as far as it was flushed.
#[derive(Debug)]
pub struct GrowingFile {
    path: PathBuf,
    length: u64,
    file: BufWriter<File>,
}

impl GrowingFile {
    /// Adds to its end.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn push(&mut self, content: &str) -> Result<(), OutputError> {
        let written = self.file.write_all(content.as_bytes());
        written.map_err(|source| failed(&self.path, source))?;
        self.length += content.len() as u64;
        Ok(())
    }

    /// Makes sure that the disk has all of it, and gives its length in bytes.
    ///
    /// # Errors
    /// [`OutputError::Failed`].
    pub fn secure(&mut self) -> Result<u64, OutputError> {
        let secured = self
            .file
            .flush()
            .and_then(|()| self.file.get_ref().sync_data());
        secured.map_err(|source| failed(&self.path, source))?;
        Ok(self.length)
    }
}

/// The nearest folder above a path that holds a result.
fn holder_of(path: &Path) -> Result<Option<PathBuf>, OutputError> {
    let absolute = std::path::absolute(path).map_err(|source| not_opened(path, source))?;
    // What lies at the end of links counts, as far as it exists.
    let nearest = absolute.ancestors().find_map(|above| {
        let found = above.canonicalize().ok()?;
        Some((found, above == absolute))
    });
    let Some((nearest, is_whole)) = nearest else {
        return Ok(None);
    };
    for above in nearest.ancestors().skip(usize::from(is_whole)) {
        if Manifest::read(above)?.is_some() {
            return Ok(Some(above.to_owned()));
        }
    }
    Ok(None)
}

/// Kind and files of a result.
struct Manifest {
    kind: String,
    files: Vec<String>,
}

impl Manifest {
    /// The manifest in a folder; `None` where there is none, or another program's.
    fn read(folder: &Path) -> Result<Option<Self>, OutputError> {
        let path = folder.join(MANIFEST);
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error)
                if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                return Ok(None);
            }
            Err(source) => return Err(not_opened(&path, source)),
        };
        let Ok(json) = serde_json::from_slice::<serde_json::Value>(&text) else {
            return Ok(None);
        };
        let kind = json["sinew"].as_str();
        let files = json["files"].as_array();
        let files = files.and_then(|files| {
            let names = files.iter().map(|name| name.as_str().map(str::to_owned));
            names.collect::<Option<Vec<String>>>()
        });
        // A name that leads out of the folder was not written by us.
        let stays = |name: &String| {
            let plain = |part: Component<'_>| matches!(part, Component::Normal(_));
            !name.is_empty() && Path::new(name).components().all(plain)
        };
        Ok(match (kind, files) {
            (Some(kind), Some(files)) if files.iter().all(stays) => Some(Self {
                kind: kind.to_owned(),
                files,
            }),
            _ => None,
        })
    }

    fn to_json(&self) -> String {
        let json = serde_json::json!({ "sinew": self.kind, "files": self.files });
        format!("{json:#}\n")
    }
}

/// Names of the entries of a folder in it, with `prefix` before each, in order.
fn entries(folder: &Path, prefix: &str) -> io::Result<Vec<String>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        names.push(format!("{prefix}{}", entry?.file_name().to_string_lossy()));
    }
    names.sort_unstable();
    Ok(names)
}

fn entries_of_folder(path: &Path, name: &str) -> Result<Vec<String>, OutputError> {
    let folder = path.join(name);
    let found =
        entries(&folder, &format!("{name}/")).map_err(|source| not_opened(&folder, source))?;
    Ok(found)
}

fn not_opened(path: &Path, source: io::Error) -> OutputError {
    OutputError::NotOpened {
        path: path.to_owned(),
        source,
    }
}

fn failed(path: &Path, source: io::Error) -> OutputError {
    OutputError::Failed {
        path: path.to_owned(),
        source,
    }
}
