//! The narrow door to the renderer: a scene, a technique and an output in, a stimulus out.

use crate::library::Library;
use crate::task::{Made, Maker, Task};
use kelir_render::camera::Camera;
use kelir_render::job::{Drawing, Job, Output, Progress, Staged, Subject, run};
use kelir_render::{Backend, Pixel, RenderError, Technique, View};
use kelir_scene::AnyScene;
use kelir_study::{Condition, Kind, Problem};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Makes stimuli with kelir's renderer, in this process and on its native code: GPU drivers differ, and one study may be drawn on several
/// machines.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderMaker {}

/// A condition's technique with its knobs; what is wrong with them.
pub(crate) fn technique(name: &str, knobs: &BTreeMap<String, Value>) -> Result<Technique, String> {
    Technique::parse(name, knobs).map_err(|error| error.to_string())
}

/// The camera with these settings, which are those of the study's smallest size; what is wrong with them. In a picture `magnification` times as
/// wide the blur is as much wider and a pixel, which gathers less light, as much noisier: it is the same photograph by a finer sensor.
pub(crate) fn camera(settings: &BTreeMap<String, Value>, magnification: f64) -> Result<Camera, String> {
    let mut camera: Camera = serde_json::from_value(json!(settings)).map_err(|error| error.to_string())?;
    camera.defocus_px *= magnification;
    camera.noise *= magnification;
    camera.check().map_err(|error| error.to_string())?;
    Ok(camera)
}

/// Every technique with what can be turned on it, its range and where it stands: a sentence each, from the techniques' own tables.
pub fn techniques_in_words() -> String {
    let sentence = |technique: Technique| {
        let stand = technique.stand();
        let knobs = technique.knobs().iter().map(|knob| {
            let stands =
                stand.get(knob.name).map(|value| format!(", {value} unless given")).unwrap_or_default();
            let unit = if knob.unit.is_empty() { String::new() } else { format!(" in {}", knob.unit) };
            format!("`{}`{unit} ({}{stands}): {}", knob.name, knob.range, knob.about)
        });
        let knobs: Vec<String> = knobs.collect();
        format!("`{}`, {}: {}.", technique.name(), technique.about(), knobs.join("; "))
    };
    Technique::all().map(sentence).join(" ")
}

impl Maker for RenderMaker {
    fn identity(&self, task: &Task<'_>, library: &Library) -> Result<String, String> {
        let job = job(task)?;
        let facts = library.scene_facts(&job.scene).map_err(lines)?;
        job.preimage_for(&facts.sha256).map_err(|error| error.to_string())
    }

    fn make(
        &self,
        task: &Task<'_>,
        library: &Library,
        progress: &mut (dyn FnMut(f64, &str) + Send),
    ) -> Result<Made, String> {
        let job = job(task)?;
        let scene = library.scene(&job.scene).map_err(lines)?;
        if scene.sha256() != library.scene_facts(&job.scene).map_err(lines)?.sha256 {
            return Err(format!("{}: was changed after the study was checked; start again", job.scene));
        }
        let mut progress = |step: Progress| progress(step.done as f64 / step.total.max(1) as f64, step.what);
        let stimulus = match scene {
            AnyScene::Theatre(scene) => run(&mut job.with_scene(scene), &mut progress),
            AnyScene::Stage(scene) => run(&mut job.with_scene(scene), &mut progress),
        }
        .map_err(|error| error.to_string())?;
        let mut provenance = serde_json::to_value(&stimulus.provenance).map_err(|error| error.to_string())?;
        provenance["source"] = "rendered".into();
        provenance["scene"] = task.scene_file().into();
        Ok(Made {
            media_type: stimulus.media_type,
            bytes: stimulus.bytes,
            attachments: stimulus.attachments.into_iter().map(|blob| (blob.media_type, blob.bytes)).collect(),
            provenance,
        })
    }
}

/// Tries a task in a small size, by the path that makes it; the scene comes back for the next. Of a study's further sizes the view alone is
/// tried: what is drawn is small at each.
pub(crate) fn rehearse(task: &Task<'_>, scene: AnyScene) -> (AnyScene, Result<(), RenderError>) {
    match scene {
        AnyScene::Theatre(scene) => {
            let (scene, drawn) = rehearse_one(task, scene);
            (AnyScene::Theatre(scene), drawn)
        }
        AnyScene::Stage(scene) => {
            let (scene, drawn) = rehearse_one(task, scene);
            (AnyScene::Stage(scene), drawn)
        }
    }
}

fn rehearse_one<S: Staged>(task: &Task<'_>, scene: S) -> (S, Result<(), RenderError>) {
    match job(task) {
        Ok(job) if task.rank > 0 => {
            let possible = job.view.check(scene.still().sides());
            (scene, possible)
        }
        Ok(job) => kelir_render::job::rehearse(job.with_scene(scene)),
        // What is wrong with the condition or its scene's name has been told already.
        Err(_) => (scene, Ok(())),
    }
}

/// How many pictures there are in all, and the files of some of them.
type Sample = (usize, Vec<Vec<u8>>);

/// Where in a film pictures are taken, as parts of it: not evenly, or they could all lie where a swing turns round.
const PLACES: [f64; 3] = [0.11, 0.37, 0.71];

/// How many pictures a task has, and its picture as it will be made; of a film pairs that follow each other. The scene comes back for the next.
pub(crate) fn sample(task: &Task<'_>, scene: AnyScene) -> (AnyScene, Result<Sample, String>) {
    match scene {
        AnyScene::Theatre(scene) => {
            let (scene, sampled) = sample_one(task, scene);
            (AnyScene::Theatre(scene), sampled)
        }
        AnyScene::Stage(scene) => {
            let (scene, sampled) = sample_one(task, scene);
            (AnyScene::Stage(scene), sampled)
        }
    }
}

fn sample_one<S: Staged>(task: &Task<'_>, scene: S) -> (S, Result<Sample, String>) {
    let mut job = match job(task) {
        Ok(job) => job.with_scene(scene),
        Err(rule) => return (scene, Err(rule)),
    };
    let frames = match (job.output, job.scene.timeline()) {
        (Output::Animation, Some(timeline)) => timeline.frame_count(),
        _ => 1,
    };
    let at = |place: f64| ((frames - 1) as f64 * place) as usize;
    let indices = if frames < 2 {
        vec![0]
    } else {
        PLACES.iter().flat_map(|place| [at(*place), at(*place) + 1]).collect()
    };
    let drawn = files(&mut job, &indices).map_err(|error| error.to_string());
    (job.scene, drawn.map(|pictures| (frames, pictures)))
}

fn files<S: Staged>(job: &mut Job<S>, indices: &[usize]) -> Result<Vec<Vec<u8>>, RenderError> {
    let mut drawing = Drawing::open(job)?;
    let mut pictures = Vec::with_capacity(indices.len());
    for index in indices {
        drawing.frame(*index)?;
        pictures.push(drawing.file()?.bytes);
    }
    Ok(pictures)
}

/// What a task asks the renderer for; its scene as a path in the library, not read.
fn job(task: &Task<'_>) -> Result<Job<String>, String> {
    let Condition::Rendered { technique: name, knobs, camera: settings } = task.condition else {
        return Err("is a picture file and is not drawn".to_owned());
    };
    let technique = technique(name, knobs)?;
    let [width, height] = task.size;
    let output = match task.block.kind {
        Kind::Still => Output::Still,
        Kind::Animation => Output::Animation,
    };
    Ok(Job {
        scene: task.scene_file().ok_or("has no scene")?,
        reference: reference(task, &technique),
        technique,
        view: View { size: [width as usize, height as usize], pixel: Pixel::Area, skip: true },
        backend: Backend::Cpu,
        camera: settings.as_ref().map(|settings| camera(settings, task.magnification())).transpose()?,
        time_s: None,
        exposure: output.exposure(),
        output,
    })
}

pub(crate) fn lines(problems: Vec<Problem>) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// What a stimulus is measured against: the study's own ground truth, the condition of it with the most samples; images of
/// the ground truth themselves carry their standard error.
fn reference(task: &Task<'_>, technique: &Technique) -> Option<Technique> {
    if technique.is_truth() {
        return None;
    }
    let conditions = task.study.conditions.values().filter_map(|condition| match condition {
        Condition::Rendered { technique: name, knobs, .. } => self::technique(name, knobs).ok(),
        _ => None,
    });
    let best = conditions.filter(Technique::is_truth).max_by_key(Technique::truth_samples);
    Some(best.unwrap_or_else(Technique::truth))
}

#[cfg(test)]
mod tests;
