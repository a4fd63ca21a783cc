//! `kelir scene check FILE…`

use std::path::PathBuf;

use anyhow::Result;
use kelir_scene::Scene;

use crate::BadInput;
use crate::output::print;

/// Subcommands of `kelir scene`.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Validate scene files: every problem is named by file, field, value and rule.
    Check {
        /// Scene files (TOML).
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    let Command::Check { files } = command;
    let mut problems = Vec::new();
    for file in files {
        match Scene::from_path(&file) {
            Ok(scene) => print(&format!("{}: good ({})", file.display(), describe(&scene)))?,
            Err(errors) => problems.push(errors.to_string()),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(BadInput(problems.join("\n")).into()) }
}

fn describe(scene: &Scene) -> String {
    let theatre = scene.still();
    let frames =
        scene.timeline().map_or_else(String::new, |timeline| format!(", {} frames", timeline.frame_count()));
    format!("{} puppets, {} emitters{frames}", theatre.planes.len(), theatre.lamp.emitters.len())
}
