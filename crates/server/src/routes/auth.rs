//! Signing researchers in and out.

use super::{Answered, Fresh, no_content};
use crate::api::{Problem, ProblemCode, SignIn, SignedIn, refusals};
use crate::app::App;
use crate::audit::AUDIT;
use crate::extract::{Body, COOKIE, ClientAddress, Researcher, cookie};
use crate::password::{RESEARCHER, verify};
use axum::extract::State;
use axum::http::{HeaderMap, header};
use axum::response::{IntoResponse, Response};
use kelir_house::random_token;
use kelir_store::sha256_hex;
use std::sync::Arc;
use std::time::{Duration, Instant};

const LASTING: Duration = Duration::from_secs(12 * 3600);

refusals!(NotSignedIn: BadBody, BadJson, NotJson, TooLarge, InvalidField, WrongPassword);

/// Sign in: the answer sets the cookie `kelir_session`, for twelve hours.
///
/// After wrong passwords an answer takes longer, up to some seconds; nobody is locked out.
#[utoipa::path(
    post, path = "/api/v1/auth/session", tag = "sign-in", request_body = SignIn,
    responses(
        (status = NO_CONTENT, description = "Signed in.", headers(("Set-Cookie" = String, description = "`kelir_session`"))),
        NotSignedIn,
    )
)]
pub(crate) async fn sign_in(
    State(app): State<Arc<App>>,
    ClientAddress(address): ClientAddress,
    Body(SignIn { password }): Body<SignIn>,
) -> Result<Response, Box<Problem>> {
    tokio::time::sleep(app.limiter.attempt(address, Instant::now())).await;
    let hash = app.store.password_hash(RESEARCHER).await?;
    let hash = hash.ok_or_else(|| Problem::internal("no researcher password is set"))?;
    let permit = app.judging.acquire().await.map_err(Problem::internal)?;
    let right =
        tokio::task::spawn_blocking(move || verify(&password, &hash)).await.map_err(Problem::internal)?;
    drop(permit);
    if !right {
        tracing::warn!(target: AUDIT, "a sign-in failed: wrong password");
        tokio::time::sleep(app.limiter.refused(Instant::now())).await;
        return Err(Problem::new(ProblemCode::WrongPassword, "That is not the password."));
    }
    app.limiter.forgive(address, Instant::now());
    let token = random_token();
    app.store.sign_in(RESEARCHER, &sha256_hex(token.as_bytes()), LASTING).await?;
    tracing::info!(target: AUDIT, who = RESEARCHER, "signed in");
    Ok(with_cookie(&app, &token, LASTING.as_secs()))
}

refusals!(Nobody: Unauthorized);

/// Who is signed in.
#[utoipa::path(
    get, path = "/api/v1/auth/session", tag = "sign-in", security(("researcher" = [])),
    responses((status = OK, description = "A researcher.", body = SignedIn), Nobody)
)]
pub(crate) async fn get_signed_in(Researcher(name): Researcher) -> Answered<SignedIn> {
    Ok(Fresh(SignedIn { name }))
}

refusals!(SignOut:);

/// Sign out; whoever is not signed in stays so.
#[utoipa::path(
    delete, path = "/api/v1/auth/session", tag = "sign-in", security((), ("researcher" = [])),
    responses((status = NO_CONTENT, description = "Signed out."), SignOut)
)]
pub(crate) async fn sign_out(
    State(app): State<Arc<App>>,
    headers: HeaderMap,
) -> Result<Response, Box<Problem>> {
    if let Some(token) = cookie(&headers, COOKIE) {
        app.store.sign_out(&sha256_hex(token.as_bytes())).await?;
        tracing::info!(target: AUDIT, "signed out");
    }
    Ok(with_cookie(&app, "", 0))
}

fn with_cookie(app: &App, token: &str, seconds: u64) -> Response {
    let secure = if app.secure_cookies { "; Secure" } else { "" };
    let cookie = format!("{COOKIE}={token}; HttpOnly; SameSite=Strict; Path=/; Max-Age={seconds}{secure}");
    ([(header::SET_COOKIE, cookie)], no_content()).into_response()
}
