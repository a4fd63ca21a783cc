//! `kelir power --design FILE`: how many participants a study needs.

use std::path::{Path, PathBuf};

use anyhow::Result;
use kelir_render::file;
use kelir_study::StudyDefinition;
use kelir_study::power::{Design, DesignFile, Needed, Power, Rate, power};

use super::drawing::render_error;
use crate::output::{print, table};
use crate::{bad_input, progress};

/// Arguments of `kelir power`.
#[derive(clap::Args)]
pub struct Args {
    /// Design file (TOML): the study, what is supposed to be true, the numbers of participants to try.
    #[arg(long, value_name = "FILE")]
    design: PathBuf,
    /// Also write everything as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    let design = read(&args.design)?;
    let bar = progress::bar(design.simulations, "simulated studies");
    let found = power(&design, &|done| bar.set_position(done));
    bar.finish_and_clear();
    if let Some(path) = &args.json {
        file::write_atomic(path, serde_json::to_string_pretty(&found)?.as_bytes()).map_err(render_error)?;
    }
    print(&text(&found))
}

fn read(path: &Path) -> Result<Design> {
    let text = |path: &Path| {
        std::fs::read_to_string(path).map_err(|error| bad_input(format!("{}: {error}", path.display())))
    };
    let file = DesignFile::parse(&path.display().to_string(), &text(path)?).map_err(bad_input)?;
    let study = path.parent().unwrap_or(Path::new("")).join(&file.study);
    let study = StudyDefinition::parse(&study.display().to_string(), &text(&study)?).map_err(bad_input)?;
    file.design(study).map_err(bad_input)
}

fn text(found: &Power) -> String {
    let mut parts = vec![format!(
        "{} ({}): {} simulated studies of each size, seed {}, α = {}, wanted power {}; a rate is known to ±{:.2} or better",
        found.study,
        &found.design_hash[..12],
        found.simulations,
        found.seed,
        found.alpha,
        found.power,
        0.98 / (found.simulations as f64).sqrt()
    )];
    let sizes: Vec<String> = found.sizes.iter().map(|size| format!("n = {}", size.participants)).collect();
    let header = |first: &[&'static str]| -> Vec<String> {
        first.iter().map(|title| (*title).to_owned()).chain(sizes.clone()).collect()
    };

    if found.sizes.iter().any(|size| size.excluded > 0.0) {
        let shares = found.sizes.iter().map(|size| format!("{:.1}%", 100.0 * size.excluded));
        let cells: Vec<String> = std::iter::once("excluded by rules".to_owned()).chain(shares).collect();
        parts.push(aligned(&header(&["participants who begin"]), &[cells]));
    }

    let Some(first) = found.sizes.first() else { return parts.join("\n\n") };
    for (null, title) in [
        (false, "How often each test finds what is there (power)"),
        (true, "How often each test finds what is not there (should not exceed α)"),
    ] {
        let rows: Vec<Vec<String>> = (0..first.tests.len())
            .filter(|&i| first.tests[i].null == null)
            .map(|i| {
                let rates = found.sizes.iter().map(|size| format!("{:.3}", size.tests[i].rate.rate));
                [first.tests[i].of.clone(), first.tests[i].test.to_owned()].into_iter().chain(rates).collect()
            })
            .collect();
        if !rows.is_empty() {
            parts.push(format!("{title}\n{}", aligned(&header(&["of", "test"]), &rows)));
        }
    }

    let rows: Vec<Vec<String>> = (0..first.intervals.len())
        .map(|i| {
            let interval = &first.intervals[i];
            let truth = interval.truth.map_or_else(|| "–".to_owned(), |x| format!("{x:.3}"));
            let cells =
                found.sizes.iter().map(|size| coverage(&size.intervals[i].coverage, size.intervals[i].width));
            [interval.of.clone(), interval.interval.to_owned(), truth].into_iter().chain(cells).collect()
        })
        .collect();
    parts.push(format!(
        "How often each {:.0}% interval holds the truth, and its mean width\n{}",
        100.0 * found.level,
        aligned(&header(&["of", "interval", "truth"]), &rows)
    ));

    if !found.needed.is_empty() {
        let most = found.sizes.last().map_or(0, |size| size.participants);
        let rows: Vec<Vec<String>> = found.needed.iter().map(|needed| row(needed, most)).collect();
        parts.push(format!(
            "Fewest participants, of those tried, with a power of {} (95% interval of the simulation)\n{}",
            found.power,
            aligned(&["of", "test", "participants", "power there"].map(str::to_owned), &rows)
        ));
    }
    parts.extend(warning(found));
    parts.join("\n\n")
}

fn aligned(header: &[String], rows: &[Vec<String>]) -> String {
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    table(&header, rows)
}

fn coverage(rate: &Rate, width: Option<f64>) -> String {
    let width = width.map_or_else(|| "–".to_owned(), |w| format!("{w:.3}"));
    if rate.runs == 0 { format!("– ({width})") } else { format!("{:.3} ({width})", rate.rate) }
}

fn row(needed: &Needed, most: u32) -> Vec<String> {
    let participants = needed.participants.map_or_else(|| format!("more than {most}"), |n| n.to_string());
    let rate = needed.rate;
    let power = format!("{:.3} [{:.3}, {:.3}]", rate.rate, rate.low, rate.high);
    vec![needed.of.clone(), needed.test.to_owned(), participants, power]
}

/// Says it where a test of all choices cries wolf.
fn warning(found: &Power) -> Option<String> {
    let (participants, test) = found
        .sizes
        .iter()
        .flat_map(|size| size.tests.iter().map(move |test| (size.participants, test)))
        .filter(|(_, test)| test.null && test.rate.low > found.alpha && test.test.contains("ignoring"))
        .max_by(|a, b| a.1.rate.rate.total_cmp(&b.1.rate.rate))?;
    Some(format!(
        "Do not judge block {} by a test of all choices that ignores who made them: with {participants} participants it finds a \
         preference in {:.0}% of studies in which there is none, because choices of one participant are alike.",
        test.of,
        100.0 * test.rate.rate
    ))
}
