//! Studies as they are served, and what sessions go on with.

use crate::api::{Problem, ProblemCode};
use kelir_house::making::{Making, StimulusMap};
use kelir_house::{Library, StudyFileError};
use kelir_store::sha256_hex;
use kelir_study::StudyDefinition;
use std::sync::{Arc, PoisonError, RwLock};
use std::time::Duration;

/// A study whose file is wrong: it is not served, and the console says why.
#[derive(Debug)]
pub(crate) struct BrokenStudy {
    pub(crate) id: String,
    /// SHA-256 of the file as it is; empty where it cannot be read.
    pub(crate) file_hash: String,
    /// Everything that is wrong with it: field, value, rule.
    pub(crate) reason: String,
}

impl BrokenStudy {
    pub(crate) fn new(library: &Library, path: &str, error: &StudyFileError) -> BrokenStudy {
        let name = path.rsplit('/').next().unwrap_or(path);
        BrokenStudy {
            id: name.strip_suffix(".toml").unwrap_or(name).to_owned(),
            file_hash: library.read(path).map(|bytes| sha256_hex(&bytes)).unwrap_or_default(),
            reason: error.to_string(),
        }
    }
}

/// A study that is being served.
pub(crate) struct LoadedStudy {
    pub(crate) study: Arc<StudyDefinition>,
    pub(crate) file_hash: String,
    /// What may be a mistake in it.
    pub(crate) warnings: Vec<String>,
    stimuli: RwLock<Stimuli>,
}

impl LoadedStudy {
    pub(crate) fn new(library: &Library, study: StudyDefinition) -> LoadedStudy {
        let warnings = library.warnings(&format!("studies/{}.toml", study.id), &study);
        LoadedStudy {
            file_hash: study.file_hash(),
            warnings: warnings.iter().map(ToString::to_string).collect(),
            stimuli: RwLock::new(Stimuli::Preparing(None)),
            study: Arc::new(study),
        }
    }

    pub(crate) fn stimuli(&self) -> Stimuli {
        self.stimuli.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub(crate) fn set_stimuli(&self, stimuli: Stimuli) {
        *self.stimuli.write().unwrap_or_else(PoisonError::into_inner) = stimuli;
    }

    /// The version with its stimuli, or the answer that says they are not ready.
    pub(crate) fn ready(&self) -> Result<Arc<Served>, Box<Problem>> {
        match self.stimuli() {
            Stimuli::Ready(served) => Ok(served),
            Stimuli::Preparing(making) => {
                let (done, total) = making.map_or((0, 0), |m| (m.done, m.total));
                let detail = format!(
                    "This study's images are still being made ({done} of {total} ready). Please come back shortly."
                );
                Err(Problem::new(ProblemCode::NotReady, detail).retry_after(5))
            }
            Stimuli::Failed(_) => Err(closed()),
        }
    }
}

/// A study's version with all that it shows.
#[derive(Debug)]
pub(crate) struct Served {
    pub(crate) version: String,
    pub(crate) stimuli: Arc<StimulusMap>,
}

/// How far a study's stimuli are.
#[derive(Clone, Debug)]
pub(crate) enum Stimuli {
    Preparing(Option<Making>),
    Ready(Arc<Served>),
    Failed(String),
}

/// What a session goes on with: the file that it began with, and what its version shows.
#[derive(Clone)]
pub(crate) struct Begun {
    pub(crate) study: Arc<StudyDefinition>,
    pub(crate) stimuli: Arc<StimulusMap>,
}

/// How long a session of a study may be silent and still hold its place.
pub(crate) fn idle(study: &StudyDefinition) -> Duration {
    Duration::from_secs(60 * u64::from(study.idle_minutes))
}

/// What participants are told of a study that cannot be taken; the console and the log say why.
pub(crate) fn closed() -> Box<Problem> {
    let detail = "This study can't be taken at the moment. The researchers see the reason in their console.";
    Problem::new(ProblemCode::StimuliFailed, detail)
}
