//! What earlier starts learnt of scenes: reading one rasterises its puppets, and what it is follows from its files alone.

use kelir_store::private_file;
use kelir_study::Problem;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What a study needs to know of a scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct SceneFacts {
    /// Hash over its values and files.
    pub(crate) sha256: String,
    /// Whether it has a timeline.
    pub(crate) moves: bool,
    /// What may be a mistake in it.
    pub(crate) warnings: Vec<Problem>,
}

/// A scene with the files that it was read from, by path and hash.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Known {
    pub(crate) files: BTreeMap<String, String>,
    pub(crate) facts: SceneFacts,
}

/// Scenes by path, as one build of the program reads them; another build reads them anew.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Remembered {
    program: String,
    scenes: BTreeMap<String, Known>,
}

impl Remembered {
    /// What is remembered in a data folder; nothing where that cannot be read.
    pub(crate) fn load(folder: &Path) -> Remembered {
        let text = std::fs::read(path(folder)).unwrap_or_default();
        let remembered: Remembered = serde_json::from_slice(&text).unwrap_or_default();
        let program = program();
        if remembered.program == program {
            remembered
        } else {
            Remembered { program, scenes: BTreeMap::new() }
        }
    }

    /// What is known of a scene, if its files are still those; `hash` is a file's, as it is now.
    pub(crate) fn facts(&self, scene: &str, hash: impl Fn(&str) -> Option<String>) -> Option<SceneFacts> {
        let known = self.scenes.get(scene)?;
        let same = |(path, was): (&String, &String)| hash(path).as_ref() == Some(was);
        (!known.files.is_empty() && known.files.iter().all(same)).then(|| known.facts.clone())
    }

    /// Keeps what was learnt. It is a memory and no data: where it cannot be written, the next start reads the scenes again.
    pub(crate) fn keep(&mut self, folder: &Path, scene: &str, known: Known) {
        self.scenes.insert(scene.to_owned(), known);
        let (path, part) = (path(folder), folder.join(".scenes.json.part"));
        let text = serde_json::to_vec_pretty(self).unwrap_or_default();
        let file = private_file().truncate(true).open(&part);
        let written = file.and_then(|mut file| file.write_all(&text));
        if let Err(error) = written.and_then(|()| std::fs::rename(&part, &path)) {
            tracing::debug!("{}: {error}", path.display());
        }
    }
}

fn path(folder: &Path) -> PathBuf {
    folder.join("scenes.json")
}

/// This build, by its file: another one may read scenes otherwise.
fn program() -> String {
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let made = file.and_then(|file| Ok((file.len(), file.modified()?)));
    let made =
        made.map(|(bytes, modified)| format!("{bytes} {:?}", modified.duration_since(std::time::UNIX_EPOCH)));
    format!("{} {}", env!("CARGO_PKG_VERSION"), made.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

    use super::*;

    #[test]
    fn a_scene_is_remembered_while_its_files_are_the_same() {
        let dir = tempfile::tempdir().unwrap();
        let warnings =
            vec![Problem::new("a.toml", "puppets[0].image", None, "is this a scan without alpha?")];
        let facts = SceneFacts { sha256: "5".repeat(64), moves: true, warnings };
        let files =
            BTreeMap::from([("a.toml", "1"), ("p.svg", "2")].map(|(k, v)| (k.to_owned(), v.to_owned())));
        Remembered::load(dir.path()).keep(dir.path(), "a.toml", Known { files, facts: facts.clone() });
        let remembered = Remembered::load(dir.path());
        let with = |puppet: Option<&str>| {
            remembered.facts("a.toml", |path| {
                if path == "a.toml" { Some("1".to_owned()) } else { puppet.map(str::to_owned) }
            })
        };
        assert_eq!(with(Some("2")), Some(facts));
        assert_eq!((with(Some("3")), with(None)), (None, None));
        assert_eq!(remembered.facts("b.toml", |_| None), None);
        // Another build, and a memory that is damaged.
        let text = std::fs::read_to_string(path(dir.path())).unwrap();
        std::fs::write(path(dir.path()), text.replace("\"program\": \"", "\"program\": \"x")).unwrap();
        assert!(Remembered::load(dir.path()).scenes.is_empty());
        std::fs::write(path(dir.path()), "{").unwrap();
        assert!(Remembered::load(dir.path()).scenes.is_empty());
        // One that was written before warnings were kept knows nothing of them.
        let before = text.replace("\"warnings\"", "\"other\"");
        assert!(before != text);
        std::fs::write(path(dir.path()), before).unwrap();
        assert!(Remembered::load(dir.path()).scenes.is_empty());
    }
}
