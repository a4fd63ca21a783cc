//! `kelir scene`: checking scene files, listing those that ship.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_house::shipped::{self, SceneRefused, Shipped};
use kelir_scene::Scene;
use serde::Serialize;
use serde_json::json;

use super::checked::Checked;
use crate::bad_input;
use crate::output::{print, print_json, table};

/// Subcommands of `kelir scene`.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
    /// Validate scene files: every problem is named by file, field, value and rule.
    Check {
        /// Scene files (TOML), or names of scenes that ship.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// List the scenes that ship: any of them may be drawn by its name.
    List {
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::Check { files, json } => check(&files, json),
        Command::List { json } => list(json),
    }
}

fn check(files: &[PathBuf], json: bool) -> Result<()> {
    let mut checked = Checked::new(json);
    for file in files {
        match shipped::scene(file) {
            Ok(scene) => checked.good(
                file,
                &describe(&scene),
                json!(Described::of(&name(file), "", &scene)),
                scene.warnings(),
            )?,
            Err(SceneRefused::Unknown(rule)) => checked.unreadable(file, rule),
            Err(SceneRefused::Wrong(errors)) => {
                checked.wrong(file, &errors);
            }
        }
    }
    checked.finish()
}

fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn describe(scene: &Scene) -> String {
    let theatre = scene.still();
    let frames =
        scene.timeline().map_or_else(String::new, |timeline| format!(", {} frames", timeline.frame_count()));
    format!("{} puppets, {} emitters{frames}", theatre.planes.len(), theatre.lamp.emitters.len())
}

/// A scene in a list.
#[derive(Serialize)]
struct Described {
    name: String,
    /// What it shows: the comment that its file begins with.
    #[serde(skip_serializing_if = "String::is_empty")]
    shows: String,
    /// The cloth, [width, height] in metres.
    screen_m: [f64; 2],
    puppets: usize,
    /// Names of the lamp's emitters.
    emitters: Vec<String>,
    /// Frames of its timeline; null for a scene that stands still.
    frames: Option<usize>,
    fps: Option<f64>,
}

impl Described {
    fn of(name: &str, shows: &str, scene: &Scene) -> Described {
        let still = scene.still();
        Described {
            name: name.to_owned(),
            shows: shows.to_owned(),
            screen_m: [still.screen.width_m, still.screen.height_m],
            puppets: still.planes.len(),
            emitters: still.lamp.emitters.iter().map(|emitter| emitter.name.clone()).collect(),
            frames: scene.timeline().map(|timeline| timeline.frame_count()),
            fps: scene.timeline().map(|timeline| timeline.fps),
        }
    }

    fn line(&self) -> Vec<String> {
        let film = self.frames.zip(self.fps).map(|(frames, fps)| format!("{frames} at {fps} Hz"));
        vec![
            self.name.clone(),
            format!("{} × {} m", self.screen_m[0], self.screen_m[1]),
            self.emitters.join(", "),
            self.puppets.to_string(),
            film.unwrap_or_default(),
            self.shows.clone(),
        ]
    }
}

fn list(json: bool) -> Result<()> {
    let mut scenes = Vec::new();
    for name in Shipped::Scene.names() {
        let text = Shipped::text(&Shipped::Scene.path(&name).map_err(bad_input)?).unwrap_or_default();
        let scene = shipped::scene(Path::new(&name)).map_err(bad_input)?;
        scenes.push(Described::of(&name, &first_comment(&text), &scene));
    }
    if json {
        return print_json(&scenes);
    }
    let lines: Vec<_> = scenes.iter().map(Described::line).collect();
    print(&table(&["name", "cloth", "lamp", "puppets", "frames", "shows"], &lines))
}

/// The first sentence of the comment that a file begins with.
fn first_comment(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix('#')).map(str::trim);
    let comment = lines.collect::<Vec<_>>().join(" ");
    comment.split_once(". ").map_or(comment.clone(), |(first, _)| format!("{first}."))
}
