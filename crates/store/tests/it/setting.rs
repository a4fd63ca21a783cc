//! A store with small studies, their pictures and sessions in it.

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use kelir_fixtures as fixtures;
use kelir_store::{
    Appended, NewAnswer, NewSession, NextTrials, PlannedSession, PlannedTrial, Progress, Session,
    StimulusHashes, Store, StoreError, StudyStimulus,
};
use kelir_study::plan::{Decision, next_trials};
use kelir_study::trials::{Checked, TrialRules};
use kelir_study::{StudyDefinition, Trial, TrialPlan};
use serde_json::json;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection};
use sqlx::{AssertSqlSafe, ConnectOptions};
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

const STAIRCASE: [(&str, &str); 4] = [
    ("trial", "\"two-interval\""),
    (
        "items",
        r#"[{ id = "l0", scene = "a.toml", level = 0 }, { id = "l1", scene = "a.toml", level = 1 }, { id = "l2", scene = "a.toml", level = 2 }]"#,
    ),
    ("psychometric", r#"{ function = "logistic", direction = "rising", label = "l" }"#),
    ("adaptive", r#"{ procedure = "staircase", trials = 5, reversals = 5, down = 2 }"#),
];

/// A minute: longer than any test.
pub(crate) const IDLE: Duration = Duration::from_secs(60);

/// Three stills, each shown once.
pub(crate) fn study() -> StudyDefinition {
    of_blocks("small.toml", &[stills()])
}

/// Three stills, then a staircase of five trials in two intervals.
pub(crate) fn adaptive() -> StudyDefinition {
    of_blocks("adaptive.toml", &[stills(), fixtures::block("levels", &STAIRCASE)])
}

fn stills() -> String {
    fixtures::block("stills", &[("items", &fixtures::items(["a", "b", "c"], "a.toml"))])
}

fn of_blocks(file: &str, blocks: &[String]) -> StudyDefinition {
    StudyDefinition::parse(file, &fixtures::study(&[("seed", "3"), ("size", "[16, 16]")], blocks)).unwrap()
}

/// A picture of one shade, packed fast or well.
pub(crate) fn png(shade: u8, compression: CompressionType) -> Vec<u8> {
    let mut bytes = Vec::new();
    let encoder = PngEncoder::new_with_quality(&mut bytes, compression, FilterType::NoFilter);
    encoder.write_image(&[shade; 256], 16, 16, ExtendedColorType::L8).unwrap();
    bytes
}

/// A square picture of one shade.
pub(crate) fn square(shade: u8, side: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let pixels = vec![shade; (side * side) as usize];
    PngEncoder::new(&mut bytes).write_image(&pixels, side, side, ExtendedColorType::L8).unwrap();
    bytes
}

/// A study that is served.
#[derive(Clone)]
pub(crate) struct Served {
    pub study: StudyDefinition,
    pub version: String,
    pub stimuli: Vec<StudyStimulus>,
}

/// Pictures for every item and condition of a study, shades counted from `shade`.
pub(crate) async fn pictures(
    store: &Store,
    study: &StudyDefinition,
    shade: u8,
    compression: CompressionType,
) -> Vec<StudyStimulus> {
    let items = study.blocks.iter().flat_map(|block| &block.items);
    let shown = items.flat_map(|item| ["mc", "pa"].map(|condition| (item.id.clone(), condition.to_owned())));
    let mut stimuli = Vec::new();
    for (shade, (item, condition)) in (shade..).zip(shown) {
        let info = store.put_stimulus("image/png", png(shade, compression)).await.unwrap();
        let (sha256, pixels_sha256, size) = (info.sha256, info.pixels_sha256, info.size);
        let provenance = json!({ "shade": shade });
        stimuli.push(StudyStimulus { item, condition, sha256, pixels_sha256, size, provenance });
    }
    stimuli
}

pub(crate) async fn serve(store: &Store, study: StudyDefinition, shade: u8) -> Served {
    let stimuli = pictures(store, &study, shade, CompressionType::Fast).await;
    let version = store.put_version(&study, &stimuli).await.unwrap();
    Served { study, version, stimuli }
}

pub(crate) async fn open() -> (TempDir, Store, Served) {
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path()).await.unwrap();
    let served = serve(&store, study(), 1).await;
    (folder, store, served)
}

impl Served {
    /// A trial with its pictures.
    pub(crate) fn planned(&self, trial: Trial) -> PlannedTrial {
        let hashes = |item: &str, condition: &str| {
            let found = self.stimuli.iter().find(|s| s.item == item && s.condition == condition).unwrap();
            StimulusHashes { sha256: found.sha256.clone(), pixels_sha256: found.pixels_sha256.clone() }
        };
        let stimuli = trial.shown.iter().map(|(role, p)| (*role, hashes(&p.item, &p.condition))).collect();
        PlannedTrial { trial, stimuli, larger: Vec::new() }
    }

    /// The beginning of a slot's plan.
    pub(crate) fn plan(&self, slot: u32) -> PlannedSession {
        let TrialPlan { seed, trials, more, .. } = TrialPlan::for_slot(&self.study, slot);
        let trials = trials.into_iter().map(|trial| self.planned(trial)).collect();
        PlannedSession { seed, next: NextTrials { trials, more } }
    }

    /// What follows in a session of `slot`.
    pub(crate) fn next(&self, slot: u32, progress: &Progress) -> NextTrials {
        let decided: Vec<Trial> = progress.trials.iter().map(|planned| planned.trial.clone()).collect();
        let chose_target = |index: u32| {
            let trial = &decided[index as usize];
            let chosen = trial.trial.rules().chosen(progress.answers.get(&index)?)?;
            Some(trial.shown[&chosen].condition == "pa")
        };
        let Decision { trials, more } = next_trials(&self.study, slot, &decided, &chose_target);
        NextTrials { trials: trials.into_iter().map(|trial| self.planned(trial)).collect(), more }
    }
}

/// Begins a session; sessions not seen for `idle` give up their slots.
pub(crate) async fn begin(store: &Store, served: &Served, idle: Duration) -> Session {
    let (new, served) = (newcomer(served, idle), served.clone());
    let plan = move |slot| Ok::<_, StoreError>(served.plan(slot));
    store.create_session(new, plan).await.unwrap().session().unwrap()
}

/// Somebody who begins.
pub(crate) fn newcomer(served: &Served, idle: Duration) -> NewSession {
    NewSession {
        study_id: served.study.id.clone(),
        version: served.version.clone(),
        file_hash: served.study.file_hash(),
        subject_id: None,
        token_hash: "t".to_owned(),
        kind: Default::default(),
        flags: Vec::new(),
        repeat: Default::default(),
        start_key: None,
        user_agent: None,
        params: json!({}),
        display: json!({}),
        idle,
    }
}

/// An answer as a page sends it to a kind of trial.
pub(crate) fn answer_of(
    rules: &dyn TrialRules,
    trial_index: u32,
    chose_first: bool,
    rt_ms: f64,
) -> NewAnswer {
    let sent = rules.simulate(chose_first, rt_ms);
    let Checked { answer, stimulus_size } = rules.check(&sent).unwrap();
    NewAnswer { trial_index, answer, payload: sent.to_string(), stimulus_size }
}

/// An answer to a still.
pub(crate) fn answer(trial_index: u32, chose_left: bool, rt_ms: f64) -> NewAnswer {
    answer_of(kelir_study::trials::rules("two-alternative").unwrap(), trial_index, chose_left, rt_ms)
}

/// Stores an answer in a session whose plan was decided when it began.
pub(crate) async fn append(store: &Store, session: &Session, new: NewAnswer) -> Appended {
    let nothing = |_| -> Result<NextTrials, StoreError> { panic!("a whole plan was asked to go on") };
    store.append_answer(session, &new, nothing).await.unwrap()
}

/// A connection of someone who is not the store and does not care for foreign keys.
pub(crate) async fn stranger(folder: &Path) -> SqliteConnection {
    SqliteConnectOptions::new()
        .filename(folder.join("kelir.sqlite"))
        .foreign_keys(false)
        .busy_timeout(Duration::from_secs(10))
        .connect()
        .await
        .unwrap()
}

/// Runs statements as someone who may drop triggers and constraints: each must change something.
pub(crate) async fn tamper(folder: &Path, statements: &[&str]) {
    let mut stranger = stranger(folder).await;
    let triggers = "SELECT name FROM sqlite_schema WHERE type = 'trigger'";
    let triggers: Vec<String> = sqlx::query_scalar(triggers).fetch_all(&mut stranger).await.unwrap();
    for name in triggers {
        sqlx::query(AssertSqlSafe(format!("DROP TRIGGER {name}"))).execute(&mut stranger).await.unwrap();
    }
    sqlx::query("PRAGMA ignore_check_constraints = on").execute(&mut stranger).await.unwrap();
    for sql in statements {
        let done = sqlx::query(AssertSqlSafe((*sql).to_owned())).execute(&mut stranger).await;
        let changed = done.unwrap_or_else(|error| panic!("{sql}: {error}")).rows_affected();
        assert!(changed > 0, "{sql}: nothing was changed");
    }
}

/// Every row of every table but sqlx's own, and every table's layout, as text.
pub(crate) async fn dump(folder: &Path) -> String {
    let mut stranger = stranger(folder).await;
    let layout =
        "SELECT coalesce(group_concat(type || ' ' || name || ' ' || coalesce(sql, ''), char(10)), '') FROM
                  (SELECT * FROM sqlite_schema ORDER BY type, name)";
    let mut text: String = sqlx::query_scalar(layout).fetch_one(&mut stranger).await.unwrap();
    let tables =
        "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%' ORDER BY name";
    let tables: Vec<String> = sqlx::query_scalar(tables).fetch_all(&mut stranger).await.unwrap();
    for table in tables {
        let columns = "SELECT group_concat('quote(' || name || ')', '||'',''||') FROM pragma_table_info($1)";
        let columns: String =
            sqlx::query_scalar(columns).bind(&table).fetch_one(&mut stranger).await.unwrap();
        let rows = format!("SELECT {columns} AS line FROM {table} ORDER BY line");
        let rows: Vec<String> =
            sqlx::query_scalar(AssertSqlSafe(rows)).fetch_all(&mut stranger).await.unwrap();
        text += &format!("\n{table}: {}\n{}", rows.len(), rows.join("\n"));
    }
    text
}

/// A copy of a data folder that the program of commit 944eaa2 wrote.
pub(crate) fn fixture(name: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    copy(&fixtures().join(name), folder.path());
    folder
}

pub(crate) fn fixtures() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/944eaa2")
}

fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let (entry, to) = (entry.unwrap(), to.to_owned());
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &to.join(entry.file_name())),
            false => drop(std::fs::copy(entry.path(), to.join(entry.file_name())).unwrap()),
        }
    }
}

/// The session of the fixture `answered` that its people left unfinished.
pub(crate) async fn half(store: &Store) -> Session {
    let text = std::fs::read_to_string(fixtures().join("answered.half.json")).unwrap();
    let (id, token): (String, String) = serde_json::from_str(&text).unwrap();
    let session = store.session(&id).await.unwrap().unwrap();
    assert_eq!(session.token_hash, kelir_store::sha256_hex(token.as_bytes()));
    session
}
