//! A page in Chromium, by its DevTools protocol.

use std::net::TcpStream;
use std::time::{Duration, Instant};

use data_encoding::BASE64;
use serde_json::{Value, json};
use tungstenite::{Message, WebSocket, client};

use crate::failure::Failure;

/// Longest time for a response.
const PATIENCE: Duration = Duration::from_secs(60);

/// A tab.
pub(super) struct Tab {
    socket: WebSocket<TcpStream>,
    session: String,
    last: u64,
    /// Errors of the page's scripts.
    pub(super) errors: Vec<String>,
}

/// A mouse event.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mouse {
    Press,
    Move,
    Release,
}

impl Tab {
    /// Opens a new tab of this size in a browser that listens there.
    pub(super) fn open(address: &str, width: u32, height: u32) -> Result<Self, Failure> {
        let place = address.trim_start_matches("ws://");
        let host = place.split('/').next().unwrap_or_default();
        let stream = TcpStream::connect(host).map_err(Failure::chore)?;
        stream.set_nodelay(true).map_err(Failure::chore)?;
        stream
            .set_read_timeout(Some(PATIENCE))
            .map_err(Failure::chore)?;
        let (socket, _) = client(address, stream).map_err(Failure::chore)?;
        let mut tab = Self {
            socket,
            session: String::new(),
            last: 0,
            errors: Vec::new(),
        };
        let target = tab.call("Target.createTarget", json!({ "url": "about:blank" }))?;
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = tab.call("Target.attachToTarget", attach)?;
        tab.session = attached["sessionId"]
            .as_str()
            .unwrap_or_default()
            .to_owned();
        tab.call("Page.enable", json!({}))?;
        tab.call("Runtime.enable", json!({}))?;
        tab.resize(width, height)?;
        Ok(tab)
    }

    /// Changes the size of the page.
    pub(super) fn resize(&mut self, width: u32, height: u32) -> Result<(), Failure> {
        let metrics =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        self.call("Emulation.setDeviceMetricsOverride", metrics)?;
        Ok(())
    }

    /// Goes to an address.
    pub(super) fn go(&mut self, url: &str) -> Result<(), Failure> {
        self.call("Page.navigate", json!({ "url": url }))?;
        Ok(())
    }

    /// The value of an expression on the page.
    pub(super) fn value(&mut self, expression: &str) -> Result<Value, Failure> {
        self.evaluate(expression)?
            .map_err(|reason| Failure::Chore(format!("`{expression}` fails on the page: {reason}")))
    }

    /// The value of an expression on the page, or the exception.
    fn evaluate(&mut self, expression: &str) -> Result<Result<Value, Value>, Failure> {
        let question =
            json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", question)?;
        let mut thrown = answer["exceptionDetails"].take();
        Ok(match thrown.is_null() {
            true => Ok(answer["result"]["value"].take()),
            false => Err(thrown["exception"]["description"].take()),
        })
    }

    /// The numeric value of an expression on the page; NaN if it is no number.
    pub(super) fn number(&mut self, expression: &str) -> Result<f64, Failure> {
        Ok(self.value(expression)?.as_f64().unwrap_or(f64::NAN))
    }

    /// Waits until an expression is true.
    pub(super) fn wait_for(&mut self, expression: &str, patience: Duration) -> Result<(), Failure> {
        // Tabs behind another draw nothing.
        self.call("Page.bringToFront", json!({}))?;
        let begun = Instant::now();
        // On the way to it parts of the page may be missing.
        while self.evaluate(&format!("Boolean({expression})"))? != Ok(Value::Bool(true)) {
            if begun.elapsed() > patience {
                let state = self.value("JSON.stringify([window.sinew?.connected, window.sinew?.lights(), window.sinew?.settings])")?;
                return Err(Failure::Chore(format!(
                    "waited {patience:?} in vain for `{expression}`; the page has {state}"
                )));
            }
            std::thread::sleep(Duration::from_millis(40));
        }
        Ok(())
    }

    /// Sends a mouse event at a position (CSS pixels), with the left button.
    pub(super) fn mouse(&mut self, what: Mouse, at: [f64; 2]) -> Result<(), Failure> {
        self.mouse_with(what, at, "left")
    }

    /// Sends a mouse event at a position (CSS pixels), with a button: "left" or "middle".
    pub(super) fn mouse_with(
        &mut self,
        what: Mouse,
        [x, y]: [f64; 2],
        button: &str,
    ) -> Result<(), Failure> {
        let held = if button == "left" { 1 } else { 4 };
        let (kind, buttons) = match what {
            Mouse::Press => ("mousePressed", held),
            Mouse::Move => ("mouseMoved", held),
            Mouse::Release => ("mouseReleased", 0),
        };
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "buttons": buttons, "clickCount": 1 });
        self.call("Input.dispatchMouseEvent", event)?;
        Ok(())
    }

    /// Turns the wheel at a position (CSS pixels), by pixels downwards.
    pub(super) fn wheel(&mut self, [x, y]: [f64; 2], by: f64) -> Result<(), Failure> {
        self.call(
            "Input.dispatchMouseEvent",
            json!({ "type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": by }),
        )?;
        Ok(())
    }

    /// Makes the page assume a touch screen.
    pub(super) fn has_fingers(&mut self) -> Result<(), Failure> {
        self.call(
            "Emulation.setTouchEmulationEnabled",
            json!({ "enabled": true, "maxTouchPoints": 2 }),
        )?;
        Ok(())
    }

    /// Sends a touch event (`touchStart`, `touchMove` or `touchEnd`) with the positions (CSS pixels) of the fingers
    /// that are then down.
    pub(super) fn touch(&mut self, what: &str, fingers: &[[f64; 2]]) -> Result<(), Failure> {
        let points = fingers.iter().enumerate();
        let points = points.map(|(id, [x, y])| json!({ "x": x, "y": y, "id": id }));
        let points: Vec<Value> = points.collect();
        self.call(
            "Input.dispatchTouchEvent",
            json!({ "type": what, "touchPoints": points }),
        )?;
        Ok(())
    }

    /// Takes a picture of the page, as a PNG file.
    pub(super) fn picture(&mut self) -> Result<Vec<u8>, Failure> {
        let answer = self.call("Page.captureScreenshot", json!({ "format": "png" }))?;
        let text = answer["data"].as_str().unwrap_or_default();
        BASE64.decode(text.as_bytes()).map_err(Failure::chore)
    }

    /// Presses and releases a key.
    pub(super) fn key(&mut self, key: &str) -> Result<(), Failure> {
        for kind in ["rawKeyDown", "keyUp"] {
            self.call(
                "Input.dispatchKeyEvent",
                json!({ "type": kind, "key": key, "code": key }),
            )?;
        }
        Ok(())
    }

    /// Leaves the page, so that it asks nothing any more.
    pub(super) fn close(&mut self) -> Result<(), Failure> {
        self.go("about:blank")
    }

    /// Makes the page see a light or a dark scheme of colours.
    pub(super) fn scheme(&mut self, scheme: &str) -> Result<(), Failure> {
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        self.call(
            "Emulation.setEmulatedMedia",
            json!({ "features": [feature] }),
        )?;
        Ok(())
    }

    /// Presses and releases Tab or Enter, with what a browser does by them.
    pub(super) fn act(&mut self, key: &str) -> Result<(), Failure> {
        let (code, text) = match key {
            "Tab" => (9, ""),
            _ => (13, "\r"),
        };
        for kind in ["keyDown", "keyUp"] {
            let mut event =
                json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            if kind == "keyDown" {
                event["text"] = json!(text);
            }
            self.call("Input.dispatchKeyEvent", event)?;
        }
        Ok(())
    }

    fn call(&mut self, method: &str, parameters: Value) -> Result<Value, Failure> {
        self.last += 1;
        let mut question = json!({ "id": self.last, "method": method, "params": parameters });
        if !self.session.is_empty() {
            question["sessionId"] = json!(self.session);
        }
        self.socket
            .send(Message::text(question.to_string()))
            .map_err(Failure::chore)?;
        loop {
            let message = self.socket.read().map_err(Failure::chore)?;
            let Message::Text(text) = message else {
                continue;
            };
            let mut answer: Value = serde_json::from_str(&text).map_err(Failure::chore)?;
            if answer["id"] == self.last {
                if answer["error"].is_object() {
                    return Err(Failure::Chore(format!(
                        "{method}: {}",
                        answer["error"]["message"]
                    )));
                }
                return Ok(answer["result"].take());
            }
            if answer["method"] == "Runtime.exceptionThrown" {
                let details = &answer["params"]["exceptionDetails"];
                self.errors
                    .push(details["exception"]["description"].to_string());
            }
        }
    }
}
