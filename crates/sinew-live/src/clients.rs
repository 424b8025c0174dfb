//! The connected pages.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::body::Bytes;
use axum::extract::ws::Message;
use tokio::sync::mpsc::{Receiver, Sender, channel};

use crate::next_draw::NextDraw;
use crate::protocol::{APPLIED_AT, Event};

/// Credits with which a page begins.
pub(crate) const FIRST_CREDITS: u32 = 2;

/// Largest number of credits of a page, for any number that it grants.
const MOST_CREDITS: u32 = 4;

/// Messages queued for one page; a page with more unread ones is disconnected. The limit is several messages for each
/// order that may wait in the inbox.
const MOST_WAITING: usize = 1024;

/// Largest number of simultaneous pages.
pub(crate) const MOST_CLIENTS: usize = 16;

/// A picture for pages.
pub(crate) struct Picture<'a> {
    pub(crate) message: Vec<u8>,
    /// Number of visible changes when it was made.
    pub(crate) changes: u64,
    /// The surfaces to which it belongs, and their number.
    pub(crate) topology: &'a Bytes,
    pub(crate) epoch: u32,
}

#[derive(Debug)]
struct Client {
    id: u32,
    credits: u32,
    /// The last command of this client that the simulation has carried out.
    applied: u32,
    /// Number of changes that it has received.
    shown: u64,
    next_draw: NextDraw,
    /// Number of pictures that wait to be sent.
    waiting: u32,
    /// The topology that it has received.
    epoch: Option<u32>,
    sender: Sender<Message>,
}

#[derive(Debug, Default)]
struct List {
    clients: Vec<Client>,
    last: u32,
}

/// All pages, with their credits.
#[derive(Debug, Default)]
pub(crate) struct Clients(Mutex<List>);

impl Clients {
    /// A new client: its number, and the messages for it; `None` if there are too many.
    pub(crate) fn enter(&self) -> Option<(u32, Receiver<Message>)> {
        let mut list = self.lock();
        if list.clients.len() >= MOST_CLIENTS {
            return None;
        }
        let (sender, receiver) = channel(MOST_WAITING);
        list.last += 1;
        let id = list.last;
        list.clients.push(Client {
            id,
            credits: FIRST_CREDITS,
            applied: 0,
            shown: 0,
            next_draw: NextDraw::after(Duration::ZERO),
            waiting: 0,
            epoch: None,
            sender,
        });
        Some((id, receiver))
    }

    /// Removes a client.
    pub(crate) fn leave(&self, id: u32) {
        self.lock().clients.retain(|client| client.id != id);
    }

    /// True if a client is still connected.
    pub(crate) fn is_here(&self, id: u32) -> bool {
        self.lock().find(id).is_some()
    }

    /// Removes all clients, so that their connections end.
    pub(crate) fn dismiss(&self) {
        self.lock().clients.clear();
    }

    /// Adds a credit of a client, which draws again after a time.
    pub(crate) fn grant(&self, id: u32, until_drawn: Duration) {
        if let Some(client) = self.lock().find(id) {
            client.credits = (client.credits + 1).min(MOST_CREDITS);
            client.next_draw = NextDraw::after(until_drawn);
        }
    }

    /// Records that a picture has been sent to a client.
    pub(crate) fn sent(&self, id: u32) {
        if let Some(client) = self.lock().find(id) {
            client.waiting = client.waiting.saturating_sub(1);
        }
    }

    /// Records the last command of a client that was carried out.
    pub(crate) fn applied(&self, id: u32, command: u32) {
        if let Some(client) = self.lock().find(id) {
            client.applied = client.applied.max(command);
        }
    }

    /// Time at which the next picture is to be made, which may be in the past, after `changes` changes; `None` if no
    /// client with a credit lacks one.
    pub(crate) fn next_picture(&self, changes: u64) -> Option<Instant> {
        let list = self.lock();
        let lack = list.clients.iter().filter(|client| client.lacks(changes));
        lack.map(Client::next_picture).min()
    }

    /// Sends a picture, and before it the topology if that is new, to all clients with a credit that lack it and
    /// whose picture is due by this time.
    pub(crate) fn show(&self, picture: Picture<'_>, by: Instant) {
        let Picture {
            message,
            changes,
            topology,
            epoch,
        } = picture;
        let mut list = self.lock();
        let wants = |client: &Client| client.lacks(changes) && client.next_picture() <= by;
        let mut left = list.clients.iter().filter(|client| wants(client)).count();
        let mut whole = Some(message);
        list.keep(|client| {
            if !wants(client) {
                return true;
            }
            left -= 1;
            let copy = match left {
                0 => whole.take(),
                _ => whole.clone(),
            };
            let Some(mut frame) = copy else {
                return true;
            };
            if client.epoch != Some(epoch) {
                client.epoch = Some(epoch);
                if !client.take(Message::Binary(topology.clone())) {
                    return false;
                }
            }
            if let Some(place) = frame.get_mut(APPLIED_AT..APPLIED_AT + 4) {
                place.copy_from_slice(&client.applied.to_le_bytes());
            }
            client.shown = changes;
            client.credits -= 1;
            client.next_draw.take();
            client.waiting += 1;
            client.take(Message::Binary(frame.into()))
        });
    }

    /// Sends an event to all clients.
    pub(crate) fn tell_all(&self, event: &Event) {
        let text = event.to_text();
        self.lock()
            .keep(|client| client.take(Message::Text(text.clone().into())));
    }

    /// Sends an event to one client.
    pub(crate) fn tell(&self, id: u32, event: &Event) {
        let text = event.to_text();
        self.lock()
            .keep(|client| client.id != id || client.take(Message::Text(text.clone().into())));
    }

    fn lock(&self) -> MutexGuard<'_, List> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl List {
    fn find(&mut self, id: u32) -> Option<&mut Client> {
        self.clients.iter_mut().find(|client| client.id == id)
    }

    fn keep(&mut self, stays: impl FnMut(&mut Client) -> bool) {
        self.clients.retain_mut(stays);
    }
}

impl Client {
    /// True if it has a credit and reads its messages: a client that grants credits without reading gets no more.
    fn wants_a_frame(&self) -> bool {
        self.credits > 0 && self.waiting < MOST_CREDITS
    }

    /// True if it needs a picture after `changes` changes.
    fn lacks(&self, changes: u64) -> bool {
        self.shown != changes && self.wants_a_frame()
    }

    /// Time at which that picture is to be made.
    fn next_picture(&self) -> Instant {
        self.next_draw.due(self.credits)
    }

    /// Queues a message without waiting; returns `false` if too many already wait.
    fn take(&self, message: Message) -> bool {
        self.sender.try_send(message).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    static TOPOLOGY: Bytes = Bytes::from_static(b"topology");

    /// A later time than any at which pictures are due.
    fn later() -> Instant {
        Instant::now() + Duration::from_secs(60)
    }

    /// A picture after this number of changes.
    fn picture(changes: u64) -> Picture<'static> {
        Picture {
            message: vec![0; 64],
            changes,
            topology: &TOPOLOGY,
            epoch: 1,
        }
    }

    #[test]
    fn a_frame_takes_a_credit_and_a_grant_gives_one() {
        let clients = Clients::default();
        let (id, mut messages) = clients.enter().unwrap();
        let mut sent = 0;
        while clients.next_picture(sent + 1).is_some() {
            sent += 1;
            clients.show(picture(sent), later());
        }
        assert_eq!(sent, u64::from(FIRST_CREDITS));
        clients.grant(id, Duration::ZERO);
        assert!(clients.next_picture(sent + 1).is_some());
        // The topology comes once, before the first picture.
        assert!(
            matches!(messages.try_recv(), Ok(Message::Binary(first)) if &first[..] == b"topology")
        );
        for _ in 0..FIRST_CREDITS {
            assert!(matches!(messages.try_recv(), Ok(Message::Binary(next)) if next.len() == 64));
        }
        assert!(messages.try_recv().is_err());
    }

    #[test]
    fn credits_have_a_bound() {
        let clients = Clients::default();
        let (id, _messages) = clients.enter().unwrap();
        for _ in 0..1000 {
            clients.grant(id, Duration::ZERO);
        }
        let mut sent = 0;
        while clients.next_picture(sent + 1).is_some() && sent < 1000 {
            sent += 1;
            clients.show(picture(sent), later());
        }
        assert_eq!(sent, u64::from(MOST_CREDITS));
    }

    #[test]
    fn pictures_do_not_pile_up_for_one_that_grants_and_reads_nothing() {
        let clients = Clients::default();
        let (id, _messages) = clients.enter().unwrap();
        let mut sent = 0;
        for _ in 0..1000 {
            clients.grant(id, Duration::ZERO);
            if clients.next_picture(sent + 1).is_some() {
                sent += 1;
                clients.show(picture(sent), later());
            }
        }
        assert_eq!(sent, u64::from(MOST_CREDITS));
        clients.sent(id);
        assert!(clients.next_picture(sent + 1).is_some());
    }

    #[test]
    fn one_that_had_no_credit_gets_the_last_picture_later() {
        let clients = Clients::default();
        let (late, _of_late) = clients.enter().unwrap();
        let (other, _of_other) = clients.enter().unwrap();
        for changes in 1..=3 {
            clients.grant(other, Duration::ZERO);
            clients.show(picture(changes), later());
        }
        assert_eq!(clients.next_picture(3), None);
        clients.grant(other, Duration::ZERO);
        assert_eq!(clients.next_picture(3), None, "it has the last one");
        clients.grant(late, Duration::ZERO);
        assert!(clients.next_picture(3).is_some());
    }

    #[test]
    fn one_that_draws_later_is_left_its_credit_until_then() {
        let clients = Clients::default();
        let (first, mut of_first) = clients.enter().unwrap();
        let (second, mut of_second) = clients.enter().unwrap();
        clients.show(picture(1), later());
        clients.grant(first, Duration::ZERO);
        clients.grant(second, Duration::from_secs(60));
        for id in [first, second] {
            clients.lock().find(id).unwrap().credits = 1;
        }
        clients.show(picture(2), Instant::now());
        let pictures = |messages: &mut Receiver<Message>| {
            std::iter::from_fn(|| messages.try_recv().ok()).count() - 1
        };
        assert_eq!([pictures(&mut of_first), pictures(&mut of_second)], [2, 1]);
    }

    #[test]
    fn each_client_is_told_of_its_own_commands() {
        let clients = Clients::default();
        let (first, mut of_first) = clients.enter().unwrap();
        let (second, mut of_second) = clients.enter().unwrap();
        clients.applied(first, 7);
        clients.applied(second, 70_000);
        clients.show(picture(1), later());
        for (messages, expected) in [(&mut of_first, 7), (&mut of_second, 70_000_u32)] {
            messages.try_recv().unwrap();
            let Ok(Message::Binary(frame)) = messages.try_recv() else {
                panic!("expected a frame");
            };
            assert_eq!(frame[APPLIED_AT..APPLIED_AT + 4], expected.to_le_bytes());
        }
    }

    #[test]
    fn a_client_that_reads_nothing_is_let_go_and_others_stay() {
        let clients = Clients::default();
        let (_deaf, of_deaf) = clients.enter().unwrap();
        let (_other, mut of_other) = clients.enter().unwrap();
        for _ in 0..2 * MOST_WAITING {
            clients.tell_all(&Event::Refused {
                reason: String::new(),
            });
            of_other.try_recv().unwrap();
        }
        assert_eq!(clients.lock().clients.len(), 1);
        drop(of_deaf);
    }

    #[test]
    fn there_are_only_so_many_clients() {
        let clients = Clients::default();
        let all: Vec<_> = (0..100).map_while(|_| clients.enter()).collect();
        assert_eq!(all.len(), MOST_CLIENTS);
        clients.leave(all[0].0);
        assert!(clients.enter().is_some());
    }
}
