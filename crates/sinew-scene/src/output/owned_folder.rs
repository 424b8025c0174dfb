//! Folders that belong to one result.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::error::OutputError;
use super::folder::OutputFolder;
use super::identity::{Identity, Input};
use super::lock_holder::lock_holder;
use super::manifest::{MANIFEST, Manifest, State};
use super::target::folder_of;
use super::whole_file::{is_left_behind, is_temporary, sync_folder};

/// A folder with one result and nothing else, so that a later result of the same kind may replace it without touching
/// foreign files. A manifest in it states the kind of result, its completeness and its files.
///
/// A complete result is kept while a new one is written: next to the folder, under the folder's name with `.old`,
/// until [`OwnedFolder::finish`].
///
/// While it is open, no other process can open it.
#[derive(Debug)]
pub struct OwnedFolder {
    path: PathBuf,
    kind: &'static str,
    pub(super) inputs: Vec<Input>,
    /// Identity of the folder that was locked; another folder may replace it at its path.
    pub(super) identity: Option<Identity>,
    /// Folders in it whose names may not yet be on the disk.
    pub(super) unnamed: Mutex<BTreeSet<PathBuf>>,
    /// Holds the lock.
    _lock: Lock,
}

/// Content of a folder before a result is written into it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tenant {
    /// No content.
    Nobody,
    /// A complete result of the same kind, which is kept until the new one is complete.
    Earlier,
    /// A result of the same kind that was not completed, which will be removed.
    Unfinished,
}

/// Fate of the result that was kept while a new one was written.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub enum Replaced {
    /// There was none, or it was removed.
    Whole,
    /// The earlier result is still in this folder.
    KeptIn(PathBuf),
}

/// A lock, which is released even if a program that another thread is just starting has a copy of the open file.
#[derive(Debug)]
struct Lock(File);

impl Drop for Lock {
    fn drop(&mut self) {
        // Closing the file releases it too, later.
        let _ = self.0.unlock();
    }
}

impl OwnedFolder {
    /// Checks, before long work, that a result of this kind may be written at `path`, by a run that reads `inputs`: the
    /// folder is new or empty, or contains only an earlier result of the same kind. Changes nothing.
    ///
    /// # Errors
    /// [`OutputError`] for a folder with other content, one into which another process writes, or one that cannot be
    /// written.
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
        let tenant = Self::check_content(path, kind, inputs)?;
        if tenant == Tenant::Earlier {
            kept_beside(path, kind)?;
        }
        Ok(tenant)
    }

    /// Same as [`OwnedFolder::check`], also for the process that writes into the folder.
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
            entries => entries.map_err(|source| OutputError::not_opened(path, source))?,
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
        let own = manifest.names();
        let mut others: Vec<String> = Vec::new();
        let mut waiting = entries;
        while let Some(name) = waiting.pop() {
            let found = path.join(&name).symlink_metadata();
            match found.map(|found| found.file_type()) {
                Ok(found) if found.is_dir() && own.folders.contains(&*name) => {
                    waiting.extend(entries_of_folder(path, &name)?);
                }
                Ok(found) if found.is_file() && own.files.contains(&*name) => {}
                Ok(found) if found.is_file() && name == MANIFEST => {}
                _ if is_temporary(&name) => {}
                _ => others.push(name),
            }
        }
        others.sort_unstable();
        match (others.is_empty(), manifest.state) {
            (false, _) => Err(foreign(others)),
            (true, State::Unfinished) => Ok(Tenant::Unfinished),
            (true, _) => Ok(Tenant::Earlier),
        }
    }

    /// Creates the folder if necessary and records the names of the new result's files (with `/` between folders). A
    /// complete result of the same kind is set aside until [`OwnedFolder::finish`]; an incomplete one is removed.
    ///
    /// # Errors
    /// Same as [`OwnedFolder::check`], and [`OutputError::Busy`] while another process writes into it.
    pub fn claim(
        path: &Path,
        kind: &'static str,
        inputs: &[PathBuf],
        names: &[String],
    ) -> Result<Self, OutputError> {
        Self::check(path, kind, inputs)?;
        let make = || fs::create_dir_all(path);
        make().map_err(|source| OutputError::not_opened(path, source))?;
        let mut folder = Self::lock(path, kind, inputs)?;
        // Once more, now that nobody else writes into it.
        match Self::check_content(path, kind, inputs)? {
            Tenant::Nobody => {}
            Tenant::Unfinished => folder.clear()?,
            Tenant::Earlier => {
                // At the end of links, which then lead there again.
                let real = path.canonicalize();
                let real = real.map_err(|source| OutputError::not_opened(path, source))?;
                let kept = folder.set_aside()?;
                let made = fs::create_dir(&real);
                made.map_err(|source| OutputError::not_opened(path, source))?;
                if let Ok(old) = fs::metadata(kept) {
                    // As far as we may.
                    let _ = fs::set_permissions(&real, old.permissions());
                }
                folder = Self::lock(path, kind, inputs)?;
            }
        }
        folder.clear_left_behind()?;
        let manifest = Manifest {
            kind: kind.to_owned(),
            state: State::Unfinished,
            aside_of: None,
            files: names.to_vec(),
        };
        folder.write(MANIFEST, manifest.to_json().as_bytes())?;
        let parent = folder_of(path);
        sync_folder(parent).map_err(|source| OutputError::failed(parent, source))?;
        Ok(folder)
    }

    /// Opens the folder of an earlier result of this kind to continue it.
    ///
    /// # Errors
    /// [`OutputError::NoResult`] if absent, and [`OutputError::Busy`].
    pub fn reopen(path: &Path, kind: &'static str) -> Result<Self, OutputError> {
        let manifest = Manifest::read(path)?.filter(|manifest| manifest.kind == kind);
        if manifest.is_none() {
            let path = path.to_owned();
            return Err(OutputError::NoResult { path, kind });
        }
        let folder = Self::lock(path, kind, &[])?;
        folder.clear_left_behind()?;
        Ok(folder)
    }

    /// Completes the result, which is then durable, and removes the one that was kept next to it; after a failed run
    /// the kept one remains.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn finish(&self, is_success: bool) -> Result<Replaced, OutputError> {
        self.secure()?;
        let kept = kept_path(&self.path);
        let is_kept = is_set_aside(&kept, self.kind)?;
        if is_kept && !is_success {
            return Ok(Replaced::KeptIn(kept));
        }
        self.write_state(State::Finished, None)?;
        match is_kept {
            true => remove_set_aside(&kept, self.kind),
            false => Ok(Replaced::Whole),
        }
    }

    /// True if the folder is not known to contain a complete result.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn is_unfinished(&self) -> Result<bool, OutputError> {
        let manifest = Manifest::read(&self.path)?;
        Ok(manifest.is_none_or(|manifest| manifest.state == State::Unfinished))
    }

    /// Removes the rest of the result that this complete one replaced.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn forget_kept(&self) -> Result<(), OutputError> {
        let kept = kept_path(&self.path);
        if is_set_aside(&kept, self.kind)? {
            remove_set_aside(&kept, self.kind)?;
        }
        Ok(())
    }

    /// Moves the folder, which contains a complete result, aside.
    fn set_aside(&self) -> Result<PathBuf, OutputError> {
        let kept = kept_beside(&self.path, self.kind)?;
        if kept.exists() {
            // One whose successor was completed, but for its removal.
            remove_set_aside(&kept, self.kind)?;
        }
        self.write_state(State::SetAside, own_name(&self.path))?;
        let real = self.path.canonicalize();
        match real.and_then(|real| fs::rename(real, &kept)) {
            Ok(()) => Ok(kept),
            Err(source) => {
                self.write_state(State::Finished, None)?;
                Err(OutputError::NotSetAside {
                    path: self.path.clone(),
                    kept,
                    source,
                })
            }
        }
    }

    fn write_state(&self, state: State, aside_of: Option<String>) -> Result<(), OutputError> {
        let path = || self.path.clone();
        let manifest =
            Manifest::read(&self.path)?.ok_or_else(|| OutputError::Gone { path: path() })?;
        let manifest = Manifest {
            state,
            aside_of,
            ..manifest
        };
        self.write(MANIFEST, manifest.to_json().as_bytes())
    }

    /// Removes all files of the result, the manifest last, and the folders in it that are then empty.
    fn clear(&self) -> Result<(), OutputError> {
        let Some(manifest) = Manifest::read(&self.path)? else {
            return Ok(());
        };
        self.clear_left_behind()?;
        for name in &manifest.files {
            self.remove(name)?;
        }
        let mut folders: Vec<&str> = manifest.names().folders.into_iter().collect();
        folders.sort_unstable();
        // Those within others first.
        for folder in folders.into_iter().rev() {
            // One that holds something or is gone stays as it is.
            let _ = fs::remove_dir(self.path.join(folder));
        }
        self.remove(MANIFEST)
    }

    fn lock(path: &Path, kind: &'static str, inputs: &[PathBuf]) -> Result<Self, OutputError> {
        let lock = File::open(path).map_err(|source| OutputError::not_opened(path, source))?;
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
            identity: Identity::of_open(&lock, path),
            unnamed: Mutex::default(),
            _lock: Lock(lock),
        })
    }

    /// Its path as given.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes temporary files of processes that have ended.
    fn clear_left_behind(&self) -> Result<(), OutputError> {
        let entries = entries(&self.path, "");
        let entries = entries.map_err(|source| OutputError::not_opened(&self.path, source))?;
        let mut names = Vec::new();
        for name in entries {
            let found = self.path.join(&name).symlink_metadata();
            if found.is_ok_and(|found| found.is_dir()) {
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

/// The end of the name of a folder whose result is kept.
const ASIDE: &str = ".old";

/// The path at which a complete result is kept while another is written into the folder at `path`.
fn kept_path(path: &Path) -> PathBuf {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let mut name: OsString = real.file_name().unwrap_or_default().to_owned();
    name.push(ASIDE);
    real.with_file_name(name)
}

/// The path of [`kept_path`], if it contains no other content.
fn kept_beside(path: &Path, kind: &str) -> Result<PathBuf, OutputError> {
    let kept = kept_path(path);
    let (here, real) = (std::env::current_dir(), path.canonicalize());
    if here.is_ok_and(|here| real.is_ok_and(|real| here.starts_with(real))) {
        let path = path.to_owned();
        return Err(OutputError::CurrentFolder { path });
    }
    if kept.symlink_metadata().is_ok() && !is_set_aside(&kept, kind)? {
        let path = path.to_owned();
        return Err(OutputError::NoRoomAside { path, kept });
    }
    Ok(kept)
}

/// True if a folder contains a result that was set aside.
fn is_set_aside(folder: &Path, kind: &str) -> Result<bool, OutputError> {
    let is_folder = folder.symlink_metadata().is_ok_and(|found| found.is_dir());
    if !is_folder {
        return Ok(false);
    }
    let manifest = Manifest::read(folder)?;
    let own = own_name(folder);
    let is_own = |of: &String| {
        own.as_ref()
            .is_some_and(|own| *own == format!("{of}{ASIDE}"))
    };
    Ok(manifest.is_some_and(|found| {
        found.kind == kind
            && found.state == State::SetAside
            && found.aside_of.as_ref().is_some_and(is_own)
    }))
}

/// The name of a folder at the end of all links.
fn own_name(folder: &Path) -> Option<String> {
    let real = folder.canonicalize().ok()?;
    Some(real.file_name()?.to_string_lossy().into_owned())
}

/// Removes a result that was set aside. Files of others in its folder remain.
fn remove_set_aside(kept: &Path, kind: &'static str) -> Result<Replaced, OutputError> {
    let folder = OwnedFolder::lock(kept, kind, &[])?;
    folder.clear()?;
    let removed = fs::remove_dir(kept);
    Ok(match removed {
        Ok(()) => Replaced::Whole,
        Err(_) => Replaced::KeptIn(kept.to_owned()),
    })
}

/// The nearest folder above a path that contains a result.
fn holder_of(path: &Path) -> Result<Option<PathBuf>, OutputError> {
    let absolute = std::path::absolute(path);
    let absolute = absolute.map_err(|source| OutputError::not_opened(path, source))?;
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
    entries(&folder, &format!("{name}/")).map_err(|source| OutputError::not_opened(&folder, source))
}
