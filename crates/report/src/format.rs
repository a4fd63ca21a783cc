//! Numbers as a reader expects them: a true minus, no more digits than mean something, a dash for what is missing.

use kelir_stats::inference::Interval;

/// What stands for a number that is not defined.
pub(crate) const MISSING: &str = "–";

/// A number with so many decimals.
pub(crate) fn fixed(x: f64, decimals: usize) -> String {
    if !x.is_finite() {
        return match x {
            x if x.is_nan() => MISSING.to_owned(),
            x if x > 0.0 => "∞".to_owned(),
            _ => "−∞".to_owned(),
        };
    }
    let text = format!("{x:.decimals$}");
    // −0.00 is a rounding's artefact.
    let zero = text.bytes().all(|b| matches!(b, b'-' | b'0' | b'.'));
    if zero { text.replace('-', "") } else { text.replace('-', "−") }
}

/// So many significant digits, with a power of ten where plain decimals would hide them.
pub(crate) fn significant(x: f64, digits: usize) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return fixed(x, 0);
    }
    if !(1e-4..1e6).contains(&size) {
        return power_of_ten(x, digits);
    }
    let whole = size.log10().floor() as i64 + 1;
    fixed(x, (digits as i64 - whole).clamp(0, 12) as usize)
}

/// "2.04 × 10⁻⁴".
fn power_of_ten(x: f64, digits: usize) -> String {
    let text = format!("{x:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{} × 10{}", mantissa.replace('-', "−"), superscript(exponent))
}

fn superscript(digits: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |d| RAISED[d as usize]);
    digits.chars().map(raised).collect()
}

/// A p-value: four decimals, or three significant digits below a thousandth.
pub(crate) fn p_value(p: f64) -> String {
    if p >= 0.001 || p == 0.0 { fixed(p, 4) } else { power_of_ten(p, 3) }
}

/// A p that resamples gave: "≤ 0.0001" where none of them reached what was seen, as it may then be smaller.
pub(crate) fn resolved_p(p: f64, smallest: Option<f64>) -> String {
    match smallest {
        Some(smallest) if p <= smallest * (1.0 + 1e-9) => {
            // Rounded up, so that it stays a bound.
            let digits = (1.0 - smallest.log10()).ceil().max(0.0) as usize;
            let unit = 10f64.powi(digits as i32);
            format!("≤ {}", fixed((smallest * unit - 1e-9).ceil() / unit, digits).trim_end_matches('0'))
        }
        _ => p_value(p),
    }
}

/// "p = 0.1606".
pub(crate) fn p_equals(p: f64) -> String {
    format!("p = {}", p_value(p))
}

/// "p ≤ 0.0001" or "p = 0.1606".
pub(crate) fn resolved_p_equals(p: f64, smallest: Option<f64>) -> String {
    let shown = resolved_p(p, smallest);
    if shown.starts_with('≤') { format!("p {shown}") } else { format!("p = {shown}") }
}

/// "0.55 to 1.08".
pub(crate) fn range(low: f64, high: f64, decimals: usize) -> String {
    format!("{} to {}", fixed(low, decimals), fixed(high, decimals))
}

/// A share as a whole percentage, with as many more decimals as it takes to tell it from none and from all.
pub(crate) fn percent(share: f64) -> String {
    format!("{}%", below(100.0 * share, 100.0, 0))
}

/// A number from 0 to `most` with so many decimals, and with more where it would else be read as one of the two.
pub(crate) fn below(x: f64, most: f64, decimals: usize) -> String {
    // What differs from an end by rounding alone is one.
    let is_end = |x: f64| x <= 1e-12 * most || x >= most * (1.0 - 1e-12);
    let told = |decimals: &usize| is_end(x) || !is_end(fixed(x, *decimals).parse().unwrap_or_default());
    fixed(x, (decimals..MOST_DECIMALS).find(told).unwrap_or(MOST_DECIMALS))
}

/// Decimals beyond which nobody reads.
const MOST_DECIMALS: usize = 12;

/// "41%, 30% to 53%", or the share alone where it has no interval.
pub(crate) fn share(value: f64, interval: Option<Interval>) -> String {
    let ends = interval.map_or_else(String::new, |i| format!(", {} to {}", percent(i.low), percent(i.high)));
    format!("{}{ends}", percent(value))
}

/// "1 pair", "2 pairs".
pub(crate) fn count(n: u64, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

/// "a", "a and b", "a, b and c".
pub(crate) fn list(items: &[String]) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_they_should() {
        for (shown, expected) in [
            (fixed(-1.4376, 3), "−1.438"),
            (fixed(-0.0001, 2), "0.00"),
            (fixed(f64::NEG_INFINITY, 2), "−∞"),
            (fixed(f64::NAN, 2), "–"),
            (significant(-0.000203782, 3), "−0.000204"),
            (significant(-0.0000203782, 3), "−2.04 × 10⁻⁵"),
            (significant(1.25e7, 2), "1.2 × 10⁷"),
            (significant(123.456, 3), "123"),
            (significant(0.012345, 3), "0.0123"),
            (p_value(0.160569), "0.1606"),
            (p_value(2.03782e-4), "2.04 × 10⁻⁴"),
            (p_value(0.0), "0.0000"),
            (resolved_p(1e-4, Some(1e-4)), "≤ 0.0001"),
            (resolved_p(1.0 / 1001.0, Some(1.0 / 1001.0)), "≤ 0.001"),
            (resolved_p(1.0 / 2000.0, Some(1.0 / 2000.0)), "≤ 0.0005"),
            (resolved_p(2e-4, Some(1e-4)), "2.00 × 10⁻⁴"),
            (resolved_p(1e-4, None), "1.00 × 10⁻⁴"),
            (list(&["a".into(), "b".into(), "c".into()]), "a, b and c"),
            (count(1, "pair"), "1 pair"),
            (percent(1.0), "100%"),
            (percent(0.0), "0%"),
            (percent(249.0 / 250.0), "99.6%"),
            (below(0.1 + 0.2 + 0.7 - 4e-16, 1.0, 3), "1.000"),
            (percent(9_999.0 / 10_000.0), "99.99%"),
            (percent(0.004), "0.4%"),
            (percent(0.995), "99.5%"),
            (percent(0.406), "41%"),
        ] {
            assert_eq!(shown, expected);
        }
    }
}
