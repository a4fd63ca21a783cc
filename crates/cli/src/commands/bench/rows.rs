//! `kelir bench rows`: how long judging many answers takes, from the database's first row to the researcher's page.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use kelir_house::selection::{Selection, VersionRef, With};
use kelir_house::{Library, Made, Maker, Task, results};
use kelir_render::encode;
use kelir_server::{Server, ServerConfig, TrustedProxies};
use kelir_stats::pairwise::Model;
use kelir_stats::random::Random;
use kelir_store::{
    ImportedSession, NewAnswer, NextTrials, PlannedSession, PlannedTrial, StimulusHashes, Store,
    StoredAnswers, StudyStimulus,
};
use kelir_study::analysis::{conditions_scale, summarise};
use kelir_study::answers::Participant;
use kelir_study::screening::screen;
use kelir_study::trials::{Checked, Role};
use kelir_study::{StudyDefinition, Trial, TrialPlan};
use serde::Serialize;

use crate::output::{Figures, table};
use crate::{bad_input, progress};

/// Arguments of `kelir bench rows`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Answers; rounded up to whole participants of thirty.
    #[arg(long, default_value_t = 1_000_000)]
    rows: u64,
    #[command(flatten)]
    pub(super) figures: Figures,
}

const CONDITIONS: usize = 6;
const ITEMS_A_BLOCK: usize = 2;
const SIZE: [u32; 2] = [592, 333];
/// Sessions stored in one transaction.
const BATCH: u32 = 500;
const PASSWORD: &str = "a password for a benchmark";

/// Seconds that each step took.
#[derive(Serialize)]
struct Report {
    rows: u64,
    participants: u64,
    conditions: usize,
    blocks: usize,
    excluded: usize,
    threads: usize,
    write_s: f64,
    cold_read_s: f64,
    screening_s: f64,
    t_tests_s: f64,
    scaling_s: f64,
    cold_total_s: f64,
    warm_read_s: f64,
    warm_total_s: f64,
    command_s: f64,
    http_first_s: f64,
    http_next_s: f64,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    let trials = (CONDITIONS * (CONDITIONS - 1) / 2 * ITEMS_A_BLOCK) as u64;
    if !(1..=100_000_000).contains(&args.rows) {
        return Err(bad_input(format!("rows = {}: must lie between 1 and 100,000,000", args.rows)));
    }
    let people = u32::try_from(args.rows.div_ceil(trials))?;
    let folder = tempfile::tempdir()?;
    let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build()?;
    let report = runtime.block_on(measure(folder.path(), people))?;
    args.figures.say(&format!(
        "{} answers of {} participants to {} blocks over {} conditions, {} of them excluded by rules; {} threads\n",
        report.rows, report.participants, report.blocks, report.conditions, report.excluded, report.threads
    ))?;
    let seconds = |x: f64| format!("{x:.3}");
    let row = |what: &str, s: f64| vec![what.to_owned(), seconds(s)];
    args.figures.say(&table(
        &["step", "seconds"],
        &[
            row("write them (chain of hashes, payloads)", report.write_s),
            row("read all from the database", report.cold_read_s),
            row("screen every participant", report.screening_s),
            row("the paper's t-test of every block", report.t_tests_s),
            row("scale the conditions", report.scaling_s),
            row("all of it, nothing read before", report.cold_total_s),
            row("read one answer more", report.warm_read_s),
            row("all of it, one answer more", report.warm_total_s),
            row("results of the folder, without a server", report.command_s),
            row("GET results, first after the start", report.http_first_s),
            row("GET results, one answer more", report.http_next_s),
        ],
    ))?;
    args.figures.give(&report)
}

async fn measure(data: &Path, people: u32) -> Result<Report> {
    std::fs::create_dir_all(data.join("studies"))?;
    std::fs::write(data.join("studies/rows.toml"), study_file())?;
    let study = Library::new(data).study("studies/rows.toml")?;
    let store = Store::open(data).await?;
    let served = Served::new(&store, study).await?;
    let begun = Instant::now();
    served.fill(&store, people).await?;
    let write_s = begun.elapsed().as_secs_f64();

    let study = &served.study;
    let mut stored = StoredAnswers::new(study, std::slice::from_ref(&served.version));
    let cold = judged(&store, study, &mut stored).await?;
    let rows = u64::from(people) * study.most_trials() as u64;
    if cold.answers as u64 != rows {
        bail!("{} answers were read of {rows}", cold.answers);
    }
    served.one_more(&store).await?;
    let warm = judged(&store, study, &mut stored).await?;
    store.close().await;

    let begun = Instant::now();
    let store = results::open_study(data, &study.id).await?;
    let selection = Selection::of(&store, &study.id, None, &VersionRef::Current, &With::default()).await?;
    results::results(&store, &selection).await?;
    store.close().await;
    let command_s = begun.elapsed().as_secs_f64();
    let (http_first_s, http_next_s) = over_http(data, &served).await?;
    Ok(Report {
        rows,
        participants: u64::from(people),
        conditions: study.conditions.len(),
        blocks: study.blocks.len(),
        excluded: cold.excluded,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        write_s,
        cold_read_s: cold.read_s,
        screening_s: cold.screening_s,
        t_tests_s: cold.t_tests_s,
        scaling_s: cold.scaling_s,
        cold_total_s: cold.total_s,
        warm_read_s: warm.read_s,
        warm_total_s: warm.total_s,
        command_s,
        http_first_s,
        http_next_s,
    })
}

/// One round of judging.
struct Judged {
    answers: usize,
    excluded: usize,
    read_s: f64,
    screening_s: f64,
    t_tests_s: f64,
    scaling_s: f64,
    total_s: f64,
}

async fn judged(store: &Store, study: &StudyDefinition, stored: &mut StoredAnswers) -> Result<Judged> {
    let begun = Instant::now();
    store.read_on(stored).await?;
    let read_s = begun.elapsed().as_secs_f64();
    let answers = stored.answers();
    let step = Instant::now();
    let everybody = answers.participants();
    let kept: Vec<&Participant> =
        everybody.iter().copied().filter(|p| screen(study, p, &[]).is_empty()).collect();
    let screening_s = step.elapsed().as_secs_f64();
    let step = Instant::now();
    let blocks = summarise(study, &kept);
    let t_tests_s = step.elapsed().as_secs_f64();
    let step = Instant::now();
    let scale = conditions_scale(study, &kept);
    let scaling_s = step.elapsed().as_secs_f64();
    let total_s = begun.elapsed().as_secs_f64();
    if blocks.iter().any(|block| block.n == 0) {
        bail!("a block has no participants");
    }
    scale.map_err(anyhow::Error::msg)?;
    let excluded = everybody.len() - kept.len();
    Ok(Judged { answers: answers.len(), excluded, read_s, screening_s, t_tests_s, scaling_s, total_s })
}

/// Six conditions, each two of them a block of two items.
fn study_file() -> String {
    let [width, height] = SIZE;
    let mut text = format!(
        "title = \"Rows\"\nquestion = \"Which?\"\nseed = 1\nsize = [{width}, {height}]\nestimated_minutes = 9\n\
         texts = {{ welcome = \"w\", consent = \"c\", instructions = \"i\", debriefing = \"d\", thanks = \"t\" }}\n\
         screening = {{ min_rt_ms = 200, max_fast_trials = 2, straight_lining = true, incomplete = true }}\n"
    );
    for i in 0..CONDITIONS {
        text += &format!("[conditions.spp-{i}]\ntechnique = \"mc\"\nspp = {}\n", 1 << i);
    }
    for (i, j) in comparisons() {
        let items: Vec<String> = (0..ITEMS_A_BLOCK)
            .map(|k| format!("{{ id = \"item-{i}-{j}-{k}\", scene = \"../scenes/arjuna-near.toml\" }}"))
            .collect();
        text += &format!(
            "[[blocks]]\nid = \"block-{i}-{j}\"\ntitle = \"{i} and {j}\"\nkind = \"still\"\n\
             conditions = [\"spp-{i}\", \"spp-{j}\"]\ntarget = \"spp-{i}\"\nitems = [{}]\n",
            items.join(", ")
        );
    }
    text
}

fn comparisons() -> impl Iterator<Item = (usize, usize)> {
    (0..CONDITIONS).flat_map(|i| (i + 1..CONDITIONS).map(move |j| (i, j)))
}

/// The study as it is served: one picture stands for all.
struct Served {
    study: StudyDefinition,
    version: String,
    picture: StimulusHashes,
}

impl Served {
    async fn new(store: &Store, study: StudyDefinition) -> Result<Served> {
        let black = vec![0; SIZE[0] as usize * SIZE[1] as usize];
        let png = encode::png(&black, SIZE.map(|side| side as usize))?;
        let info = store.put_stimulus("image/png", png).await?;
        let shown = study.blocks.iter().flat_map(|block| {
            block
                .items
                .iter()
                .flat_map(|item| block.conditions.iter().map(|name| (item.id.clone(), name.clone())))
        });
        let stimulus = |(item, condition)| StudyStimulus {
            item,
            condition,
            sha256: info.sha256.clone(),
            pixels_sha256: info.pixels_sha256.clone(),
            size: info.size,
            provenance: serde_json::json!({}),
        };
        let stimuli: Vec<StudyStimulus> = shown.map(stimulus).collect();
        let version = store.put_version(&study, &stimuli).await?;
        let picture = StimulusHashes { sha256: info.sha256, pixels_sha256: info.pixels_sha256 };
        Ok(Served { study, version, picture })
    }

    /// Simulated participants, a fifth of a JOD between neighbouring conditions, through the store's own rows and chain.
    async fn fill(&self, store: &Store, people: u32) -> Result<()> {
        let bar = progress::bar(u64::from(people), "participants");
        let mut next = 0;
        while next < people {
            let until = people.min(next + BATCH);
            let sessions = (next..until).map(|slot| self.simulate(slot)).collect::<Result<_>>()?;
            store.import_sessions(sessions).await?;
            next = until;
            bar.set_position(u64::from(next));
        }
        bar.finish_and_clear();
        Ok(())
    }

    fn simulate(&self, slot: u32) -> Result<ImportedSession> {
        let mut random = Random::stream(self.study.seed, u64::from(slot));
        let TrialPlan { seed, trials, more, .. } = TrialPlan::for_slot(&self.study, slot);
        let answers = trials.iter().map(|trial| answer(trial, &mut random)).collect::<Result<_>>()?;
        let filled = |trial: Trial| PlannedTrial {
            stimuli: trial.shown.keys().map(|role| (*role, self.picture.clone())).collect(),
            larger: Vec::new(),
            trial,
        };
        let next = NextTrials { trials: trials.into_iter().map(filled).collect(), more };
        Ok(ImportedSession {
            study_id: self.study.id.clone(),
            version: self.version.clone(),
            file_hash: self.study.file_hash(),
            slot,
            planned: PlannedSession { seed, next },
            answers,
            completion_code: Some("DONE".to_owned()),
        })
    }

    /// A newcomer who has answered one trial.
    async fn one_more(&self, store: &Store) -> Result<()> {
        let mut session = self.simulate(1_000_000_000)?;
        session.answers.truncate(1);
        session.completion_code = None;
        Ok(store.import_sessions(vec![session]).await?)
    }
}

/// What a page sends for a trial, and what is stored of it.
fn answer(trial: &Trial, random: &mut Random) -> Result<NewAnswer> {
    let quality = |role| {
        let spp = trial.shown.get(&role).and_then(|placed| placed.condition.strip_prefix("spp-"));
        spp.and_then(|spp| spp.parse::<f64>().ok()).unwrap_or_default() * 0.2
    };
    let p = Model::default().probability(quality(Role::Left) - quality(Role::Right));
    let rt_ms = (7.0 + 0.6 * random.normal()).exp();
    let rules = trial.trial.rules();
    let sent = rules.simulate(random.bernoulli(p), rt_ms);
    let Ok(checked) = rules.check(&sent) else { bail!("trial {}: {sent} is no answer", trial.trial_index) };
    let Checked { answer, stimulus_size } = checked;
    Ok(NewAnswer { trial_index: trial.trial_index, answer, payload: sent.to_string(), stimulus_size })
}

/// Refuses to draw: no picture is looked at here.
struct Nobody;

impl Maker for Nobody {
    fn identity(&self, _: &Task<'_>, _: &Library) -> Result<String, String> {
        Err("nothing is drawn in a benchmark of answers".to_owned())
    }

    fn make(&self, _: &Task<'_>, _: &Library, _: &mut (dyn FnMut(f64, &str) + Send)) -> Result<Made, String> {
        Err("nothing is drawn in a benchmark of answers".to_owned())
    }
}

/// Seconds of the first request for results after the server's start, and of the next, before which one answer came.
async fn over_http(data: &Path, served: &Served) -> Result<(f64, f64)> {
    let server = Server::start(ServerConfig {
        data: data.to_owned(),
        listen: SocketAddr::from(([127, 0, 0, 1], 0)),
        password: Some(PASSWORD.to_owned()),
        secure_cookies: false,
        trusted_proxies: TrustedProxies::default(),
        maker: Arc::new(Nobody),
        progress: Arc::new(|_| {}),
    })
    .await?;
    // It fails, as it should.
    let _ = server.ready().await;
    let address = server.address();
    let body = serde_json::json!({ "password": PASSWORD }).to_string();
    let signed_in = request(address, "POST", "/api/v1/auth/session", "", body).await?;
    let cookie = signed_in
        .lines()
        .find_map(|line| line.strip_prefix("set-cookie: ")?.split(';').next())
        .context("the server gave no cookie")?
        .to_owned();
    let path = format!("/api/v1/studies/{}/versions/{}/results", served.study.id, served.version);
    let mut seconds = [0.0; 2];
    for took in &mut seconds {
        let begun = Instant::now();
        let answer = request(address, "GET", &path, &cookie, String::new()).await?;
        *took = begun.elapsed().as_secs_f64();
        if !answer.starts_with("HTTP/1.1 200") || !answer.contains("\"jod\"") {
            bail!("GET {path}: {}", answer.lines().next().unwrap_or_default());
        }
        served.one_more(server.server().store()).await?;
    }
    server.shutdown().await;
    Ok((seconds[0], seconds[1]))
}

async fn request(
    address: SocketAddr,
    method: &str,
    path: &str,
    cookie: &str,
    body: String,
) -> Result<String> {
    let text = format!(
        "{method} {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nContent-Type: application/json\r\n\
         Cookie: {cookie}\r\nContent-Length: {}\r\n\r\n{body}",
        body.len()
    );
    tokio::task::spawn_blocking(move || {
        let mut stream = TcpStream::connect(address)?;
        stream.write_all(text.as_bytes())?;
        let mut answer = String::new();
        stream.read_to_string(&mut answer)?;
        Ok(answer)
    })
    .await?
}
