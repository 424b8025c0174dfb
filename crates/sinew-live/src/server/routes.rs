//! The addresses of the server.

use std::sync::Arc;

use axum::Router;
use axum::extract::{ConnectInfo, Path, State, WebSocketUpgrade};
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use axum::routing::get;

use super::guests::Standing;
use super::shared::Shared;
use super::token::Token;
use super::{assets, guard, socket};

/// Longest message of a page (bytes): commands take some hundred.
const LONGEST_MESSAGE: usize = 16 * 1024;

/// Largest number of bytes that wait for a page which does not read: enough for a picture of a large body and its
/// topology, but a limit for responses to pings.
const MOST_UNREAD: usize = 64 << 20;

/// Content security policy: sources that the page may load; framing it is forbidden.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

#[derive(Clone)]
struct Door {
    shared: Arc<Shared>,
    token: Token,
}

/// The addresses: the page, its files, and the connection, all below the token.
pub(crate) fn router(shared: Arc<Shared>, token: Token) -> Router {
    Router::new()
        .route("/{token}/", get(page))
        .route("/{token}/socket", get(connect))
        .route("/{token}/{name}", get(file))
        .fallback(async || refusal(StatusCode::NOT_FOUND))
        .with_state(Door { shared, token })
}

async fn page(
    State(door): State<Door>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&door, &token, &standing), "", &headers)
}

async fn file(
    State(door): State<Door>,
    Path((token, name)): Path<(String, String)>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&door, &token, &standing), &name, &headers)
}

fn asset(
    (door, token, standing): (&Door, &str, &Standing),
    name: &str,
    headers: &HeaderMap,
) -> Response {
    if !guard::is_for_this_computer(headers) {
        return refusal(StatusCode::FORBIDDEN);
    }
    if !door.token.is(token) {
        return refusal(StatusCode::NOT_FOUND);
    }
    standing.know();
    match assets::find(name) {
        None => refusal(StatusCode::NOT_FOUND),
        Some(asset) => (
            [
                (CONTENT_TYPE, asset.kind),
                (CACHE_CONTROL, "no-store"),
                (CONTENT_SECURITY_POLICY, POLICY),
                (REFERRER_POLICY, "no-referrer"),
                (X_CONTENT_TYPE_OPTIONS, "nosniff"),
            ],
            asset.content,
        )
            .into_response(),
    }
}

async fn connect(
    State(door): State<Door>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    if !guard::is_from_own_page(&headers) {
        return refusal(StatusCode::FORBIDDEN);
    }
    if !door.token.is(&token) {
        return refusal(StatusCode::NOT_FOUND);
    }
    standing.know();
    upgrade
        .max_message_size(LONGEST_MESSAGE)
        .max_frame_size(LONGEST_MESSAGE)
        .max_write_buffer_size(MOST_UNREAD)
        .on_upgrade(async move |stream| socket::talk(stream, door.shared, standing).await)
}

fn refusal(status: StatusCode) -> Response {
    let reason = match status {
        StatusCode::FORBIDDEN => "this server answers its own page on this computer alone\n",
        _ => "no such page; the address that `sinew live` printed has a secret in it\n",
    };
    (status, reason).into_response()
}
