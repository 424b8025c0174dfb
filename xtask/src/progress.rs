//! A progress bar, shown on terminals only.

use indicatif::{ProgressBar, ProgressStyle};
use sinew_bench::Progress;

/// A bar that follows a bench. Hidden where standard error is no terminal.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::new(0);
        let style = ProgressStyle::with_template("{bar:30} {pos}/{len} {msg} ({elapsed})");
        if let Ok(style) = style {
            bar.set_style(style);
        }
        Self(bar)
    }

    pub(crate) fn show(&self, progress: Progress) {
        match progress {
            Progress::Reference { scene } => {
                self.0
                    .set_message(format!("reference of {}", scene.display()));
            }
            Progress::Run { done, of, what } => {
                self.0.set_length(of as u64);
                self.0.set_position(done as u64);
                self.0.set_message(what);
            }
        }
    }

    pub(crate) fn finish(&self) {
        self.0.finish_and_clear();
    }
}
