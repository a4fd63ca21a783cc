//! The distributions on a grid of reference values.

use serde::Serialize;
use utoipa::ToSchema;

use crate::distributions::{Beta, Binomial, ChiSquared, FisherF, NoncentralT, StudentT, normal};
use crate::{Result, StatsError};

/// Function, arguments and value, by `tests/data/make_distributions.py` (mpmath, 50 and more digits).
const GRID: &str = include_str!("../../tests/data/distributions.tsv");

/// One line of the grid, computed.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct GridPoint {
    /// Which function.
    pub function: &'static str,
    /// Its arguments.
    pub arguments: Vec<f64>,
    /// What mpmath says.
    pub expected: f64,
    /// What this crate says.
    pub computed: f64,
}

impl GridPoint {
    /// |computed − expected| / |expected|.
    pub fn relative_error(&self) -> f64 {
        if self.computed == self.expected {
            0.0
        } else {
            ((self.computed - self.expected) / self.expected).abs()
        }
    }

    /// The size of the problem: the largest of df, n, a and b among the arguments; 0 for the normal distribution.
    pub fn size(&self) -> f64 {
        let shapes = match self.function.split('_').next() {
            Some("t" | "chi" | "noncentral" | "binomial") => 1,
            Some("beta" | "f") => 2,
            _ => 0,
        };
        self.arguments.iter().take(shapes).fold(0.0, |size, &a| a.max(size))
    }
}

/// The worst relative error of one function over one range of sizes.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct WorstError {
    /// Which function.
    pub function: &'static str,
    /// Sizes (df, n, a, b) up to this.
    pub size_to: f64,
    /// How many points.
    pub points: usize,
    /// The worst relative error among them.
    pub relative_error: f64,
    /// The arguments at which it occurs.
    pub arguments: Vec<f64>,
}

/// Every point of the grid of reference values, computed.
///
/// # Errors
/// Only when a function refuses a point of the grid, which would be a defect.
pub fn grid() -> Result<Vec<GridPoint>> {
    GRID.lines().map(point).collect()
}

/// The worst relative errors over sizes up to 1000 and up to 1e6: the table of the documentation.
///
/// # Errors
/// As [`grid`].
pub fn worst_errors() -> Result<Vec<WorstError>> {
    let mut table: Vec<WorstError> = Vec::new();
    for point in grid()? {
        let size_to = if point.size() <= 1000.0 { 1000.0 } else { 1e6 };
        let relative_error = point.relative_error();
        match table.iter_mut().find(|row| row.function == point.function && row.size_to == size_to) {
            Some(row) => {
                row.points += 1;
                if relative_error > row.relative_error {
                    row.relative_error = relative_error;
                    row.arguments = point.arguments;
                }
            }
            None => table.push(WorstError {
                function: point.function,
                size_to,
                points: 1,
                relative_error,
                arguments: point.arguments,
            }),
        }
    }
    Ok(table)
}

fn point(line: &'static str) -> Result<GridPoint> {
    let mut columns = line.split('\t');
    let function = columns.next().unwrap_or_default();
    let mut arguments: Vec<f64> = columns.map(|text| text.parse().unwrap_or(f64::NAN)).collect();
    let expected = arguments.pop().unwrap_or(f64::NAN);
    let computed = compute(function, &arguments)?;
    Ok(GridPoint { function, arguments, expected, computed })
}

fn compute(function: &str, arguments: &[f64]) -> Result<f64> {
    match (function, arguments) {
        ("normal_cdf", &[x]) => normal::cdf(x),
        ("normal_ln_cdf", &[x]) => normal::ln_cdf(x),
        ("normal_quantile", &[p]) => normal::quantile(p),
        ("t_sf", &[df, t]) => StudentT::new(df)?.sf(t),
        ("t_ln_sf", &[df, t]) => StudentT::new(df)?.ln_sf(t),
        ("t_quantile_sf", &[df, q]) => StudentT::new(df)?.quantile_sf(q),
        ("beta_cdf", &[a, b, x]) => Beta::new(a, b)?.cdf(x),
        ("beta_sf", &[a, b, x]) => Beta::new(a, b)?.sf(x),
        ("beta_ln_cdf", &[a, b, x]) => Beta::new(a, b)?.ln_cdf(x),
        ("beta_quantile", &[a, b, p]) => Beta::new(a, b)?.quantile(p),
        ("binomial_pmf", &[n, p, k]) => Ok(Binomial::new(n as u64, p)?.pmf(k as u64)),
        ("binomial_cdf", &[n, p, k]) => Ok(Binomial::new(n as u64, p)?.cdf(k as u64)),
        ("binomial_sf", &[n, p, k]) => Ok(Binomial::new(n as u64, p)?.sf(k as u64)),
        ("chi_squared_cdf", &[df, x]) => ChiSquared::new(df)?.cdf(x),
        ("chi_squared_sf", &[df, x]) => ChiSquared::new(df)?.sf(x),
        ("f_cdf", &[df1, df2, f]) => FisherF::new(df1, df2)?.cdf(f),
        ("f_sf", &[df1, df2, f]) => FisherF::new(df1, df2)?.sf(f),
        ("noncentral_t_cdf", &[df, delta, t]) => NoncentralT::new(df, delta)?.cdf(t),
        ("noncentral_t_sf", &[df, delta, t]) => NoncentralT::new(df, delta)?.sf(t),
        _ => Err(StatsError::NoSolution { what: "a line of the grid", reason: "its function is unknown" }),
    }
}
