//! Signing researchers in and out.

use crate::app::App;
use crate::error::ApiError;
use crate::extract::{Object, cookie};
use crate::password::{RESEARCHER, random_token, verify};
use axum::extract::{ConnectInfo, Request, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use kelir_store::sha256_hex;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The cookie that holds a researcher's token.
pub(crate) const COOKIE: &str = "kelir_session";
const LASTING: Duration = Duration::from_secs(12 * 3600);

pub(crate) async fn post_login(State(app): State<Arc<App>>, request: Request) -> Result<Response, ApiError> {
    use axum::extract::FromRequest;
    let address = request.extensions().get::<ConnectInfo<SocketAddr>>().map(|info| info.0.ip());
    let address = address.unwrap_or(IpAddr::V4(Ipv4Addr::UNSPECIFIED));
    let body = Object::from_request(request, &()).await?;
    body.only(&["password"])?;
    let password = body.string("password")?.to_owned();
    if password.len() > 1024 {
        return Err(ApiError::field("password", "must have at most 1024 bytes"));
    }
    app.limiter.attempt(address, Instant::now()).map_err(|seconds| {
        let message = format!("Too many tries; please wait {seconds} seconds.");
        ApiError::new(StatusCode::TOO_MANY_REQUESTS, "too_many_tries", message).retry_after(seconds)
    })?;
    let hash = app.store.password_hash(RESEARCHER).await?;
    let hash = hash.ok_or_else(|| ApiError::internal("no researcher password is set"))?;
    let permit = app.judging.acquire().await.map_err(ApiError::internal)?;
    let right =
        tokio::task::spawn_blocking(move || verify(&password, &hash)).await.map_err(ApiError::internal)?;
    drop(permit);
    if !right {
        return Err(ApiError::new(StatusCode::UNAUTHORIZED, "wrong_password", "That is not the password."));
    }
    app.limiter.forgive(address);
    let token = random_token();
    app.store.sign_in(RESEARCHER, &sha256_hex(token.as_bytes()), LASTING).await?;
    Ok(no_content(&app, &token, LASTING.as_secs()))
}

pub(crate) async fn post_logout(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
) -> Result<Response, ApiError> {
    if let Some(token) = cookie(&headers, COOKIE) {
        app.store.sign_out(&sha256_hex(token.as_bytes())).await?;
    }
    Ok(no_content(&app, "", 0))
}

fn no_content(app: &App, token: &str, seconds: u64) -> Response {
    let secure = if app.secure_cookies { "; Secure" } else { "" };
    let cookie = format!("{COOKIE}={token}; HttpOnly; SameSite=Strict; Path=/; Max-Age={seconds}{secure}");
    (StatusCode::NO_CONTENT, [(header::SET_COOKIE, cookie), (header::CACHE_CONTROL, "no-store".to_owned())])
        .into_response()
}
