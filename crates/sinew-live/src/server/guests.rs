//! Connections to the server: not too many, and none that says nothing for long.

use std::io::{self, ErrorKind};
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, Sleep, sleep_until};

/// Most connections at once: each page needs a few while it loads, and one from then on.
const MOST: usize = 64;

/// Time after which a connection ends that is no page's, and took no answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// A listener whose connections are counted and timed, so that idle ones leave room for pages.
#[derive(Debug)]
pub(crate) struct Guests {
    listener: TcpListener,
    open: Arc<AtomicUsize>,
    most: usize,
    patience: Duration,
}

impl Guests {
    pub(crate) fn of(listener: TcpListener) -> Self {
        Self {
            listener,
            open: Arc::default(),
            most: MOST,
            patience: PATIENCE,
        }
    }
}

impl Listener for Guests {
    type Io = Guest;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guest, SocketAddr) {
        loop {
            let (stream, address) = Listener::accept(&mut self.listener).await;
            let seat = Seat::take(&self.open);
            if self.open.load(Ordering::Relaxed) <= self.most {
                // Else a picture waits for word of the one before, which may come a draw later. A connection that is gone shows that soon enough.
                let _ = stream.set_nodelay(true);
                return (Guest::new(stream, seat, self.patience), address);
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection that is counted as long as it lives.
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

/// Lets a connection stay that is a page's.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stay(Arc<AtomicBool>);

impl Stay {
    /// From now on it may be silent as long as it likes.
    pub(crate) fn allow(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_allowed(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Connected<IncomingStream<'_, Guests>> for Stay {
    fn connect_info(stream: IncomingStream<'_, Guests>) -> Self {
        stream.io().stay.clone()
    }
}

/// A connection, which fails when it waits for longer than the patience: counted from its beginning, and anew from each answer that it took a part of.
#[derive(Debug)]
pub(crate) struct Guest {
    stream: TcpStream,
    stay: Stay,
    patience: Duration,
    end: Pin<Box<Sleep>>,
    _seat: Seat,
}

impl Guest {
    fn new(stream: TcpStream, seat: Seat, patience: Duration) -> Self {
        Self {
            stream,
            stay: Stay::default(),
            patience,
            end: Box::pin(sleep_until(Instant::now() + patience)),
            _seat: seat,
        }
    }

    /// An error where it has waited too long, instead of waiting on.
    fn waits<T>(&mut self, context: &mut Context<'_>) -> Poll<io::Result<T>> {
        if self.stay.is_allowed() {
            return Poll::Pending;
        }
        ready!(self.end.as_mut().poll(context));
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
        let end = Instant::now() + self.patience;
        self.end.as_mut().reset(end);
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
            let guests = Guests {
                most,
                patience,
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
            own.stay.allow();
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
                inside.push(guests.accept().await);
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
}
