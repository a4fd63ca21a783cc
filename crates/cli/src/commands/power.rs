//! `kelir power --design FILE`: how many participants a study needs.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use anyhow::Result;
use kelir_house::shipped::{Shipped, is_file};
use kelir_study::power::{Design, DesignFile, Needed, Power, Rate, power};
use kelir_study::report::ALPHA;
use kelir_study::{PrimaryEndpoint, StudyDefinition};

use crate::output::{Figures, table};
use crate::{bad_input, progress};

/// Arguments of `kelir power`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Design file (TOML), or the name of one that ships: the study, what is supposed to be true, the numbers of participants to try.
    #[arg(long, value_name = "DESIGN")]
    design: PathBuf,
    #[command(flatten)]
    figures: Figures,
}

/// Runs the command.
pub(crate) fn run(args: &Args) -> Result<()> {
    let design = read(&args.design)?;
    args.figures.try_writing()?;
    let bar = progress::bar(design.simulations, "simulated studies");
    let (begun, due) = (Instant::now(), Mutex::new(FIRST_ANSWER));
    let found = power(&design, threads(), &|done, so_far| {
        bar.set_position(done);
        let mut due = due.lock().unwrap_or_else(PoisonError::into_inner);
        if begun.elapsed() > *due && done < design.simulations {
            *due = 2 * begun.elapsed();
            bar.suspend(|| eprintln!("{}\n", interim(&so_far(), design.simulations)));
        }
    });
    bar.finish_and_clear();
    args.figures.give(&found)?;
    args.figures.say(&text(&found))
}

/// When the answer so far is told for the first time; then each time that it has cost twice as much.
const FIRST_ANSWER: Duration = Duration::from_secs(2);

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// The answer so far.
fn interim(found: &Power, of: u64) -> String {
    let needed =
        needed(found).unwrap_or_else(|| "Nothing of what is asked for is there to be found.".to_owned());
    format!("After {} of {of} simulated studies of each size:\n{needed}", found.simulations)
}

fn read(argument: &Path) -> Result<Design> {
    let (path, text) = file(argument)?;
    let design = DesignFile::parse(&path, &text).map_err(bad_input)?;
    let folder = Path::new(&path).parent().unwrap_or(Path::new(""));
    let (path, text) = match is_file(argument) {
        true => file(&folder.join(&design.study))?,
        // A design that ships names a study that ships.
        false => {
            shipped(Shipped::Study, Path::new(&design.study).file_stem().and_then(|stem| stem.to_str()))?
        }
    };
    design.design(StudyDefinition::parse(&path, &text).map_err(bad_input)?).map_err(bad_input)
}

/// Path and text of a file, or of a design that ships.
fn file(argument: &Path) -> Result<(String, String)> {
    if !is_file(argument) {
        return shipped(Shipped::Design, argument.to_str());
    }
    let text = std::fs::read_to_string(argument);
    let text = text.map_err(|error| bad_input(format!("{}: {error}", argument.display())))?;
    Ok((argument.display().to_string(), text))
}

fn shipped(kind: Shipped, name: Option<&str>) -> Result<(String, String)> {
    let path = kind.path(name.unwrap_or_default()).map_err(bad_input)?;
    let text = Shipped::text(&path).unwrap_or_default();
    Ok((path, text))
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
    parts.extend(found.primary.as_ref().map(|named| primary(named, found.alpha)));
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
                let test = test_name(first.tests[i].test, first.tests[i].primary);
                [first.tests[i].of.clone(), test].into_iter().chain(rates).collect()
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

    parts.extend(needed(found));
    parts.extend(warning(found));
    parts.join("\n\n")
}

/// How many participants it takes; `None` where nothing is there to be found.
fn needed(found: &Power) -> Option<String> {
    if found.needed.is_empty() {
        return None;
    }
    let most = found.sizes.last().map_or(0, |size| size.participants);
    let rows: Vec<Vec<String>> = found.needed.iter().map(|needed| row(needed, most)).collect();
    Some(format!(
        "Fewest participants, of those tried, with a power of {} (95% interval of the simulation)\n{}",
        found.power,
        aligned(&["of", "test", "participants", "power there"].map(str::to_owned), &rows)
    ))
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
    vec![needed.of.clone(), test_name(needed.test, needed.primary), participants, power]
}

fn test_name(test: &str, primary: bool) -> String {
    if primary { format!("primary endpoint: {test}") } else { test.to_owned() }
}

/// What the study is made to decide, and how that is judged.
fn primary(named: &PrimaryEndpoint, alpha: f64) -> String {
    let when = named.participants.map(|n| format!(" The study file plans it for {n} judged participants."));
    let level = match alpha == ALPHA {
        true => String::new(),
        false => format!(" A report judges it at {ALPHA}."),
    };
    format!(
        "Primary endpoint: {} of {}, at α = {alpha}, uncorrected, as it is one test and in no Holm family.{level}{}",
        named.test.in_words(),
        named.subject(),
        when.unwrap_or_default()
    )
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
