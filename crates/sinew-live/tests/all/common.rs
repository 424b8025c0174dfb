//! A page, with requests like those of a browser.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::Value;
use sinew_live::{Door, Ended, Live, LiveError, PaneChoice, Settings};
use sinew_scene::{Scene, SceneSource};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Error, HandshakeError, Message, WebSocket, client};

/// A cube on its bottom in steps of 2 ms; further tables can follow.
pub(crate) const CUBE: &str = r#"
[run]
duration = 1.0
integrator = "symplectic-euler"
dt = 0.002
[mesh]
cube = { cells = 3, edge = 0.1 }
[[region]]
density = 1060.0
model = "linear"
youngs_modulus = 3500.0
poissons_ratio = 0.3
[damping]
mass = 20.0
[[fixed]]
group = "bottom"
"#;

/// Points of its surface.
pub(crate) const POINTS: usize = 56;

/// Settings for a scene on a free port, whose second pane is the one with any step.
pub(crate) fn settings(text: &str) -> Settings {
    Settings {
        scene: Scene::parse(SceneSource::new("cube.toml", text)).unwrap(),
        values: Vec::new(),
        panes: vec![PaneChoice::default()],
        second: PaneChoice {
            integrator: Some("cnn-stabilised".to_owned()),
            dt: None,
        },
        hand_speed: None,
        from_start: None,
    }
}

/// Offset of the first pane in a picture, and the size of its numbers and of a tool.
pub(crate) const PANE: usize = 32;
pub(crate) const NUMBERS: usize = 240;
pub(crate) const TOOL: usize = 136;

/// A served page, which ends with this value.
pub(crate) struct Page {
    pub(crate) url: String,
    ends: Arc<AtomicBool>,
    server: Option<JoinHandle<Result<Ended, LiveError>>>,
}

impl Page {
    pub(crate) fn of(settings: Settings) -> Self {
        let door = Door::open(0).unwrap();
        let live = Live::open(&door, settings).unwrap();
        let (url, ends) = (door.url(), Arc::new(AtomicBool::new(false)));
        let asked = Arc::clone(&ends);
        let server = std::thread::spawn(move || live.run(|| asked.load(Ordering::Relaxed)));
        Self {
            url,
            ends,
            server: Some(server),
        }
    }

    pub(crate) fn host(&self) -> &str {
        self.url.split('/').nth(2).unwrap()
    }

    pub(crate) fn path(&self) -> &str {
        self.url.split_once(self.host()).unwrap().1
    }

    pub(crate) fn end(&mut self) -> Ended {
        self.ends.store(true, Ordering::Relaxed);
        self.server.take().unwrap().join().unwrap().unwrap()
    }

    /// The status of the answer to a request.
    pub(crate) fn get(&self, host: &str, path: &str) -> u16 {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        let answer = String::from_utf8_lossy(&answer);
        answer.split(' ').nth(1).unwrap().parse().unwrap()
    }

    /// A connection of a page of this origin, or the status by which it is refused.
    pub(crate) fn connect_to(&self, url: &str, origin: &str) -> Result<Connection, u16> {
        let stream = TcpStream::connect(self.host()).unwrap();
        let patience = Some(Duration::from_secs(20));
        stream.set_read_timeout(patience).unwrap();
        let url = format!("{}socket", url.replacen("http", "ws", 1));
        let mut request = url.into_client_request().unwrap();
        let headers = request.headers_mut();
        headers.insert("Origin", origin.parse().unwrap());
        match client(request, stream) {
            Ok((socket, _)) => Ok(Connection {
                socket,
                topology: Vec::new(),
            }),
            Err(HandshakeError::Failure(Error::Http(answer))) => Err(answer.status().as_u16()),
            Err(error) => panic!("{error}"),
        }
    }

    pub(crate) fn connect(&self) -> Connection {
        let own = format!("http://{}", self.host());
        let connected = self.connect_to(&self.url, &own);
        connected.unwrap_or_else(|status| panic!("{status}"))
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
    }
}

pub(crate) struct Connection {
    pub(crate) socket: WebSocket<TcpStream>,
    /// The last surfaces received.
    pub(crate) topology: Vec<u8>,
}

/// A message from a server.
pub(crate) enum Heard {
    Event(Value),
    Topology,
    Picture(Vec<u8>),
    Nothing,
    End,
}

impl Connection {
    pub(crate) fn say(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    pub(crate) fn grant(&mut self) {
        self.socket.send(Message::binary(vec![1, 0, 0, 0])).unwrap();
    }

    pub(crate) fn hear(&mut self) -> Heard {
        match self.socket.read() {
            Ok(Message::Text(text)) => Heard::Event(serde_json::from_str(&text).unwrap()),
            Ok(Message::Binary(bytes)) if u32_at(&bytes, 0) == 0 => {
                self.topology = bytes.to_vec();
                Heard::Topology
            }
            Ok(Message::Binary(bytes)) => Heard::Picture(bytes.to_vec()),
            Ok(Message::Close(_)) => Heard::End,
            Ok(_) => self.hear(),
            Err(Error::Io(error))
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) =>
            {
                Heard::Nothing
            }
            Err(_) => Heard::End,
        }
    }

    /// The next event of this kind; pictures before it are acknowledged with credits.
    pub(crate) fn event(&mut self, kind: &str) -> Value {
        let begun = Instant::now();
        let mut others = Vec::new();
        loop {
            let patience = Duration::from_secs(20);
            assert!(begun.elapsed() < patience, "no {kind} after {others:?}");
            match self.hear() {
                Heard::Event(event) if event["event"] == kind => return event,
                Heard::Event(event) => others.push(event.to_string()),
                Heard::Picture(_) => self.grant(),
                Heard::Topology => {}
                Heard::Nothing | Heard::End => panic!("no {kind} after {others:?}"),
            }
        }
    }

    /// The next picture for which this holds.
    pub(crate) fn picture(&mut self, holds: impl Fn(&[u8]) -> bool) -> Vec<u8> {
        let begun = Instant::now();
        loop {
            assert!(begun.elapsed() < Duration::from_secs(20));
            match self.hear() {
                Heard::Picture(picture) => {
                    self.grant();
                    if holds(&picture) {
                        return picture;
                    }
                }
                Heard::Event(_) | Heard::Topology => {}
                Heard::Nothing | Heard::End => panic!("no picture"),
            }
        }
    }
}

pub(crate) fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

pub(crate) fn f64_at(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}

/// Simulated time (s) of the first pane.
pub(crate) fn time(picture: &[u8]) -> f64 {
    f64_at(picture, PANE + 8)
}

/// The last command that a picture contains.
pub(crate) fn applied(picture: &[u8]) -> u32 {
    u32_at(picture, 8)
}
