//! What operations may refuse with, as their documentation lists it.

use super::ProblemCode;
use super::problem::PROBLEM_JSON;
use std::collections::BTreeMap;
use utoipa::openapi::schema::{AllOfBuilder, ObjectBuilder, Type};
use utoipa::openapi::{ContentBuilder, HeaderBuilder, Ref, RefOr, Response, ResponseBuilder};

/// The refusals of an operation as its documentation lists them: each code at its status. `internal` and `unavailable` are everybody's.
pub(crate) fn responses(codes: &[ProblemCode]) -> BTreeMap<String, RefOr<Response>> {
    let mut by_status = BTreeMap::<u16, Vec<ProblemCode>>::new();
    for code in codes.iter().copied().chain([ProblemCode::Internal, ProblemCode::Unavailable]) {
        by_status.entry(code.status().as_u16()).or_default().push(code);
    }
    let response = |codes: Vec<ProblemCode>| {
        let told: Vec<String> =
            codes.iter().map(|code| format!("`{}`: {}", code.as_str(), code.meaning())).collect();
        let names = codes.iter().map(|code| code.as_str());
        let code = ObjectBuilder::new().schema_type(Type::String).enum_values(Some(names));
        let schema = AllOfBuilder::new()
            .item(Ref::from_schema_name("Problem"))
            .item(ObjectBuilder::new().property("code", code).required("code"));
        let mut response = ResponseBuilder::new()
            .description(told.join(" "))
            .content(PROBLEM_JSON, ContentBuilder::new().schema(Some(schema)).build());
        if codes.iter().any(|code| code.says_when()) {
            let seconds = ObjectBuilder::new().schema_type(Type::Integer).minimum(Some(1));
            let header = HeaderBuilder::new()
                .schema(Some(seconds))
                .description(Some("Seconds to wait before asking again."));
            response = response.header("Retry-After", header.build());
        }
        response.build().into()
    };
    by_status.into_iter().map(|(status, codes)| (status.to_string(), response(codes))).collect()
}

/// `refusals!(Name: ProblemCode, …)` names the codes that an operation may refuse with, for the `responses(…)` of its `#[utoipa::path]`.
macro_rules! refusals {
    ($name:ident: $($code:ident),*) => {
        struct $name;

        impl utoipa::IntoResponses for $name {
            fn responses()
            -> std::collections::BTreeMap<String, utoipa::openapi::RefOr<utoipa::openapi::Response>> {
                $crate::api::responses(&[$($crate::api::ProblemCode::$code),*])
            }
        }
    };
}
pub(crate) use refusals;
