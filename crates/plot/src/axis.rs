//! Axes: where a value stands on them, and where their ticks are.

use crate::PlotError;

/// How an axis measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By powers of ten.
    Log10,
    /// Names, the k-th at k = 0, 1, ….
    Names(Vec<String>),
}

/// One axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// How it measures.
    pub scale: Scale,
    /// From and to, in the axis's unit; by default what the data need.
    pub range: Option<[f64; 2]>,
}

/// A tick: its place in axis units (log10 of the value on a logarithmic axis) and what is written at it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub at: f64,
    pub text: String,
}

/// An axis fitted to its data.
#[derive(Clone, Debug)]
pub(crate) struct Fitted {
    log: bool,
    /// From and to, axis units.
    pub span: [f64; 2],
    pub ticks: Vec<Tick>,
    /// Between the ticks of a logarithmic axis: 2, 3, … 9 of each decade.
    pub minor: Vec<f64>,
}

impl Axis {
    /// A linear axis that fits its data.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis that fits its data.
    pub fn log10(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log10, range: None }
    }

    /// An axis of names.
    pub fn names(label: impl Into<String>, names: Vec<String>) -> Self {
        Self { label: label.into(), scale: Scale::Names(names), range: None }
    }

    /// This axis with ends of its own.
    pub fn within(self, low: f64, high: f64) -> Self {
        Self { range: Some([low, high]), ..self }
    }

    /// Fits the axis to finite values; those of a logarithmic axis are above 0.
    pub(crate) fn fit(&self, values: &[f64]) -> Result<Fitted, PlotError> {
        if let Some([low, high]) = self.range
            && (!(low.is_finite() && high.is_finite() && low < high)
                || self.scale == Scale::Log10 && low <= 0.0)
        {
            return Err(PlotError::Range { axis: self.label.clone(), low, high });
        }
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let fitted = match &self.scale {
            Scale::Linear => linear(self.range, least, most),
            Scale::Log10 => logarithmic(self.range, least, most),
            Scale::Names(names) => {
                let ticks =
                    names.iter().enumerate().map(|(k, name)| Tick { at: k as f64, text: name.clone() });
                let span = self.range.unwrap_or([-0.5, names.len().max(1) as f64 - 0.5]);
                Fitted { log: false, span, ticks: ticks.collect(), minor: Vec::new() }
            }
        };
        Ok(fitted)
    }
}

impl Fitted {
    /// Axis units of a value.
    pub(crate) fn place(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }
}

fn linear(range: Option<[f64; 2]>, least: f64, most: f64) -> Fitted {
    let [low, high] = range.unwrap_or_else(|| {
        if least > most {
            return [0.0, 1.0];
        }
        let margin = if most > least { 0.06 * (most - least) } else { 0.5 * least.abs().max(1.0) };
        [least - margin, most + margin]
    });
    let step = round_step((high - low) / 5.0);
    let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    let first = (low / step).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    // Numbers beyond what decimals can say are written as powers.
    let text = |at: f64| {
        if step >= 1e6 || decimals >= 7 { format!("{at:.1e}") } else { format!("{at:.decimals$}") }
    };
    let ticks = (first..=last).map(|k| k as f64 * step).map(|at| Tick { at, text: minus(&text(at)) });
    Fitted { log: false, span: [low, high], ticks: ticks.collect(), minor: Vec::new() }
}

/// 1, 2 or 5 times a power of ten, near what is asked.
fn round_step(about: f64) -> f64 {
    let power = 10f64.powf(about.log10().floor());
    let times = about / power;
    power * [1.0, 2.0, 5.0].into_iter().find(|round| times < 1.5 * round).unwrap_or(10.0)
}

fn logarithmic(range: Option<[f64; 2]>, least: f64, most: f64) -> Fitted {
    let [low, high] = match range {
        Some(range) => range.map(f64::log10),
        None if least > most => [-1.0, 1.0],
        None => {
            // At least 0.8 of a decade, so that a tick falls inside.
            let decades = most.log10() - least.log10();
            let margin = (0.06 * decades).max(0.4 - 0.5 * decades);
            [least.log10() - margin, most.log10() + margin]
        }
    };
    let decades = || low.floor() as i32..=high.ceil() as i32;
    let inside = |at: &f64| (low - 1e-9..=high + 1e-9).contains(at);
    let minor: Vec<f64> = decades()
        .flat_map(|decade| (2..=9).map(move |k| f64::from(decade) + f64::from(k).log10()))
        .filter(inside)
        .collect();
    let whole = decades().filter(|decade| inside(&f64::from(*decade))).count();
    // Every decade, or every second or third if there are many; 2 and 5 too if there are few.
    let every = whole.div_ceil(8).max(1) as i32;
    let mut ticks: Vec<Tick> = decades()
        .filter(|decade| decade % every == 0 && inside(&f64::from(*decade)))
        .map(|decade| Tick { at: f64::from(decade), text: power(decade) })
        .collect();
    if whole < 3 {
        let between = decades()
            .flat_map(|decade| [2, 5].map(|k| (f64::from(decade) + f64::from(k).log10(), k, decade)));
        ticks.extend(
            between
                .filter(|(at, ..)| inside(at))
                .map(|(at, k, decade)| Tick { at, text: multiple(k, decade) }),
        );
        ticks.sort_by(|a, b| a.at.total_cmp(&b.at));
    }
    Fitted { log: true, span: [low, high], ticks, minor }
}

/// 10ⁿ as a reader writes it.
fn power(decade: i32) -> String {
    multiple(1, decade)
}

fn multiple(k: i32, decade: i32) -> String {
    if (-3..=4).contains(&decade) {
        let decimals = (-decade).max(0) as usize;
        return format!("{:.decimals$}", f64::from(k) * 10f64.powi(decade));
    }
    let raised: String = decade.to_string().chars().map(superscript).collect();
    if k == 1 { format!("10{raised}") } else { format!("{k}·10{raised}") }
}

fn superscript(digit: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    digit.to_digit(10).map_or('⁻', |d| DIGITS[d as usize])
}

/// A minus sign in place of the hyphen, and no "-0".
fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(fitted: &Fitted) -> Vec<&str> {
        fitted.ticks.iter().map(|tick| tick.text.as_str()).collect()
    }

    #[test]
    fn linear_ticks_are_round_and_inside() {
        let fitted = Axis::linear("p").within(0.0, 1.0).fit(&[]).expect("a range");
        assert_eq!(texts(&fitted), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        let fitted = Axis::linear("t").fit(&[-3.0, 4.0]).expect("a range");
        assert_eq!(texts(&fitted), ["−2", "0", "2", "4"]);
    }

    #[test]
    fn decades_are_written_out_while_they_are_short() {
        let fitted = Axis::log10("s").fit(&[1e-5, 10.0]).expect("positive");
        assert_eq!(texts(&fitted), ["10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1", "10"]);
        assert!(fitted.minor.iter().all(|at| at.fract() != 0.0));
        let fitted = Axis::log10("s").fit(&[1.0, 8.0]).expect("positive");
        assert_eq!(texts(&fitted), ["1", "2", "5"]);
    }

    #[test]
    fn a_range_must_hold_something() {
        for [low, high] in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
            assert!(matches!(Axis::linear("x").within(low, high).fit(&[]), Err(PlotError::Range { .. })));
        }
        assert!(matches!(Axis::log10("x").within(0.0, 1.0).fit(&[]), Err(PlotError::Range { .. })));
    }

    #[test]
    fn no_data_and_one_value_still_have_an_axis() {
        for axis in [Axis::linear("x"), Axis::log10("x")] {
            for data in [&[][..], &[3.0]] {
                let fitted = axis.fit(data).expect("an axis");
                assert!(fitted.span[0] < fitted.span[1] && !fitted.ticks.is_empty(), "{fitted:?}");
            }
        }
    }
}
