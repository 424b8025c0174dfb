//! Timing of a page's draws, and of the pictures for them.

use std::time::{Duration, Instant};

/// Time from making a picture until a page can draw it, under heavy load.
const UNDER_WAY: Duration = Duration::from_millis(6);

/// Time between two draws if a page announces none.
const BETWEEN_DRAWS: Duration = Duration::from_millis(16);

/// The next draw of a page. A page that can take two pictures gets one immediately, so that it always has one to
/// draw, and another as late as possible, so that the screen shows the user's latest input; a page that can take a
/// single picture gets only the late one.
#[derive(Debug)]
pub(crate) struct NextDraw {
    /// Time at which the page announced the draw.
    told: Instant,
    /// Time at which the late picture must be made.
    late: Instant,
    has_early: bool,
    has_late: bool,
}

impl NextDraw {
    /// The next draw of a page that draws after a time `wait` from now.
    pub(crate) fn after(wait: Duration) -> Self {
        let told = Instant::now();
        Self {
            told,
            late: told + wait.saturating_sub(UNDER_WAY),
            has_early: false,
            has_late: false,
        }
    }

    /// Time at which the next picture must be made for a page with `takes` credits; a time in the past means
    /// immediately.
    pub(crate) fn due(&self, takes: u32) -> Instant {
        match (self.has_early, self.has_late) {
            (false, false) if takes > 1 => self.told,
            (_, false) => self.late,
            // The page has not announced its draw.
            (_, true) => self.late + BETWEEN_DRAWS,
        }
    }

    /// Records that a picture is made.
    pub(crate) fn take(&mut self) {
        self.has_early = true;
        self.has_late = Instant::now() >= self.late;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE: Duration = Duration::from_secs(60);

    #[test]
    fn one_picture_is_made_at_once_and_one_just_before_the_draw() {
        let mut next = NextDraw::after(MINUTE);
        assert!(next.due(2) <= Instant::now());
        next.take();
        let left = next.due(1) - Instant::now();
        assert!(left < MINUTE && left > MINUTE - 2 * UNDER_WAY, "{left:?}");
    }

    #[test]
    fn the_only_picture_is_made_just_before_the_draw() {
        let next = NextDraw::after(MINUTE);
        assert_eq!(next.due(1), next.late);
    }

    #[test]
    fn a_page_that_tells_of_no_draw_gets_the_next_picture_later() {
        let mut next = NextDraw::after(Duration::ZERO);
        next.take();
        assert_eq!(next.due(2), next.late + BETWEEN_DRAWS);
    }
}
