//! A study in several sizes: a version has them all, and an answer says which of them was seen.

use crate::setting::{IDLE, answer, append, begin, dump, open, square, stranger};
use kelir_store::{Appended, PlannedTrial, SizedStimuli, StimulusHashes, Store, StudyStimulus};
use kelir_study::trials::Role;
use serde_json::json;
use sqlx::Executor;

/// The same study's pictures twice as large.
async fn larger(store: &Store, smaller: &[StudyStimulus]) -> Vec<StudyStimulus> {
    let mut stimuli = Vec::new();
    for (shade, small) in (1..).zip(smaller) {
        let info = store.put_stimulus("image/png", square(shade, 32)).await.unwrap();
        let (sha256, pixels_sha256, size) = (info.sha256, info.pixels_sha256, info.size);
        stimuli.push(StudyStimulus { sha256, pixels_sha256, size, ..small.clone() });
    }
    stimuli
}

#[tokio::test(flavor = "multi_thread")]
async fn a_version_shows_each_item_at_each_size_and_is_another_without_one() {
    let (_folder, store, served) = open().await;
    let both = [&served.stimuli[..], &larger(&store, &served.stimuli).await].concat();
    let version = store.put_version(&served.study, &both).await.unwrap();
    assert_ne!(version, served.version);
    let shown = store.version_stimuli("small", &version).await.unwrap();
    assert_eq!(shown.len(), 12);
    for pair in shown.chunks(2) {
        assert_eq!((&pair[0].item, &pair[0].condition), (&pair[1].item, &pair[1].condition));
        assert_eq!((pair[0].size, pair[1].size), ([16, 16], [32, 32]), "by rising size");
    }
    // One size of one item is written once.
    let twice = [&both[..], &[StudyStimulus { sha256: both[1].sha256.clone(), ..both[0].clone() }]].concat();
    assert!(store.put_version(&served.study, &twice).await.is_err());
}

#[tokio::test(flavor = "multi_thread")]
async fn the_row_of_an_answer_holds_what_was_shown_at_the_size_it_names() {
    let (folder, store, served) = open().await;
    let larger = larger(&store, &served.stimuli).await;
    let both = [&served.stimuli[..], &larger].concat();
    let version = store.put_version(&served.study, &both).await.unwrap();
    let served = crate::setting::Served { version, stimuli: both, ..served };
    let session = begin(&store, &served, IDLE).await;
    // The plan as the server makes it: `Served` plans the smallest size alone.
    let trials = store.trials(&session.session_id).await.unwrap();
    let hashes = |role: &Role, trial: &PlannedTrial| {
        let placed = &trial.trial.shown[role];
        let found = larger.iter().find(|s| s.item == placed.item && s.condition == placed.condition).unwrap();
        StimulusHashes { sha256: found.sha256.clone(), pixels_sha256: found.pixels_sha256.clone() }
    };
    let mut raw = stranger(folder.path()).await;
    raw.execute("DROP TRIGGER session_trials_no_update").await.unwrap();
    for trial in trials {
        let old = serde_json::to_value(&trial).unwrap();
        assert!(old.get("larger").is_none(), "a plan of one size is written as before");
        let stimuli = trial.stimuli.keys().map(|role| (*role, hashes(role, &trial))).collect();
        let planned = PlannedTrial { larger: vec![SizedStimuli { size: [32, 32], stimuli }], ..trial };
        sqlx::query("UPDATE session_trials SET trial = $1 WHERE session_id = $2 AND trial_index = $3")
            .bind(serde_json::to_string(&planned).unwrap())
            .bind(&session.session_id)
            .bind(planned.trial.trial_index)
            .execute(&mut raw)
            .await
            .unwrap();
    }
    for (index, (size, scale)) in
        [(None, 1.0), (Some([32, 32]), 1.0), (Some([64, 64]), 2.0)].into_iter().enumerate()
    {
        let mut sent = answer(index as u32, true, 500.0);
        sent.payload = json!({ "choice": "left", "scale": scale, "css_width_px": 8.0 * scale }).to_string();
        sent.stimulus_size = size;
        assert_eq!(append(&store, &session, sent).await, Appended::Stored);
    }
    let rows = store.answer_rows("small", std::slice::from_ref(&session.version)).await.unwrap();
    for (row, size) in rows.iter().zip([[16, 16], [32, 32], [16, 16]]) {
        for shown in row.shown.values() {
            let of =
                |s: &&StudyStimulus| (&s.item, &s.condition, s.size) == (&shown.item, &shown.condition, size);
            let found = served.stimuli.iter().find(of).unwrap();
            assert_eq!((&found.sha256, &found.pixels_sha256), (&shown.sha256, &shown.pixels_sha256));
        }
    }
    assert_eq!(store.verify_chain("small").await.unwrap().faults, []);
    let told = store.shown_sizes("small", std::slice::from_ref(&session.version)).await.unwrap();
    let told: Vec<_> = told.iter().map(|t| (t.size, t.answers, t.scale, t.css_width_px)).collect();
    assert_eq!(
        told,
        [
            ([16, 16], 2, Some([1.0, 2.0]), Some([8.0, 16.0])),
            ([32, 32], 1, Some([1.0, 1.0]), Some([8.0, 8.0]))
        ]
    );
}

#[tokio::test(flavor = "multi_thread")]
async fn a_database_of_before_there_were_sizes_keeps_what_its_versions_show() {
    let (folder, store, served) = open().await;
    let session = begin(&store, &served, IDLE).await;
    append(&store, &session, answer(0, true, 500.0)).await;
    let shown = store.version_stimuli("small", &served.version).await.unwrap();
    store.close().await;
    let today = dump(folder.path()).await;

    // The table as the third migration made it.
    let third = include_str!("../../../../migrations/sqlite/0003_versions_trials_answers.sql");
    let part = |from: &str, to: &str| {
        let rest = &third[third.find(from).unwrap()..];
        rest[..rest.find(to).unwrap()].to_owned()
    };
    let mut raw = stranger(folder.path()).await;
    for sql in [
        "CREATE TABLE kept AS SELECT study_id, version, item_id, condition, sha256, pixels_sha256, provenance FROM version_stimuli;
         DROP TABLE version_stimuli;",
        &part("CREATE TABLE version_stimuli", "DROP INDEX"),
        "INSERT INTO version_stimuli SELECT * FROM kept; DROP TABLE kept; DELETE FROM _sqlx_migrations WHERE version = 8;",
        &part("CREATE TRIGGER version_stimuli_complete", "-- Plans grow"),
    ] {
        raw.execute(sqlx::AssertSqlSafe(sql.to_owned())).await.unwrap();
    }
    assert_ne!(dump(folder.path()).await, today);

    let store = Store::open(folder.path()).await.unwrap();
    assert_eq!(store.version_stimuli("small", &served.version).await.unwrap(), shown);
    append(&store, &session, answer(1, true, 500.0)).await;
    assert_eq!(store.verify_chain("small").await.unwrap().faults, []);
    // What a version shows can still not be changed.
    for sql in [
        "UPDATE version_stimuli SET width = 1",
        "DELETE FROM version_stimuli",
        "INSERT INTO version_stimuli SELECT study_id, version, 'new', condition, width, height, sha256, pixels_sha256, provenance FROM version_stimuli LIMIT 1",
    ] {
        let error = raw.execute(sql).await.unwrap_err().to_string();
        assert!(error.contains("what a version shows never changes"), "{sql}: {error}");
    }
    let layout = |dump: &str| dump.split("\n_sqlx_migrations").next().unwrap().to_owned();
    assert_eq!(layout(&dump(folder.path()).await), layout(&today));
}
