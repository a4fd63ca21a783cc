//! Laying a [`Figure`] out and writing it as SVG.

use svg::Document;
use svg::node::element::{Circle, Description, Group, Path, Rectangle, Text, Title};

use crate::axis::Fitted;
use crate::labels::{beside, spread};
use crate::{Axis, Figure, PlotError, Point, Rule, Scale, Series};

/// Okabe and Ito's palette without its yellow, which a white page swallows.
pub(crate) const PALETTE: [&str; 7] =
    ["#0072b2", "#d55e00", "#009e73", "#b0588f", "#1a1a1a", "#3b9ad0", "#c07f00"];
pub(crate) const INK: &str = "#282828";
pub(crate) const GRID: &str = "#dedede";
const FAINT: &str = "#f1f1f1";
pub(crate) const FONT_PX: f64 = 13.0;

/// A place on the page, px from its left upper corner.
type Place = (f64, f64);

/// The figure as an SVG document with a title and a description for screen readers; the ground is white.
///
/// Errors: a coordinate that is not finite, or not above 0 on a logarithmic axis; an empty range; a size out of bounds.
pub fn svg(figure: &Figure) -> Result<String, PlotError> {
    let [width, height] = figure.size;
    if width < 200 || height < 150 || width > 10_000 || height > 10_000 {
        return Err(PlotError::Size(width, height));
    }
    let layout = Layout::new(figure)?;
    let names: Vec<&str> =
        figure.series.iter().map(|series| series.name.as_str()).filter(|name| !name.is_empty()).collect();
    let description = format!("{} against {}. {}", figure.y.label, figure.x.label, names.join("; "));
    let document = Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .set("role", "img")
        .set("font-family", "system-ui, sans-serif")
        .set("font-size", FONT_PX)
        .add(Title::new(&figure.title))
        .add(Description::new().add(svg::node::Text::new(description.trim_end())))
        .add(Rectangle::new().set("width", width).set("height", height).set("fill", "#fff"))
        .add(layout.axes(figure))
        .add(layout.data(figure));
    Ok(document.to_string())
}

/// Where everything stands.
struct Layout {
    x: Fitted,
    y: Fitted,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// Checks the values of an axis and fits it to them.
pub(crate) fn fit(axis: &Axis, values: Vec<(String, f64)>) -> Result<Fitted, PlotError> {
    for (what, value) in &values {
        if !value.is_finite() {
            return Err(PlotError::NotFinite { what: what.clone(), value: *value });
        }
        if axis.scale == Scale::Log10 && *value <= 0.0 {
            return Err(PlotError::NotPositive { what: what.clone(), value: *value });
        }
    }
    axis.fit(&values.into_iter().map(|(_, value)| value).collect::<Vec<_>>())
}

/// About how wide a text is, px: the reader's font is not known here.
pub(crate) fn text_width(text: &str) -> f64 {
    text.chars().count() as f64 * FONT_PX * 0.56
}

impl Layout {
    fn new(figure: &Figure) -> Result<Self, PlotError> {
        let (mut xs, mut ys) = (Vec::new(), Vec::new());
        for series in &figure.series {
            for (k, point) in series.points.iter().enumerate() {
                let of = |coordinate: &str| format!("{}[{k}].{coordinate}", series.name);
                xs.push((of("x"), point.x));
                ys.push((of("y"), point.y));
                ys.extend(point.interval.iter().flatten().map(|end| (of("interval"), *end)));
            }
        }
        for rule in &figure.rules {
            match rule {
                Rule::Horizontal(at, name) => ys.push((name.clone(), *at)),
                Rule::Vertical(at, name) => xs.push((name.clone(), *at)),
            }
        }
        let (x, y) = (fit(&figure.x, xs)?, fit(&figure.y, ys)?);
        let [width, height] = figure.size.map(f64::from);
        let beside = figure.series.iter().map(|series| series.name.as_str());
        let beside = beside.chain(figure.rules.iter().filter_map(|rule| match rule {
            Rule::Horizontal(_, name) => Some(name.as_str()),
            Rule::Vertical(..) => None,
        }));
        let beside = beside.map(text_width).fold(0.0, f64::max);
        let left = 44.0 + y.ticks.iter().map(|tick| text_width(&tick.text)).fold(0.0, f64::max);
        let right = (width - 18.0 - beside.min(0.4 * width)).max(left + 60.0);
        Ok(Self { x, y, left, right, top: 44.0, bottom: height - 60.0 })
    }

    /// Page column of an axis place.
    fn column(&self, at: f64) -> f64 {
        let [low, high] = self.x.span;
        self.left + (at - low) / (high - low) * (self.right - self.left)
    }

    /// Page row of an axis place.
    fn row(&self, at: f64) -> f64 {
        let [low, high] = self.y.span;
        self.bottom - (at - low) / (high - low) * (self.bottom - self.top)
    }

    fn place(&self, point: &Point) -> Place {
        (self.column(self.x.place(point.x)), self.row(self.y.place(point.y)))
    }

    /// Grid, ticks, labels and title.
    fn axes(&self, figure: &Figure) -> Group {
        let upright = |at: f64| [(self.column(at), self.top), (self.column(at), self.bottom)];
        let level = |at: f64| [(self.left, self.row(at)), (self.right, self.row(at))];
        let minor =
            self.x.minor.iter().map(|at| upright(*at)).chain(self.y.minor.iter().map(|at| level(*at)));
        let mut group = minor.fold(Group::new(), |group, ends| group.add(line(&ends, FAINT, 1.0)));
        if !matches!(figure.x.scale, Scale::Names(_)) {
            for tick in &self.x.ticks {
                group = group.add(line(&upright(tick.at), GRID, 1.0));
            }
        }
        for tick in &self.y.ticks {
            let at = (self.left - 8.0, self.row(tick.at));
            group = group.add(line(&level(tick.at), GRID, 1.0)).add(text(&tick.text, at, "end", INK));
        }
        // Names that would run into each other stand on two levels.
        let room = (self.right - self.left) / self.x.ticks.len().max(1) as f64;
        let crowded = self.x.ticks.iter().any(|tick| text_width(&tick.text) > room - 6.0);
        for (k, tick) in self.x.ticks.iter().enumerate() {
            let lower = if crowded && k % 2 == 1 { FONT_PX + 1.0 } else { 0.0 };
            let at = (self.column(tick.at), self.bottom + 13.0 + lower);
            group = group.add(text(&tick.text, at, "middle", INK));
        }
        let (middle, centre) = ((self.left + self.right) / 2.0, (self.top + self.bottom) / 2.0);
        let frame = [(self.left, self.top), (self.left, self.bottom), (self.right, self.bottom)];
        group
            .add(line(&frame, INK, 1.0))
            .add(text(&figure.x.label, (middle, f64::from(figure.size[1]) - 12.0), "middle", INK))
            .add(
                text(&figure.y.label, (0.0, 0.0), "middle", INK)
                    .set("transform", format!("translate(16 {centre:.1}) rotate(-90)")),
            )
            .add(
                text(&figure.title, (self.left, 18.0), "start", INK)
                    .set("font-weight", "bold")
                    .set("font-size", FONT_PX + 2.0),
            )
    }

    /// Reference lines, series and their names.
    fn data(&self, figure: &Figure) -> Group {
        let mut group = Group::new();
        let mut names: Vec<(f64, &str, &str)> = Vec::new();
        // The bars lie below the reference lines, which are told in their height.
        for (k, series) in figure.series.iter().enumerate().filter(|(_, series)| series.bars) {
            group = group.add(self.bars(series, PALETTE[k % PALETTE.len()]));
        }
        let mut upright = 0.0;
        for rule in &figure.rules {
            match rule {
                Rule::Horizontal(at, name) => {
                    let at = self.row(self.y.place(*at));
                    group = group.add(dashed(line(&[(self.left, at), (self.right, at)], INK, 1.2)));
                    names.push((at, name, INK));
                }
                Rule::Vertical(at, name) => {
                    let at = self.column(self.x.place(*at));
                    // Each on a line of its own, and to the left where the page ends.
                    let fits = at + 5.0 + text_width(name) < f64::from(figure.size[0]);
                    let (beside, anchor) = if fits { (at + 5.0, "start") } else { (at - 5.0, "end") };
                    let height = self.top + 8.0 + upright * (FONT_PX + 3.0);
                    upright += 1.0;
                    group = group
                        .add(dashed(line(&[(at, height - 8.0), (at, self.bottom)], INK, 1.2)))
                        .add(text(name, (beside, height), anchor, INK));
                }
            }
        }
        for (k, series) in figure.series.iter().enumerate() {
            let colour = PALETTE[k % PALETTE.len()];
            group = group.add(self.series(series, k, colour));
            if let Some(last) = series.points.last()
                && !series.name.is_empty()
            {
                names.push((self.place(last).1, &series.name, colour));
            }
        }
        group = self.labels(figure, group);
        let wanted: Vec<f64> = names.iter().map(|(at, ..)| *at).collect();
        let heights = spread(&wanted, FONT_PX + 3.0, [self.top, self.bottom]);
        names.iter().zip(heights).fold(group, |group, ((_, name, colour), at)| {
            group.add(text(name, (self.right + 8.0, at), "start", colour))
        })
    }

    /// The points' own labels: bars' above them, over what crosses there; the others' beside their points, none over another.
    fn labels(&self, figure: &Figure, group: Group) -> Group {
        let bars = figure.series.iter().filter(|series| series.bars).flat_map(|series| &series.points);
        let group = bars.fold(group, |group, point| {
            let (x, y) = self.place(point);
            let label = point.label.as_deref().unwrap_or_default();
            group.add(haloed(text(label, (x, y - 9.0), "middle", INK)))
        });
        let all =
            figure.series.iter().enumerate().flat_map(|(k, s)| s.points.iter().map(move |point| (k, point)));
        let all = all.filter(|(k, _)| !figure.series[*k].bars);
        let all: Vec<(usize, &Point)> =
            all.filter(|(k, p)| p.label.is_some() || figure.series[*k].markers).collect();
        let width = |point: &Point| point.label.as_deref().map_or(0.0, text_width);
        let places: Vec<(f64, f64, f64)> = all
            .iter()
            .map(|(_, point)| {
                let (x, y) = self.place(point);
                (x, y, width(point))
            })
            .collect();
        let found = beside(&places, FONT_PX + 3.0, [self.left, self.right + 4.0]);
        all.iter().zip(found).fold(group, |group, ((k, point), at)| match &point.label {
            Some(label) => group.add(text(label, at, "start", PALETTE[k % PALETTE.len()])),
            None => group,
        })
    }

    fn bars(&self, series: &Series, colour: &str) -> Group {
        let width = (0.62 * (self.column(1.0) - self.column(0.0))).min(64.0);
        series.points.iter().fold(Group::new(), |group, point| {
            let (x, y) = self.place(point);
            let bar = Rectangle::new().set("x", px(x - width / 2.0)).set("y", px(y));
            let bar = bar.set("width", px(width)).set("height", px(self.bottom - y));
            group.add(bar.set("fill", colour))
        })
    }

    fn series(&self, series: &Series, k: usize, colour: &str) -> Group {
        let places: Vec<Place> = series.points.iter().map(|point| self.place(point)).collect();
        let mut group = Group::new();
        if series.line && places.len() > 1 {
            let line = line(&places, colour, 2.0);
            group = group.add(if series.dashed { dashed(line) } else { line });
        }
        for (point, (x, y)) in series.points.iter().zip(&places) {
            if let Some(ends) = point.interval {
                let [low, high] = ends.map(|end| self.row(self.y.place(end)));
                group = group.add(line(&[(*x, low), (*x, high)], colour, 1.6));
                for end in [low, high] {
                    group = group.add(line(&[(x - 4.0, end), (x + 4.0, end)], colour, 1.6));
                }
            }
            if series.markers {
                group = match k % 5 {
                    0 => group.add(
                        Circle::new().set("cx", px(*x)).set("cy", px(*y)).set("r", 4).set("fill", colour),
                    ),
                    kind => group.add(marker(kind, (*x, *y), colour)),
                };
            }
        }
        group
    }
}

/// Tenths of a px: finer is not seen.
pub(crate) fn px(at: f64) -> f64 {
    (at * 10.0).round() / 10.0
}

fn outline(places: &[Place]) -> String {
    let steps = places.iter().enumerate().map(|(k, (x, y))| {
        let step = if k == 0 { 'M' } else { 'L' };
        format!("{step}{} {}", px(*x), px(*y))
    });
    steps.collect()
}

pub(crate) fn line(places: &[Place], colour: &str, width: f64) -> Path {
    Path::new().set("d", outline(places)).set("fill", "none").set("stroke", colour).set("stroke-width", width)
}

/// Readable over a line: the ground shows around its letters.
fn haloed(text: Text) -> Text {
    text.set("stroke", "#fff").set("stroke-width", 4).set("paint-order", "stroke")
}

pub(crate) fn dashed(line: Path) -> Path {
    line.set("stroke-dasharray", "6 4")
}

/// A mark of its own for each series, so that grey print tells them apart; kind 0, a disk, is drawn by the caller.
fn marker(kind: usize, (x, y): Place, colour: &str) -> Path {
    let at = |offsets: &[Place]| offsets.iter().map(|(dx, dy)| (x + dx, y + dy)).collect::<Vec<_>>();
    let shape = match kind {
        1 => at(&[(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)]),
        2 => at(&[(-5.0, 4.0), (5.0, 4.0), (0.0, -5.0)]),
        3 => at(&[(-5.0, 0.0), (0.0, -5.0), (5.0, 0.0), (0.0, 5.0)]),
        _ => {
            let strokes = [at(&[(-4.0, -4.0), (4.0, 4.0)]), at(&[(-4.0, 4.0), (4.0, -4.0)])];
            let cross: String = strokes.iter().map(|stroke| outline(stroke)).collect();
            return Path::new()
                .set("d", cross)
                .set("fill", "none")
                .set("stroke", colour)
                .set("stroke-width", 2);
        }
    };
    Path::new().set("d", outline(&shape) + "Z").set("fill", colour)
}

pub(crate) fn text(content: &str, (x, y): Place, anchor: &str, colour: &str) -> Text {
    Text::new(content)
        .set("x", px(x))
        .set("y", px(y))
        .set("text-anchor", anchor)
        .set("dy", "0.35em")
        .set("fill", colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure() -> Figure {
        let points =
            |k: f64| (1..5).map(move |n| Point { x: f64::from(n), y: k / f64::from(n), ..Point::default() });
        let series = |name: &str, k: f64| Series {
            name: name.into(),
            points: points(k).collect(),
            line: true,
            markers: true,
            ..Series::default()
        };
        Figure {
            title: "error & time <x>".into(),
            x: Axis::log10("time, s"),
            y: Axis::log10("RMSE"),
            series: vec![series("PA", 1.0), series("MC", 3.0)],
            rules: vec![Rule::Horizontal(0.5, "floor".into())],
            size: [640, 400],
        }
    }

    #[test]
    fn a_figure_names_its_series_and_escapes_its_texts() {
        let document = svg(&figure()).expect("finite");
        for text in ["PA", "MC", "floor", "time, s", "error &amp; time &lt;x&gt;", "<title>", "<desc>"] {
            assert!(document.contains(text), "{text}");
        }
        assert!(!document.contains("<x>"));
    }

    #[test]
    fn points_stand_where_their_axes_say() {
        let figure = figure();
        let layout = Layout::new(&figure).expect("finite");
        // On logarithmic axes a power law is straight: the slopes between neighbours agree.
        let places: Vec<Place> = figure.series[0].points.iter().map(|point| layout.place(point)).collect();
        let slope = |a: Place, b: Place| (b.1 - a.1) / (b.0 - a.0);
        let slopes: Vec<f64> = places.windows(2).map(|pair| slope(pair[0], pair[1])).collect();
        assert!(slopes.iter().all(|s| (s - slopes[0]).abs() < 1e-9), "{slopes:?}");
        assert!(slopes[0] > 0.0, "a falling error runs down the page");
        let mut linear = figure;
        linear.y = Axis::linear("RMSE");
        let layout = Layout::new(&linear).expect("finite");
        let places: Vec<Place> = linear.series[0].points.iter().map(|point| layout.place(point)).collect();
        assert!((slope(places[0], places[1]) - slope(places[2], places[3])).abs() > 0.1);
    }

    #[test]
    fn what_has_no_place_is_refused_by_name() {
        let mut bad = figure();
        bad.series[1].points[2].y = f64::NAN;
        assert!(matches!(svg(&bad), Err(PlotError::NotFinite { what, .. }) if what == "MC[2].y"));
        let mut bad = figure();
        bad.series[0].points[0].x = 0.0;
        assert_eq!(svg(&bad), Err(PlotError::NotPositive { what: "PA[0].x".into(), value: 0.0 }));
        assert_eq!(svg(&Figure { size: [10, 10], ..figure() }), Err(PlotError::Size(10, 10)));
    }

    #[test]
    fn a_bar_is_as_high_as_its_number_and_lines_are_named_apart() {
        let bar = |x: f64, y: f64| Point { x, y, interval: None, label: Some(y.to_string()) };
        let figure = Figure {
            title: "counts".into(),
            x: Axis::names("choices", ["0", "1", "2"].map(String::from).to_vec()),
            y: Axis::linear("participants").within(0.0, 28.0),
            series: vec![Series {
                points: vec![bar(0.0, 12.0), bar(1.0, 14.0), bar(2.0, 0.0)],
                bars: true,
                ..Series::default()
            }],
            rules: vec![Rule::Vertical(1.9, "mean 1.9".into()), Rule::Vertical(2.0, "a long name".into())],
            size: [300, 240],
        };
        let document = svg(&figure).expect("finite");
        let attribute = |tag: &str, name: &str| -> f64 {
            let rest = tag.split(&format!("{name}=\"")).nth(1).expect(name);
            rest.split('"').next().expect("quoted").parse().expect("a number")
        };
        // The first rectangle is the ground.
        let bars: Vec<f64> = document.split("<rect").skip(2).map(|tag| attribute(tag, " height")).collect();
        assert_eq!(bars.len(), 3);
        assert!((bars[0] / bars[1] - 12.0 / 14.0).abs() < 0.01 && bars[2] == 0.0, "{bars:?}");
        let texts: Vec<&str> = document.split("<text").collect();
        let named = |name: &str| texts.iter().find(|t| t.contains(name)).copied().expect(name);
        assert!(attribute(named("a long name"), " y") > attribute(named("mean 1.9"), " y") + FONT_PX);
        assert!(named("a long name").contains("\"end\""), "what would leave the page stands to the left");
    }

    #[test]
    fn an_empty_figure_is_still_a_figure() {
        let empty = Figure { series: Vec::new(), rules: Vec::new(), ..figure() };
        assert!(svg(&empty).expect("no data is no error").contains("</svg>"));
    }
}
