//! The scenes that a start page offers.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;

/// A scene that a start page offers.
#[derive(Clone, Debug, Serialize)]
pub struct Offer {
    /// Its name, of letters, digits and hyphens.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The heading under which it is shown; scenes of one heading follow each other.
    pub group: String,
    /// Description of the scene.
    pub about: String,
    /// Its method and its step.
    pub method: String,
    /// Description of the picture, for those who do not see it.
    pub alt: String,
    /// The picture, a PNG file.
    #[serde(skip)]
    pub picture: &'static [u8],
}

/// The pace of a scene on this computer: simulated time over the time that it takes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "pace", content = "factor", rename_all = "snake_case")]
pub enum Pace {
    /// It is measured later.
    Waits,
    /// It is measured now.
    Runs,
    /// The measured factor; more than 1 is faster than real time.
    Measured(f64),
    /// The scene could not be simulated for as long as a measurement needs.
    Unknown,
}

/// The offers of a start page with what is known of them. Their paces stay known from one start page to the next.
#[derive(Debug)]
pub struct Offers {
    offers: Vec<Offer>,
    paces: Mutex<Vec<Pace>>,
    /// A sentence that the page shows, such as why a scene could not be opened.
    notice: Mutex<Option<String>>,
}

impl Offers {
    /// Offers without paces.
    #[must_use]
    pub fn new(offers: Vec<Offer>) -> Self {
        let paces = vec![Pace::Waits; offers.len()];
        Self {
            offers,
            paces: Mutex::new(paces),
            notice: Mutex::default(),
        }
    }

    /// Sets the sentence that the next start page shows.
    pub fn set_notice(&self, notice: Option<String>) {
        *self.notice.lock().unwrap_or_else(PoisonError::into_inner) = notice;
    }

    /// The first scene without a measured pace.
    pub(crate) fn unmeasured(&self) -> Option<usize> {
        let is_open = |pace: &Pace| matches!(pace, Pace::Waits | Pace::Runs);
        self.paces().iter().position(is_open)
    }

    pub(crate) fn set_pace(&self, index: usize, pace: Pace) {
        if let Some(own) = self.paces().get_mut(index) {
            *own = pace;
        }
    }

    fn paces(&self) -> MutexGuard<'_, Vec<Pace>> {
        self.paces.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The answer to a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// The scene opens.
    Taken,
    /// Another scene was chosen before.
    Late,
    /// No scene has this name.
    Unknown,
}

/// Data that a start page's server shares with the program: the offers and the choice.
#[derive(Debug)]
pub(crate) struct Counter {
    offers: Arc<Offers>,
    chosen: Mutex<Option<usize>>,
}

/// An offer with its pace, as the page receives it.
#[derive(Serialize)]
struct Shown<'a> {
    #[serde(flatten)]
    offer: &'a Offer,
    #[serde(flatten)]
    pace: Pace,
}

/// The state of a start page.
#[derive(Serialize)]
struct State<'a> {
    page: &'static str,
    version: &'static str,
    notice: Option<String>,
    /// The title of the chosen scene.
    chosen: Option<&'a str>,
    offers: Vec<Shown<'a>>,
}

impl Counter {
    pub(crate) fn new(offers: Arc<Offers>) -> Self {
        Self {
            offers,
            chosen: Mutex::default(),
        }
    }

    /// Chooses a scene by its name; the first choice holds.
    pub(crate) fn choose(&self, name: &str) -> Choice {
        let mut offers = self.offers.offers.iter();
        let Some(index) = offers.position(|offer| offer.name == name) else {
            return Choice::Unknown;
        };
        let mut chosen = self.chosen.lock().unwrap_or_else(PoisonError::into_inner);
        match *chosen {
            Some(other) if other != index => Choice::Late,
            _ => {
                *chosen = Some(index);
                Choice::Taken
            }
        }
    }

    /// The chosen scene.
    pub(crate) fn chosen(&self) -> Option<usize> {
        *self.chosen.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The picture of the scene of this name.
    pub(crate) fn picture(&self, name: &str) -> Option<&'static [u8]> {
        let mut offers = self.offers.offers.iter();
        let offer = offers.find(|offer| offer.name == name)?;
        Some(offer.picture)
    }

    /// The state, as the page reads it.
    pub(crate) fn to_json(&self) -> String {
        let notice = self.offers.notice.lock();
        let paces = self.offers.paces().clone();
        let shown = self.offers.offers.iter().zip(paces);
        let state = State {
            page: "start",
            version: env!("CARGO_PKG_VERSION"),
            notice: notice.unwrap_or_else(PoisonError::into_inner).clone(),
            chosen: self
                .chosen()
                .map(|index| self.offers.offers[index].title.as_str()),
            offers: shown.map(|(offer, pace)| Shown { offer, pace }).collect(),
        };
        serde_json::to_string(&state).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn offer(name: &str) -> Offer {
        Offer {
            name: name.to_owned(),
            title: format!("a {name}"),
            group: String::new(),
            about: String::new(),
            method: String::new(),
            alt: String::new(),
            picture: b"png",
        }
    }

    #[test]
    fn the_first_choice_holds_and_unknown_names_choose_nothing() {
        let offers = Arc::new(Offers::new(vec![offer("cube"), offer("organ")]));
        let counter = Counter::new(Arc::clone(&offers));
        for name in ["", "CUBE", "cube.png", "cube\n"] {
            assert_eq!(counter.choose(name), Choice::Unknown, "{name:?}");
        }
        assert_eq!(counter.chosen(), None);
        assert_eq!(counter.choose("organ"), Choice::Taken);
        assert_eq!(counter.choose("organ"), Choice::Taken);
        assert_eq!(counter.choose("cube"), Choice::Late);
        assert_eq!(counter.chosen(), Some(1));
        // The next start page begins without a choice.
        assert_eq!(Counter::new(offers).chosen(), None);
    }

    #[test]
    fn a_page_reads_paces_as_they_are_measured() {
        let offers = Arc::new(Offers::new(vec![offer("cube"), offer("organ")]));
        offers.set_pace(0, Pace::Measured(2.5));
        offers.set_pace(1, Pace::Runs);
        offers.set_pace(2, Pace::Unknown);
        assert_eq!(offers.unmeasured(), Some(1));
        let state = Counter::new(offers).to_json();
        let state: serde_json::Value = serde_json::from_str(&state).unwrap();
        assert_eq!(state["page"], "start");
        assert_eq!(state["offers"][0]["pace"], "measured");
        assert_eq!(state["offers"][0]["factor"], 2.5);
        assert_eq!(state["offers"][1]["pace"], "runs");
    }
}
