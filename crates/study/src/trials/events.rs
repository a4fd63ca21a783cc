//! What happens to a page while a trial is taken.

use super::{Geometry, Input, Role};
use crate::schema::worded;
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

worded! {
    /// What happened.
    pub enum EventKind {
        /// the page lost the focus, though it may still have been in view
        Blur = "blur",
        /// the page got the focus back
        Focus = "focus",
        /// the page went out of view
        Hidden = "hidden",
        /// the page came back into view
        Visible = "visible",
        /// window, zoom or display changed, and with it how the stimuli stand
        Resize = "resize",
        /// the display was turned
        Orientation = "orientation",
        /// full screen began
        FullscreenEnter = "fullscreen_enter",
        /// full screen ended
        FullscreenExit = "fullscreen_exit",
        /// an input came that does not count as the answer
        Ignored = "ignored",
    }
}

worded! {
    /// Why an input does not count.
    pub enum Ignored {
        /// no hand made it: a script did
        Untrusted = "untrusted",
        /// the second or a later click of a quick series
        Double = "double",
        /// the same key still held, or back too soon to have been let go
        Repeat = "repeat",
        /// the input that counted before had not been let go
        Held = "held",
        /// the stimulus had not been visible for min_visible_ms
        Early = "early",
        /// the last input that counted was not min_gap_ms ago
        Gap = "gap",
        /// the trial it was meant for had its answer; it is listed with the next trial, before whose onset it came
        Answered = "answered",
    }
}

/// One thing that happened to the page.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TrialEvent {
    /// What happened.
    pub event: EventKind,
    /// When, from the trial's onset; below 0 it was before that and after the last answer.
    #[schema(minimum = -1e12, maximum = 1e12, extensions(("x-unit" = json!("ms"))))]
    pub time_ms: f64,
    /// Of an ignored input: why it did not count.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<Ignored>,
    /// Of an ignored input: what it was given with.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub input: Option<Input>,
    /// Of an ignored input: the answer that it would have been.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub choice: Option<Role>,
    /// Of a turned display: how it is held now, in the browser's words, such as landscape-primary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(max_length = 100)]
    pub orientation: Option<String>,
    /// Of a resize: how the stimuli stand from then on.
    #[serde(flatten)]
    pub geometry: Geometry,
}
