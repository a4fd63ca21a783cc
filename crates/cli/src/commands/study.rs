//! `kelir study check FILE…`

use std::path::PathBuf;

use anyhow::Result;

use crate::BadInput;
use crate::output::print;

/// Subcommands of `kelir study`.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Validate study files and the scenes they name: every problem is named by file, field, value and rule.
    Check {
        /// Study files (TOML).
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    let Command::Check { files } = command;
    let mut problems = Vec::new();
    for file in files {
        match kelir_server::check_study(&file) {
            Ok(study) => {
                let trials: usize = study.blocks.iter().map(|block| block.items.len()).sum();
                print(&format!("{}: good ({} blocks, {trials} trials)", file.display(), study.blocks.len()))?;
            }
            Err(errors) => problems.push(errors.to_string()),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(BadInput(problems.join("\n")).into()) }
}
