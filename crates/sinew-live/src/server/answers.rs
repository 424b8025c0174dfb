//! Answers of the servers, with the headers that all of them have.

use axum::body::Body;
use axum::http::header::{
    CACHE_CONTROL, CONTENT_SECURITY_POLICY, CONTENT_TYPE, REFERRER_POLICY, X_CONTENT_TYPE_OPTIONS,
};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};

use super::guard;
use super::guests::Standing;
use super::token::Token;

/// Content security policy: sources that the page may load; framing it is forbidden.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src 'self' data:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// Refuses a request that names another computer or another secret, and notes a connection that has sent the secret.
pub(crate) fn admit(
    headers: &HeaderMap,
    (own, token): (&Token, &str),
    standing: &Standing,
) -> Result<(), StatusCode> {
    if !guard::is_for_this_computer(headers) {
        return Err(StatusCode::FORBIDDEN);
    }
    know((own, token), standing)
}

/// Same as [`admit`], for requests that change something: only a page of this server may send them.
pub(crate) fn admit_own_page(
    headers: &HeaderMap,
    (own, token): (&Token, &str),
    standing: &Standing,
) -> Result<(), StatusCode> {
    if !guard::is_from_own_page(headers) {
        return Err(StatusCode::FORBIDDEN);
    }
    know((own, token), standing)
}

fn know((own, token): (&Token, &str), standing: &Standing) -> Result<(), StatusCode> {
    if !own.is(token) {
        return Err(StatusCode::NOT_FOUND);
    }
    standing.know();
    Ok(())
}

/// A file or a message of this media type.
pub(crate) fn content(kind: &'static str, content: impl Into<Body>) -> Response {
    (
        [
            (CONTENT_TYPE, kind),
            (CACHE_CONTROL, "no-store"),
            (CONTENT_SECURITY_POLICY, POLICY),
            (REFERRER_POLICY, "no-referrer"),
            (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        ],
        content.into(),
    )
        .into_response()
}

/// A refusal as one sentence.
pub(crate) fn refusal(status: StatusCode) -> Response {
    let reason = match status {
        StatusCode::FORBIDDEN => "this server answers its own page on this computer alone\n",
        _ => "no such page; the address that `sinew live` printed has a secret in it\n",
    };
    (status, reason).into_response()
}
