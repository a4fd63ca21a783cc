//! One error shape for every answer that is not a success, and the errors of starting.

use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use kelir_store::StoreError;
use kelir_study::StudyErrors;
use serde_json::json;
use std::path::PathBuf;

/// Why a study file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StudyFileError {
    /// Everything that is wrong with it, its scenes, conditions and pictures included.
    #[error("{0}")]
    Invalid(#[from] StudyErrors),
    /// It cannot be read.
    #[error("{path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// Why the server did not start.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The data folder cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A study is wrong.
    #[error(transparent)]
    Study(#[from] StudyFileError),
    /// The researcher's password cannot be set up.
    #[error("researcher password: {0}")]
    Password(String),
    /// The address cannot be listened on.
    #[error("cannot listen on {address}: {source}")]
    Listen {
        /// The address.
        address: std::net::SocketAddr,
        /// What the system said.
        source: std::io::Error,
    },
}

/// An answer that says what is wrong: `{"error":{"code","message","field"?}}`, and more keys where a route promises them.
#[derive(Debug)]
pub(crate) struct ApiError(Box<Answer>);

#[derive(Debug)]
struct Answer {
    status: StatusCode,
    code: &'static str,
    message: String,
    field: Option<String>,
    more: Option<(&'static str, serde_json::Value)>,
    retry_after_s: Option<u64>,
}

impl ApiError {
    pub(crate) fn new(status: StatusCode, code: &'static str, message: impl Into<String>) -> Self {
        let message = message.into();
        ApiError(Box::new(Answer { status, code, message, field: None, more: None, retry_after_s: None }))
    }

    pub(crate) fn field(field: impl Into<String>, rule: impl Into<String>) -> Self {
        let (field, rule) = (field.into(), rule.into());
        let message = format!("{field} {rule}");
        let mut error = Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid_field", message);
        error.0.field = Some(field);
        error
    }

    pub(crate) fn not_found(what: &str) -> Self {
        Self::new(StatusCode::NOT_FOUND, "not_found", format!("There is no such {what}."))
    }

    pub(crate) fn conflict(code: &'static str, message: &str) -> Self {
        Self::new(StatusCode::CONFLICT, code, message)
    }

    pub(crate) fn unauthorized() -> Self {
        Self::new(
            StatusCode::UNAUTHORIZED,
            "unauthorized",
            "This session is not known, or the token is not its own.",
        )
    }

    pub(crate) fn with(mut self, key: &'static str, value: serde_json::Value) -> Self {
        self.0.more = Some((key, value));
        self
    }

    pub(crate) fn retry_after(mut self, seconds: u64) -> Self {
        self.0.retry_after_s = Some(seconds);
        self
    }

    /// Something here is broken: the log gets the reason, the browser does not.
    pub(crate) fn internal(reason: impl std::fmt::Display) -> Self {
        tracing::error!("{reason}");
        Self::new(
            StatusCode::INTERNAL_SERVER_ERROR,
            "internal",
            "Something is wrong on the server; it has been noted.",
        )
    }
}

impl From<StoreError> for ApiError {
    fn from(error: StoreError) -> Self {
        ApiError::internal(error)
    }
}

impl IntoResponse for ApiError {
    fn into_response(self) -> Response {
        let answer = *self.0;
        let mut error = json!({ "code": answer.code, "message": answer.message });
        if let Some(field) = answer.field {
            error["field"] = field.into();
        }
        if let Some((key, value)) = answer.more {
            error[key] = value;
        }
        let mut response = (answer.status, Json(json!({ "error": error }))).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
        if let Some(seconds) = answer.retry_after_s {
            headers.insert(header::RETRY_AFTER, HeaderValue::from(seconds));
        }
        response
    }
}
