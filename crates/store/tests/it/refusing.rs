//! What the database itself refuses, whoever asks.

use crate::setting::{answer, append, dump, fixture, half, stranger};
use kelir_store::Store;
use sqlx::AssertSqlSafe;

/// Statements of somebody who minds neither foreign keys nor recursive triggers, and what each is told.
const REFUSED: [(&str, &[&str]); 8] = [
    (
        "answers are append-only",
        &[
            "UPDATE answers SET row = replace(row, 'pa', 'mc')",
            "UPDATE answers SET row_hash = lower(hex(randomblob(32)))",
            "UPDATE answers SET study_id = 'other'",
            "UPDATE OR REPLACE answers SET seq = 1",
            "DELETE FROM answers",
            "INSERT OR REPLACE INTO answers SELECT * FROM answers",
            "REPLACE INTO answers SELECT study_id, 2, session_id, trial_index, json_set(row, '$[1]', 2), lower(hex(randomblob(32))) FROM answers",
            "REPLACE INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[1]', 2, '$[3]', 9), row_hash FROM answers",
            "REPLACE INTO answers (rowid, study_id, seq, session_id, trial_index, row, row_hash)
             SELECT rowid, study_id, 2, session_id, 9, json_set(row, '$[1]', 2, '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
            "INSERT INTO answers SELECT * FROM answers WHERE true ON CONFLICT DO UPDATE SET row_hash = lower(hex(randomblob(32)))",
        ],
    ),
    (
        "the chain of answers has no gaps",
        &["INSERT INTO answers SELECT study_id, 3, session_id, 9, json_set(row, '$[1]', 3, '$[3]', 9), lower(hex(randomblob(32))) FROM answers"],
    ),
    (
        "a withdrawal may only blank them",
        &[
            "UPDATE answer_contents SET answer = '{}'",
            "UPDATE answer_contents SET payload = '{}'",
            "UPDATE answer_contents SET nonce = randomblob(16)",
            "UPDATE answer_contents SET seq = 2, nonce = NULL, answer = NULL, payload = NULL",
            "UPDATE answer_contents SET study_id = 'other', nonce = NULL, answer = NULL, payload = NULL",
            "DELETE FROM answer_contents",
            "INSERT OR REPLACE INTO answer_contents SELECT study_id, seq, nonce, '{}', payload FROM answer_contents",
            "REPLACE INTO answer_contents (rowid, study_id, seq, nonce, answer, payload)
             SELECT rowid, study_id, 2, nonce, '{}', payload FROM answer_contents",
            "UPDATE response_payloads SET payload = '{}'",
            "DELETE FROM response_payloads",
            "INSERT OR REPLACE INTO response_payloads VALUES (1, '{}')",
        ],
    ),
    (
        "responses are append-only",
        &[
            "UPDATE responses SET choice = 'right', chosen_condition = right_condition",
            "UPDATE responses SET rt_ms = 1",
            "DELETE FROM responses",
            "UPDATE OR REPLACE responses SET response_id = 1",
        ],
    ),
    (
        "this chain is closed; answers go into the table answers",
        &[
            "INSERT OR REPLACE INTO responses SELECT * FROM responses",
            "INSERT INTO responses SELECT 35, session_id, 9, block_id, pair_id, left_sha256, right_sha256, left_condition, right_condition,
             choice, chosen_condition, rt_ms, received_at, payload_hash, row_hash, 'x' FROM responses WHERE response_id = 34",
        ],
    ),
    (
        "what a version shows never changes",
        &[
            "UPDATE version_stimuli SET pixels_sha256 = 'x'",
            "UPDATE version_stimuli SET provenance = '{}'",
            "DELETE FROM version_stimuli",
            "INSERT OR REPLACE INTO version_stimuli SELECT study_id, version, item_id, condition, width, height, sha256, 'x', provenance FROM version_stimuli
             WHERE study_id = 'shadow-puppets'",
            "INSERT INTO version_stimuli SELECT study_id, version, 'another', condition, width, height, sha256, 'x', provenance FROM version_stimuli
             WHERE study_id = 'small' LIMIT 1",
        ],
    ),
    (
        "plans are append-only",
        &[
            "UPDATE session_trials SET trial = '{}'",
            "UPDATE session_trials SET after_seq = 9",
            "DELETE FROM session_trials",
            "INSERT OR REPLACE INTO session_trials SELECT session_id, trial_index, '{}', decided_at, after_seq FROM session_trials",
        ],
    ),
    (
        "a session",
        &[
            "UPDATE sessions SET version = lower(hex(randomblob(32)))",
            "UPDATE sessions SET version = NULL",
            "UPDATE sessions SET study_id = 'shadow-puppets'",
            "DELETE FROM sessions",
            "INSERT OR REPLACE INTO sessions SELECT * FROM sessions",
            "REPLACE INTO sessions (rowid, session_id, study_id, file_hash, subject_id, token_hash, slot, plan_seed, params, display,
             created_at, last_seen_at, version) SELECT rowid, 'new', study_id, file_hash, subject_id, token_hash, slot, plan_seed, params,
             display, created_at, last_seen_at, version FROM sessions LIMIT 1",
        ],
    ),
];

#[tokio::test(flavor = "multi_thread")]
async fn what_was_written_is_not_changed_by_anybody() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    let session = half(&store).await;
    append(&store, &session, answer(2, true, 500.0)).await;
    store.note_on_chain("small", 1, 3, "looked at", "somebody").await.unwrap();
    let before = dump(folder.path()).await;
    let mut stranger = stranger(folder.path()).await;
    let notes = "notes are append-only";
    let on_notes = [
        "UPDATE chain_notes SET note = 'nothing'",
        "DELETE FROM chain_notes",
        "REPLACE INTO chain_notes SELECT note_id, chain, study_id, seq, 'nothing', author, written_at FROM chain_notes",
    ];
    for (refusal, statements) in REFUSED.into_iter().chain([(notes, &on_notes[..])]) {
        for sql in statements {
            let done = sqlx::query(AssertSqlSafe(*sql)).execute(&mut stranger).await;
            let error = done.expect_err(sql).to_string();
            assert!(error.contains(refusal), "{sql}: {error}");
        }
    }
    assert_eq!(dump(folder.path()).await, before);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_row_says_where_it_stands_and_contents_are_whole_or_blank() {
    let folder = fixture("answered");
    let store = Store::open(folder.path()).await.unwrap();
    append(&store, &half(&store).await, answer(2, true, 500.0)).await;
    let before = dump(folder.path()).await;
    let mut stranger = stranger(folder.path()).await;
    for sql in [
        // A next row whose text tells of another place: study, number, session, trial.
        "INSERT INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[0]', 'x', '$[1]', 2, '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
        "INSERT INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
        "INSERT INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[1]', 2, '$[2]', 'x', '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
        "INSERT INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[1]', 2), lower(hex(randomblob(32))) FROM answers",
        "INSERT INTO answers SELECT study_id, 0, session_id, 9, json_set(row, '$[1]', 0, '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
        // Blanked by halves.
        "UPDATE answer_contents SET answer = NULL",
        "UPDATE answer_contents SET answer = NULL, payload = NULL",
        "UPDATE answer_contents SET answer = NULL, nonce = NULL",
    ] {
        let error = sqlx::query(sql).execute(&mut stranger).await.expect_err(sql).to_string();
        assert!(error.contains("CHECK constraint failed"), "{sql}: {error}");
    }
    for sql in [
        "INSERT INTO sessions SELECT 'new', study_id, file_hash, subject_id, token_hash, 9, plan_seed, params, display, created_at,
         last_seen_at, NULL, NULL, NULL, version || 'x', 0, NULL, NULL, kind, flags, NULL FROM sessions LIMIT 1",
        "INSERT INTO sessions SELECT 'new', study_id, file_hash, subject_id, token_hash, 9, plan_seed, params, display, created_at,
         last_seen_at, NULL, NULL, NULL, NULL, 0, NULL, NULL, kind, flags, NULL FROM sessions LIMIT 1",
    ] {
        let error = sqlx::query(sql).execute(&mut stranger).await.expect_err(sql).to_string();
        assert!(error.contains("a session belongs to a version"), "{sql}: {error}");
    }
    assert_eq!(dump(folder.path()).await, before);
    // The negative controls: what is allowed is done, by a stranger too.
    for sql in [
        "INSERT INTO answers SELECT study_id, 2, session_id, 9, json_set(row, '$[1]', 2, '$[3]', 9), lower(hex(randomblob(32))) FROM answers",
        "UPDATE answer_contents SET answer = NULL, nonce = NULL, payload = NULL",
        "UPDATE response_payloads SET payload = NULL WHERE response_id = 1",
        "INSERT INTO sessions SELECT 'new', study_id, file_hash, subject_id, token_hash, 9, plan_seed, params, display, created_at,
         last_seen_at, NULL, NULL, NULL, version, 0, NULL, NULL, kind, flags, NULL FROM sessions LIMIT 1",
    ] {
        assert_eq!(sqlx::query(sql).execute(&mut stranger).await.unwrap().rows_affected(), 1, "{sql}");
    }
}
