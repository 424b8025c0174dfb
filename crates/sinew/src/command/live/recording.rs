//! `sinew live --record`.

use std::path::{Path, PathBuf};

use sinew_record::{Ended, Request, RunFolder};
use sinew_scene::Scene;
use sinew_scene::output::{Tenant, complain};
use sinew_session::{Log, Replay};

use crate::command::Failure;
use crate::command::interruption::Interruption;
use crate::command::run::replay::{in_folder, warnings_of};

/// The folders of a session. What a folder holds depends on all of the session, the intervals of its rows among it, so that the session is repeated by
/// its log when it has ended: the folders are those of `sinew run --replay`, and recording takes no time from the hand.
pub(super) struct Recording {
    /// A folder for each pane.
    folders: [PathBuf; 2],
    scene: Scene,
    /// Values that the command line set in the scene.
    values: Vec<String>,
}

impl Recording {
    /// Checks that the folders may be written.
    pub(super) fn new(path: &Path, scene: Scene, values: Vec<String>) -> Result<Self, Failure> {
        let mut second = path.components().as_path().to_owned().into_os_string();
        second.push("-second");
        let folders = [path.to_owned(), PathBuf::from(second)];
        for folder in &folders {
            if RunFolder::check(folder, &scene)? == Tenant::Earlier {
                let path = folder.display();
                complain(&format!(
                    "{path}: the results of an earlier run in it will be replaced"
                ));
            }
        }
        Ok(Self {
            folders,
            scene,
            values,
        })
    }

    /// Repeats the session of each pane into its folder.
    pub(super) fn write(self, logs: Vec<Log>, interruption: &Interruption) -> Result<(), Failure> {
        for (path, log) in self.folders.iter().zip(logs) {
            complain(&format!("recording into {}", path.display()));
            let failed = |source| Failure::Replay {
                log: path.to_owned(),
                source: Box::new(source),
            };
            let mut replay = Replay::new(self.scene.clone(), log).map_err(failed)?;
            let request = Request {
                threads: None,
                warnings: warnings_of(&replay),
                values: self.values.clone(),
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
        }
        Ok(())
    }
}
