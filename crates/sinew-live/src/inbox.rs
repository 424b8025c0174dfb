//! Requests of pages to the simulation.

use std::collections::VecDeque;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crate::protocol::Order;

/// Largest number of orders that wait: a user does not give more.
const MOST_ORDERS: usize = 256;

/// A request of a client, by the number that the client gave it.
#[derive(Clone, Debug)]
pub(crate) struct Request<T> {
    /// The client.
    pub(crate) client: u32,
    /// The client's own number of the command.
    pub(crate) id: u32,
    /// The request itself.
    pub(crate) what: T,
}

impl<T> Request<T> {
    /// A request of a client under the client's number.
    pub(crate) fn of(client: u32, id: u32, what: T) -> Self {
        Self { client, id, what }
    }
}

/// Position (m) and rotation vector (rad) of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Number of the tool.
    pub(crate) tool: usize,
    /// Position (m), then rotation vector (rad).
    pub(crate) pose: [f64; 6],
}

/// Requests that wait for the simulation: the latest pose of each tool from each client; the last of consecutive
/// settings of one kind from a client; all other requests, in order.
#[derive(Debug, Default)]
pub(crate) struct Waiting {
    /// The latest pose of each tool from each client, in the order in which they arrived.
    pub(crate) poses: Vec<Request<Place>>,
    /// All other requests, in the order in which they arrived.
    pub(crate) orders: VecDeque<Request<Order>>,
    /// New clients, which have not received the settings.
    pub(crate) entered: Vec<u32>,
    /// True if the simulation must end.
    pub(crate) ends: bool,
    woken: bool,
}

impl Waiting {
    /// Discards the requests of some clients.
    pub(crate) fn forget(&mut self, is_gone: impl Fn(u32) -> bool) {
        self.poses.retain(|pose| !is_gone(pose.client));
        self.orders.retain(|order| !is_gone(order.client));
        self.entered.retain(|client| !is_gone(*client));
    }

    /// The index of an order of the same client that sets the same value, after which only settings wait.
    fn idle_beside(&self, request: &Request<Order>) -> Option<usize> {
        let wanted = setting(&request.what)?;
        let last = self.orders.iter().enumerate().rev();
        let mut settings =
            last.map_while(|(place, order)| Some((place, order.client, setting(&order.what)?)));
        let same =
            settings.find(|(_, client, other)| *client == request.client && *other == wanted);
        same.map(|(place, ..)| place)
    }
}

/// A value that an order sets.
#[derive(PartialEq)]
enum Setting<'a> {
    Step { pane: usize },
    Option { pane: usize, key: &'a str },
    Pull,
}

/// The value that an order sets, if it does.
fn setting(order: &Order) -> Option<Setting<'_>> {
    match order {
        Order::Dt { pane, .. } => Some(Setting::Step { pane: *pane }),
        Order::Option { pane, key, .. } => Some(Setting::Option { pane: *pane, key }),
        Order::Pull { .. } => Some(Setting::Pull),
        _ => None,
    }
}

/// The queue of all requests from pages to the simulation.
#[derive(Debug, Default)]
pub(crate) struct Inbox {
    waiting: Mutex<Waiting>,
    wake: Condvar,
}

impl Inbox {
    /// Queues a pose after the others, and discards an earlier one of the same client for the same tool.
    pub(crate) fn pose(&self, request: Request<Place>) {
        let mut waiting = self.lock();
        let is_same = |earlier: &Request<Place>| {
            earlier.client == request.client && earlier.what.tool == request.what.tool
        };
        waiting.poses.retain(|earlier| !is_same(earlier));
        waiting.poses.push(request);
        self.wake(waiting);
    }

    /// Queues an order after the others; returns `false` if too many wait. A setting replaces one that it makes
    /// obsolete: a dragged slider requests hundreds, each of which sets up a method.
    pub(crate) fn order(&self, request: Request<Order>) -> bool {
        let mut waiting = self.lock();
        if let Some(place) = waiting.idle_beside(&request) {
            waiting.orders.remove(place);
        }
        let has_room = waiting.orders.len() < MOST_ORDERS;
        if has_room {
            waiting.orders.push_back(request);
        }
        self.wake(waiting);
        has_room
    }

    /// Reports a new client.
    pub(crate) fn enter(&self, client: u32) {
        let mut waiting = self.lock();
        waiting.entered.push(client);
        self.wake(waiting);
    }

    /// Discards the requests of a client that has left.
    pub(crate) fn leave(&self, client: u32) {
        let mut waiting = self.lock();
        waiting.forget(|other| other == client);
    }

    /// Wakes the simulation after a page gave a credit.
    pub(crate) fn nudge(&self) {
        self.wake(self.lock());
    }

    /// Ends the simulation.
    pub(crate) fn end(&self) {
        let mut waiting = self.lock();
        waiting.ends = true;
        self.wake(waiting);
    }

    /// Moves waiting requests into `taken`, which keeps its capacity, after waiting for at most `patience`. As long as
    /// orders remain in `taken`, further orders and the poses after them continue to wait here.
    pub(crate) fn take(&self, taken: &mut Waiting, patience: Duration) {
        let mut waiting = self.lock();
        if !waiting.woken && !patience.is_zero() {
            let slept = self.wake.wait_timeout(waiting, patience);
            waiting = slept.unwrap_or_else(PoisonError::into_inner).0;
        }
        if taken.orders.is_empty() {
            taken.poses.append(&mut waiting.poses);
            taken.orders.append(&mut waiting.orders);
        }
        taken.entered.append(&mut waiting.entered);
        taken.ends = waiting.ends;
        waiting.woken = false;
    }

    fn wake(&self, mut waiting: MutexGuard<'_, Waiting>) {
        waiting.woken = true;
        drop(waiting);
        self.wake.notify_one();
    }

    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pose(tool: usize, id: u32) -> Request<Place> {
        let pose = [f64::from(id); 6];
        Request::of(1, id, Place { tool, pose })
    }

    #[test]
    fn poses_of_two_clients_for_one_tool_wait_in_their_order() {
        let (inbox, mut taken) = (Inbox::default(), Waiting::default());
        for (client, id) in [(1, 1), (2, 1), (1, 2)] {
            inbox.pose(Request {
                client,
                ..pose(0, id)
            });
        }
        inbox.take(&mut taken, Duration::ZERO);
        let of = |request: &Request<Place>| (request.client, request.id);
        let poses: Vec<_> = taken.poses.iter().map(of).collect();
        assert_eq!(poses, [(2, 1), (1, 2)]);
    }

    #[test]
    fn of_poses_the_latest_is_kept_and_of_orders_all() {
        let (inbox, mut taken) = (Inbox::default(), Waiting::default());
        for id in 0..5 {
            inbox.pose(pose(id as usize % 2, id));
            assert!(inbox.order(Request::of(1, id, Order::Step)));
        }
        inbox.take(&mut taken, Duration::ZERO);
        let ids = |id: &Request<Place>| id.id;
        assert_eq!(taken.poses.iter().map(ids).collect::<Vec<_>>(), [3, 4]);
        let order: Vec<u32> = taken.orders.iter().map(|order| order.id).collect();
        assert_eq!(order, [0, 1, 2, 3, 4]);
        // What is left there is done before others.
        assert!(inbox.order(Request::of(1, 5, Order::Step)));
        inbox.pose(pose(0, 6));
        taken.orders.truncate(1);
        taken.poses.clear();
        inbox.take(&mut taken, Duration::ZERO);
        assert_eq!((taken.orders.len(), taken.poses.len()), (1, 0));
        taken.orders.clear();
        inbox.take(&mut taken, Duration::ZERO);
        assert_eq!((taken.orders[0].id, taken.poses[0].id), (5, 6));
    }

    #[test]
    fn of_the_steps_and_options_of_a_dragged_slider_the_last_is_kept() {
        let (inbox, mut taken) = (Inbox::default(), Waiting::default());
        let mut id = 0;
        let mut order = |client: u32, order: Order| {
            id += 1;
            assert!(inbox.order(Request::of(client, id, order)));
        };
        let dt = |pane: usize, dt: f64| Order::Dt { pane, dt };
        let option = |key: &str, number: f64| Order::Option {
            pane: 0,
            key: key.to_owned(),
            word: None,
            number: Some(number),
        };
        for k in 0..1000 {
            order(1, dt(0, f64::from(k)));
            order(1, option("sweeps", f64::from(k)));
            order(1, option("saturation", f64::from(k)));
            order(2, dt(0, 0.5));
        }
        order(1, Order::Step);
        order(1, dt(0, 0.25));
        order(1, dt(1, 0.25));
        inbox.take(&mut taken, Duration::ZERO);
        let orders: Vec<Order> = taken.orders.drain(..).map(|order| order.what).collect();
        let expected = [
            dt(0, 999.0),
            option("sweeps", 999.0),
            option("saturation", 999.0),
            dt(0, 0.5),
            Order::Step,
            dt(0, 0.25),
            dt(1, 0.25),
        ];
        assert_eq!(orders, expected);
    }

    #[test]
    fn a_client_that_goes_leaves_no_order() {
        let (inbox, mut taken) = (Inbox::default(), Waiting::default());
        for client in [1, 2, 1] {
            inbox.enter(client);
            inbox.pose(Request {
                client,
                ..pose(0, client)
            });
            assert!(inbox.order(Request::of(client, 1, Order::Step)));
        }
        inbox.leave(1);
        inbox.take(&mut taken, Duration::ZERO);
        let all = taken.orders.iter().map(|order| order.client);
        let all = all.chain(taken.poses.iter().map(|pose| pose.client));
        let all: Vec<u32> = all.chain(taken.entered.iter().copied()).collect();
        assert_eq!(all, [2, 2, 2]);
    }

    #[test]
    fn a_flood_of_orders_is_cut() {
        let inbox = Inbox::default();
        let kept = (0..1000).filter(|id| inbox.order(Request::of(1, *id, Order::Reset)));
        let kept = kept.count();
        assert_eq!(kept, MOST_ORDERS);
    }
}
