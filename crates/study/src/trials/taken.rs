//! What every page says of how a trial was taken, whatever its kind.

use super::{Role, TrialEvent};
use crate::schema::worded;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use utoipa::ToSchema;

worded! {
    /// What an answer was given with.
    pub enum Input {
        /// a mouse
        Mouse = "mouse",
        /// a finger
        Touch = "touch",
        /// a stylus
        Pen = "pen",
        /// a key
        Keyboard = "keyboard",
    }
}

worded! {
    /// How the two pictures stood.
    pub enum Arrangement {
        /// beside each other
        Side = "side",
        /// the right one below the left one
        Stack = "stack",
        /// side, in the word that the codebook used to have
        Beside = "beside",
        /// stack, in the word that the codebook used to have
        Below = "below",
    }
}

/// How an animation was shown. Its position is a function of time: frame n is due n / fps seconds after the first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FrameLog {
    /// Frames per second of the animation.
    #[schema(minimum = 0, extensions(("x-unit" = json!("Hz"))))]
    pub fps: Option<f64>,
    /// Refresh rate of the display, to which the nearest refresh of a frame's time is found.
    #[schema(minimum = 0, extensions(("x-unit" = json!("Hz"))))]
    pub refresh_hz: Option<f64>,
    /// Refreshes that each frame was shown for, where pages counted these; they don't any more.
    #[schema(minimum = 0)]
    pub hold: Option<f64>,
    /// Refreshes from the first frame to the choice.
    #[schema(minimum = 0)]
    pub refreshes: Option<f64>,
    /// Frames drawn.
    #[schema(minimum = 0)]
    pub shown: Option<f64>,
    /// Frames passed over without being drawn.
    #[schema(minimum = 0)]
    pub skipped: Option<f64>,
    /// Frames that were never drawn, or later than their time by more than a refresh.
    #[serde(default)]
    #[schema(minimum = 0)]
    pub missed_frames: Option<f64>,
    /// Refreshes at which the browser did not let the page draw.
    #[schema(minimum = 0)]
    pub missed_refreshes: Option<f64>,
    /// Longest time between two refreshes at which the page could draw.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub longest_interval_ms: Option<f64>,
    /// What was shown when: frame, counted on through loops, and ms since the first frame, of each frame drawn, up to 600.
    #[serde(default)]
    #[schema(max_items = 600)]
    pub draws: Option<Vec<Vec<f64>>>,
}

/// A length that is not negative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[schema(minimum = 0)]
pub struct Length(pub f64);

/// A length in whole pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[schema(minimum = 1, maximum = 65536)]
pub struct Pixels(pub u32);

/// How stimuli stand on the page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Geometry {
    /// Device pixels per stimulus pixel, pinch zoom included; 1 is native. Shown on device_pixel_ratio × css_width_px device pixels.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 100)]
    pub scale: Option<f64>,
    /// Width at which each stimulus stood, pinch zoom included: its width in pixels × scale / device_pixel_ratio.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1e6, extensions(("x-unit" = json!("CSS px"))))]
    pub css_width_px: Option<f64>,
    /// Device pixels per CSS pixel.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 100)]
    pub device_pixel_ratio: Option<f64>,
    /// Width and height of the window's inside, CSS px.
    #[serde(default)]
    #[schema(min_items = 2, max_items = 2)]
    pub viewport: Option<Vec<Length>>,
    /// How two pictures that are there at once stand; empty where one stands alone.
    #[serde(default)]
    pub arrangement: Option<Arrangement>,
}

/// What every page says of how a trial was taken. A stimulus pixel is one of the picture, a device pixel one of the display, a CSS pixel one of the page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Taken {
    /// From the first frame at which an answer was possible (the stimuli in view, or the question after two intervals) to the answer.
    #[schema(minimum = 0, maximum = 86400000, extensions(("x-unit" = json!("ms"))))]
    pub rt: f64,
    /// When that frame was shown, by the page's own clock.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1e12, extensions(("x-unit" = json!("ms"))))]
    pub onset: Option<f64>,
    /// From the start of the page's session to the answer.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1e12, extensions(("x-unit" = json!("ms"))))]
    pub time_elapsed: Option<f64>,
    /// Plugin that showed the trial.
    #[serde(default)]
    #[schema(max_length = 100)]
    pub trial_type: Option<String>,
    /// Version of that plugin.
    #[serde(default)]
    #[schema(max_length = 100)]
    pub plugin_version: Option<String>,
    /// What the answer was given with.
    #[serde(default)]
    pub input: Option<Input>,
    /// Width and height of the size at which the stimuli were shown, in their own pixels: one of the study's. Absent: the smallest.
    #[serde(default)]
    #[schema(min_items = 2, max_items = 2)]
    pub stimulus_size: Option<Vec<Pixels>>,
    /// How the stimuli stood at the answer.
    #[serde(flatten)]
    pub geometry: Geometry,
    /// 1 where they stood otherwise at onset, else 0; the changes are events.
    #[serde(default)]
    #[schema(maximum = 1)]
    pub geometry_changed: Option<u8>,
    /// At onset, where that was otherwise:
    #[serde(default)]
    pub at_onset: Option<Geometry>,
    /// Measured refresh rate of the display; empty where it could not be measured.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 10000, extensions(("x-unit" = json!("Hz"))))]
    pub refresh_hz: Option<f64>,
    /// How long the page was hidden during the trial.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1e12, extensions(("x-unit" = json!("ms"))))]
    pub hidden_ms: Option<f64>,
    /// The shortest time for which any of the trial's stimuli was in view before the answer.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1e12, extensions(("x-unit" = json!("ms"))))]
    pub min_visible_ms: Option<f64>,
    /// How often the page had been reloaded.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1000000000)]
    pub reload_count: Option<u32>,
    /// When the browser had the answer, by its own clock, ISO 8601.
    #[serde(default)]
    #[schema(max_length = 100)]
    pub timestamp: Option<String>,
    /// Of animations: how each was played, by role.
    #[serde(default)]
    pub frames: Option<BTreeMap<Role, FrameLog>>,
    /// Of animations: how many of their frames were never drawn, or later than their time by more than a refresh. More than 0 marks a trial.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1000000000)]
    pub missed_frames: Option<u32>,
    /// What happened to the page from the last answer to this one; the table of events has a row each.
    #[serde(default)]
    #[schema(max_items = 200)]
    pub events: Option<Vec<TrialEvent>>,
    /// How many events there were beyond those that are listed.
    #[serde(default)]
    #[schema(minimum = 0, maximum = 1000000000)]
    pub events_dropped: Option<u32>,
}
