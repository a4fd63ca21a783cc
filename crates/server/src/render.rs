//! The narrow door to the renderer: a scene, a technique and an output in, a stimulus out.

use crate::library::Library;
use crate::making::{Made, Maker, Task};
use kelir_render::Technique;
use serde_json::Value;
use std::collections::BTreeMap;

/// Makes stimuli with kelir's renderer, in this process.
#[derive(Clone, Copy, Debug, Default)]
pub struct RenderMaker {}

/// A condition's technique with its knobs; what is wrong with them.
pub(crate) fn technique(name: &str, knobs: &BTreeMap<String, Value>) -> Result<Technique, String> {
    let mut object: serde_json::Map<String, Value> = knobs.clone().into_iter().collect();
    object.insert("technique".to_owned(), Value::from(name));
    serde_json::from_value(Value::Object(object)).map_err(|error| error.to_string())
}

/// What is wrong with a camera's settings.
pub(crate) fn camera(_settings: &BTreeMap<String, Value>) -> Result<(), String> {
    Ok(())
}

impl Maker for RenderMaker {
    fn identity(&self, _task: &Task<'_>, _library: &Library) -> Result<String, String> {
        Err("the renderer is not joined yet".to_owned())
    }

    fn make(&self, _: &Task<'_>, _: &Library, _: &mut dyn FnMut(f64, &str)) -> Result<Made, String> {
        Err("the renderer is not joined yet".to_owned())
    }
}
