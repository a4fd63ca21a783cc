//! `[blocks.psychometric]` and the levels of the block's pairs.

use crate::definition::{Direction, GUESS, Item, Psychometric};
use crate::fields::{SECTION, number, text};
use kelir_reader::{Fields, Node};
use kelir_stats::psychometric::{Lapse, Sigmoid};

/// The block's psychometric function; a level and the function need each other. `items` come with where they stand.
pub(super) fn read(
    block: &mut Fields<'_>,
    key: &str,
    (items, nodes): (&[Item], &[Node<'_>]),
    catch: bool,
) -> Option<Psychometric> {
    let Some(node) = block.given("psychometric", SECTION) else {
        let given = items.iter().zip(nodes).filter(|(item, _)| item.level.is_some());
        for level in given.filter_map(|(_, node)| node.get("level")) {
            level.refuse::<()>("needs the block's [blocks.psychometric]");
        }
        return None;
    };
    let mut fields = node.table()?;
    let function =
        fields.must("function", "\"gaussian\", \"logistic\" or \"weibull\"", |v| match v.as_str()? {
            "gaussian" => Some(Sigmoid::Gaussian),
            "logistic" => Some(Sigmoid::Logistic),
            "weibull" => Some(Sigmoid::Weibull),
            _ => None,
        });
    let direction = fields.must("direction", "\"rising\" or \"falling\"", |v| match v.as_str()? {
        "rising" => Some(Direction::Rising),
        "falling" => Some(Direction::Falling),
        _ => None,
    });
    let label = fields
        .must("label", "a text of 1 to 80 characters, none of them a control character", |v| text(v, 80));
    let unit =
        fields.may("unit", "a text of 1 to 20 characters, none of them a control character", |v| text(v, 20));
    let lapse = fields
        .may("lapse", "\"prior\" or a rate from 0 to 0.4", |v| match v.as_str() {
            Some("prior") => Some(Lapse::Prior),
            Some(_) => None,
            None => number(v, 0.0, 0.4).map(Lapse::Fixed),
        })
        .unwrap_or_default();
    let thresholds = fields
        .may("thresholds", "a list of 1 to 9 shares above 0.5 and below 1", |v| {
            let items = v.as_array().filter(|items| (1..=9).contains(&items.len()))?;
            items.iter().map(|v| number(v, 0.0, 1.0).filter(|p| *p > GUESS && *p < 1.0)).collect()
        })
        .unwrap_or_else(|| vec![0.75]);
    let t_test = fields.may("t_test", "true or false", Node::as_bool).unwrap_or(false);
    fields.done();

    if catch {
        block.report("psychometric", "a catch block is not analysed; leave one of the two out");
    }
    for node in nodes.iter().filter(|node| node.get("level").is_none()) {
        node.report("level", "is missing: each pair of a block with a psychometric function has a level");
    }
    let mut levels: Vec<f64> = items.iter().filter_map(|pair| pair.level).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if items.iter().all(|pair| pair.level.is_some()) && levels.len() < 3 {
        block.report(key, "must have at least three different levels to show a curve");
    }
    Some(Psychometric {
        function: function?,
        direction: direction?,
        label: label?,
        unit,
        lapse,
        thresholds,
        t_test,
    })
}
