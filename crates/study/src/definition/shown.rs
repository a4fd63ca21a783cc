//! What a participant sees of a study: pictures in a size, texts in a language.

use super::StudyDefinition;
use crate::display::Fit;
use crate::languages::Texts;

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

    /// The language in which a session that asked for `wanted` reads the study: that one where the study has it, else its own.
    pub fn language_for<'a>(&'a self, wanted: Option<&'a str>) -> &'a str {
        wanted.filter(|wanted| self.translations.contains_key(*wanted)).unwrap_or(&self.language)
    }

    /// What participants read in a language; in the study's own where it has no such translation.
    pub fn texts_in(&self, language: &str) -> &Texts {
        self.translations.get(language).map_or(&self.texts, |translation| &translation.texts)
    }
}
