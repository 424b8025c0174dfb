//! Errors of the live page.

use std::path::PathBuf;

use sinew_core::OptionError;
use sinew_scene::SceneError;
use sinew_world::{CommandError, WorldError};

/// A page that cannot be served, or a scene that cannot be simulated.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The scene cannot be used.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The scene cannot be simulated.
    #[error(transparent)]
    World(#[from] WorldError),
    /// An integrator or a step of a pane is refused.
    #[error(transparent)]
    Command(#[from] CommandError),
    /// An integrator that does not exist, or an option that it does not have.
    #[error(transparent)]
    Option(#[from] OptionError),
    /// A file of the scene that changed while the page was open.
    #[error(
        "{path} has changed since this page was opened, so that its body would be another one: end `sinew live` and start it again",
        path = .path.display()
    )]
    Changed {
        /// The file.
        path: PathBuf,
    },
    /// A scene without a body.
    #[error("a single mass has no surface to show; `sinew run` writes its motion")]
    NoBody,
    /// A port that another program listens to.
    #[error("port {port} of this computer is taken; --port 0 takes a free one")]
    PortTaken {
        /// The port.
        port: u16,
    },
    /// A port that cannot be listened to.
    #[error("cannot listen to port {port} of this computer: {source}; --port 0 takes a free one")]
    Listen {
        /// The port.
        port: u16,
        /// Error of the system.
        source: std::io::Error,
    },
    /// An order that was still being carried out when the session was to end.
    #[error(
        "a request of the page was still in preparation {seconds} s after the end of the session: it was dropped"
    )]
    Busy {
        /// Time limit (s).
        seconds: u64,
    },
    /// No random numbers for the address of the page.
    #[error("the system gives no random numbers for the page's address: {0}")]
    Random(getrandom::Error),
    /// A thread or a timer that the system refuses.
    #[error("cannot begin to serve: {0}")]
    Serve(std::io::Error),
    /// A simulation that ended by a fault of this program.
    #[error(
        "the simulation ended by an internal error; please report it with the steps that led to it"
    )]
    Simulation,
}

impl LiveError {
    /// True if the request itself cannot be served, as opposed to a failure of this computer.
    #[must_use]
    pub fn is_refusal(&self) -> bool {
        !matches!(
            self,
            Self::Random(_) | Self::Serve(_) | Self::Simulation | Self::Busy { .. }
        )
    }
}
