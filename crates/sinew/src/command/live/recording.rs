//! `sinew live --record`.

use std::path::{Path, PathBuf};

use sinew_record::{Ended, Request};
use sinew_scene::Scene;
use sinew_scene::output::complain;
use sinew_world::{Journal, Log, Replay};

use crate::command::Failure;
use crate::command::interruption::Interruption;
use crate::command::run::check_folder;
use crate::command::run::replay::{in_folder, warnings_of};

/// The folders of a session. The content of a folder, such as the intervals of its rows, depends on the whole session,
/// so the session is replayed by its log when it has ended: the folders are those of `sinew run --replay`, and
/// recording takes no time from the user.
pub(super) struct Recording {
    /// A folder for each pane.
    folders: [PathBuf; 2],
}

impl Recording {
    /// Checks that the folders may be written.
    pub(super) fn new(path: &Path, scene: &Scene) -> Result<Self, Failure> {
        let mut second = path.components().as_path().to_owned().into_os_string();
        second.push("-second");
        let folders = [path.to_owned(), PathBuf::from(second)];
        for folder in &folders {
            check_folder(folder, scene, None, false)?;
        }
        Ok(Self { folders })
    }

    /// Creates the files for the commands of the panes during the session.
    pub(super) fn journals(&self) -> Result<Vec<Journal>, Failure> {
        let mut journals = Vec::new();
        for folder in &self.folders {
            if let Some(parent) = folder.parent() {
                // What fails here fails below, too.
                let _ = std::fs::create_dir_all(parent);
            }
            match Journal::create(log_beside(folder)) {
                Ok(journal) => journals.push(journal),
                Err(error) => {
                    journals.iter().for_each(|journal| remove(journal.path()));
                    return Err(error.into());
                }
            }
        }
        Ok(journals)
    }

    /// Removes the files of the commands of a session that was not begun.
    pub(super) fn remove_journals(&self) {
        self.folders
            .iter()
            .for_each(|folder| remove(&log_beside(folder)));
    }

    /// Prints the place of the commands of a session that ended without its folders.
    pub(super) fn name_journals(&self) {
        for beside in self.folders.iter().map(|folder| log_beside(folder)) {
            if std::fs::metadata(&beside).is_ok_and(|found| found.len() > 0) {
                complain(&where_commands_are(&beside, true));
            }
        }
    }

    /// Replays the session of each pane into its folder, which contains its log from then on. If this fails, the log
    /// stays next to its folder.
    pub(super) fn write(
        self,
        session: sinew_live::Ended,
        interruption: &Interruption,
    ) -> Result<(), Failure> {
        for error in &session.unkept {
            complain(&format!("warning: {error}"));
        }
        let mut outcome = Ok(());
        let mut logs = session.logs.into_iter();
        for path in &self.folders {
            let beside = log_beside(path);
            // The second pane may be gone.
            let Some(log) = logs.next() else {
                remove(&beside);
                continue;
            };
            let scene = (session.scene.clone(), session.values.clone());
            let is_over = matches!(outcome, Err(Failure::Interrupted { .. }));
            let recorded = (!is_over).then(|| record(path, scene, log, interruption));
            // Of an interrupted recording the folder holds the log.
            if let Some(Ok(()) | Err(Failure::Interrupted { .. })) = recorded {
                remove(&beside);
            } else {
                let is_whole = session.unkept.iter().all(|error| error.path() != beside);
                complain(&where_commands_are(&beside, is_whole));
            }
            outcome = outcome.and(recorded.unwrap_or(Ok(())));
        }
        outcome
    }
}

/// A message with the place of the commands of a session that was not recorded; `is_whole` if the file has all of
/// them.
fn where_commands_are(beside: &Path, is_whole: bool) -> String {
    let path = beside.display();
    match is_whole {
        true => format!("the commands are in {path}: `sinew run SCENE --replay` repeats them"),
        false => format!(
            "{path} holds the first commands, as far as they could be written: `sinew run SCENE --replay` repeats those"
        ),
    }
}

/// Repeats the session of a pane into its folder.
fn record(
    path: &Path,
    (scene, values): (Scene, Vec<String>),
    log: Log,
    interruption: &Interruption,
) -> Result<(), Failure> {
    complain(&format!("recording into {}", path.display()));
    let mut replay = Replay::new(scene, log).map_err(|source| Failure::Replay {
        log: log_beside(path),
        source: Box::new(source),
    })?;
    let request = Request {
        threads: None,
        warnings: warnings_of(&replay),
        values,
        again: false,
    };
    match in_folder(path, &mut replay, &request, interruption.clone())? {
        Ended::Finished => {}
        Ended::Diverged { t, place } => complain(&format!(
            "the motion diverged at t = {t:.6} s: {place} is too far away"
        )),
        Ended::Refused { t, reason } => {
            complain(&format!("the motion ended at t = {t:.6} s: {reason}"));
        }
        Ended::Interrupted { t } => {
            let log = path.join("session.log");
            let remedy = format!(
                "; `sinew run SCENE --replay {} --out DIR` records the session as a whole",
                log.display()
            );
            return Err(Failure::Interrupted { t, remedy });
        }
    }
    Ok(())
}

/// Path of the log of a session until its folder contains the log.
fn log_beside(folder: &Path) -> PathBuf {
    let mut path = folder.components().as_path().to_owned().into_os_string();
    path.push(".session.log");
    PathBuf::from(path)
}

/// Removes a file of this program.
fn remove(path: &Path) {
    // One that stays costs disk space, and nothing else.
    let _ = std::fs::remove_file(path);
}
