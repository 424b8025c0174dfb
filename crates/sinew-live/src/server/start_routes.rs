//! The addresses of the server of the start page.

use std::sync::Arc;

use axum::Router;
use axum::extract::{ConnectInfo, DefaultBodyLimit, Path, State};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};

use super::answers::{admit, admit_own_page, content, refusal};
use super::assets;
use super::guests::Standing;
use super::token::Token;
use crate::offers::{Choice, Counter};

/// Longest name of a scene (bytes).
const LONGEST_NAME: usize = 256;

#[derive(Clone)]
struct Start {
    counter: Arc<Counter>,
    token: Token,
}

/// The addresses: the page, its files, its state and the choice of a scene, all below the token.
pub(crate) fn start_router(counter: Arc<Counter>, token: Token) -> Router {
    Router::new()
        .route("/{token}/", get(page))
        .route("/{token}/choose", post(choose))
        .route("/{token}/{name}", get(file))
        .layer(DefaultBodyLimit::max(LONGEST_NAME))
        .fallback(async || refusal(StatusCode::NOT_FOUND))
        .with_state(Start { counter, token })
}

async fn page(
    State(start): State<Start>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&start, &token, &standing), "", &headers)
}

async fn file(
    State(start): State<Start>,
    Path((token, name)): Path<(String, String)>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
) -> Response {
    asset((&start, &token, &standing), &name, &headers)
}

fn asset(
    (start, token, standing): (&Start, &str, &Standing),
    name: &str,
    headers: &HeaderMap,
) -> Response {
    if let Err(refused) = admit(headers, (&start.token, token), standing) {
        return refusal(refused);
    }
    if name == assets::STATE {
        return content("application/json", start.counter.to_json());
    }
    let picture = name.strip_suffix(".png");
    if let Some(picture) = picture.and_then(|scene| start.counter.picture(scene)) {
        return content("image/png", picture);
    }
    match assets::find(assets::OF_START, name) {
        None => refusal(StatusCode::NOT_FOUND),
        Some(asset) => content(asset.kind, asset.content),
    }
}

/// Chooses the scene whose name is the body of the request. The first choice holds.
async fn choose(
    State(start): State<Start>,
    Path(token): Path<String>,
    ConnectInfo(standing): ConnectInfo<Standing>,
    headers: HeaderMap,
    body: Result<String, axum::extract::rejection::StringRejection>,
) -> Response {
    if let Err(refused) = admit_own_page(&headers, (&start.token, &token), &standing) {
        return refusal(refused);
    }
    let chosen = body.map(|name| start.counter.choose(&name));
    match chosen {
        Ok(Choice::Taken) => StatusCode::NO_CONTENT.into_response(),
        Ok(Choice::Late) => (
            StatusCode::CONFLICT,
            "another scene was chosen before, and opens\n",
        )
            .into_response(),
        Ok(Choice::Unknown) => {
            (StatusCode::BAD_REQUEST, "no scene has this name\n").into_response()
        }
        Err(rejected) => (rejected.status(), "expected the name of a scene\n").into_response(),
    }
}
