//! With which devices those who are judged took part, counted.

use crate::document::{Cell, Piece, Row, Section, Table};
use crate::format::{count, fixed};
use crate::{StudyReport, display};
use kelir_study::columns::ParticipantColumns;
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// How many participants had something.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, ToSchema)]
pub struct DeviceCount {
    /// What is counted, with its unit.
    pub what: String,
    /// What it was; "not known" where the browser did not say.
    pub value: String,
    /// Participants.
    pub participants: u64,
}

const UNKNOWN: &str = "not known";

impl DeviceCount {
    /// Of these sessions, one a participant: by what is counted, then the most frequent first.
    pub fn of<'a>(sessions: impl IntoIterator<Item = &'a ParticipantColumns>) -> Vec<DeviceCount> {
        let mut counts = BTreeMap::<(usize, String), u64>::new();
        for session in sessions {
            for (what, value) in told(session).into_iter().enumerate() {
                *counts.entry((what, value.unwrap_or_else(|| UNKNOWN.to_owned()))).or_default() += 1;
            }
        }
        let mut all: Vec<((usize, String), u64)> = counts.into_iter().collect();
        all.sort_by(|((a, x), m), ((b, y), n)| a.cmp(b).then(n.cmp(m)).then(x.cmp(y)));
        all.into_iter()
            .map(|((what, value), participants)| DeviceCount {
                what: WHATS[what].to_owned(),
                value,
                participants,
            })
            .collect()
    }
}

/// What is counted.
const WHATS: [&str; 6] = [
    "browser",
    "screen, device px",
    "device px a CSS px when the session began",
    "refresh rate as measured, Hz",
    "main pointer",
    "colours",
];

/// What a session says of each of these.
fn told(session: &ParticipantColumns) -> [Option<String>; 6] {
    let whole = |x: Option<f64>| x.filter(|x| *x >= 1.0).map(|x| x.round() as u32);
    let screen = whole(session.resolution_width).zip(whole(session.resolution_height));
    let trimmed = |x: f64| fixed(x, 2).trim_end_matches('0').trim_end_matches('.').to_owned();
    let colours = match (session.wide_gamut, session.high_dynamic_range) {
        (None, None) => None,
        (_, Some(1)) => Some("high dynamic range"),
        (Some(1), _) => Some("wide gamut (P3)"),
        _ => Some("sRGB"),
    };
    [
        session.user_agent.as_deref().and_then(browser),
        screen.map(|(width, height)| display::size([width, height])),
        session.device_pixel_ratio.map(trimmed),
        session.refresh_hz.map(|hz| fixed(hz, 0)),
        session.touch.map(|touch| if touch == 1 { "finger" } else { "mouse or pen" }.to_owned()),
        colours.map(str::to_owned),
    ]
}

/// A browser's name and major version, from what it calls itself: most call themselves several, the last of which they are.
fn browser(user_agent: &str) -> Option<String> {
    const NAMES: [(&str, &str); 7] = [
        ("Edg/", "Edge"),
        ("OPR/", "Opera"),
        ("SamsungBrowser/", "Samsung Internet"),
        ("Firefox/", "Firefox"),
        ("FxiOS/", "Firefox"),
        ("Chrome/", "Chrome"),
        ("CriOS/", "Chrome"),
    ];
    let major = |mark: &str| {
        let version = user_agent.split_once(mark)?.1;
        let digits: String = version.chars().take_while(char::is_ascii_digit).collect();
        Some(digits).filter(|digits| !digits.is_empty())
    };
    let named = NAMES.iter().find_map(|(mark, name)| Some(format!("{name} {}", major(mark)?)));
    let safari = || user_agent.contains("Safari/").then(|| major("Version/")).flatten();
    named.or_else(|| Some(format!("Safari {}", safari()?)))
}

/// The section; nothing where no session said anything.
pub(crate) fn section(report: &StudyReport) -> Option<Section> {
    let known = report.devices.iter().any(|device| device.value != UNKNOWN);
    let (first, total) = (report.devices.first()?, report.standing.judged);
    let mut rows = vec![Row::Group(first.what.clone())];
    let mut what = &first.what;
    for device in &report.devices {
        if device.what != *what {
            what = &device.what;
            rows.push(Row::Group(what.clone()));
        }
        rows.push(Row::Cells(vec![Cell::text(&device.value), Cell::whole(device.participants)]));
    }
    let text = format!(
        "As the browsers of the {} who are judged said it; nobody measured luminance, viewing distance or light in the room.",
        count(total, "participant")
    );
    let table = Table::new("", &["device", "participants#"], rows);
    known.then(|| Section::new("Devices and displays", vec![Piece::Text(text), Piece::Table(table)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn browsers_are_told_by_the_last_name_they_give_themselves() {
        for (agent, name) in [
            ("Mozilla/5.0 (X11; Linux x86_64; rv:128.0) Gecko/20100101 Firefox/128.0", Some("Firefox 128")),
            (
                "Mozilla/5.0 (Windows NT 10.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/131.0.0.0 Safari/537.36",
                Some("Chrome 131"),
            ),
            (
                "Mozilla/5.0 (Windows NT 10.0) AppleWebKit/537.36 Chrome/131.0.0.0 Safari/537.36 Edg/131.0.2903.51",
                Some("Edge 131"),
            ),
            (
                "Mozilla/5.0 (Macintosh) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/18.1 Safari/605.1.15",
                Some("Safari 18"),
            ),
            (
                "Mozilla/5.0 (iPhone) AppleWebKit/605.1.15 CriOS/130.0.1 Mobile/15E148 Safari/604.1",
                Some("Chrome 130"),
            ),
            ("curl/8.1", None),
        ] {
            assert_eq!(browser(agent).as_deref(), name, "{agent}");
        }
    }

    #[test]
    fn devices_are_counted_by_participants() {
        let session = |hz: f64, width: f64| ParticipantColumns {
            refresh_hz: Some(hz),
            resolution_width: Some(width),
            resolution_height: Some(1080.0),
            touch: Some(0),
            ..ParticipantColumns::default()
        };
        let found =
            DeviceCount::of(&[session(59.94, 1920.0), session(60.02, 1920.0), session(143.9, 2560.0)]);
        let of = |what: &str| {
            found
                .iter()
                .filter(|d| d.what.starts_with(what))
                .map(|d| (d.value.as_str(), d.participants))
                .collect::<Vec<_>>()
        };
        assert_eq!(of("refresh"), [("60", 2), ("144", 1)]);
        assert_eq!(of("screen"), [("1920 × 1080", 2), ("2560 × 1080", 1)]);
        assert_eq!(of("main pointer"), [("mouse or pen", 3)]);
        assert_eq!(of("browser"), [("not known", 3)]);
    }
}
