//! One error shape for every answer that is not a success: problem details (RFC 9457).

use axum::Json;
use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};
use kelir_store::StoreError;
use kelir_study::schema::{FieldError, worded};
use kelir_study::visits::RefusedId;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use utoipa::ToSchema;

/// The media type of problem details.
pub(crate) const PROBLEM_JSON: &str = "application/problem+json";
/// An answer names so many wrong fields and no more.
const MOST_ERRORS: usize = 100;
/// When to ask again where the disk or the database is the trouble.
const RETRY_AFTER_S: u64 = 10;

worded! {
    /// What kind of problem it is.
    pub enum ProblemCode {
        /// The body could not be read.
        BadBody = "bad_body",
        /// The body is no JSON, or no JSON object.
        BadJson = "bad_json",
        /// A part of the address or a parameter after `?` breaks its rule.
        InvalidParameter = "invalid_parameter",
        /// More than one version's hash begins like that.
        AmbiguousVersion = "ambiguous_version",
        /// The request holds no valid sign-in, or no token of this session.
        Unauthorized = "unauthorized",
        /// That is not the password.
        WrongPassword = "wrong_password",
        /// A page of another site sent the request.
        CrossSite = "cross_site",
        /// The link is signed and not good: it has ended or was changed.
        LinkRefused = "link_refused",
        /// There is nothing of this name.
        NotFound = "not_found",
        /// The address does not take this method.
        MethodNotAllowed = "method_not_allowed",
        /// An answer can be stored only after consent.
        NoConsent = "no_consent",
        /// The trial has another answer already; `stored` is what stands.
        AlreadyAnswered = "already_answered",
        /// The trial was shown of a plan that has been decided anew since: it is to be shown again, of the plan that the session has now.
        PlanChanged = "plan_changed",
        /// Somebody with this id has begun the study already; whoever that is goes on in the browser where it was.
        AlreadyBegun = "already_begun",
        /// Somebody with this id has finished the study already; the code is shown in the browser where it was.
        AlreadyFinished = "already_finished",
        /// Trials have no answer yet: those in `missing`, or others that are still to be decided where `more` is true.
        Incomplete = "incomplete",
        /// The body is larger than the address takes.
        TooLarge = "too_large",
        /// The body is not sent as `application/json`.
        NotJson = "not_json",
        /// Fields of the body break their rules; `errors` names them all.
        InvalidField = "invalid_field",
        /// Something is wrong on the server; its log has the reason.
        Internal = "internal",
        /// The server cannot store or read just now; `detail` says why, `Retry-After` when to ask again.
        Unavailable = "unavailable",
        /// The server is starting, or the study's images are still being made; `Retry-After` says when to ask again.
        NotReady = "not_ready",
        /// The study cannot be taken at the moment; researchers see the reason in the console.
        StimuliFailed = "stimuli_failed",
    }
}

impl ProblemCode {
    /// The status that answers of this code have.
    pub fn status(self) -> StatusCode {
        match self {
            ProblemCode::BadBody
            | ProblemCode::BadJson
            | ProblemCode::InvalidParameter
            | ProblemCode::AmbiguousVersion => StatusCode::BAD_REQUEST,
            ProblemCode::Unauthorized | ProblemCode::WrongPassword => StatusCode::UNAUTHORIZED,
            ProblemCode::LinkRefused => StatusCode::FORBIDDEN,
            ProblemCode::NotFound => StatusCode::NOT_FOUND,
            ProblemCode::MethodNotAllowed => StatusCode::METHOD_NOT_ALLOWED,
            ProblemCode::CrossSite => StatusCode::FORBIDDEN,
            ProblemCode::NoConsent
            | ProblemCode::AlreadyAnswered
            | ProblemCode::PlanChanged
            | ProblemCode::AlreadyBegun
            | ProblemCode::AlreadyFinished
            | ProblemCode::Incomplete => StatusCode::CONFLICT,
            ProblemCode::TooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            ProblemCode::NotJson => StatusCode::UNSUPPORTED_MEDIA_TYPE,
            ProblemCode::InvalidField => StatusCode::UNPROCESSABLE_ENTITY,
            ProblemCode::Internal => StatusCode::INTERNAL_SERVER_ERROR,
            ProblemCode::Unavailable | ProblemCode::NotReady | ProblemCode::StimuliFailed => {
                StatusCode::SERVICE_UNAVAILABLE
            }
        }
    }

    /// Whether answers of this code say in `Retry-After` when to ask again.
    pub fn says_when(self) -> bool {
        matches!(self, ProblemCode::Unavailable | ProblemCode::NotReady)
    }
}

/// An answer that says what is wrong (RFC 9457).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Problem {
    /// Always `about:blank`: `code` tells the kinds apart.
    #[serde(rename = "type")]
    pub kind: String,
    /// The status in words.
    pub title: String,
    /// The HTTP status.
    pub status: u16,
    /// What kind of problem it is.
    pub code: ProblemCode,
    /// What happened, for people.
    pub detail: String,
    /// The fields or parameters that are wrong, all of them up to a hundred.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub errors: Vec<FieldError>,
    /// With `incomplete`: indices of the decided trials that have no answer yet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub missing: Option<Vec<u32>>,
    /// With `incomplete`: whether more trials are to be decided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub more: Option<bool>,
    /// With `already_answered`: what is stored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(nullable = false)]
    pub stored: Option<StoredAnswer>,
    #[serde(skip)]
    retry_after_s: Option<u64>,
}

/// An answer as it is stored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StoredAnswer {
    /// When the server committed it, ISO-8601 UTC.
    pub received_at: String,
    /// What analyses read of it; null once it was blanked by a withdrawal.
    #[schema(required)]
    pub answer: Option<Map<String, Value>>,
    /// All that the browser sent; null once it was blanked by a withdrawal.
    #[schema(required)]
    pub payload: Option<Map<String, Value>>,
}

impl From<kelir_store::StoredAnswer> for StoredAnswer {
    fn from(stored: kelir_store::StoredAnswer) -> StoredAnswer {
        let object = |value: Option<Value>| value.and_then(|value| value.as_object().cloned());
        StoredAnswer {
            received_at: stored.received_at,
            answer: object(stored.answer),
            payload: object(stored.payload),
        }
    }
}

impl Problem {
    /// A problem of a kind, told in a sentence. Boxed, as every handler's result has room for one.
    pub fn new(code: ProblemCode, detail: impl Into<String>) -> Box<Problem> {
        let status = code.status();
        Box::new(Problem {
            kind: "about:blank".to_owned(),
            title: status.canonical_reason().unwrap_or_default().to_owned(),
            status: status.as_u16(),
            code,
            detail: detail.into(),
            errors: Vec::new(),
            missing: None,
            more: None,
            stored: None,
            retry_after_s: None,
        })
    }

    /// The problem that these errors of a body or of parameters are; `errors` is not empty.
    pub fn fields(code: ProblemCode, mut errors: Vec<FieldError>) -> Box<Problem> {
        let said = |error: &FieldError| match error.pointer.strip_prefix('/') {
            Some(field) => format!("{field} {}", error.rule),
            None => format!("The body {}", error.rule),
        };
        let more = errors.len().saturating_sub(1);
        let detail = errors.first().map(said).unwrap_or_default();
        let detail = if more == 0 { format!("{detail}.") } else { format!("{detail}; {more} more.") };
        errors.truncate(MOST_ERRORS);
        Box::new(Problem { errors, ..*Problem::new(code, detail) })
    }

    /// One parameter that breaks a rule.
    pub fn parameter(name: &str, value: &str, rule: impl Into<String>) -> Box<Problem> {
        Problem::fields(ProblemCode::InvalidParameter, vec![FieldError::at(name, value, rule)])
    }

    /// An id that cannot be taken, by the parameter that it came in.
    pub(crate) fn refused_id(RefusedId { name, value, rule }: RefusedId) -> Box<Problem> {
        let mut error = FieldError::at(&name, value, rule);
        error.pointer.insert_str(0, "/params");
        Problem::fields(ProblemCode::InvalidField, vec![error])
    }

    pub(crate) fn not_found(what: &str) -> Box<Problem> {
        Problem::new(ProblemCode::NotFound, format!("There is no such {what}."))
    }

    pub(crate) fn retry_after(mut self: Box<Self>, seconds: u64) -> Box<Problem> {
        self.retry_after_s = Some(seconds);
        self
    }

    /// Something here is broken: the log gets the reason, the browser does not.
    pub(crate) fn internal(reason: impl std::fmt::Display) -> Box<Problem> {
        tracing::error!("{reason}");
        Problem::new(ProblemCode::Internal, "Something is wrong on the server; it has been noted.")
    }
}

impl From<StoreError> for Box<Problem> {
    fn from(error: StoreError) -> Self {
        let Some(trouble) = error.as_told() else { return Problem::internal(error) };
        tracing::error!("{error}");
        let detail = format!("{} {}", trouble.sentence(), trouble.advice());
        Problem::new(ProblemCode::Unavailable, detail).retry_after(RETRY_AFTER_S)
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let mut response = (self.code.status(), Json(&self)).into_response();
        let headers = response.headers_mut();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(PROBLEM_JSON));
        headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
        if let Some(seconds) = self.retry_after_s {
            headers.insert(header::RETRY_AFTER, HeaderValue::from(seconds));
        }
        // For whoever tells it otherwise than as JSON.
        response.extensions_mut().insert(self);
        response
    }
}

impl IntoResponse for Box<Problem> {
    fn into_response(self) -> Response {
        (*self).into_response()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kelir_store::Trouble;

    #[test]
    fn trouble_with_the_disk_is_told_as_such_and_passes() {
        for trouble in [
            Trouble::Full,
            Trouble::Locked,
            Trouble::ReadOnly,
            Trouble::Failing,
            Trouble::Damaged,
            Trouble::Gone,
        ] {
            let error = StoreError::Trouble { trouble, message: "a path of the server".to_owned() };
            let problem = Box::<Problem>::from(error);
            assert!(problem.detail.starts_with(trouble.sentence()), "{}", problem.detail);
            assert!(problem.detail.ends_with(trouble.advice()), "{}", problem.detail);
            assert!(!problem.detail.contains("path"), "{}", problem.detail);
            let response = problem.into_response();
            assert_eq!(response.status(), StatusCode::SERVICE_UNAVAILABLE);
            assert_eq!(response.headers()[header::RETRY_AFTER], "10");
        }
        let unreadable = StoreError::Corrupt { what: "trial", message: "a secret".to_owned() };
        let problem = Box::<Problem>::from(unreadable);
        assert_eq!(problem.code, ProblemCode::Unavailable);
        assert!(
            problem.detail.contains("is damaged") && !problem.detail.contains("secret"),
            "{}",
            problem.detail
        );
        let other = Box::<Problem>::from(StoreError::Migrate("x".to_owned()));
        assert_eq!(other.into_response().status(), StatusCode::INTERNAL_SERVER_ERROR);
    }
}
