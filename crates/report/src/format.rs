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

/// "p = 0.1606".
pub(crate) fn p_equals(p: f64) -> String {
    format!("p = {}", p_value(p))
}

/// "0.55 to 1.08".
pub(crate) fn range(low: f64, high: f64, decimals: usize) -> String {
    format!("{} to {}", fixed(low, decimals), fixed(high, decimals))
}

/// A share as a whole percentage.
pub(crate) fn percent(share: f64) -> String {
    format!("{}%", fixed(100.0 * share, 0))
}

/// "41%, 30% to 53%".
pub(crate) fn share(value: f64, interval: Interval) -> String {
    format!("{}, {} to {}", percent(value), percent(interval.low), percent(interval.high))
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
            (list(&["a".into(), "b".into(), "c".into()]), "a, b and c"),
            (count(1, "pair"), "1 pair"),
        ] {
            assert_eq!(shown, expected);
        }
    }
}
