//! The progress of a run on a terminal, and its interruption.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use sinew_core::{Moment, RecordError, Verdict};
use sinew_record::{Companion, Pace};

use sinew_world::Recorder;

use super::interruption::Interruption;

/// Time between two updates of the display.
const REFRESH: Duration = Duration::from_millis(100);

/// Shows the progress of a run and ends it on request. The bar is hidden if standard error is no terminal.
pub(crate) struct Onlooker {
    interruption: Interruption,
    bar: ProgressBar,
    duration: f64,
    begun: Instant,
    /// Time (s) of the motion at which this process began; `None` before the first report.
    from: Option<f64>,
    shown: Instant,
    /// Pace of runs that are not divided into batches elsewhere.
    pace: Pace,
}

impl Onlooker {
    /// Onlooker for a run of `steps` steps over `duration` (s).
    pub(crate) fn new(interruption: Interruption, steps: usize, duration: f64) -> Self {
        let bar = ProgressBar::new(steps as u64);
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} % {msg} {eta} left");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        let now = Instant::now();
        Self {
            interruption,
            bar,
            duration,
            begun: now,
            from: None,
            shown: now,
            pace: Pace::new(0),
        }
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn show(&mut self, steps: usize, t: f64) {
        let from = *self.from.get_or_insert(t);
        if self.shown.elapsed() < REFRESH {
            return;
        }
        self.shown = Instant::now();
        let pace = (t - from) / self.begun.elapsed().as_secs_f64().max(1e-9);
        self.bar.set_position(steps as u64);
        self.bar.set_message(format!(
            "t = {t:.4} of {} s, {pace:.3} times real time,",
            self.duration
        ));
    }
}

impl Companion for Onlooker {
    fn is_interrupted(&self) -> bool {
        self.interruption.is_asked_for()
    }

    fn progress(&mut self, steps: usize, t: f64) {
        self.show(steps, t);
    }
}

/// For use together with a recorder that needs no check of states.
impl sinew_core::Recorder for Onlooker {
    fn next(&mut self, step: usize) -> Option<usize> {
        Some(self.pace.next().max(step))
    }

    fn record(&mut self, moment: &Moment<'_>) -> Result<Verdict, RecordError> {
        self.pace.look(moment.step);
        self.show(moment.step, moment.state.t());
        Ok(match self.is_interrupted() {
            true => Verdict::Stop,
            false => Verdict::Continue,
        })
    }
}

impl Recorder for Onlooker {}
