//! E⁰ kept between drawings.

use std::sync::Arc;

use kelir_scene::Theatre;

use super::rows::{means_over_pixels, unit_image};

/// E⁰ of a lamp's emitters on one view's pixels, kept while lamp, screen and size stay.
#[derive(Debug, Default)]
pub(crate) struct UnitImages {
    kept: Vec<UnitImage>,
}

/// E⁰ of one emitter.
#[derive(Clone, Debug)]
struct UnitImage {
    /// What it was made for.
    key: String,
    /// At pixel centres.
    centres: Arc<Vec<f64>>,
    /// Means over pixels, where they were asked for.
    means: Option<Arc<Vec<f64>>>,
}

impl UnitImages {
    /// Brings the images up to date and forgets what is no longer used; `means` asks for [`UnitImages::means`].
    pub(crate) fn update(&mut self, theatre: &Theatre, size: [usize; 2], means: bool) {
        let lamp_m = theatre.lamp.position_m;
        let screen = &theatre.screen;
        let old = std::mem::take(&mut self.kept);
        for emitter in &theatre.lamp.emitters {
            let key =
                format!("{:?} {lamp_m:?} {} {} {size:?}", emitter.shape, screen.width_m, screen.height_m);
            let mut image = old.iter().find(|image| image.key == key).cloned().unwrap_or_else(|| UnitImage {
                centres: Arc::new(unit_image(&emitter.shape, lamp_m, screen, size)),
                means: None,
                key,
            });
            if means && image.means.is_none() {
                image.means = Some(Arc::new(means_over_pixels(&image.centres, size)));
            }
            self.kept.push(image);
        }
    }

    /// At pixel centres, one image an emitter.
    pub(crate) fn centres(&self) -> Vec<&[f64]> {
        self.kept.iter().map(|image| image.centres.as_slice()).collect()
    }

    /// Means over pixels, one image an emitter; values at the centres where means were not asked for.
    pub(crate) fn means(&self) -> Vec<&[f64]> {
        self.kept.iter().map(|image| image.means.as_ref().unwrap_or(&image.centres).as_slice()).collect()
    }
}
