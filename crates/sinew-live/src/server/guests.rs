//! Connections to the server: limits of their number and of their idle time.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicUsize, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use futures_util::task::AtomicWaker;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, Sleep, sleep_until};

/// Largest number of simultaneous connections: each page needs a few while it loads, and one afterwards.
const MOST: usize = 64;

/// Time after which a connection without a page ends if it reads no response.
const PATIENCE: Duration = Duration::from_secs(10);

/// Largest number of simultaneous connections that have not sent the secret of the page's address. A further one
/// dismisses the oldest of them, so that connections with the secret are always served.
const MOST_STRANGERS: usize = 16;

/// Time limit for a connection to send the secret.
const PATIENCE_WITH_STRANGERS: Duration = Duration::from_secs(3);

/// A listener whose connections are counted and timed, so that idle ones leave capacity for pages.
#[derive(Debug)]
pub(crate) struct Guests {
    listener: TcpListener,
    open: Arc<AtomicUsize>,
    /// Connections that have not sent the secret, the oldest first.
    strangers: VecDeque<Standing>,
    limits: Limits,
}

/// Numbers of connections and their times.
#[derive(Clone, Copy, Debug)]
struct Limits {
    most: usize,
    strangers: usize,
    patience: Duration,
    with_strangers: Duration,
}

impl Guests {
    pub(crate) fn of(listener: TcpListener) -> Self {
        Self {
            listener,
            open: Arc::default(),
            strangers: VecDeque::new(),
            limits: Limits {
                most: MOST,
                strangers: MOST_STRANGERS,
                patience: PATIENCE,
                with_strangers: PATIENCE_WITH_STRANGERS,
            },
        }
    }

    /// Admits a new connection, and dismisses the oldest stranger if there are too many.
    fn receive(&mut self, standing: &Standing) {
        self.strangers.retain(Standing::is_stranger);
        if self.strangers.len() >= self.limits.strangers
            && let Some(oldest) = self.strangers.pop_front()
        {
            oldest.dismiss();
        }
        self.strangers.push_back(standing.clone());
    }
}

impl Listener for Guests {
    type Io = Guest;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guest, SocketAddr) {
        loop {
            let (stream, address) = Listener::accept(&mut self.listener).await;
            let seat = Seat::take(&self.open);
            if self.open.load(Ordering::Relaxed) <= self.limits.most {
                // Else a picture waits for word of the one before, which may come a draw later. A connection that is gone shows that soon enough.
                let _ = stream.set_nodelay(true);
                let guest = Guest::new(stream, seat, self.limits);
                self.receive(&guest.standing);
                return (guest, address);
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection that is counted while it is open.
#[derive(Debug)]
struct Seat(Arc<AtomicUsize>);

impl Seat {
    fn take(open: &Arc<AtomicUsize>) -> Self {
        open.fetch_add(1, Ordering::Relaxed);
        Self(Arc::clone(open))
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The status of a connection: a stranger, one that has sent the secret, a page, or a dismissed one.
#[derive(Clone, Debug, Default)]
pub(crate) struct Standing(Arc<Inner>);

#[derive(Debug, Default)]
struct Inner {
    rank: AtomicU8,
    /// The task that waits for the connection.
    waker: AtomicWaker,
}

const STRANGER: u8 = 0;
const KNOWN: u8 = 1;
const PAGE: u8 = 2;
const DISMISSED: u8 = 3;

impl Standing {
    /// Marks the connection as one that has sent the secret.
    pub(crate) fn know(&self) {
        let _ = self.raise(STRANGER, KNOWN);
    }

    /// Marks the connection as a page, which may be silent without limit.
    pub(crate) fn stay(&self) {
        let _ = self.raise(KNOWN, PAGE);
    }

    fn dismiss(&self) {
        if self.raise(STRANGER, DISMISSED) {
            self.0.waker.wake();
        }
    }

    /// Changes the rank from one to another; returns true if the connection had the first rank.
    fn raise(&self, from: u8, to: u8) -> bool {
        let raised = self
            .0
            .rank
            .compare_exchange(from, to, Ordering::AcqRel, Ordering::Acquire);
        raised.is_ok()
    }

    fn rank(&self) -> u8 {
        self.0.rank.load(Ordering::Acquire)
    }

    /// True if the connection is open and has not sent the secret.
    fn is_stranger(&self) -> bool {
        // Its connection has the other half.
        Arc::strong_count(&self.0) > 1 && self.rank() == STRANGER
    }
}

impl Connected<IncomingStream<'_, Guests>> for Standing {
    fn connect_info(stream: IncomingStream<'_, Guests>) -> Self {
        stream.io().standing.clone()
    }
}

/// A connection, which fails when it waits for longer than a limit: that for strangers counts from the
/// beginning of the connection, that for others from the last response that was partly read.
#[derive(Debug)]
pub(crate) struct Guest {
    stream: TcpStream,
    standing: Standing,
    patience: Duration,
    end: Pin<Box<Sleep>>,
    _seat: Seat,
}

impl Guest {
    fn new(stream: TcpStream, seat: Seat, limits: Limits) -> Self {
        Self {
            stream,
            standing: Standing::default(),
            patience: limits.patience,
            end: Box::pin(sleep_until(Instant::now() + limits.with_strangers)),
            _seat: seat,
        }
    }

    /// Returns an error instead of waiting if it has waited too long or is dismissed.
    fn waits<T>(&mut self, context: &mut Context<'_>) -> Poll<io::Result<T>> {
        self.standing.0.waker.register(context.waker());
        match self.standing.rank() {
            PAGE => return Poll::Pending,
            DISMISSED => {}
            _ => ready!(self.end.as_mut().poll(context)),
        }
        Poll::Ready(Err(ErrorKind::TimedOut.into()))
    }

    fn wrote<T>(
        &mut self,
        written: Poll<io::Result<T>>,
        context: &mut Context<'_>,
    ) -> Poll<io::Result<T>> {
        if written.is_pending() {
            return self.waits(context);
        }
        if self.standing.rank() != STRANGER {
            let end = Instant::now() + self.patience;
            self.end.as_mut().reset(end);
        }
        written
    }
}

impl AsyncRead for Guest {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        match Pin::new(&mut self.stream).poll_read(context, buffer) {
            Poll::Pending => self.waits(context),
            // One that asks without an end is a stranger for no longer than one that is silent.
            _ if self.standing.rank() == STRANGER && self.end.deadline() <= Instant::now() => {
                Poll::Ready(Err(ErrorKind::TimedOut.into()))
            }
            read => read,
        }
    }
}

impl AsyncWrite for Guest {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.wrote(written, context)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[io::IoSlice<'_>],
    ) -> Poll<io::Result<usize>> {
        let written = Pin::new(&mut self.stream).poll_write_vectored(context, bytes);
        self.wrote(written, context)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}

#[cfg(test)]
mod tests {
    use std::future::Future;

    use tokio::io::{AsyncReadExt, AsyncWriteExt};
    use tokio::runtime::Builder;
    use tokio::time::timeout;

    use super::*;

    fn with_guests<F: Future>(
        most: usize,
        test: impl FnOnce(Guests, SocketAddr) -> F,
    ) -> F::Output {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
            let address = listener.local_addr().unwrap();
            let patience = Duration::from_millis(200);
            let limits = Limits {
                most,
                strangers: most,
                patience,
                with_strangers: patience,
            };
            let guests = Guests {
                limits,
                ..Guests::of(listener)
            };
            test(guests, address).await
        })
    }

    #[test]
    fn one_that_says_nothing_is_let_go_and_a_page_stays() {
        with_guests(2, async |mut guests, address| {
            let _idle = TcpStream::connect(address).await.unwrap();
            let (mut idle, _) = guests.accept().await;
            let mut page = TcpStream::connect(address).await.unwrap();
            let (mut own, _) = guests.accept().await;
            assert!(own.stream.nodelay().unwrap());
            own.standing.know();
            own.standing.stay();
            let mut byte = [0];
            let ended = idle.read(&mut byte).await.unwrap_err();
            assert_eq!(ended.kind(), ErrorKind::TimedOut);
            let waited = timeout(Duration::from_millis(400), own.read(&mut byte)).await;
            assert!(waited.is_err(), "it waits on");
            page.write_all(b"x").await.unwrap();
            assert_eq!(own.read(&mut byte).await.unwrap(), 1);
        });
    }

    #[test]
    fn beyond_the_most_newcomers_are_dropped_until_others_have_gone() {
        with_guests(3, async |mut guests, address| {
            let mut outside = Vec::new();
            for _ in 0..5 {
                outside.push(TcpStream::connect(address).await.unwrap());
            }
            let mut inside = Vec::new();
            for _ in 0..3 {
                let (guest, _) = guests.accept().await;
                guest.standing.know();
                inside.push(guest);
            }
            let soon = Duration::from_millis(100);
            assert!(timeout(soon, guests.accept()).await.is_err());
            let mut byte = [0];
            assert_eq!(outside[4].read(&mut byte).await.unwrap(), 0);
            inside.pop();
            outside.push(TcpStream::connect(address).await.unwrap());
            assert!(timeout(soon, guests.accept()).await.is_ok());
        });
    }

    #[test]
    fn the_oldest_stranger_makes_room_for_a_newcomer() {
        with_guests(2, async |mut guests, address| {
            guests.limits.most = 64;
            let mut outside = Vec::new();
            let mut inside = Vec::new();
            for known in [false, true, false, false] {
                outside.push(TcpStream::connect(address).await.unwrap());
                let (guest, _) = guests.accept().await;
                if known {
                    guest.standing.know();
                }
                inside.push(guest);
            }
            let mut byte = [0];
            let soon = Duration::from_millis(50);
            for (place, goes) in [(0, true), (1, false), (2, false), (3, false)] {
                let read = timeout(soon, inside[place].read(&mut byte)).await;
                assert_eq!(matches!(read, Ok(Err(_))), goes, "{place}");
            }
        });
    }

    #[test]
    fn answers_do_not_prolong_the_time_of_a_stranger() {
        with_guests(2, async |mut guests, address| {
            let mut talker = TcpStream::connect(address).await.unwrap();
            let (mut own, _) = guests.accept().await;
            let mut known = TcpStream::connect(address).await.unwrap();
            let (mut page, _) = guests.accept().await;
            page.standing.know();
            let (mut byte, begun) = ([0], Instant::now());
            let mut ended = false;
            while begun.elapsed() < Duration::from_millis(600) {
                // One that was let go takes nothing.
                let _ = talker.write_all(b"x").await;
                known.write_all(b"x").await.unwrap();
                ended |= own.read(&mut byte).await.is_err();
                let _ = own.write_all(b"y").await;
                page.read_exact(&mut byte).await.unwrap();
                page.write_all(b"y").await.unwrap();
                tokio::time::sleep(Duration::from_millis(20)).await;
                assert!(begun.elapsed() > Duration::from_millis(150) || !ended);
                if ended {
                    break;
                }
            }
            assert!(ended);
        });
    }
}
