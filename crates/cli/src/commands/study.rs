//! `kelir study`: checking study files, listing what was served.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_house::links::{Links, Visit, now};
use kelir_house::shipped::{Shipped, is_file};
use kelir_house::versions::versions as versions_of;
use kelir_house::{HEAVY_BYTES, Library, SLOW_BITS_PER_S, StudyFileError, Weight, library_of, results};
use kelir_study::Problem;
use serde_json::json;

use super::checked::Checked;
use super::stored::{block_on, results_error};
use crate::bad_input;
use crate::output::{Format, Printed, csv, print, print_json, table};

/// Subcommands of `kelir study`.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
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
pub(crate) enum LinkKind {
    /// Stored, counted apart, left out of every analysis.
    Pilot,
    /// Nothing is stored.
    Preview,
}

/// Runs the command.
pub(crate) fn run(command: Command) -> Result<()> {
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
        let versions = versions_of(&store, study, None).await;
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
    let Weight { block, size, bytes, is_exact, begins_after_bytes } = weight;
    json!({ "block": block, "size": size, "bytes": bytes, "is_exact": is_exact, "begins_after_bytes": begins_after_bytes })
}

/// What a participant downloads in all at one size, and whether that was counted.
struct Total {
    size: [u32; 2],
    bytes: u64,
    is_exact: bool,
}

fn totals(weights: &[Weight], sizes: &[[u32; 2]]) -> Vec<Total> {
    let of = |size: &[u32; 2]| {
        let of_size = || weights.iter().filter(|weight| weight.size == *size);
        let bytes = of_size().map(|weight| weight.bytes).sum();
        Total { size: *size, bytes, is_exact: of_size().all(|weight| weight.is_exact) }
    };
    sizes.iter().map(of).collect()
}

fn megabytes(bytes: u64, is_exact: bool) -> String {
    format!("{}{:.2} MB", if is_exact { "" } else { "about " }, bytes as f64 / 1e6)
}

/// Sizes at which people on a slow line wait, and what can be done.
fn heavy(file: &str, totals: &[Total]) -> Vec<Problem> {
    let is_one_of_many = totals.len() > 1;
    let warning = |total: &Total| {
        let [width, height] = total.size;
        let (weight, bound) = (megabytes(total.bytes, total.is_exact), megabytes(HEAVY_BYTES, true));
        let seconds = 8.0 * total.bytes as f64 / SLOW_BITS_PER_S as f64;
        let (whose, otherwise) = match is_one_of_many {
            true => (
                "whose window has room for this size ",
                ", or leave this size out where sharper pictures are not worth the wait",
            ),
            false => ("", ""),
        };
        Problem::new(
            file,
            if is_one_of_many { "display.sizes" } else { "size" },
            Some(format!("[{width}, {height}]")),
            format!(
                "a participant {whose}downloads {weight}, which takes a slow line (1.6 Mbit/s) {seconds:.0} s; up to {bound} nothing is said. Pixels \
                 are bytes: show fewer items, shorter films or fewer frames a second{otherwise}"
            ),
        )
    };
    totals.iter().filter(|total| total.bytes > HEAVY_BYTES).map(warning).collect()
}

/// What a participant downloads at each size, in all and block by block.
fn weights_text(weights: &[Weight], totals: &[Total]) -> String {
    let line = |total: &Total| {
        let [width, height] = total.size;
        let own = weights.iter().filter(|weight| weight.size == total.size);
        let begins = |w: &Weight| {
            let megabytes = w.begins_after_bytes.map(|bytes| megabytes(bytes, w.is_exact));
            megabytes.map_or_else(String::new, |mb| format!(", beginning after {mb} at 9 Mbit/s"))
        };
        let of_block = |w: &Weight| format!("{} {}{}", w.block, megabytes(w.bytes, w.is_exact), begins(w));
        let blocks: Vec<String> = own.map(of_block).collect();
        let all = megabytes(total.bytes, total.is_exact);
        format!("  a participant downloads at {width} × {height}: {all} ({})", blocks.join("; "))
    };
    totals.iter().map(line).collect::<Vec<_>>().join("\n")
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
            let warnings = library.warnings(&path, &study);
            Ok((study, weights, warnings))
        });
        match study {
            Ok((_, Err(error), _)) => checked.unreadable(file, error),
            Ok((study, Ok(weights), mut warnings)) => {
                let adaptive = study.blocks.iter().any(|b| b.adaptive.is_some());
                let (blocks, trials) = (study.blocks.len(), study.most_trials());
                let most = if adaptive { "at most " } else { "" };
                let about = json!({ "study": study.id, "blocks": blocks, "trials_at_most": trials, "adaptive": adaptive,
                    "design_hash": study.design_hash(), "weights": weights.iter().map(weight_json).collect::<Vec<_>>(),
                    "heavy_bytes": HEAVY_BYTES });
                let details = format!("blocks: {blocks}, trials: {most}{trials}");
                let name = file.display().to_string();
                let totals = totals(&weights, study.sizes());
                warnings.iter_mut().for_each(|warning| warning.file.clone_from(&name));
                warnings.extend(heavy(&name, &totals));
                checked.good(file, &details, about, &warnings)?;
                if !json {
                    print(&weights_text(&weights, &totals))?;
                }
            }
            Err(StudyFileError::Invalid(errors)) => {
                checked.wrong(file, &errors);
            }
            Err(error) => checked.unreadable(file, error.to_string()),
        }
    }
    checked.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_heavy_is_said_at_the_size_at_which_it_is() {
        let weight = |block: &str, size, bytes, is_exact| {
            let begins_after_bytes = (block == "loop").then_some(bytes - 1_500_000);
            Weight { block: block.to_owned(), size, bytes, is_exact, begins_after_bytes }
        };
        let (small, large) = ([592, 333], [1110, 624]);
        let weights = [
            weight("stills", small, 2_000_000, true),
            weight("stills", large, 2_500_000, true),
            weight("loop", small, 4_000_000, true),
            weight("loop", large, 3_500_001, false),
        ];
        let totals = totals(&weights, &[small, large]);
        let text = weights_text(&weights, &totals);
        assert_eq!(
            text.lines().collect::<Vec<_>>(),
            [
                "  a participant downloads at 592 × 333: 6.00 MB (stills 2.00 MB; loop 4.00 MB, beginning after 2.50 MB at 9 Mbit/s)",
                "  a participant downloads at 1110 × 624: about 6.00 MB (stills 2.50 MB; loop about 3.50 MB, beginning after about 2.00 MB at 9 Mbit/s)"
            ]
        );
        let [heavy] = &heavy("f.toml", &totals)[..] else { panic!("the larger size alone") };
        assert_eq!((heavy.field.as_str(), heavy.value.as_deref()), ("display.sizes", Some("[1110, 624]")));
        for said in
            ["room for this size downloads about 6.00 MB", "30 s", "up to 6.00 MB", "leave this size out"]
        {
            assert!(heavy.rule.contains(said), "{said} in {heavy}");
        }
        let [heavy] = &super::heavy("f.toml", &totals[1..])[..] else { panic!("the one size") };
        assert_eq!(heavy.field, "size");
        assert!(!heavy.rule.contains("this size"), "{heavy}");
    }
}
