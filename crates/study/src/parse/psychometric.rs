//! `[blocks.psychometric]` and the levels of the block's pairs.

use crate::definition::{Direction, GUESS, Item, Psychometric};
use crate::fields::{Fields, Gatherer, number, text};
use kelir_stats::psychometric::{Lapse, Sigmoid};
use toml::Value;

/// The block's psychometric function; a level and the function need each other.
pub(super) fn read(
    gatherer: &Gatherer<'_>,
    block: &mut Fields<'_>,
    key: &str,
    items: &[Item],
    catch: bool,
) -> Option<Psychometric> {
    let Some(value) = block.raw("psychometric") else {
        for (i, pair) in items.iter().enumerate().filter(|(_, pair)| pair.level.is_some()) {
            let level = pair.level.map(Value::Float);
            block.report(
                &format!("{key}[{i}].level"),
                level.as_ref(),
                "needs the block's [blocks.psychometric]",
            );
        }
        return None;
    };
    let mut fields = Fields::of(gatherer, block.path_of("psychometric"), value)?;
    let function =
        fields.need("function", "\"gaussian\", \"logistic\" or \"weibull\"", |v| match v.as_str()? {
            "gaussian" => Some(Sigmoid::Gaussian),
            "logistic" => Some(Sigmoid::Logistic),
            "weibull" => Some(Sigmoid::Weibull),
            _ => None,
        });
    let direction = fields.need("direction", "\"rising\" or \"falling\"", |v| match v.as_str()? {
        "rising" => Some(Direction::Rising),
        "falling" => Some(Direction::Falling),
        _ => None,
    });
    let label = fields
        .need("label", "a text of 1 to 80 characters, none of them a control character", |v| text(v, 80));
    let unit =
        fields.get("unit", "a text of 1 to 20 characters, none of them a control character", |v| text(v, 20));
    let lapse = fields
        .get("lapse", "\"prior\" or a rate from 0 to 0.4", |v| match v.as_str() {
            Some("prior") => Some(Lapse::Prior),
            Some(_) => None,
            None => number(v, 0.0, 0.4).map(Lapse::Fixed),
        })
        .unwrap_or_default();
    let thresholds = fields
        .get("thresholds", "a list of 1 to 9 shares above 0.5 and below 1", |v| {
            let items = v.as_array().filter(|items| (1..=9).contains(&items.len()))?;
            items.iter().map(|v| number(v, 0.0, 1.0).filter(|p| *p > GUESS && *p < 1.0)).collect()
        })
        .unwrap_or_else(|| vec![0.75]);
    fields.finish();

    if catch {
        block.report("psychometric", None, "a catch block is not analysed; leave one of the two out");
    }
    for (i, _) in items.iter().enumerate().filter(|(_, pair)| pair.level.is_none()) {
        let rule = "missing; each pair of a block with a psychometric function has a level";
        block.report(&format!("{key}[{i}].level"), None, rule);
    }
    let mut levels: Vec<f64> = items.iter().filter_map(|pair| pair.level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if items.iter().all(|pair| pair.level.is_some()) && levels.len() < 3 {
        block.report(key, None, "must have at least three different levels to show a curve");
    }
    Some(Psychometric { function: function?, direction: direction?, label: label?, unit, lapse, thresholds })
}
