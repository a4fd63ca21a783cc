//! The Statistical Reference Datasets of NIST (sources in `tests/data/nist/README.md`).

use serde::Serialize;
use utoipa::ToSchema;

use crate::Result;
use crate::descriptive::{Moments, autocorrelation, one_way_anova};

const UNIVARIATE: &str = include_str!("../../tests/data/nist/univariate.txt");
const EXACT: &str = include_str!("../../tests/data/nist/exact.tsv");
const ANOVA: [(&str, &str); 9] = [
    ("SmLs01", include_str!("../../tests/data/nist/SmLs01.dat")),
    ("SmLs02", include_str!("../../tests/data/nist/SmLs02.dat")),
    ("SmLs03", include_str!("../../tests/data/nist/SmLs03.dat")),
    ("SmLs04", include_str!("../../tests/data/nist/SmLs04.dat")),
    ("SmLs05", include_str!("../../tests/data/nist/SmLs05.dat")),
    ("SmLs06", include_str!("../../tests/data/nist/SmLs06.dat")),
    ("SmLs07", include_str!("../../tests/data/nist/SmLs07.dat")),
    ("SmLs08", include_str!("../../tests/data/nist/SmLs08.dat")),
    ("SmLs09", include_str!("../../tests/data/nist/SmLs09.dat")),
];

/// One certified statistic, computed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Certified {
    /// NIST's name of the data set.
    pub set: &'static str,
    /// `mean`, `sd`, `autocorrelation` or `f`.
    pub statistic: &'static str,
    /// NIST's value.
    pub certified: f64,
    /// The value in exact arithmetic on the decimals as parsed to `f64`.
    pub exact: f64,
    /// What this crate says.
    pub computed: f64,
}

impl Certified {
    /// Digits shared with NIST: −log₁₀ of the relative error, at most 15.
    pub fn digits(&self) -> f64 {
        log_relative_error(self.computed, self.certified)
    }

    /// The most digits that any arithmetic could share with NIST after the decimals were parsed to `f64`.
    pub fn ceiling(&self) -> f64 {
        log_relative_error(self.exact, self.certified)
    }
}

/// All 36 certified statistics: mean, standard deviation and lag-1 autocorrelation of nine series, F of nine analyses
/// of variance.
///
/// # Errors
/// Only when a function refuses one of the data sets, which would be a defect.
pub fn nist() -> Result<Vec<Certified>> {
    let mut rows = Vec::new();
    for line in UNIVARIATE.lines() {
        let (head, data) = line.split_once(':').unwrap_or((line, ""));
        let set = head.split_whitespace().next().unwrap_or_default();
        let certified = numbers(head);
        let values = numbers(data);
        let moments = Moments::of(&values)?;
        let computed = [moments.mean, moments.sd.unwrap_or(f64::NAN), autocorrelation(&values, 1)?];
        for ((statistic, computed), certified) in
            ["mean", "sd", "autocorrelation"].into_iter().zip(computed).zip(certified)
        {
            rows.push(Certified { set, statistic, certified, exact: exact(set, statistic), computed });
        }
    }
    for (set, text) in ANOVA {
        let mut groups: Vec<Vec<f64>> = Vec::new();
        let mut certified = f64::NAN;
        for line in text.lines() {
            if line.starts_with("Between Treatment") {
                certified = numbers(line).last().copied().unwrap_or(f64::NAN);
            }
        }
        // The data begin on line 61, as each file's header says.
        for row in text.lines().skip(60).map(numbers) {
            if let [treatment, response] = row[..] {
                groups.resize(groups.len().max(treatment as usize), Vec::new());
                groups[treatment as usize - 1].push(response);
            }
        }
        let groups: Vec<&[f64]> = groups.iter().map(Vec::as_slice).collect();
        let computed = one_way_anova(&groups)?.f;
        rows.push(Certified { set, statistic: "f", certified, exact: exact(set, "f"), computed });
    }
    Ok(rows)
}

fn numbers(text: &str) -> Vec<f64> {
    text.split_whitespace().filter_map(|word| word.parse().ok()).collect()
}

fn exact(set: &str, statistic: &str) -> f64 {
    let line = EXACT.lines().find_map(|line| line.strip_prefix(set)?.trim_start().strip_prefix(statistic));
    line.and_then(|value| value.trim().parse().ok()).unwrap_or(f64::NAN)
}

fn log_relative_error(value: f64, certified: f64) -> f64 {
    let error = ((value - certified) / certified).abs();
    if error == 0.0 { 15.0 } else { (-error.log10()).min(15.0) }
}
