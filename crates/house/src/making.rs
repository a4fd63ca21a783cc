//! Making a study's stimuli: each once, stored by what it is with where it came from.

use crate::library::{Library, beside};
use crate::task::{Made, Maker, Task, tasks};
use crate::{drawing, picture};
use kelir_store::{ANIMATION, Render, StimulusInfo, Store, StoreError, StudyStimulus, sha256_hex};
use kelir_study::{Condition, Pictures, StudyDefinition};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;

/// How far a study's stimuli are.
#[derive(Clone, Debug)]
pub struct Making {
    /// Study's id.
    pub study: String,
    /// Which stimulus is being made, `pair (condition)` and its size where there are several; empty at the end.
    pub stimulus: String,
    /// What is being done to it.
    pub step: String,
    /// Stimuli that are ready.
    pub done: usize,
    /// Stimuli in all.
    pub total: usize,
    /// Part of the present stimulus that is done, 0..=1.
    pub fraction: f64,
}

/// A study's stimuli, by item and condition, each by rising size.
#[derive(Clone, Debug, Default)]
pub struct StimulusMap(BTreeMap<(String, String), Vec<StudyStimulus>>);

impl StimulusMap {
    /// What an item shows under a condition, by rising size; never nothing.
    ///
    /// # Errors
    /// [`MakingError::Missing`] names what is not there.
    pub fn of(&self, item: &str, condition: &str) -> Result<&[StudyStimulus], MakingError> {
        let missing = || MakingError::Missing { item: item.to_owned(), condition: condition.to_owned() };
        self.0.get(&(item.to_owned(), condition.to_owned())).map(Vec::as_slice).ok_or_else(missing)
    }

    /// What an item shows under a condition at the size of this place, from 0.
    ///
    /// # Errors
    /// [`MakingError::Missing`] names what is not there.
    pub fn at(&self, item: &str, condition: &str, rank: usize) -> Result<&StudyStimulus, MakingError> {
        let missing = || MakingError::Missing { item: item.to_owned(), condition: condition.to_owned() };
        self.of(item, condition)?.get(rank).ok_or_else(missing)
    }

    /// Everything that is shown, by item, condition and size.
    pub fn all(&self) -> Vec<StudyStimulus> {
        self.0.values().flatten().cloned().collect()
    }
}

impl FromIterator<StudyStimulus> for StimulusMap {
    fn from_iter<T: IntoIterator<Item = StudyStimulus>>(stimuli: T) -> StimulusMap {
        let mut map = BTreeMap::<(String, String), Vec<StudyStimulus>>::new();
        for stimulus in stimuli {
            map.entry((stimulus.item.clone(), stimulus.condition.clone())).or_default().push(stimulus);
        }
        map.values_mut().for_each(|sizes| sizes.sort_by_key(|stimulus| stimulus.size));
        StimulusMap(map)
    }
}

/// Why a study's stimuli could not be made.
#[derive(Debug, thiserror::Error)]
pub enum MakingError {
    /// One of them cannot.
    #[error("{stimulus}: {reason}")]
    Stimulus {
        /// Pair and condition in words.
        stimulus: String,
        /// Why.
        reason: String,
    },
    /// A study shows what was never made.
    #[error("item {item} has no stimulus of condition {condition}")]
    Missing {
        /// Id of the item.
        item: String,
        /// The condition's name.
        condition: String,
    },
    /// The store cannot be read or written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Makes what is missing of a study's stimuli; what was made before, in any run, is taken as it is. Each is stored as soon as
/// it is done, so an interrupted run goes on where it stopped.
///
/// # Errors
/// Why one of them cannot be made, or the store not be used.
pub async fn make(
    study: &Arc<StudyDefinition>,
    store: &Store,
    library: &Library,
    maker: &Arc<dyn Maker>,
    progress: &(dyn Fn(Making) + Send + Sync),
) -> Result<StimulusMap, MakingError> {
    let tasks = tasks(study);
    let mut made = Vec::new();
    for (done, task) in tasks.iter().enumerate() {
        let stimulus = task.in_words();
        let event = |fraction, step: &str| Making {
            study: study.id.clone(),
            stimulus: stimulus.clone(),
            step: step.to_owned(),
            done,
            total: tasks.len(),
            fraction,
        };
        let failed = |reason: String| MakingError::Stimulus { stimulus: stimulus.clone(), reason };
        progress(event(0.0, "looking it up"));
        let identity = drawing::draw(|| identity(task, library, maker.as_ref())).map_err(failed)?;
        let job_key = sha256_hex(identity.as_bytes());
        let (info, provenance) = match intact(store, &job_key).await? {
            Some(known) => known,
            None => {
                let drawn = drawing::draw(|| {
                    draw(task, library, maker.as_ref(), &mut |fraction, step| progress(event(fraction, step)))
                });
                match keep(store, &job_key, drawn.map_err(failed)?).await {
                    Err(error @ StoreError::Undecodable(_)) => return Err(failed(error.to_string())),
                    kept => kept?,
                }
            }
        };
        // What browsers get is packed beforehand, so that no participant waits for it.
        progress(event(1.0, "packing"));
        match store.packing(&info.sha256).await {
            Err(error @ StoreError::Undecodable(_)) => return Err(failed(error.to_string())),
            packed => packed?,
        };
        made.push(StudyStimulus {
            item: task.pair.id.clone(),
            condition: task.name.to_owned(),
            sha256: info.sha256,
            pixels_sha256: info.pixels_sha256,
            size: info.size,
            provenance,
        });
    }
    let total = tasks.len();
    progress(Making {
        study: study.id.clone(),
        stimulus: String::new(),
        step: "ready".to_owned(),
        done: total,
        total,
        fraction: 1.0,
    });
    Ok(made.into_iter().collect())
}

/// The stimulus of a finished job and how it was made, if it and all it names are stored undamaged.
async fn intact(store: &Store, job_key: &str) -> Result<Option<(StimulusInfo, Value)>, StoreError> {
    let Some(render) = store.render(job_key).await? else { return Ok(None) };
    if !is_whole(store, &render.sha256).await? {
        return Ok(None);
    }
    let info = store.stimulus_info(&render.sha256).await?;
    Ok(info.map(|info| (info, render.provenance)))
}

/// Whether a stimulus and all that it names are stored as they were.
///
/// # Errors
/// The store cannot be read.
pub async fn is_whole(store: &Store, sha256: &str) -> Result<bool, StoreError> {
    let mut wanted = vec![sha256.to_owned()];
    while let Some(sha256) = wanted.pop() {
        match store.stimulus(&sha256).await {
            Ok(Some((media_type, bytes))) if media_type == ANIMATION => wanted.extend(frames(&bytes)),
            Ok(Some(_)) => {}
            Ok(None) | Err(StoreError::Damaged { .. }) => return Ok(false),
            Err(error) => return Err(error),
        }
    }
    Ok(true)
}

/// The frames that a manifest names, each once.
fn frames(manifest: &[u8]) -> Vec<String> {
    let manifest: Value = serde_json::from_slice(manifest).unwrap_or_default();
    let mut frames: Vec<String> = manifest["frames"]
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|frame| frame.as_str().map(str::to_owned))
        .collect();
    frames.sort();
    frames.dedup();
    frames
}

async fn keep(store: &Store, job_key: &str, made: Made) -> Result<(StimulusInfo, Value), StoreError> {
    for (media_type, bytes) in made.attachments {
        store.put_stimulus(&media_type, bytes).await?;
    }
    let info = store.put_stimulus(&made.media_type, made.bytes).await?;
    let (sha256, provenance) = (info.sha256.clone(), made.provenance);
    let render = Render { job_key: job_key.to_owned(), sha256, provenance };
    store.put_render(&render).await?;
    Ok((info, render.provenance))
}

fn identity(task: &Task<'_>, library: &Library, maker: &dyn Maker) -> Result<String, String> {
    match task.condition {
        Condition::Rendered { .. } => maker.identity(task, library),
        Condition::Files { .. } => {
            let (path, bytes) = picture_file(task, library)?;
            Ok(format!("file\n{path}\n{}", sha256_hex(&bytes)))
        }
    }
}

fn draw(
    task: &Task<'_>,
    library: &Library,
    maker: &dyn Maker,
    progress: &mut (dyn FnMut(f64, &str) + Send),
) -> Result<Made, String> {
    match task.condition {
        Condition::Rendered { .. } => maker.make(task, library, progress),
        Condition::Files { .. } => {
            let (path, bytes) = picture_file(task, library)?;
            if let Some(rule) = picture::broken(&path, &bytes, task.size).first() {
                return Err(format!("{path}: {rule}"));
            }
            let (media_type, _) =
                picture::describe(&bytes).ok_or(format!("{path}: is neither PNG nor JPEG"))?;
            let provenance = json!({ "source": "file", "file": path });
            Ok(Made { media_type: media_type.to_owned(), bytes, attachments: Vec::new(), provenance })
        }
    }
}

fn picture_file(task: &Task<'_>, library: &Library) -> Result<(String, Vec<u8>), String> {
    let Condition::Files { files } = task.condition else { return Err("is not a picture file".to_owned()) };
    let paths = files.get(&task.pair.id).map(Pictures::paths).unwrap_or_default();
    let path = paths.get(task.rank).ok_or("has no picture file")?;
    let path = beside(&task.study_file(), path);
    let bytes = library.read(&path).map_err(|error| format!("{path}: {error}"))?;
    Ok((path, bytes))
}
