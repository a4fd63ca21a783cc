//! What is sent for one trial. Keys beside these are kept as they come.

use super::{Role, TrialKind};
use kelir_study::schema::{Record, worded};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;
use utoipa::ToSchema;

worded! {
    /// What the choice was made with.
    pub enum Device {
        /// A mouse or a touchpad.
        Mouse = "mouse",
        /// A finger on the screen.
        Touch = "touch",
        /// A pen on the screen.
        Pen = "pen",
        /// A key.
        Keyboard = "keyboard",
    }
}

worded! {
    /// How two stimuli stood.
    pub enum Arrangement {
        /// Beside each other.
        Side = "side",
        /// Below each other.
        Stack = "stack",
    }
}

worded! {
    /// A side.
    pub enum Side {
        /// The left one, or the upper one where stimuli stand below each other.
        Left = "left",
        /// The right one, or the lower one.
        Right = "right",
    }
}

worded! {
    /// Which of two intervals.
    pub enum Which {
        /// The first one.
        First = "first",
        /// The second one.
        Second = "second",
    }
}

/// How an animation was shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct FrameLog {
    /// Frames per second of the animation.
    #[schema(minimum = 0, extensions(("x-unit" = json!("Hz"))))]
    pub fps: Option<f64>,
    /// Refresh rate that the animation was timed by.
    #[schema(minimum = 0, extensions(("x-unit" = json!("Hz"))))]
    pub refresh_hz: Option<f64>,
    /// Refreshes that each frame is shown for.
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
    /// Refreshes at which the browser did not let the page draw.
    #[schema(minimum = 0)]
    pub missed_refreshes: Option<f64>,
    /// Longest time between two draws.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub longest_interval_ms: Option<f64>,
}

/// What the answers to all kinds of trial say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct AnswerCommon {
    /// Response time: from the first painted frame that could be answered to the choice.
    #[schema(minimum = 0, maximum = 86_400_000, extensions(("x-unit" = json!("ms"))))]
    pub rt: f64,
    /// When the first frame was painted, by the page's clock.
    #[schema(minimum = 0, maximum = 1_000_000_000_000_u64, extensions(("x-unit" = json!("ms"))))]
    pub onset: f64,
    /// From the start of the page to the choice.
    #[schema(minimum = 0, maximum = 1_000_000_000_000_u64, extensions(("x-unit" = json!("ms"))))]
    pub time_elapsed: Option<f64>,
    /// Plugin that showed the trial.
    #[schema(max_length = 100)]
    pub trial_type: Option<String>,
    /// Version of that plugin.
    #[schema(max_length = 100)]
    pub plugin_version: Option<String>,
    /// What the choice was made with.
    pub input: Option<Device>,
    /// Device pixels per stimulus pixel, pinch zoom included; 1 is native.
    #[schema(minimum = 0, maximum = 100)]
    pub scale: Option<f64>,
    /// Width at which a stimulus stood, pinch zoom included.
    #[schema(minimum = 0, maximum = 1_000_000, extensions(("x-unit" = json!("CSS px"))))]
    pub css_width_px: Option<f64>,
    /// Device pixels per CSS pixel.
    #[schema(minimum = 0, maximum = 100)]
    pub device_pixel_ratio: Option<f64>,
    /// Width and height of the window's inside.
    #[schema(min_items = 2, max_items = 2, extensions(("x-unit" = json!("CSS px"))))]
    pub viewport: Option<Vec<Length>>,
    /// Measured refresh rate of the display.
    #[schema(minimum = 0, maximum = 10_000, extensions(("x-unit" = json!("Hz"))))]
    pub refresh_hz: Option<f64>,
    /// How long the page was hidden during the trial.
    #[schema(minimum = 0, maximum = 1_000_000_000_000_u64, extensions(("x-unit" = json!("ms"))))]
    pub hidden_ms: Option<f64>,
    /// The shortest time that any of the trial's stimuli was visible before the answer.
    #[schema(minimum = 0, maximum = 1_000_000_000_000_u64, extensions(("x-unit" = json!("ms"))))]
    pub min_visible_ms: Option<f64>,
    /// How often the page had been reloaded.
    #[schema(minimum = 0, maximum = 1_000_000_000)]
    pub reload_count: Option<u32>,
    /// When the browser had the answer, by its own clock.
    #[schema(max_length = 100, extensions(("x-unit" = json!("ISO 8601"))))]
    pub timestamp: Option<String>,
    /// How animations were shown, by role.
    pub frames: Option<BTreeMap<Role, FrameLog>>,
}

/// A length that is not negative.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[schema(minimum = 0)]
pub struct Length(pub f64);

/// The answer to a two-alternative trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TwoAlternativeAnswer {
    /// What every answer says.
    #[serde(flatten)]
    pub common: AnswerCommon,
    /// The stimulus chosen.
    pub choice: Side,
    /// How the two stood.
    pub arrangement: Option<Arrangement>,
}

/// A number for each step of a two-interval trial: milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct StepTimes {
    /// Fixation mark.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub fixation: f64,
    /// First stimulus.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub first: f64,
    /// Mask.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub mask: f64,
    /// Second stimulus.
    #[schema(minimum = 0, extensions(("x-unit" = json!("ms"))))]
    pub second: f64,
}

/// A number for each step of a two-interval trial: whole frames of the measured refresh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
pub struct StepFrames {
    /// Fixation mark.
    pub fixation: u32,
    /// First stimulus.
    pub first: u32,
    /// Mask.
    pub mask: u32,
    /// Second stimulus.
    pub second: u32,
}

/// The answer to a two-interval trial.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TwoIntervalAnswer {
    /// What every answer says.
    #[serde(flatten)]
    pub common: AnswerCommon,
    /// The stimulus chosen.
    pub choice: Which,
    /// How long each step was asked to last.
    pub requested_ms: StepTimes,
    /// How many frames each step was shown for.
    pub shown_frames: StepFrames,
    /// How long each step lasted, between the times of frames.
    pub shown_ms: StepTimes,
}

/// The answer to a trial, as its kind asks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(untagged)]
pub enum Answer {
    /// To a two-alternative trial.
    TwoAlternative(TwoAlternativeAnswer),
    /// To a two-interval trial.
    TwoInterval(TwoIntervalAnswer),
}

impl Answer {
    /// What answers to trials of a kind are held to.
    pub fn record(kind: TrialKind) -> &'static Record {
        static TWO_ALTERNATIVE: LazyLock<Record> = LazyLock::new(Record::of::<TwoAlternativeAnswer>);
        static TWO_INTERVAL: LazyLock<Record> = LazyLock::new(Record::of::<TwoIntervalAnswer>);
        match kind {
            TrialKind::TwoAlternative => &TWO_ALTERNATIVE,
            TrialKind::TwoInterval => &TWO_INTERVAL,
        }
    }
}
