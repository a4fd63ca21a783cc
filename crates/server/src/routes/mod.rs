//! The routes, one module a resource, and the document that is made of them.

#![allow(unused_qualifications, reason = "`#[utoipa::path]` writes them")]

mod auth;
mod document;
mod health;
mod links;
mod pages;
mod papers;
mod plans;
mod previews;
mod sessions;
mod stimuli;
mod studies;
mod versions;

pub use document::openapi_json;

use crate::api::{Problem, ProblemCode};
use crate::app::App;
use crate::headers;
use axum::extract::DefaultBodyLimit;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Router, middleware};
use std::sync::Arc;
use tower_http::compression::CompressionLayer;
use tower_http::compression::predicate::{DefaultPredicate, NotForContentType, Predicate};
use utoipa_axum::router::{OpenApiRouter, UtoipaMethodRouter, UtoipaMethodRouterExt};
use utoipa_axum::routes;

/// Most bytes of a body, but for a trial's, whose frame times may be many.
const BODY_LIMIT: usize = 64 << 10;
const TRIAL_LIMIT: usize = 1 << 20;

/// Every operation: what is not in here is not documented.
fn operations() -> Vec<UtoipaMethodRouter<Arc<App>>> {
    vec![
        routes!(studies::get_study),
        routes!(sessions::create_session),
        routes!(sessions::get_session),
        routes!(sessions::give_consent),
        routes!(sessions::put_answer, sessions::post_answer).layer(DefaultBodyLimit::max(TRIAL_LIMIT)),
        routes!(sessions::complete_session),
        routes!(stimuli::get_session_stimulus),
        routes!(links::get_visit),
        routes!(links::make_link),
        routes!(previews::get_preview),
        routes!(previews::consent_preview),
        routes!(previews::answer_preview).layer(DefaultBodyLimit::max(TRIAL_LIMIT)),
        routes!(previews::complete_preview),
        routes!(stimuli::get_stimulus),
        routes!(auth::sign_in, auth::get_signed_in, auth::sign_out),
        routes!(studies::list_studies),
        routes!(studies::list_versions),
        routes!(versions::get_results),
        routes!(versions::get_report),
        routes!(versions::get_document),
        routes!(versions::get_report_html),
        routes!(versions::get_report_md),
        routes!(versions::get_responses_csv),
        routes!(versions::get_participants_csv),
        routes!(versions::get_participants_codebook_csv),
        routes!(versions::get_export_xlsx),
        routes!(versions::get_pairs_csv),
        routes!(versions::get_codebook_csv),
        routes!(versions::get_events_csv),
        routes!(versions::get_events_codebook_csv),
        routes!(versions::get_codebook),
        routes!(papers::get_taylor_cameron),
        routes!(document::get_openapi),
        routes!(document::find_docs),
        routes!(document::get_docs),
        routes!(document::get_docs_style),
        routes!(health::get_health),
        routes!(health::get_integrity),
    ]
}

/// The operations with what they say of themselves.
fn documented() -> OpenApiRouter<Arc<App>> {
    operations().into_iter().fold(document::empty(), OpenApiRouter::routes)
}

pub(crate) fn router(app: Arc<App>) -> Router {
    // Pictures are compressed as they are; the default predicate leaves them alone, octets too.
    let compressible = DefaultPredicate::new()
        .and(NotForContentType::const_new("application/octet-stream"))
        .and(NotForContentType::const_new(kelir_store::PACKED));
    let (documented, _) = documented().split_for_parts();
    documented
        // What pages loaded before an update still ask for.
        .route("/api/v1/sessions/{session}/complete", post(sessions::complete_session))
        .route("/", get(pages::get_root))
        .route("/study/{study}", get(pages::get_participant))
        .route("/study/{study}/", get(pages::without_slash))
        .route("/console", get(pages::get_console))
        .route("/console/", get(pages::without_slash))
        .route("/console/{*path}", get(pages::get_console))
        .route("/assets/{*path}", get(pages::get_asset))
        .fallback(not_found)
        .method_not_allowed_fallback(method_not_allowed)
        .layer(DefaultBodyLimit::max(BODY_LIMIT))
        .layer(middleware::from_fn(headers::same_site))
        .layer(middleware::from_fn(headers::for_people))
        .layer(CompressionLayer::new().compress_when(compressible))
        .layer(middleware::from_fn(headers::secure))
        .layer(middleware::from_fn(headers::note_route))
        .with_state(app)
}

async fn not_found() -> Box<Problem> {
    Problem::not_found("address")
}

async fn method_not_allowed() -> Box<Problem> {
    Problem::new(ProblemCode::MethodNotAllowed, "This address does not take that method.")
}

/// JSON that no cache may keep.
struct Fresh<T>(T);

impl<T: serde::Serialize> IntoResponse for Fresh<T> {
    fn into_response(self) -> Response {
        ([(header::CACHE_CONTROL, "no-store")], axum::Json(self.0)).into_response()
    }
}

type Answered<T> = Result<Fresh<T>, Box<Problem>>;

/// 204, kept by no cache.
fn no_content() -> Response {
    (StatusCode::NO_CONTENT, [(header::CACHE_CONTROL, "no-store")]).into_response()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn no_two_types_have_one_name_in_the_document() {
        let mut known = BTreeMap::new();
        for (schemas, ..) in operations() {
            for (name, schema) in schemas {
                let schema = serde_json::to_value(schema).unwrap_or_default();
                let before = known.insert(name.clone(), schema.clone());
                assert!(
                    before.is_none_or(|before| before == schema),
                    "{name} is two types: name one of them otherwise"
                );
            }
        }
        assert!(known.len() > 50, "the types are looked at: {}", known.len());
    }
}
