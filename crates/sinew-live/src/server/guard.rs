//! Checks of requests: only pages of this server may connect to it.
//!
//! The server listens on this computer only. A foreign page in a browser of this computer can reach it too: either
//! directly, and then its `Origin` is foreign, or under a foreign name that was redirected to this computer (DNS
//! rebinding), and then `Host` is that name. So `Host` must be a name of this computer, with any port, since a
//! forwarded port may differ, and a connection must come from a page of exactly this host and port.

use axum::http::HeaderMap;
use axum::http::header::{HOST, ORIGIN};

/// Names of this computer. A name with a dot at its end is the same name in absolute form; upper and lower case are
/// equal (RFC 9110, section 4.2.3).
const NAMES: [&str; 4] = ["localhost", "localhost.", "127.0.0.1", "[::1]"];

/// True if a request names this computer.
pub(crate) fn is_for_this_computer(headers: &HeaderMap) -> bool {
    single(headers, HOST.as_str()).is_some_and(is_local)
}

/// True if a request comes from a page that this server sent.
pub(crate) fn is_from_own_page(headers: &HeaderMap) -> bool {
    let (host, origin) = (
        single(headers, HOST.as_str()),
        single(headers, ORIGIN.as_str()),
    );
    let (Some(host), Some(origin)) = (host, origin) else {
        return false;
    };
    let own = origin.strip_prefix("http://");
    is_local(host) && own.is_some_and(|own| own.eq_ignore_ascii_case(host))
}

/// The value of a header that occurs exactly once.
fn single<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    let mut values = headers.get_all(name).iter();
    let value = values.next()?.to_str().ok()?;
    values.next().is_none().then_some(value)
}

fn is_local(host: &str) -> bool {
    NAMES.iter().any(|name| {
        host.split_at_checked(name.len())
            .is_some_and(|(own, rest)| {
                own.eq_ignore_ascii_case(name) && (rest.is_empty() || is_port(rest))
            })
    })
}

fn is_port(text: &str) -> bool {
    let digits = text.strip_prefix(':');
    digits.is_some_and(|digits| {
        !digits.is_empty()
            && digits.len() <= 5
            && digits.bytes().all(|digit| digit.is_ascii_digit())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn headers(pairs: &[(&'static str, &'static str)]) -> HeaderMap {
        let mut headers = HeaderMap::new();
        for (name, value) in pairs {
            headers.append(*name, value.parse().unwrap());
        }
        headers
    }

    #[test]
    fn only_names_of_this_computer_are_hosts() {
        for host in [
            "localhost",
            "localhost:8080",
            "LOCALHOST:8080",
            "Localhost",
            "localhost.:8080",
            "127.0.0.1",
            "127.0.0.1:1",
            "[::1]",
            "[::1]:65535",
        ] {
            assert!(is_for_this_computer(&headers(&[("host", host)])), "{host}");
        }
        for host in [
            "evil.example",
            "localhost.evil.example",
            "localhost:",
            "localhost:80x",
            "127.0.0.1.evil.example:80",
            "localhost:123456",
            "",
            "192.168.0.1:80",
            "localhost@evil.example",
            "localhost..:80",
            ".localhost:80",
            "localhost.evil:80",
            "127.0.0.1.:80",
            "127.1:80",
            "0.0.0.0:80",
            "[::1",
            "[::1]80",
            "::1",
            "[::1].:80",
            "[::ffff:127.0.0.1]:80",
            " localhost",
        ] {
            assert!(!is_for_this_computer(&headers(&[("host", host)])), "{host}");
        }
        assert!(!is_for_this_computer(&headers(&[])));
        assert!(!is_for_this_computer(&headers(&[
            ("host", "localhost"),
            ("host", "evil.example")
        ])));
    }

    #[test]
    fn only_the_servers_own_page_may_connect() {
        let from = |host, origin| is_from_own_page(&headers(&[("host", host), ("origin", origin)]));
        assert!(from("localhost:4000", "http://localhost:4000"));
        assert!(from("[::1]:4000", "http://[::1]:4000"));
        assert!(from("localhost", "http://localhost"));
        // A browser writes the name of its page's origin in small letters, and keeps the trailing dot.
        assert!(from("LOCALHOST:4000", "http://localhost:4000"));
        assert!(from("localhost.:4000", "http://localhost.:4000"));
        assert!(!from("localhost.:4000", "http://localhost:4000"));
        assert!(!from("localhost", "http://localhost:4000"));
        // A page of another server on this computer, and strangers.
        assert!(!from("localhost:4000", "http://localhost:3000"));
        assert!(!from("localhost:4000", "http://127.0.0.1:4000"));
        assert!(!from("localhost:4000", "https://localhost:4000"));
        assert!(!from("localhost:4000", "http://evil.example"));
        assert!(!from("localhost:4000", "null"));
        assert!(!from("evil.example", "http://evil.example"));
        assert!(!is_from_own_page(&headers(&[("host", "localhost:4000")])));
    }
}
