//! The address of a page.

use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr, TcpListener};

use crate::error::LiveError;
use crate::server::Token;

/// A port of this computer and a secret. A start page and sessions use it one after the other, so that a browser
/// finds all of them at the same address; between them its requests wait.
#[derive(Debug)]
pub struct Door {
    listener: TcpListener,
    address: SocketAddr,
    token: Token,
}

impl Door {
    /// Listens to a port of this computer; 0 for a free one.
    ///
    /// # Errors
    /// [`LiveError`] for a port that cannot be listened to.
    pub fn open(port: u16) -> Result<Self, LiveError> {
        let token = Token::random().map_err(LiveError::Random)?;
        let listener =
            TcpListener::bind((Ipv4Addr::LOCALHOST, port)).map_err(|source| {
                match source.kind() {
                    ErrorKind::AddrInUse => LiveError::PortTaken { port },
                    _ => LiveError::Listen { port, source },
                }
            })?;
        listener.set_nonblocking(true).map_err(LiveError::Serve)?;
        let address = listener.local_addr().map_err(LiveError::Serve)?;
        Ok(Self {
            listener,
            address,
            token,
        })
    }

    /// The address of the page, with its secret.
    #[must_use]
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.token)
    }

    pub(crate) fn token(&self) -> Token {
        self.token.clone()
    }

    /// A handle to the listener.
    pub(crate) fn listener(&self) -> io::Result<TcpListener> {
        self.listener.try_clone()
    }
}
