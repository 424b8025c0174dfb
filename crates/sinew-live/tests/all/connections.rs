//! Connections that send nothing.

use std::io::Read;
use std::net::TcpStream;
use std::time::Duration;

use crate::common::{CUBE, Page, settings, time};

#[test]
fn idle_connections_are_let_go_and_pages_stay() {
    let page = Page::of(settings(CUBE));
    let mut client = page.connect();
    let t = time(&client.picture(|_| true));
    let mut idle: Vec<TcpStream> = (0..100)
        .map(|_| TcpStream::connect(page.host()).unwrap())
        .collect();
    for stream in &mut idle {
        stream
            .set_read_timeout(Some(Duration::from_secs(20)))
            .unwrap();
        // Its end, or a reset.
        let ended = stream.read(&mut [0]);
        assert!(
            !matches!(&ended, Err(error) if error.kind() == std::io::ErrorKind::WouldBlock),
            "{ended:?}"
        );
    }
    assert_eq!(page.get(page.host(), page.path()), 200);
    // Longer than an idle connection lives.
    client.picture(|picture| time(picture) > t + 10.5);
}
