//! `kelir report`: a study's report as a file for a browser or a paper.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use kelir_render::file::{try_writing, write_atomic};
use kelir_report::{Document, Figures, html, markdown};

use super::stored::Stored;
use crate::bad_input;

/// Arguments of `kelir report`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Id of the study, as in its address.
    study: String,
    #[command(flatten)]
    stored: Stored,
    /// report.html: one file with everything in it. report.md: Markdown, with its figures in the folder report-figures beside it.
    #[arg(short, long)]
    output: PathBuf,
}

/// How the report is written.
enum Kind {
    Html,
    Markdown { figures: String },
}

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    let kind = kind(&args.output)?;
    if let Some(folder) = args.output.parent().filter(|p| !p.as_os_str().is_empty() && !p.is_dir()) {
        return Err(bad_input(format!(
            "--output = {}: {} is no folder",
            args.output.display(),
            folder.display()
        )));
    }
    try_writing(&args.output)?;
    if let Kind::Markdown { figures } = &kind {
        try_writing(&args.output.with_file_name(figures).join("a.svg"))?;
    }
    let document = Document::of(&args.stored.report(&args.study)?);
    match kind {
        Kind::Html => write(&args.output, html(&document).as_bytes()),
        Kind::Markdown { figures } => {
            let written = markdown(&document, &Figures::Folder(figures.clone()));
            let beside = args.output.parent().unwrap_or(Path::new(""));
            if !written.files.is_empty() {
                let folder = beside.join(&figures);
                std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
            }
            // The text comes last: while it is there, so is what it shows.
            for (path, svg) in &written.files {
                write(&beside.join(path), svg.as_bytes())?;
            }
            write(&args.output, written.text.as_bytes())
        }
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    Ok(write_atomic(path, bytes)?)
}

/// What the file's ending asks for.
fn kind(output: &Path) -> Result<Kind> {
    let (stem, ending) =
        (output.file_stem(), output.extension().and_then(|e| e.to_str()).unwrap_or_default());
    match (stem.and_then(|s| s.to_str()), ending.to_ascii_lowercase().as_str()) {
        (Some(_), "html" | "htm") => Ok(Kind::Html),
        (Some(stem), "md" | "markdown") => Ok(Kind::Markdown { figures: format!("{stem}-figures") }),
        _ => Err(bad_input(format!("--output = {}: must end in .html or .md", output.display()))),
    }
}
