//! Agreement of several raters.

use serde::Serialize;
use utoipa::ToSchema;

use crate::distributions::normal;
use crate::{Result, StatsError};

/// Agreement beyond chance of a fixed number of raters on unordered categories.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct FleissKappa {
    /// Items rated.
    pub items: usize,
    /// Raters an item.
    pub raters: u64,
    /// κ: 1 for full agreement, 0 for chance.
    pub kappa: f64,
    /// Its standard error when there is no agreement beyond chance (Fleiss, Nee & Landis 1979).
    pub se_null: f64,
    /// κ / se_null.
    pub z: f64,
    /// Two-sided p of z.
    pub p: f64,
}

/// Fleiss' κ (1971) of a table `ratings[item][category]` = how many raters chose the category.
///
/// # Errors
/// [`StatsError::TooFew`] without an item, below two raters or two categories; [`StatsError::LengthMismatch`] for a
/// ragged table; [`StatsError::InvalidElement`] for an item with another number of raters;
/// [`StatsError::NoSolution`] when all ratings are in one category.
pub fn fleiss_kappa(ratings: &[&[u64]]) -> Result<FleissKappa> {
    let Some(first) = ratings.first() else {
        return Err(StatsError::TooFew { name: "ratings", len: 0, needed: 1 });
    };
    let categories = first.len();
    if categories < 2 {
        return Err(StatsError::TooFew { name: "categories", len: categories as u64, needed: 2 });
    }
    let total = |row: &[u64]| row.iter().map(|&count| count as f64).sum::<f64>();
    let raters = total(first);
    if raters < 2.0 {
        return Err(StatsError::TooFew { name: "raters", len: raters as u64, needed: 2 });
    }
    for (index, row) in ratings.iter().enumerate() {
        if row.len() != categories {
            return Err(StatsError::LengthMismatch {
                first: "ratings[0]",
                first_len: categories,
                second: "another item",
                second_len: row.len(),
            });
        }
        if total(row) != raters {
            let rule = "must have as many raters as the first item";
            return Err(StatsError::InvalidElement { name: "ratings", index, value: total(row), rule });
        }
    }
    let items = ratings.len() as f64;
    let pairs = raters * (raters - 1.0);
    let agreeing: f64 = ratings.iter().flat_map(|row| row.iter()).map(|&c| c as f64 * (c as f64 - 1.0)).sum();
    let shares: Vec<f64> = (0..categories)
        .map(|j| ratings.iter().map(|row| row[j] as f64).sum::<f64>() / (items * raters))
        .collect();
    let expected: f64 = shares.iter().map(|p| p * p).sum();
    let pq: f64 = shares.iter().map(|p| p * (1.0 - p)).sum();
    if pq == 0.0 {
        return Err(StatsError::NoSolution { what: "Fleiss' κ", reason: "all ratings are in one category" });
    }
    let kappa = (agreeing / (items * pairs) - expected) / (1.0 - expected);
    let skew: f64 = shares.iter().map(|p| p * (1.0 - p) * (1.0 - 2.0 * p)).sum();
    let se_null = (2.0 * (pq * pq - skew)).sqrt() / (pq * (items * pairs).sqrt());
    let z = kappa / se_null;
    Ok(FleissKappa {
        items: ratings.len(),
        raters: raters as u64,
        kappa,
        se_null,
        z,
        p: 2.0 * normal::sf(z.abs())?,
    })
}
