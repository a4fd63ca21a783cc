//! What the handlers share.

use crate::api::{Problem, ProblemCode};
use crate::library::Library;
use crate::limiter::Limiter;
use crate::making::{Maker, Making, StimulusMap};
use kelir_store::{Store, StoreError, StoredAnswers};
use kelir_study::StudyDefinition;
use kelir_study::answers::Answers;
use std::collections::{BTreeMap, HashMap};
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;
use tokio::sync::Semaphore;

pub(crate) struct App {
    pub(crate) store: Store,
    pub(crate) library: Library,
    pub(crate) maker: Arc<dyn Maker>,
    pub(crate) studies: BTreeMap<String, LoadedStudy>,
    pub(crate) limiter: Limiter,
    /// argon2 takes 19 MiB and a core for each password it judges.
    pub(crate) judging: Semaphore,
    /// A report resamples participants thousands of times.
    pub(crate) reporting: Semaphore,
    pub(crate) secure_cookies: bool,
    /// Earlier versions of studies, which sessions that began with them go on using.
    versions: RwLock<HashMap<String, Arc<StudyDefinition>>>,
}

/// A study that is being served.
pub(crate) struct LoadedStudy {
    pub(crate) study: Arc<StudyDefinition>,
    pub(crate) config_hash: String,
    pub(crate) stimuli: RwLock<Stimuli>,
    /// The answers as last read: what has come since is all that a result has to read.
    answers: tokio::sync::Mutex<StoredAnswers>,
}

/// How far a study's stimuli are.
#[derive(Clone, Debug)]
pub(crate) enum Stimuli {
    Preparing(Option<Making>),
    Ready(Arc<StimulusMap>),
    Failed(String),
}

impl App {
    pub(crate) fn new(
        store: Store,
        library: Library,
        maker: Arc<dyn Maker>,
        studies: Vec<StudyDefinition>,
        secure_cookies: bool,
    ) -> App {
        let loaded = |study: StudyDefinition| LoadedStudy {
            config_hash: study.config_hash(),
            stimuli: RwLock::new(Stimuli::Preparing(None)),
            answers: tokio::sync::Mutex::new(StoredAnswers::new(&study)),
            study: Arc::new(study),
        };
        App {
            store,
            library,
            maker,
            studies: studies.into_iter().map(|study| (study.id.clone(), loaded(study))).collect(),
            limiter: Limiter::default(),
            judging: Semaphore::new(2),
            reporting: Semaphore::new(1),
            secure_cookies,
            versions: RwLock::default(),
        }
    }

    pub(crate) fn study(&self, id: &str) -> Result<&LoadedStudy, Box<Problem>> {
        self.studies.get(id).ok_or_else(|| Problem::not_found("study"))
    }

    /// The definition that a session began with.
    pub(crate) async fn version(
        &self,
        study_id: &str,
        config_hash: &str,
    ) -> Result<Arc<StudyDefinition>, Box<Problem>> {
        if let Some(loaded) = self.studies.get(study_id)
            && loaded.config_hash == config_hash
        {
            return Ok(loaded.study.clone());
        }
        if let Some(study) = self.versions.read().unwrap_or_else(PoisonError::into_inner).get(config_hash) {
            return Ok(study.clone());
        }
        let versions = self.store.study_versions(study_id).await?;
        let version = versions.into_iter().find(|v| v.config_hash == config_hash);
        let study = Arc::new(
            version.ok_or_else(|| Problem::internal("a session's study version is not stored"))?.study,
        );
        let mut versions = self.versions.write().unwrap_or_else(PoisonError::into_inner);
        versions.insert(config_hash.to_owned(), study.clone());
        Ok(study)
    }
}

impl LoadedStudy {
    /// How long a session may be silent and still hold its place.
    pub(crate) fn idle(&self) -> Duration {
        Duration::from_secs(60 * u64::from(self.study.idle_minutes))
    }

    /// Every answer there is now.
    pub(crate) async fn answers(&self, store: &Store) -> Result<Arc<Answers>, StoreError> {
        let mut stored = self.answers.lock().await;
        store.read_on(&mut stored).await?;
        Ok(stored.answers())
    }

    pub(crate) fn stimuli(&self) -> Stimuli {
        self.stimuli.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(crate) fn set_stimuli(&self, stimuli: Stimuli) {
        *self.stimuli.write().unwrap_or_else(PoisonError::into_inner) = stimuli;
    }

    /// The stimuli, or the answer that says they are not ready.
    pub(crate) fn ready(&self) -> Result<Arc<StimulusMap>, Box<Problem>> {
        match self.stimuli() {
            Stimuli::Ready(map) => Ok(map),
            Stimuli::Preparing(making) => {
                let (done, total) = making.map_or((0, 0), |m| (m.done, m.total));
                let detail = format!(
                    "This study's images are still being made ({done} of {total} ready). Please come back shortly."
                );
                Err(Problem::new(ProblemCode::NotReady, detail).retry_after(5))
            }
            Stimuli::Failed(_) => {
                let detail = "This study's images could not be made. The researchers have been told why.";
                Err(Problem::new(ProblemCode::StimuliFailed, detail))
            }
        }
    }
}
