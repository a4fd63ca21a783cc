//! `kelir study check FILE…`

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_server::results;

use super::stats::Format;
use super::stored::{block_on, results_error};

use crate::BadInput;
use crate::output::{csv, print, table};

/// Subcommands of `kelir study`.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Validate study files and the scenes they name: every problem is named by file, field, value and rule.
    Check {
        /// Study files (TOML).
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// List the versions of a study that were served from a data folder, with what each has gathered.
    Versions {
        /// Id of the study, as in its address.
        study: String,
        /// The server's data folder; it may be running.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        #[arg(long, value_enum, default_value = "table")]
        format: Format,
    },
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Check { files } => check(files),
        Command::Versions { study, data, format } => versions(&study, &data, format),
    }
}

fn versions(study: &str, data: &Path, format: Format) -> Result<()> {
    let versions = block_on(async {
        let store = results::open_study(data, study).await.map_err(results_error)?;
        let versions = results::versions(&store, study, None).await;
        store.close().await;
        Ok(versions?)
    })?;
    let header = [
        "version",
        "design",
        "first served",
        "last served",
        "started",
        "in progress",
        "finished",
        "answers",
        "current",
    ];
    let whole = matches!(format, Format::Csv);
    let rows: Vec<Vec<String>> = versions
        .iter()
        .map(|v| {
            let hash = |hash: &str| if whole { hash.to_owned() } else { hash[..12].to_owned() };
            let people = &v.participants;
            vec![
                hash(&v.version),
                hash(&v.design_hash),
                v.first_served_at.clone(),
                v.last_served_at.clone(),
                people.started.to_string(),
                people.in_progress.to_string(),
                people.completed.to_string(),
                v.answers.to_string(),
                if v.is_current { "yes" } else { "" }.to_owned(),
            ]
        })
        .collect();
    match format {
        Format::Json => print(&serde_json::to_string_pretty(&versions)?),
        Format::Csv => print(&csv(&header, &rows)),
        Format::Table => print(&table(&header, &rows)),
    }
}

fn check(files: Vec<PathBuf>) -> Result<()> {
    let mut problems = Vec::new();
    for file in files {
        match kelir_server::check_study(&file) {
            Ok(study) => {
                let most = if study.blocks.iter().any(|b| b.adaptive.is_some()) { "at most " } else { "" };
                let (blocks, trials) = (study.blocks.len(), study.most_trials());
                print(&format!("{}: good (blocks: {blocks}, trials: {most}{trials})", file.display()))?;
            }
            Err(errors) => problems.push(errors.to_string()),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(BadInput(problems.join("\n")).into()) }
}
