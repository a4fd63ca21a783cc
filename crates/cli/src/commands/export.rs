//! `kelir export`: a study's answers as tables.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::ValueEnum;
use kelir_render::file::write_atomic;
use kelir_server::{codebook_csv, events_codebook_csv, events_csv, responses_csv, results::pairs_csv};

use super::stored::{Stored, block_on};
use crate::output::print;

/// Arguments of `kelir export`.
#[derive(clap::Args)]
pub struct Args {
    /// Id of the study, as in its address.
    study: String,
    #[command(flatten)]
    stored: Stored,
    /// Which table.
    #[arg(long, value_enum, default_value = "responses")]
    table: Table,
    /// File to write; absent: standard output.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// A table of answers.
#[derive(Clone, Copy, ValueEnum)]
enum Table {
    /// One tidy row a trial, everything that is stored.
    Responses,
    /// One row for each thing that happened to a page while a trial was taken: lost focus, a resize, an input that did not count.
    Events,
    /// Choices as pwcmp reads them, without the excluded.
    Pairs,
    /// What each column of the responses is.
    Codebook,
    /// What each column of the events is.
    EventsCodebook,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let text = block_on(async {
        match args.table {
            Table::Codebook => return Ok(codebook_csv()),
            Table::EventsCodebook => return Ok(events_codebook_csv()),
            _ => {}
        }
        let (store, selection) = args.stored.open(&args.study).await?;
        let text = match args.table {
            Table::Pairs => pairs_csv(&store, &selection).await,
            Table::Events => events_csv(&store, &selection).await,
            _ => responses_csv(&store, &selection).await,
        };
        store.close().await;
        Ok(text?)
    })?;
    match &args.output {
        None => print(&text),
        Some(file) => write_atomic(file, text.as_bytes()).with_context(|| file.display().to_string()),
    }
}
