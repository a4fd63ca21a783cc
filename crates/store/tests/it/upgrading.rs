//! A data folder of an earlier version goes on as it was: nothing is lost, nothing is pooled that was not alike.

use crate::chain::faults;
use crate::setting::{IDLE, answer, append, begin, dump, fixture, fixtures, half, stranger, tamper};
use kelir_store::{Appended, Store, StoreError, StoredAnswers, StudyStimulus};
use kelir_study::analysis::summarise;
use kelir_study::screening::screen;
use kelir_study::{StudyDefinition, trials::Role};
use serde_json::Value;
use sqlx::SqlSafeStr;
use sqlx::migrate::{Migration, MigrationType, Migrator};
use sqlx::sqlite::SqliteConnection;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use tempfile::TempDir;

fn file_of(folder: &Path, sha256: &str) -> std::path::PathBuf {
    folder.join("stimuli").join(&sha256[..2]).join(sha256)
}

/// What every session was shown, as (item, condition, hash), read from a database of before.
async fn shown_before(folder: &Path) -> BTreeMap<String, BTreeSet<[String; 3]>> {
    let mut stranger = stranger(folder).await;
    let sessions: Vec<(String, String)> =
        sqlx::query_as("SELECT session_id, trials FROM sessions").fetch_all(&mut stranger).await.unwrap();
    let shown = |trials: &str| {
        let trials: Vec<Value> = serde_json::from_str(trials).unwrap();
        let text = |trial: &Value, key: &str| trial[key].as_str().unwrap().to_owned();
        let side = |trial: &Value, side: &str| {
            [text(trial, "pair_id"), text(trial, side), text(trial, &format!("{side}_sha256"))]
        };
        trials.iter().flat_map(|trial| ["left", "right"].map(|name| side(trial, name))).collect()
    };
    sessions.into_iter().map(|(id, trials)| (id, shown(&trials))).collect()
}

fn as_shown(stimuli: &[StudyStimulus]) -> BTreeSet<[String; 3]> {
    stimuli.iter().map(|s| [s.item.clone(), s.condition.clone(), s.sha256.clone()]).collect()
}

async fn number(stranger: &mut SqliteConnection, query: &'static str) -> i64 {
    sqlx::query_scalar(query).fetch_one(stranger).await.unwrap()
}

#[tokio::test(flavor = "multi_thread")]
async fn a_folder_with_answers_says_what_it_said() {
    let folder = fixture("answered");
    let before = shown_before(folder.path()).await;
    let store = Store::open(folder.path()).await.unwrap();
    let stats: Value =
        serde_json::from_slice(&std::fs::read(fixtures().join("answered.stats.json")).unwrap()).unwrap();
    let [version] = &store.study_versions("small").await.unwrap()[..] else { panic!("one version") };
    let counts = store.version_counts("small", IDLE).await.unwrap()[&version.version];
    let people = counts.participants;
    assert_eq!(stats["participants"]["started"], people.started);
    assert_eq!(stats["participants"]["completed"], people.completed);
    assert_eq!(counts.answers, 34);

    let mut stored = StoredAnswers::new(&version.study, std::slice::from_ref(&version.version));
    store.read_on(&mut stored).await.unwrap();
    let answers = stored.answers();
    let (kept, excluded): (Vec<_>, Vec<_>) =
        answers.participants().into_iter().partition(|p| screen(&version.study, p, &[]).is_empty());
    let ids = |key: &str| -> Vec<String> {
        let listed = stats[key].as_array().unwrap();
        listed.iter().map(|e| e["session_id"].as_str().unwrap().to_owned()).collect()
    };
    assert_eq!(excluded.iter().map(|p| p.session_id.to_string()).collect::<Vec<_>>(), ids("excluded"));
    assert!(!kept.is_empty() && !excluded.is_empty());
    let blocks = serde_json::to_value(summarise(&version.study, &kept)).unwrap();
    let said = stats["blocks"].as_array().unwrap();
    assert_eq!(blocks.as_array().unwrap().len(), said.len());
    for (block, said) in blocks.as_array().unwrap().iter().zip(said) {
        for key in ["id", "n", "incomplete", "counts", "mean", "sd", "t", "df", "p"] {
            assert_eq!(block[key], said[key], "{key}");
        }
    }
    let times = store.answer_times("small", std::slice::from_ref(&version.version)).await.unwrap().unwrap();
    assert_eq!(stats["answered"], serde_json::json!([times.0, times.1]));

    let report = store.verify_chain("small").await.unwrap();
    assert_eq!((report.rows, report.faults, report.blanked), (34, vec![], 0));
    let stimuli = store.version_stimuli("small", &version.version).await.unwrap();
    for (session, shown) in before {
        assert_eq!(as_shown(&stimuli), shown, "{session}");
    }
    assert!(stimuli.iter().all(|s| s.provenance["technique"].is_string()), "where they came from is kept");
    let session = half(&store).await;
    assert_eq!(append(&store, &session, answer(2, true, 500.0)).await, Appended::Stored);
    assert_eq!(append(&store, &session, answer(3, true, 500.0)).await, Appended::Stored);
    assert!(matches!(store.complete(&session, "CODE").await.unwrap(), kelir_store::Completed::Code(_)));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_plan_that_was_brought_over_shows_what_it_showed() {
    let folder = fixture("answered");
    let mut raw = stranger(folder.path()).await;
    let old: Vec<(String, String)> =
        sqlx::query_as("SELECT session_id, trials FROM sessions").fetch_all(&mut raw).await.unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    for (session, trials) in old {
        let old: Vec<Value> = serde_json::from_str(&trials).unwrap();
        let new = store.trials(&session).await.unwrap();
        assert_eq!(new.len(), old.len());
        for (planned, old) in new.iter().zip(old) {
            let trial = &planned.trial;
            assert_eq!((trial.trial.name(), trial.repeat), ("two-alternative", 0));
            let numbers = [
                ("trial_index", trial.trial_index),
                ("block_index", trial.block_index),
                ("pair_index", trial.item_index),
            ];
            numbers.iter().for_each(|(key, number)| assert_eq!(old[key], *number, "{key}"));
            assert_eq!(
                (&old["block_id"], &old["pair_id"]),
                (&trial.block_id.clone().into(), &trial.item_id.clone().into())
            );
            assert_eq!(old["kind"], serde_json::to_value(trial.kind).unwrap());
            assert_eq!(old["target_left"], trial.is_first("pa"));
            for (role, shown) in planned.shown(None).unwrap() {
                assert_eq!(
                    (old[role.as_str()].as_str(), &shown.item),
                    (Some(&*shown.condition), &trial.item_id)
                );
                assert_eq!(old[format!("{}_sha256", role.as_str())], shown.sha256);
                let info = store.stimulus_info(&shown.sha256).await.unwrap().unwrap();
                assert_eq!((info.pixels_sha256, info.size), (shown.pixels_sha256, [64, 36]));
            }
            assert!(planned.stimuli.keys().eq([Role::Left, Role::Right].iter()));
        }
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn sessions_of_a_changed_study_go_where_their_pictures_are() {
    let folder = fixture("changed");
    let before = shown_before(folder.path()).await;
    let mut raw = stranger(folder.path()).await;
    let minus_zero = "SELECT count(*) FROM response_payloads WHERE payload LIKE '%\"rt\":-0.0,%'";
    assert_eq!(number(&mut raw, minus_zero).await, 1);
    // In the order they came: two, the scene was edited, two more, then a comma was changed in what is read at the end.
    let files: Vec<(String, String)> =
        sqlx::query_as("SELECT session_id, config_hash FROM sessions ORDER BY session_id")
            .fetch_all(&mut raw)
            .await
            .unwrap();
    assert!(files[0].1 == files[3].1 && files[3].1 != files[4].1);
    let store = Store::open(folder.path()).await.unwrap();
    let versions = store.study_versions("small").await.unwrap();
    assert_eq!(versions.len(), 2);
    assert_ne!(versions[0].version, versions[1].version);
    assert_eq!(versions[0].design_hash, versions[1].design_hash, "other pictures alone");
    let [after, first] = &versions[..] else { panic!() };
    for (version, sessions) in [(first, &files[..2]), (after, &files[2..])] {
        let of = store.sessions("small", std::slice::from_ref(&version.version)).await.unwrap();
        let ids: Vec<&String> = of.iter().map(|session| &session.session_id).collect();
        assert_eq!(ids, sessions.iter().map(|(id, _)| id).collect::<Vec<_>>());
        assert!(version.first_served_at <= of[0].created_at && of[1].created_at <= version.last_served_at);
        let stimuli = store.version_stimuli("small", &version.version).await.unwrap();
        assert_eq!(stimuli.len(), 8);
        for id in ids {
            assert_eq!(as_shown(&stimuli), before[id]);
        }
        let counts = store.version_counts("small", IDLE).await.unwrap()[&version.version];
        assert_eq!(counts.answers as usize, 4 * sessions.len());
        let mut stored = StoredAnswers::new(&version.study, std::slice::from_ref(&version.version));
        store.read_on(&mut stored).await.unwrap();
        assert_eq!(stored.answers().len(), 4 * sessions.len());
    }
    let pixels = async |version: &str| -> BTreeMap<(String, String), String> {
        let stimuli = store.version_stimuli("small", version).await.unwrap();
        stimuli.into_iter().map(|s| ((s.item, s.condition), s.pixels_sha256)).collect()
    };
    let (new, old) = (pixels(&after.version).await, pixels(&first.version).await);
    let differ: BTreeSet<&str> =
        new.iter().filter(|(key, p)| old[*key] != **p).map(|((item, _), _)| &**item).collect();
    assert_eq!(differ, BTreeSet::from(["a", "x"]), "the items of the scene that was edited");
    // The one with the comma is served now; what each participant read is known still.
    let of = store.sessions("small", std::slice::from_ref(&after.version)).await.unwrap();
    assert!(of[0].file_hash == of[1].file_hash && of[1].file_hash != of[2].file_hash);
    assert_eq!(after.file_hash, of[2].file_hash);
    let thanks = async |file: &str| store.study_file("small", file).await.unwrap().unwrap().texts.thanks;
    assert_eq!(
        [thanks(&of[0].file_hash).await, thanks(&of[2].file_hash).await],
        [["Thank you."], ["Thank you!"]]
    );
    let report = store.verify_chain("small").await.unwrap();
    assert_eq!((report.rows, report.faults), (20, vec![]));
    // The negative control of the row with −0.0: it has one zero of its own, and only zero.
    let zero = "UPDATE responses SET rt_ms = 5e-324 WHERE rt_ms = 0";
    tamper(folder.path(), &[zero]).await;
    assert_eq!(faults(&store.verify_chain("small").await.unwrap(), 1).len(), 1);
}

#[tokio::test(flavor = "multi_thread")]
async fn what_is_served_next_is_the_version_that_was_brought_over() {
    for name in ["answered", "changed"] {
        let folder = fixture(name);
        let store = Store::open(folder.path()).await.unwrap();
        let toml = std::fs::read_to_string(folder.path().join("studies/small.toml")).unwrap();
        let study = StudyDefinition::parse("studies/small.toml", &toml).unwrap();
        let current = store.study_versions("small").await.unwrap().remove(0);
        assert_eq!((&current.study, &current.file_hash), (&study, &study.file_hash()));
        let before = dump(folder.path()).await;
        let mut stimuli = store.version_stimuli("small", &current.version).await.unwrap();
        for stimulus in &mut stimuli {
            // As a server makes them: the bytes are stored, and what they show is measured.
            let (media_type, bytes) = store.stimulus(&stimulus.sha256).await.unwrap().unwrap();
            let info = store.put_stimulus(&media_type, bytes).await.unwrap();
            assert_eq!((&info.sha256, &info.pixels_sha256), (&stimulus.sha256, &stimulus.pixels_sha256));
            stimulus.size = info.size;
        }
        assert_eq!(before, dump(folder.path()).await);
        assert_eq!(store.put_version(&study, &stimuli).await.unwrap(), current.version);
        let served = crate::setting::Served { study, version: current.version.clone(), stimuli };
        // It keeps its place among the slots of those who were there.
        let started =
            store.version_counts("small", IDLE).await.unwrap()[&current.version].participants.started;
        assert!(u64::from(begin(&store, &served, IDLE).await.slot) < started + 1);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn opening_again_changes_nothing() {
    for name in ["answered", "changed"] {
        let folder = fixture(name);
        let before = dump(folder.path()).await;
        Store::open(folder.path()).await.unwrap().close().await;
        let once = dump(folder.path()).await;
        Store::open(folder.path()).await.unwrap().close().await;
        assert_eq!(dump(folder.path()).await, once);
        assert_ne!(before, once, "the negative control");
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn an_upgrade_that_fails_leaves_the_folder_as_it_was() {
    let folder = fixture("changed");
    let mut raw = stranger(folder.path()).await;
    let last = "(SELECT max(session_id) FROM sessions)";
    let trials: String = sqlx::query_scalar(
        "SELECT trials FROM sessions WHERE session_id = (SELECT max(session_id) FROM sessions)",
    )
    .fetch_one(&mut raw)
    .await
    .unwrap();
    for broken in ["[{\"trial_index\":\"x\"}]", "{}"] {
        let set = format!("UPDATE sessions SET trials = '{broken}' WHERE session_id = {last}");
        sqlx::query(sqlx::AssertSqlSafe(set)).execute(&mut raw).await.unwrap();
        let before = dump(folder.path()).await;
        let error = Store::open(folder.path()).await.unwrap_err();
        assert!(matches!(error, StoreError::Corrupt { what: "trials", .. }), "{error}");
        assert!(dump(folder.path()).await == before, "something was left half done");
    }
    let mend = format!("UPDATE sessions SET trials = $1 WHERE session_id = {last}");
    sqlx::query(sqlx::AssertSqlSafe(mend)).bind(trials).execute(&mut raw).await.unwrap();
    Store::open(folder.path()).await.unwrap().close().await;
    let untroubled = fixture("changed");
    Store::open(untroubled.path()).await.unwrap().close().await;
    // But for when its layout was changed.
    for folder in [&folder, &untroubled] {
        let open_until = "UPDATE stimuli SET open_until = NULL";
        sqlx::query(open_until).execute(&mut stranger(folder.path()).await).await.unwrap();
    }
    let (mended, untroubled) = (dump(folder.path()).await, dump(untroubled.path()).await);
    let without_times = |dump: &str| {
        dump.split("\n_sqlx_migrations").next().unwrap().to_owned()
            + dump.split("\nanswer_contents").nth(1).unwrap()
    };
    assert_eq!(without_times(&mended), without_times(&untroubled));
}

#[tokio::test(flavor = "multi_thread")]
async fn a_picture_that_is_gone_or_damaged_stops_nothing() {
    let folder = fixture("answered");
    let shown = shown_before(folder.path()).await.into_values().next().unwrap();
    let file = |item: &str, condition: &str| {
        let found = shown.iter().find(|[i, c, _]| i == item && c == condition).unwrap();
        file_of(folder.path(), &found[2])
    };
    std::fs::remove_file(file("a", "pa")).unwrap();
    std::fs::write(file("b", "mc"), b"damaged").unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let [version] = &store.study_versions("small").await.unwrap()[..] else { panic!("one version") };
    let stimuli = store.version_stimuli("small", &version.version).await.unwrap();
    assert_eq!(as_shown(&stimuli), shown);
    let unknown: Vec<(&str, &str)> = stimuli
        .iter()
        .filter(|s| s.pixels_sha256 == format!("file:{}", s.sha256))
        .map(|s| (s.item.as_str(), s.condition.as_str()))
        .collect();
    // The catch item shows what a shows, and so does the first frame of c.
    assert_eq!(unknown, [("a", "pa"), ("b", "mc"), ("c", "pa"), ("x", "pa")]);
    assert_eq!(store.version_counts("small", IDLE).await.unwrap()[&version.version].answers, 34);
    assert_eq!(append(&store, &half(&store).await, answer(2, true, 1.0)).await, Appended::Stored);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_picture_that_was_never_there_stops_nothing() {
    let folder = fixture("answered");
    let shown = shown_before(folder.path()).await.into_values().next().unwrap();
    let [.., hash] = shown.iter().find(|[item, condition, _]| item == "c" && condition == "mc").unwrap();
    let mut raw = stranger(folder.path()).await;
    let set =
        format!("UPDATE sessions SET trials = replace(trials, '{hash}', '') WHERE completed_at IS NULL");
    assert_eq!(sqlx::query(sqlx::AssertSqlSafe(set)).execute(&mut raw).await.unwrap().rows_affected(), 1);
    let store = Store::open(folder.path()).await.unwrap();
    assert_eq!(store.study_versions("small").await.unwrap().len(), 2, "what lacks a picture is not alike");
    let session = half(&store).await;
    assert_eq!(store.version_stimuli("small", &session.version).await.unwrap().len(), 7);
    assert_eq!(append(&store, &session, answer(2, true, 1.0)).await, Appended::Stored);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_version_is_as_old_as_its_oldest_session() {
    let folder = fixture("changed");
    // The file of before the comma was loaded again last.
    tamper(folder.path(), &["UPDATE studies SET loaded_at = '2027' WHERE loaded_at = (SELECT min(loaded_at) FROM studies WHERE study_id = 'small')"]).await;
    let store = Store::open(folder.path()).await.unwrap();
    for version in store.study_versions("small").await.unwrap() {
        let sessions = store.sessions("small", std::slice::from_ref(&version.version)).await.unwrap();
        assert_eq!(version.first_served_at, sessions[0].created_at);
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_folder_that_nobody_took_part_in_has_its_versions() {
    let folder = fixture("answered");
    let nobody = ["DELETE FROM response_payloads", "DELETE FROM responses", "DELETE FROM sessions"];
    tamper(folder.path(), &nobody).await;
    let store = Store::open(folder.path()).await.unwrap();
    for study in ["shadow-puppets", "small"] {
        let [version] = &store.study_versions(study).await.unwrap()[..] else { panic!("{study}") };
        assert_eq!(store.version_stimuli(study, &version.version).await.unwrap().len(), 8);
        let report = store.verify_chain(study).await.unwrap();
        assert_eq!((report.rows, report.head.as_str()), (0, kelir_store::GENESIS));
    }
}

#[tokio::test(flavor = "multi_thread")]
async fn a_study_whose_pictures_were_not_all_made_has_no_version_yet() {
    let folder = fixture("answered");
    tamper(folder.path(), &["DELETE FROM study_stimuli WHERE study_id = 'shadow-puppets' AND pair_id = 'c'"])
        .await;
    let store = Store::open(folder.path()).await.unwrap();
    assert!(store.study_versions("shadow-puppets").await.unwrap().is_empty());
    assert_eq!(store.study_ids().await.unwrap(), ["shadow-puppets", "small"]);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_folder_of_the_first_migration_alone_goes_on() {
    let folder = fixture("answered");
    let mut raw = stranger(folder.path()).await;
    for sql in [
        "DROP INDEX sessions_by_study",
        "CREATE INDEX sessions_by_study ON sessions (study_id, config_hash, slot)",
        "DELETE FROM _sqlx_migrations WHERE version > 1",
    ] {
        sqlx::query(sql).execute(&mut raw).await.unwrap();
    }
    let store = Store::open(folder.path()).await.unwrap();
    let report = store.verify_chain("small").await.unwrap();
    assert_eq!((report.rows, report.faults), (34, vec![]));
    assert_eq!(append(&store, &half(&store).await, answer(2, true, 1.0)).await, Appended::Stored);
}

#[tokio::test(flavor = "multi_thread")]
async fn a_database_of_the_first_migration_gets_the_layout_of_one_that_begins_today() {
    let first = include_str!("../../../../migrations/sqlite/0001_first.sql");
    let first = Migration::new(1, "first".into(), MigrationType::Simple, first.into_sql_str(), false);
    let [old, new] = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    std::fs::write(old.path().join("kelir.sqlite"), b"").unwrap();
    let mut raw = stranger(old.path()).await;
    Migrator::with_migrations(vec![first]).run(&mut raw).await.unwrap();
    for folder in [&old, &new] {
        let store = Store::open(folder.path()).await.unwrap();
        assert!(store.study_ids().await.unwrap().is_empty());
        store.close().await;
    }
    let layout = async |folder: &TempDir| {
        dump(folder.path()).await.split("\n_sqlx_migrations").next().unwrap().to_owned()
    };
    assert_eq!(layout(&old).await, layout(&new).await);
}
