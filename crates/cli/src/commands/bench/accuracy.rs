//! `kelir bench accuracy`: error against time, of every technique over its knobs.

use std::path::PathBuf;

use anyhow::Result;
use kelir_house::shipped;
use kelir_plot::{Axis, Figure, Point, Rule, Series, svg};
use kelir_render::accuracy::{Case, CaseReport, Measured, Options, Outcome, Report, all, measure};
use kelir_render::subject::check_view;
use kelir_render::{Backend, Pixel, View, VisibilityModel, file};
use kelir_scene::Scene;

use crate::commands::drawing::{PixelName, parse_backend, parse_size, render_error};
use crate::output::{Figures, table};
use crate::{bad_input, progress};

/// What is measured, and how carefully.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Scene file (TOML), or the name of a scene that ships.
    scene: PathBuf,
    /// Pixels, WIDTHxHEIGHT, of the screen's aspect; by default 960 wide.
    #[arg(long, value_parser = parse_size)]
    size: Option<[usize; 2]>,
    /// A pixel's value: the mean over its area, or the value at its centre.
    #[arg(long, value_enum, default_value = "area")]
    pixel: PixelName,
    /// Where to draw, several by commas: cpu, gpu (also a software one), auto.
    #[arg(long, value_delimiter = ',', default_value = "cpu", value_parser = parse_backend)]
    backend: Vec<Backend>,
    /// Only these of the table's techniques, by the beginnings of their names: "PA,MC".
    #[arg(long, value_delimiter = ',', value_name = "NAMES")]
    only: Vec<String>,
    /// Timed drawings of each case.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Samples a pixel of the Monte-Carlo image that whole images are held against.
    #[arg(long, value_name = "N", default_value_t = 16384)]
    reference_spp: u32,
    /// Its seed; the images under test have seed 1.
    #[arg(long, value_name = "N", default_value_t = 2)]
    reference_seed: u64,
    /// Crops of 8 × 8 pixels that are held against the oracle.
    #[arg(long, default_value_t = 8)]
    crops: usize,
    /// The oracle's tolerance, where nothing is a finite sum.
    #[arg(long, default_value_t = 1e-4)]
    tolerance: f64,
    #[command(flatten)]
    pub(super) figures: Figures,
    /// Also draw error against time, as SVG.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
}

/// Measures, prints and writes.
pub(super) fn run(args: &Args) -> Result<()> {
    let scene = shipped::scene(&args.scene).map_err(bad_input)?;
    let still = scene.still();
    let pixel = match args.pixel {
        PixelName::Area => Pixel::Area,
        PixelName::Centre => Pixel::Centre,
    };
    let aspect = still.screen.height_m / still.screen.width_m;
    let size = args.size.unwrap_or_else(|| [960, (960.0 * aspect).round() as usize]);
    let wanted =
        |series: &str| args.only.is_empty() || args.only.iter().any(|only| series.starts_with(only.as_str()));
    let cases: Vec<_> = all(&still).into_iter().filter(|case| wanted(case.series)).collect();
    if cases.is_empty() {
        return Err(bad_input(format!("only = {:?}: no technique's name begins so", args.only.join(","))));
    }
    if let Some(path) = &args.plot {
        file::try_writing(path).map_err(render_error)?;
    }
    let view = View { size, pixel, skip: true };
    check_view(&still, &view).map_err(render_error)?;
    let options = Options {
        backends: args.backend.clone(),
        runs: args.runs,
        reference_spp: args.reference_spp,
        reference_seed: args.reference_seed,
        crops: [args.crops, 8],
        tolerance: args.tolerance,
        ..Options::new(view)
    };
    let report = watched(&scene, &cases, &options)?;
    // Files first: a closed pipe on the tables loses nothing.
    args.figures.give(&report)?;
    if let Some(path) = &args.plot {
        let name = args.scene.file_stem().unwrap_or_default().to_string_lossy();
        file::write_atomic(path, svg(&figure(&report, &name))?.as_bytes()).map_err(render_error)?;
    }
    args.figures.say(&text(&report))
}

/// Measures, and shows how far it is.
pub(super) fn watched(scene: &Scene, cases: &[Case], options: &Options) -> Result<Report> {
    let bar = progress::bar((cases.len() * options.backends.len() + 2) as u64, "reference");
    let report = measure(scene, cases, options, &mut |step| {
        bar.set_message(step.what.to_owned());
        bar.set_position(step.done as u64);
    });
    bar.finish_and_clear();
    report.map_err(render_error)
}

fn measured(result: &CaseReport) -> Option<&Measured> {
    match &result.outcome {
        Outcome::Measured(measured) => Some(measured),
        Outcome::Refused(_) => None,
    }
}

/// Error with two digits.
fn short(error: f64) -> String {
    format!("{error:.1e}")
}

fn milliseconds(seconds: f64) -> String {
    let ms = 1e3 * seconds;
    match ms {
        _ if ms < 10.0 => format!("{ms:.2}"),
        _ if ms < 100.0 => format!("{ms:.1}"),
        _ => format!("{ms:.0}"),
    }
}

/// Name of a technique's line, with the backend where there are several.
fn series_name(result: &CaseReport, report: &Report) -> String {
    let several = report.results.iter().any(|other| other.backend != result.backend);
    match (several, result.backend) {
        (false, _) => result.case.series.to_owned(),
        (true, Backend::Auto) => format!("{}, auto", result.case.series),
        (true, Backend::Cpu) => format!("{}, cpu", result.case.series),
        (true, Backend::Gpu) => format!("{}, gpu", result.case.series),
    }
}

/// The tables.
pub(super) fn text(report: &Report) -> String {
    let [width, height] = report.size;
    let reference = &report.reference;
    let pixels = width * height;
    let mut adapters: Vec<&str> = report.results.iter().filter_map(|r| r.adapter.as_deref()).collect();
    adapters.dedup();
    let mut text = format!(
        "{width}x{height}, {} of {pixels} pixels in penumbra ({:.1} %); {}\n\
         errors of irradiance in units of the brightest unshadowed point; times of {} drawings\n\n\
         Against Monte Carlo of {} samples a pixel, seed {} ({:.1} s). Its standard error, {} over penumbra, is the floor.\n\
         first: a new renderer's image, with quartiles; again: the same once more, with what it kept.\n\n",
        report.penumbra_pixels,
        100.0 * report.penumbra_pixels as f64 / pixels as f64,
        adapters.join("; "),
        report.runs,
        reference.technique.truth_samples(),
        reference.technique.stand()["seed"],
        reference.seconds,
        short(reference.floor),
    );
    let rows: Vec<Vec<String>> = report
        .results
        .iter()
        .filter_map(|result| {
            let m = measured(result)?;
            Some(vec![
                series_name(result, report),
                result.case.knob.clone(),
                milliseconds(m.first.median),
                format!("{}–{}", milliseconds(m.first.lower), milliseconds(m.first.upper)),
                milliseconds(m.again.median),
                short(m.penumbra.rmse),
                short(m.penumbra.bias),
                short(m.penumbra.p999),
                short(m.penumbra.max),
                short(m.all.rmse),
                short(m.all.p999),
                m.ssim.map_or("–".into(), |ssim| format!("{ssim:.5}")),
                format!("{:.5}", m.flip),
            ])
        })
        .collect();
    let header = [
        "technique",
        "knob",
        "first ms",
        "quartiles",
        "again ms",
        "RMSE",
        "bias",
        "P99.9",
        "max",
        "RMSE, all",
        "P99.9, all",
        "SSIM",
        "FLIP",
    ];
    text += &table(&header, &rows);
    text += "\n(RMSE, bias, P99.9 and max over penumbra; \"all\" over all pixels; SSIM and FLIP of the display images)\n";
    text += &on_crops(report);
    let refused: Vec<Vec<String>> = report
        .results
        .iter()
        .filter_map(|result| match &result.outcome {
            Outcome::Refused(why) => {
                Some(vec![series_name(result, report), result.case.knob.clone(), why.clone()])
            }
            Outcome::Measured(_) => None,
        })
        .collect();
    if !refused.is_empty() {
        text += &format!("\nNot drawn\n\n{}\n", table(&["technique", "knob", "reason"], &refused));
    }
    text
}

/// The second table: model and numerical error apart.
fn on_crops(report: &Report) -> String {
    let oracle = &report.oracle;
    if let Some(why) = &oracle.refused {
        return format!("\nNo comparison with the oracle: {why}\n");
    }
    if oracle.crops.is_empty() {
        return "\nNo comparison with the oracle: no crop has any penumbra\n".into();
    }
    let places: Vec<String> = oracle.crops.iter().map(|c| format!("({}, {})", c.x, c.y)).collect();
    let rows: Vec<Vec<String>> = report
        .results
        .iter()
        .filter_map(|result| {
            let crops = measured(result)?.crops.as_ref()?;
            let geometric = crops.model == VisibilityModel::Geometric;
            Some(vec![
                series_name(result, report),
                result.case.knob.clone(),
                if geometric { "geometric".into() } else { "irradiance".into() },
                if geometric { short(oracle.geometric.rmse) } else { "0".into() },
                short(crops.numerical.rmse),
                short(crops.numerical.max),
                short(crops.visibility_max),
                short(crops.total.rmse),
                short(crops.total.max),
            ])
        })
        .collect();
    let header = [
        "technique",
        "knob",
        "visibility",
        "model RMSE",
        "numerical RMSE",
        "max",
        "max in visibility",
        "total RMSE",
        "max",
    ];
    format!(
        "\nAgainst the oracle (tolerance {}) on {} crops of {} × {} pixels, first pixels {}\n\n{}\n",
        short(oracle.tolerance),
        oracle.crops.len(),
        oracle.crops[0].side,
        oracle.crops[0].side,
        places.join(", "),
        table(&header, &rows)
    )
}

/// Error over penumbra against time, logarithmic both.
fn figure(report: &Report, scene: &str) -> Figure {
    let mut series: Vec<Series> = Vec::new();
    for result in &report.results {
        let Some(m) = measured(result) else { continue };
        // A logarithmic axis has no place for an error of exactly 0.
        if m.penumbra.rmse <= 0.0 {
            continue;
        }
        let (knob, value) = result.case.knob.split_once(' ').unwrap_or((&result.case.knob, ""));
        let name = format!("{} ({knob})", series_name(result, report));
        let label = Some(value.to_owned());
        let point = Point { x: m.first.median, y: m.penumbra.rmse, interval: None, label };
        match series.iter_mut().find(|s| s.name == name) {
            Some(of) => of.points.push(point),
            None => series.push(Series {
                name,
                points: vec![point],
                line: true,
                markers: true,
                ..Series::default()
            }),
        }
    }
    // Knobs at both ends of a line say which way it runs.
    for of in &mut series {
        let last = of.points.len() - 1;
        of.points
            .iter_mut()
            .enumerate()
            .filter(|(k, _)| *k != 0 && *k != last)
            .for_each(|(_, p)| p.label = None);
    }
    let [width, height] = report.size;
    let floor = report.reference.floor;
    let rules = match floor > 0.0 {
        true => vec![Rule::Horizontal(floor, "standard error of the reference".into())],
        false => Vec::new(),
    };
    Figure {
        title: format!("Error against time: {scene}, {width} × {height}, {} threads", report.threads),
        x: Axis::log10("median time of an image from nothing, s"),
        y: Axis::log10("RMSE over penumbra, full scale = 1"),
        series,
        rules,
        size: [860, 560],
    }
}
