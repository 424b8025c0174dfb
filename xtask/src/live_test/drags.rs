//! Random drags in ready scenes, which end no session.

use std::io::ErrorKind;
use std::net::TcpStream;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use serde_json::Value;
use sinew_scene::output::say;
use tungstenite::{Error, Message, WebSocket};

use super::bench::{Bench, require};
use super::served::Served;
use crate::failure::Failure;

/// Scenes with tools that press, pull, grasp and push in, with a blade, and without any of these.
const SCENES: [&str; 10] = [
    "press",
    "organ-pressed",
    "retract",
    "needle-push",
    "handle",
    "needle",
    "held-cube",
    "beam",
    "slit",
    "organ-fibres",
];

/// Events of a mouse in a second.
const RATES: [f64; 3] = [30.0, 60.0, 144.0];

/// Longest wait for a picture.
const PATIENCE: Duration = Duration::from_secs(20);

/// Drags tools, or the tissue of scenes without any, to random places in the box around the body and beyond it.
pub(super) fn end_no_session(bench: &Bench, drags: u32) -> Result<(), Failure> {
    let each = drags.div_ceil(SCENES.len() as u32);
    let mut numbers = Numbers(1);
    let mut went_back = 0;
    for name in SCENES {
        let scene = bench.folder.path().join(format!("{name}.toml"));
        write(&bench.sinew, name, &scene)?;
        let served = Served::start(&bench.sinew, &[scene])?;
        let socket = served.connect_as_page().map_err(Failure::chore)?;
        let mut guest = Guest::of(name, socket)?;
        for drag in 0..each {
            let rate = RATES[drag as usize % RATES.len()];
            guest.drag(rate, &mut numbers)?;
        }
        let t = guest.t;
        guest.wait_for(|guest| guest.t > t + 0.05)?;
        went_back += guest.went_back;
    }
    say(&format!(
        "{} random drags in {} scenes by three kinds of mouse: no session ended, {went_back} times one went back",
        each * SCENES.len() as u32,
        SCENES.len()
    ))?;
    Ok(())
}

/// Writes a ready scene.
fn write(sinew: &Path, name: &str, scene: &Path) -> Result<(), Failure> {
    let written = Command::new(sinew)
        .args(["new", "--ready", name, "--out"])
        .arg(scene)
        .output()
        .map_err(Failure::chore)?;
    require(written.status.success(), || {
        format!(
            "sinew new --ready {name}: {}",
            String::from_utf8_lossy(&written.stderr)
        )
    })
}

/// Numbers from 0 to 1, the same in each run.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A page that sends what a mouse would.
struct Guest {
    scene: &'static str,
    socket: WebSocket<TcpStream>,
    /// The last command.
    id: u32,
    has_tool: bool,
    epoch: u32,
    /// Points (m) of the surface at rest.
    points: Vec<[f64; 3]>,
    /// Place (m) of the first tool, or of the tissue that is pulled.
    place: [f64; 3],
    t: f64,
    went_back: u32,
    stopped: Option<String>,
}

impl Guest {
    fn of(scene: &'static str, socket: WebSocket<TcpStream>) -> Result<Self, Failure> {
        let mut guest = Self {
            scene,
            socket,
            id: 0,
            has_tool: false,
            epoch: 0,
            points: Vec::new(),
            place: [0.0; 3],
            t: f64::NAN,
            went_back: 0,
            stopped: None,
        };
        guest.wait_for(|guest| guest.t >= 0.0)?;
        Ok(guest)
    }

    /// Drags from the present place to a random one.
    fn drag(&mut self, rate: f64, numbers: &mut Numbers) -> Result<(), Failure> {
        if !self.has_tool {
            let count = self.points.len() as f64;
            let point = (numbers.next() * count) as usize;
            self.place = self.points[point];
            let epoch = self.epoch;
            self.say(&format!(
                r#""do":"grip","pane":0,"point":{point},"epoch":{epoch}"#
            ))?;
        }
        let bound = |pick: fn(f64, f64) -> f64, from: f64| {
            let fold = |found: [f64; 3], point: &[f64; 3]| {
                std::array::from_fn(|axis| pick(found[axis], point[axis]))
            };
            self.points.iter().fold([from; 3], fold)
        };
        let (low, high) = (
            bound(f64::min, f64::INFINITY),
            bound(f64::max, f64::NEG_INFINITY),
        );
        let to: [f64; 3] = std::array::from_fn(|axis| {
            let middle = 0.5 * (low[axis] + high[axis]);
            middle + 1.6 * (numbers.next() - 0.5) * (high[axis] - low[axis])
        });
        let (from, events) = (self.place, ((0.1 + 0.4 * numbers.next()) * rate).ceil());
        let begun = Instant::now();
        for event in 1..=events as u32 {
            let share = f64::from(event) / events;
            self.place = std::array::from_fn(|axis| from[axis] + share * (to[axis] - from[axis]));
            let [x, y, z] = self.place;
            let place = format!("[{x:?},{y:?},{z:?}]");
            self.say(&match self.has_tool {
                true => format!(r#""do":"pose","tool":0,"position":{place},"rotation":[0,0,0]"#),
                false => format!(r#""do":"pull","to":{place}"#),
            })?;
            let due = Duration::from_secs_f64(f64::from(event) / rate);
            self.hear_for(due.saturating_sub(begun.elapsed()))?;
        }
        if !self.has_tool {
            self.say(r#""do":"let_go""#)?;
        }
        let stopped = self.stopped.as_ref();
        require(stopped.is_none(), || {
            let reason = stopped.map_or("", String::as_str);
            format!("a drag in {} ended the session: {reason}", self.scene)
        })
    }

    fn say(&mut self, order: &str) -> Result<(), Failure> {
        self.id += 1;
        let text = format!(r#"{{"id":{},{order}}}"#, self.id);
        self.socket
            .send(Message::text(text))
            .map_err(Failure::chore)
    }

    fn wait_for(&mut self, holds: impl Fn(&Self) -> bool) -> Result<(), Failure> {
        let begun = Instant::now();
        while !holds(self) {
            require(begun.elapsed() < PATIENCE, || {
                format!("{}: no picture after {PATIENCE:?}", self.scene)
            })?;
            self.hear_for(Duration::from_millis(20))?;
        }
        Ok(())
    }

    /// Reads messages for a time.
    fn hear_for(&mut self, time: Duration) -> Result<(), Failure> {
        let begun = Instant::now();
        loop {
            let left = time.saturating_sub(begun.elapsed());
            if left < Duration::from_micros(100) {
                return Ok(());
            }
            let stream = self.socket.get_ref();
            stream
                .set_read_timeout(Some(left))
                .map_err(Failure::chore)?;
            match self.socket.read() {
                Ok(Message::Text(text)) => self.note(&text),
                Ok(Message::Binary(bytes)) => self.take(&bytes)?,
                Ok(_) => {}
                Err(Error::Io(error))
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {}
                Err(error) => return Err(Failure::chore(error)),
            }
        }
    }

    fn note(&mut self, text: &str) {
        let event: Value = serde_json::from_str(text).unwrap_or_default();
        match event["event"].as_str() {
            Some("scenery") => {
                let start = &event["tools"][0]["start"];
                self.has_tool = start.is_array();
                self.place = [0, 1, 2].map(|axis| start[axis].as_f64().unwrap_or(0.0));
            }
            Some("stopped") => self.stopped = event["reason"].as_str().map(str::to_owned),
            Some("went_back") => self.went_back += 1,
            _ => {}
        }
    }

    /// Takes a surface or a picture, for which it gives a credit.
    fn take(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let u32_at = |at: usize| {
            let bytes = bytes
                .get(at..at + 4)
                .and_then(|bytes| bytes.try_into().ok());
            bytes.map_or(0, u32::from_le_bytes)
        };
        if u32_at(0) == 0 {
            self.epoch = u32_at(4);
            let number = |place: u32| f64::from(f32::from_bits(u32_at(32 + 4 * place as usize)));
            let points = 0..u32_at(16);
            self.points = points
                .map(|point| [0, 1, 2].map(|axis| number(3 * point + axis)))
                .collect();
            return Ok(());
        }
        let t = bytes.get(40..48).and_then(|bytes| bytes.try_into().ok());
        self.t = t.map_or(f64::NAN, f64::from_le_bytes);
        self.socket
            .send(Message::binary(vec![1, 0, 0, 0]))
            .map_err(Failure::chore)
    }
}
