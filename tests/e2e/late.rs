//! Who comes back late: to another place in the design while nothing is answered, else to the same one, and the report counts that.

use std::path::Path;

use kelir_tests::{Server, Taking, small_data, sql, take};
use serde_json::{Value, json};

/// Two hours pass in which nobody of these studies is heard of.
fn hours_pass(data: &Path) {
    let database = data.join("kelir.sqlite");
    for (table, column) in [("sessions", "last_seen_at"), ("slots", "seen_at")] {
        let pass = format!(
            "UPDATE {table} SET {column} = strftime('%Y-%m-%dT%H:%M:%fZ', {column}, '-2 hours') WHERE {column} <> ''"
        );
        sql(&database, &pass);
    }
}

fn slot(data: &Path, session: &str) -> Value {
    let of = format!("SELECT slot FROM sessions WHERE session_id = '{session}'");
    sql(&data.join("kelir.sqlite"), &of)[0]["slot"].clone()
}

fn complete(taking: &Taking<'_>, from: usize) {
    for trial in from..4 {
        let (status, told) = taking.answer(trial, "left", 900.0);
        assert_eq!(status, 200, "{told}");
    }
    taking.finish();
}

#[test]
fn who_comes_back_late_shares_no_place_or_is_counted() {
    let data = small_data();
    let server = Server::start_small(data.path());
    let choices = ["left", "right", "left", "right"];
    let late = Taking::begin(&server, "small", "late");
    hours_pass(data.path());
    let other = take(&server, "small", "other", &choices);
    assert_eq!([slot(data.path(), &late.id), slot(data.path(), &other)], [0, 0], "which is the trouble");
    // A page that holds answers of its plan keeps it.
    assert_eq!(late.call("GET", "?unsent=1", &Value::Null).1["trials"], late.state["trials"]);
    assert_eq!(slot(data.path(), &late.id), 0);
    let back = Taking::resume(&server, &late.id, &late.token);
    assert_eq!(slot(data.path(), &late.id), 1);
    assert_ne!(back.state["trials"], late.state["trials"], "the mirror's plan");
    // A page that was frozen before shows the old plan still: what is chosen there is nobody's choice of the new one.
    let (status, told) = late.answer(0, "left", 900.0);
    assert_eq!((status, &told["code"]), (409, &json!("plan_changed")), "{told}");
    let stored = "SELECT count(*) AS n FROM answers";
    assert_eq!(sql(&data.path().join("kelir.sqlite"), stored)[0]["n"], 4, "the other's alone");
    let again = Taking::resume(&server, &late.id, &late.token);
    assert_eq!(again.state["trials"], back.state["trials"], "and no other from then on");
    complete(&back, 0);

    let begun = Taking::begin(&server, "small", "begun");
    assert_eq!(begun.answer(0, "left", 900.0).0, 200);
    hours_pass(data.path());
    let other = take(&server, "small", "another", &choices);
    let back = Taking::resume(&server, &begun.id, &begun.token);
    assert_eq!(back.state["next_trial"], 1, "what was answered is kept");
    complete(&back, 1);
    assert_eq!([slot(data.path(), &begun.id), slot(data.path(), &other)], [2, 2]);

    let cookie = server.sign_in();
    let results = server.research(&cookie, "/api/v1/studies/small/versions/current/results");
    let standing = &results["standing"];
    assert_eq!(standing["balance"]["doubled_places"], 1, "{standing}");
    let said = standing["balance_summary"].as_str().unwrap();
    assert!(said.contains("1 place in the design was completed by more than one participant"), "{said}");
    let report = server.research(&cookie, "/api/v1/studies/small/versions/current/report.md");
    assert!(report.as_str().unwrap().contains(said));
    // What stands first is counted of those who are judged: with one place doubled and its mirror empty, it leans.
    let uneven = standing["balance"]["uneven"].as_array().unwrap();
    assert!(
        !uneven.is_empty() && uneven.iter().all(|item| item["answers"] == standing["judged"]),
        "{standing}"
    );
}
