//! What a job's stimulus is known by: a hash over all that decides its bytes.

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::Job;
use crate::subject::Staged;
use crate::{Backend, RenderError, Technique, renderer};
use kelir_jcs::{canonical, exact};

/// The first line of what is hashed; another contract has another.
const CONTRACT: &str = "kelir-job/2\n";

/// The revisions that stand in a key.
struct Revisions {
    shared: u32,
    of: fn(&Technique) -> u32,
}

const NOW: Revisions = Revisions { shared: crate::REVISION, of: Technique::revision };

impl<S: Staged> Job<S> {
    /// SHA-256 of the preimage, hexadecimal: what is drawn once for it need not be drawn again. Errors: as [`Job::preimage_for`].
    pub fn key(&self) -> Result<String, RenderError> {
        Ok(hex::encode(Sha256::digest(self.preimage_for(self.scene.sha256())?)))
    }
}

impl<S> Job<S> {
    /// What the key is the SHA-256 of, for a scene of this hash (`Scene::sha256`), read or not: a line that names the contract, then
    /// RFC 8785's JSON of all that decides the bytes. Knobs are written with their defaults; whether work is skipped changes no byte and
    /// isn't there. Errors: as [`Job::check`]; no adapter for a backend that must have one.
    pub fn preimage_for(&self, scene_sha256: &str) -> Result<String, RenderError> {
        self.check()?;
        let class = match self.backend {
            Backend::Cpu => "cpu".to_owned(),
            backend => renderer(&self.technique, backend)?.class(),
        };
        self.preimage(scene_sha256, &class, &NOW)
    }

    fn preimage(&self, scene: &str, class: &str, revisions: &Revisions) -> Result<String, RenderError> {
        let mut preimage = drawn_by(&self.technique, revisions)?;
        let reference =
            self.reference.as_ref().map(|reference| drawn_by(reference, revisions)).transpose()?;
        for (member, value) in [
            ("scene", json!(scene)),
            ("time_s", exact(&self.time_s)?),
            ("shared_revision", json!(revisions.shared)),
            ("size", json!(self.view.size)),
            ("pixel", json!(self.view.pixel)),
            ("camera", exact(&self.camera)?),
            ("exposure", json!(self.exposure)),
            ("output", json!(self.output)),
            ("reference", json!(reference)),
            ("backend", json!(class)),
        ] {
            preimage[member] = value;
        }
        Ok(format!("{CONTRACT}{}", canonical(preimage)?))
    }
}

/// A technique's name, revision and knobs.
fn drawn_by(technique: &Technique, revisions: &Revisions) -> Result<Value, RenderError> {
    let mut knobs = exact(technique)?;
    if let Value::Object(members) = &mut knobs {
        members.remove("technique");
    }
    Ok(json!({ "technique": technique.name(), "revision": (revisions.of)(technique), "knobs": knobs }))
}

#[cfg(test)]
mod tests;
