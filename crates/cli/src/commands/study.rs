//! `kelir study`: checking study files, listing what was served.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_server::links::{Links, Visit, now};
use kelir_server::shipped::{Shipped, is_file};
use kelir_server::{HEAVY_BYTES, Library, StudyFileError, Weight, library_of, results};
use serde_json::json;

use super::checked::{Checked, problem_json};
use super::stored::{block_on, results_error};
use crate::bad_input;
use crate::output::{Format, Printed, csv, print, print_json, table};

/// Subcommands of `kelir study`.
#[derive(clap::Subcommand)]
pub enum Command {
    /// Do all that serving will do, small: open each scene and picture, draw each stimulus, fill in each placeholder. Every problem is named by
    /// file, field, value and rule.
    Check {
        /// Study files (TOML), or names of studies that ship.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// Make a signed link by which who has it tries a study, as the console's buttons do.
    Link {
        /// Id of the study, as in its address.
        study: String,
        /// What it is for.
        #[arg(long, value_enum, default_value = "pilot")]
        kind: LinkKind,
        /// For how many days it is good.
        #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=90))]
        days: u32,
        /// The server's data folder; it may be running.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        /// The server's address, as people see it.
        #[arg(long, default_value = "http://127.0.0.1:8080")]
        base: String,
        /// Print one JSON document.
        #[arg(long)]
        json: bool,
    },
    /// List the versions of a study that were served from a data folder, with what each has gathered.
    Versions {
        /// Id of the study, as in its address.
        study: String,
        /// The server's data folder; it may be running.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        #[command(flatten)]
        printed: Printed,
    },
}

/// What a link is for.
#[derive(Clone, Copy, clap::ValueEnum)]
pub enum LinkKind {
    /// Stored, counted apart, left out of every analysis.
    Pilot,
    /// Nothing is stored.
    Preview,
}

/// Runs the command.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Check { files, json } => check(&files, json),
        Command::Link { study, kind, days, data, base, json } => {
            let (path, expires_at_s) = link(&study, kind, days, &data)?;
            let url = format!("{}{path}", base.trim_end_matches('/'));
            if json { print_json(&json!({ "url": url, "expires_at_s": expires_at_s })) } else { print(&url) }
        }
        Command::Versions { study, data, printed } => versions(&study, &data, printed.form()),
    }
}

/// Path of a link and when it ends, seconds since 1970.
fn link(study: &str, kind: LinkKind, days: u32, data: &Path) -> Result<(String, u64)> {
    if !data.is_dir() {
        return Err(bad_input(format!("data = {}: there is no such folder", data.display())));
    }
    let files = Library::new(data).study_files();
    let ids: Vec<&str> =
        files.iter().filter_map(|path| path.strip_prefix("studies/")?.strip_suffix(".toml")).collect();
    if !ids.contains(&study) {
        return Err(bad_input(format!("study = {study}: must be one of {}", ids.join(", "))));
    }
    let visit = match kind {
        LinkKind::Pilot => Visit::Pilot,
        LinkKind::Preview => Visit::Preview,
    };
    let expires = now() + 86_400 * u64::from(days);
    Ok((Links::open(data)?.link(study, visit, expires), expires))
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
        Format::Json => print_json(&versions),
        Format::Csv => print(&csv(&header, &rows)),
        Format::Table => print(&table(&header, &rows)),
    }
}

fn weight_json(weight: &Weight) -> serde_json::Value {
    let Weight { block, size, bytes, is_exact } = weight;
    json!({ "block": block, "size": size, "bytes": bytes, "is_exact": is_exact })
}

/// What a participant downloads, block by block and in all, at each size; what is heavy is said.
fn weights_text(weights: &[Weight], sizes: &[[u32; 2]]) -> String {
    let megabytes = |bytes: u64, is_exact: bool| {
        format!("{}{:.2} MB", if is_exact { "" } else { "about " }, bytes as f64 / 1e6)
    };
    let mut lines = Vec::new();
    for size @ [width, height] in sizes {
        let of_size: Vec<&Weight> = weights.iter().filter(|weight| weight.size == *size).collect();
        let all = of_size.iter().map(|weight| weight.bytes).sum();
        let blocks: Vec<String> =
            of_size.iter().map(|w| format!("{} {}", w.block, megabytes(w.bytes, w.is_exact))).collect();
        let is_exact = of_size.iter().all(|weight| weight.is_exact);
        lines.push(format!(
            "  a participant downloads at {width} × {height}: {} ({})",
            megabytes(all, is_exact),
            blocks.join(", ")
        ));
        if all > HEAVY_BYTES {
            lines.push(format!(
                "  that is heavy: above {} a slow line (1.6 Mbit/s) takes more than half a minute; fewer or shorter animations, or a smaller size, weigh less",
                megabytes(HEAVY_BYTES, true)
            ));
        }
    }
    lines.join("\n")
}

fn check(files: &[PathBuf], json: bool) -> Result<()> {
    let mut checked = Checked::new(json);
    for file in files {
        let found = match is_file(file) {
            true => library_of(file),
            false => match Shipped::Study.path(&file.to_string_lossy()) {
                Ok(path) => Ok((Library::built_in(), path)),
                Err(rule) => {
                    checked.unreadable(file, rule);
                    continue;
                }
            },
        };
        let study = found.and_then(|(library, path)| {
            let study = library.rehearsed(&path)?;
            let weights = library.weights(&path, &study);
            Ok((study, weights))
        });
        match study {
            Ok((_, Err(error))) => checked.unreadable(file, error),
            Ok((study, Ok(weights))) => {
                let adaptive = study.blocks.iter().any(|b| b.adaptive.is_some());
                let (blocks, trials) = (study.blocks.len(), study.most_trials());
                let most = if adaptive { "at most " } else { "" };
                let about = json!({ "study": study.id, "blocks": blocks, "trials_at_most": trials, "adaptive": adaptive,
                    "design_hash": study.design_hash(), "weights": weights.iter().map(weight_json).collect::<Vec<_>>(),
                    "heavy_bytes": HEAVY_BYTES });
                let details = format!("blocks: {blocks}, trials: {most}{trials}");
                checked.good(file, &details, about, &study.warnings(&file.display().to_string()))?;
                if !json {
                    print(&weights_text(&weights, study.sizes()))?;
                }
            }
            Err(StudyFileError::Invalid(errors)) => {
                checked.wrong(file, errors.to_string(), errors.0.iter().map(problem_json).collect());
            }
            Err(error) => checked.unreadable(file, error.to_string()),
        }
    }
    checked.finish()
}
