//! What handlers take from a request, typed and checked; each refusal is a problem document.

use crate::address::client_address;
use crate::api::{Problem, ProblemCode};
use crate::app::App;
use axum::body::Bytes;
use axum::extract::rejection::{BytesRejection, PathRejection};
use axum::extract::{ConnectInfo, FromRequest, FromRequestParts, Path, RawPathParams, Request};
use axum::http::request::Parts;
use axum::http::{HeaderMap, StatusCode, header};
use kelir_store::{Session, sha256_hex};
use kelir_study::schema::{FieldError, Record};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::convert::Infallible;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::Arc;
use utoipa::openapi::path::{Parameter, ParameterIn};
use utoipa::{IntoParams, ToSchema};

/// A request's JSON object, with the text it came as.
pub(crate) struct Object {
    pub(crate) text: String,
    pub(crate) value: Value,
}

impl<S: Send + Sync> FromRequest<S> for Object {
    type Rejection = Box<Problem>;

    async fn from_request(request: Request, state: &S) -> Result<Self, Box<Problem>> {
        let media_type =
            request.headers().get(header::CONTENT_TYPE).and_then(|v| v.to_str().ok()).unwrap_or_default();
        let media_type = media_type.split(';').next().unwrap_or_default().trim().to_ascii_lowercase();
        if media_type != "application/json" {
            let detail = "The body must be JSON, with Content-Type: application/json.";
            return Err(Problem::new(ProblemCode::NotJson, detail));
        }
        let refused = |rejection: BytesRejection| match rejection.status() {
            StatusCode::PAYLOAD_TOO_LARGE => {
                Problem::new(ProblemCode::TooLarge, "The body is larger than this address takes.")
            }
            _ => Problem::new(ProblemCode::BadBody, "The body could not be read."),
        };
        let bytes = Bytes::from_request(request, state).await.map_err(refused)?;
        let no_json =
            |why: String| Problem::new(ProblemCode::BadJson, format!("The body is no JSON: {why}."));
        let text = String::from_utf8(bytes.into()).map_err(|_| no_json("it is no UTF-8 text".to_owned()))?;
        match serde_json::from_str(&text) {
            Ok(value @ Value::Object(_)) => Ok(Object { text, value }),
            Ok(_) => Err(Problem::new(ProblemCode::BadJson, "The body must be a JSON object.")),
            Err(error) => Err(no_json(format!("line {}, column {}", error.line(), error.column()))),
        }
    }
}

impl Object {
    /// The object as a `T`, held to all that `record`, which is `T`'s, says.
    pub(crate) fn read<T: DeserializeOwned>(&self, record: &Record) -> Result<T, Box<Problem>> {
        typed(record.check(&self.value), &self.value, ProblemCode::InvalidField)
    }
}

fn typed<T: DeserializeOwned>(
    errors: Vec<FieldError>,
    value: &Value,
    code: ProblemCode,
) -> Result<T, Box<Problem>> {
    if !errors.is_empty() {
        return Err(Problem::fields(code, errors));
    }
    // What the schema lets pass and the type does not, such as 1.0 for a whole number.
    T::deserialize(value).map_err(|error| {
        let rule = format!("cannot be read: {error}");
        Problem::fields(code, vec![FieldError { pointer: String::new(), value: None, rule }])
    })
}

/// A request's body as a `T`, whose schema it has been held to.
pub(crate) struct Body<T>(pub(crate) T);

impl<T: ToSchema + DeserializeOwned + 'static, S: Send + Sync> FromRequest<S> for Body<T> {
    type Rejection = Box<Problem>;

    async fn from_request(request: Request, state: &S) -> Result<Self, Box<Problem>> {
        let object = Object::from_request(request, state).await?;
        object.read(Record::shared::<T>()).map(Body)
    }
}

/// The variable parts of an address.
pub(crate) struct Parameters<T>(pub(crate) T);

impl<T: DeserializeOwned + Send, S: Send + Sync> FromRequestParts<S> for Parameters<T> {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Box<Problem>> {
        Path::from_request_parts(parts, state)
            .await
            .map(|Path(inner)| Parameters(inner))
            .map_err(|_: PathRejection| Problem::not_found("address"))
    }
}

/// The parameters after `?`, held to all that `T` says of them; others are refused, as a mistyped one would be passed over.
pub(crate) struct Query<T>(pub(crate) T);

impl<T: IntoParams + DeserializeOwned, S: Send + Sync> FromRequestParts<S> for Query<T> {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Box<Problem>> {
        let pairs = axum::extract::Query::<Vec<(String, String)>>::try_from_uri(&parts.uri);
        let axum::extract::Query(pairs) = pairs.map_err(|_| {
            Problem::new(ProblemCode::InvalidParameter, "What follows ? in the address cannot be read.")
        })?;
        let known = T::into_params(|| Some(ParameterIn::Query));
        let (mut given, mut errors) = (Map::new(), Vec::new());
        for (name, text) in pairs {
            let wrong = |rule: String| FieldError::at(&name, text.as_str(), rule);
            match known.iter().find(|parameter| parameter.name == name) {
                None => {
                    let known: Vec<&str> = known.iter().map(|parameter| parameter.name.as_str()).collect();
                    errors.push(wrong(format!("is not known here; known are {}", known.join(", "))));
                }
                Some(_) if given.contains_key(&name) => errors.push(wrong("must be given once".to_owned())),
                Some(parameter) => {
                    let (value, breaches) = read(parameter, &text);
                    errors.extend(breaches.into_iter().map(|error| wrong(error.rule)));
                    given.insert(name, value);
                }
            }
        }
        typed(errors, &Value::Object(given), ProblemCode::InvalidParameter).map(Query)
    }
}

/// A parameter's text as the value that its schema means (a number where one fits), and the rules that it breaks.
fn read(parameter: &Parameter, text: &str) -> (Value, Vec<FieldError>) {
    let Some(schema) = &parameter.schema else { return (text.into(), Vec::new()) };
    let record = Record::new(schema, []);
    let number = serde_json::from_str(text).ok().filter(Value::is_number);
    let candidates = number.into_iter().chain([Value::from(text)]);
    let mut read: Vec<_> = candidates.map(|value| (record.check(&value), value)).collect();
    let fitting = read.iter().position(|(errors, _)| errors.is_empty()).unwrap_or_default();
    let (errors, value) = read.swap_remove(fitting);
    (value, errors)
}

/// The token of `Authorization: Bearer …`.
fn bearer(headers: &HeaderMap) -> Option<&str> {
    let value = headers.get(header::AUTHORIZATION)?.to_str().ok()?;
    let (scheme, token) = value.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then(|| token.trim())
}

/// The SHA-256 of the token that a request holds.
pub(crate) struct Token(pub(crate) String);

impl<S: Send + Sync> FromRequestParts<S> for Token {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Box<Problem>> {
        let unknown = || Problem::new(ProblemCode::Unauthorized, "The request holds no token.");
        bearer(&parts.headers).map(|token| Token(sha256_hex(token.as_bytes()))).ok_or_else(unknown)
    }
}

/// The cookie that holds a researcher's token.
pub(crate) const COOKIE: &str = "kelir_session";

/// The value of one cookie.
pub(crate) fn cookie<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers
        .get_all(header::COOKIE)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(';'))
        .find_map(|pair| pair.trim().split_once('=').filter(|(key, _)| *key == name).map(|(_, value)| value))
}

/// What a participant's request holds: the `{session}` of its address and the hash of its token.
pub(crate) struct Claim {
    pub(crate) session_id: String,
    token_hash: String,
}

impl Claim {
    /// The session, if the token is its own. An unknown session and a wrong token look the same.
    pub(crate) fn admit(&self, session: Option<Session>) -> Result<Session, Box<Problem>> {
        // Hashes of secrets: how long comparing takes says nothing about the secret.
        session.filter(|session| session.token_hash == self.token_hash).ok_or_else(unknown_session)
    }
}

fn unknown_session() -> Box<Problem> {
    Problem::new(ProblemCode::Unauthorized, "This session is not known, or the token is not its own.")
}

impl<S: Send + Sync> FromRequestParts<S> for Claim {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, state: &S) -> Result<Self, Box<Problem>> {
        let token_hash = sha256_hex(bearer(&parts.headers).ok_or_else(unknown_session)?.as_bytes());
        let address = RawPathParams::from_request_parts(parts, state).await;
        let address = address.map_err(|_| Problem::not_found("address"))?;
        let id = address.iter().find_map(|(name, value)| (name == "session").then_some(value));
        Ok(Claim { session_id: id.ok_or_else(unknown_session)?.to_owned(), token_hash })
    }
}

/// The session that `{session}` of the address names, for who holds its token.
pub(crate) struct Participant(pub(crate) Session);

impl FromRequestParts<Arc<App>> for Participant {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Box<Problem>> {
        let claim = Claim::from_request_parts(parts, app).await?;
        claim.admit(app.store.session(&claim.session_id).await?).map(Participant)
    }
}

/// The name of the researcher who is signed in, if one is.
pub(crate) struct SignedIn(pub(crate) Option<String>);

impl FromRequestParts<Arc<App>> for SignedIn {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Box<Problem>> {
        match cookie(&parts.headers, COOKIE) {
            Some(token) => Ok(SignedIn(app.store.signed_in(&sha256_hex(token.as_bytes())).await?)),
            None => Ok(SignedIn(None)),
        }
    }
}

/// The researcher who is signed in, by name.
pub(crate) struct Researcher(pub(crate) String);

impl FromRequestParts<Arc<App>> for Researcher {
    type Rejection = Box<Problem>;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Box<Problem>> {
        let sign_in = || Problem::new(ProblemCode::Unauthorized, "Sign in first.");
        let SignedIn(name) = SignedIn::from_request_parts(parts, app).await?;
        name.map(Researcher).ok_or_else(sign_in)
    }
}

/// The address that a request comes from: its connection's, or the one that a trusted proxy names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ClientAddress(pub(crate) IpAddr);

impl FromRequestParts<Arc<App>> for ClientAddress {
    type Rejection = Infallible;

    async fn from_request_parts(parts: &mut Parts, app: &Arc<App>) -> Result<Self, Infallible> {
        let connection = parts.extensions.get::<ConnectInfo<SocketAddr>>();
        let peer = connection.map_or(IpAddr::V4(Ipv4Addr::UNSPECIFIED), |ConnectInfo(peer)| peer.ip());
        Ok(ClientAddress(client_address(peer, &parts.headers, &app.trusted_proxies)))
    }
}
