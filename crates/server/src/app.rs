//! What the handlers share.

use crate::address::Tally;
use crate::api::Problem;
use crate::config::ServerConfig;
use crate::findings::Findings;
use crate::limiter::Limiter;
use crate::loaded::{Begun, BrokenStudy, LoadedStudy, Stimuli, closed};
use crate::presenting::Presenter;
use crate::previews::Previews;
use crate::proxies::TrustedProxies;
use kelir_house::links::Links;
use kelir_house::selection::{Selection, SelectionError, VersionRef, With};
use kelir_house::{Library, Maker};
use kelir_store::{Session, Store, StoreError, StoredAnswers};
use kelir_study::StudyDefinition;
use kelir_study::answers::Answers;
use std::collections::{BTreeMap, HashMap};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;
use tokio::sync::Semaphore;

/// How long a start counts as one of many.
const STARTS_WITHIN: Duration = Duration::from_secs(600);

pub(crate) struct App {
    pub(crate) store: Store,
    pub(crate) library: Library,
    pub(crate) maker: Arc<dyn Maker>,
    pub(crate) studies: BTreeMap<String, LoadedStudy>,
    /// Studies whose files are wrong, by id.
    pub(crate) broken: BTreeMap<String, BrokenStudy>,
    pub(crate) limiter: Limiter,
    /// Sessions begun, by address.
    pub(crate) starts: Tally,
    pub(crate) integrity: Findings,
    pub(crate) presenter: Presenter,
    /// argon2 takes 19 MiB and a core for each password it judges.
    pub(crate) judging: Semaphore,
    /// A report resamples participants thousands of times.
    pub(crate) reporting: Semaphore,
    pub(crate) secure_cookies: bool,
    pub(crate) links: Links,
    pub(crate) previews: Previews,
    pub(crate) trusted_proxies: TrustedProxies,
    /// The server was asked to stop: what fails from then on is no fault.
    pub(crate) stopping: AtomicBool,
    /// What sessions that began with other files or versions go on with, by study, file and version.
    begun: RwLock<HashMap<[String; 3], Begun>>,
    /// Answers as last read, by study and versions: what has come since is all that a result has to read.
    answers: tokio::sync::Mutex<HashMap<Vec<String>, StoredAnswers>>,
}

/// Selections of versions whose answers are kept.
const MOST_KEPT: usize = 32;

impl App {
    pub(crate) fn new(
        store: Store,
        library: Library,
        studies: Vec<StudyDefinition>,
        broken: BTreeMap<String, BrokenStudy>,
        config: &ServerConfig,
        links: Links,
    ) -> App {
        let loaded = |study: StudyDefinition| (study.id.clone(), LoadedStudy::new(&library, study));
        let studies = studies.into_iter().map(loaded).collect();
        App {
            store,
            library,
            maker: config.maker.clone(),
            stopping: AtomicBool::new(false),
            broken,
            studies,
            limiter: Limiter::default(),
            starts: Tally::new(STARTS_WITHIN),
            integrity: Findings::default(),
            presenter: Presenter::default(),
            judging: Semaphore::new(2),
            reporting: Semaphore::new(1),
            secure_cookies: config.secure_cookies,
            trusted_proxies: config.trusted_proxies.clone(),
            links,
            previews: Previews::default(),
            begun: RwLock::default(),
            answers: tokio::sync::Mutex::default(),
        }
    }

    pub(crate) fn study(&self, id: &str) -> Result<&LoadedStudy, Box<Problem>> {
        self.studies
            .get(id)
            .ok_or_else(|| if self.broken.contains_key(id) { closed() } else { Problem::not_found("study") })
    }

    /// The version of a study that is served now; `None` while its stimuli are not all made.
    pub(crate) fn current(&self, id: &str) -> Option<String> {
        match self.studies.get(id)?.stimuli() {
            Stimuli::Ready(served) => Some(served.version.clone()),
            _ => None,
        }
    }

    /// What a session began with, where it is in memory.
    pub(crate) fn begun_here(&self, session: &Session) -> Option<Begun> {
        if let Some(loaded) = self.studies.get(&session.study_id)
            && let Stimuli::Ready(served) = loaded.stimuli()
            && (&loaded.file_hash, &served.version) == (&session.file_hash, &session.version)
        {
            return Some(Begun { study: loaded.study.clone(), stimuli: served.stimuli.clone() });
        }
        let key = [&session.study_id, &session.file_hash, &session.version].map(String::clone);
        self.begun.read().unwrap_or_else(PoisonError::into_inner).get(&key).cloned()
    }

    /// What a session began with.
    pub(crate) async fn begun(&self, session: &Session) -> Result<Begun, Box<Problem>> {
        if let Some(begun) = self.begun_here(session) {
            return Ok(begun);
        }
        let study = self.store.study_file(&session.study_id, &session.file_hash).await?;
        let study = study.ok_or_else(|| Problem::internal("a session's study file is not stored"))?;
        let stimuli = self.store.version_stimuli(&session.study_id, &session.version).await?;
        let begun = Begun { study: Arc::new(study), stimuli: Arc::new(stimuli.into_iter().collect()) };
        let key = [&session.study_id, &session.file_hash, &session.version].map(String::clone);
        self.begun.write().unwrap_or_else(PoisonError::into_inner).insert(key, begun.clone());
        Ok(begun)
    }

    /// The versions of a study that are asked for.
    pub(crate) async fn select(
        &self,
        study_id: &str,
        version: &VersionRef,
        with: &With,
    ) -> Result<Selection, Box<Problem>> {
        let current = self.current(study_id);
        let selection = Selection::of(&self.store, study_id, current.as_deref(), version, with).await;
        match selection {
            // Not served and never was: the study is what is not there.
            Err(SelectionError::NoVersion) if !self.studies.contains_key(study_id) => {
                Err(Problem::not_found("study"))
            }
            Err(SelectionError::Unknown(_, known))
                if known.is_empty() && !self.studies.contains_key(study_id) =>
            {
                Err(Problem::not_found("study"))
            }
            selection => Ok(selection?),
        }
    }

    /// Every answer to the chosen versions that there is now.
    pub(crate) async fn answers(&self, selection: &Selection) -> Result<Arc<Answers>, StoreError> {
        let key: Vec<String> =
            std::iter::once(&selection.study.id).chain(&selection.versions).cloned().collect();
        let mut kept = self.answers.lock().await;
        if kept.len() >= MOST_KEPT && !kept.contains_key(&key) {
            kept.clear();
        }
        let new = || StoredAnswers::new(&selection.study, &selection.versions);
        let stored = kept.entry(key).or_insert_with(new);
        self.store.read_on(stored).await?;
        Ok(stored.answers())
    }
}
