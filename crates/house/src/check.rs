//! Whether a study can be served: all that it names is opened, and each picture is tried in a small size.

use crate::library::{Library, beside};
use crate::task::{Task, tasks};
use crate::{picture, render};
use kelir_render::RenderError;
use kelir_study::{Block, Condition, Item, Kind, Problem, Problems, StudyDefinition};
use std::collections::{BTreeMap, BTreeSet};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Why a study file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StudyFileError {
    /// Everything that is wrong with it, its scenes, conditions and pictures included.
    #[error("{0}")]
    Invalid(#[from] Problems),
    /// It cannot be read.
    #[error("{path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl Library {
    /// Reads and checks the study file at `path`, with its scenes, its conditions' settings and its pictures.
    ///
    /// # Errors
    /// It cannot be read, or everything that is wrong with it.
    pub fn study(&self, path: &str) -> Result<StudyDefinition, StudyFileError> {
        self.checked(path, false)
    }

    /// As [`Library::study`], and tries each picture in a small size: what this calls good can be made.
    ///
    /// # Errors
    /// It cannot be read, or everything that is wrong with it.
    pub fn rehearsed(&self, path: &str) -> Result<StudyDefinition, StudyFileError> {
        self.checked(path, true)
    }

    /// What may be a mistake in a study that is good: in its file, and in the pictures and scenes that it names.
    pub fn warnings(&self, path: &str, study: &StudyDefinition) -> Vec<Problem> {
        [study.warnings(path), doubts_around(self, path, study)].concat()
    }

    fn checked(&self, path: &str, thorough: bool) -> Result<StudyDefinition, StudyFileError> {
        let unreadable = |source| StudyFileError::Unreadable { path: PathBuf::from(path), source };
        let bytes = self.read(path).map_err(unreadable)?;
        let text = String::from_utf8(bytes)
            .map_err(|_| unreadable(io::Error::new(ErrorKind::InvalidData, "the file is no UTF-8 text")))?;
        let (study, mut problems) = StudyDefinition::parse_as_far(path, &text);
        if let Some(study) = &study {
            problems.extend(problems_around(self, path, study));
            if thorough && study.size != [0, 0] {
                problems.extend(problems_drawing(self, path, study));
            }
        }
        match study {
            Some(study) if problems.is_empty() => Ok(study),
            _ => Err(Problems::new(problems).into()),
        }
    }
}

/// The library of any study file and its path there, for [`Library::rehearsed`]. What it names is looked for below the parent of its folder when that
/// is called `studies`, else below the folder itself, and then among the built-in files.
///
/// # Errors
/// There is no such file.
pub fn library_of(file: &Path) -> Result<(Library, String), StudyFileError> {
    let unreadable = |source| StudyFileError::Unreadable { path: file.to_owned(), source };
    let whole = file.canonicalize().map_err(unreadable)?;
    let parts = (whole.parent(), whole.file_name().and_then(|name| name.to_str()));
    let (Some(folder), Some(name)) = parts else {
        return Err(unreadable(io::Error::new(ErrorKind::InvalidInput, "is no file with a readable name")));
    };
    Ok(match folder.parent() {
        Some(root) if folder.file_name().is_some_and(|name| name == "studies") => {
            (Library::new(root), format!("studies/{name}"))
        }
        _ => (Library::new(folder), name.to_owned()),
    })
}

/// Problems as they are found, each said once.
struct Found<'a> {
    file: &'a str,
    problems: Vec<Problem>,
}

impl Found<'_> {
    fn add(&mut self, field: String, value: Option<&str>, rule: impl Into<String>) {
        let value = value.map(|v| format!("{v:?}"));
        let problem = Problem::new(self.file, field, value, rule);
        if !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }
}

/// What is wrong with what a study names: conditions' settings, picture files, scenes.
fn problems_around(library: &Library, file: &str, study: &StudyDefinition) -> Vec<Problem> {
    let mut found = Found { file, problems: Vec::new() };
    for (name, condition) in &study.conditions {
        let field = format!("conditions.{name}");
        match condition {
            Condition::Rendered { technique, knobs, camera } => {
                if let Err(rule) = render::technique(technique, knobs) {
                    found.add(field.clone(), None, rule);
                }
                // What is right at the smallest size and at the largest is right between.
                let wrong =
                    |settings| widths(study).into_iter().find_map(|m| render::camera(settings, m).err());
                if let Some(rule) = camera.as_ref().and_then(wrong) {
                    found.add(format!("{field}.camera"), None, rule);
                }
            }
            Condition::Files { files } => {
                for (item, pictures) in files {
                    for (rank, (path, size)) in pictures.paths().iter().zip(study.sizes()).enumerate() {
                        let rules = match library.read(&beside(file, path)) {
                            Ok(bytes) => picture::broken(path, &bytes, *size),
                            Err(error) => vec![error.to_string()],
                        };
                        let place =
                            if pictures.paths().len() > 1 { format!("[{rank}]") } else { String::new() };
                        let field = format!("{field}.files.{item}{place}");
                        rules.into_iter().for_each(|rule| found.add(field.clone(), Some(path), rule));
                    }
                }
            }
        }
    }
    let (mut wrong, mut refused) = (Vec::new(), BTreeSet::new());
    for (block, item, field) in items(study) {
        let Some(named) = &item.scene else { continue };
        let path = beside(file, named);
        match library.scene_facts(&path) {
            Ok(facts) if !facts.moves && block.kind == Kind::Animation => {
                found.add(
                    format!("{field}.scene"),
                    Some(named),
                    "has no [timeline]; the block shows animations",
                );
            }
            Ok(_) => {}
            // Its problems are told once, however many items show it.
            Err(problems) if refused.insert(path.clone()) => wrong.extend(problems),
            Err(_) => {}
        }
    }
    found.problems.extend(wrong);
    found.problems
}

/// What picture files ask that nobody will do, so that participants see them otherwise than their maker may; and what may be a mistake in a scene, told
/// of the first item that shows it.
fn doubts_around(library: &Library, file: &str, study: &StudyDefinition) -> Vec<Problem> {
    let mut found = Found { file, problems: Vec::new() };
    for (name, condition) in &study.conditions {
        let Condition::Files { files } = condition else { continue };
        for (item, path) in
            files.iter().flat_map(|(item, of)| of.paths().iter().map(move |path| (item, path)))
        {
            let unheeded = library.read(&beside(file, path)).map(|bytes| picture::unheeded(&bytes));
            for rule in unheeded.unwrap_or_default() {
                found.add(format!("conditions.{name}.files.{item}"), Some(path), rule);
            }
        }
    }
    let mut told = BTreeSet::new();
    for (_, item, field) in items(study) {
        let Some(named) = &item.scene else { continue };
        let path = beside(file, named);
        if !told.insert(path.clone()) {
            continue;
        }
        for warning in library.scene_facts(&path).map(|facts| facts.warnings).unwrap_or_default() {
            found.add(format!("{field}.scene"), Some(named), warning.to_string());
        }
    }
    found.problems
}

/// What keeps pictures from being drawn, found by drawing each in a small size. What [`problems_around`] finds is not said again.
fn problems_drawing(library: &Library, file: &str, study: &StudyDefinition) -> Vec<Problem> {
    let mut found = Found { file, problems: Vec::new() };
    let fields: BTreeMap<&str, String> =
        items(study).map(|(_, item, field)| (item.id.as_str(), field)).collect();
    // Reading a scene takes longer than drawing it small: each is read once.
    let mut by_scene: BTreeMap<String, Vec<Task<'_>>> = BTreeMap::new();
    for task in tasks(study) {
        if let (Condition::Rendered { .. }, Some(named)) = (task.condition, &task.pair.scene) {
            by_scene.entry(beside(file, named)).or_default().push(task);
        }
    }
    for (path, tasks) in by_scene {
        let Ok(mut scene) = library.scene(&path) else { continue };
        for task in tasks {
            let drawn;
            (scene, drawn) = render::rehearse(&task, scene);
            match drawn {
                Ok(()) => {}
                // Sizes are the study's: told once for all scenes of one screen.
                Err(RenderError::View(rule)) => {
                    let parts = rule.strip_prefix("size = ").and_then(|rule| rule.split_once(": "));
                    let (value, rule) =
                        parts.map_or((None, rule.as_str()), |(value, rule)| (Some(value), rule));
                    let field = if study.sizes().len() > 1 { "display.sizes" } else { "size" };
                    found.add(field.to_owned(), value, rule);
                }
                Err(error) => {
                    let field = fields.get(task.pair.id.as_str()).cloned().unwrap_or_default();
                    found.add(
                        field,
                        Some(&task.pair.id),
                        format!("cannot be drawn under condition {}: {error}", task.name),
                    );
                }
            }
        }
    }
    found.problems
}

/// How many times as wide as the smallest size the smallest and the largest are.
fn widths(study: &StudyDefinition) -> [f64; 2] {
    let [smallest, largest] =
        [study.sizes().first(), study.sizes().last()].map(|size| size.map_or(1, |size| size[0].max(1)));
    [1.0, f64::from(largest) / f64::from(smallest)]
}

/// Every item with its block and the path of its field.
fn items(study: &StudyDefinition) -> impl Iterator<Item = (&Block, &Item, String)> {
    study.blocks.iter().enumerate().flat_map(|(i, block)| {
        let field = move |j: usize| format!("blocks[{i}].{}[{j}]", block.items_key);
        block.items.iter().enumerate().map(move |(j, item)| (block, item, field(j)))
    })
}
