//! The narrow door to the renderer: a scene, a technique and an output in, a stimulus out.

use crate::library::Library;
use crate::making::{Made, Maker, Task};
use kelir_render::camera::Camera;
use kelir_render::job::{Job, Output, run};
use kelir_render::{Backend, Pixel, Technique, View};
use kelir_study::{Condition, Kind, Problem};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Makes stimuli with kelir's renderer, in this process.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderMaker {
    /// Where it draws.
    pub backend: Backend,
}

/// A condition's technique with its knobs; what is wrong with them.
pub(crate) fn technique(name: &str, knobs: &BTreeMap<String, Value>) -> Result<Technique, String> {
    let mut object: serde_json::Map<String, Value> = knobs.clone().into_iter().collect();
    object.insert("technique".to_owned(), Value::from(name));
    serde_json::from_value(Value::Object(object)).map_err(|error| error.to_string())
}

/// The camera with these settings; what is wrong with them.
pub(crate) fn camera(settings: &BTreeMap<String, Value>) -> Result<Camera, String> {
    let camera: Camera = serde_json::from_value(json!(settings)).map_err(|error| error.to_string())?;
    camera.check().map_err(|error| error.to_string())?;
    Ok(camera)
}

impl Maker for RenderMaker {
    /// All that decides the bytes but for the machine: what was made on one is as good on another.
    fn identity(&self, task: &Task<'_>, library: &Library) -> Result<String, String> {
        let plan = Plan::of(task)?;
        let facts = library.scene_facts(&plan.scene).map_err(lines)?;
        let identity = json!({
            "kelir": env!("CARGO_PKG_VERSION"),
            "scene": facts.sha256,
            "technique": plan.technique,
            "view": plan.view,
            "camera": plan.camera,
            "output": plan.output,
            "reference": plan.reference,
        });
        Ok(identity.to_string())
    }

    fn make(
        &self,
        task: &Task<'_>,
        library: &Library,
        progress: &mut dyn FnMut(f64, &str),
    ) -> Result<Made, String> {
        let Plan { scene, technique, view, camera, output, reference } = Plan::of(task)?;
        let scene = library.scene(&scene).map_err(lines)?;
        let mut job = Job { scene, technique, view, backend: self.backend, camera, output, reference };
        let stimulus = run(&mut job, &mut |step| {
            progress(step.done as f64 / step.total.max(1) as f64, step.what);
        })
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

/// A job before its scene is read.
struct Plan {
    scene: String,
    technique: Technique,
    view: View,
    camera: Option<Camera>,
    output: Output,
    reference: Option<Technique>,
}

impl Plan {
    fn of(task: &Task<'_>) -> Result<Plan, String> {
        let Condition::Rendered { technique: name, knobs, camera: settings } = task.condition else {
            return Err("is a picture file and is not drawn".to_owned());
        };
        let technique = technique(name, knobs)?;
        let [width, height] = task.study.size;
        Ok(Plan {
            scene: task.scene_file().ok_or("has no scene")?,
            reference: reference(task, &technique),
            technique,
            view: View { size: [width as usize, height as usize], pixel: Pixel::Area, skip: true },
            camera: settings.as_ref().map(camera).transpose()?,
            output: match task.block.kind {
                Kind::Still => Output::Still,
                Kind::Animation => Output::Animation,
            },
        })
    }
}

fn lines(problems: Vec<Problem>) -> String {
    problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}

/// What a stimulus is measured against: the study's own Monte-Carlo condition, the one with the most samples; Monte-Carlo
/// images themselves carry their standard error.
fn reference(task: &Task<'_>, technique: &Technique) -> Option<Technique> {
    if matches!(technique, Technique::Mc(_)) {
        return None;
    }
    let conditions = task.study.conditions.values().filter_map(|condition| match condition {
        Condition::Rendered { technique: name, knobs, .. } if name == "mc" => {
            self::technique(name, knobs).ok()
        }
        _ => None,
    });
    let spp = |technique: &Technique| if let Technique::Mc(knobs) = technique { knobs.spp } else { 0 };
    conditions.max_by_key(spp).or_else(|| self::technique("mc", &BTreeMap::new()).ok())
}
