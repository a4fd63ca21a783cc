//! Estimates with their intervals, one a row: the names have room to be read, however many rows there are.

use svg::Document;
use svg::node::element::{Circle, Description, Group, Rectangle, Title};

use crate::draw::{FONT_PX, GRID, INK, PALETTE, dashed, line, px, text, text_width};
use crate::{Axis, PlotError, Scale};

/// One estimate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Estimate {
    /// What it is of; what does not fit is cut off with an ellipsis.
    pub label: String,
    /// Where it lies on the axis; none is a row that only says its text.
    pub value: Option<f64>,
    /// Lower and upper end of its interval.
    pub interval: Option<[f64; 2]>,
    /// The numbers as text, at the right.
    pub text: String,
    /// A row that sums up the rows below it; with neither value nor text, a heading over them.
    pub strong: bool,
}

/// A figure of estimates to draw with [`forest`].
#[derive(Clone, Debug, PartialEq)]
pub struct Forest {
    /// Above the figure, and its accessible name.
    pub title: String,
    /// The horizontal axis; one of names has no meaning here and counts as linear.
    pub axis: Axis,
    /// A value to compare with, dashed, with its name.
    pub rule: Option<(f64, String)>,
    /// From the top down.
    pub rows: Vec<Estimate>,
    /// Width, px; the height follows from the rows.
    pub width: u32,
}

const ROW_PX: f64 = 26.0;
const TOP_PX: f64 = 52.0;

/// The figure as an SVG document with a title and a description for screen readers; the ground is white.
///
/// Errors: a number that is not finite, or not above 0 on a logarithmic axis; an empty range; a width out of bounds.
pub fn forest(figure: &Forest) -> Result<String, PlotError> {
    let width = f64::from(figure.width);
    let height = TOP_PX + ROW_PX * figure.rows.len() as f64 + 54.0;
    if figure.width < 200 || figure.width > 10_000 || height > 100_000.0 {
        return Err(PlotError::Size(figure.width, height as u32));
    }
    let mut values = Vec::new();
    for row in &figure.rows {
        values.extend(row.value.map(|value| (row.label.clone(), value)));
        values.extend(row.interval.iter().flatten().map(|end| (format!("{}.interval", row.label), *end)));
    }
    values.extend(figure.rule.iter().map(|(at, name)| (name.clone(), *at)));
    let axis = match figure.axis.scale {
        Scale::Names(_) => Axis { scale: Scale::Linear, ..figure.axis.clone() },
        _ => figure.axis.clone(),
    };
    let fitted = crate::draw::fit(&axis, values)?;

    // Bold letters are wider by a tenth.
    let wide = |row: &Estimate, of: &str| text_width(of) * if row.strong { 1.1 } else { 1.0 };
    let longest =
        |of: fn(&Estimate) -> &str| figure.rows.iter().map(|row| wide(row, of(row))).fold(0.0, f64::max);
    let names = longest(|row| &row.label).min(0.42 * width);
    let left = 12.0 + names + 14.0;
    let right = (width - longest(|row| &row.text).min(0.34 * width) - 22.0).max(left + 40.0);
    let bottom = TOP_PX + ROW_PX * figure.rows.len() as f64;
    let [low, high] = fitted.span;
    let column =
        |value: f64| left + ((fitted.place(value) - low) / (high - low)).clamp(0.0, 1.0) * (right - left);

    let mut group = Group::new();
    for tick in &fitted.ticks {
        let at = left + (tick.at - low) / (high - low) * (right - left);
        group = group.add(line(&[(at, TOP_PX), (at, bottom)], GRID, 1.0)).add(text(
            &tick.text,
            (at, bottom + 14.0),
            "middle",
            INK,
        ));
    }
    if let Some((value, name)) = &figure.rule {
        let at = column(*value);
        group = group.add(dashed(line(&[(at, TOP_PX - 4.0), (at, bottom)], INK, 1.2))).add(text(
            name,
            (at, TOP_PX - 12.0),
            "middle",
            INK,
        ));
    }
    for (k, row) in figure.rows.iter().enumerate() {
        let middle = TOP_PX + ROW_PX * (k as f64 + 0.5);
        let (colour, weight) = if row.strong { (PALETTE[1], "bold") } else { (PALETTE[0], "normal") };
        let label = shortened(&row.label, names / if row.strong { 1.1 } else { 1.0 } + 4.0);
        group = group
            .add(text(&label, (12.0, middle), "start", INK).set("font-weight", weight))
            .add(text(&row.text, (right + 12.0, middle), "start", INK).set("font-weight", weight));
        if let Some(ends) = row.interval {
            let [low, high] = ends.map(column);
            group = group.add(line(&[(low, middle), (high, middle)], colour, 2.0));
            for end in [low, high] {
                group = group.add(line(&[(end, middle - 4.0), (end, middle + 4.0)], colour, 2.0));
            }
        }
        if let Some(value) = row.value {
            let radius = if row.strong { 5.5 } else { 4.5 };
            group = group.add(
                Circle::new()
                    .set("cx", px(column(value)))
                    .set("cy", px(middle))
                    .set("r", radius)
                    .set("fill", colour),
            );
        }
    }
    let rows: Vec<String> = figure.rows.iter().map(|row| format!("{}: {}", row.label, row.text)).collect();
    let document = Document::new()
        .set("viewBox", (0, 0, figure.width, height as u32))
        .set("width", figure.width)
        .set("height", height as u32)
        .set("role", "img")
        .set("font-family", "system-ui, sans-serif")
        .set("font-size", FONT_PX)
        .add(Title::new(&figure.title))
        .add(Description::new().add(svg::node::Text::new(format!("{}. {}", axis.label, rows.join("; ")))))
        .add(Rectangle::new().set("width", figure.width).set("height", height).set("fill", "#fff"))
        .add(group)
        .add(line(&[(left, bottom), (right, bottom)], INK, 1.0))
        .add(text(&axis.label, ((left + right) / 2.0, height - 14.0), "middle", INK))
        .add(
            text(&figure.title, (12.0, 16.0), "start", INK)
                .set("font-weight", "bold")
                .set("font-size", FONT_PX + 2.0),
        );
    Ok(document.to_string())
}

/// The text cut to about so many px.
fn shortened(name: &str, room: f64) -> String {
    if text_width(name) <= room {
        return name.to_owned();
    }
    let fits = (room / text_width("x")) as usize;
    let kept: String = name.chars().take(fits.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(value: f64) -> Forest {
        let row = |label: &str, strong| Estimate {
            label: label.to_owned(),
            value: Some(value),
            interval: Some([value - 0.1, value + 0.1]),
            text: "a & b".to_owned(),
            strong,
        };
        Forest {
            title: "shares <b>".to_owned(),
            axis: Axis::linear("share").within(0.0, 1.0),
            rule: Some((0.5, "chance".to_owned())),
            rows: vec![
                row("all", true),
                row("a name that is much too long to stand beside its estimate, whatever is done", false),
            ],
            width: 500,
        }
    }

    /// The x of every disk.
    fn disks(document: &str) -> Vec<f64> {
        let of = |part: &str| part.split('"').next().and_then(|x| x.parse().ok());
        document.split("cx=\"").skip(1).filter_map(of).collect()
    }

    #[test]
    fn an_estimate_stands_where_its_value_says_and_texts_are_escaped() {
        let at = |value: f64| disks(&forest(&figure(value)).expect("finite"))[0];
        let (quarter, half, three) = (at(0.25), at(0.5), at(0.75));
        assert!(
            ((three - half) - (half - quarter)).abs() < 0.11 && half - quarter > 20.0,
            "{quarter} {half} {three}"
        );
        let document = forest(&figure(0.4)).expect("finite");
        for text in ["chance", "a &amp; b", "shares &lt;b&gt;", "…", "<desc>"] {
            assert!(document.contains(text), "{text}");
        }
    }

    #[test]
    fn what_has_no_place_is_refused_and_no_rows_are_no_error() {
        assert!(matches!(forest(&figure(f64::NAN)), Err(PlotError::NotFinite { .. })));
        assert!(matches!(forest(&Forest { width: 10, ..figure(0.4) }), Err(PlotError::Size(10, _))));
        assert!(forest(&Forest { rows: Vec::new(), ..figure(0.4) }).expect("empty").contains("</svg>"));
    }
}
