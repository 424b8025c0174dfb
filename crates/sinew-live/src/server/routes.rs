//! The addresses of the server of a session.

use std::sync::Arc;

use axum::Router;
use axum::extract::{ConnectInfo, Path, State, WebSocketUpgrade};
use axum::http::{HeaderMap, StatusCode};
use axum::response::Response;
use axum::routing::get;

use super::answers::{admit, admit_own_page, content, refusal};
use super::guests::Standing;
use super::shared::Shared;
use super::token::Token;
use super::{assets, socket};

/// Longest message of a page (bytes): commands take some hundred.
const LONGEST_MESSAGE: usize = 16 * 1024;

/// Largest number of bytes that wait for a page which does not read: enough for a picture of a large body and its
/// topology, but a limit for responses to pings.
const MOST_UNREAD: usize = 64 << 20;

#[derive(Clone)]
struct Session {
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
        .with_state(Session { shared, token })
}

async fn page(
    State(session): State<Session>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&session, &token, &standing), "", &headers)
}

async fn file(
    State(session): State<Session>,
    Path((token, name)): Path<(String, String)>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&session, &token, &standing), &name, &headers)
}

fn asset(
    (session, token, standing): (&Session, &str, &Standing),
    name: &str,
    headers: &HeaderMap,
) -> Response {
    if let Err(refused) = admit(headers, (&session.token, token), standing) {
        return refusal(refused);
    }
    match assets::find(assets::OF_SESSION, name) {
        None => refusal(StatusCode::NOT_FOUND),
        Some(asset) => content(asset.kind, asset.content),
    }
}

async fn connect(
    State(session): State<Session>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    if let Err(refused) = admit_own_page(&headers, (&session.token, &token), &standing) {
        return refusal(refused);
    }
    upgrade
        .max_message_size(LONGEST_MESSAGE)
        .max_frame_size(LONGEST_MESSAGE)
        .max_write_buffer_size(MOST_UNREAD)
        .on_upgrade(async move |stream| socket::talk(stream, session.shared, standing).await)
}
