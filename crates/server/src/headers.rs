//! What every answer carries, and what is refused before anything is touched.

use crate::api::{Problem, ProblemCode};
use crate::extract::{COOKIE, cookie};
use axum::extract::{MatchedPath, Request};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Uri, header};
use axum::middleware::Next;
use axum::response::{Html, IntoResponse, Response};
use kelir_report::escaped;

/// Scripts, styles and data come from this server alone; nothing is inline and nobody may frame a page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; \
     base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

/// What a page may use of the device: the whole screen, and nothing that senses.
const PERMISSIONS: &str = "accelerometer=(), ambient-light-sensor=(), bluetooth=(), camera=(), display-capture=(), geolocation=(), gyroscope=(), \
     hid=(), magnetometer=(), microphone=(), midi=(), payment=(), serial=(), usb=(), fullscreen=(self)";

/// The cross-origin ones isolate the pages, which also gives them a finer clock for response times.
const HEADERS: [(HeaderName, &str); 7] = [
    (header::CONTENT_SECURITY_POLICY, POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (HeaderName::from_static("permissions-policy"), PERMISSIONS),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-embedder-policy"), "require-corp"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Middleware: adds what the handler has not set itself.
pub(crate) async fn secure(request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    for (name, value) in HEADERS {
        response.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    response
}

/// Middleware: a request that changes something and comes with (or for) a researcher's cookie is refused when another site's page sent it.
pub(crate) async fn same_site(request: Request, next: Next) -> Response {
    let headers = request.headers();
    let about_cookies =
        request.uri().path().starts_with("/api/v1/auth/") || cookie(headers, COOKIE).is_some();
    if !request.method().is_safe() && about_cookies && from_elsewhere(headers) {
        let detail = "This request came from a page of another site; open the console itself.";
        return Problem::new(ProblemCode::CrossSite, detail).into_response();
    }
    next.run(request).await
}

/// Whether a browser says that another site's page sent this. Programs say nothing, and have no cookie that somebody else could use.
fn from_elsewhere(headers: &HeaderMap) -> bool {
    let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or("unreadable"));
    if let Some(site) = text(HeaderName::from_static("sec-fetch-site")) {
        return !matches!(site, "same-origin" | "none");
    }
    let Some(origin) = text(header::ORIGIN) else { return false };
    let authority = origin.parse::<Uri>().ok().and_then(|uri| uri.authority().map(ToString::to_string));
    authority.as_deref() != text(header::HOST)
}

/// Middleware: a problem is told as a page to whoever asks for pages, which are people with browsers.
pub(crate) async fn for_people(request: Request, next: Next) -> Response {
    let accepted = request.headers().get(header::ACCEPT).and_then(|value| value.to_str().ok());
    let wants_pages = accepted.is_some_and(|accepted| accepted.contains("text/html"));
    let response = next.run(request).await;
    match response.extensions().get::<Problem>() {
        Some(problem) if wants_pages => {
            let page = Html(problem_page(problem));
            let (mut parts, _) = response.into_parts();
            parts.headers.remove(header::CONTENT_TYPE);
            parts.headers.remove(header::CONTENT_LENGTH);
            parts.extensions.remove::<Problem>();
            (parts, page).into_response()
        }
        _ => response,
    }
}

fn problem_page(problem: &Problem) -> String {
    let (title, detail) = (escaped(&problem.title), escaped(&problem.detail));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title} · kelir</title>\n\
         <link rel=\"stylesheet\" href=\"/api/v1/docs/style.css\">\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n<p>{detail}</p>\n</main>\n\
         </body>\n</html>\n"
    )
}

/// The route that answered, and whether somebody who has consented asked: for the log and for the connection's guard.
#[derive(Clone, Default)]
pub(crate) struct Answered {
    pub(crate) route: Option<MatchedPath>,
    pub(crate) consented: bool,
}

/// Middleware: notes which route answered.
pub(crate) async fn note_route(request: Request, next: Next) -> Response {
    let route = request.extensions().get::<MatchedPath>().cloned();
    let changes = !request.method().is_safe();
    let mut response = next.run(request).await;
    let of_session =
        route.as_ref().is_some_and(|route| route.as_str().starts_with("/api/v1/sessions/{session}/"));
    // Nothing below a session is changed without its token; what comes first is the consent.
    let consented = changes && of_session && response.status().is_success();
    response.extensions_mut().insert(Answered { route, consented });
    response
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn what_another_site_sends_is_known() {
        let elsewhere = |pairs: &[(&'static str, &str)]| {
            let pairs =
                pairs.iter().map(|(name, value)| (HeaderName::from_static(name), value.parse().unwrap()));
            from_elsewhere(&pairs.collect())
        };
        assert!(!elsewhere(&[("host", "kelir.example")]), "a program");
        assert!(!elsewhere(&[("host", "kelir.example"), ("sec-fetch-site", "same-origin")]));
        assert!(!elsewhere(&[
            ("host", "inner"),
            ("origin", "https://kelir.example"),
            ("sec-fetch-site", "same-origin")
        ]));
        assert!(!elsewhere(&[("host", "kelir.example:8080"), ("origin", "http://kelir.example:8080")]));
        for site in ["cross-site", "same-site"] {
            assert!(elsewhere(&[("host", "kelir.example"), ("sec-fetch-site", site)]), "{site}");
        }
        for origin in
            ["null", "https://evil.example", "http://kelir.example", "http://kelir.example.evil.example:8080"]
        {
            assert!(elsewhere(&[("host", "kelir.example:8080"), ("origin", origin)]), "{origin}");
        }
        assert!(elsewhere(&[("origin", "http://kelir.example")]), "without a host");
    }
}
