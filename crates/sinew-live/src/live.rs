//! A scene that a page shows.

use std::net::TcpListener;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use sinew_scene::{Scene, Simulation};
use sinew_world::{Journal, JournalError, World};
use tokio::runtime::Runtime;

use crate::door::Door;
use crate::ended::Ended;
use crate::engine::{Beginning, Engine, Survey};
use crate::error::LiveError;
use crate::pane_choice::PaneChoice;
use crate::picture::Surface;
use crate::scene_values::SceneValues;
use crate::scenery::{Presented, scenery_of};
use crate::server::{Shared, Token, router, runtime, serve};

/// Time between two checks for a request to end.
const LOOK: Duration = Duration::from_millis(50);

/// Time limit for the simulation to end. It ends between steps and orders, and setting up a method may take minutes.
const PATIENCE: Duration = Duration::from_secs(3);

/// Settings of a live session.
#[derive(Debug)]
pub struct Settings {
    /// The scene.
    pub scene: Scene,
    /// Values that were set in its file to get it, as `KEY=VALUE`.
    pub values: Vec<String>,
    /// The initial panes, one or two.
    pub panes: Vec<PaneChoice>,
    /// The second pane, if it is opened later.
    pub second: PaneChoice,
    /// The largest speed (m/s) of tools that the user steers; `None` for a tenth of that of waves in the body.
    pub hand_speed: Option<f64>,
    /// Advice for the user's first moves, if the scene was chosen on a start page: then it begins paused, and its page has
    /// a way back.
    pub from_start: Option<String>,
}

/// A scene with its page, before the page is opened.
pub struct Live {
    runtime: Runtime,
    listener: TcpListener,
    token: Token,
    shared: Arc<Shared>,
    engine: Engine,
    simulation: Arc<Simulation>,
}

impl Live {
    /// Builds the sessions for a page at this address.
    ///
    /// # Errors
    /// [`LiveError`] for a scene that cannot be simulated.
    pub fn open(door: &Door, settings: Settings) -> Result<Self, LiveError> {
        let Settings {
            scene,
            values,
            panes,
            second,
            hand_speed,
            from_start,
        } = settings;
        let runtime = runtime().map_err(LiveError::Serve)?;
        let listener = door.listener().map_err(LiveError::Serve)?;
        let session = World::new(scene.clone())?.with_values(&values);
        let simulation = Arc::clone(session.scene());
        let body = simulation.model().body().ok_or(LiveError::NoBody)?;
        let surface = Surface::of(&body.mesh);
        let presented = Presented {
            title: scene.title().to_owned(),
            hand_speed: hand_speed.unwrap_or_else(|| crate::hand_speed::hand_speed(&body.model)),
            from_start,
        };
        let scenery = scenery_of(&simulation, &[], &presented)?;
        let files = session.log().header().inputs.clone();
        let beginning = Beginning {
            scene: SceneValues::new(scene, values, files),
            panes,
            second,
            scenery: scenery.clone(),
            presented,
        };
        let engine = Engine::new(beginning, session, surface)?;
        let shared = Arc::new(Shared::new(scenery));
        Ok(Self {
            runtime,
            listener,
            token: door.token(),
            shared,
            engine,
            simulation,
        })
    }

    /// The simulation without its page.
    #[cfg(test)]
    pub(crate) fn into_engine(self) -> (Engine, Arc<Shared>) {
        (self.engine, self.shared)
    }

    /// Writes the commands of each pane to a file during the session, so that a killed session can be repeated.
    /// Commands are written within a second.
    ///
    /// # Errors
    /// [`JournalError`] if a file cannot be written.
    pub fn keep_logs(&mut self, journals: Vec<Journal>) -> Result<(), JournalError> {
        self.engine.keep_logs(journals)
    }

    /// Serves the page and simulates until `ends` returns true.
    ///
    /// # Errors
    /// [`LiveError::Serve`] if the system refuses a thread or a connection.
    pub fn run(self, ends: impl Fn() -> bool) -> Result<Ended, LiveError> {
        let Self {
            runtime,
            listener,
            token,
            shared,
            engine,
            simulation,
            ..
        } = self;
        let survey =
            Survey::start(&shared, &simulation, simulation.body()).map_err(LiveError::Serve)?;
        let simulated = {
            let shared = Arc::clone(&shared);
            thread::Builder::new()
                .name("simulation".to_owned())
                .spawn(move || engine.run(&shared, survey))
                .map_err(LiveError::Serve)?
        };
        let router = router(Arc::clone(&shared), token);
        let outcome = serve(&runtime, listener, router, async {
            let mut look = tokio::time::interval(LOOK);
            while !ends() && !simulated.is_finished() {
                look.tick().await;
            }
            // Pages are notified that the connection closes.
            shared.clients.dismiss();
            tokio::time::sleep(LOOK).await;
        });
        shared.inbox.end();
        runtime.shutdown_background();
        let asked = Instant::now();
        while !simulated.is_finished() {
            if asked.elapsed() > PATIENCE {
                return Err(LiveError::Busy {
                    seconds: PATIENCE.as_secs(),
                });
            }
            thread::sleep(LOOK);
        }
        outcome.map_err(LiveError::Serve)?;
        simulated.join().map_err(|_| LiveError::Simulation)
    }
}
