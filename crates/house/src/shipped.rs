//! What ships inside the binary, by name: no checkout is needed for it.

use crate::library::{BuiltIn, Library};
use kelir_reader::did_you_mean;
use kelir_scene::{AnyScene, Problems, Scene};
use std::path::Path;

/// Kinds of files that ship, each a folder of TOML files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shipped {
    /// Scenes.
    Scene,
    /// Studies.
    Study,
    /// Designs of studies, for their power.
    Design,
}

impl Shipped {
    fn folder(self) -> &'static str {
        match self {
            Shipped::Scene => "scenes/",
            Shipped::Study => "studies/",
            Shipped::Design => "studies/designs/",
        }
    }

    fn word(self) -> &'static str {
        match self {
            Shipped::Scene => "scene",
            Shipped::Study => "study",
            Shipped::Design => "design",
        }
    }

    /// The names, sorted.
    pub fn names(self) -> Vec<String> {
        let mut names: Vec<String> = BuiltIn::iter()
            .filter_map(|path| Some(path.strip_prefix(self.folder())?.strip_suffix(".toml")?.to_owned()))
            .filter(|name| !name.contains('/'))
            .collect();
        names.sort();
        names
    }

    /// Path of `name` in the built-in library.
    ///
    /// # Errors
    /// Nothing of this kind has that name; says what has, and that files are named otherwise.
    pub fn path(self, name: &str) -> Result<String, String> {
        let names = self.names();
        if names.iter().any(|known| known == name) {
            return Ok(format!("{}{name}.toml", self.folder()));
        }
        let (word, hint, known) = (self.word(), did_you_mean(name, &names), names.join(", "));
        Err(format!(
            "{name}: no {word} of this name ships{hint}; there are {known}; a file's path has a / in it or ends in .toml"
        ))
    }

    /// The text of a built-in file, by its path in the library.
    pub fn text(path: &str) -> Option<String> {
        BuiltIn::get(path).and_then(|file| String::from_utf8(file.data.into_owned()).ok())
    }
}

/// Whether an argument means a file, and not what ships under that name.
pub fn is_file(argument: &Path) -> bool {
    let text = argument.to_string_lossy();
    text.contains(['/', std::path::MAIN_SEPARATOR]) || text.to_ascii_lowercase().ends_with(".toml")
}

/// Reads a scene of a theatre: a file, or one that ships by its name.
///
/// # Errors
/// Everything that is wrong with it, that it is a stage too; a name that nothing has.
pub fn scene(argument: &Path) -> Result<Scene, SceneRefused> {
    if is_file(argument) {
        return Ok(Scene::from_path(argument)?);
    }
    let (path, text) = shipped(argument)?;
    Ok(Scene::parse(&path, &text, &Library::built_in())?)
}

/// Reads a scene, whatever it shows: a file, or one that ships by its name.
///
/// # Errors
/// Everything that is wrong with it; a name that nothing has.
pub fn any_scene(argument: &Path) -> Result<AnyScene, SceneRefused> {
    if is_file(argument) {
        return Ok(AnyScene::from_path(argument)?);
    }
    let (path, text) = shipped(argument)?;
    Ok(AnyScene::parse(&path, &text, &Library::built_in())?)
}

/// Path and text of a scene that ships.
fn shipped(argument: &Path) -> Result<(String, String), SceneRefused> {
    let path = Shipped::Scene.path(&argument.to_string_lossy()).map_err(SceneRefused::Unknown)?;
    let text = Shipped::text(&path).unwrap_or_default();
    Ok((path, text))
}

/// Why there is no such scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneRefused {
    /// Nothing that ships has this name.
    #[error("{0}")]
    Unknown(String),
    /// What is wrong with it.
    #[error(transparent)]
    Wrong(#[from] Problems),
}
