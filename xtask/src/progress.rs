//! A progress bar, shown on terminals only.

use indicatif::{ProgressBar, ProgressStyle};
use sinew_verify::Progress;

/// A bar that follows a bench. Hidden if standard error is no terminal.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    pub(crate) fn new() -> Self {
        // Nothing of an unknown number is an empty bar; nothing of none would be a full one.
        let bar = ProgressBar::no_length();
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

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn a_bar_starts_empty_and_fills_with_the_runs() {
        let bar = Bar::new();
        let share = || {
            let mut share = f32::NAN;
            bar.0.update(|state| share = state.fraction());
            share
        };
        assert_eq!(share(), 0.0);
        let scene = PathBuf::from("a.toml");
        bar.show(Progress::Reference { scene });
        assert_eq!(share(), 0.0);
        let run = |done| Progress::Run {
            done,
            of: 8,
            what: String::new(),
        };
        bar.show(run(0));
        assert_eq!(share(), 0.0);
        bar.show(run(6));
        assert_eq!(share(), 0.75);
    }
}
