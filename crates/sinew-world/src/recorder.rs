//! Recorders, which observe a world in motion.

use std::sync::Arc;

use sinew_core::{Inputs, Moment, RecordError, RecordedSteps, State, StepReport, Verdict};
use sinew_scene::{ProbeCsv, SceneBody};

/// A recorder that is notified of changes of the body.
pub trait Recorder: sinew_core::Recorder {
    /// Continues with another body, or with loads that follow inputs.
    ///
    /// # Errors
    /// [`RecordError`] ends the motion.
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        let _ = change;
        Ok(())
    }
}

/// A recorder that requests no states.
impl Recorder for () {}

/// A recorder that requests every state.
impl<F> Recorder for F where F: FnMut(&Moment<'_>) -> Result<Verdict, RecordError> {}

impl Recorder for ProbeCsv {
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        self.change_body(change.body);
        Ok(())
    }
}

/// A change of the body between two steps.
#[derive(Clone, Copy)]
pub struct BodyChange<'a> {
    /// The body from now on.
    pub body: &'a Arc<SceneBody>,
    /// Inputs from outside.
    pub inputs: &'a Inputs,
    /// The cut; `None` if the only change is that loads follow inputs from now on, which does not change forces yet.
    pub cut: Option<&'a BodyCut>,
    /// Steps taken before it, as the recorder counts them.
    pub steps: usize,
    /// Work of these steps.
    pub work: StepReport,
}

/// A body that was cut between two steps.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyCut {
    /// The state before the cut.
    pub before: State,
    /// The state after it, before the step.
    pub after: State,
    /// The energy (J) that it added.
    pub energy: f64,
}

/// A recorder and the steps it has received: it receives one motion, for any number of calls that take the steps.
pub struct Shown<'r, R: Recorder + ?Sized> {
    pub(crate) steps: RecordedSteps<'r, R>,
    pub(crate) body: Arc<SceneBody>,
}

impl<R: Recorder + ?Sized> Shown<'_, R> {
    /// Number of steps that it has received.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.steps.steps()
    }

    /// Work of the steps that were taken since it was begun here.
    #[must_use]
    pub fn work(&self) -> StepReport {
        self.steps.work()
    }

    /// The recorder.
    pub fn recorder(&mut self) -> &mut R {
        self.steps.recorder()
    }

    /// Notifies the recorder of a body that differs from the last one it received.
    pub(crate) fn follow(
        &mut self,
        body: &Arc<SceneBody>,
        inputs: &Inputs,
        cut: Option<&BodyCut>,
    ) -> Result<(), RecordError> {
        if Arc::ptr_eq(&self.body, body) {
            return Ok(());
        }
        self.body = Arc::clone(body);
        let change = BodyChange {
            body,
            inputs,
            cut,
            steps: self.steps(),
            work: self.work(),
        };
        self.recorder().body_changed(&change)?;
        self.steps.watch_again();
        Ok(())
    }
}

/// Several recorders as one: each receives the states that it requests; if one stops, all stop.
#[derive(Default)]
pub struct Recorders<'a> {
    list: Vec<Member<'a>>,
}

struct Member<'a> {
    recorder: &'a mut dyn Recorder,
    /// The next step that it requests.
    next: Option<usize>,
    /// Number of degrees of freedom that it watches.
    watched: usize,
}

impl<'a> Recorders<'a> {
    /// A list without recorders.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a recorder.
    #[must_use]
    pub fn with(mut self, recorder: &'a mut dyn Recorder) -> Self {
        self.list.push(Member {
            watched: recorder.watches().len(),
            recorder,
            next: None,
        });
        self
    }
}

impl sinew_core::Recorder for Recorders<'_> {
    fn next(&mut self, step: usize) -> Option<usize> {
        for member in &mut self.list {
            member.next = member.recorder.next(step);
        }
        self.list.iter().filter_map(|member| member.next).min()
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        let soonest = self.list.iter().filter_map(|member| member.next).min();
        let mut verdict = Verdict::Continue;
        for member in &mut self.list {
            if member.next == soonest && member.recorder.record(moment)? == Verdict::Stop {
                verdict = Verdict::Stop;
            }
        }
        Ok(verdict)
    }

    fn watches(&self) -> Vec<u32> {
        let lists = self.list.iter().map(|member| member.recorder.watches());
        lists.flatten().collect()
    }

    fn watched(&mut self, t: f64, u: &[f64]) -> Result<Verdict, RecordError> {
        let (mut verdict, mut rest) = (Verdict::Continue, u);
        for member in &mut self.list {
            let (own, others) = rest.split_at(member.watched);
            // Alone it would not be called either.
            if !own.is_empty() && member.recorder.watched(t, own)? == Verdict::Stop {
                verdict = Verdict::Stop;
            }
            rest = others;
        }
        Ok(verdict)
    }
}

impl Recorder for Recorders<'_> {
    fn body_changed(&mut self, change: &BodyChange<'_>) -> Result<(), RecordError> {
        for member in &mut self.list {
            member.recorder.body_changed(change)?;
            member.watched = member.recorder.watches().len();
        }
        Ok(())
    }
}
