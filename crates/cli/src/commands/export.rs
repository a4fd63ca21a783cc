//! `kelir export`: a study's answers as tables.

use std::path::PathBuf;

use anyhow::Result;
use clap::ValueEnum;
use kelir_house::selection::Selection;
use kelir_house::{
    codebook_csv, codebook_of, events_table, pairs_csv, participants_table, responses_csv, spreadsheet,
};
use kelir_render::file::{try_writing, write_atomic};
use kelir_store::Store;
use kelir_study::columns::{events_codebook, participants_codebook};

use super::stored::{Stored, block_on};
use crate::bad_input;
use crate::output::print;

/// Arguments of `kelir export`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Id of the study, as in its address.
    study: String,
    #[command(flatten)]
    stored: Stored,
    /// Which table; absent: the responses.
    #[arg(long, value_enum)]
    table: Option<Table>,
    /// File to write; absent: standard output. FILE.xlsx is a spreadsheet with every table.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// A table of answers.
#[derive(Clone, Copy, ValueEnum)]
enum Table {
    /// One tidy row a trial, everything that is stored.
    Responses,
    /// One row a session: who came, when, with what, how far, whether judged.
    Participants,
    /// One row for each thing that happened to a page while a trial was taken: lost focus, a resize, an input that did not count.
    Events,
    /// Choices as pwcmp reads them, without the excluded.
    Pairs,
    /// What each column of the responses is.
    Codebook,
    /// What each column of the participants is.
    ParticipantsCodebook,
    /// What each column of the events is.
    EventsCodebook,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let is_spreadsheet = args
        .output
        .as_ref()
        .and_then(|file| file.extension())
        .is_some_and(|e| e.eq_ignore_ascii_case("xlsx"));
    if let (true, Some(_)) = (is_spreadsheet, args.table) {
        return Err(bad_input(
            "--table: a spreadsheet holds every table; give --output FILE.csv for one of them",
        ));
    }
    if let Some(file) = &args.output {
        try_writing(file)?;
    }
    let content = block_on(async {
        if let Some(Table::Codebook) = args.table {
            return Ok(codebook_csv().into_bytes());
        }
        let (store, selection) = args.stored.open(&args.study).await?;
        let content = if is_spreadsheet {
            spreadsheet(&store, &selection).await.map_err(anyhow::Error::from)
        } else {
            csv(&store, &selection, args.table.unwrap_or(Table::Responses)).await
        };
        store.close().await;
        content
    })?;
    match &args.output {
        None => print(&String::from_utf8_lossy(&content)),
        Some(file) => Ok(write_atomic(file, &content)?),
    }
}

async fn csv(store: &Store, selection: &Selection, table: Table) -> Result<Vec<u8>> {
    let text = match table {
        Table::Responses => responses_csv(store, selection).await?,
        Table::Participants => participants_table(store, selection).await?.csv(),
        Table::Events => events_table(store, selection).await?.csv(),
        Table::EventsCodebook => codebook_of(&events_codebook()).csv(),
        Table::Pairs => pairs_csv(store, selection).await?,
        Table::Codebook => codebook_csv(),
        Table::ParticipantsCodebook => {
            codebook_of(&participants_codebook(&selection.study.session.params)).csv()
        }
    };
    Ok(text.into_bytes())
}
