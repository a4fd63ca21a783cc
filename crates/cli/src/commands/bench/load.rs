//! `kelir bench load`: durable answers a second, against a plain server that stores the same rows, and how long people wait.

use std::time::Duration;

use anyhow::{Context, Result, ensure};
use serde::Serialize;
use serde_json::Value;

use crate::output::{Figures, table};

mod client;
mod sides;

use client::{Times, pace, request, saturate};
use sides::{ITEMS, Side};

/// Arguments of `kelir bench load`.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Answers of a side in a round.
    #[arg(long, default_value_t = 5_000)]
    answers: usize,
    /// Rounds; the sides take turns.
    #[arg(long, default_value_t = 3)]
    rounds: usize,
    /// Connections that answers come by.
    #[arg(long, default_value_t = 64)]
    connections: usize,
    /// People who answer every two seconds.
    #[arg(long, default_value_t = 1_000)]
    people: usize,
    /// Sessions up to which starts and answers are measured, from 100 by factors of ten; a million takes half an hour.
    #[arg(long, default_value_t = 10_000)]
    sessions: usize,
    /// Leave the rival out: it needs node, npm and the network.
    #[arg(long)]
    alone: bool,
    #[command(flatten)]
    pub(super) figures: Figures,
}

/// Starts that are measured at each number of sessions.
const STARTS: usize = 500;
/// What a person of the panel does, in all.
const PACE: Duration = Duration::from_secs(2);

/// One line of figures.
#[derive(Serialize)]
struct Line {
    what: String,
    per_s: f64,
    p50_ms: f64,
    p99_ms: f64,
}

impl Line {
    fn of(what: String, times: &Times) -> Line {
        let [p50_ms, p99_ms] = [0.5, 0.99].map(|q| times.quantile_ms(q));
        Line { what, per_s: times.per_s, p50_ms, p99_ms }
    }

    fn row(&self) -> Vec<String> {
        let Line { what, per_s, p50_ms, p99_ms } = self;
        vec![what.clone(), format!("{per_s:.0}"), format!("{p50_ms:.1}"), format!("{p99_ms:.1}")]
    }
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Result<()> {
    // One thread asks: what a second one would take is the servers'.
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build()?;
    let figures = runtime.block_on(measure(args))?;
    args.figures.say(&table(
        &["what", "a second", "p50 ms", "p99 ms"],
        &figures.iter().map(Line::row).collect::<Vec<_>>(),
    ))?;
    if let Some([least, median, most]) = ratios(&figures) {
        args.figures.say(&format!(
            "kelir stores {median:.1} times as many answers a second: the median of {} rounds, {least:.1} to {most:.1}.",
            args.rounds
        ))?;
    }
    args.figures.give(&figures)
}

/// How many times as many answers kelir stores as the rival in the same round: the least, the median and the most. What a machine has for both
/// changes from minute to minute, and hits both sides of a round alike.
fn ratios(figures: &[Line]) -> Option<[f64; 3]> {
    let of = |side: &'static str| {
        figures.iter().filter(move |line| line.what.starts_with(side)).map(|line| line.per_s)
    };
    let mut ratios: Vec<f64> =
        of("answers, kelir").zip(of("answers, Express")).map(|(own, rival)| own / rival).collect();
    ratios.sort_by(f64::total_cmp);
    Some([*ratios.first()?, *ratios.get(ratios.len() / 2)?, *ratios.last()?])
}

async fn measure(args: &Args) -> Result<Vec<Line>> {
    let mut sides = vec![sides::kelir()?];
    if !args.alone {
        sides.push(sides::express()?);
    }
    let mut figures = Vec::new();
    for round in 1..=args.rounds {
        for side in &sides {
            let sessions = begin(side, args.answers.div_ceil(ITEMS)).await?.0;
            let times = saturate(side.address, args.connections, answers(&sessions)).await?.1;
            figures.push(Line::of(format!("answers, {}, round {round}", side.name), &times));
        }
    }
    for side in &sides {
        figures.push(panel(side, args.people).await?);
    }
    drop(sides);
    let side = sides::kelir_drawing().await?;
    figures.push(panel(&side, args.people).await?);
    ensure!(side.draws().await?, "nothing was drawn any more at the end: the waits say nothing");
    drop(side);
    let side = sides::kelir()?;
    let (mut size, mut held) = (100, 0);
    while size <= args.sessions {
        begin(&side, size.saturating_sub(held)).await?;
        let (sessions, times) = begin(&side, STARTS).await?;
        figures.push(Line::of(format!("starts, {size} sessions held"), &times));
        let times = saturate(side.address, args.connections, answers(&sessions)).await?.1;
        figures.push(Line::of(format!("answers, {size} sessions held"), &times));
        held = held.max(size) + STARTS;
        size *= 10;
    }
    Ok(figures)
}

/// So many people who answer at their pace, two sessions each.
async fn panel(side: &Side, people: usize) -> Result<Line> {
    let sessions = begin(side, 2 * people).await?.0;
    let answers = sessions.chunks_exact(2).map(answers).collect();
    let times = pace(side.address, answers, PACE).await?;
    Ok(Line::of(format!("{people} people, {}", side.name), &times))
}

/// Begins so many sessions and gives their consent: their ids and tokens, and how long beginning took.
async fn begin(side: &Side, sessions: usize) -> Result<(Vec<[String; 2]>, Times)> {
    let start = request("POST", "/api/v1/studies/shadow-puppets/sessions", "", "{}");
    let (begun, times) = saturate(side.address, 16, vec![start; sessions]).await?;
    let mut known = Vec::new();
    for body in begun {
        let session: Value = serde_json::from_slice(&body)?;
        let text = |key: &str| session[key].as_str().map(str::to_owned).context("no session came back");
        known.push([text("session_id")?, text("token")?]);
    }
    let consents = known
        .iter()
        .map(|[id, token]| request("POST", &format!("/api/v1/sessions/{id}/consent"), token, "{}"));
    saturate(side.address, 16, consents.collect()).await?;
    Ok((known, times))
}

/// Every answer of these sessions, as a page sends it.
fn answers(sessions: &[[String; 2]]) -> Vec<String> {
    let kind = kelir_study::TrialKind::default().name();
    let answer = |[id, token]: &[String; 2], trial: usize| {
        let body = format!(
            r#"{{"choice":"left","rt":{}.125,"onset":10234.5,"input":"mouse","scale":1,"arrangement":"beside","device_pixel_ratio":1,"viewport":[1280,800],"refresh_hz":60,"hidden_ms":0,"time_elapsed":20000,"trial_type":"{kind}","plugin_version":"0.1.0","reload_count":0,"timestamp":"2026-11-28T08:00:00.000Z"}}"#,
            500 + trial
        );
        request("PUT", &format!("/api/v1/sessions/{id}/trials/{trial}"), token, &body)
    };
    sessions.iter().flat_map(|session| (0..ITEMS).map(move |trial| answer(session, trial))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_compared_each_with_its_own() {
        let line = |what: &str, per_s| Line { what: what.to_owned(), per_s, p50_ms: 1.0, p99_ms: 1.0 };
        let mut figures = Vec::new();
        for (round, own, rival) in [(1, 300.0, 100.0), (2, 1000.0, 200.0), (3, 40.0, 40.0)] {
            figures.push(line(&format!("answers, kelir, round {round}"), own));
            figures.push(line(&format!("answers, Express + better-sqlite3, round {round}"), rival));
        }
        // Not the best against the best, which would be 5 as well as anybody's luck.
        figures.push(line("answers, 100 sessions held", 9e9));
        assert_eq!(ratios(&figures), Some([1.0, 3.0, 5.0]));
        assert_eq!(ratios(&figures[..1]), None, "alone there is nothing to compare with");
    }
}
