//! `kelir bench numerics`.

use anyhow::{Result, bail};
use kelir_render::{Backend, numerics};
use serde_json::json;

use crate::bad_input;
use crate::commands::drawing::render_error;
use crate::output::{Figures, table};

/// An error to two digits.
fn error(value: f64) -> String {
    if value.is_nan() { "–".into() } else { format!("{value:.1e}") }
}

/// The renderer's stress cases.
pub(super) fn renderer(most: usize, figures: &Figures) -> Result<()> {
    let cases = numerics::cases(most);
    if cases.is_empty() {
        return Err(bad_input(format!(
            "most = {most}: no mask is that small; the smallest has 64 texels a side"
        )));
    }
    let bar = crate::progress::bar(cases.len() as u64, "cases");
    let mut rows = Vec::with_capacity(cases.len());
    for case in &cases {
        bar.set_message(case.name.clone());
        rows.push(numerics::measure(case).map_err(render_error)?);
        bar.inc(1);
    }
    bar.finish_and_clear();
    figures.say(
        "Visibility against the oracle: the largest error of PA as it draws; of exact boxes on each kind of table; of f32 corners and blends\n\
         on the exact table. Radiance: of full scale. Bytes: sRGB bytes that differ from the oracle's, of the pixels compared.\n",
    )?;
    let header =
        ["case", "PA", "uses", "u32", "u64", "f32", "biased f32", "f32 corners", "radiance", "bytes", ""];
    let line = |row: &numerics::Row| {
        let mut cells = vec![row.case.clone(), error(row.product), row.uses.to_owned()];
        cells.extend(row.variants.map(error));
        cells.extend([error(row.radiance), format!("{}/{}", row.bytes_off, row.pixels)]);
        cells.push(if row.holds() { String::new() } else { "FAILS".into() });
        cells
    };
    let mut lines: Vec<Vec<String>> = rows.iter().map(line).collect();
    let parallel = || rows.iter().filter(|row| row.parallel);
    let worst = |of: &dyn Fn(&numerics::Row) -> f64| error(parallel().map(of).fold(0.0, f64::max));
    let mut last = vec!["worst of the parallel ones".to_owned(), worst(&|r| r.product), String::new()];
    last.extend((0..numerics::VARIANTS.len()).map(|k| worst(&|r| r.variants[k])));
    last.push(worst(&|r| r.radiance));
    let (off, pixels) = parallel().fold((0, 0), |(o, p), r| (o + r.bytes_off, p + r.pixels));
    last.extend([format!("{off}/{pixels}"), String::new()]);
    lines.push(last);
    figures.say(&table(&header, &lines))?;
    figures.say("\nE⁰ against mpmath: the largest relative error\n")?;
    let emitters = numerics::emitters();
    let lines: Vec<Vec<String>> = emitters
        .iter()
        .map(|e| {
            let [w, h] = e.size_m;
            let name = format!("{} of {w} m × {h} m", e.shape);
            let errors = [e.product, e.closed_form, e.closed_form_f32].map(error);
            [vec![name, e.points.to_string()], errors.to_vec()].concat()
        })
        .collect();
    figures.say(&table(&["emitter", "points", "kelir", "closed form, f64", "closed form, f32"], &lines))?;
    let stacks = stacks(figures)?;
    let impossible: usize = rows.iter().map(|row| row.impossible).sum();
    let failed =
        rows.iter().filter(|row| !row.holds()).count() + stacks.iter().filter(|row| !row.holds()).count();
    figures.say(&format!(
        "\n{} cases, {} of them parallel: largest error of PA {} (at most {:e}), {impossible} visibilities that are NaN, negative or above 1,\n\
         {off} of {pixels} bytes differ from the oracle's, {} of them by more than a code or further than {} code from a boundary",
        rows.len(),
        parallel().count(),
        worst(&|r| r.product),
        numerics::BOUND,
        rows.iter().map(|row| if row.parallel { row.bytes_wrong } else { 0 }).sum::<usize>(),
        numerics::NEAR_BOUNDARY,
    ))?;
    figures.give(&json!({ "cases": rows, "emitters": emitters, "stacks": stacks }))?;
    if failed > 0 {
        bail!("{failed} cases do not hold");
    }
    Ok(())
}

/// Puppets behind puppets, by every technique on the CPU and on what GPU there is.
fn stacks(figures: &Figures) -> Result<Vec<numerics::StackRow>> {
    figures.say("\nPuppets behind each other: the largest error in visibility against the oracle, over 1 to 256 of them, in 8 and 16 bits\n")?;
    let mut rows = Vec::new();
    for backend in [Backend::Cpu, Backend::Gpu] {
        let bar = crate::progress::bar(0, "stacks");
        match numerics::stacks(256, backend, |puppets| bar.set_message(format!("{puppets} puppets"))) {
            Ok(drawn) => rows.extend(drawn),
            Err(error) if backend == Backend::Gpu => figures.say(&format!("Not on a GPU: {error}\n"))?,
            Err(error) => return Err(render_error(error)),
        }
        bar.finish_and_clear();
    }
    let mut lines: Vec<Vec<String>> = Vec::new();
    for of in rows.chunk_by(|a, b| (a.technique, a.backend) == (b.technique, b.backend)) {
        let errors = of.iter().filter_map(|row| row.error);
        let (refused, failed) = (
            of.iter().filter(|row| row.refused.is_some()).count(),
            of.iter().filter(|row| !row.holds()).count(),
        );
        lines.push(vec![
            of[0].technique.to_owned(),
            if of[0].backend == Backend::Cpu { "cpu" } else { "gpu" }.to_owned(),
            of.len().to_string(),
            error(errors.fold(0.0, f64::max)),
            of.iter().map(|row| row.impossible).sum::<usize>().to_string(),
            refused.to_string(),
            if failed == 0 { String::new() } else { format!("{failed} FAIL") },
        ]);
    }
    figures.say(&table(&["technique", "backend", "stacks", "error", "impossible", "refused", ""], &lines))?;
    Ok(rows)
}

/// Error over knobs.
pub(super) fn curves(figures: &Figures) -> Result<()> {
    let curves = numerics::curves().map_err(render_error)?;
    figures.say(
        "Error against the oracle over the knob: rms over penumbra / largest; the default is marked *\n",
    )?;
    let most = curves.iter().map(|c| c.steps.len()).max().unwrap_or(0);
    let line = |curve: &numerics::Curve| {
        let mut cells = vec![curve.name.clone(), curve.of.to_owned(), curve.knob.to_owned()];
        cells.extend(curve.steps.iter().map(|s| {
            let mark = if s.value == curve.default { "*" } else { "" };
            format!("{}{mark}: {} / {}", s.value, error(s.rmse), error(s.max))
        }));
        cells.resize(3 + most, String::new());
        cells
    };
    let header: Vec<&str> = ["what", "error of", "knob"].into_iter().chain((0..most).map(|_| "")).collect();
    figures.say(&table(&header, &curves.iter().map(line).collect::<Vec<_>>()))?;
    figures.give(&curves)
}

/// The statistics.
pub(super) fn statistics(figures: &Figures) -> Result<()> {
    figures.say("Distributions against mpmath: the worst relative error of each function\n")?;
    let worst = kelir_stats::numerics::worst_errors()?;
    let rows: Vec<Vec<String>> = worst
        .iter()
        .map(|row| {
            vec![
                row.function.to_owned(),
                format!("{:e}", row.size_to),
                row.points.to_string(),
                format!("{:.1e}", row.relative_error),
                format!("{:?}", row.arguments),
            ]
        })
        .collect();
    figures.say(&table(&["function", "sizes to", "points", "relative error", "at"], &rows))?;
    figures
        .say("\nNIST StRD: digits shared with the certified value, and the most that f64 inputs allow\n")?;
    let certified = kelir_stats::numerics::nist()?;
    let rows: Vec<Vec<String>> = certified
        .iter()
        .map(|row| {
            let digits = [row.digits(), row.ceiling()].map(|digits| format!("{digits:.1}"));
            vec![row.set.to_owned(), row.statistic.to_owned(), digits[0].clone(), digits[1].clone()]
        })
        .collect();
    figures.say(&table(&["set", "statistic", "digits", "ceiling"], &rows))?;
    let distributions = worst.iter().map(|row| {
        json!({ "function": row.function, "sizes_to": row.size_to, "points": row.points, "relative_error": row.relative_error,
            "arguments": format!("{:?}", row.arguments) })
    });
    let nist = certified.iter().map(|row| {
        json!({ "set": row.set, "statistic": row.statistic, "digits": row.digits(), "ceiling": row.ceiling() })
    });
    figures.give(
        &json!({ "distributions": distributions.collect::<Vec<_>>(), "nist": nist.collect::<Vec<_>>() }),
    )?;
    if let Some(short) = certified.iter().find(|row| row.digits() < row.ceiling() - 0.5) {
        bail!("{} {} falls short of its ceiling", short.set, short.statistic);
    }
    Ok(())
}
