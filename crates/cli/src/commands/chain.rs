//! `kelir chain`: whether the stored answers are what was written.

use std::path::PathBuf;

use anyhow::Result;
use clap::Subcommand;
use kelir_house::results;
use kelir_store::ChainReport;

use super::stored::{block_on, results_error};
use crate::bad_input;
use crate::output::{Format, Printed, csv, print, print_json, table};

/// Subcommands of `kelir chain`.
#[derive(Subcommand)]
pub(crate) enum Command {
    /// Prove a study's chain of answers: every row that is not what was written is named, and checking goes on behind it. Exit code 1 where one
    /// is unexplained.
    Check {
        /// Id of the study, as in its address.
        study: String,
        /// The server's data folder; it may be running.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        #[command(flatten)]
        printed: Printed,
    },
    /// Leave a note on a row that does not verify, for whoever checks later. Notes are kept with their author and time, and never changed.
    Note {
        /// Id of the study, as in its address.
        study: String,
        /// The server's data folder; it may be running.
        #[arg(long, default_value = "data")]
        data: PathBuf,
        /// Version of the chain that the row is in, as `check` names it.
        #[arg(long, default_value_t = 2)]
        chain: u32,
        /// Place of the row in its chain, as `check` names it.
        #[arg(long)]
        seq: i64,
        /// What is known of it.
        #[arg(long)]
        why: String,
        /// Who says so.
        #[arg(long)]
        author: String,
    },
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
    match command {
        Command::Check { study, data, printed } => {
            let report = block_on(async {
                let store = results::open_study(&data, &study).await.map_err(results_error)?;
                let report = store.verify_chain(&study).await;
                store.close().await;
                Ok(report?)
            })?;
            show(&report, printed.form())?;
            match report.unexplained().count() {
                0 => Ok(()),
                n => anyhow::bail!(
                    "{n} of {} stored answers are not what was written and unexplained",
                    report.rows
                ),
            }
        }
        Command::Note { study, data, chain, seq, why, author } => block_on(async {
            let store = results::open_study(&data, &study).await.map_err(results_error)?;
            let report = store.verify_chain(&study).await?;
            if !report.faults.iter().any(|fault| (fault.chain, fault.seq) == (chain, seq)) {
                store.close().await;
                let rule = "is no row that does not verify: `kelir chain check` names those";
                return Err(bad_input(format!("chain = {chain}, seq = {seq}: {rule}")));
            }
            if why.trim().is_empty() || author.trim().is_empty() {
                store.close().await;
                return Err(bad_input("why, author: must not be empty"));
            }
            store.note_on_chain(&study, chain, seq, why.trim(), author.trim()).await?;
            store.close().await;
            print(&format!("Noted on answer {seq} of chain {chain}."))
        }),
    }
}

fn show(report: &ChainReport, format: Format) -> Result<()> {
    let header = ["chain", "answer", "what is wrong with it", "note"];
    let rows: Vec<Vec<String>> = report
        .faults
        .iter()
        .map(|fault| {
            let note = fault.note.clone().unwrap_or_else(|| "unexplained".to_owned());
            vec![fault.chain.to_string(), fault.seq.to_string(), fault.what.clone(), note]
        })
        .collect();
    match format {
        Format::Json => print_json(report),
        Format::Csv => print(&csv(&header, &rows)),
        Format::Table => {
            let faults = match rows.len() {
                0 => "every one is what was written".to_owned(),
                1 => "1 is not what was written".to_owned(),
                n => format!("{n} are not what was written"),
            };
            print(&format!("{} answers checked, {faults}; {} blanked.", report.rows, report.blanked))?;
            print(&format!("The chain ends in {}.", report.head))?;
            if rows.is_empty() { Ok(()) } else { print(&table(&header, &rows)) }
        }
    }
}
