//! `kelir scene`: checking scene files, listing those that ship.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_house::shipped::{self, SceneRefused, Shipped};
use kelir_render::file;
use kelir_scene::stage::StageScene;
use kelir_scene::{AnyScene, Mending, Scene, Timeline};
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
        /// Write the drawing of the one scene file that is refused or warned about, mended so that it is accepted and looks the same, and say what was
        /// changed; nothing is written where that can't be done.
        #[arg(long, value_name = "OUT.svg", conflicts_with = "json")]
        fix_drawing: Option<PathBuf>,
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
        Command::Check { files, fix_drawing: Some(out), .. } => fix_drawing(&files, &out),
        Command::Check { files, json, .. } => check(&files, json),
        Command::List { json } => list(json),
    }
}

fn check(files: &[PathBuf], json: bool) -> Result<()> {
    let mut checked = Checked::new(json);
    for file in files {
        match shipped::any_scene(file) {
            Ok(scene) => checked.good(
                file,
                &describe(&scene),
                match &scene {
                    AnyScene::Theatre(scene) => json!(Described::of(&name(file), "", scene)),
                    AnyScene::Stage(scene) => json!(DescribedStage::of(&name(file), scene)),
                },
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

/// Mends the one drawing of a scene that needs it.
fn fix_drawing(files: &[PathBuf], out: &Path) -> Result<()> {
    let [scene] = files else {
        return Err(bad_input("--fix-drawing mends a drawing of one scene file: name one"));
    };
    if !shipped::is_file(scene) {
        return Err(bad_input(format!(
            "{} ships, and its drawings are good: name a scene file",
            scene.display()
        )));
    }
    let mut mendings = kelir_scene::mend(scene).map_err(bad_input)?;
    let Some(Mending { drawing, result }) = mendings.pop() else {
        return print(&format!("{}: no drawing needs mending; nothing is written", scene.display()));
    };
    if !mendings.is_empty() {
        let all: Vec<String> =
            mendings.iter().map(|m| &m.drawing).chain([&drawing]).map(|d| d.display().to_string()).collect();
        return Err(bad_input(format!("{} need mending: check scenes of one of them each", all.join(", "))));
    }
    let label = drawing.display();
    let mended = result.map_err(|wrong| {
        let wrong: Vec<String> = wrong.iter().map(|rule| format!("{label}: {rule}")).collect();
        bad_input(format!(
            "{}\nthis can't be mended without changing what is seen; nothing is written",
            wrong.join("\n")
        ))
    })?;
    let same = |a: &Path, b: &Path| a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
    if same(out, &drawing) {
        return Err(bad_input(format!(
            "{} is the drawing itself, which is kept: name another file",
            out.display()
        )));
    }
    file::write_atomic(out, mended.svg.as_bytes())?;
    print(&format!("{}: {label}, mended:", out.display()))?;
    mended.changes.iter().try_for_each(|change| print(&format!("  {change}")))
}

fn name(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn describe(scene: &AnyScene) -> String {
    let frames = |timeline: Option<&Timeline>| {
        timeline.map_or_else(String::new, |timeline| format!(", {} frames", timeline.frame_count()))
    };
    match scene {
        AnyScene::Theatre(scene) => {
            let (theatre, frames) = (scene.still(), frames(scene.timeline()));
            format!("{} puppets, {} emitters{frames}", theatre.planes.len(), theatre.lamp.emitters.len())
        }
        AnyScene::Stage(scene) => {
            let (stage, frames) = (scene.still(), frames(scene.timeline()));
            let (objects, lights) = (stage.objects.len(), stage.lights.len());
            format!("{objects} objects of {} triangles, {lights} lights{frames}", stage.triangles())
        }
    }
}

/// A stage, as `check` tells it.
#[derive(Serialize)]
struct DescribedStage {
    name: String,
    objects: Vec<String>,
    /// Of all meshes, those that cast shadows alone too.
    triangles: usize,
    lights: Vec<String>,
    /// Frames of its timeline; null for a scene that stands still.
    frames: Option<usize>,
    fps: Option<f64>,
}

impl DescribedStage {
    fn of(name: &str, scene: &StageScene) -> Self {
        let stage = scene.still();
        Self {
            name: name.to_owned(),
            triangles: stage.triangles(),
            objects: stage.objects.into_iter().map(|object| object.name).collect(),
            lights: stage.lights.into_iter().map(|light| light.name).collect(),
            frames: scene.timeline().map(Timeline::frame_count),
            fps: scene.timeline().map(|timeline| timeline.fps),
        }
    }
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
