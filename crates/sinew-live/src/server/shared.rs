//! Data shared by the server and the simulation.

use std::sync::{Arc, Mutex, PoisonError};

use crate::clients::Clients;
use crate::inbox::Inbox;
use crate::protocol::{Event, Scenery};

/// Data that connections share with the simulation.
#[derive(Debug)]
pub(crate) struct Shared {
    /// The queue of commands.
    pub(crate) inbox: Inbox,
    /// The connected pages, which receive pictures.
    pub(crate) clients: Clients,
    scenery: Mutex<Scenery>,
    integrators: Mutex<Option<Arc<Event>>>,
}

impl Shared {
    /// Shared data without pages.
    pub(crate) fn new(scenery: Scenery) -> Self {
        Self {
            inbox: Inbox::default(),
            clients: Clients::default(),
            scenery: Mutex::new(scenery),
            integrators: Mutex::default(),
        }
    }

    /// The scenery, which a page receives first.
    pub(crate) fn scenery(&self) -> Scenery {
        let scenery = self.scenery.lock();
        scenery.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// True if there is a tool with this number.
    pub(crate) fn has_tool(&self, tool: usize) -> bool {
        let scenery = self.scenery.lock();
        tool < scenery.unwrap_or_else(PoisonError::into_inner).tools.len()
    }

    /// Sends a changed scenery to all pages, and to those that connect later.
    pub(crate) fn tell_of_scenery(&self, scenery: Scenery) {
        let own = self.scenery.lock();
        *own.unwrap_or_else(PoisonError::into_inner) = scenery.clone();
        self.clients.tell_all(&Event::Scenery(Box::new(scenery)));
    }

    /// The event about the integrators, if they are known.
    pub(crate) fn integrators(&self) -> Option<Arc<Event>> {
        let known = self.integrators.lock();
        known.unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Sends the integrators to all pages, and to those that connect later.
    pub(crate) fn tell_of_integrators(&self, event: Event) {
        let event = Arc::new(event);
        let known = self.integrators.lock();
        *known.unwrap_or_else(PoisonError::into_inner) = Some(Arc::clone(&event));
        self.clients.tell_all(&event);
    }
}
