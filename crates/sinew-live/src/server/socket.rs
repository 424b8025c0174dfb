//! A connection to a page.

use std::pin::pin;
use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket};
use futures_util::future::select;
use futures_util::{SinkExt, StreamExt};
use tokio::sync::mpsc::Receiver;
use tokio::time::timeout;

use super::guests::Standing;
use super::shared::Shared;
use crate::clients::MOST_CLIENTS;
use crate::inbox::{Place, Request};
use crate::protocol::{Event, Order, Said, is_frame};

/// Time for which a page may read nothing while a message is sent to it.
const PATIENCE: Duration = Duration::from_secs(10);

/// Longest accepted time until the next draw of a page.
const LONGEST_FRAME: Duration = Duration::from_millis(250);

/// Serves a page until it leaves, breaks the protocol, or reads nothing while messages accumulate.
pub(crate) async fn talk(mut stream: WebSocket, shared: Arc<Shared>, standing: Standing) {
    let Some((id, messages)) = shared.clients.enter() else {
        let reason = format!(
            "{MOST_CLIENTS} pages are open, which is the most: close one, and load this one again"
        );
        // A page that is gone needs no reason.
        let _ = stream
            .send(Message::Text(Event::Refused { reason }.to_text().into()))
            .await;
        return;
    };
    standing.stay();
    let greeting = Event::Scenery(Box::new(shared.scenery())).to_text();
    if stream.send(Message::Text(greeting.into())).await.is_ok() {
        // Those who came before it was known have been notified.
        if let Some(integrators) = shared.integrators() {
            shared.clients.tell(id, &integrators);
        }
        shared.inbox.enter(id);
        exchange(stream, &shared, id, messages).await;
    }
    shared.clients.leave(id);
    shared.inbox.leave(id);
}

/// Passes messages on in both directions, neither of which waits for the other, until one of them ends.
async fn exchange(stream: WebSocket, shared: &Shared, id: u32, mut messages: Receiver<Message>) {
    let (mut sink, mut source) = stream.split();
    let speak = pin!(async {
        while let Some(message) = messages.recv().await {
            let is_frame = matches!(&message, Message::Binary(bytes) if is_frame(bytes));
            let sent = timeout(PATIENCE, sink.send(message)).await;
            if !matches!(sent, Ok(Ok(()))) {
                break;
            }
            if is_frame {
                shared.clients.sent(id);
            }
        }
    });
    let listen = pin!(async {
        while let Some(Ok(message)) = source.next().await {
            if !hear(shared, id, &message) {
                break;
            }
        }
    });
    select(speak, listen).await;
}

/// Handles a message of a page; returns false if it closes the connection.
fn hear(shared: &Shared, id: u32, message: &Message) -> bool {
    let refuse = |reason: String| shared.clients.tell(id, &Event::Refused { reason });
    match message {
        Message::Close(_) => return false,
        Message::Ping(_) | Message::Pong(_) => {}
        Message::Binary(bytes) => match <[u8; 4]>::try_from(&bytes[..]) {
            Ok(microseconds) => {
                let until_drawn = Duration::from_micros(u32::from_le_bytes(microseconds).into());
                shared.clients.grant(id, until_drawn.min(LONGEST_FRAME));
                shared.inbox.nudge();
            }
            Err(_) => {
                let bytes = bytes.len();
                refuse(format!("{bytes} bytes that are no credit: expected 4"));
            }
        },
        Message::Text(text) => match serde_json::from_str::<Said>(text) {
            Ok(Said { id: number, order }) => {
                let has_room = match order {
                    Order::Pose {
                        tool,
                        position: [x, y, z],
                        rotation: [a, b, c],
                    } => {
                        let pose = [x, y, z, a, b, c];
                        if shared.has_tool(tool) {
                            shared
                                .inbox
                                .pose(Request::of(id, number, Place { tool, pose }));
                        } else {
                            shared.clients.applied(id, number);
                            refuse(format!("there is no tool {tool}"));
                        }
                        true
                    }
                    order => shared.inbox.order(Request::of(id, number, order)),
                };
                if !has_room {
                    refuse("too many commands wait".to_owned());
                }
            }
            Err(error) => refuse(format!("no command: {error}")),
        },
    }
    true
}
