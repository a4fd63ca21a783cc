//! Trying a study spoils nothing: a preview leaves no trace, a pilot is counted apart, and only who may tries.

use std::path::Path;
use std::process::Command;

use kelir_tests::{Server, kelir_ok, small_data, sql};
use serde_json::{Value, json};

/// The parameters of a link's query.
fn params(url: &str) -> Value {
    let query = url.trim().split_once('?').unwrap().1;
    let pairs = query.split('&').map(|pair| pair.split_once('=').unwrap_or((pair, "")));
    pairs.map(|(name, value)| (name.to_owned(), Value::from(value))).collect::<serde_json::Map<_, _>>().into()
}

fn link(data: &Path, kind: &str) -> String {
    kelir_ok(&["study", "link", "small", "--kind", kind, "--data", data.to_str().unwrap()]).trim().to_owned()
}

fn begin(server: &Server, params: &Value) -> (u16, Value) {
    server.call("POST", "/api/v1/studies/small/sessions", None, &json!({ "params": params, "display": {} }))
}

/// Everything that a visit could write to, as it stands in the database; but how browsers get their pictures, which is no visit's.
fn stored(data: &Path) -> Vec<String> {
    let shell = Command::new("sqlite3").arg(data.join("kelir.sqlite")).arg(".dump").output().unwrap();
    assert!(shell.status.success(), "{}", String::from_utf8_lossy(&shell.stderr));
    let dump = String::from_utf8(shell.stdout).unwrap();
    let of_others =
        ["packings", "researchers", "researcher_sessions"].map(|table| format!("INSERT INTO {table} "));
    let rows = dump.lines().filter(|line| of_others.iter().all(|other| !line.starts_with(other)));
    rows.map(str::to_owned).collect()
}

#[test]
fn a_preview_goes_to_its_end_and_stores_nothing() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let before = stored(&server.data);
    let url = link(data.path(), "preview");
    let (_, query) = url.split_once('?').unwrap();
    let (status, visit) =
        server.call("GET", &format!("/api/v1/studies/small/visit?{query}"), None, &Value::Null);
    assert_eq!((status, &visit["visit"]), (200, &json!("preview")));
    let (status, begun) = begin(&server, &params(&url));
    assert_eq!(status, 201, "{begun}");
    let (id, token) = (begun["session_id"].as_str().unwrap(), begun["token"].as_str());
    assert!(id.starts_with("preview-"));
    let at = |rest: &str| format!("/api/v1/previews/{id}{rest}");
    let answer = json!({ "choice": "left", "rt": 700.0 });
    assert_eq!(server.call("PUT", &at("/trials/0"), token, &answer).0, 409, "consent comes first");
    let (_, state) = server.call("POST", &at("/consent"), token, &Value::Null);
    let trials = state["trials"].as_array().unwrap().len();
    assert_eq!(
        server.call("PUT", &at("/trials/0"), token, &json!({ "choice": "up" })).0,
        422,
        "an answer is checked"
    );
    assert_eq!(server.call("POST", &at("/completion"), token, &Value::Null).0, 409);
    for trial in 0..trials {
        let (status, told) = server.call("PUT", &at(&format!("/trials/{trial}")), token, &answer);
        assert_eq!(status, 200, "{told}");
    }
    let (status, end) = server.call("POST", &at("/completion"), token, &Value::Null);
    assert_eq!((status, &end["redirect"]), (200, &Value::Null), "no panel is told: {end}");
    assert_eq!(server.call("GET", &at(""), Some("other"), &Value::Null).0, 401);
    assert_eq!(stored(&server.data), before);
    // Negative controls: a participant leaves rows, and what is written over a row is seen too.
    assert_eq!(begin(&server, &json!({})).0, 201);
    let begun = stored(&server.data);
    assert_ne!(begun, before);
    sql(&server.data.join("kelir.sqlite"), "UPDATE sessions SET last_seen_at = '2026-01-01T00:00:00.000Z'");
    let touched = stored(&server.data);
    assert_eq!(touched.len(), begun.len());
    assert_ne!(touched, begun);
}

#[test]
fn a_plain_preview_is_a_participants_visit_and_a_changed_link_none_at_all() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let (status, begun) = begin(&server, &json!({ "preview": "" }));
    assert_eq!(status, 201);
    assert!(
        !begun["session_id"].as_str().unwrap().starts_with("preview-"),
        "participants could rehearse: {begun}"
    );
    let mut changed = params(&link(data.path(), "pilot"));
    changed["exp"] = json!("9999999999");
    let before = stored(&server.data);
    let (status, refused) = begin(&server, &changed);
    assert_eq!((status, &refused["code"]), (403, &json!("link_refused")));
    assert_eq!(stored(&server.data), before);
    // Whoever is signed in needs no signature.
    let cookie = server.sign_in();
    let visit = server.research(&cookie, "/api/v1/studies/small/visit?preview");
    assert_eq!(visit["visit"], "preview");
    let plain = server.call("GET", "/api/v1/studies/small/visit?preview", None, &Value::Null).1;
    assert_eq!(plain["visit"], "participant");
}

#[test]
fn a_pilot_is_stored_as_one_and_its_link_is_not_kept() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let (status, begun) = begin(&server, &params(&link(data.path(), "pilot")));
    assert_eq!(status, 201, "{begun}");
    let rows = sql(&data.path().join("kelir.sqlite"), "SELECT kind, params FROM sessions");
    assert_eq!(rows, [json!({ "kind": "pilot", "params": "{}" })]);
}

#[test]
fn a_preview_in_a_browser_says_that_it_is_one_and_leaves_nothing_behind() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let before = stored(&server.data);
    let path =
        link(data.path(), "preview").split_once("/study/").map(|(_, rest)| format!("/study/{rest}")).unwrap();
    let seen = kelir_tests::browser("preview.mjs", &json!({ "url": format!("{}{path}", server.base) }));
    assert!(seen["ribbon"].as_str().unwrap().contains("nothing is stored"), "{seen}");
    assert_eq!(
        (&seen["code"], &seen["kept"], &seen["complaints"]),
        (&json!("PREVIEW"), &json!([]), &json!([])),
        "{seen}"
    );
    assert_eq!(stored(&server.data), before);
}
