//! `[display]`: the sizes at which each stimulus is made, and what a page does with room beyond them.

use crate::definition::StudyDefinition;
use crate::fields::{SECTION, integer};
use crate::schema::worded;
use kelir_reader::{Fields, Node};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Screens are not larger yet; a film of this size would fill a browser's memory.
const LARGEST: [i64; 2] = [3840, 2160];
const MOST_SIZES: usize = 8;

const SIZE: &str = "[width, height] in pixels, width 16 to 3840, height 16 to 2160; it may be missing where display.sizes is there";
const SIZES: &str = "1 to 8 of [width, height] as in size, each wider than the one before it, of one aspect to within a pixel of height";

worded! {
    /// What a page does where there is more room than a size fills at one device pixel a stimulus pixel.
    pub enum Fit {
        /// nothing: a stimulus is never enlarged
        Native = "native",
        /// whole multiples: each stimulus pixel as a square of 2 × 2 device pixels, of 3 × 3, and so on
        Integer = "integer",
        /// as large as fits, resampled by the browser
        Fill = "fill",
    }
}

/// How stimuli stand on displays that differ, as far as the file says so.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DisplayRules {
    /// Sizes [width, height] at which each stimulus is made, by rising width, in pixels; none: the study's `size` alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sizes: Vec<[u32; 2]>,
    /// What happens with room beyond them; absent: what the edition says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fit: Option<Fit>,
}

impl StudyDefinition {
    /// Every size at which its stimuli are made, the smallest first.
    pub fn sizes(&self) -> &[[u32; 2]] {
        if self.display.sizes.is_empty() { std::slice::from_ref(&self.size) } else { &self.display.sizes }
    }

    /// What a page does with room beyond a size: whole multiples from edition 2 on, nothing before.
    pub fn fit(&self) -> Fit {
        self.display.fit.unwrap_or(if self.edition >= 2 { Fit::Integer } else { Fit::Native })
    }

    /// The sizes in words: `592 × 333 or 1110 × 624 pixels`.
    pub fn sizes_in_words(&self) -> String {
        let sizes: Vec<String> = self.sizes().iter().map(|[w, h]| format!("{w} × {h}")).collect();
        format!("{} pixels", sizes.join(" or "))
    }

    /// In which size whom a stimulus is shown, for researchers.
    pub fn display_in_words(&self) -> String {
        let (made, largest) = match self.sizes() {
            [_] => ("", "that size"),
            _ => (", natively at each", "the largest of these that fits the window"),
        };
        let shown = match self.fit() {
            Fit::Native => format!("at {largest}, one device pixel a picture pixel, and never enlarged"),
            Fit::Integer => format!(
                "at {largest}, one device pixel a picture pixel; where a whole multiple of that fits, each pixel is a square of device pixels"
            ),
            Fit::Fill => "as large as fits the window, resampled by the browser".to_owned(),
        };
        format!(
            "Pictures are made at {}{made}. They are shown {shown}; those of one trial always alike. Where there is too little room for the smallest, \
             it is scaled down.",
            self.sizes_in_words()
        )
    }
}

/// Reads `size` and `[display]`; nothing where one of them is wrong, which has been reported.
pub(crate) fn read(fields: &mut Fields<'_>) -> (Option<[u32; 2]>, DisplayRules) {
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
