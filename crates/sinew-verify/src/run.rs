//! The course of a verification.

use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use crate::check::Check;
use crate::error::LabError;
use crate::inputs::Inputs;
use crate::machine::Machine;
use crate::progress::Progress;
use crate::results::{SCHEMA, Verification, VerifiedRow, VerifiedSubject};
use crate::subject::Subject;
use crate::subjects::SUBJECTS;
use crate::verdict::MarkVerdict;

/// A verification to be run.
#[derive(Clone, Debug)]
pub struct VerifyPlan {
    /// Root of the repository, whose meshes and scenes checks read.
    pub root: PathBuf,
    /// Subjects by their short names; all if it is empty.
    pub only: Vec<String>,
    /// True if rows that take long are also run.
    pub long: bool,
    /// Checks that run at the same time.
    pub threads: usize,
}

/// A subject that does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no subject {name:?}; the subjects are {known}")]
pub struct UnknownSubject {
    /// The requested name.
    pub name: String,
    /// All names.
    pub known: String,
}

impl VerifyPlan {
    /// Checks everything that was requested. A figure that cannot be computed is a row that fails, with its reason.
    ///
    /// # Errors
    /// [`UnknownSubject`], before anything is computed.
    pub fn run(
        &self,
        revision: String,
        machine: Machine,
        progress: impl FnMut(Progress) + Send,
    ) -> Result<Verification, UnknownSubject> {
        self.run_on(SUBJECTS, revision, machine, progress)
    }

    /// [`VerifyPlan::run`] with these subjects in place of all.
    pub(crate) fn run_on(
        &self,
        subjects: &[Subject],
        revision: String,
        machine: Machine,
        progress: impl FnMut(Progress) + Send,
    ) -> Result<Verification, UnknownSubject> {
        if let Some(name) = self
            .only
            .iter()
            .find(|name| !subjects.iter().any(|subject| subject.id == **name))
        {
            let known: Vec<&str> = subjects.iter().map(|subject| subject.id).collect();
            return Err(UnknownSubject {
                name: name.clone(),
                known: known.join(", "),
            });
        }
        let is_asked = |subject: &&Subject| {
            self.only.is_empty() || self.only.iter().any(|id| id == subject.id)
        };
        let subjects: Vec<&Subject> = subjects.iter().filter(is_asked).collect();
        let (mut checks, mut left_out) = (Vec::new(), 0);
        for (number, subject) in subjects.iter().enumerate() {
            for check in (subject.checks)() {
                if self.long || !check.is_long {
                    checks.push((number, check));
                } else {
                    left_out += check.figures.len();
                }
            }
        }
        let rows = self.rows(&subjects, &checks, progress);
        let mut verified: Vec<VerifiedSubject> = subjects
            .iter()
            .map(|subject| VerifiedSubject {
                id: subject.id,
                title: subject.title,
                says: subject.says,
                rows: Vec::new(),
                quoted: subject.quoted,
            })
            .collect();
        for ((subject, _), rows) in checks.iter().zip(rows) {
            verified[*subject].rows.extend(rows);
        }
        Ok(Verification {
            schema: SCHEMA,
            revision,
            machine,
            subjects: verified,
            left_out,
        })
    }

    /// The rows of each check, computed on several threads and in the order of the checks.
    fn rows(
        &self,
        subjects: &[&Subject],
        checks: &[(usize, Check)],
        progress: impl FnMut(Progress) + Send,
    ) -> Vec<Vec<VerifiedRow>> {
        let inputs = Inputs {
            root: self.root.clone(),
        };
        let next = AtomicUsize::new(0);
        let progress = Mutex::new(progress);
        let work = || {
            let mut done = Vec::new();
            loop {
                let number = next.fetch_add(1, Ordering::Relaxed);
                let Some((subject, check)) = checks.get(number) else {
                    return done;
                };
                if let Ok(mut progress) = progress.lock() {
                    progress(Progress::Run {
                        done: number,
                        of: checks.len(),
                        what: format!("{}: {}", subjects[*subject].id, check.case),
                    });
                }
                done.push((number, verified(check, &inputs)));
            }
        };
        let mut all: Vec<(usize, Vec<VerifiedRow>)> = std::thread::scope(|scope| {
            let workers: Vec<_> = (1..self.threads).map(|_| scope.spawn(work)).collect();
            let mut all = work();
            for worker in workers {
                match worker.join() {
                    Ok(done) => all.extend(done),
                    Err(panic) => std::panic::resume_unwind(panic),
                }
            }
            all
        });
        all.sort_unstable_by_key(|(number, _)| *number);
        all.into_iter().map(|(_, rows)| rows).collect()
    }
}

/// The rows of a check.
fn verified(check: &Check, inputs: &Inputs) -> Vec<VerifiedRow> {
    let start = Instant::now();
    let asked = check.figures.len();
    let computed = (check.compute)(inputs).and_then(|figures| match figures.len() == asked {
        true => Ok(figures),
        false => Err(LabError::new(format!(
            "{} figures were computed, {asked} are asked for",
            figures.len()
        ))),
    });
    let seconds = start.elapsed().as_secs_f64();
    let row = |(number, (figure, asked)): (usize, &(String, _))| {
        let asked: crate::check::Asked = *asked;
        let got = computed.as_ref().map(|figures| figures[number]);
        let passes = got.is_ok_and(|got| asked.passes(got));
        let missing = match &got {
            Ok(got) if got.is_finite() => None,
            Ok(got) => Some(format!("{got}: it is not a finite number")),
            Err(error) => Some(error.to_string()),
        };
        VerifiedRow {
            case: check.case.clone(),
            figure: figure.clone(),
            asked,
            got: got.ok().filter(|got| got.is_finite()),
            missing,
            source: check.source,
            verdict: if passes {
                MarkVerdict::Pass
            } else {
                MarkVerdict::Fail
            },
            note: check.note,
            seconds,
        }
    };
    check.figures.iter().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;
    use crate::check::{Asked, Source};

    const SOURCE: Source = Source::ClosedForm("two and two");

    fn checks() -> Vec<Check> {
        let four = |asked| Check::one("2 + 2", "sum", asked, SOURCE, |_| Ok(4.0));
        let two = [("a", Asked::value(1.0, 0.0)), ("b", Asked::value(1.0, 0.0))];
        vec![
            four(Asked::value(4.0, 0.0)),
            four(Asked::value(4.1, 0.05)),
            four(Asked::at_most(3.9)),
            four(Asked::at_least(4.0)),
            Check::one(
                "0/0",
                "ratio",
                Asked::value(1.0, f64::INFINITY),
                SOURCE,
                |_| Ok(f64::NAN),
            ),
            Check::one("a file", "size", Asked::at_least(0.0), SOURCE, |inputs| {
                Ok(inputs.mesh("no-such-mesh")?.tets.len() as f64)
            }),
            Check::several("two figures", two, SOURCE, |_| Ok(vec![1.0])),
            four(Asked::at_most(0.0)).long(true),
        ]
    }

    fn verified_with(long: bool, threads: usize) -> Verification {
        let subject = Subject {
            id: "sums",
            title: "Sums",
            says: "",
            checks,
            quoted: &[],
        };
        let plan = VerifyPlan {
            root: PathBuf::from("no-such-folder"),
            only: Vec::new(),
            long,
            threads,
        };
        plan.run_on(&[subject], "r".into(), Machine::default(), |_| {})
            .unwrap()
    }

    #[test]
    fn wrong_figures_and_those_that_cannot_be_computed_fail_with_what_was_asked() {
        let verification = verified_with(false, 3);
        let verdicts: Vec<bool> = verification
            .rows()
            .map(|(_, row)| row.verdict == MarkVerdict::Pass)
            .collect();
        assert_eq!(
            verdicts,
            [true, false, false, true, false, false, false, false]
        );
        assert_eq!(verification.left_out, 1);
        let text = verification.brief();
        for told in [
            "FAIL sums: 2 + 2: sum: asked 4.1 +- 0.05, got 4",
            "asked at most 3.9, got 4",
            "got NaN: it is not a finite number",
            "no-such-mesh.msh",
            "got 1 figures were computed, 2 are asked for",
            "6 of 8 rows fail; 1 that take long are left out (--long)",
        ] {
            assert!(text.contains(told), "{told} is not in\n{text}");
        }
        assert!(verification.html().contains("id=\"failures\""));
    }

    #[test]
    fn long_rows_run_on_demand() {
        let verification = verified_with(true, 1);
        assert_eq!((verification.rows().count(), verification.left_out), (9, 0));
    }

    #[test]
    fn no_two_rows_have_the_same_name_and_none_asks_for_nothing() {
        let (mut ids, mut names) = (HashSet::new(), HashSet::new());
        for subject in SUBJECTS {
            assert!(ids.insert(subject.id), "{}", subject.id);
            for check in (subject.checks)() {
                for (figure, asked) in &check.figures {
                    let name = format!("{}: {}: {figure}, {asked:?}", subject.id, check.case);
                    assert!(!asked.passes(f64::NAN), "{name}");
                    assert!(names.insert(name.clone()), "{name}");
                }
            }
        }
    }
}
