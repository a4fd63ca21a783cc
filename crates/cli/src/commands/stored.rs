//! What the commands share that read a server's data folder: which study, and which of its versions.

use std::path::PathBuf;

use anyhow::Result;
use kelir_house::results::{self, ResultsError};
use kelir_house::selection::{Include, Selection, SelectionError, VersionRef, With};
use kelir_report::StudyReport;
use kelir_store::Store;

use crate::bad_input;

/// A study in a data folder.
#[derive(clap::Args)]
pub(super) struct Stored {
    /// The server's data folder; it may be running.
    #[arg(long, default_value = "data")]
    pub data: PathBuf,
    #[command(flatten)]
    pub versions: Versions,
}

/// Which versions of a study.
#[derive(clap::Args)]
pub(super) struct Versions {
    /// Version of the study: its hash, the beginning of it (8 digits or more), or `current`, the one served last.
    /// `kelir study versions` lists them.
    #[arg(long, default_value = "current", value_parser = parse::<VersionRef>)]
    pub version: VersionRef,
    /// Versions whose answers count with that one's, separated by commas, or `all`.
    #[arg(long, default_value = "", hide_default_value = true, value_parser = parse::<With>)]
    pub with: With,
    /// Kinds of sessions that are judged like participants': pilot, simulated, or both, separated by a comma.
    #[arg(long, default_value = "", hide_default_value = true, value_parser = parse::<Include>)]
    pub include: Include,
}

fn parse<T: std::str::FromStr<Err = SelectionError>>(text: &str) -> Result<T, String> {
    text.parse().map_err(|error: SelectionError| error.to_string())
}

/// Runs what reads a data folder to its end.
pub(super) fn block_on<T>(work: impl Future<Output = Result<T>>) -> Result<T> {
    tokio::runtime::Builder::new_current_thread().enable_all().build()?.block_on(work)
}

/// An unknown folder, study or version is bad input; a failing disk is not.
pub(super) fn results_error(error: ResultsError) -> anyhow::Error {
    match error {
        ResultsError::Store(_) | ResultsError::Selection(SelectionError::Store(_)) => error.into(),
        _ => bad_input(error),
    }
}

impl Stored {
    /// The full report of the versions asked for.
    pub(super) fn report(&self, study: &str) -> Result<StudyReport> {
        block_on(async {
            let (store, selection) = self.open(study).await?;
            let report = results::report(&store, &selection).await;
            store.close().await;
            Ok(report?)
        })
    }

    /// The store of the data folder, with the versions asked for.
    pub(super) async fn open(&self, study: &str) -> Result<(Store, Selection)> {
        let store = results::open_study(&self.data, study).await.map_err(results_error)?;
        let Versions { version, with, include } = &self.versions;
        let selection = Selection::of(&store, study, None, version, with).await;
        let selection = selection.map_err(|error| results_error(error.into()))?;
        Ok((store, selection.including(include.clone())))
    }
}
