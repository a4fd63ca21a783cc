//! Plots that say it faster than tables.

use crate::document::{Figure, Piece};
use crate::format::{fixed, percent, range, share};
use crate::{PhysicalError, StudyReport};
use kelir_plot::{Axis, Estimate, Forest, Point, Rule, Series, forest, svg};
use kelir_stats::inference::{Interval, ShareEquivalence};
use kelir_stats::paper::Comparison;
use kelir_study::report::{ALPHA, BlockReport, Proportion};

/// Width of every figure, px: on a phone it is shown at six tenths and its letters can still be read.
const WIDTH: u32 = 560;
const HEIGHT: u32 = 380;

/// A figure, or a sentence that says why it could not be drawn.
fn drawn(name: &str, caption: String, picture: Result<String, kelir_plot::PlotError>) -> Piece {
    match picture {
        Ok(svg) => Piece::Figure(Figure { name: name.to_owned(), caption, svg }),
        Err(error) => Piece::Text(format!("No figure of {name}: {error}.")),
    }
}

/// Shares of target choices: each block over all its choices, then each pair alone. `None` without answers.
pub(crate) fn choices(blocks: &[BlockReport]) -> Option<Piece> {
    let row = |label: String, found: Option<&Proportion>, strong| {
        let interval = found.and_then(Proportion::interval);
        Estimate {
            label,
            value: found.map(|p| p.proportion),
            interval: interval.map(|i| [i.low, i.high]),
            text: found.map_or("no answers".to_owned(), |p| share(p.proportion, interval)),
            strong,
        }
    };
    let mut rows = Vec::new();
    for block in blocks.iter().filter(|b| b.first.is_some()) {
        let summary = &block.summary;
        let [a, b] = &summary.conditions;
        let other = if *a == summary.target { b } else { a };
        let head = Estimate { label: summary.id.clone(), strong: true, ..Estimate::default() };
        rows.push(head);
        rows.push(row(format!("{} over {other}", summary.target), block.analysis.proportion.as_ref(), true));
        if block.by_item.len() > 1 {
            rows.extend(block.by_item.iter().map(|pair| row(pair.id.clone(), pair.target.as_ref(), false)));
        }
    }
    if rows.is_empty() {
        return None;
    }
    let figure = Forest {
        title: "Share of choices, 95% intervals".to_owned(),
        axis: Axis::linear("share of choices").within(0.0, 1.0),
        rule: Some((0.5, "chance".to_owned())),
        rows,
        width: WIDTH,
    };
    let caption = "Share of choices of the counted condition with its 95% interval. Orange: a whole block, over all its choices. Blue: one pair. \
         Intervals are over participants. Dashed: chance.";
    Some(drawn("choices", caption.to_owned(), forest(&figure)))
}

/// Most bars that are named one by one.
const MOST_NAMED: usize = 20;

/// How many participants of a block chose its target how often. `None` without answers.
pub(crate) fn distribution(block: &BlockReport) -> Option<Piece> {
    let summary = &block.summary;
    let most = summary.counts.values().max().filter(|most| **most > 0)?;
    let bars = (0..=summary.items).map(|k| {
        let people = summary.counts.get(&(k as u32)).copied().unwrap_or(0);
        Point { x: k as f64, y: people as f64, interval: None, label: Some(people.to_string()) }
    });
    let label = format!("choices of {}, of {}", summary.target, summary.items);
    let ends = [-0.5, summary.items as f64 + 0.5];
    let x = match summary.items {
        0..=MOST_NAMED => Axis::names(label, (0..=summary.items).map(|k| k.to_string()).collect()),
        _ => Axis::linear(label).within(ends[0], ends[1]),
    };
    let mean = summary.mean.map(|mean| Rule::Vertical(mean, format!("mean {}", fixed(mean, 2))));
    let chance = Rule::Vertical(summary.mu, format!("chance {}", fixed(summary.mu, 1)));
    let figure = kelir_plot::Figure {
        title: format!("{}: choices of {} per participant", summary.id, summary.target),
        x,
        // Room above the bars for their numbers and the names of the lines.
        y: Axis::linear("participants").within(0.0, 1.4 * *most as f64),
        series: vec![Series { points: bars.collect(), bars: true, ..Series::default() }],
        rules: mean.into_iter().chain([chance]).collect(),
        size: [WIDTH, 300],
    };
    let caption = format!(
        "How many participants chose {} how often, of those who answered every pair of the block. Dashed: their mean, and chance, half the pairs.",
        summary.target
    );
    Some(drawn(&format!("distribution-{}", file_name(&summary.id)), caption, svg(&figure)))
}

/// All conditions on one axis.
pub(crate) fn scale(report: &StudyReport) -> Option<Piece> {
    let found = report.report.scale.as_ref()?;
    let mut conditions = found.conditions.clone();
    conditions.sort_by(|a, b| b.jod.total_cmp(&a.jod));
    let rows = conditions.iter().map(|c| Estimate {
        label: c.condition.clone(),
        value: Some(c.jod),
        interval: c.low.zip(c.high).map(|(low, high)| [low, high]),
        text: c.low.zip(c.high).map_or_else(
            || fixed(c.jod, 2),
            |(low, high)| format!("{}, {}", fixed(c.jod, 2), range(low, high, 2)),
        ),
        strong: false,
    });
    let figure = Forest {
        title: "Positions of the conditions, 95% intervals".to_owned(),
        axis: Axis::linear("JOD; more is chosen more often"),
        rule: Some((0.0, "mean".to_owned())),
        rows: rows.collect(),
        width: WIDTH,
    };
    let caption = format!(
        "Positions in just-objectionable differences: 1 JOD apart is a choice by 75%. Lines: {} intervals from leaving out each of {} participants in turn. Overlapping \
         intervals are no test: differences are tested in the table.",
        percent(found.level),
        found.observers
    );
    Some(drawn("scale", caption, forest(&figure)))
}

/// The tests of a comparison of the paper by the bound of equivalence: each one-sided test, and that of a difference.
pub(crate) fn equivalence(of: &Comparison) -> Piece {
    let line = |name: &str, dashed, p: &dyn Fn(&ShareEquivalence) -> f64| Series {
        name: name.to_owned(),
        points: of.equivalence.iter().map(|e| Point { x: e.within, y: p(e), ..Point::default() }).collect(),
        line: true,
        dashed,
        ..Series::default()
    };
    let figure = kelir_plot::Figure {
        title: format!("{}: p by bound", of.id),
        x: Axis::linear("bound on the share, ±").within(0.0, 0.5),
        y: Axis::linear("p").within(0.0, 1.0),
        series: vec![
            line("above ½ − bound", false, &|e| e.tests.p_lower),
            line("below ½ + bound", false, &|e| e.tests.p_upper),
            line("difference", true, &|_| of.test.p),
        ],
        rules: vec![Rule::Horizontal(ALPHA, fixed(ALPHA, 2))],
        size: [WIDTH, 300],
    };
    let caption = format!(
        "{}: p of the two one-sided t-tests of equivalence to a half, by how far from it PA's share may lie. Equivalence is shown where both lie under the \
         line at {ALPHA}. Dashed: the two-sided t-test of a difference, which has no bound.",
        of.title
    );
    drawn(&format!("equivalence-{}", of.id), caption, svg(&figure))
}

/// A block's psychometric function with its data.
pub(crate) fn psychometric(block: &BlockReport) -> Option<Piece> {
    let found = block.psychometric.as_ref()?;
    let data = found.points.iter().filter_map(|point| {
        let share = point.target.as_ref()?;
        let interval = share.interval().map(|i| [i.low, i.high]);
        Some(Point { x: point.level, y: share.proportion, interval, label: None })
    });
    let data: Vec<Point> = data.collect();
    if data.is_empty() {
        return None;
    }
    let mut series = vec![Series { points: data, markers: true, ..Series::default() }];
    let mut rules = vec![Rule::Horizontal(found.guess, "guessing".to_owned())];
    if let Some(fit) = &found.fit {
        let points = fit.curve.iter().map(|p| Point { x: p.level, y: p.share, ..Point::default() });
        series.push(Series { points: points.collect(), line: true, ..Series::default() });
        rules.push(Rule::Vertical(fit.threshold.value, "threshold".to_owned()));
    }
    let level = match &found.asked.unit {
        Some(unit) => format!("{}, {unit}", found.asked.label),
        None => found.asked.label.clone(),
    };
    let figure = kelir_plot::Figure {
        title: format!("{}: choices of {} by level", block.summary.id, block.summary.target),
        x: Axis::linear(level),
        y: Axis::linear("share of choices").within(0.0, 1.0),
        series,
        rules,
        size: [WIDTH, HEIGHT],
    };
    let caption = "Dots: share of choices at each level with its 95% interval over participants. Curve: the psychometric function where its posterior is highest. Dashed: guessing, and \
         the threshold, halfway between guessing and lapsing.";
    Some(drawn(&format!("psychometric-{}", file_name(&block.summary.id)), caption.to_owned(), svg(&figure)))
}

/// How long answers took: cumulative shares, one line a block.
pub(crate) fn times(blocks: &[BlockReport]) -> Option<Piece> {
    let series: Vec<Series> = blocks
        .iter()
        .filter(|block| !block.rt_percentiles_ms.is_empty())
        .map(|block| {
            let points = block.rt_percentiles_ms.iter().enumerate().map(|(k, ms)| Point {
                x: ms / 1000.0,
                y: (k + 1) as f64 / 100.0,
                ..Point::default()
            });
            let name = block.summary.id.clone();
            Series { name, points: points.collect(), line: true, ..Series::default() }
        })
        .collect();
    if series.is_empty() {
        return None;
    }
    let most = series.iter().flat_map(|s| s.points.last()).map(|p| p.x).fold(0.001, f64::max);
    let figure = kelir_plot::Figure {
        title: "Share of answers given within a time".to_owned(),
        x: Axis::linear("response time, s").within(0.0, 1.04 * most),
        y: Axis::linear("share of answers so far").within(0.0, 1.0),
        series,
        rules: vec![Rule::Horizontal(0.5, "median".to_owned())],
        size: [WIDTH, HEIGHT],
    };
    let caption = "Share of answers given within a time, from the 1st to the 99th percentile of each block. Where a line crosses the dashed one lies its median.";
    Some(drawn("response-times", caption.to_owned(), svg(&figure)))
}

/// A stimulus with a measured error and answers.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Judged<'a> {
    pub pair: &'a str,
    pub condition: &'a str,
    pub error: PhysicalError,
    /// Share of choices that preferred it to the other of its pair.
    pub share: f64,
    pub interval: Option<Interval>,
}

/// Every stimulus with a measured error and answers.
pub(crate) fn judged(report: &StudyReport) -> Vec<Judged<'_>> {
    let mut found = Vec::new();
    for block in &report.report.blocks {
        for pair in &block.by_item {
            let Some(target) = &pair.target else { continue };
            for stimulus in report
                .smallest()
                .filter(|s| s.item == pair.id && block.summary.conditions.contains(&s.condition))
            {
                let Some(error) = stimulus.error() else { continue };
                let turned =
                    |Interval { low, high, level }| Interval { low: 1.0 - high, high: 1.0 - low, level };
                let (share, interval) = if stimulus.condition == block.summary.target {
                    (target.proportion, target.interval())
                } else {
                    (1.0 - target.proportion, target.interval().map(turned))
                };
                found.push(Judged { pair: &pair.id, condition: &stimulus.condition, error, share, interval });
            }
        }
    }
    found
}

/// The physical error of each stimulus against the share that preferred it.
pub(crate) fn errors(report: &StudyReport) -> Option<Piece> {
    let all = judged(report);
    if all.is_empty() {
        return None;
    }
    let mut kinds: Vec<(&str, bool)> = all.iter().map(|j| (j.condition, j.error.own)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let series = kinds.iter().map(|(condition, own)| {
        let points = all.iter().filter(|j| (j.condition, j.error.own) == (*condition, *own)).map(|j| Point {
            x: j.error.rms,
            y: j.share,
            interval: j.interval.map(|i| [i.low, i.high]),
            // The pair is named once, at the stimulus that was measured.
            label: (!own).then(|| j.pair.to_owned()),
        });
        let name = if *own { format!("{condition} (own noise)") } else { (*condition).to_owned() };
        Series { name, points: points.collect(), markers: true, ..Series::default() }
    });
    let figure = kelir_plot::Figure {
        title: "Preference against physical error".to_owned(),
        x: Axis::log10("RMS error, share of full scale (log axis)"),
        y: Axis::linear("share that preferred it").within(0.0, 1.0),
        series: series.collect(),
        rules: vec![Rule::Horizontal(0.5, "chance".to_owned())],
        size: [WIDTH, HEIGHT],
    };
    let caption = "Each stimulus: its error in penumbra against its reference, or its own standard error (own noise) where it is the reference; of simulated \
         photographs before the camera. Upwards the share of participants who preferred it to the other of its pair, with its 95% interval over \
         participants. Labels name pairs, colours and marks conditions.";
    Some(drawn("errors", caption.to_owned(), svg(&figure)))
}

/// An id as a file's name: study files allow nothing dangerous in ids, but a name must not depend on that.
fn file_name(id: &str) -> String {
    id.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' }).collect()
}
