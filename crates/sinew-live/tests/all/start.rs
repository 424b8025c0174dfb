//! The start page and the sessions that it opens, with requests like those of a browser.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use serde_json::Value;
use sinew_live::{Door, Live, LiveError, Offer, Offers, Settings, Start};

use crate::common::{CUBE, settings};

/// A start page, and the session that is chosen on it, until a page goes back to it and nothing is chosen.
struct Place {
    url: String,
    ends: Arc<AtomicBool>,
    server: Option<JoinHandle<Result<Vec<usize>, LiveError>>>,
}

fn offer(name: &str) -> Offer {
    Offer {
        name: name.to_owned(),
        title: format!("the {name}"),
        group: "cubes".to_owned(),
        about: "it stands".to_owned(),
        method: "by hand".to_owned(),
        alt: "a cube".to_owned(),
        picture: b"\x89PNG",
    }
}

impl Place {
    fn open() -> Self {
        let door = Door::open(0).unwrap();
        let (url, ends) = (door.url(), Arc::new(AtomicBool::new(false)));
        let asked = Arc::clone(&ends);
        let server = std::thread::spawn(move || {
            let offers = Arc::new(Offers::new(vec![offer("cube"), offer("other")]));
            let ends = || asked.load(Ordering::Relaxed);
            let mut chosen = Vec::new();
            // The first pace is found at once, the second one never.
            let measure = |index: usize, is_over: &dyn Fn() -> bool| {
                while index == 1 && !is_over() {
                    std::thread::sleep(Duration::from_millis(1));
                }
                Some(2.5)
            };
            loop {
                let start = Start::open(&door, Arc::clone(&offers))?;
                let Some(index) = start.run(measure, ends)? else {
                    return Ok(chosen);
                };
                chosen.push(index);
                let settings = Settings {
                    from_start: Some("Wait.".to_owned()),
                    ..settings(CUBE)
                };
                if !Live::open(&door, settings)?.run(ends)?.goes_to_start {
                    return Ok(chosen);
                }
            }
        });
        Self {
            url,
            ends,
            server: Some(server),
        }
    }

    fn host(&self) -> &str {
        self.url.split('/').nth(2).unwrap()
    }

    fn path(&self, name: &str) -> String {
        format!("{}{name}", self.url.split_once(self.host()).unwrap().1)
    }

    /// Sends bytes; the status and the text of the answer.
    fn send(&self, request: &[u8]) -> (u16, String) {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        let patience = Some(Duration::from_secs(20));
        stream.set_read_timeout(patience).unwrap();
        // The server may refuse before it has read all of it.
        let _ = stream.write_all(request);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let status = answer.split(' ').nth(1).map_or(0, |status| {
            status.parse().unwrap_or_else(|_| panic!("{answer}"))
        });
        let text = answer.split_once("\r\n\r\n").map_or("", |(_, text)| text);
        (status, text.to_owned())
    }

    fn get(&self, name: &str) -> (u16, String) {
        self.ask("GET", self.host(), None, &self.path(name), b"")
    }

    fn ask(
        &self,
        method: &str,
        host: &str,
        origin: Option<&str>,
        path: &str,
        body: &[u8],
    ) -> (u16, String) {
        let origin = origin.map_or(String::new(), |origin| format!("Origin: {origin}\r\n"));
        let head = format!(
            "{method} {path} HTTP/1.1\r\nHost: {host}\r\n{origin}Content-Length: {}\r\nConnection: close\r\n\r\n",
            body.len()
        );
        self.send(&[head.as_bytes(), body].concat())
    }

    /// Chooses as the page does.
    fn choose(&self, body: &[u8]) -> u16 {
        let origin = format!("http://{}", self.host());
        let path = self.path("choose");
        self.ask("POST", self.host(), Some(&origin), &path, body).0
    }

    /// The state of the page; null from a server that ends in this moment.
    fn state(&self) -> Value {
        serde_json::from_str(&self.get("state").1).unwrap_or_default()
    }

    /// Waits until this page is served.
    fn wait_for(&self, page: &str) {
        let begun = Instant::now();
        while self.state()["page"] != page {
            assert!(begun.elapsed() < Duration::from_secs(20), "no page {page}");
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    /// The scenes that were chosen.
    fn end(mut self) -> Vec<usize> {
        self.ends.store(true, Ordering::Relaxed);
        self.server.take().unwrap().join().unwrap().unwrap()
    }

    /// Sends an order on a new connection to the session, and returns all that it says until it ends.
    fn order(&self, text: &str) -> Vec<String> {
        use tungstenite::client::IntoClientRequest;
        let url = format!("{}socket", self.url.replacen("http", "ws", 1));
        let mut request = url.into_client_request().unwrap();
        let origin = format!("http://{}", self.host());
        let headers = request.headers_mut();
        headers.insert("Origin", origin.parse().unwrap());
        let stream = TcpStream::connect(self.host()).unwrap();
        let (mut socket, _) = tungstenite::client(request, stream).unwrap();
        socket.send(tungstenite::Message::text(text)).unwrap();
        let mut said = Vec::new();
        while let Ok(message) = socket.read() {
            if let tungstenite::Message::Text(text) = message {
                said.push(text.to_string());
            }
        }
        said
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.ends.store(true, Ordering::Relaxed);
    }
}

#[test]
fn a_chosen_scene_opens_paused_at_the_same_address_and_leads_back() {
    let place = Place::open();
    assert_eq!(place.get("").0, 200);
    assert_eq!(place.get("cube.png"), (200, "\u{fffd}PNG".to_owned()));
    assert_eq!(place.get("none.png").0, 404);
    let begun = Instant::now();
    while place.state()["offers"][0]["factor"] != 2.5 {
        assert!(begun.elapsed() < Duration::from_secs(20));
    }
    assert_eq!(place.state()["offers"][1]["pace"], "runs");
    assert_eq!(place.choose(b"other"), 204);
    place.wait_for("live");
    let said = place.order(r#"{"id":1,"do":"scenes"}"#);
    assert!(said[0].contains(r#""from_start":"Wait.""#), "{}", said[0]);
    assert!(said.iter().any(|said| said.contains(r#""paused":true"#)));
    // A survey of the integrators may end after it.
    let leads_back = |said: &String| said == r#"{"event":"scenes"}"#;
    assert!(said.iter().any(leads_back), "{said:?}");
    place.wait_for("start");
    // Measured paces stay known.
    assert_eq!(place.state()["offers"][0]["factor"], 2.5);
    assert_eq!(place.state()["chosen"], Value::Null);
    assert_eq!(place.choose(b"cube"), 204);
    place.wait_for("live");
    assert_eq!(place.end(), [1, 0]);
}

#[test]
fn strangers_choose_nothing() {
    let place = Place::open();
    let (host, path) = (place.host().to_owned(), place.path("choose"));
    let own = format!("http://{host}");
    let guessed = path.replace(|digit: char| digit.is_ascii_digit(), "0");
    for (host, origin, path, expected) in [
        (host.as_str(), None, path.as_str(), 403),
        (&host, Some("http://evil.example"), &path, 403),
        (&host, Some("null"), &path, 403),
        (&host, Some("http://localhost:1"), &path, 403),
        (&host, Some(&own.replace("http:", "https:")), &path, 403),
        ("evil.example", Some("http://evil.example"), &path, 403),
        ("evil.example", Some(&own), &path, 403),
        (&host, Some(&own), &guessed, 404),
        (&host, Some(&own), "/choose", 404),
    ] {
        let (status, text) = place.ask("POST", host, origin, path, b"cube");
        assert_eq!(status, expected, "{host} {origin:?} {path}: {text}");
    }
    for (host, path, expected) in [
        ("evil.example", place.path("state"), 403),
        ("evil.example", place.path(""), 403),
        (&host, guessed.replace("choose", "state"), 404),
        (&host, guessed.replace("choose", "cube.png"), 404),
        (&host, "/".to_owned(), 404),
    ] {
        let status = place.ask("GET", host, None, &path, b"").0;
        assert_eq!(status, expected, "{host} {path}");
    }
    // A choice by an address that a browser loads.
    assert_eq!(place.get("choose").0, 405);
    assert_eq!(place.state()["chosen"], Value::Null);
    assert_eq!(place.end(), [0; 0]);
}

#[test]
fn garbage_chooses_nothing() {
    let place = Place::open();
    for (body, expected) in [
        (&b""[..], 400),
        (b"none", 400),
        (b"../cube", 400),
        (b"cube\0", 400),
        (b"{\"name\":\"cube\"}", 400),
        (&[0xff; 40], 400),
        (&[b'c'; 257], 413),
        (&[b'c'; 1 << 20], 413),
    ] {
        let status = place.choose(body);
        // One that is too long may be cut off before its answer is read.
        assert!(
            status == expected || (status == 0 && body.len() > 256),
            "{} bytes: {status}",
            body.len()
        );
    }
    let path = place.path("choose");
    for request in [
        format!("POST {path} HTTP/1.1\r\nHost: {}\r\n\r\n", place.host()),
        format!("POST {path} HTTP/9.9\r\n\r\n"),
        "\0\0\0\0\r\n\r\n".to_owned(),
        format!("GET {} HTTP/1.1\r\n\r\n", place.path("state")),
    ] {
        assert_ne!(place.send(request.as_bytes()).0, 200, "{request:?}");
    }
    assert_eq!(place.state()["chosen"], Value::Null);
    assert_eq!(place.end(), [0; 0]);
}

#[test]
fn of_a_hundred_choices_at_once_one_holds() {
    let place = Place::open();
    std::thread::scope(|scope| {
        for number in 0..100 {
            let place = &place;
            let name = ["cube", "other"][number % 2];
            // Those that come after the start page ended are refused by the session, or by nobody.
            scope.spawn(move || place.choose(name.as_bytes()));
        }
    });
    place.wait_for("live");
    assert_eq!(place.end().len(), 1);
}

#[test]
fn a_session_of_another_beginning_has_no_way_to_a_start_page() {
    let page = crate::common::Page::of(settings(CUBE));
    let mut client = page.connect();
    client.say(r#"{"id":1,"do":"scenes"}"#);
    let reason = client.event("refused")["reason"].to_string();
    assert!(reason.contains("start page"), "{reason}");
}
