//! What handlers take from a request; each refusal has the one error shape.

use crate::app::App;
use crate::error::ApiError;
use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, PathRejection};
use axum::extract::{FromRequest, FromRequestParts, Path, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, StatusCode, header};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::sync::Arc;

/// A request's JSON object, with the text it came as.
pub(crate) struct Object(pub(crate) Map<String, Value>);

impl<S: Send + Sync> FromRequest<S> for Object {
    type Rejection = ApiError;

    async fn from_request(request: Request, state: &S) -> Result<Self, ApiError> {
        let media_type =
            request.headers().get(header::CONTENT_TYPE).and_then(|v| v.to_str().ok()).unwrap_or_default();
        let media_type = media_type.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
        if media_type != "application/json" {
            let message = "The body must be JSON, with Content-Type: application/json.";
            return Err(ApiError::new(StatusCode::UNSUPPORTED_MEDIA_TYPE, "not_json", message));
        }
        let bytes =
            Bytes::from_request(request, state).await.map_err(|rejection: BytesRejection| match rejection
                .status()
            {
                StatusCode::PAYLOAD_TOO_LARGE => ApiError::new(
                    StatusCode::PAYLOAD_TOO_LARGE,
                    "too_large",
                    "The body is larger than this address takes.",
                ),
                _ => ApiError::new(StatusCode::BAD_REQUEST, "bad_body", "The body could not be read."),
            })?;
        match serde_json::from_slice(&bytes) {
            Ok(Value::Object(object)) => Ok(Object(object)),
            Ok(_) => {
                Err(ApiError::new(StatusCode::BAD_REQUEST, "bad_json", "The body must be a JSON object."))
            }
            Err(error) => {
                let message =
                    format!("The body is no JSON: line {}, column {}.", error.line(), error.column());
                Err(ApiError::new(StatusCode::BAD_REQUEST, "bad_json", message))
            }
        }
    }
}

impl Object {
    /// Refuses keys other than these.
    pub(crate) fn only(&self, known: &[&str]) -> Result<(), ApiError> {
        match self.0.keys().find(|key| !known.contains(&key.as_str())) {
            Some(key) => Err(ApiError::field(
                key.as_str(),
                format!("is not known here; known are {}", known.join(", ")),
            )),
            None => Ok(()),
        }
    }

    pub(crate) fn string(&self, key: &str) -> Result<&str, ApiError> {
        self.0.get(key).and_then(Value::as_str).ok_or_else(|| ApiError::field(key, "must be a text"))
    }

    /// A number that must be there, within `[low, high]`.
    pub(crate) fn number(&self, key: &str, low: f64, high: f64) -> Result<f64, ApiError> {
        self.optional_number(key, low, high)?.ok_or_else(|| ApiError::field(key, "must be a number"))
    }

    /// A number within `[low, high]`, absent or null.
    pub(crate) fn optional_number(&self, key: &str, low: f64, high: f64) -> Result<Option<f64>, ApiError> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(None),
            Some(value) => match value.as_f64() {
                Some(x) if x >= low && x <= high => Ok(Some(x)),
                _ => Err(ApiError::field(key, format!("must be a number from {low} to {high}"))),
            },
        }
    }

    /// A text of at most `most` bytes, absent or null.
    pub(crate) fn optional_text(&self, key: &str, most: usize) -> Result<(), ApiError> {
        match self.0.get(key) {
            None | Some(Value::Null) => Ok(()),
            Some(Value::String(text)) if text.len() <= most => Ok(()),
            Some(_) => Err(ApiError::field(key, format!("must be a text of at most {most} bytes"))),
        }
    }
}

/// The variable parts of an address.
pub(crate) struct Parameters<T>(pub(crate) T);

impl<T: DeserializeOwned + Send, S: Send + Sync> FromRequestParts<S> for Parameters<T> {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, ApiError> {
        Path::from_request_parts(parts, state)
            .await
            .map(|Path(inner)| Parameters(inner))
            .map_err(|_: PathRejection| ApiError::not_found("address"))
    }
}

/// The token of `Authorization: Bearer …`.
pub(crate) fn bearer(headers: &HeaderMap) -> Option<&str> {
    let value = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    let (scheme, token) = value.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then(|| token.trim())
}

/// The value of one cookie.
pub(crate) fn cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'))
        .find_map(|pair| pair.trim().split_once('=').filter(|(key, _)| *key == name).map(|(_, value)| value))
}

/// Proof that the request comes from a signed-in researcher.
pub(crate) struct Researcher;

impl FromRequestParts<Arc<App>> for Researcher {
    type Rejection = ApiError;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, ApiError> {
        let sign_in = || ApiError::new(StatusCode::UNAUTHORIZED, "unauthorized", "Sign in first.");
        let token = cookie(&parts.headers, crate::routes::auth::COOKIE).ok_or_else(sign_in)?;
        let hash = kelir_store::sha256_hex(token.as_bytes());
        app.store.signed_in(&hash).await?.map(|_| Researcher).ok_or_else(sign_in)
    }
}
