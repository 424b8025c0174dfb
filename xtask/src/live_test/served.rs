//! `sinew live` as a user starts it.

use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use tungstenite::client::IntoClientRequest;
use tungstenite::http::HeaderValue;
use tungstenite::{Error, WebSocket, client};

use crate::failure::Failure;

/// Time after which a server that was asked to end is killed.
const LONGEST_END: Duration = Duration::from_secs(30);

/// A server, which ends with this value.
pub(super) struct Served {
    child: Child,
    /// The address of its page.
    pub(super) url: String,
    errors: BufReader<std::process::ChildStderr>,
}

/// End of a program.
pub(super) struct Ended {
    pub(super) code: Option<i32>,
    pub(super) said: String,
    pub(super) after: Duration,
}

impl Served {
    /// Starts it on a scene.
    pub(super) fn start(sinew: &Path, arguments: &[PathBuf]) -> Result<Self, Failure> {
        let mut child = command(sinew, arguments).spawn().map_err(Failure::chore)?;
        let (Some(out), Some(errors)) = (child.stdout.take(), child.stderr.take()) else {
            return Err(Failure::Chore("no pipes to sinew".to_owned()));
        };
        let mut url = String::new();
        BufReader::new(out)
            .read_line(&mut url)
            .map_err(Failure::chore)?;
        let mut served = Self {
            child,
            url: url.trim().to_owned(),
            errors: BufReader::new(errors),
        };
        if served.url.is_empty() {
            let ended = served.wait()?;
            return Err(Failure::Chore(format!("sinew live: {}", ended.said)));
        }
        Ok(served)
    }

    /// Runs it until it ends without a page, for example because its port is in use.
    pub(super) fn try_to(sinew: &Path, arguments: &[PathBuf]) -> Result<Output, Failure> {
        command(sinew, arguments).output().map_err(Failure::chore)
    }

    /// Host and port.
    pub(super) fn host(&self) -> &str {
        let place = self.url.trim_start_matches("http://");
        place.split('/').next().unwrap_or_default()
    }

    /// Connects as a page of this origin.
    pub(super) fn connect(&self, origin: &str) -> Result<WebSocket<TcpStream>, Error> {
        let stream = TcpStream::connect(self.host()).map_err(Error::Io)?;
        let url = format!("{}socket", self.url.replacen("http", "ws", 1));
        let mut request = url.into_client_request()?;
        if let Ok(origin) = HeaderValue::from_str(origin) {
            request.headers_mut().insert("Origin", origin);
        }
        let (socket, _) = client(request, stream).map_err(|error| match error {
            tungstenite::HandshakeError::Failure(error) => error,
            tungstenite::HandshakeError::Interrupted(_) => Error::ConnectionClosed,
        })?;
        Ok(socket)
    }

    /// Connects as its own page.
    pub(super) fn connect_as_page(&self) -> Result<WebSocket<TcpStream>, Error> {
        self.connect(&format!("http://{}", self.host()))
    }

    /// Memory (MB) that it uses.
    pub(super) fn memory(&self) -> f64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id()));
        let status = status.unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let number = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
        number.map_or(f64::NAN, |number| number / 1024.0)
    }

    /// True if it is still running.
    pub(super) fn runs(&mut self) -> bool {
        matches!(self.child.try_wait(), Ok(None))
    }

    /// Presses Ctrl-C, or requests the end in another way if this program was started to ignore it, like background
    /// jobs.
    pub(super) fn interrupt(mut self) -> Result<Ended, Failure> {
        let id = self.child.id().to_string();
        let signal = if ignores_interrupts() {
            "-TERM"
        } else {
            "-INT"
        };
        Command::new("kill")
            .args([signal, &id])
            .status()
            .map_err(Failure::chore)?;
        self.wait()
    }

    fn wait(&mut self) -> Result<Ended, Failure> {
        let begun = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().map_err(Failure::chore)? {
                break status;
            }
            if begun.elapsed() > LONGEST_END {
                let _ = self.child.kill();
            }
            sleep(Duration::from_millis(10));
        };
        let mut said = String::new();
        self.errors
            .read_to_string(&mut said)
            .map_err(Failure::chore)?;
        Ok(Ended {
            code: status.code(),
            said,
            after: begun.elapsed(),
        })
    }
}

/// True if this process, and thus its children, ignore signal 2.
fn ignores_interrupts() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> 1 & 1 == 1)
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn command(sinew: &Path, arguments: &[PathBuf]) -> Command {
    let mut command = Command::new(sinew);
    command.arg("live").args(arguments).stdin(Stdio::null());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}
