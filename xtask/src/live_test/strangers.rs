//! Tests of foreign pages, which must be refused, and of clients that behave badly.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use sinew_scene::output::say;
use tungstenite::{Error, Message};

use super::bench::{Bench, require};
use super::hand::{PATIENCE, open};
use super::served::Served;
use crate::failure::Failure;

/// Tests with foreign origins, hosts and tokens.
pub(super) fn are_refused(bench: &Bench) -> Result<(), Failure> {
    let served = Served::start(&bench.sinew, &bench.papers_cube()?)?;
    for origin in [
        "http://evil.example",
        "null",
        "http://localhost:1",
        "http://localhost",
        "http://127.0.0.1",
        "",
    ] {
        let answer = served.connect(origin);
        let is_refused = matches!(&answer, Err(Error::Http(answer)) if answer.status() == 403);
        require(is_refused, || {
            format!("a page of {origin:?} may connect: {answer:?}")
        })?;
    }
    let path = served
        .url
        .trim_start_matches("http://")
        .trim_start_matches(served.host());
    let guessed = path.replace(|digit: char| digit.is_ascii_digit(), "0");
    for (host, path, expected) in [
        (served.host(), path, "200"),
        ("localhost:4444", path, "200"),
        ("localhost", path, "200"),
        ("LOCALHOST:80", path, "200"),
        ("localhost.:80", path, "200"),
        ("127.0.0.1", path, "200"),
        ("[::1]:80", path, "200"),
        ("[::1]", path, "200"),
        ("evil.example", path, "403"),
        ("localhost.evil.example", path, "403"),
        ("127.0.0.1.evil.example:80", path, "403"),
        ("[::ffff:127.0.0.1]:80", path, "403"),
        ("localhost:", path, "403"),
        (served.host(), guessed.as_str(), "404"),
        (served.host(), "/", "404"),
    ] {
        let mut stream = TcpStream::connect(served.host()).map_err(Failure::chore)?;
        let request = format!("GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n");
        stream
            .write_all(request.as_bytes())
            .map_err(Failure::chore)?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).map_err(Failure::chore)?;
        let line = String::from_utf8_lossy(&answer)
            .lines()
            .next()
            .unwrap_or_default()
            .to_owned();
        require(line.contains(expected), || {
            format!("GET {path} for {host}: {line}")
        })?;
    }
    say(
        "forged origins, hosts and tokens are refused; any name of this computer and any port is served",
    )?;
    Ok(())
}

/// A second page, a page that reads nothing, invalid messages, and messages that are too long.
pub(super) fn do_no_harm(bench: &Bench) -> Result<(), Failure> {
    let scene = bench.scene(10, "symplectic-euler", 0.001)?;
    let mut served = Served::start(&bench.sinew, &[scene])?;
    let mut first = open(bench, &served)?;
    let mut second = open(bench, &served)?;
    first.value("window.sinew.command('dt', { pane: 0, dt: 0.0005 })")?;
    second.wait_for("window.sinew.settings.panes[0].dt === 0.0005", PATIENCE)?;
    second.value("window.sinew.command('pose', { tool: 0, position: [0.05, 0.05, 0.112], rotation: [0, 0, 0] })")?;
    first.wait_for(
        "Math.abs(window.sinew.picture.panes[0].tools[0].position[2] - 0.112) < 1e-12",
        PATIENCE,
    )?;

    // What a page that comes late plots of the energy is that of all the session.
    std::thread::sleep(Duration::from_secs(1));
    let mut late = open(bench, &served)?;
    let off = late.number(
        "(() => { const { kinetic, elastic, toolWork, loadWork } = window.sinew.picture.panes[0]; \
         const whole = kinetic + elastic - toolWork - loadWork; return Math.abs(window.sinew.balance() / whole - 1); })()",
    )?;
    require(off < 1e-9, || {
        format!("E - W on a page that came late is off by {off} of it")
    })?;

    // It grants and sends, and never reads.
    let mut deaf = served.connect_as_page().map_err(Failure::chore)?;
    let before = first.number("window.sinew.pictures")?;
    for number in 0..400 {
        let order = format!("{{\"id\":{number},\"do\":\"field\",\"name\":\"strain\"}}");
        let sent = deaf
            .send(Message::binary(vec![1, 0, 0, 0]))
            .and_then(|()| deaf.send(Message::text(order)));
        if sent.is_err() {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    first.wait_for(&format!("window.sinew.pictures > {before} + 20"), PATIENCE)?;

    let nonsense = [
        Message::text(""),
        Message::text("{"),
        Message::text("[[[[[[[[[[[[[[[[["),
        Message::text("{\"id\":1,\"do\":\"dt\",\"pane\":0,\"dt\":1e999}"),
        Message::text("{\"id\":4294967296,\"do\":\"reset\"}"),
        Message::text(
            "{\"id\":1,\"do\":\"pose\",\"tool\":99999999,\"position\":[0,0,0],\"rotation\":[0,0,0]}",
        ),
        Message::text(
            "{\"id\":1,\"do\":\"pose\",\"tool\":0,\"position\":[1e308,-1e308,0],\"rotation\":[1e308,0,0]}",
        ),
        Message::binary(vec![]),
        Message::binary(vec![0xff; 3]),
        Message::binary(vec![0; 5000]),
        Message::text("x".repeat(20_000)),
        Message::binary(vec![0; 10_000_000]),
    ];
    for message in nonsense {
        let mut client = served.connect_as_page().map_err(Failure::chore)?;
        // The server may close the connection while it is sent.
        let _ = client.send(message);
        let _ = client.close(None);
        require(served.runs(), || "sinew ended by a message".to_owned())?;
    }
    // A connection that breaks in the middle of a frame.
    let mut broken = served.connect_as_page().map_err(Failure::chore)?;
    let _ = broken.get_mut().write_all(&[0x82, 0xff, 0xff]);
    drop(broken);
    let stopped = first.value("window.sinew.settings.panes[0].stopped")?;
    require(stopped.is_null(), || {
        format!("the simulation was stopped by a message: {stopped}")
    })?;
    first.value("window.sinew.command('reset')")?;
    let before = first.number("window.sinew.pictures")?;
    first.wait_for(&format!("window.sinew.pictures > {before} + 20"), PATIENCE)?;
    require(served.runs(), || "sinew ended".to_owned())?;
    say(
        "two pages, one that reads nothing, nonsense and messages of 10 MB: the first page goes on",
    )?;
    Ok(())
}

/// The end by Ctrl-C with an open page, and a port that is in use.
pub(super) fn ctrl_c_and_taken_port(bench: &Bench) -> Result<(), Failure> {
    let served = Served::start(&bench.sinew, &bench.papers_cube()?)?;
    let mut tab = open(bench, &served)?;
    let port = served
        .host()
        .rsplit(':')
        .next()
        .unwrap_or_default()
        .to_owned();
    let begun = Instant::now();
    let other = Served::try_to(
        &bench.sinew,
        &[PathBuf::from("--port"), PathBuf::from(&port)],
    )?;
    let said = String::from_utf8_lossy(&other.stderr).into_owned();
    require(other.status.code() == Some(2), || {
        format!("a taken port: {}: {said}", other.status)
    })?;
    require(
        said.contains("--port 0") && said.lines().count() == 1,
        || said.clone(),
    )?;
    require(begun.elapsed() < Duration::from_secs(5), || {
        "a taken port is told late".to_owned()
    })?;
    let ended = served.interrupt()?;
    require(ended.code == Some(0), || {
        format!("Ctrl-C: exit code {:?}: {}", ended.code, ended.said)
    })?;
    let last = ended.said.lines().last().unwrap_or_default();
    require(last.starts_with("the session ended at t = "), || {
        ended.said.clone()
    })?;
    require(
        !ended.said.contains("panicked") && !ended.said.contains("error"),
        || ended.said.clone(),
    )?;
    tab.wait_for("!window.sinew.connected", PATIENCE)?;
    tab.wait_for(
        "['pause', 'reset', 'save', 'panes'].every((id) => document.getElementById(id).disabled)",
        PATIENCE,
    )?;
    say(&format!(
        "a taken port is one sentence; Ctrl-C ends with 0 in {:.2} s, and the page says so",
        ended.after.as_secs_f64()
    ))?;
    Ok(())
}
