//! `kelir paper`: a published result, computed again.

use anyhow::Result;
use clap::ValueEnum;
use kelir_stats::paper::{Comparison, Replication, taylor_cameron};

use crate::output::{print, print_json};

/// Arguments of `kelir paper`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Which paper.
    #[arg(value_enum)]
    paper: Paper,
    /// Print one JSON document, in full precision.
    #[arg(long)]
    json: bool,
}

/// Papers whose statistics are computed again.
#[derive(Clone, Copy, ValueEnum)]
enum Paper {
    /// Taylor & Cameron, "Rendering Virtual Shadow Puppet Theatres".
    TaylorCameron,
}

/// Runs the command.
pub(crate) fn run(args: Args) -> Result<()> {
    let Paper::TaylorCameron = args.paper;
    let replication = taylor_cameron()?;
    if args.json {
        return print_json(&replication);
    }
    let comparisons: Vec<String> = replication.comparisons.iter().map(comparison).collect();
    print(&format!(
        "Taylor & Cameron, \"Rendering Virtual Shadow Puppet Theatres\", computed again\n\n{}\n\n{}",
        comparisons.join("\n\n"),
        printed_t(&replication)
    ))
}

fn comparison(c: &Comparison) -> String {
    let counts: Vec<String> = c.counts.iter().map(|(value, n)| format!("{n} chose {value}")).collect();
    let (t, e) = (&c.test, &c.effect);
    let equivalence: Vec<String> =
        c.tabled().map(|e| format!("±{:.2}: {:.4}", e.within, e.tests.p)).collect();
    let agrees = if c.t_as_printed { "as printed" } else { "not what is printed" };
    let power: Vec<String> =
        c.power.iter().map(|plan| format!("{:.2} for d = {}", plan.power, plan.d)).collect();
    format!(
        "{}\n  printed          mean {}, sd {}, t {}\n  \
         counts           {} (tables that round to the printed mean and sd: {})\n  \
         t-test           mean {:.4}, sd {:.4}, t = {:.6} ({agrees}), df = {}, p = {:.5e}; Holm-corrected p = {:.4e}\n  \
         effect           d = {:.3} [{:.3}, {:.3}], g = {:.3} [{:.3}, {:.3}]\n  \
         equivalence      p by the bound on the share: {}\n  \
         Bayes factor     BF01 = {:.3}, BF10 = {:.3} (JZS, r = {:.3})\n  \
         without normality  sign test p = {:.4}, Wilcoxon p = {:.4}\n  \
         power at n = {:<4} {}; 80% for d = {:.3}",
        c.title,
        c.printed.mean,
        c.printed.sd,
        c.printed.t,
        counts.join(", "),
        c.reconstructions,
        t.mean,
        t.sd,
        t.t,
        t.df,
        t.p,
        c.p_holm,
        e.d,
        e.d_interval.low,
        e.d_interval.high,
        e.g,
        e.g_interval.low,
        e.g_interval.high,
        equivalence.join(", "),
        c.bayes.bf01,
        c.bayes.bf10,
        c.bayes.prior_scale,
        c.sign.p,
        c.wilcoxon.p,
        t.n,
        power.join(", "),
        c.detectable.d,
    )
}

fn printed_t(replication: &Replication) -> String {
    let found = &replication.printed_t;
    let (from, to) = found.participants;
    let splits = if found.splits_with_this_t.is_empty() {
        format!("no whole number of {from} to {to} participants gives it")
    } else {
        format!("splits that give it: {}", found.splits_with_this_t.len())
    };
    let closest = found.closest;
    format!(
        "The printed t = {}: {splits}; the closest is {} of {} (t = {:.3}).",
        found.printed, closest.chosen, closest.n, closest.t
    )
}
