//! `kelir stats STUDY` and `kelir stats ttest`.

use anyhow::Result;
use clap::{Subcommand, ValueEnum};
use kelir_report::Document;
use kelir_stats::inference::{TTest, t_test_from_counts};

use super::stored::Stored;
use crate::bad_input;
use crate::output::{Format, Printed, csv, print, print_json, table};

/// Arguments of `kelir stats`.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    test: Option<Test>,
    /// Id of the study, as in its address.
    #[arg(required = true)]
    study: Option<String>,
    #[command(flatten)]
    stored: Stored,
    /// Print one JSON document, everything in full precision.
    #[arg(long, conflicts_with = "format")]
    json: bool,
    #[arg(long, value_enum, default_value = "text")]
    format: ReportFormat,
}

/// How a study's report is printed.
#[derive(Clone, Copy, ValueEnum)]
enum ReportFormat {
    /// For reading, 100 columns wide.
    #[value(alias = "table")]
    Text,
    /// As `--json`.
    #[value(hide = true)]
    Json,
    /// One row a number, full precision.
    Csv,
}

/// A test of numbers given on the command line.
#[derive(Subcommand)]
enum Test {
    /// Two-sided one-sample t-test of a table of counts.
    Ttest {
        /// VALUE:HOW-OFTEN pairs, as in 0:12,1:14,2:6.
        #[arg(long, value_parser = parse_counts, allow_hyphen_values = true)]
        counts: Counts,
        /// The mean under the null hypothesis.
        #[arg(long)]
        mu: f64,
        #[command(flatten)]
        printed: Printed,
    },
}

#[derive(Clone)]
struct Counts(Vec<(f64, u64)>);

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    match (args.test, args.study) {
        (Some(Test::Ttest { counts, mu, printed }), _) => {
            let test = t_test_from_counts(&counts.0, mu).map_err(bad_input)?;
            print_test(&test, printed.form())
        }
        (None, Some(study)) => {
            let report = args.stored.report(&study)?;
            match args.format {
                _ if args.json => print_json(&report),
                ReportFormat::Text => print(&kelir_report::text(&Document::of(&report))),
                ReportFormat::Json => print_json(&report),
                ReportFormat::Csv => print(&kelir_report::csv(&report)),
            }
        }
        (None, None) => unreachable!("clap asks for a study or a test"),
    }
}

fn print_test(test: &TTest, format: Format) -> Result<()> {
    match format {
        Format::Json => print_json(test),
        Format::Csv => print(&csv(
            &["n", "mean", "sd", "mu", "t", "df", "p"],
            &[vec![
                test.n.to_string(),
                test.mean.to_string(),
                test.sd.to_string(),
                test.mu.to_string(),
                test.t.to_string(),
                test.df.to_string(),
                test.p.to_string(),
            ]],
        )),
        Format::Table => print(&table(
            &["n", "mean", "sd", "mu", "t", "df", "p (two-sided)"],
            &[vec![
                test.n.to_string(),
                format!("{:.4}", test.mean),
                format!("{:.4}", test.sd),
                test.mu.to_string(),
                format!("{:.4}", test.t),
                test.df.to_string(),
                p_value(test.p),
            ]],
        )),
    }
}

/// Three significant digits, the way a paper prints them.
fn p_value(p: f64) -> String {
    if p >= 0.001 { format!("{p:.4}") } else { format!("{p:.3e}") }
}

fn parse_counts(text: &str) -> Result<Counts, String> {
    let pair = |item: &str| -> Option<(f64, u64)> {
        let (value, count) = item.split_once(':')?;
        Some((value.trim().parse().ok()?, count.trim().parse().ok()?))
    };
    let counts = text.split(',').map(|item| {
        pair(item).ok_or_else(|| format!("{item:?} is no VALUE:HOW-OFTEN pair, as in 0:12,1:14,2:6"))
    });
    counts.collect::<Result<_, _>>().map(Counts)
}
