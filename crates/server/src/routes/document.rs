//! The OpenAPI document: what every operation says of itself, in one file.

use crate::api::{Problem, refusals};
use crate::app::App;
use crate::extract::COOKIE;
use crate::viewer;
use axum::http::header;
use axum::response::{IntoResponse, Redirect};
use serde_json::Value;
use std::sync::{Arc, LazyLock};
use utoipa::openapi::OpenApi;
use utoipa::openapi::security::{ApiKey, ApiKeyValue, Http, HttpAuthScheme, SecurityScheme};
use utoipa::{Modify, OpenApi as _};
use utoipa_axum::router::OpenApiRouter;

#[derive(utoipa::OpenApi)]
#[openapi(
    info(
        title = "kelir",
        description = "Perceptual studies of shadows: taking part in them, and reading what came of them.\n\n\
            JSON in snake_case; times in ms where a name does not say otherwise. Every answer from 400 on is a problem document \
            (RFC 9457, `application/problem+json`) whose `code` says what kind of problem it is.",
    ),
    servers((url = "/", description = "The server that this document came from.")),
    tags(
        (name = "participants", description = "Taking part. A session's token goes with every request about it."),
        (name = "sign-in", description = "Researchers signing in and out."),
        (name = "studies", description = "What is served, and what was."),
        (name = "results", description = "What came of it."),
        (name = "about", description = "The server and this document."),
    ),
    components(schemas(Problem)),
    security(()),
    modifiers(&Secrets),
)]
struct Head;

struct Secrets;

impl Modify for Secrets {
    fn modify(&self, document: &mut OpenApi) {
        let cookie = ApiKeyValue::with_description(
            COOKIE,
            "A signed-in researcher's cookie; `POST /api/v1/auth/session` sets it.",
        );
        let mut token = Http::new(HttpAuthScheme::Bearer);
        token.description = Some("The `token` that a session was created with.".to_owned());
        let components = document.components.get_or_insert_default();
        components.add_security_scheme("researcher", SecurityScheme::ApiKey(ApiKey::Cookie(cookie)));
        components.add_security_scheme("session", SecurityScheme::Http(token));
    }
}

/// The document before there are operations in it.
pub(super) fn empty() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::with_openapi(Head::openapi())
}

/// The document as text: its keys sorted, a newline at the end. `web/api/openapi.json` is a copy of it.
pub fn openapi_json() -> &'static str {
    static TEXT: LazyLock<String> = LazyLock::new(|| {
        let (_, document) = super::documented().split_for_parts();
        // Through a value, whose keys have an order: the document's own extensions have none.
        let mut document = serde_json::to_value(document).expect("a document is texts, numbers and lists");
        name_keys_as_texts(&mut document);
        tell_knobs(&mut document);
        format!("{document:#}\n")
    });
    &TEXT
}

/// A map with numbers for keys has texts for keys once it is JSON; utoipa says that its keys are numbers.
fn name_keys_as_texts(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            if object.get("propertyNames").is_some_and(|names| names["type"] == "integer") {
                object.remove("propertyNames");
            }
            object.values_mut().for_each(name_keys_as_texts);
        }
        Value::Array(items) => items.iter_mut().for_each(name_keys_as_texts),
        _ => {}
    }
}

/// A condition's knobs are those of its technique: kelir-study, whose type it is, knows none.
fn tell_knobs(document: &mut Value) {
    const KNOBS: &str = "/components/schemas/Condition/oneOf/0/properties/knobs/description";
    if let Some(Value::String(description)) = document.pointer_mut(KNOBS) {
        description.push(' ');
        description.push_str(&kelir_house::techniques_in_words());
    }
}

refusals!(About:);

/// This document.
#[utoipa::path(
    get, path = "/api/v1/openapi.json", tag = "about",
    responses((status = OK, description = "The OpenAPI document.", content_type = "application/json", body = Object), About)
)]
pub(crate) async fn get_openapi() -> impl IntoResponse {
    kept("application/json", openapi_json())
}

/// Go on to `docs/`.
#[utoipa::path(
    get, path = "/api/v1/docs", tag = "about",
    responses((status = PERMANENT_REDIRECT, description = "The page is at `docs/`."), About)
)]
pub(crate) async fn find_docs() -> Redirect {
    Redirect::permanent("/api/v1/docs/")
}

/// This document as a page.
#[utoipa::path(
    get, path = "/api/v1/docs/", tag = "about",
    responses((status = OK, description = "A page without scripts.", content_type = "text/html", body = String), About)
)]
pub(crate) async fn get_docs() -> impl IntoResponse {
    static PAGE: LazyLock<String> = LazyLock::new(|| {
        let document = serde_json::from_str(openapi_json()).unwrap_or_default();
        viewer::page(&document, "/api/v1/docs/style.css", "/api/v1/openapi.json")
    });
    ([(header::CONTENT_SECURITY_POLICY, viewer::POLICY)], kept("text/html; charset=utf-8", &PAGE))
}

/// The page's style.
#[utoipa::path(
    get, path = "/api/v1/docs/style.css", tag = "about",
    responses((status = OK, description = "A style sheet.", content_type = "text/css", body = String), About)
)]
pub(crate) async fn get_docs_style() -> impl IntoResponse {
    kept("text/css; charset=utf-8", viewer::STYLE)
}

/// What changes with the server alone.
fn kept(media_type: &'static str, text: &'static str) -> impl IntoResponse {
    ([(header::CONTENT_TYPE, media_type), (header::CACHE_CONTROL, "no-cache")], text)
}
