//! `size` and `[display]`.

use crate::display::{DisplayRules, Fit};
use crate::fields::{SECTION, integer};
use kelir_reader::{Fields, Node};

/// Screens are not larger yet; a film of this size would fill a browser's memory.
const LARGEST: [i64; 2] = [3840, 2160];
const MOST_SIZES: usize = 8;

const SIZE: &str = "[width, height] in pixels, width 16 to 3840, height 16 to 2160; it may be missing where display.sizes is there";
const SIZES: &str = "1 to 8 of [width, height] as in size, each wider than the one before it, of one aspect to within a pixel of height";

/// Reads `size` and `[display]`; nothing where one of them is wrong, which has been reported.
pub(super) fn read(fields: &mut Fields<'_>) -> (Option<[u32; 2]>, DisplayRules) {
    let mut display = fields.given("display", SECTION).and_then(|node| node.table());
    let (mut listed, mut rules) = (false, DisplayRules::default());
    if let Some(display) = &mut display {
        listed = display.has("sizes");
        rules.sizes = display.may("sizes", SIZES, sizes).unwrap_or_default();
        rules.fit = display.may("fit", "\"native\", \"integer\" or \"fill\"", |v| {
            Fit::ALL.iter().copied().find(|fit| v.as_str() == Some(fit.as_str()))
        });
    }
    if let Some(display) = display {
        display.done();
    }
    if !listed {
        return (fields.must("size", SIZE, size), rules);
    }
    let (given, smallest) = (fields.may("size", SIZE, size), rules.sizes.first().copied());
    if given.is_some() && smallest.is_some() && given != smallest {
        let rule = "must be the first of display.sizes where both are there";
        fields.reject("size", rule);
    }
    // One size is the same study however it is written.
    if rules.sizes.len() == 1 {
        rules.sizes.clear();
    }
    (smallest, rules)
}

fn size(value: &Node) -> Option<[u32; 2]> {
    let [w, h] = &value.as_array()?[..] else { return None };
    Some([integer(w, 16, LARGEST[0])? as u32, integer(h, 16, LARGEST[1])? as u32])
}

fn sizes(value: &Node) -> Option<Vec<[u32; 2]>> {
    let sizes: Vec<[u32; 2]> = value.as_array()?.iter().map(size).collect::<Option<_>>()?;
    let [w, h] = sizes.first()?.map(f64::from);
    let alike = |[width, height]: &[u32; 2]| (f64::from(*width) * h / w - f64::from(*height)).abs() <= 1.0;
    let rising = sizes.windows(2).all(|pair| pair[0][0] < pair[1][0]);
    (sizes.len() <= MOST_SIZES && rising && sizes.iter().all(alike)).then_some(sizes)
}

#[cfg(test)]
mod tests;
